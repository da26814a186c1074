// How far a hull reaches out of a solid: bounded, by cells that are divided where the bound is not yet good enough.
//
// The distance from the solid changes by no more than one goes. So within a cell it is at most its value at the middle
// plus half the diagonal; a cell whose bound does not exceed the farthest point found by more than the slack is done
// with.
#pragma once

#include <avbd/hull.h>

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

}  // namespace avbd
