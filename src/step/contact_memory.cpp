// What contact points remember from the last step.
#include <algorithm>

#include "avbd/rows/math.h"
#include "step/contacts.h"
#include "step/swept_contacts.h"

namespace avbd {

namespace {

constexpr float kAnchorDrift = 0.01f;  ///< of the smaller half thickness: farther from its anchor a point has rolled on

/// For each new point the index of the old point that it continues, or -1.
void matchPoints(const PairData& pair, const BodyData& a, float nearby, int (&match)[kMaxManifoldPoints]) {
  bool taken[kMaxManifoldPoints] = {};
  for (int i = 0; i < pair.manifold.count; ++i) {
    match[i] = -1;
    for (int j = 0; j < pair.pointCount && match[i] < 0; ++j)
      if (!taken[j] && pair.points[j].feature == pair.manifold.points[i].feature) match[i] = j, taken[j] = true;
  }
  for (int i = 0; i < pair.manifold.count; ++i) {
    if (match[i] >= 0) continue;
    const Vec3 at = toBody(a, pair.manifold.points[i].position);
    float best = nearby * nearby;
    for (int j = 0; j < pair.pointCount; ++j) {
      const Vec3 gap = at - pair.points[j].anchorA;
      if (!taken[j] && dot(gap, gap) < best) best = dot(gap, gap), match[i] = j;
    }
    if (match[i] >= 0) taken[match[i]] = true;
  }
}

/// Carries two components along t1 and t2 over to the pair's basis.
Vec3 toBasis(const PairData& pair, const ContactBasis& old, Vec3 v) {
  const Vec3 tangential = old.t1 * v.y + old.t2 * v.z;
  return {v.x, dot(tangential, pair.t1), dot(tangential, pair.t2)};
}

/// The same of the pair's turning. `known`: that of any of its old points, or null.
void rememberTurning(PairData& pair, const ContactBasis* known) {
  if (pair.turn == Vec3{} && pair.torque == Vec3{}) return;
  const bool keep = known && dot(known->normal, pair.normal) > kSameNormal;
  pair.turn = keep ? toBasis(pair, *known, pair.turn) : Vec3{};
  pair.torque = keep ? toBasis(pair, *known, pair.torque) : Vec3{};
}

}  // namespace

TouchBasis basisOf(Vec3 normal) {
  rows::V3<float> t1, t2;
  rows::orthonormalBasis(rows::V3<float>{normal.x, normal.y, normal.z}, t1, t2);
  return {{t1.x, t1.y, t1.z}, {t2.x, t2.y, t2.z}};
}

void turnBasis(PairData& pair) {
  const TouchBasis basis = basisOf(pair.manifold.normal);
  pair.normal = pair.manifold.normal;
  pair.t1 = basis.t1, pair.t2 = basis.t2;
}

PointMeans& meansOf(WorldData& world, PairData& pair) {
  if (pair.mean == kNone) {
    pair.mean = static_cast<uint32_t>(world.means.size());
    world.means.push_back({});
  }
  return world.means[pair.mean];
}

void continueForce(WorldData& world, PairData& pair, int i, const OldPoint* old) {
  const bool same = old && dot(old->basis.normal, pair.normal) > kSameNormal;
  meansOf(world, pair)[static_cast<size_t>(i)] = same ? toBasis(pair, old->basis, old->mean) : Vec3{};
}

void inheritForce(WorldData& world, PairData& pair, const OldPoint& gone) {
  if (gone.mean == Vec3{} || dot(gone.basis.normal, pair.normal) <= kSameNormal) return;
  int nearest = -1;
  float best = 0;
  for (int i = 0; i < pair.pointCount; ++i) {
    const Vec3 gap = gone.memory.anchorA - pair.points[i].anchorA;
    if (nearest >= 0 && dot(gap, gap) >= best) continue;
    nearest = i;
    best = dot(gap, gap);
  }
  if (nearest < 0) return;
  Vec3& mean = meansOf(world, pair)[static_cast<size_t>(nearest)];
  mean = mean + toBasis(pair, gone.basis, gone.mean);
}

void rememberPoints(const WorldData& world, PairData& pair, const KnownPoint* known) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const Vec3 fromAToB = toFloat(b.position - a.position);
  const float drift = kAnchorDrift * smallerSize(a, b);
  turnBasis(pair);
  const ContactBasis* any = nullptr;
  for (int i = 0; i < pair.manifold.count; ++i) {
    const ManifoldPoint& now = pair.manifold.points[i];
    const Vec3 onA = toBody(a, now.position), onB = toBody(b, now.position - fromAToB);
    const ContactBasis* basis = known[i].basis;
    const PointMemory* old = basis && dot(basis->normal, pair.normal) > kSameNormal ? known[i].memory : nullptr;
    PointMemory& point = pair.points[i];
    point = old ? *old : PointMemory{};
    if (old) point.lambda = toBasis(pair, *basis, old->lambda);
    const Vec3 driftA = onA - point.anchorA, driftB = onB - point.anchorB;
    const bool rolled = dot(driftA, driftA) > drift * drift || dot(driftB, driftB) > drift * drift;
    if (!old || !point.sticks || rolled) point.anchorA = onA, point.anchorB = onB;
    if (!old) point.sticks = 1;
    point.feature = now.feature;
    if (basis) any = basis;
  }
  rememberTurning(pair, any);
  pair.pointCount = pair.manifold.count;
  pair.gonePoints = 0;
}

