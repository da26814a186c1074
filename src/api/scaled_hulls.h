// The scaled hulls that a world was asked about last: a question with one costs no new hull.
#pragma once

#include <avbd/geometry.h>

#include <array>
#include <shared_mutex>

#include "geom/hull.h"

namespace avbd {

/// Safe beside itself: several queries may ask at the same time, and none waits for another's hull to be made.
class ScaledHulls {
 public:
  static constexpr size_t kCount = 16;

  std::shared_ptr<const HullData> find(const std::shared_ptr<const HullData>& source, Vec3 scale) {
    {
      const std::shared_lock lock(mutex_);
      for (const Entry& entry : entries_)
        if (entry.source == source && entry.scale == scale) return entry.copy;
    }
    std::shared_ptr<const HullData> copy = scaledHull(source, scale);
    Entry entry{source, copy, scale};
    const std::lock_guard lock(mutex_);
    std::swap(entries_[oldest_], entry);
    oldest_ = (oldest_ + 1) % kCount;
    return copy;
  }

 private:
  struct Entry {
    std::shared_ptr<const HullData> source, copy;
    Vec3 scale;
  };
  std::shared_mutex mutex_;
  std::array<Entry, kCount> entries_;
  size_t oldest_ = 0;
};

}  // namespace avbd
