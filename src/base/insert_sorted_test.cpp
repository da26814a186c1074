#include "base/insert_sorted.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace avbd {
namespace {

using Entry = std::pair<int, int>;  // key, and a mark that follows it about

TEST(InsertSorted, PutsThingsBehindThoseOfTheSameKey) {
  std::mt19937 random{5};
  for (int round = 0; round < 300; ++round) {
    const auto some = [&](int mark) {
      std::vector<Entry> entries(random() % 30);
      for (Entry& entry : entries) entry = {static_cast<int>(random() % 20), mark++};
      std::stable_sort(entries.begin(), entries.end(), [](Entry a, Entry b) { return a.first < b.first; });
      return entries;
    };
    std::vector<Entry> list = some(0);
    const std::vector<Entry> fresh = some(100);
    std::vector<Entry> expected = list;
    expected.insert(expected.end(), fresh.begin(), fresh.end());
    std::stable_sort(expected.begin(), expected.end(), [](Entry a, Entry b) { return a.first < b.first; });
    insertSorted(
        list, fresh.size(), [&](const Entry& entry, size_t i) { return entry.first > fresh[i].first; },
        [&](size_t i) { return fresh[i]; });
    ASSERT_EQ(list, expected);
  }
}

}  // namespace
}  // namespace avbd
