// Islands: dynamic bodies that touch or are jointed. Numbered by their lowest body slot; within an island bodies,
// pairs and joints stand in the order of their slots, so that nothing far away changes a sum.
#include <algorithm>

#include "base/disjoint_sets.h"
#include "step/step_data.h"
#include "world/joints.h"
#include "world/pairs.h"
#include "world/soft.h"
#include "world/soft_touch.h"

namespace avbd {

namespace {

constexpr uint32_t kPairGrain = Jobs::grainOf(2048);

/// Pairs with points, in order: each piece's own at its beginning, then moved up. Without a branch, as which ones have
/// some nobody can foresee.
void listTouching(StepData& step) {
  const auto count = static_cast<uint32_t>(step.found.size());
  step.touching.resize(count);
  step.touchingEnd.resize((count + kPairGrain - 1) / kPairGrain);
  step.jobs->forRange(count, kPairGrain, [&](uint32_t begin, uint32_t end, int) {
    uint32_t* at = step.touching.data() + begin;
    for (uint32_t i = begin; i < end; ++i) {
      *at = i;
      at += step.found[i].points > 0;
    }
    step.touchingEnd[begin / kPairGrain] = static_cast<uint32_t>(at - step.touching.data());
  });
  auto end = step.touching.begin();
  for (uint32_t piece = 0; piece < step.touchingEnd.size(); ++piece)
    end = std::copy(step.touching.begin() + piece * kPairGrain, step.touching.begin() + step.touchingEnd[piece], end);
  step.touching.erase(end, step.touching.end());
}

/// The records of bodies are far apart in memory: all threads read them.
void listAwake(const WorldData& world, StepData& step) {
  const std::vector<uint32_t>& awake = world.sleep.awake;
  step.awake.resize(awake.size());
  step.jobs->forRange(static_cast<uint32_t>(awake.size()), 256, [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i) {
      const BodyData& body = world.bodies[awake[i]];
      step.awake[i] = {awake[i], body.type, body.mass, body.iterations};
    }
  });
}

void joinBodies(const WorldData& world, StepData& step) {
  step.parent.resize(world.bodies.size());
  for (const uint32_t slot : world.sleep.awake) step.parent[slot] = slot;
  for (const uint32_t i : step.touching)
    if (step.found[i].isBetweenDynamic()) join(step.parent, step.found[i].bodyA, step.found[i].bodyB);
  for (const uint32_t slot : world.sleep.joints) {
    if (!acts(world, slot)) continue;
    uint32_t first = kNone;
    forEachBody(world, slot, [&](uint32_t body) {
      if (!isDynamic(world, body)) return;
      if (first != kNone) join(step.parent, first, body);
      first = body;
    });
  }
  world.softIds.forEach([&](uint32_t slot) {
    const SoftData& soft = world.softs[slot];
    if (isAsleep(world, soft)) return;
    for (const uint32_t body : soft.bodies) join(step.parent, soft.bodies[0], body);
  });
  for (const FoundTouch& found : step.softTouches) {
    const uint32_t first = found.awake ? bodyOfFirst(world, found.touch) : kNone;
    if (isDynamic(world, first)) join(step.parent, first, bodyOfSecond(world, found.touch));
  }
}

/// Turns the islands' counts into the beginnings of consecutive ranges and clears them, to be counted again by who
/// fills the ranges. Returns the sum.
uint32_t layOut(std::vector<Island>& islands, uint32_t Island::*begin, uint32_t Island::*count) {
  uint32_t next = 0;
  for (Island& island : islands) {
    island.*begin = next;
    next += island.*count;
    island.*count = 0;
  }
  return next;
}

/// Numbers the islands and lists their bodies, both in ascending order.
void listBodies(const WorldData& world, StepData& step) {
  for (const uint32_t slot : step.order) step.islandOf[slot] = kNone;  // of the step before
  step.islandOf.resize(std::max(step.islandOf.size(), world.bodies.size()), kNone);
  step.islands.clear();
  step.kinematic.clear();
  for (const auto& [slot, type, mass, iterations] : step.awake) {
    if (type == BodyType::Kinematic) step.kinematic.push_back(slot);
    if (type != BodyType::Dynamic) continue;
    const uint32_t root = setOf(step.parent, slot);
    if (root == slot) {
      step.islandOf[slot] = static_cast<uint32_t>(step.islands.size());
      step.islands.emplace_back();
    }
    step.islandOf[slot] = step.islandOf[root];
    ++step.islands[step.islandOf[slot]].bodyCount;
  }
  step.order.resize(layOut(step.islands, &Island::bodyBegin, &Island::bodyCount));
  for (const auto& [slot, type, mass, iterations] : step.awake) {
    if (step.islandOf[slot] == kNone) continue;
    Island& island = step.islands[step.islandOf[slot]];
    step.order[island.bodyBegin + island.bodyCount++] = slot;
    island.mass += mass;
    island.iterations = std::max(island.iterations, iterations > 0 ? iterations : world.def.iterations);
  }
}

void listSofts(const WorldData& world, StepData& step) {
  world.softIds.forEach([&](uint32_t slot) {
    if (!isAsleep(world, world.softs[slot])) ++step.islands[step.islandOf[world.softs[slot].bodies[0]]].softCount;
  });
  step.islandSofts.resize(layOut(step.islands, &Island::softBegin, &Island::softCount));
  world.softIds.forEach([&](uint32_t slot) {
    if (isAsleep(world, world.softs[slot])) return;
    Island& island = step.islands[step.islandOf[world.softs[slot].bodies[0]]];
    step.islandSofts[island.softBegin + island.softCount++] = slot;
  });
}

void listTouches(const WorldData& world, StepData& step) {
  const auto island = [&](const FoundTouch& found) -> Island& {
    return step.islands[step.islandOf[bodyOfSecond(world, found.touch)]];
  };
  for (const FoundTouch& found : step.softTouches) {
    if (!found.awake) continue;
    ++island(found).touchCount;
    if (!isDynamic(world, bodyOfFirst(world, found.touch))) island(found).floating = false;
  }
  step.islandTouches.resize(layOut(step.islands, &Island::touchBegin, &Island::touchCount));
  for (uint32_t i = 0; i < step.softTouches.size(); ++i) {
    if (!step.softTouches[i].awake) continue;
    Island& of = island(step.softTouches[i]);
    step.islandTouches[of.touchBegin + of.touchCount++] = i;
  }
}

uint32_t islandOfJoint(const WorldData& world, const StepData& step, uint32_t slot) {
  uint32_t island = kNone;
  forEachBody(world, slot, [&](uint32_t body) {
    if (island == kNone && body != kNone) island = step.islandOf[body];
  });
  return island;
}

/// What is met on the way turns within the step, and its rows follow, iteration by iteration.
constexpr float kTurnAnIteration = 0.1f;  ///< [rad]
constexpr int kSweptFactor = 8;           ///< of the iterations of a step: the most that are taken

int iterationsFor(const WorldData& world, float turn) {
  const int most = kSweptFactor * world.def.iterations;
  return static_cast<int>(std::min(turn * (1 / kTurnAnIteration), static_cast<float>(most)));
}

/// Islands with contacts that are met on the way start where the first is, as from far behind it no iteration finds
/// back, and take more iterations. Where both bodies move, force and counter-force
/// act far from each other as the step begins, so no rigid motion of the start keeps the angular momentum.
void noteSwept(const WorldData& world, StepData& step) {
  for (const SweptPair& swept : step.swept) {
    const size_t index = findPair(world, swept.key) + swept.patch;
    if (step.found[index].points == 0) continue;
    Island& island = step.islands[islandOfPair(step, step.found[index])];
    island.startTime = std::min(island.startTime, swept.time);
    if (swept.rows.whips) island.iterations = std::max(island.iterations, iterationsFor(world, swept.turn));
    if (step.found[index].isBetweenDynamic()) island.floating = false;
  }
}

void listPairs(StepData& step) {
  for (const uint32_t i : step.touching) {
    Island& island = step.islands[islandOfPair(step, step.found[i])];
    ++island.pairCount;
    if (!step.found[i].isBetweenDynamic()) island.floating = false;
  }
  // Where a contact gives one body more than it takes from the other, momentum is not kept.
  for (const ContactChange& change : step.changes)
    if (change.scaleA != change.scaleB) step.islands[islandOfPair(step, step.found[change.pair])].floating = false;
  step.islandPairs.resize(layOut(step.islands, &Island::pairBegin, &Island::pairCount));
  for (const uint32_t i : step.touching) {
    Island& island = step.islands[islandOfPair(step, step.found[i])];
    step.islandPairs[island.pairBegin + island.pairCount++] = i;
  }
}

void listJoints(const WorldData& world, StepData& step) {
  for (const uint32_t slot : world.sleep.joints) {
    if (!acts(world, slot)) continue;
    Island& island = step.islands[islandOfJoint(world, step, slot)];
    ++island.jointCount;
    forEachBody(world, slot, [&](uint32_t body) {
      if (!isDynamic(world, body)) island.floating = false;
    });
    // Its wheels stand in the world; what a user's rows do to momentum only the user knows.
    const JointType type = world.joints[slot].type;
    if (type == JointType::Pulley || type == JointType::Custom) island.floating = false;
  }
  step.islandJoints.resize(layOut(step.islands, &Island::jointBegin, &Island::jointCount));
  for (const uint32_t slot : world.sleep.joints) {
    if (!acts(world, slot)) continue;
    Island& island = step.islands[islandOfJoint(world, step, slot)];
    step.islandJoints[island.jointBegin + island.jointCount++] = slot;
  }
}

}  // namespace

void findIslands(WorldData& world, StepData& step) {
  listTouching(step);
  listAwake(world, step);
  joinBodies(world, step);
  listBodies(world, step);
  listPairs(step);
  noteSwept(world, step);
  listJoints(world, step);
  listSofts(world, step);
  listTouches(world, step);
  world.report.bodies = static_cast<uint32_t>(step.order.size());
  world.report.islands = static_cast<uint32_t>(step.islands.size());
  world.report.joints = static_cast<uint32_t>(step.islandJoints.size());
}

}  // namespace avbd
