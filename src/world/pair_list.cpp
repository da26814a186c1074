// Pairs in order (pair_list.h).
#include "world/pair_list.h"

#include <algorithm>

namespace avbd {

size_t PairList::lowerBound(uint64_t key) const {
  const auto at = std::lower_bound(order_.begin(), order_.end(), key,
                                   [](const Entry& entry, uint64_t value) { return entry.key < value; });
  return static_cast<size_t>(at - order_.begin());
}

void PairList::clear() {
  order_.clear();
  records_.resize(0);
  free_.clear();
  strayed_ = 0;
}

/// Gives fresh_ as many entries, each with a record of its own. Returns how many records there have to be then.
size_t PairList::takeRecords(size_t count) {
  fresh_.resize(count);
  const size_t old = std::min(count, free_.size()), had = records_.size();
  for (size_t i = 0; i < old; ++i) fresh_[i].record = free_[free_.size() - 1 - i];
  free_.resize(free_.size() - old);
  for (size_t i = old; i < count; ++i) fresh_[i].record = static_cast<uint32_t>(had + i - old);
  return had + count - old;
}

void PairList::insert(std::span<const PairData> pairs) {
  records_.resize(takeRecords(pairs.size()));
  for (size_t i = 0; i < pairs.size(); ++i) {
    const uint32_t record = fresh_[i].record;
    records_[record] = pairs[i];
    fresh_[i] = entryOf(pairs[i], record);
  }
  add(fresh_);
}

void PairList::add(std::span<const Entry> entries) {
  const bool atEnd = entries.empty() || order_.empty() || order_.back().key <= entries[0].key;
  if (!atEnd || !free_.empty()) strayed_ += entries.size();
  insertSorted(
      order_, entries.size(), [&](const Entry& entry, size_t i) { return entry.key > entries[i].key; },
      [&](size_t i) { return entries[i]; });
}

void PairList::erase(std::span<const uint32_t> places) {
  if (places.empty()) return;
  size_t size = places[0];
  for (size_t k = 0; k < places.size(); ++k) {
    free_.push_back(order_[places[k]].record);
    const size_t next = k + 1 < places.size() ? places[k + 1] : order_.size();
    std::copy(order_.begin() + places[k] + 1, order_.begin() + static_cast<std::ptrdiff_t>(next),
              order_.begin() + static_cast<std::ptrdiff_t>(size));
    size += next - places[k] - 1;
  }
  order_.resize(size);
}

void PairList::sortStrayed(Jobs& jobs) {
  if (strayed_ <= order_.size() / kMostStrayed) return;
  spare_.resize(order_.size(), jobs);
  jobs.forRange(static_cast<uint32_t>(order_.size()), 256, [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i) {
      prefetch(i + kAhead);
      spare_[i] = records_[order_[i].record];
    }
  });
  for (uint32_t i = 0; i < order_.size(); ++i) order_[i].record = i;
  records_.swap(spare_);
  spare_.resize(0);  // so that a copy of the list has each record once
  free_.clear();
  strayed_ = 0;
}

}  // namespace avbd
