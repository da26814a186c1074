// Height fields: terrain as a grid of heights, shared by any number of shapes and worlds.
#pragma once

#include <avbd/types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace avbd {

/// A grid of heights along y over the x-z plane, centred: sample (column c, row r) is at
/// ((c - (columns - 1) / 2) spacingX, heights[r columns + c], (r - (rows - 1) / 2) spacingZ). Each cell is two
/// triangles, cut from its lowest to its highest corner indices (c, r) - (c + 1, r + 1). Solid below.
struct HeightFieldDef {
  int columns = 2, rows = 2;         ///< 2 .. 32768 each
  float spacingX = 1, spacingZ = 1;  ///< [m] > 0
  std::span<const float> heights{};  ///< [m], columns x rows
  /// For each cell (columns - 1 by rows - 1, row by row) an index into ShapeDef::materials, or kHole; empty: all 0.
  std::span<const uint16_t> materials{};
  /// [m] > 0: how far below the surface bodies are still pushed up. 0 takes the larger spacing.
  float thickness = 0;
  static constexpr uint16_t kHole = 0xffff;
};

/// A height field and its tree. Does not change once made; threads and worlds may share it.
class HeightFieldData {
 public:
  ~HeightFieldData();
  HeightFieldData(const HeightFieldData&) = delete;
  HeightFieldData& operator=(const HeightFieldData&) = delete;
  int columns() const;
  int rows() const;
  float spacingX() const;
  float spacingZ() const;
  float thickness() const;
  float height(int column, int row) const;
  uint16_t cellMaterial(int column, int row) const;  ///< HeightFieldDef::kHole where the cell is open
  Vec3 lower() const;                                ///< bounds of the surface
  Vec3 upper() const;
  uint64_t contentHash() const;
  size_t bytes() const;
  uint32_t triangleCount() const;                        ///< element = 2 (row (columns - 1) + column) + (0 or 1)
  std::array<Vec3, 3> triangle(uint32_t element) const;  ///< corners, unscaled

  struct Parts;  ///< src/geom
  explicit HeightFieldData(std::unique_ptr<const Parts> parts);
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<const Parts> parts_;
};

/// Throws Error for a grid of fewer than two rows or columns, a list of another length, heights that are not finite or
/// beyond 1e6, or a spacing that is not positive.
std::shared_ptr<const HeightFieldData> makeHeightField(const HeightFieldDef& def);

}  // namespace avbd
