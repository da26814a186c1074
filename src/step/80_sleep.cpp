// Sleep: which islands have rested long enough. They fall asleep once the step is published (sleeping.h).
#include <algorithm>

#include "step/step_data.h"
#include "world/joints.h"
#include "world/sleep.h"

namespace avbd {

namespace {

/// Slow in both ways: as a whole, and about its centre where it is farthest from it.
bool isSlow(const WorldData& world, const BodyData& body, const StepData::EndState& end) {
  const float speed = world.def.sleepSpeed * world.def.lengthUnit;
  const float radius = body.radius > 0 ? body.radius : world.def.lengthUnit;
  const float turning = radius * radius * dot(end.angularVelocity, end.angularVelocity);
  return dot(end.linearVelocity, end.linearVelocity) < speed * speed && turning < speed * speed;
}

bool moves(const WorldData& world, uint32_t body) {
  return body != kNone && world.bodies[body].type == BodyType::Kinematic && isAwake(world, body) &&
         hasVelocity(world.bodies[body]);
}

/// Something that moves by itself touches or holds the island.
bool isCarried(const WorldData& world, const StepData& step, const Island& island) {
  for (uint32_t i = 0; i < island.pairCount; ++i) {
    const FoundContact& pair = step.found[step.islandPairs[island.pairBegin + i]];
    if (pair.hasKinematic() && (moves(world, pair.bodyA) || moves(world, pair.bodyB))) return true;
  }
  bool carried = false;
  for (uint32_t i = 0; i < island.jointCount && !carried; ++i)
    forEachBody(world, step.islandJoints[island.jointBegin + i],
                [&](uint32_t body) { carried = carried || moves(world, body); });
  return carried;
}

/// Counts the rest of an island's bodies; true if all have had enough.
bool rests(const WorldData& world, StepData& step, const Island& island, float dt) {
  bool all = true;
  for (uint32_t i = island.bodyBegin; i < island.bodyBegin + island.bodyCount; ++i) {
    const BodyData& body = world.bodies[step.order[i]];
    const bool slow = isSlow(world, body, step.end[i]);
    step.stillTime[i] = slow ? std::min(body.stillTime + dt, world.def.sleepTime) : 0;
    all = all && slow && body.canSleep && step.stillTime[i] >= world.def.sleepTime;
  }
  return all;
}

}  // namespace

void chooseSleepers(WorldData& world, StepData& step) {
  step.falling.clear(), step.stillTime.clear();
  if (!world.def.sleep || step.substep + 1 < world.def.substeps) return;
  step.stillTime.resize(step.order.size());
  const float dt = step.h * static_cast<float>(world.def.substeps);
  for (uint32_t n = 0; n < step.islands.size(); ++n) {
    const Island& island = step.islands[n];
    if (!rests(world, step, island, dt) || isCarried(world, step, island)) continue;
    step.falling.push_back(n);
    for (uint32_t i = island.bodyBegin; i < island.bodyBegin + island.bodyCount; ++i)
      step.end[i].linearVelocity = step.end[i].angularVelocity = {};
  }
}

}  // namespace avbd
