// Triggers that a fast body enters and leaves within one step (continuous.h).
#include <algorithm>

#include "collide/convex.h"
#include "step/step_data.h"
#include "world/pairs.h"

namespace avbd {

namespace {

constexpr float kTolerance = 0.1f;  ///< of the slop

/// What is known of a body: its way up to `time`, that from `since` on, and where it ends.
struct Way {
  BodyMotion motion;
  Pose end;
  float time;
  BodyMotion rest;
  float since;
};

Way wayOf(const WorldData& world, const StepData& step, uint32_t body) {
  const uint32_t index = step.continuous.indexOf[body];
  if (index == kNone) {
    const BodyMotion motion = motionOf(world, step, body);
    return {motion, at(motion, 1), 1, motion, 0};
  }
  const MovedBody& moved = step.continuous.bodies[index];
  const BodyMotion& first = moved.state == MovedBody::State::Free ? moved.motion : moved.before;
  return {first, at(moved.motion, 1), moved.time, moved.motion, moved.since};
}

/// By more than rounding: what just touches at the end is found by the next step's overlap.
bool apart(const ShapeGeom& a, const ShapeMotion& atA, const ShapeGeom& b, const ShapeMotion& atB, float tolerance) {
  const Nearest near = nearest(a, atA.start, b, atB.start, tolerance);
  return near.apart || near.distance > tolerance;
}

bool passes(const WorldData& world, const StepData& step, uint32_t slotA, uint32_t slotB) {
  const ShapeData &a = world.shapes[slotA], &b = world.shapes[slotB];
  if (!isConvex(a.geom.type) || !isConvex(b.geom.type)) return false;
  const Way wayA = wayOf(world, step, a.body), wayB = wayOf(world, step, b.body);
  const Vec3d origin = at(wayA.motion, 0).position;
  const auto enters = [&](const BodyMotion& motionA, const BodyMotion& motionB, float from, float to) {
    const ImpactQuery query{0, kTolerance * step.slop, from, to};
    const Impact impact =
        timeOfImpact(a.geom, motionOf(motionA, a, origin), b.geom, motionOf(motionB, b, origin), query);
    return impact.happens && impact.before > query.tolerance;
  };
  const float time = std::min(wayA.time, wayB.time), since = std::max(wayA.since, wayB.since);
  return (enters(wayA.motion, wayB.motion, 0, time) || (since > 0 && enters(wayA.rest, wayB.rest, since, 1))) &&
         apart(a.geom, motionOf(resting(wayA.end), a, wayA.end.position), b.geom,
               motionOf(resting(wayB.end), b, wayA.end.position), kTolerance * step.slop);
}

}  // namespace

void findCrossings(WorldData& world, StepData& step) {
  std::vector<uint64_t>& visits = step.continuous.visits;
  std::sort(visits.begin(), visits.end());
  visits.erase(std::unique(visits.begin(), visits.end()), visits.end());
  for (const uint64_t key : visits) {
    const auto low = static_cast<uint32_t>(key >> 32), high = static_cast<uint32_t>(key);
    const size_t pair = findPair(world, key);
    if ((pair < world.pairs.size() && world.pairs[pair].touching) || !passes(world, step, low, high)) continue;
    const bool lowIsTrigger = world.shapes[low].isTrigger;
    const uint32_t trigger = lowIsTrigger ? low : high, visitor = lowIsTrigger ? high : low;
    const auto bodyId = [&](uint32_t shape) { return world.bodyIds.id(world.shapes[shape].body); };
    step.continuous.crossings.push_back(
        {world.shapeIds.id(trigger), world.shapeIds.id(visitor), bodyId(trigger), bodyId(visitor)});
  }
}

}  // namespace avbd
