// The pairs of a world in the order of their keys. What moves when pairs come and go are the entries of the order, 16
// bytes each; the records, half a kilobyte each, stay where they are until so many are out of order that walking the
// list would wait for memory: then all are put in order at once.
#pragma once

#include <avbd/rows/real.h>

#include <cstddef>
#include <iterator>
#include <span>
#include <type_traits>
#include <vector>

#include "base/insert_sorted.h"
#include "base/jobs.h"
#include "world/pair_records.h"

namespace avbd {

class PairList {
  template <class List>
  class Iterator;

 public:
  using iterator = Iterator<PairList>;
  using const_iterator = Iterator<const PairList>;

  size_t size() const { return order_.size(); }
  bool empty() const { return order_.empty(); }
  /// A record stays valid until pairs are taken out or put in order.
  PairData& operator[](size_t i) { return records_[order_[i].record]; }
  const PairData& operator[](size_t i) const { return records_[order_[i].record]; }
  inline iterator begin();
  inline iterator end();
  inline const_iterator begin() const;
  inline const_iterator end() const;

  // What is known of a pair without its record.
  uint64_t key(size_t i) const { return order_[i].key; }
  uint32_t shapeA(size_t i) const { return static_cast<uint32_t>(key(i) >> 32); }
  uint32_t shapeB(size_t i) const { return static_cast<uint32_t>(key(i)); }
  /// Two convex shapes, or one and a half space, that are no triggers.
  bool isConvex(size_t i) const { return order_[i].isConvex; }

  /// How many pairs before it is worked at a record is asked for.
  static constexpr size_t kAhead = 4;
  /// Asks for a record before it is needed, as the order in which they lie is not that of the list: all of it, or of a
  /// pair that did not touch the first lines. There need not be one. Inline always: g++ drops calls of a function
  /// that does nothing else.
  AVBD_INLINE void prefetch(size_t i) const {
    if (i >= size()) return;
    const char* record = reinterpret_cast<const char*>(&(*this)[i]);
    const size_t size = order_[i].touches ? sizeof(PairData) : kLinesApart * kCacheLine;
    for (size_t line = 0; line < size; line += kCacheLine) __builtin_prefetch(record + line, 1);
  }
  /// Whether it has points now, for prefetch().
  void setTouches(size_t i, bool touches) {
    if (order_[i].touches != touches) order_[i].touches = touches;
  }

  /// The first pair whose key is not below this one.
  size_t lowerBound(uint64_t key) const;
  /// Behind the last of the pair's run.
  size_t endOfRun(size_t i) const {
    size_t end = i + 1;
    while (end < size() && key(end) == key(i)) ++end;
    return end;
  }

  void clear();
  /// Becomes `count` pairs: fill(pair) makes each, in order, out of one that may have been another.
  template <class Fill>
  void assign(size_t count, Fill&& fill);
  /// New pairs, ascending by key, to their places: behind those of the same key.
  void insert(std::span<const PairData> pairs);
  /// New pairs of these keys, ascending, none of which is there yet: fill(pair, key) makes each out of a fresh one, on
  /// any thread of the jobs.
  template <class Fill>
  void insert(std::span<const uint64_t> keys, Fill&& fill, Jobs& jobs);
  /// Takes out the pairs of which is(i) holds. It is asked once for each in order, and finds all in place.
  template <class Is>
  void eraseIf(Is&& is);
  /// Takes out the pairs at these places, which ascend.
  void erase(std::span<const uint32_t> places);
  /// Puts the records in order where too many are out of it.
  void sortStrayed(Jobs& jobs);

 private:
  static constexpr size_t kCacheLine = 64, kLinesApart = 2;
  static constexpr size_t kMostStrayed = 5;  ///< as a divisor of the number of pairs
  struct Entry {
    uint64_t key;
    uint32_t record;
    bool isConvex, touches;
  };
  static Entry entryOf(const PairData& pair, uint32_t record) {
    return {pair.key(), record, !pair.isTrigger && !pair.hasSurface, pair.pointCount > 0};
  }
  size_t takeRecords(size_t count);
  void add(std::span<const Entry> entries);

  std::vector<Entry> order_;
  PairRecords records_, spare_;
  std::vector<uint32_t> free_;  ///< of the records
  std::vector<Entry> fresh_;
  std::vector<uint32_t> gone_;  ///< places
  size_t strayed_ = 0;          ///< how many records were taken out of order
};

template <class Fill>
void PairList::assign(size_t count, Fill&& fill) {
  free_.clear();
  strayed_ = 0;
  records_.resize(count);
  order_.resize(count);
  for (uint32_t i = 0; i < count; ++i) {
    fill(records_[i]);
    order_[i] = entryOf(records_[i], i);
  }
}

template <class Fill>
void PairList::insert(std::span<const uint64_t> keys, Fill&& fill, Jobs& jobs) {
  records_.resize(takeRecords(keys.size()), jobs);
  jobs.forRange(static_cast<uint32_t>(keys.size()), 64, [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t record = fresh_[i].record;
      records_[record] = PairData{};
      fill(records_[record], keys[i]);
      fresh_[i] = entryOf(records_[record], record);
    }
  });
  add(fresh_);
}

template <class List>
class PairList::Iterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = PairData;
  using difference_type = std::ptrdiff_t;
  using reference = std::conditional_t<std::is_const_v<List>, const PairData&, PairData&>;
  using pointer = std::remove_reference_t<reference>*;

  Iterator() = default;
  Iterator(List* list, size_t at) : list_(list), at_(at) {}
  reference operator*() const { return (*list_)[at_]; }
  pointer operator->() const { return &(*list_)[at_]; }
  Iterator& operator++() { return ++at_, *this; }
  bool operator==(const Iterator& other) const { return at_ == other.at_; }

 private:
  List* list_ = nullptr;
  size_t at_ = 0;
};

PairList::iterator PairList::begin() { return {this, 0}; }
PairList::iterator PairList::end() { return {this, size()}; }
PairList::const_iterator PairList::begin() const { return {this, 0}; }
PairList::const_iterator PairList::end() const { return {this, size()}; }

template <class Is>
void PairList::eraseIf(Is&& is) {
  gone_.clear();
  for (uint32_t i = 0; i < order_.size(); ++i)
    if (is(i)) gone_.push_back(i);
  erase(gone_);
}

}  // namespace avbd
