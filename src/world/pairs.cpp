// Filters, exclusions and the list of shapes to pair anew (pairs.h).
#include "world/pairs.h"

#include <algorithm>

namespace avbd {
namespace {

uint64_t bodyPair(uint32_t a, uint32_t b) {
  const uint64_t low = std::min(a, b), high = std::max(a, b);
  return low << 32 | high;
}

}  // namespace

bool filtersMeet(const Filter& a, const Filter& b) {
  if (a.group != 0 && a.group == b.group) return a.group > 0;
  const bool aSeesB = (b.category & a.mask) != 0, bSeesA = (a.category & b.mask) != 0;
  return a.anyMask && b.anyMask ? aSeesB || bSeesA : aSeesB && bSeesA;
}

bool mayTouch(const WorldData& data, uint32_t shapeA, uint32_t shapeB) {
  const ShapeData &a = data.shapes[shapeA], &b = data.shapes[shapeB];
  if (a.body == b.body) return false;
  const bool anyDynamic =
      data.bodies[a.body].type == BodyType::Dynamic || data.bodies[b.body].type == BodyType::Dynamic;
  return anyDynamic && filtersMeet(a.filter, b.filter) && !isExcluded(data, a.body, b.body);
}

void erasePairsOfBody(WorldData& data, uint32_t body) {
  std::erase_if(data.pairs, [=](const PairData& pair) { return pair.bodyA == body || pair.bodyB == body; });
}

void erasePairsOfShape(WorldData& data, uint32_t shape) {
  std::erase_if(data.pairs, [=](const PairData& pair) { return pair.shapeA == shape || pair.shapeB == shape; });
}

void erasePairsBetween(WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  std::erase_if(data.pairs, [=](const PairData& pair) {
    return (pair.bodyA == bodyA && pair.bodyB == bodyB) || (pair.bodyA == bodyB && pair.bodyB == bodyA);
  });
}

void markUnpaired(WorldData& data, uint32_t shape) {
  const auto at = std::lower_bound(data.unpaired.begin(), data.unpaired.end(), shape);
  if (at == data.unpaired.end() || *at != shape) data.unpaired.insert(at, shape);
}

void markBodyUnpaired(WorldData& data, uint32_t body) {
  for (uint32_t s = data.bodies[body].firstShape; s != kNone; s = data.shapes[s].next) markUnpaired(data, s);
}

void unmarkUnpaired(WorldData& data, uint32_t shape) {
  const auto at = std::lower_bound(data.unpaired.begin(), data.unpaired.end(), shape);
  if (at != data.unpaired.end() && *at == shape) data.unpaired.erase(at);
}

void exclude(WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  const uint64_t pair = bodyPair(bodyA, bodyB);
  data.excludedPairs.insert(std::upper_bound(data.excludedPairs.begin(), data.excludedPairs.end(), pair), pair);
  erasePairsBetween(data, bodyA, bodyB);
}

void endExclusion(WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  const uint64_t pair = bodyPair(bodyA, bodyB);
  const auto at = std::lower_bound(data.excludedPairs.begin(), data.excludedPairs.end(), pair);
  AVBD_ASSERT(at != data.excludedPairs.end() && *at == pair);
  data.excludedPairs.erase(at);
  if (isExcluded(data, bodyA, bodyB)) return;
  markBodyUnpaired(data, bodyA);
  markBodyUnpaired(data, bodyB);
}

void endExclusionsOf(WorldData& data, uint32_t body) {
  std::erase_if(data.excludedPairs, [=](uint64_t pair) { return pair >> 32 == body || (pair & 0xffffffffu) == body; });
}

bool isExcluded(const WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  return std::binary_search(data.excludedPairs.begin(), data.excludedPairs.end(), bodyPair(bodyA, bodyB));
}

}  // namespace avbd