namespace {

/// Remembers the points, and what they gave in the substeps before: apart, as most steps have none.
void rememberForces(WorldData& world, PairData& pair, const KnownPoint* known, const int (&match)[kMaxManifoldPoints]) {
  OldPoint old[kMaxManifoldPoints];
  const int count = pair.mean != kNone ? pair.pointCount + pair.gonePoints : 0;
  for (int j = 0; j < count; ++j)
    old[j] = {pair.points[j], {pair.normal, pair.t1, pair.t2}, world.means[pair.mean][static_cast<size_t>(j)]};
  rememberPoints(world, pair, known);
  for (int i = 0; i < pair.pointCount; ++i)
    continueForce(world, pair, i, match[i] >= 0 && count > 0 ? &old[match[i]] : nullptr);
  for (int j = 0; j < count; ++j)
    if (std::find(match, match + pair.pointCount, j) == match + pair.pointCount) inheritForce(world, pair, old[j]);
}

}  // namespace

void rememberPoints(WorldData& world, const StepData& step, PairData& pair) {
  const ContactBasis basis{pair.normal, pair.t1, pair.t2};
  PointMemory before[kMaxManifoldPoints];
  for (int i = 0; i < pair.pointCount; ++i) before[i] = pair.points[i];
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  int match[kMaxManifoldPoints];
  matchPoints(pair, a, kNearPoint * smallerSize(a, b), match);
  KnownPoint known[kMaxManifoldPoints];
  for (int i = 0; i < pair.manifold.count; ++i)
    if (match[i] >= 0) known[i] = {&before[match[i]], &basis};
  if (step.substep > 0) return rememberForces(world, pair, known, match);
  pair.mean = kNone;
  rememberPoints(world, pair, known);
}

/// Fast enough along the surface that friction cannot hold it within the step.
void beginSlide(const WorldData& world, const StepData& step, PairData& pair, Vec3 belt) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const ContactArms arms = armsOf(world, step, pair, 0);
  const Vec3 motion =
      b.linearVelocity + cross(b.angularVelocity, arms.b) - a.linearVelocity - cross(a.angularVelocity, arms.a) - belt;
  const Vec3 slip = motion - pair.normal * dot(motion, pair.normal);
  pair.slides = 0;
  pair.landedSliding = length(slip) > pair.staticFriction * length(world.def.gravity) * step.h;
}

void forgetContact(const WorldData& world, const StepData& step, PairData& pair) {
  if (step.substep == 0) pair.gonePoints = 0, pair.mean = kNone;
  if (pair.kept.what != KeptManifold::What::Apart) pair.kept.what = KeptManifold::What::Nothing;
  if (pair.pointCount == 0) return;  // forgotten already
  for (int i = 0; pair.mean != kNone && i < pair.pointCount; ++i)
    if (world.means[pair.mean][static_cast<size_t>(i)] != Vec3{})
      pair.gonePoints = static_cast<uint8_t>(pair.pointCount);
  pair.manifold.count = 0;
  pair.pointCount = 0;
  pair.slides = 0;
  pair.landedSliding = false;
  pair.turn = pair.torque = Vec3{};
}

}  // namespace avbd
