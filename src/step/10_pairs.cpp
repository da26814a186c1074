// Pairs: shapes whose fat bounds overlap. Only shapes that left their fat bounds look for new partners.
#include <algorithm>

#include "base/insert_sorted.h"
#include "step/step_data.h"
#include "world/limits.h"
#include "world/pairs.h"
#include "world/sleep.h"

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
  for (const uint32_t slot : world.unpaired) {
    if (slot >= world.shapes.size() || world.shapes[slot].proxy < 0) continue;
    // What sleeps looks for its pairs when it wakes.
    const uint32_t body = world.shapes[slot].body;
    if (!isDynamic(world, body) || isAwake(world, body)) refit(world, step, slot, true);
  }
  world.unpaired.clear();
  for (const uint32_t slot : world.sleep.awake)
    for (uint32_t s = world.bodies[slot].firstShape; s != kNone; s = world.shapes[s].next) refit(world, step, s, false);
}

/// Nothing happens between two that rest, but that a trigger that was made or moved by hand sees what rests in it.
bool mayMeet(const WorldData& world, uint32_t shapeA, uint32_t shapeB) {
  const ShapeData &a = world.shapes[shapeA], &b = world.shapes[shapeB];
  return isAwake(world, a.body) || isAwake(world, b.body) || a.isTrigger || b.isTrigger;
}

/// Keys that are not in the list.
void findNewKeys(WorldData& world, StepData& step) {
  step.newKeys.clear();
  for (const uint32_t slot : step.moved) {
    world.tree.query(world.tree.box(world.shapes[slot].proxy), [&](uint32_t other) {
      if (mayMeet(world, slot, other) && mayTouch(world, slot, other)) step.newKeys.push_back(pairKey(slot, other));
    });
  }
  std::sort(step.newKeys.begin(), step.newKeys.end());
  step.newKeys.erase(std::unique(step.newKeys.begin(), step.newKeys.end()), step.newKeys.end());
  std::erase_if(step.newKeys, [&](uint64_t key) { return findPair(world, key) != nullptr; });
}

/// Drops the pairs that do not overlap any more. Most steps lose none, so that nothing is copied.
void dropParted(WorldData& world, StepData& step) {
  step.isMoved.resize(world.shapes.size());
  for (const uint32_t slot : step.moved) step.isMoved[slot] = 1;
  const auto parted = [&](const PairData& pair) {
    if (!step.isMoved[pair.shapeA] && !step.isMoved[pair.shapeB]) return false;
    return !overlaps(world.tree.box(world.shapes[pair.shapeA].proxy), world.tree.box(world.shapes[pair.shapeB].proxy));
  };
  size_t size = 0;
  for (size_t i = 0; i < world.pairs.size(); ++i) {
    if (parted(world.pairs[i])) {
      loseTouch(world, world.pairs[i], step.substep > 0);
      continue;
    }
    if (size != i) world.pairs[size] = world.pairs[i];
    ++size;
  }
  world.pairs.resize(size);
  for (const uint32_t slot : step.moved) step.isMoved[slot] = 0;
}

/// New pairs to their places; a run stays together.
void addNew(WorldData& world, const StepData& step) {
  insertSorted(
      world.pairs, step.newKeys.size(), [&](const PairData& pair, size_t i) { return pair.key() > step.newKeys[i]; },
      [&](size_t i) { return newPair(world, step.newKeys[i]); });
}

}  // namespace

void findPairs(WorldData& world, StepData& step) {
  refitMoved(world, step);
  if (!step.moved.empty()) {
    findNewKeys(world, step);
    dropParted(world, step);
    addNew(world, step);
  }
  world.report.pairs = static_cast<uint32_t>(world.pairs.size());
}

}  // namespace avbd
