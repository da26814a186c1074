// Filters, exclusions and the list of shapes to pair anew (pairs.h).
#include "world/pairs.h"

#include <algorithm>

#include "world/sleep.h"

namespace avbd {

bool filtersMeet(const Filter& a, const Filter& b) {
  if (a.group != 0 && a.group == b.group) return a.group > 0;
  const bool aSeesB = (b.category & a.mask) != 0, bSeesA = (a.category & b.mask) != 0;
  return a.anyMask && b.anyMask ? aSeesB || bSeesA : aSeesB && bSeesA;
}

bool mayTouch(const WorldData& data, uint32_t shapeA, uint32_t shapeB) {
  const ShapeData &a = data.shapes[shapeA], &b = data.shapes[shapeB];
  // Points of soft bodies touch faces of others (step/soft_touches.h).
  if (a.body == b.body || (isParticle(data, a.body) && isParticle(data, b.body))) return false;
  const BodyType typeA = data.bodies[a.body].type, typeB = data.bodies[b.body].type;
  if (a.isTrigger || b.isTrigger) {
    if (a.isTrigger && b.isTrigger) return false;
    if ((a.isTrigger ? typeB : typeA) == BodyType::Static) return false;
  } else if (typeA != BodyType::Dynamic && typeB != BodyType::Dynamic) {
    return false;
  }
  if (!isConvex(a.geom.type) && !isConvex(b.geom.type)) return false;
  return filtersMeet(a.filter, b.filter) && !isExcluded(data, a.body, b.body);
}

namespace {

void readWishes(const WorldData& data, PairData& pair) {
  const ShapeData &a = data.shapes[pair.shapeA], &b = data.shapes[pair.shapeB];
  const bool ofSoft = isParticle(data, pair.bodyA) || isParticle(data, pair.bodyB);
  pair.reports = !ofSoft && (pair.isTrigger || (a.contactEvents && b.contactEvents));
  pair.wantsHits = a.hitEvents || b.hitEvents;
  pair.hasHook = a.contactHook || b.contactHook;
}

}  // namespace

void beginPair(const WorldData& data, PairData& pair, uint64_t key) {
  pair.shapeA = static_cast<uint32_t>(key >> 32);
  pair.shapeB = static_cast<uint32_t>(key);
  const ShapeData &a = data.shapes[pair.shapeA], &b = data.shapes[pair.shapeB];
  pair.bodyA = a.body;
  pair.bodyB = b.body;
  pair.generation[0] = data.shapeIds.id(pair.shapeA).generation;
  pair.generation[1] = data.shapeIds.id(pair.shapeB).generation;
  pair.generation[2] = data.bodyIds.id(pair.bodyA).generation;
  pair.generation[3] = data.bodyIds.id(pair.bodyB).generation;
  pair.hasSurface = isSurface(a.geom.type) || isSurface(b.geom.type);
  pair.isTrigger = a.isTrigger || b.isTrigger;
  pair.triggerIsA = a.isTrigger;
  readWishes(data, pair);
}

namespace {

LostTouch lostTouch(const WorldData& data, size_t index) {
  const PairData& head = data.pairs[index];
  LostTouch lost;
  for (int side = 0; side < 2; ++side) lost.shape[side] = head.shapeId(side), lost.body[side] = head.bodyId(side);
  lost.isTrigger = head.isTrigger, lost.triggerIsA = head.triggerIsA;
  lost.reports = head.reports;
  lost.wasTouching = head.wasTouching;
  const TouchPlace place = lastPlace(data, index);
  lost.position = place.position, lost.normal = place.normal;
  return lost;
}

}  // namespace

TouchPlace lastPlace(const WorldData& data, size_t head) {
  for (size_t i = head, end = data.pairs.endOfRun(head); i < end; ++i) {
    const PairData& pair = data.pairs[i];
    if (pair.manifold.normal != Vec3{}) return {pair.origin + pair.manifold.points[0].position, pair.manifold.normal};
  }
  return {};
}

void loseTouch(WorldData& data, size_t index, bool inStep) {
  const PairData& pair = data.pairs[index];
  const bool touched = inStep && pair.touching;
  if (pair.patch != 0 || (!pair.wasTouching && !touched)) return;
  data.lostTouches.push_back(lostTouch(data, index));
  data.lostTouches.back().touched = touched;
}

void updateWishes(WorldData& data) {
  if (!data.wishesChanged) return;
  data.wishesChanged = false;
  for (size_t i = 0; i < data.pairs.size(); ++i) {
    PairData& pair = data.pairs[i];
    // The slot may be another shape's by now.
    if (!data.shapeIds.isAlive(pair.shapeId(0)) || !data.shapeIds.isAlive(pair.shapeId(1))) continue;
    const bool reported = pair.reports;
    readWishes(data, pair);
    if (pair.reports == reported) continue;
    if (reported && pair.wasTouching) {
      data.lostTouches.push_back(lostTouch(data, i));
      data.lostTouches.back().reports = data.lostTouches.back().unwanted = true;
    }
    if (!reported) pair.wasTouching = false;
  }
}

size_t findPair(const WorldData& data, uint64_t key) {
  const size_t at = data.pairs.lowerBound(key), none = data.pairs.size();
  return at < none && data.pairs.key(at) == key ? at : none;
}

namespace {

// The lists of slots are ascending and hold each once, in whatever order the user goes.
void insertSlot(std::vector<uint32_t>& slots, uint32_t slot) {
  const auto at = std::lower_bound(slots.begin(), slots.end(), slot);
  if (at == slots.end() || *at != slot) slots.insert(at, slot);
}

void eraseSlot(std::vector<uint32_t>& slots, uint32_t slot) {
  const auto at = std::lower_bound(slots.begin(), slots.end(), slot);
  if (at != slots.end() && *at == slot) slots.erase(at);
}

}  // namespace

void forgetPairsOfShape(WorldData& data, uint32_t shape) {
  if (!data.pairs.empty() || !data.sleep.woken.empty() || !data.softContacts.empty()) insertSlot(data.forgotten, shape);
}

void forgetPairsOfBody(WorldData& data, uint32_t body) {
  for (uint32_t s = data.bodies[body].firstShape; s != kNone; s = data.shapes[s].next) forgetPairsOfShape(data, s);
}

std::vector<const PairData*> sleepingPairs(const WorldData& data) {
  std::vector<const PairData*> pairs;
  for (const SleepingIsland& island : data.sleep.islands)
    for (const PairData& pair : island.pairs) pairs.push_back(&pair);
  std::sort(pairs.begin(), pairs.end(), [](const PairData* x, const PairData* y) {
    return x->key() != y->key() ? x->key() < y->key() : x->patch < y->patch;
  });
  return pairs;
}

bool isForgotten(const WorldData& data, uint32_t shape) {
  return std::binary_search(data.forgotten.begin(), data.forgotten.end(), shape);
}

void dropForgottenPairs(WorldData& data) {
  if (data.forgotten.empty()) return;
  std::vector<bool> forgotten(data.shapes.size());
  for (const uint32_t slot : data.forgotten) forgotten[slot] = true;
  data.pairs.eraseIf([&](size_t i) {
    if (!forgotten[data.pairs.shapeA(i)] && !forgotten[data.pairs.shapeB(i)]) return false;
    loseTouch(data, i, false);
    return true;
  });
  std::erase_if(data.softContacts,
                [&](const SoftContact& contact) { return forgotten[contact.shape[0]] || forgotten[contact.shape[1]]; });
  data.forgotten.clear();
}

void erasePairsBetween(WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  returnWoken(data, false);
  if (data.pairs.empty()) return;
  for (uint32_t a = data.bodies[bodyA].firstShape; a != kNone; a = data.shapes[a].next) {
    for (uint32_t b = data.bodies[bodyB].firstShape; b != kNone; b = data.shapes[b].next) {
      const size_t first = findPair(data, slotPair(a, b));
      if (first == data.pairs.size()) continue;
      loseTouch(data, first, false);
      data.pairs.eraseIf([&](size_t i) { return data.pairs.key(i) == slotPair(a, b); });
    }
  }
}

void markUnpaired(WorldData& data, uint32_t shape) { insertSlot(data.unpaired, shape); }

void markBodyUnpaired(WorldData& data, uint32_t body) {
  for (uint32_t s = data.bodies[body].firstShape; s != kNone; s = data.shapes[s].next) markUnpaired(data, s);
}

void unmarkUnpaired(WorldData& data, uint32_t shape) { eraseSlot(data.unpaired, shape); }

namespace {

void wakeDynamic(WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  for (const uint32_t body : {bodyA, bodyB})
    if (isDynamic(data, body)) wakeBody(data, body);
}

}  // namespace

void exclude(WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  wakeDynamic(data, bodyA, bodyB);
  const uint64_t pair = slotPair(bodyA, bodyB);
  data.excludedPairs.insert(std::upper_bound(data.excludedPairs.begin(), data.excludedPairs.end(), pair), pair);
  erasePairsBetween(data, bodyA, bodyB);
}

void endExclusion(WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  const uint64_t pair = slotPair(bodyA, bodyB);
  const auto at = std::lower_bound(data.excludedPairs.begin(), data.excludedPairs.end(), pair);
  AVBD_ASSERT(at != data.excludedPairs.end() && *at == pair);
  data.excludedPairs.erase(at);
  if (isExcluded(data, bodyA, bodyB)) return;
  wakeDynamic(data, bodyA, bodyB);
  markBodyUnpaired(data, bodyA);
  markBodyUnpaired(data, bodyB);
}

void endExclusionsOf(WorldData& data, uint32_t body) {
  std::erase_if(data.excludedPairs, [=](uint64_t pair) { return pair >> 32 == body || (pair & 0xffffffffu) == body; });
}

bool isExcluded(const WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  return std::binary_search(data.excludedPairs.begin(), data.excludedPairs.end(), slotPair(bodyA, bodyB));
}

size_t exclusionsOf(const WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  const auto [first, last] =
      std::equal_range(data.excludedPairs.begin(), data.excludedPairs.end(), slotPair(bodyA, bodyB));
  return static_cast<size_t>(last - first);
}

}  // namespace avbd
