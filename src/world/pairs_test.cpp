// Filters, counted exclusions, and what is erased and marked.
#include "world/pairs.h"

#include <gtest/gtest.h>

#include "world/bodies.h"

namespace avbd {
namespace {

TEST(Filter, CategoriesAndMasks) {
  const Filter all{}, ghost{.mask = 0}, second{.category = 2, .mask = 2};
  EXPECT_TRUE(filtersMeet(all, all));
  EXPECT_FALSE(filtersMeet(all, ghost));
  EXPECT_FALSE(filtersMeet(ghost, all));
  EXPECT_FALSE(filtersMeet(all, second));
  EXPECT_TRUE(filtersMeet(second, second));
}

TEST(Filter, GroupsComeFirst) {
  const Filter friends{.mask = 0, .group = 3}, strangers{.group = -3}, others{.group = 4};
  EXPECT_TRUE(filtersMeet(friends, friends));
  EXPECT_FALSE(filtersMeet(strangers, strangers));
  EXPECT_FALSE(filtersMeet(friends, others));
  EXPECT_TRUE(filtersMeet(strangers, others));
}

TEST(Filter, AnyMaskNeedsBoth) {
  const Filter seen{.category = 1, .mask = 0, .anyMask = true}, sees{.category = 2, .mask = 1, .anyMask = true};
  EXPECT_TRUE(filtersMeet(seen, sees));
  EXPECT_TRUE(filtersMeet(sees, seen));
  Filter strict = sees;
  strict.anyMask = false;
  EXPECT_FALSE(filtersMeet(seen, strict));
  EXPECT_FALSE(filtersMeet(seen, seen));
}

class Pairs : public testing::Test {
 protected:
  uint32_t make(BodyDef def) {
    const uint32_t slot = addBody(data, def, checkedBody(def, 1));
    return slot;
  }
  void pairUp(uint32_t shapeA, uint32_t shapeB) {
    PairData pair;
    pair.shapeA = shapeA;
    pair.shapeB = shapeB;
    pair.bodyA = data.shapes[shapeA].body;
    pair.bodyB = data.shapes[shapeB].body;
    data.pairs.insert({&pair, 1});
  }
  std::vector<std::pair<uint32_t, uint32_t>> pairs() const {
    std::vector<std::pair<uint32_t, uint32_t>> all;
    for (const PairData& pair : data.pairs) all.push_back({pair.shapeA, pair.shapeB});
    return all;
  }

  WorldData data;
  // Body 0 has shapes 0 and 1, bodies 1 .. 3 have shapes 2 .. 4; body 3 is static.
  uint32_t a = make({.shapes = {{}, {}}});
  uint32_t b = make({.shape = Box{}});
  uint32_t c = make({.shape = Box{}});
  uint32_t ground = make({.type = BodyType::Static, .shape = HalfSpace{}});
};

using List = std::vector<std::pair<uint32_t, uint32_t>>;

TEST_F(Pairs, MayTouch) {
  EXPECT_TRUE(mayTouch(data, 0, 2));
  EXPECT_FALSE(mayTouch(data, 0, 1)) << "same body";
  EXPECT_TRUE(mayTouch(data, 0, 4));
  const uint32_t lift = make({.type = BodyType::Kinematic, .shape = Box{}});
  EXPECT_FALSE(mayTouch(data, 4, data.bodies[lift].firstShape)) << "neither is dynamic";
  exclude(data, b, a);
  EXPECT_FALSE(mayTouch(data, 0, 2));
  EXPECT_FALSE(mayTouch(data, 2, 1));
  EXPECT_TRUE(mayTouch(data, 0, 3));
}

TEST_F(Pairs, ForgottenPairsAreVoidAtOnceAndDroppedInOrder) {
  const auto fill = [&] {
    data.pairs.clear();
    pairUp(0, 2);
    pairUp(0, 4);
    pairUp(1, 3);
    pairUp(2, 3);
    pairUp(2, 4);
  };
  fill();
  forgetPairsOfBody(data, a);
  List seen;
  forEachPair(data, [&](const PairData& pair) { seen.push_back({pair.shapeA, pair.shapeB}); });
  EXPECT_EQ(seen, (List{{2, 3}, {2, 4}}));
  dropForgottenPairs(data);
  EXPECT_EQ(pairs(), (List{{2, 3}, {2, 4}}));
  EXPECT_TRUE(data.forgotten.empty());
  fill();
  forgetPairsOfShape(data, 4);
  forgetPairsOfShape(data, 4);
  EXPECT_EQ(data.forgotten, std::vector<uint32_t>{4});
  dropForgottenPairs(data);
  EXPECT_EQ(pairs(), (List{{0, 2}, {1, 3}, {2, 3}}));
  fill();
  erasePairsBetween(data, c, a);
  EXPECT_EQ(pairs(), (List{{0, 2}, {0, 4}, {2, 3}, {2, 4}}));
  exclude(data, b, c);
  EXPECT_EQ(pairs(), (List{{0, 2}, {0, 4}, {2, 4}}));
}

TEST_F(Pairs, UnpairedIsSortedAndHoldsEachOnce) {
  EXPECT_EQ(data.unpaired, (std::vector<uint32_t>{0, 1, 2, 3, 4}));
  data.unpaired.clear();
  markUnpaired(data, 3);
  markUnpaired(data, 1);
  markUnpaired(data, 3);
  EXPECT_EQ(data.unpaired, (std::vector<uint32_t>{1, 3}));
  markBodyUnpaired(data, a);
  EXPECT_EQ(data.unpaired, (std::vector<uint32_t>{0, 1, 3}));
  unmarkUnpaired(data, 1);
  unmarkUnpaired(data, 2);
  EXPECT_EQ(data.unpaired, (std::vector<uint32_t>{0, 3}));
}

TEST_F(Pairs, ExclusionsAreCounted) {
  exclude(data, a, b);
  exclude(data, b, a);
  exclude(data, a, c);
  data.unpaired.clear();
  endExclusion(data, a, b);
  EXPECT_TRUE(isExcluded(data, a, b));
  EXPECT_TRUE(data.unpaired.empty());
  endExclusion(data, a, b);
  EXPECT_FALSE(isExcluded(data, b, a));
  EXPECT_EQ(data.unpaired, (std::vector<uint32_t>{0, 1, 2})) << "they may meet again";
  exclude(data, b, c);
  endExclusionsOf(data, c);
  EXPECT_TRUE(data.excludedPairs.empty());
}

}  // namespace
}  // namespace avbd
