// Falling asleep and waking within a step (sleeping.h).
#include "step/sleeping.h"

#include <algorithm>

#include "world/joints.h"
#include "world/sleep.h"
#include "world/soft_touch.h"

namespace avbd {

namespace {

void saveJoint(const WorldData& world, StepData& step, uint32_t slot) {
  step.jointsBefore.save(slot, world.joints[slot]);
  if (isD6(world.joints[slot].type)) step.d6Before.save(slot, world.d6[slot]);
  if (isLink(world.joints[slot].type)) step.linksBefore.save(slot, world.links[slot]);
}

/// An island that a contact wakes: as it is now, for a step that fails and for the events of those that move.
void saveIsland(const WorldData& world, StepData& step, uint32_t index) {
  const SleepingIsland& island = world.sleep.islands[index];
  step.wokenIslands.push_back(index);
  for (const uint32_t slot : island.bodies) {
    step.bodiesBefore.save(slot, world.bodies[slot]);
    if (world.def.moveEvents) step.posesBefore[slot] = {world.bodies[slot].position, world.bodies[slot].rotation};
  }
  if (world.def.substeps > 1)
    for (const uint32_t slot : island.joints) saveJoint(world, step, slot);
}

void wakeSide(WorldData& world, StepData& step, uint32_t body) {
  if (!isDynamic(world, body) || isAwake(world, body)) return;
  saveIsland(world, step, world.bodies[body].sleepIsland);
  wakeIsland(world, world.bodies[body].sleepIsland);
}

/// The pairs of islands from step.wokenIslands[begin] on return to the list, as they are at the start of a step.
void listWoken(WorldData& world, StepData& step, size_t begin) {
  std::vector<uint64_t>& keys = step.newKeys;
  keys.clear();
  for (size_t i = begin; i < step.wokenIslands.size(); ++i)
    for (const PairData& pair : world.sleep.islands[step.wokenIslands[i]].pairs) keys.push_back(pair.key());
  std::sort(keys.begin(), keys.end());
  returnWoken(world, true);
  updateAwake(world);
  auto next = keys.begin();
  for (uint32_t i = 0; i < world.pairs.size() && next != keys.end(); ++i) {
    PairData& pair = world.pairs[i];
    if (pair.patch != 0) continue;
    while (next != keys.end() && *next < pair.key()) ++next;
    if (next == keys.end() || *next != pair.key()) continue;
    pair.touching = pair.touchBegins = false;
    step.wokenPairs.push_back(i);
  }
}

/// Whether a kinematic body may pass through the other in one step, so that it has to be awake to be taken along.
bool maySweep(const WorldData& world, const StepData& step, const FoundContact& pair) {
  if (!pair.hasKinematic()) return false;
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const bool isA = pair.typeA == BodyType::Kinematic;
  const BodyData &moves = isA ? a : b, &rests = isA ? b : a;
  const float way = (length(moves.linearVelocity) + length(moves.angularVelocity) * moves.radius) * step.h;
  return way > rests.minExtent;
}

}  // namespace

bool wakeTouched(WorldData& world, StepData& step) {
  step.wokenPairs.clear();
  if (world.sleep.asleep == 0) return false;
  const size_t before = step.wokenIslands.size();
  for (const FoundContact& found : step.found) {
    if (found.points == 0 && !maySweep(world, step, found)) continue;
    wakeSide(world, step, found.bodyA);
    wakeSide(world, step, found.bodyB);
  }
  for (const FoundTouch& found : step.softTouches) {
    if (!found.awake) continue;
    wakeSide(world, step, bodyOfFirst(world, found.touch));
    wakeSide(world, step, bodyOfSecond(world, found.touch));
  }
  if (step.wokenIslands.size() == before) return false;
  listWoken(world, step, before);
  return !step.wokenPairs.empty();
}

void rememberAwake(const WorldData& world, StepData& step) {
  step.bodiesBefore.count = step.jointsBefore.count = step.d6Before.count = step.linksBefore.count = 0;
  step.wokenIslands.clear();
  if (world.def.substeps == 1) return;
  step.softTouchesBefore = world.softTouches;
  step.softMemoryBefore.resize(world.softs.size());
  for (size_t i = 0; i < world.softs.size(); ++i) step.softMemoryBefore[i] = world.softs[i].memory;
  for (const uint32_t slot : world.sleep.awake) step.bodiesBefore.save(slot, world.bodies[slot]);
  for (const uint32_t slot : world.sleep.joints) saveJoint(world, step, slot);
}

void restoreAwake(WorldData& world, StepData& step) {
  if (world.def.substeps > 1) {
    world.softTouches = step.softTouchesBefore;
    for (size_t i = 0; i < world.softs.size(); ++i) world.softs[i].memory = step.softMemoryBefore[i];
  }
  step.bodiesBefore.restore(world.bodies);
  step.jointsBefore.restore(world.joints);
  step.d6Before.restore(world.d6);
  step.linksBefore.restore(world.links);
  for (const uint32_t i : step.wokenIslands)
    world.sleep.asleep += static_cast<uint32_t>(world.sleep.islands[i].bodies.size());
}

void restoreSleepers(WorldData& world, StepData& step) {
  if (step.wokenIslands.empty()) return;
  step.wokenIslands.clear();
  storeAsleep(world, false);
}

namespace {

/// Kinematic bodies that have stopped leave the list.
bool stopKinematic(WorldData& world, const StepData& step) {
  bool any = false;
  for (const uint32_t slot : step.kinematic) {
    BodyData& body = world.bodies[slot];
    body.asleep = !hasVelocity(body);
    any = any || body.asleep;
  }
  return any;
}

void tellSleep(WorldData& world) {
  std::vector<uint32_t>& changed = world.sleep.changed;
  world.events.sleeps.clear(), world.events.wakes.clear();
  std::sort(changed.begin(), changed.end());
  for (const uint32_t slot : changed) {
    BodyData& body = world.bodies[slot];
    if (!world.bodyIds.isAliveSlot(slot) || body.type != BodyType::Dynamic || body.asleep == body.toldAsleep) continue;
    body.toldAsleep = body.asleep;
    (body.asleep ? world.events.sleeps : world.events.wakes).push_back(world.bodyIds.id(slot));
  }
  changed.clear();
}

}  // namespace

void settle(WorldData& world, StepData& step) {
  for (const uint32_t i : step.wokenIslands) freeIsland(world, i);
  step.wokenIslands.clear();
  for (size_t i = 0; i < step.stillTime.size(); ++i) world.bodies[step.order[i]].stillTime = step.stillTime[i];
  for (const uint32_t i : step.falling) {
    const Island& island = step.islands[i];
    sleepTogether(world, {step.order.data() + island.bodyBegin, island.bodyCount});
  }
  if (stopKinematic(world, step) || !step.falling.empty()) storeAsleep(world, true);
  tellSleep(world);
  world.report.asleep = world.sleep.asleep;
}

}  // namespace avbd
