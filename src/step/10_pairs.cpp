// Pairs: shapes whose fat bounds overlap. Only shapes that left their fat bounds look for new partners.
#include <algorithm>

#include "step/step_data.h"
#include "world/limits.h"
#include "world/pairs.h"
#include "world/sleep.h"

namespace avbd {

namespace {

/// What one thread works at at a time.
constexpr uint32_t kBodyGrain = Jobs::grainOf(64), kShapeGrain = Jobs::grainOf(32), kPairGrain = Jobs::grainOf(1024);

/// Makes `of` one empty list a piece.
template <class T>
void clearPieces(std::vector<std::vector<T>>& of, uint32_t count, uint32_t grain) {
  of.resize(std::max<size_t>(of.size(), (count + grain - 1) / grain));
  for (std::vector<T>& list : of) list.clear();
}

/// One piece's list behind the other.
template <class T>
void addPieces(const std::vector<std::vector<T>>& of, std::vector<T>& all) {
  for (const std::vector<T>& list : of) all.insert(all.end(), list.begin(), list.end());
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
  return swept(bounds(shape.geom, pose, margin + turningReach(body, h)), body.linearVelocity * h);
}

/// Whether it may leave its fat bounds in this step.
bool leaves(const WorldData& world, const StepData& step, const BodyData& body, const ShapeData& shape) {
  const float margin = kSpeculative * world.def.lengthUnit;
  return !contains(world.tree.box(shape.proxy), sweptBounds(body, shape, step.h, margin));
}

/// Gives the shapes step.moved[begin ...] new fat bounds.
void refit(WorldData& world, StepData& step, size_t begin) {
  const float margin = (kSpeculative + kFatMargin) * world.def.lengthUnit;
  step.shifts.resize(step.moved.size() - begin);
  step.jobs->forRange(static_cast<uint32_t>(step.shifts.size()), 64, [&](uint32_t from, uint32_t to, int) {
    for (uint32_t i = from; i < to; ++i) {
      const ShapeData& shape = world.shapes[step.moved[begin + i]];
      step.shifts[i] = {shape.proxy, sweptBounds(world.bodies[shape.body], shape, 2 * step.h, margin)};
    }
  });
  world.tree.shift(step.shifts, *step.jobs);
}

/// Shapes that were made or set to another place, or that wake.
void refitUnpaired(WorldData& world, StepData& step) {
  for (const uint32_t slot : world.unpaired) {
    if (slot >= world.shapes.size() || world.shapes[slot].proxy < 0) continue;
    // What sleeps looks for its pairs when it wakes.
    const uint32_t body = world.shapes[slot].body;
    if (!isDynamic(world, body) || isAwake(world, body)) step.moved.push_back(slot);
  }
  world.unpaired.clear();
  refit(world, step, 0);
}

/// Shapes of bodies that are awake and leave their bounds, in the order of the bodies.
void refitAwake(WorldData& world, StepData& step) {
  const std::vector<uint32_t>& awake = world.sleep.awake;
  const auto count = static_cast<uint32_t>(awake.size());
  clearPieces(step.leavingOf, count, kBodyGrain);
  step.jobs->forRange(count, kBodyGrain, [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i) {
      const BodyData& body = world.bodies[awake[i]];
      for (uint32_t s = body.firstShape; s != kNone; s = world.shapes[s].next)
        if (leaves(world, step, body, world.shapes[s])) step.leavingOf[begin / kBodyGrain].push_back(s);
    }
  });
  const size_t before = step.moved.size();
  addPieces(step.leavingOf, step.moved);
  refit(world, step, before);
}

void refitMoved(WorldData& world, StepData& step) {
  step.moved.clear();
  refitUnpaired(world, step);
  refitAwake(world, step);
}

/// Nothing happens between two that rest, but that a trigger that was made or moved by hand sees what rests in it.
bool mayMeet(const WorldData& world, uint32_t shapeA, uint32_t shapeB) {
  const ShapeData &a = world.shapes[shapeA], &b = world.shapes[shapeB];
  return isAwake(world, a.body) || isAwake(world, b.body) || a.isTrigger || b.isTrigger;
}

/// Keys of a moved shape's pairs that are not in the list.
void findKeys(const WorldData& world, uint32_t slot, std::vector<uint64_t>& keys) {
  world.tree.query(world.tree.box(world.shapes[slot].proxy), [&](uint32_t other) {
    const uint64_t key = slotPair(slot, other);
    if (findPair(world, key) < world.pairs.size()) return;
    if (mayMeet(world, slot, other) && mayTouch(world, slot, other)) keys.push_back(key);
  });
}

void findNewKeys(WorldData& world, StepData& step) {
  const auto count = static_cast<uint32_t>(step.moved.size());
  clearPieces(step.keysOf, count, kShapeGrain);
  step.jobs->forRange(count, kShapeGrain, [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i) findKeys(world, step.moved[i], step.keysOf[begin / kShapeGrain]);
  });
  step.newKeys.clear();
  addPieces(step.keysOf, step.newKeys);
  std::sort(step.newKeys.begin(), step.newKeys.end());
  step.newKeys.erase(std::unique(step.newKeys.begin(), step.newKeys.end()), step.newKeys.end());
}

/// Drops the pairs that do not overlap any more.
void dropParted(WorldData& world, StepData& step) {
  step.isMoved.resize(world.shapes.size());
  for (const uint32_t slot : step.moved) step.isMoved[slot] = 1;
  const auto boundsOf = [&](uint32_t shape) -> const Aabb& { return world.tree.box(world.shapes[shape].proxy); };
  const auto count = static_cast<uint32_t>(world.pairs.size());
  clearPieces(step.partedOf, count, kPairGrain);
  step.jobs->forRange(count, kPairGrain, [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t a = world.pairs.shapeA(i), b = world.pairs.shapeB(i);
      if ((step.isMoved[a] || step.isMoved[b]) && !overlaps(boundsOf(a), boundsOf(b)))
        step.partedOf[begin / kPairGrain].push_back(i);
    }
  });
  step.parted.clear();
  addPieces(step.partedOf, step.parted);
  for (const uint32_t i : step.parted) loseTouch(world, i, step.substep > 0);
  world.pairs.erase(step.parted);
  for (const uint32_t slot : step.moved) step.isMoved[slot] = 0;
}

/// New pairs to their places; a run stays together.
void addNew(WorldData& world, const StepData& step) {
  world.pairs.insert(
      step.newKeys, [&](PairData& pair, uint64_t key) { beginPair(world, pair, key); }, *step.jobs);
  world.pairs.sortStrayed(*step.jobs);
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
