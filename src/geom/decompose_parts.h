// Parts of a solid: connected sets of voxels in a box, the true surface within them, and where to cut them.
#pragma once

#include <avbd/hull.h>

#include "geom/decompose_measure.h"

namespace avbd {

struct SolidPart {
  Cell low, high;                   ///< box of its cells, `high` excluded
  Vec3d lower, upper;               ///< the box that cuts left: it may end within a cell, which both sides then have
  std::vector<Cell> cells;          ///< in order of z, y, x
  std::vector<uint32_t> triangles;  ///< that may touch the box
  std::vector<Vec3> points;         ///< their convex hull holds the part: its surface's corners within the box
};

/// The solid's connected parts (over faces, edges and corners of cells).
std::vector<SolidPart> wholeParts(const Solid3& solid);
/// Cuts at a border of cells, or at a flat piece of the surface near it, where the hulls of both sides together reach
/// least into what is not solid. Each side's connected parts; just the part again if it is one cell.
std::vector<SolidPart> cutPart(const Solid3& solid, const SolidPart& part);
/// How much the hull of two parts' cells holds that is not solid: cells times their distance.
double emptiness(const Solid3& solid, const SolidPart& a, const SolidPart& b);
/// Hull of points that may lie in one plane: then they are thickened by `thickness`.
std::shared_ptr<const HullData> hullOfPart(const std::vector<Vec3>& points, int maxVertices, double tolerance,
                                           double thickness);

}  // namespace avbd
