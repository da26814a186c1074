#include "world/pair_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace avbd {
namespace {

PairData pairOf(uint64_t key, uint16_t patch = 0) {
  PairData pair;
  pair.shapeA = static_cast<uint32_t>(key >> 32), pair.shapeB = static_cast<uint32_t>(key);
  pair.patch = patch;
  return pair;
}

/// What a record says: its key, and a mark that follows it about.
using Marked = std::pair<uint64_t, uint32_t>;

std::vector<Marked> contentOf(const PairList& list) {
  std::vector<Marked> content;
  for (const PairData& pair : list) content.emplace_back(pair.key(), pair.element);
  return content;
}

TEST(PairList, KeepsOrderAndRecordsWhateverComesAndGoes) {
  std::mt19937 random{3};
  Jobs jobs(1, {});
  PairList list;
  std::vector<Marked> model;
  uint32_t mark = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<uint64_t> keys;
    for (size_t n = random() % (round < 20 ? 200 : 12); n > 0; --n) {
      const uint64_t key = uint64_t(random() % 100) << 32 | (100 + random() % 100);
      const auto sameKey = [&](const Marked& m) { return m.first == key; };
      if (std::none_of(model.begin(), model.end(), sameKey)) keys.push_back(key);
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    list.insert(
        keys,
        [&](PairData& pair, uint64_t key) {
          EXPECT_EQ(pair.element, kNoElement) << "a fresh one";
          pair = pairOf(key);
          pair.element = ++mark;
          model.emplace_back(key, mark);
        },
        jobs);
    std::sort(model.begin(), model.end());
    ASSERT_EQ(contentOf(list), model);
    list.sortStrayed(jobs);
    ASSERT_EQ(contentOf(list), model);
    ASSERT_EQ(contentOf(PairList(list)), model);
    const uint32_t gone = random() % 17;
    if (round % 2 == 0) {
      list.eraseIf([&](size_t i) { return list[i].element % 17 == gone; });
    } else {
      std::vector<uint32_t> places;
      for (uint32_t i = 0; i < list.size(); ++i)
        if (list[i].element % 17 == gone) places.push_back(i);
      list.erase(places);
    }
    std::erase_if(model, [&](const Marked& m) { return m.second % 17 == gone; });
    ASSERT_EQ(contentOf(list), model);
    for (size_t i = 0; i < list.size(); ++i) ASSERT_EQ(list.key(i), list[i].key());
  }
  EXPECT_GT(model.size(), 20u);
}

TEST(PairList, ARunStaysTogetherAndGrowsAtItsEnd) {
  PairList list;
  list.insert(std::vector{pairOf(2), pairOf(4), pairOf(6)});
  const PairData more[] = {pairOf(4, 1), pairOf(4, 2), pairOf(5)};
  list.insert(more);
  std::vector<std::pair<uint32_t, uint16_t>> seen;
  for (const PairData& pair : list) seen.emplace_back(pair.shapeB, pair.patch);
  EXPECT_EQ(seen, (std::vector<std::pair<uint32_t, uint16_t>>{{2, 0}, {4, 0}, {4, 1}, {4, 2}, {5, 0}, {6, 0}}));
  EXPECT_EQ(list.lowerBound(4), 1u);
  EXPECT_EQ(list.lowerBound(3), 1u);
  EXPECT_EQ(list.lowerBound(7), list.size());
  EXPECT_EQ(list.endOfRun(1), 4u);
  EXPECT_EQ(list.endOfRun(5), 6u);
}

TEST(PairList, EraseIfFindsAllFromItsPlaceOn) {
  PairList list;
  list.insert(std::vector{pairOf(9)});
  uint64_t shapeB = 0;
  list.assign(8, [&](PairData& pair) { pair = pairOf(++shapeB); });
  list.eraseIf([&](size_t i) {
    EXPECT_EQ(list.size(), 8u);
    EXPECT_EQ(list[7].shapeB, 8u);
    EXPECT_EQ(list[i].shapeB, i + 1);
    return i % 2 == 0;
  });
  EXPECT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0].shapeB, 2u);
  list.clear();
  EXPECT_TRUE(list.empty());
  list.prefetch(0);
}

TEST(PairList, KnowsWhatIsNeitherTriggerNorSurface) {
  PairList list;
  PairData trigger = pairOf(1), surface = pairOf(2);
  trigger.isTrigger = true, surface.hasSurface = true;
  list.insert(std::vector{trigger, surface, pairOf(3)});
  EXPECT_FALSE(list.isConvex(0));
  EXPECT_FALSE(list.isConvex(1));
  EXPECT_TRUE(list.isConvex(2));
}

}  // namespace
}  // namespace avbd
