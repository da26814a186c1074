// The inside of a mesh of a soft body (soft_mesh.h).
#pragma once

#include <avbd/soft_mesh.h>

#include <string>
#include <vector>

#include "geom/face_tree.h"

namespace avbd {

struct SoftMeshData::Parts {
  SoftMeshReport report;
  std::vector<Vec3> points;
  std::vector<std::array<uint32_t, 4>> tets, hinges;
  std::vector<std::array<uint32_t, 3>> triangles, surface;
  std::vector<uint32_t> sourcePoints;
  std::unique_ptr<const FaceTree> faceTree;
  float faceSize = 0;
  double volume = 0, area = 0;
  uint64_t hash = 0;
};

namespace soft_mesh {

using Point3 = Vec3d;
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
/// What follows from points, elements and surface.
std::shared_ptr<const SoftMeshData> finish(std::unique_ptr<SoftMeshData::Parts> parts);

}  // namespace soft_mesh
}  // namespace avbd
