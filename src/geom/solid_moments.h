// Volume, centre and inertia of solids of density 1, summed in double.
#pragma once

#include <avbd/body.h>

#include <array>
#include <span>

#include "geom/hull_math.h"
#include "geom/sym_mat3d.h"

namespace avbd {

/// total += scale * v v^T
void addOuter(SymMat3d& total, Vec3d v, double scale);
/// total += scale * (a b^T + b a^T)
void addMixed(SymMat3d& total, Vec3d a, Vec3d b, double scale);

/// total += scale * m
void addScaled(SymMat3d& total, const SymMat3d& m, double scale);

/// A solid's volume, its centre, and the second moments of its points about the centre: the integral of r r^T.
struct SolidMoments {
  double volume = 0;
  Vec3d center;
  SymMat3d second;

  SymMat3d inertia() const;  ///< at density 1: trace(second) 1 - second
  MassProperties properties(double density) const;
};

/// Integrals of 1, p and p p^T over parts of a solid, about any point; parts may be added.
struct MomentSums {
  double volume = 0;
  Vec3d first;
  SymMat3d second;

  void addTetrahedron(Vec3d a, Vec3d b, Vec3d c, Vec3d d);
  SolidMoments about(Vec3d origin) const;  ///< `origin` is where the sums' zero lies
};

struct Direction {
  double cos, sin;
};

/// A solid of revolution about the y axis, put together from slices between two heights.
class Revolution {
 public:
  /// The outer radius goes from `low` at height y0 to `high` at y1.
  void addCone(double y0, double low, double y1, double high);
  /// Outside is an arc: radius + rounding cos(angle) at height y + rounding sin(angle), from one direction (cos, sin >
  /// 0 upwards) to another, both unit.
  void addArc(double y, double radius, double rounding, Direction from, Direction to);
  SolidMoments moments() const;

 private:
  void add(double area, double areaY, double areaYY, double fourth);
  double volume_ = 0, y_ = 0, yy_ = 0, xx_ = 0;
};

/// Of a closed surface of triangles, anticlockwise from outside.
SolidMoments polyhedronMoments(std::span<const Vec3d> points, std::span<const std::array<uint32_t, 3>> triangles);
/// Of a convex polyhedron swept by a ball: the solid itself, a prism on each face, a wedge of a cylinder along each
/// edge and a sector of a ball at each vertex (Steiner's formula, for the first and second moments too). The sector's
/// solid angle is the vertex's angle defect; its moments follow from its arcs by the divergence theorem on the sphere.
SolidMoments roundedMoments(std::span<const Vec3d> points, std::span<const std::array<uint32_t, 3>> triangles,
                            double rounding);

}  // namespace avbd
