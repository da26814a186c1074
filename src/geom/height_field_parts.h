// What a HeightFieldData holds: samples and a pyramid of least and greatest heights.
#pragma once

#include <avbd/height_field.h>

#include <vector>

namespace avbd {

struct HeightFieldData::Parts {
  /// Least and greatest height of a block's cells, open ones left out; low > high where all are open.
  struct Block {
    float low, high;
  };
  /// Blocks of 4 x 4 cells, then of 2 x 2 blocks each, up to one block.
  struct Level {
    int columns, rows;
    std::vector<Block> blocks;
  };
  static constexpr int kBlockShift = 2;

  int columns = 0, rows = 0;
  float spacingX = 1, spacingZ = 1, thickness = 0;
  std::vector<float> heights;
  std::vector<uint16_t> materials;  ///< empty: all 0
  std::vector<Level> levels;
  Vec3 lower, upper;
  uint64_t hash = 0;

  int cellColumns() const { return columns - 1; }
  int cellRows() const { return rows - 1; }
  float height(int column, int row) const {
    return heights[static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column)];
  }
  uint16_t material(int column, int row) const {
    if (materials.empty()) return 0;
    return materials[static_cast<size_t>(row) * static_cast<size_t>(columns - 1) + static_cast<size_t>(column)];
  }
  /// Whether the cell is in the grid and not a hole.
  bool isClosed(int column, int row) const {
    return column >= 0 && row >= 0 && column < cellColumns() && row < cellRows() &&
           material(column, row) != HeightFieldDef::kHole;
  }
  float x(int column) const { return (static_cast<float>(column) - 0.5f * static_cast<float>(columns - 1)) * spacingX; }
  float z(int row) const { return (static_cast<float>(row) - 0.5f * static_cast<float>(rows - 1)) * spacingZ; }
  Vec3 corner(int column, int row) const { return {x(column), height(column, row), z(row)}; }
};

}  // namespace avbd
