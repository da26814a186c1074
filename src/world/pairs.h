// Which shapes may touch, and what is forgotten when something is moved, changed or destroyed between steps.
#pragma once

#include <algorithm>

#include "world/world_data.h"

namespace avbd {

/// Groups, categories and masks.
bool filtersMeet(const Filter& a, const Filter& b);
/// Whether a pair of these two shapes may exist: different bodies, one of them dynamic, one of them convex, filters,
/// exclusions. A trigger sees kinematic bodies too, but nothing static and no other trigger.
bool mayTouch(const WorldData& data, uint32_t shapeA, uint32_t shapeB);
/// A fresh pair becomes that of a key.
void beginPair(const WorldData& data, PairData& pair, uint64_t key);
/// Keeps what is needed to report the begin and the end of a touching pair (index) that leaves the list. Of a run: its
/// first entry, with all others still behind it. `inStep`: between substeps, so that `touching` is of this step.
void loseTouch(WorldData& data, size_t pair, bool inStep);
/// Where the shapes of a pair (index; of a run: its first entry) were last near each other.
struct TouchPlace {
  Vec3d position;  ///< of a point between them
  Vec3 normal;
};
TouchPlace lastPlace(const WorldData& data, size_t head);
/// Tells the pairs what their shapes want now (WorldData::wishesChanged).
void updateWishes(WorldData& data);
/// One key of two slots in any order: of two shapes, that of their pair.
inline uint64_t slotPair(uint32_t a, uint32_t b) {
  const uint64_t low = std::min(a, b), high = std::max(a, b);
  return low << 32 | high;
}
/// Index of the pair's first entry in the list, or WorldData::pairs.size().
size_t findPair(const WorldData& data, uint64_t key);

/// The pairs become void at once and leave the list with all others at the next step: closing the gaps one by one would
/// move the whole list for each.
void forgetPairsOfShape(WorldData& data, uint32_t shape);
void forgetPairsOfBody(WorldData& data, uint32_t body);
void dropForgottenPairs(WorldData& data);
/// Calls f(pair) for all pairs that are not void, in order; also those of sleepers.
template <class F>
void forEachPair(const WorldData& data, F&& f);
void erasePairsBetween(WorldData& data, uint32_t bodyA, uint32_t bodyB);

/// The next step looks for all pairs of the shape.
void markUnpaired(WorldData& data, uint32_t shape);
void markBodyUnpaired(WorldData& data, uint32_t body);
void unmarkUnpaired(WorldData& data, uint32_t shape);

/// Counted: a pair excluded twice has to be freed twice.
void exclude(WorldData& data, uint32_t bodyA, uint32_t bodyB);
void endExclusion(WorldData& data, uint32_t bodyA, uint32_t bodyB);
void endExclusionsOf(WorldData& data, uint32_t body);
bool isExcluded(const WorldData& data, uint32_t bodyA, uint32_t bodyB);
size_t exclusionsOf(const WorldData& data, uint32_t bodyA, uint32_t bodyB);  ///< how often the pair is excluded

/// Pairs of sleeping islands, in order.
std::vector<const PairData*> sleepingPairs(const WorldData& data);
/// Whether its pairs are void.
bool isForgotten(const WorldData& data, uint32_t shape);

template <class F>
void forEachPair(const WorldData& data, F&& f) {
  const bool all = data.forgotten.empty();
  const auto visit = [&](const PairData& pair) {
    if (all || (!isForgotten(data, pair.shapeA) && !isForgotten(data, pair.shapeB))) f(pair);
  };
  const std::vector<const PairData*> sleeping = sleepingPairs(data);
  auto next = sleeping.begin();
  for (const PairData& pair : data.pairs) {
    for (; next != sleeping.end() && (*next)->key() < pair.key(); ++next) visit(**next);
    visit(pair);
  }
  for (; next != sleeping.end(); ++next) visit(**next);
}

}  // namespace avbd
