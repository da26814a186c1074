// Contacts: manifolds of all pairs, with what their points remember from the last step.
#include <algorithm>

#include "avbd/rows/math.h"
#include "collide/collide.h"
#include "step/step_data.h"

namespace avbd {

namespace {

constexpr float kSameNormal = 0.9f;  ///< cosine: a normal that turned farther keeps no multipliers
constexpr float kNearPoint = 0.1f;   ///< of the smaller half thickness: the nearest old point still counts as this one
constexpr float kAnchorDrift = 0.01f;  ///< of the smaller half thickness: farther from its anchor a point has rolled on

NearPose nearPose(const BodyData& body, const ShapeData& shape, Vec3d origin) {
  return {toFloat(body.position - origin) + rotate(body.rotation, shape.toMass.p), body.rotation * shape.toMass.q};
}

/// Smaller half thickness of two bodies; a body without bounded shapes does not count.
float smallerSize(const BodyData& a, const BodyData& b) {
  return std::min(a.minExtent > 0 ? a.minExtent : b.minExtent, b.minExtent > 0 ? b.minExtent : a.minExtent);
}

/// Distance within which contacts are looked for: what the bodies may close in this step, but never a large part of
/// the smaller one's size.
float speculativeMargin(const WorldData& world, const BodyData& a, const BodyData& b, float h) {
  const float speed = length(a.linearVelocity - b.linearVelocity) + length(a.angularVelocity) * a.radius +
                      length(b.angularVelocity) * b.radius;
  return kSpeculative * world.def.lengthUnit + std::min(speed * h, smallerSize(a, b));
}

float combined(float a, float b, Combine rule) {
  switch (rule) {
    case Combine::GeometricMean:
      return rows::sqrt(a * b);
    case Combine::Average:
      return 0.5f * (a + b);
    case Combine::Minimum:
      return std::min(a, b);
    case Combine::Multiply:
      return a * b;
    case Combine::Maximum:
      return std::max(a, b);
  }
  return 0;
}

float staticOf(const Material& m) { return m.staticFriction < 0 ? m.friction : m.staticFriction; }

void combineMaterials(PairData& pair, const Material& a, const Material& b) {
  if (a.frictionPriority != b.frictionPriority) {
    const Material& m = a.frictionPriority > b.frictionPriority ? a : b;
    pair.friction = m.friction;
    pair.staticFriction = staticOf(m);
    pair.restitution = m.restitution;
    return;
  }
  const Combine friction = std::max(a.frictionCombine, b.frictionCombine);
  pair.friction = combined(a.friction, b.friction, friction);
  pair.staticFriction = std::max(pair.friction, combined(staticOf(a), staticOf(b), friction));
  pair.restitution = combined(a.restitution, b.restitution, std::max(a.restitutionCombine, b.restitutionCombine));
}

/// A point in the body's axes, relative to its centre of mass.
Vec3 toBody(const BodyData& body, Vec3 fromCenter) { return rotate(conjugate(body.rotation), fromCenter); }

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

/// What of a pair's last step its new points are made from.
struct Before {
  Vec3 normal, t1, t2;
  PointMemory points[kMaxManifoldPoints];
};

/// Carries the memory of one old point over to the new manifold's basis.
PointMemory carryOver(const PointMemory& old, const PairData& pair, const Before& before) {
  PointMemory point = old;
  const Vec3 tangential = before.t1 * old.lambda.y + before.t2 * old.lambda.z;
  point.lambda = {old.lambda.x, dot(tangential, pair.t1), dot(tangential, pair.t2)};
  return point;
}

void turnBasis(PairData& pair) {
  const rows::V3<float> n{pair.manifold.normal.x, pair.manifold.normal.y, pair.manifold.normal.z};
  rows::V3<float> t1, t2;
  rows::orthonormalBasis(n, t1, t2);
  pair.normal = pair.manifold.normal;
  pair.t1 = {t1.x, t1.y, t1.z};
  pair.t2 = {t2.x, t2.y, t2.z};
}

void rememberPoints(PairData& pair, const BodyData& a, const BodyData& b, Vec3 fromAToB) {
  Before before;
  before.normal = pair.normal, before.t1 = pair.t1, before.t2 = pair.t2;
  for (int i = 0; i < pair.pointCount; ++i) before.points[i] = pair.points[i];
  const float size = smallerSize(a, b), drift = kAnchorDrift * size;
  int match[kMaxManifoldPoints];
  matchPoints(pair, a, kNearPoint * size, match);
  turnBasis(pair);
  const bool sameNormal = dot(before.normal, pair.normal) > kSameNormal;
  for (int i = 0; i < pair.manifold.count; ++i) {
    const ManifoldPoint& now = pair.manifold.points[i];
    const Vec3 onA = toBody(a, now.position), onB = toBody(b, now.position - fromAToB);
    const bool known = match[i] >= 0 && sameNormal;
    PointMemory& point = pair.points[i];
    point = known ? carryOver(before.points[match[i]], pair, before) : PointMemory{};
    const Vec3 driftA = onA - point.anchorA, driftB = onB - point.anchorB;
    const bool rolled = dot(driftA, driftA) > drift * drift || dot(driftB, driftB) > drift * drift;
    if (!known || !point.sticks || rolled) point.anchorA = onA, point.anchorB = onB;
    if (!known) point.sticks = 1;
    point.feature = now.feature;
  }
  pair.pointCount = pair.manifold.count;
}

/// A contact that begins fast enough along the surface that friction cannot hold it within the step begins as a slide.
void beginSlide(const WorldData& world, const StepData& step, PairData& pair, const BodyData& a, const BodyData& b) {
  const Vec3 armA = pair.manifold.points[0].position, armB = armA - toFloat(b.position - a.position);
  const Vec3 motion =
      b.linearVelocity + cross(b.angularVelocity, armB) - a.linearVelocity - cross(a.angularVelocity, armA);
  const Vec3 slip = motion - pair.normal * dot(motion, pair.normal);
  pair.slides = 0;
  pair.landedSliding = length(slip) > pair.staticFriction * length(world.def.gravity) * step.h;
}

}  // namespace

void findContacts(WorldData& world, StepData& step) {
  uint32_t contacts = 0, points = 0;
  for (PairData& pair : world.pairs) {
    const ShapeData &shapeA = world.shapes[pair.shapeA], &shapeB = world.shapes[pair.shapeB];
    const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
    pair.origin = a.position;
    collide(shapeA.geom, nearPose(a, shapeA, a.position), shapeB.geom, nearPose(b, shapeB, a.position),
            speculativeMargin(world, a, b, step.h), pair.manifold);
    if (pair.manifold.count == 0) {
      pair.pointCount = 0;
      pair.slides = 0;
      pair.landedSliding = false;
      continue;
    }
    combineMaterials(pair, shapeA.material, shapeB.material);
    const bool begins = pair.pointCount == 0;
    rememberPoints(pair, a, b, toFloat(b.position - a.position));
    if (begins) beginSlide(world, step, pair, a, b);
    ++contacts;
    points += static_cast<uint32_t>(pair.manifold.count);
  }
  world.report.contacts = contacts;
  world.report.points = points;
}

}  // namespace avbd
