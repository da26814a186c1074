// Makes the polygons of a hull from its triangles: neighbours that lie in one plane within a tolerance become one face.
//
// A group of triangles is a face if some plane supports the whole hull with all the group's vertices within the
// tolerance below it, no triangle of the group is turned far from it, and the group's rim is one loop that is convex in
// that plane (a corner may be reflex by the tolerance). Edges are tried from the flattest to the sharpest, again until
// nothing merges. What then has corners that hold nothing up, because fewer than three faces meet there or a loop is
// straight or reflex at them, is named in `weak`: the hull without them is made anew by the caller. With none left,
// loops are strictly convex and three or more faces meet at every vertex.
#pragma once

#include <span>

#include "geom/hull_exact.h"

namespace avbd {

struct MergedFaces {
  std::vector<std::vector<uint32_t>> loops;  ///< anticlockwise seen from outside, each from its smallest index, sorted
  std::vector<uint32_t> weak;                ///< vertices to leave out, ascending
};

/// Every index below points.size() is a vertex of the triangles, which form an exact hull.
MergedFaces mergeFaces(std::span<const Vec3d> points, std::span<const ExactHull::Triangle> triangles, double tolerance);

/// Area vector of a polygon (twice the area; along its normal).
Vec3d loopArea(std::span<const Vec3d> points, std::span<const uint32_t> loop);

}  // namespace avbd
