// Numbers for shared geometry and families (shared_table.h).
#include "world/shared_table.h"

#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>

#include <string>

#include "base/hash.h"

namespace avbd {
namespace {

uint64_t hashOf(const SharedTable::Thing& thing) {
  if (const auto* family = std::get_if<std::shared_ptr<const CustomFamily>>(&thing)) {
    const std::string name = (*family)->name();
    return hash64(name.data(), name.size(), static_cast<uint64_t>((*family)->rowCount()));
  }
  if (const auto* hull = std::get_if<std::shared_ptr<const HullData>>(&thing)) return (*hull)->contentHash();
  if (const auto* mesh = std::get_if<std::shared_ptr<const MeshData>>(&thing)) return (*mesh)->contentHash();
  if (const auto* solid = std::get_if<std::shared_ptr<const SoftMeshData>>(&thing)) return (*solid)->contentHash();
  return std::get<std::shared_ptr<const HeightFieldData>>(thing)->contentHash();
}

const void* addressOf(const SharedTable::Thing& thing) {
  return std::visit([](const auto& pointer) { return static_cast<const void*>(pointer.get()); }, thing);
}

}  // namespace

uint32_t SharedTable::number(const Thing& thing) {
  const auto [at, isNew] = numberOf_.try_emplace(addressOf(thing), static_cast<uint32_t>(entries_.size()));
  if (isNew) entries_.push_back({thing, hashOf(thing)});
  return at->second;
}

uint32_t SharedTable::find(Kind kind, uint64_t hash, uint32_t number) const {
  const auto fits = [&](const Entry& entry) { return entry.kind() == kind && entry.hash == hash; };
  if (number < entries_.size() && fits(entries_[number])) return number;
  uint32_t found = kUnknown;
  for (uint32_t i = 0; i < entries_.size(); ++i) {
    if (!fits(entries_[i])) continue;
    // Geometry of one content is one and the same; a family's name does not tell all that it does.
    if (found != kUnknown && kind == Kind::Family) return kUnknown;
    if (found == kUnknown) found = i;
  }
  return found;
}

const char* kindName(SharedTable::Kind kind) {
  constexpr const char* kNames[] = {"Hull", "Mesh", "HeightField", "CustomFamily", "SoftMesh"};
  return kNames[static_cast<size_t>(kind)];
}

}  // namespace avbd
