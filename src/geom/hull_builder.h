// Makes hulls: points to vertices and polygons (hull_builder.cpp), and those to a HullData (hull_factory.cpp).
//
// Tolerance. Let T be the tolerance that was asked for. Vertices are chosen by an exact quickhull, farthest point
// first, until no point lies more than T/2 outside (hull_exact.h). Vertices that the others already span within T/2 go
// again, each only if every one gone before it stays within T/2: a point is at most T/2 outside a hull of which no
// point is more than T/2 outside the final one, together T. Faces merge within T/4 (hull_merge.h); a face's plane
// supports the hull, its own vertices lie at most T/4 below it. Only the limit on vertices makes the error larger; then
// the vertices that the others span best go first, and the error says what that cost. Every vertex of a hull is one of
// the points given. Each lies below every plane within a float's rounding of the plane's offset: 2^-22 of the largest
// coordinate.
#pragma once

#include <avbd/hull.h>

#include <array>

#include "geom/hull_math.h"
#include "geom/solid_moments.h"

namespace avbd {

/// A finished polyhedron.
struct HullParts {
  std::vector<Vec3> vertices;
  std::vector<std::vector<uint32_t>> loops;  ///< of faces, anticlockwise from outside
  double error = 0;
};

class HullFactory {
 public:
  static std::shared_ptr<const HullData> make(const HullParts& parts);
  /// `hull` with each vertex times scale.
  static std::shared_ptr<const HullData> scale(const HullData& hull, Vec3 scale);
  static SolidMoments moments(const HullData& hull);

 private:
  static void fillFaces(HullData& hull, const HullParts& parts);
  static void fillEdges(HullData& hull);
  static void fillInside(HullData& hull);
};

/// Triangles of the exact hull of a few points, anticlockwise from outside; none if they lie in one plane.
std::vector<std::array<uint32_t, 3>> hullTriangles(std::span<const Vec3d> points);

}  // namespace avbd
