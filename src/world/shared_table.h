// What snapshots cannot hold: geometry and families that worlds share. A table numbers them, a snapshot says the
// number.
#pragma once

#include <avbd/custom_joint.h>
#include <avbd/geometry.h>
#include <avbd/soft_mesh.h>

#include <memory>
#include <unordered_map>
#include <variant>
#include <vector>

namespace avbd {

/// Grows with what snapshots name and keeps it alive, so that a world can go back to a shape that is gone by now.
class SharedTable {
 public:
  enum class Kind : uint8_t { Hull, Mesh, HeightField, Family, SoftMesh };
  using Thing = std::variant<std::shared_ptr<const HullData>, std::shared_ptr<const MeshData>,
                             std::shared_ptr<const HeightFieldData>, std::shared_ptr<const CustomFamily>,
                             std::shared_ptr<const SoftMeshData>>;
  struct Entry {
    Thing thing;
    uint64_t hash = 0;  ///< of its content; of a family of its name and count of rows
    Kind kind() const { return static_cast<Kind>(thing.index()); }
  };

  /// Its number; if it is new, a new one.
  uint32_t number(const Thing& thing);
  const std::vector<Entry>& entries() const { return entries_; }

  static constexpr uint32_t kUnknown = 0xffffffffu;
  /// The entry that goes by this number and hash in a snapshot: the one of that number if it has the hash, else the
  /// only one with it. kUnknown: there is none, or families of one name that might be either.
  uint32_t find(Kind kind, uint64_t hash, uint32_t number) const;

 private:
  std::vector<Entry> entries_;
  std::unordered_map<const void*, uint32_t> numberOf_;
};

const char* kindName(SharedTable::Kind kind);

}  // namespace avbd
