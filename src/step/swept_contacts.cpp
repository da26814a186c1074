// Contacts that are met on the way: how they are made, and their rows (swept_contacts.h).
#include "step/swept_contacts.h"

#include <algorithm>
#include <tuple>

#include "collide/collide.h"
#include "step/begin_rows.h"
#include "step/contacts.h"
#include "step/restitution.h"
#include "world/pairs.h"

namespace avbd {

namespace {

/// Place of a pair's entry in step.swept.
size_t placeOf(const StepData& step, const PairData& pair) {
  const auto at =
      std::lower_bound(step.swept.begin(), step.swept.end(), pair, [](const SweptPair& x, const PairData& y) {
        return std::make_tuple(x.key, x.patch) < std::make_tuple(y.key(), y.patch);
      });
  return static_cast<size_t>(at - step.swept.begin());
}

Vec3 turnedBack(Vec3 turn, Vec3 v) { return fromRow(rotate(conjugate(rows::expQuat(toRow(turn))), toRow(v))); }

/// A body when it meets.
struct Met {
  Pose pose;
  rows::Twist<float> moved;
};

Met metOf(const BodyData& body, const BodyMotion& motion, float time) {
  const Pose pose = at(motion, time);
  return {pose, {toRow(toFloat(pose.position - body.position)), toRow(motion.turn * time)}};
}

/// Whose face the points lie on: the flat one's, of two alike what does not give way.
bool planeIsOfA(const WorldData& world, const PairData& pair) {
  if (pair.manifold.carrier != Carrier::None) return pair.manifold.carrier == Carrier::A;
  const ShapeGeom &a = world.shapes[pair.shapeA].geom, &b = world.shapes[pair.shapeB].geom;
  if (!isConvex(a.type) || !isConvex(b.type)) return !isConvex(a.type);
  if ((a.radius > 0) != (b.radius > 0)) return b.radius > 0;
  return !isDynamic(world, pair.bodyA);
}

/// What the rows know of the pair's points, which are those of the poses where the two meet.
void fixToBodies(const WorldData& world, const PairData& pair, const Met (&met)[2], SweptPair& swept) {
  SweptContact& s = swept.rows;
  const ShapeGeom* geom[2] = {&world.shapes[pair.shapeA].geom, &world.shapes[pair.shapeB].geom};
  s = {};
  s.planeOnA = planeIsOfA(world, pair);
  const int plane = s.planeOnA ? 0 : 1, other = 1 - plane;
  s.count = pair.pointCount;
  s.turns = !(geom[plane]->radius > 0);
  s.radius = isConvex(geom[other]->type) ? geom[other]->radius : 0;
  s.metA = met[0].moved, s.metB = met[1].moved;
  s.between = toRow(world.bodies[pair.bodyB].position - world.bodies[pair.bodyA].position);
  const Vec3 n = pair.manifold.normal, out = n * (s.planeOnA ? -s.radius : s.radius);
  const auto back = [&](int side, Vec3 v) { return toRow(turnedBack(fromRow(met[side].moved.ang), v)); };
  s.n = s.turns ? back(plane, n) : toRow(n);
  for (int i = 0; i < s.count; ++i) {
    const ManifoldPoint& point = pair.manifold.points[i];
    const auto surface = [&](int side) {  // from the body's centre to its own surface
      const Vec3d at = pair.origin + point.position + n * (side == 0 ? -0.5f : 0.5f) * point.separation;
      return toFloat(at - met[side].pose.position);
    };
    swept.armA[i] = toFloat(pair.origin + point.position - met[0].pose.position);
    swept.armB[i] = toFloat(pair.origin + point.position - met[1].pose.position);
    if (i == 0) s.plane = s.turns ? back(plane, surface(plane)) : toRow(surface(plane));
    s.core[i] = back(other, surface(other) - out);
  }
}

/// [m] still to go along the normal when the step begins; and where the points are on the bodies.
void placePoints(PairData& pair, const Met (&met)[2], const SweptPair& swept) {
  for (int i = 0; i < pair.pointCount; ++i) {
    const Vec3 armA = swept.armA[i], armB = swept.armB[i];
    const rows::Twist<float> moved = relativeMotion(met[0].moved, met[1].moved, toRow(armA), toRow(armB));
    pair.manifold.points[i].separation += dot(toRow(pair.manifold.normal), moved.lin);
    pair.points[i].anchorA = rotate(conjugate(met[0].pose.rotation), armA);
    pair.points[i].anchorB = rotate(conjugate(met[1].pose.rotation), armB);
  }
}

float smallerRadius(const BodyData& a, const BodyData& b) {
  return std::min(a.radius > 0 ? a.radius : b.radius, b.radius > 0 ? b.radius : a.radius);
}

constexpr float kWhips = 1;  ///< [rad] in a step

/// The pair has the points that it has when it meets, and remembers what it knows of them.
void keepSwept(const WorldData& world, StepData& step, PairData& pair, const Met (&met)[2], const TiedImpact& impact) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const auto at = step.swept.insert(step.swept.begin() + static_cast<ptrdiff_t>(placeOf(step, pair)), SweptPair{});
  at->key = pair.key(), at->patch = pair.patch, at->round = step.round, at->time = impact.time;
  fixToBodies(world, pair, met, *at);
  at->turn = relativeWay(impact.motion[0], a.radius, impact.motion[1], b.radius) / smallerRadius(a, b);
  at->rows.whips = at->turn > kWhips;
  placePoints(pair, met, *at);
  pair.kept.what = KeptManifold::What::Nothing;
  bool isNew = true;
  for (int i = 0; i < pair.pointCount; ++i) isNew = isNew && pair.points[i].lambda == Vec3{};
  if (isNew) beginSlide(world, step, pair, {});
}

/// What the farther points of two shapes may come to when they have met.
float marginOf(const BodyData& a, const BodyData& b, float way, float least) {
  return std::max(std::min(way, 2 * smallerRadius(a, b)), least);
}

NearPose poseOf(const ShapeData& shape, const Pose& body, Vec3d origin) {
  return {toFloat(body.position - origin) + rotate(body.rotation, shape.toMass.p), body.rotation * shape.toMass.q};
}

void findPoints(WorldData& world, StepData& step, size_t index, const NearPair& near) {
  PairData& pair = world.pairs[index];
  if (pair.hasSurface) {
    findPatches(world, step, index, world.pairs.endOfRun(index), near);
    if (!step.overflow.empty()) lengthenRuns(world, step);
    step.overflow.clear();
    return;
  }
  const ShapeData &a = world.shapes[pair.shapeA], &b = world.shapes[pair.shapeB];
  collide(a.geom, near.a, b.geom, near.b, near.margin, pair.manifold);
  if (pair.manifold.count == 0) return forgetContact(world, step, pair);
  pair.origin = world.bodies[pair.bodyA].position;
  combineMaterials(pair, a.material, b.material);
  rememberPoints(world, step, pair);
}

/// The pair may be new to the list: a body may go elsewhere than its velocity says.
size_t pairOf(WorldData& world, StepData& step, uint64_t key) {
  size_t index = findPair(world, key);
  if (index < world.pairs.size()) return index;
  step.newKeys.assign(1, key);
  world.pairs.insert(
      step.newKeys, [&](PairData& pair, uint64_t of) { beginPair(world, pair, of); }, *step.jobs);
  return findPair(world, key);
}

}  // namespace

