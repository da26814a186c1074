// Hulls: what they answer, and scaled copies (hull.h).
#include "geom/hull.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "geom/hull_builder.h"

namespace avbd {

MassProperties HullData::massProperties(float density) const { return HullFactory::moments(*this).properties(density); }

namespace {

/// Scaled copies that someone uses.
struct ScaledCopy {
  std::weak_ptr<const HullData> source, copy;
  Vec3 scale;
};

struct ScaledCopies {
  std::mutex mutex;
  std::multimap<uint64_t, ScaledCopy> all;  // by the source's content
  size_t sweepAt = 64;

  std::shared_ptr<const HullData> find(const std::shared_ptr<const HullData>& hull, Vec3 scale) const {
    const auto [begin, end] = all.equal_range(hull->contentHash());
    for (auto i = begin; i != end; ++i) {
      const ScaledCopy& entry = i->second;
      if (!(entry.scale == scale) || entry.source.lock() != hull) continue;
      if (auto copy = entry.copy.lock()) return copy;
    }
    return nullptr;
  }
};

ScaledCopies& scaledCopies() {
  static ScaledCopies copies;
  return copies;
}

}  // namespace

std::shared_ptr<const HullData> scaledHull(const std::shared_ptr<const HullData>& hull, Vec3 scale) {
  if (scale == Vec3{1, 1, 1}) return hull;
  ScaledCopies& copies = scaledCopies();
  {
    const std::scoped_lock lock(copies.mutex);
    if (auto copy = copies.find(hull, scale)) return copy;
  }
  // Made without the lock: others need not wait. Of two that make the same one at a time the first to finish stays.
  std::shared_ptr<const HullData> made = HullFactory::scale(*hull, scale);
  const std::scoped_lock lock(copies.mutex);
  if (auto copy = copies.find(hull, scale)) return copy;
  copies.all.insert({hull->contentHash(), {hull, made, scale}});
  // The dead go when their number may have doubled.
  if (copies.all.size() > copies.sweepAt) {
    std::erase_if(copies.all, [](const auto& entry) { return entry.second.copy.expired(); });
    copies.sweepAt = 2 * copies.all.size() + 64;
  }
  return made;
}

}  // namespace avbd
