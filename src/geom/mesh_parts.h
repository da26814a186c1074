// What a MeshData holds.
#pragma once

#include <avbd/mesh.h>

#include <cmath>
#include <vector>

#include "geom/mesh_tree.h"

namespace avbd {

/// Corners, and what lies across the edge from corner i to the next.
struct MeshTriangle {
  static constexpr uint32_t kNone = 0x7fffffffu;  ///< no neighbour
  static constexpr uint32_t kFlat = 1u << 31;     ///< the neighbour lies in the same plane
  uint32_t vertex[3];
  uint32_t link[3];
};

struct MeshData::Parts {
  std::vector<Vec3> vertices;
  std::vector<MeshTriangle> triangles;  ///< in the tree's order
  std::vector<uint32_t> source;
  std::vector<uint16_t> materials;  ///< empty: all 0
  MeshTree tree;
  Vec3 lower, upper;
  uint64_t hash = 0;
  bool doubleSided = false;
  MeshReport report;
};

/// The unit normal of a triangle; in double, so that slivers have one too. Zero where there is no area at all.
inline Vec3 triangleNormal(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3d u = toDouble(b) - toDouble(a), v = toDouble(c) - toDouble(a);
  const Vec3d n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const double l = std::sqrt(dot(n, n));
  return l > 0 ? toFloat(n * (1 / l)) : Vec3{};
}

/// How a surface goes on across an edge (direction `along` of a triangle with this normal).
enum class Bend : uint8_t { Flat, Ridge, Valley };
inline Bend bendOf(Vec3 normal, Vec3 across, Vec3 along) {
  // Sine of the bend below which two triangles are one plane: what rounding of vertices makes of flat ground.
  constexpr float kFlatBend = 1e-4f;
  const Vec3 out = cross(along, normal);
  const float bend = dot(across, out), size = kFlatBend * length(out);
  // Folded back onto itself: a blade.
  if (dot(normal, across) < -0.9999f) return Bend::Ridge;
  if (bend > size) return Bend::Ridge;
  return bend < -size ? Bend::Valley : Bend::Flat;
}

// The steps of makeMesh, in order. Each works on what the one before left.
void weldVertices(const MeshDef& def, MeshData::Parts& parts);
void dropBadTriangles(const MeshDef& def, MeshData::Parts& parts);
void linkTriangles(MeshData::Parts& parts);
void orderByTree(MeshData::Parts& parts);

}  // namespace avbd
