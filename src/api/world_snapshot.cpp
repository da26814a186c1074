// Snapshots: saved under the lock that queries take for the tree, restored into a second world that takes the place.
#include <utility>

#include "api/world_impl.h"
#include "world/check.h"
#include "world/snapshot.h"

namespace avbd {
namespace {

/// Returns how many bytes it takes, whether or not it fits.
size_t saveTo(const WorldData& data, SharedTable& table, snapshot::PairSides& sides, std::span<std::byte> out) {
  snapshot::Writer writer(out);
  saveSnapshot(data, table, sides, writer);
  if (writer.fits()) sealSnapshot(data, out.first(writer.size()));
  return writer.size();
}

}  // namespace

size_t World::snapshotSize() const {
  const std::lock_guard lock(impl_->treeMutex);
  return saveTo(impl_->data, impl_->shared, impl_->pairSides, {});
}

void World::save(std::vector<std::byte>& out) const {
  const std::lock_guard lock(impl_->treeMutex);
  snapshot::Writer writer(out);
  saveSnapshot(impl_->data, impl_->shared, impl_->pairSides, writer);
  out.resize(writer.size());
  sealSnapshot(impl_->data, out);
}

size_t World::save(std::span<std::byte> out) const {
  const std::lock_guard lock(impl_->treeMutex);
  const size_t size = saveTo(impl_->data, impl_->shared, impl_->pairSides, out);
  if (size > out.size())
    (Path("World::save") / "out").refuse(toText(out.size()) + " bytes", "must be at least " + toText(size));
  return size;
}

void World::restore(std::span<const std::byte> snapshot) {
  Impl& impl = *impl_;
  if (!impl.restored) impl.restored = std::make_unique<WorldData>();
  loadSnapshot(snapshot, impl.data, impl.shared, impl.pairSides, *impl.restored);
  std::swap(impl.data.contactHook, impl.restored->contactHook);
  std::swap(impl.data, *impl.restored);
}

}  // namespace avbd
