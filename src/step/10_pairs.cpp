// Pairs: shapes whose fat bounds overlap. Only shapes that left their fat bounds look for new partners.
#include <algorithm>

#include "step/step_data.h"
#include "world/limits.h"
#include "world/pairs.h"

namespace avbd {

namespace {

uint64_t pairKey(uint32_t a, uint32_t b) { return a < b ? uint64_t(a) << 32 | b : uint64_t(b) << 32 | a; }

Vec3 lengthen(Vec3 bound, Vec3 motion, bool upper) {
  const auto grow = [upper](float at, float by) { return (upper ? by > 0 : by < 0) ? at + by : at; };
  return {grow(bound.x, motion.x), grow(bound.y, motion.y), grow(bound.z, motion.z)};
}

/// How far turning takes a point of the body at most. Dynamic bodies are small, and give way; a kinematic one may be a
/// door of triangles, which pushes only what it finds in time.
float turningReach(const BodyData& body, float h) {
  if (body.type != BodyType::Kinematic) return 0;
  return std::min(length(body.angularVelocity) * h, 2.0f) * body.radius;
}

/// Bounds of a shape now and at the end of the step at its present velocity.
Aabb sweptBounds(const BodyData& body, const ShapeData& shape, float h, float margin) {
  const Pose mass{body.position, body.rotation};
  const Pose pose{mass.position + rotate(mass.rotation, shape.toMass.p), mass.rotation * shape.toMass.q};
  Aabb box = bounds(shape.geom, pose, margin + turningReach(body, h));
  const Vec3 motion = body.linearVelocity * h;
  box.lower = lengthen(box.lower, motion, false);
  box.upper = lengthen(box.upper, motion, true);
  return box;
}

void refit(WorldData& world, StepData& step, uint32_t slot, bool always) {
  ShapeData& shape = world.shapes[slot];
  const float unit = world.def.lengthUnit;
  const BodyData& body = world.bodies[shape.body];
  if (!always && contains(world.tree.box(shape.proxy), sweptBounds(body, shape, step.h, kSpeculative * unit))) return;
  world.tree.move(shape.proxy, sweptBounds(body, shape, 2 * step.h, (kSpeculative + kFatMargin) * unit));
  step.moved.push_back(slot);
}

void refitMoved(WorldData& world, StepData& step) {
  step.moved.clear();
  for (const uint32_t slot : world.unpaired)
    if (slot < world.shapes.size() && world.shapes[slot].proxy >= 0) refit(world, step, slot, true);
  world.unpaired.clear();
  world.bodyIds.forEach([&](uint32_t slot) {
    const BodyData& body = world.bodies[slot];
    if (body.type == BodyType::Static) return;
    for (uint32_t s = body.firstShape; s != kNone; s = world.shapes[s].next) refit(world, step, s, false);
  });
}

void findNewKeys(const WorldData& world, StepData& step) {
  step.newKeys.clear();
  for (const uint32_t slot : step.moved) {
    world.tree.query(world.tree.box(world.shapes[slot].proxy), [&](uint32_t other) {
      if (mayTouch(world, slot, other)) step.newKeys.push_back(pairKey(slot, other));
    });
  }
  std::sort(step.newKeys.begin(), step.newKeys.end());
  step.newKeys.erase(std::unique(step.newKeys.begin(), step.newKeys.end()), step.newKeys.end());
}

bool boundsOverlap(const WorldData& world, uint32_t a, uint32_t b) {
  return overlaps(world.tree.box(world.shapes[a].proxy), world.tree.box(world.shapes[b].proxy));
}

/// Old pairs that still overlap and new ones, in order of their keys; a run stays together.
void mergePairs(WorldData& world, StepData& step) {
  std::vector<PairData>& merged = step.mergedPairs;
  merged.clear();
  size_t next = 0;
  for (PairData& pair : world.pairs) {
    for (; next < step.newKeys.size() && step.newKeys[next] < pair.key(); ++next)
      merged.push_back(newPair(world, step.newKeys[next]));
    if (next < step.newKeys.size() && step.newKeys[next] == pair.key()) ++next;
    if (boundsOverlap(world, pair.shapeA, pair.shapeB))
      merged.push_back(pair);
    else
      loseTouch(world, pair, step.substep > 0);
  }
  for (; next < step.newKeys.size(); ++next) merged.push_back(newPair(world, step.newKeys[next]));
  world.pairs.swap(merged);
}

}  // namespace

void findPairs(WorldData& world, StepData& step) {
  refitMoved(world, step);
  if (!step.moved.empty()) {
    findNewKeys(world, step);
    mergePairs(world, step);
  }
  world.report.pairs = static_cast<uint32_t>(world.pairs.size());
}

}  // namespace avbd
