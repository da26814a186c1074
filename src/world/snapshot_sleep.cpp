// Snapshots: what is awake and what sleeps, and that it fits together.
#include <algorithm>

#include "world/sleep.h"
#include "world/snapshot_parts.h"

namespace avbd::snapshot {
namespace {

/// All members by name: a new one does not compile before it is here, and coded below if it is state.
template <class Codec, class Sleep>
void codeLists(Codec& codec, Sleep& sleep) {
  auto& [awake, joints, newAwake, newJoints, stale, islands, free, woken, changed, asleep] = sleep;
  list(codec, awake), list(codec, joints), list(codec, newAwake), list(codec, newJoints);
  list(codec, free), list(codec, woken), list(codec, changed);
  codec.put(stale);
  codec.put(asleep);
}

bool ascends(const std::vector<uint32_t>& slots) {
  return std::adjacent_find(slots.begin(), slots.end(), std::greater_equal<>()) == slots.end();
}

void checkBelow(const std::vector<uint32_t>& slots, size_t count) {
  for (const uint32_t slot : slots) require(slot < count, "a list of what there is not");
}

bool isIn(const std::vector<uint32_t>& ascending, uint32_t slot) {
  return std::binary_search(ascending.begin(), ascending.end(), slot);
}

void checkIsland(const WorldData& data, uint32_t index, bool free, bool woken, std::vector<uint8_t>& sleeps) {
  const SleepingIsland& island = data.sleep.islands[index];
  require(free == island.bodies.empty() && !(free && woken), "an island of no body");
  require(!free || (island.joints.empty() && island.supports.empty() && island.pairs.empty()), "a free island");
  require(ascends(island.bodies) && ascends(island.supports), "an island's order");
  checkBelow(island.bodies, data.bodies.size()), checkBelow(island.supports, data.bodies.size());
  checkBelow(island.joints, data.joints.size());
  if (woken) return;
  for (const uint32_t slot : island.bodies) {
    require(data.bodyIds.isAliveSlot(slot) && isDynamic(data, slot), "a sleeper that there is not");
    require(data.bodies[slot].asleep && data.bodies[slot].sleepIsland == index, "a sleeper's island");
    sleeps[slot] = 1;
  }
  for (const uint32_t slot : island.joints) require(data.jointIds.isAliveSlot(slot), "a sleeping joint");
}

}  // namespace

void codeSleep(Writer& out, const WorldData& data, const PairSides& sides) {
  codeLists(out, data.sleep);
  out.number(data.sleep.islands.size());
  for (const SleepingIsland& island : data.sleep.islands) {
    const auto& [bodies, joints, supports, pairs] = island;
    list(out, bodies), list(out, joints), list(out, supports);
    codePairList(out, sides, pairs);
  }
}

void codeSleep(Reader& in, WorldData& data, const PairSides& sides) {
  codeLists(in, data.sleep);
  data.sleep.islands.resize(in.count(4));
  for (SleepingIsland& island : data.sleep.islands) {
    auto& [bodies, joints, supports, pairs] = island;
    list(in, bodies), list(in, joints), list(in, supports);
    checkBelow(bodies, data.bodies.size()), checkBelow(supports, data.bodies.size());
    require(codePairList(in, data, sides, pairs) == 0, "means of a sleeping pair");
  }
}

void checkSleep(const WorldData& data) {
  const SleepData& sleep = data.sleep;
  require(ascends(sleep.awake) && ascends(sleep.joints), "the order of what is awake");
  for (const auto* slots : {&sleep.awake, &sleep.newAwake, &sleep.changed}) checkBelow(*slots, data.bodies.size());
  for (const auto* slots : {&sleep.joints, &sleep.newJoints}) checkBelow(*slots, data.joints.size());
  for (const auto* indices : {&sleep.free, &sleep.woken}) checkBelow(*indices, sleep.islands.size());
  std::vector<uint8_t> sleeps(data.bodies.size());
  std::vector<uint8_t> free(sleep.islands.size()), woken(sleep.islands.size());
  for (const uint32_t i : sleep.free) require(free[i]++ == 0, "an island that is free twice");
  for (const uint32_t i : sleep.woken) require(woken[i]++ == 0, "an island that woke twice");
  for (uint32_t i = 0; i < sleep.islands.size(); ++i) checkIsland(data, i, free[i] != 0, woken[i] != 0, sleeps);
  std::vector<uint32_t> fresh = sleep.newAwake;
  std::sort(fresh.begin(), fresh.end());
  uint32_t asleep = 0;
  data.bodyIds.forEach([&](uint32_t slot) {
    const BodyData& body = data.bodies[slot];
    asleep += sleeps[slot];
    require(body.type != BodyType::Dynamic || (body.asleep ? sleeps[slot] == 1 : sleeps[slot] == 0), "a sleeper");
    require(body.stillTime >= 0, "a time of rest");
    require(body.asleep || isIn(sleep.awake, slot) || isIn(fresh, slot), "a body that no list names");
  });
  require(asleep == sleep.asleep, "the number of sleepers");
  const auto lives = [&](uint32_t slot) { return data.bodyIds.isAliveSlot(slot) && isAwake(data, slot); };
  require(sleep.stale || std::all_of(sleep.awake.begin(), sleep.awake.end(), lives), "what is awake");
  const auto exists = [&](uint32_t slot) { return data.jointIds.isAliveSlot(slot); };
  require(sleep.stale || std::all_of(sleep.joints.begin(), sleep.joints.end(), exists), "which joints are awake");
}

}  // namespace avbd::snapshot
