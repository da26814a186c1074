// How far a hull reaches out of a solid, and how far the solid out of all hulls: bounded, by cells that are divided
// where the bound is not yet good enough.
//
// The distance from a solid, or from the nearest of many, changes by no more than one goes. So within a cell it is at
// most its value at the middle plus half the diagonal; a cell whose bound does not exceed the farthest point found by
// more than the slack is done with. The work grows with the surface over the square of what is told apart.
#pragma once

#include <avbd/hull.h>

#include <memory>
#include <vector>

#include "geom/voxel_grid.h"

namespace avbd {

/// A solid by its surface and its voxels.
struct Solid3 {
  const ClosedSurface& surface;
  const VoxelGrid& grid;

  /// Distance from the solid; negative inside: to the surface.
  double outside(Vec3d p) const;
};

struct Reach {
  double found = 0;  ///< distance of the farthest point found
  double bound = 0;  ///< no point lies farther
};

/// How far points of the hull lie outside the solid. Distances below `floor` need not be told apart.
Reach reachOf(const HullData& hull, const Solid3& solid, double floor, double slack);

/// How far points of the solid lie outside all hulls: `bound` is at most the larger of `floor` and `found` + `slack`.
Reach leftOutside(const std::vector<std::shared_ptr<const HullData>>& hulls, const Solid3& solid, double floor,
                  double slack);

}  // namespace avbd
