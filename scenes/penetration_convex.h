// Depth of overlap of any two convex shapes, in double, from nothing but how far each reaches along a direction.
//
// The least translation that parts two convex shapes goes along the direction n in which the sum of their reaches,
// reachA(n) + reachB(-n), is least. Of two polytopes that overlap the least sum is at a face normal of one or at a
// cross product of two edges, so trying all of them is exact. Otherwise (smooth shapes, rounded ones whose cores are
// apart) the best of many directions is improved until steps of 1e-10 rad no longer help: an upper bound of the depth
// that is tight to rounding unless it fell into a local minimum, and never too small.
#pragma once

#include <avbd/geometry.h>

#include <vector>

namespace avbd::scenes {

/// A convex shape in the world: a core and a ball of `radius` that sweeps it.
struct ConvexBody {
  enum class Core { Corners, Cylinder, Cone, Ellipsoid };
  Core core = Core::Corners;
  std::vector<Vec3d> corners;  ///< of a polytope: all; else unused
  std::vector<Vec3d> normals;  ///< unit; directions worth trying: faces, axes
  std::vector<Vec3d> edges;    ///< unit directions of a polytope's edges
  Vec3d center;
  Vec3d axis[3];  ///< of smooth cores
  Vec3d half;     ///< radius, half height, radius; or half axes
  double radius = 0;

  /// max of n . x over the core; n is unit.
  double reach(Vec3d n) const;
  Vec3d lower() const;  ///< bounds, radius included
  Vec3d upper() const;
};

/// All geometries but HalfSpace, Mesh and HeightField.
ConvexBody convexBody(const Geometry& geometry, const Pose& pose);
ConvexBody triangleBody(Vec3d a, Vec3d b, Vec3d c);

/// Positive: the least translation that parts them; negative: minus their distance.
double convexDepth(const ConvexBody& a, const ConvexBody& b);

/// The triangles of a Mesh or HeightField in the world.
std::vector<ConvexBody> surfaceBodies(const Geometry& geometry, const Pose& pose);
/// Largest depth against any triangle.
double surfaceDepth(const ConvexBody& a, const std::vector<ConvexBody>& surface);

}  // namespace avbd::scenes
