// Ids are never reused, slots are, and the order of both is fixed.
#include "base/handle_pool.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace avbd {
namespace {

using Pool = HandlePool<struct ThingTag>;
using ThingId = Id<struct ThingTag>;

TEST(HandlePool, StartsEmpty) {
  Pool pool;
  EXPECT_EQ(pool.count(), 0u);
  EXPECT_EQ(pool.slotCount(), 0u);
  EXPECT_FALSE(pool.isAlive(ThingId{}));
  EXPECT_FALSE(pool.isAlive(ThingId{1, 1}));
  EXPECT_FALSE(pool.isAlive(ThingId{0xffffffffu, 0}));
}

TEST(HandlePool, FirstIdsCountUp) {
  Pool pool;
  EXPECT_EQ(pool.create(), (ThingId{1, 1}));
  EXPECT_EQ(pool.create(), (ThingId{2, 1}));
  EXPECT_EQ(pool.slot(ThingId{2, 1}), 1u);
  EXPECT_EQ(pool.id(1), (ThingId{2, 1}));
  EXPECT_EQ(pool.count(), 2u);
}

TEST(HandlePool, DestroyedIdIsDeadForEver) {
  Pool pool;
  const ThingId first = pool.create();
  EXPECT_TRUE(pool.destroy(first));
  EXPECT_FALSE(pool.destroy(first));
  EXPECT_FALSE(pool.isAlive(first));
  // Not even the id that the slot will have next is alive yet.
  EXPECT_FALSE(pool.isAlive(ThingId{1, 2}));
  const ThingId second = pool.create();
  EXPECT_EQ(second, (ThingId{1, 2}));
  EXPECT_TRUE(pool.isAlive(second));
  EXPECT_FALSE(pool.isAlive(first));
}

TEST(HandlePool, LastFreedIsFirstTaken) {
  Pool pool;
  const ThingId a = pool.create(), b = pool.create(), c = pool.create();
  pool.destroy(a);
  pool.destroy(c);
  EXPECT_EQ(pool.create(), (ThingId{3, 2}));
  EXPECT_EQ(pool.create(), (ThingId{1, 2}));
  EXPECT_EQ(pool.create(), (ThingId{4, 1}));
  EXPECT_TRUE(pool.isAlive(b));
}

TEST(HandlePool, ForEachVisitsLiveSlotsInOrder) {
  Pool pool;
  std::vector<ThingId> ids;
  for (int i = 0; i < 5; ++i) ids.push_back(pool.create());
  pool.destroy(ids[3]);
  pool.destroy(ids[0]);
  std::vector<uint32_t> slots;
  pool.forEach([&](uint32_t slot) { slots.push_back(slot); });
  EXPECT_EQ(slots, (std::vector<uint32_t>{1, 2, 4}));
  EXPECT_TRUE(pool.isAliveSlot(4));
  EXPECT_FALSE(pool.isAliveSlot(3));
  EXPECT_FALSE(pool.isAliveSlot(5));
}

TEST(HandlePool, ChurnNeverRepeatsAnIdAndACopyReplays) {
  Pool pool;
  std::mt19937 random(5);
  std::vector<ThingId> live;
  std::set<ThingId> seen;
  for (int i = 0; i < 10000; ++i) {
    if (live.empty() || random() % 2) {
      live.push_back(pool.create());
      EXPECT_TRUE(seen.insert(live.back()).second);
    } else {
      const size_t at = random() % live.size();
      EXPECT_TRUE(pool.destroy(live[at]));
      live.erase(live.begin() + static_cast<std::ptrdiff_t>(at));
    }
    ASSERT_EQ(pool.count(), live.size());
  }
  EXPECT_LT(pool.slotCount(), 1000u);
  Pool copy = pool;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(copy.create(), pool.create());
}

}  // namespace
}  // namespace avbd
