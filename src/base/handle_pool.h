// Which slots of a table are in use, and the ids that name them.
#pragma once

#include <avbd/id.h>

#include <cstddef>
#include <limits>
#include <vector>

#include "base/assert.h"

namespace avbd {

/// Plain relocatable data: a copy is a snapshot. The same calls in the same order give the same ids: a freed slot is
/// the next one taken. Slots are 0-based and index the caller's own arrays; an id holds slot + 1.
template <class Tag>
class HandlePool {
 public:
  Id<Tag> create() {
    uint32_t slot;
    if (free_.empty()) {
      slot = static_cast<uint32_t>(generations_.size());
      generations_.push_back(1);
      alive_.push_back(1);
    } else {
      slot = free_.back();
      free_.pop_back();
      alive_[slot] = 1;
    }
    ++count_;
    return id(slot);
  }

  /// Does nothing and returns false if the id is null, stale or not from this pool.
  bool destroy(Id<Tag> id) {
    if (!isAlive(id)) return false;
    const uint32_t slot = id.index - 1;
    alive_[slot] = 0;
    --count_;
    // A slot whose generations are used up is never taken again, so that no old id comes back to life.
    if (++generations_[slot] != std::numeric_limits<uint32_t>::max()) free_.push_back(slot);
    return true;
  }

  bool isAlive(Id<Tag> id) const {
    return id.index != 0 && id.index <= generations_.size() && generations_[id.index - 1] == id.generation &&
           alive_[id.index - 1] != 0;
  }
  bool isAliveSlot(uint32_t slot) const { return slot < alive_.size() && alive_[slot] != 0; }

  /// Index into the caller's arrays of a live id.
  uint32_t slot(Id<Tag> id) const {
    AVBD_ASSERT(isAlive(id));
    return id.index - 1;
  }
  /// Id that a slot has now.
  Id<Tag> id(uint32_t slot) const {
    AVBD_ASSERT(slot < generations_.size());
    return {slot + 1, generations_[slot]};
  }

  size_t count() const { return count_; }  ///< alive
  /// Slots ever taken: the size that the caller's arrays need.
  size_t slotCount() const { return generations_.size(); }

  /// What it was made of: with freeSlots() all that makes it again.
  const std::vector<uint32_t>& generations() const { return generations_; }
  const std::vector<uint32_t>& freeSlots() const { return free_; }  ///< the next one taken at the end
  /// Becomes a pool of these lists, of which it takes the memory. False where they make none: it must then not be used.
  bool restore(std::vector<uint32_t>& generations, std::vector<uint32_t>& freeSlots) {
    generations_.swap(generations);
    free_.swap(freeSlots);
    alive_.assign(generations_.size(), 1);
    for (const uint32_t slot : free_) {
      if (slot >= alive_.size() || !alive_[slot]) return false;
      alive_[slot] = 0;
    }
    // One whose generations are used up is neither alive nor free.
    constexpr uint32_t kUsedUp = std::numeric_limits<uint32_t>::max();
    count_ = 0;
    for (uint32_t slot = 0; slot < alive_.size(); ++slot) {
      const bool free = !alive_[slot];
      if (generations_[slot] == 0 || (free && generations_[slot] == kUsedUp)) return false;
      alive_[slot] = !free && generations_[slot] != kUsedUp;
      count_ += alive_[slot];
    }
    return true;
  }

  /// Calls f(slot) for all live slots in ascending order.
  template <class F>
  void forEach(F&& f) const {
    for (uint32_t slot = 0; slot < alive_.size(); ++slot) {
      if (alive_[slot]) f(slot);
    }
  }

 private:
  std::vector<uint32_t> generations_;  ///< of the id that the slot has, or will have next
  std::vector<uint8_t> alive_;
  std::vector<uint32_t> free_;  ///< last freed at the end
  size_t count_ = 0;
};

}  // namespace avbd
