// A fine mesh that follows a coarse soft body: what is drawn may have any number of points, and the cage that moves
// them few.
//
// Each fine point keeps its weights in the tetrahedron that holds it, or outside of all in the nearest one, so that an
// affine motion of the cage moves it by the same map. On cloth it keeps its place in the nearest triangle and its
// distance from it, along the normal.
#pragma once

#include <avbd/soft_mesh.h>

#include <vector>

namespace avbd {

struct SurfaceBindingDef {
  std::shared_ptr<const SoftMeshData> mesh{};  ///< the cage
  std::span<const Vec3> points{};              ///< [m] the fine ones, in the mesh's frame while it is at rest
};

/// A point as the cage sees it: the sum of the weighted corners, and `offset` along the normal.
struct BoundPoint {
  std::array<uint32_t, 4> corners{};  ///< points of the mesh; of cloth the fourth repeats the third and weighs nothing
  std::array<double, 4> weights{};    ///< their sum is 1; some are negative outside of the element
  double offset = 0;                  ///< [m] of cloth, to the side from which the triangle is anticlockwise
  uint32_t element = 0;               ///< tetrahedron, or triangle of cloth
};

class SurfaceBinding {
 public:
  /// Throws Error for a mesh that is null, no points, and points that are not finite or beyond 1e6.
  explicit SurfaceBinding(const SurfaceBindingDef& def);

  std::span<const BoundPoint> points() const { return points_; }  ///< in the definition's order
  uint32_t outside() const { return outside_; }                   ///< points that no tetrahedron holds; 0 of cloth
  double farthest() const { return farthest_; }                   ///< [m] of a point from its element

  /// Where the fine points are now. cage: the points of the mesh now, as World::getPoints gives them [m]. Throws Error
  /// for another number of them than the mesh has, and where `out` has another number than there are fine points.
  void skin(std::span<const Vec3d> cage, std::span<Vec3d> out) const;

 private:
  std::vector<BoundPoint> points_;
  size_t cageSize_ = 0;
  uint32_t outside_ = 0;
  double farthest_ = 0;
};

/// Unit normals of points, of all triangles at each by their areas, to the side from which these are anticlockwise;
/// (0, 1, 0) where there are none. Throws Error for an index beyond the points or another number of normals.
void smoothNormals(std::span<const Vec3d> points, std::span<const std::array<uint32_t, 3>> triangles,
                   std::span<Vec3> out);

}  // namespace avbd
