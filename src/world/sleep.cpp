// Sleep between steps (sleep.h).
#include "world/sleep.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/insert_sorted.h"
#include "world/joints.h"
#include "world/pairs.h"
#include "world/soft.h"
#include "world/soft_touch.h"

namespace avbd {
namespace {

/// Adds `fresh` to an ascending list, each once, and forgets it.
void mergeSlots(std::vector<uint32_t>& list, std::vector<uint32_t>& fresh) {
  if (fresh.empty()) return;
  std::sort(fresh.begin(), fresh.end());
  insertSorted(
      list, fresh.size(), [&](uint32_t slot, size_t i) { return slot > fresh[i]; }, [&](size_t i) { return fresh[i]; });
  list.erase(std::unique(list.begin(), list.end()), list.end());
  fresh.clear();
}

void sortUnique(std::vector<uint32_t>& slots) {
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
}

/// Any body of a joint, or kNone, of which `is` holds.
template <class Is>
uint32_t bodyOfJoint(const WorldData& data, uint32_t joint, Is is) {
  uint32_t found = kNone;
  forEachBody(data, joint, [&](uint32_t body) {
    if (found == kNone && body != kNone && is(body)) found = body;
  });
  return found;
}

bool isJointAwake(const WorldData& data, uint32_t joint) {
  return bodyOfJoint(data, joint, [&](uint32_t body) { return isAwake(data, body); }) != kNone;
}

uint32_t takeIsland(WorldData& data) {
  SleepData& sleep = data.sleep;
  if (sleep.free.empty()) {
    sleep.islands.emplace_back();
    return static_cast<uint32_t>(sleep.islands.size() - 1);
  }
  const uint32_t island = sleep.free.back();
  sleep.free.pop_back();
  return island;
}

void wakeSupported(WorldData& data, uint32_t body) {
  SleepData& sleep = data.sleep;
  if (sleep.asleep == 0) return;
  for (uint32_t i = 0; i < sleep.islands.size(); ++i) {
    const SleepingIsland& island = sleep.islands[i];
    if (std::binary_search(island.supports.begin(), island.supports.end(), body)) wakeIsland(data, i);
  }
}

}  // namespace

void enlist(WorldData& data, uint32_t slot) {
  BodyData& body = data.bodies[slot];
  body.asleep = body.type == BodyType::Static || (body.type == BodyType::Kinematic && !hasVelocity(body));
  if (!body.asleep) data.sleep.newAwake.push_back(slot);
}

void wakeIsland(WorldData& data, uint32_t index) {
  SleepData& sleep = data.sleep;
  const SleepingIsland& island = sleep.islands[index];
  if (island.bodies.empty() || data.bodies[island.bodies[0]].sleepIsland != index) return;  // awake already
  for (const uint32_t slot : island.bodies) {
    BodyData& body = data.bodies[slot];
    body.asleep = false, body.sleepIsland = kNone, body.stillTime = 0;
    sleep.newAwake.push_back(slot);
    sleep.changed.push_back(slot);
  }
  sleep.asleep -= static_cast<uint32_t>(island.bodies.size());
  sleep.woken.push_back(index);
}

void wakeBody(WorldData& data, uint32_t body) {
  if (body == kNone) return;
  if (!isDynamic(data, body)) return wakeSupported(data, body);
  if (data.bodies[body].asleep) wakeIsland(data, data.bodies[body].sleepIsland);
  data.bodies[body].stillTime = 0;
}

void wakeJoint(WorldData& data, uint32_t joint) {
  forEachBody(data, joint, [&](uint32_t body) {
    if (isDynamic(data, body)) wakeBody(data, body);
  });
}

void wakeAll(WorldData& data) {
  for (uint32_t i = 0; i < data.sleep.islands.size(); ++i) wakeIsland(data, i);
  for (const auto* list : {&data.sleep.awake, &data.sleep.newAwake})
    for (const uint32_t slot : *list) data.bodies[slot].stillTime = 0;
}

void wakeKinematic(WorldData& data, uint32_t slot) {
  BodyData& body = data.bodies[slot];
  if (!body.asleep || !hasVelocity(body)) return;
  body.asleep = false;
  data.sleep.newAwake.push_back(slot);
  // Pairs with what rests beside it were not kept.
  markBodyUnpaired(data, slot);
  wakeSupported(data, slot);
}

void wakeAround(WorldData& data, uint32_t body) {
  if (data.sleep.asleep == 0) return;
  for (uint32_t s = data.bodies[body].firstShape; s != kNone; s = data.shapes[s].next)
    data.tree.query(data.tree.box(data.shapes[s].proxy), [&](uint32_t other) {
      const uint32_t near = data.shapes[other].body;
      if (isDynamic(data, near) && !isAwake(data, near) && mayTouch(data, s, other)) wakeBody(data, near);
    });
}

void freeIsland(WorldData& data, uint32_t index) {
  SleepingIsland& island = data.sleep.islands[index];
  island.bodies.clear(), island.joints.clear(), island.supports.clear(), island.pairs.clear();
  data.sleep.free.push_back(index);
}

namespace {

/// The pairs of the woken islands go back to the list.
void returnPairs(WorldData& data) {
  std::vector<PairData> back;
  for (const uint32_t i : data.sleep.woken)
    back.insert(back.end(), data.sleep.islands[i].pairs.begin(), data.sleep.islands[i].pairs.end());
  if (data.sleep.woken.size() > 1)
    std::sort(back.begin(), back.end(), [](const PairData& x, const PairData& y) {
      return std::make_tuple(x.key(), x.patch) < std::make_tuple(y.key(), y.patch);
    });
  data.pairs.insert(back);
}

void unpairWoken(WorldData& data) {
  for (const uint32_t i : data.sleep.woken)
    for (const uint32_t body : data.sleep.islands[i].bodies)
      for (uint32_t s = data.bodies[body].firstShape; s != kNone; s = data.shapes[s].next) data.unpaired.push_back(s);
  sortUnique(data.unpaired);
}

}  // namespace

void returnWoken(WorldData& data, bool keep) {
  SleepData& sleep = data.sleep;
  if (sleep.woken.empty()) return;
  returnPairs(data);
  unpairWoken(data);
  for (const uint32_t i : sleep.woken) {
    sleep.newJoints.insert(sleep.newJoints.end(), sleep.islands[i].joints.begin(), sleep.islands[i].joints.end());
    if (!keep) freeIsland(data, i);
  }
  sleep.woken.clear();
}

void updateAwake(WorldData& data) {
  SleepData& sleep = data.sleep;
  returnWoken(data, false);
  mergeSlots(sleep.awake, sleep.newAwake);
  mergeSlots(sleep.joints, sleep.newJoints);
  if (!sleep.stale) return;
  sleep.stale = false;
  std::erase_if(sleep.awake, [&](uint32_t slot) { return !data.bodyIds.isAliveSlot(slot) || !isAwake(data, slot); });
  std::erase_if(sleep.joints,
                [&](uint32_t slot) { return !data.jointIds.isAliveSlot(slot) || !isJointAwake(data, slot); });
}

void sleepTogether(WorldData& data, std::span<const uint32_t> bodies) {
  const uint32_t index = takeIsland(data);
  SleepingIsland& island = data.sleep.islands[index];
  island.bodies.assign(bodies.begin(), bodies.end());
  for (const uint32_t slot : bodies) {
    BodyData& body = data.bodies[slot];
    body.linearVelocity = body.angularVelocity = body.acceleration = body.force = body.torque = {};
    body.asleep = true, body.sleepIsland = index;
    data.sleep.changed.push_back(slot);
  }
  data.sleep.asleep += static_cast<uint32_t>(bodies.size());
  data.sleep.stale = true;
}

namespace {

void addSupport(const WorldData& data, SleepingIsland& island, uint32_t body) {
  if (body == kNone || isDynamic(data, body)) return;
  const auto at = std::lower_bound(island.supports.begin(), island.supports.end(), body);
  if (at == island.supports.end() || *at != body) island.supports.insert(at, body);
}

/// What two different islands have to do with each other, which is a trigger or a touch that has just ended, stays.
void storePairs(WorldData& data, bool keep) {
  PairList& pairs = data.pairs;
  bool stays = true;
  const auto storeRun = [&](size_t i) {
    bool matters = false;
    const size_t end = pairs.endOfRun(i);
    for (size_t k = i; k < end; ++k) matters = matters || pairs[k].pointCount > 0 || pairs[k].wasTouching;
    const uint32_t a = pairs[i].bodyA, b = pairs[i].bodyB;
    const uint32_t islandA = data.bodies[a].sleepIsland, islandB = data.bodies[b].sleepIsland;
    const bool apart = islandA != kNone ? islandB != kNone && islandB != islandA : islandB == kNone;
    stays = isAwake(data, a) || isAwake(data, b) || (matters && apart);
    if (stays || !matters || !keep) return;
    SleepingIsland& island = data.sleep.islands[islandA != kNone ? islandA : islandB];
    for (size_t k = i; k < end; ++k) {
      island.pairs.push_back(pairs[k]);
      // Means are of one step.
      island.pairs.back().mean = kNone, island.pairs.back().gonePoints = 0, island.pairs.back().touchBegins = false;
    }
    addSupport(data, island, a), addSupport(data, island, b);
  };
  pairs.eraseIf([&](size_t i) {
    if (pairs[i].patch == 0) storeRun(i);
    return !stays;
  });
}

void storeJoints(WorldData& data) {
  for (const uint32_t joint : data.sleep.joints) {
    if (!data.jointIds.isAliveSlot(joint) || isJointAwake(data, joint)) continue;
    const uint32_t sleeper = bodyOfJoint(data, joint, [&](uint32_t body) { return isDynamic(data, body); });
    SleepingIsland& island = data.sleep.islands[data.bodies[sleeper].sleepIsland];
    island.joints.push_back(joint);
    if (isD6(data.joints[joint].type))
      std::fill(std::begin(data.d6[joint].force), std::end(data.d6[joint].force), 0.0f);
    if (isLink(data.joints[joint].type)) data.links[joint].force = 0;
    forEachBody(data, joint, [&](uint32_t body) { addSupport(data, island, body); });
  }
}

}  // namespace

void storeAsleep(WorldData& data, bool keep) {
  data.sleep.stale = true;
  storePairs(data, keep);
  if (keep) storeJoints(data);
  updateAwake(data);
}

namespace {

uint32_t rootOf(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

void putToSleep(WorldData& data, uint32_t body) {
  if (data.bodies[body].asleep) return;
  updateAwake(data);
  dropForgottenPairs(data);
  const std::vector<uint32_t>& awake = data.sleep.awake;
  std::vector<uint32_t> parent(awake.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](uint32_t slot) {
    return rootOf(parent, static_cast<uint32_t>(std::lower_bound(awake.begin(), awake.end(), slot) - awake.begin()));
  };
  for (const PairData& pair : data.pairs)
    if (pair.pointCount > 0 && isDynamic(data, pair.bodyA) && isDynamic(data, pair.bodyB))
      parent[root(pair.bodyA)] = root(pair.bodyB);
  for (const uint32_t joint : data.sleep.joints) {
    if (!acts(data, joint)) continue;
    uint32_t first = kNone;
    forEachBody(data, joint, [&](uint32_t other) {
      if (!isDynamic(data, other)) return;
      if (first != kNone) parent[root(first)] = root(other);
      first = other;
    });
  }
  const auto join = [&](uint32_t a, uint32_t b) { parent[root(a)] = root(b); };
  data.softIds.forEach([&](uint32_t slot) {
    const SoftData& soft = data.softs[slot];
    if (!isAsleep(data, soft))
      for (const uint32_t particle : soft.bodies) join(particle, soft.bodies[0]);
  });
  for (const SoftTouch& touch : data.softTouches) {
    const uint32_t a = bodyOfFirst(data, touch), b = bodyOfSecond(data, touch);
    if (isDynamic(data, a) && isAwake(data, a) && isAwake(data, b)) join(a, b);
  }
  std::vector<uint32_t> bodies;
  for (const uint32_t slot : awake)
    if (isDynamic(data, slot) && root(slot) == root(body)) bodies.push_back(slot);
  sleepTogether(data, bodies);
  storeAsleep(data, true);
}

}  // namespace avbd
