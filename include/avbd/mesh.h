// Triangle meshes to collide with: made once, shared by any number of shapes and worlds. For static and kinematic
// bodies.
#pragma once

#include <avbd/types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace avbd {

/// A surface of triangles. It may be open; nothing needs to be connected.
struct MeshDef {
  std::span<const Vec3> vertices{};                      ///< [m]
  std::span<const std::array<uint32_t, 3>> triangles{};  ///< anticlockwise seen from the front
  std::span<const uint16_t> materials{};  ///< for each triangle an index into ShapeDef::materials; empty: all 0
  bool doubleSided = false;  ///< otherwise only the front pushes: what is behind a triangle passes through it
  /// [m] >= 0: vertices nearer than this are one. 0 merges only equal ones.
  float weldDistance = 0;
};

/// What making a mesh found and repaired.
struct MeshReport {
  uint32_t triangles = 0;         ///< kept
  uint32_t degenerate = 0;        ///< dropped: without area, or lower than 1e-6 of its longest edge
  uint32_t duplicate = 0;         ///< dropped: the same three vertices and front as another; any front if doubleSided
  uint32_t boundaryEdges = 0;     ///< edges of one triangle only: holes and rims
  uint32_t nonManifoldEdges = 0;  ///< edges of more than two, or of two that disagree about the front
  size_t bytes = 0;               ///< of the finished mesh with its tree
};

/// A mesh and its tree. Does not change once made; threads and worlds may share it.
class MeshData {
 public:
  ~MeshData();
  MeshData(const MeshData&) = delete;
  MeshData& operator=(const MeshData&) = delete;
  const MeshReport& report() const;
  Vec3 lower() const;  ///< bounds
  Vec3 upper() const;
  uint64_t contentHash() const;  ///< of vertices, triangles and materials: equal meshes have equal hashes
  uint32_t triangleCount() const;
  std::array<Vec3, 3> triangle(uint32_t element) const;  ///< corners, unscaled; element as contacts and queries name it
  uint32_t sourceTriangle(uint32_t element) const;       ///< its index in MeshDef::triangles
  uint16_t materialIndex(uint32_t element) const;
  bool doubleSided() const;

  struct Parts;  ///< src/geom
  explicit MeshData(std::unique_ptr<const Parts> parts);
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<const Parts> parts_;
};

/// Throws Error for vertices that are not finite or beyond 1e6, an index beyond the vertices, a list of materials of
/// another length, or a mesh of which no triangle is left.
std::shared_ptr<const MeshData> makeMesh(const MeshDef& def);

}  // namespace avbd