const SweptPair* sweptOf(const StepData& step, const PairData& pair) {
  const size_t at = placeOf(step, pair);
  if (at == step.swept.size()) return nullptr;
  const SweptPair& swept = step.swept[at];
  return swept.key == pair.key() && swept.patch == pair.patch ? &swept : nullptr;
}

bool sweepContact(WorldData& world, StepData& step, const TiedImpact& meeting) {
  const size_t index = pairOf(world, step, meeting.key);
  const PairData& head = world.pairs[index];
  const BodyData &a = world.bodies[head.bodyA], &b = world.bodies[head.bodyB];
  const Met met[2] = {metOf(a, meeting.motion[0], meeting.time), metOf(b, meeting.motion[1], meeting.time)};
  const float way = relativeWay(meeting.motion[0], a.radius, meeting.motion[1], b.radius);
  const NearPair near{poseOf(world.shapes[head.shapeA], met[0].pose, a.position),
                      poseOf(world.shapes[head.shapeB], met[1].pose, a.position),
                      marginOf(a, b, way, kSpeculative * world.def.lengthUnit)};
  std::erase_if(step.swept, [&](const SweptPair& swept) { return swept.key == meeting.key; });
  findPoints(world, step, index, near);
  bool any = false;
  for (size_t i = index, end = world.pairs.endOfRun(index); i < end; ++i) {
    PairData& pair = world.pairs[i];
    if (pair.pointCount == 0) continue;
    keepSwept(world, step, pair, met, meeting);
    any = true;
  }
  return any;
}

namespace {

void findOffsets(const WorldData& world, const StepData& step, const PairData& pair, SweptContact& rows) {
  const rows::Twist<float> still{{0, 0, 0}, {0, 0, 0}};
  for (int i = 0; i < rows.count; ++i) {
    rows.offset[i] = step.slop;
    if (pair.restitution > 0) {
      const Rebound answer = rebound(world, step, pair, i);
      if (answer.speed > 0) rows.offset[i] = -answer.height;
    }
    // How deep it is already is corrected as slowly as in other contacts.
    const float deep = depthOf(rows, i, still, still) - rows.offset[i];
    if (deep > 0) rows.offset[i] += deep - std::min((1 - step.alpha) * deep, world.def.maxDepenetrationSpeed * step.h);
  }
}

void listLanes(const WorldData& world, StepData& step, const std::vector<uint32_t>& pairs, Slice lanes, bool isFull) {
  for (uint32_t lane = lanes.begin; lane < lanes.end; ++lane) {
    if (pairs[lane] == kNone) continue;
    const SweptPair* swept = sweptOf(step, world.pairs[pairs[lane]]);
    if (!swept) continue;
    step.sweptLanes.push_back(swept->rows);
    SweptContact& last = step.sweptLanes.back();
    last.lane = lane - lanes.begin, last.isFull = isFull;
    if (step.changes.empty()) continue;
    const Vec3 belt = changeOf(step, pairs[lane]).belt;
    if (belt == Vec3{}) continue;
    last.belt = toRow(belt * step.h);
    last.metA = last.metB = {{0, 0, 0}, {0, 0, 0}};
  }
}

}  // namespace

void prepareSwept(const WorldData& world, StepData& step) {
  for (SweptPair& swept : step.swept)
    findOffsets(world, step, world.pairs[findPair(world, swept.key) + swept.patch], swept.rows);
}

void listSwept(const WorldData& world, StepData& step) {
  step.sweptLanes.clear();
  if (step.swept.empty()) return;
  for (BatchRange& batch : step.batches) {
    batch.sweptBegin = static_cast<uint32_t>(step.sweptLanes.size());
    const uint32_t contacts = batch.contactTile * kTile, full = batch.fullTile * kTile;
    listLanes(world, step, step.contactPair, {contacts, contacts + batch.contactTiles * kTile}, false);
    listLanes(world, step, step.fullPair, {full, full + batch.fullTiles * kTile}, true);
    batch.sweptCount = static_cast<uint32_t>(step.sweptLanes.size()) - batch.sweptBegin;
  }
}

}  // namespace avbd
