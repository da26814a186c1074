// The inside of a mesh of a soft body (soft_mesh.h).
#pragma once

#include <avbd/soft_mesh.h>

#include <string>
#include <vector>

#include "geom/face_tree.h"
#include "geom/surface_at_rest.h"
#include "geom/surface_features.h"

namespace avbd {

/// A tetrahedron at rest.
struct TetAtRest {
  Vec3 gb, gc, gd;   ///< gradients of the weights of corners 1 to 3 [1/m]
  float volume = 0;  ///< [m^3]
};

struct TriangleAtRest {
  float bx = 0, by = 0, cx = 0, cy = 0;  ///< gradients of the weights of corners 1 and 2, in the plane [1/m]
  float area = 0;                        ///< [m^2]
};

struct HingeAtRest {
  std::array<float, 4> weight{};  ///< of bending (rows/cloth_bend.h)
  float areas = 0;                ///< [m^2] of both triangles
};

/// A point of another's star: b_j of rows/star_elastic.h.
struct StarPoint {
  uint32_t point = 0;
  Vec3 gradient;  ///< [1/m]
};

struct SoftMeshData::Parts {
  SoftMeshReport report;
  std::vector<Vec3> points;
  std::vector<std::array<uint32_t, 4>> tets, hinges;
  std::vector<std::array<uint32_t, 3>> triangles, surface;
  std::vector<uint32_t> sourcePoints;
  std::vector<TetAtRest> tetsAtRest;
  std::vector<TriangleAtRest> trianglesAtRest;
  std::vector<HingeAtRest> hingesAtRest;
  // Of each point of a solid its star, the tetrahedra about it: the other points of it, ascending, those of point i
  // from starBegin[i] on; a quarter of its volume [m^3].
  std::vector<uint32_t> starBegin;
  std::vector<StarPoint> starPoints;
  std::vector<float> starVolumes;
  std::unique_ptr<const FaceTree> faceTree;
  SurfaceFeatures features;  ///< of the surface
  SurfaceAtRest atRest;      ///< likewise
  float faceSize = 0;
  double volume = 0, area = 0;
  uint64_t hash = 0;
};

namespace soft_mesh {

inline Vec3d crossOf(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

inline constexpr double kFlat = 1e-5;  ///< [of the longest edge] least height of an element

/// Refuses points that are none and indices beyond them. `definition`: the name of the definition, `field` that of the
/// elements.
template <size_t n>
void check(const char* definition, const char* field, std::span<const Vec3> points,
           std::span<const std::array<uint32_t, n>> elements);
/// Takes out elements with the corners of another.
template <size_t n>
void dropDuplicates(std::vector<std::array<uint32_t, n>>& elements, SoftMeshReport& report);
/// Copies the points that the elements need, and numbers their corners anew.
template <size_t n>
void takePoints(std::span<const Vec3> points, std::vector<std::array<uint32_t, n>>& elements,
                SoftMeshData::Parts& parts);
/// Fills what elements and hinges are at rest.
void findRest(SoftMeshData::Parts& parts);
/// Fills what stars are at rest, from what tetrahedra are.
void findStars(SoftMeshData::Parts& parts);
/// What follows from points, elements and surface.
std::shared_ptr<const SoftMeshData> finish(std::unique_ptr<SoftMeshData::Parts> parts);

}  // namespace soft_mesh
}  // namespace avbd
