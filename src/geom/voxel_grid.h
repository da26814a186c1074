// A solid as voxels: those that its surface touches, those inside, and how far the others are from them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/decompose_surface.h"

namespace avbd {

struct Cell {
  int x = 0, y = 0, z = 0;
};

enum class Voxel : uint8_t { Outside, Surface, Inside };

/// Cells of equal size; a layer of outside cells lies around the solid. A cell that a triangle touches is Surface; what
/// the outside layer does not reach through faces of other Outside cells is Inside, whatever the surface's holes.
class VoxelGrid {
 public:
  /// sealed: surface cells that no outside cell meets count as inside, as they may lie in a hollow.
  VoxelGrid(const ClosedSurface& surface, int resolution, bool sealed);

  int size(int axis) const { return size_[axis]; }
  double cellSize() const { return cell_; }
  Voxel at(int x, int y, int z) const { return voxels_[index(x, y, z)]; }
  bool isSolid(int x, int y, int z) const { return at(x, y, z) != Voxel::Outside; }
  /// Sum over the row's cells below x of their distances, about, to the nearest solid cell's centre, in thirds of a
  /// cell.
  uint32_t distanceBelow(int x, int y, int z) const { return below_[(size_t(z) * size_[1] + y) * (size_[0] + 1) + x]; }
  Vec3d corner(int x, int y, int z) const { return origin_ + Vec3d{x * cell_, y * cell_, z * cell_}; }
  /// The cell that holds a point; of the grid, even where the point lies outside.
  Cell cellOf(Vec3d p) const;
  double volume() const;  ///< surface cells count half

 private:
  size_t index(int x, int y, int z) const { return (static_cast<size_t>(z) * size_[1] + y) * size_[0] + x; }
  void markTriangle(const std::array<Vec3d, 3>& corners);
  void fillInside();
  void sealHollows();
  void findDistances();

  Vec3d origin_;
  double cell_ = 1;
  std::array<int, 3> size_{};
  std::vector<Voxel> voxels_;
  std::vector<uint16_t> distance_;  // thirds of a cell; 0 for solid ones
  std::vector<uint32_t> below_;
};

}  // namespace avbd
