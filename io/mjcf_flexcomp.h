// Points and elements that <flexcomp> makes by itself, numbered as MuJoCo numbers them: pins and names go by the
// number.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "io/mjcf_math.h"

namespace avbd::mjcf {

enum class FlexKind { Grid, Box, Cylinder, Ellipsoid, Square, Disc, Circle, Mesh, Gmsh, Direct };

using FlexElement = std::array<uint32_t, 4>;  ///< indices of points; the first dim + 1 are used, the others are 0

struct FlexShape {
  int dim = 2;
  std::vector<Vec3d> points;
  std::vector<FlexElement> elements;
};

/// What the kinds up to Circle are made from.
struct FlexPattern {
  FlexKind kind = FlexKind::Grid;
  int dim = 2;
  std::array<int, 3> count{10, 10, 10};  ///< points along each axis; those that the kind uses at least 2
  Vec3d spacing{0.02, 0.02, 0.02};       ///< [m] > 0
};

/// How many points it will have. Nothing overflows for counts up to 1e6.
double pointCount(const FlexPattern& pattern);

/// A grid about the origin, in x and y of two dimensions; the shell of a box, its points moved onto a cylinder or an
/// ellipsoid: in three dimensions with tetrahedra from a point at its centre (point 0), in two an open box without its
/// top; a disc in x and y; a circle of count - 1 points.
FlexShape flexShape(const FlexPattern& pattern);

/// Tetrahedra from one more point, `origin`, which comes first, to each triangle.
FlexShape solidAbout(Vec3d origin, const FlexShape& surface);

/// Without the points that no element has. Returns the former number of each that is left.
std::vector<uint32_t> dropUnused(FlexShape& shape);

}  // namespace avbd::mjcf
