// What soft bodies are made of: solids of tetrahedra, or cloth of triangles; made once, shared by any number of soft
// bodies and worlds.
#pragma once

#include <avbd/types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace avbd {

class FaceTree;  // src/geom

struct TetMeshDef {
  std::span<const Vec3> points{};                   ///< [m], at rest
  std::span<const std::array<uint32_t, 4>> tets{};  ///< indices of points
};

struct ClothMeshDef {
  std::span<const Vec3> points{};                        ///< [m], at rest; bending rests flat
  std::span<const std::array<uint32_t, 3>> triangles{};  ///< indices of points
};

/// What making a mesh found and repaired.
struct SoftMeshReport {
  uint32_t elements = 0;    ///< tetrahedra or triangles that are kept
  uint32_t inverted = 0;    ///< tetrahedra turned: two of their corners changed places
  uint32_t degenerate = 0;  ///< dropped: two corners are one, or the least height is below 1e-5 of the longest edge
  uint32_t duplicate = 0;   ///< dropped: the same corners as another
  uint32_t unused = 0;      ///< points dropped: in no element that is kept
};

/// Does not change once made; threads and worlds may share it. Points keep their order; those that no element needs are
/// left out, so that an index here may be another than in the definition (sourcePoint).
class SoftMeshData {
 public:
  ~SoftMeshData();
  SoftMeshData(const SoftMeshData&) = delete;
  SoftMeshData& operator=(const SoftMeshData&) = delete;
  const SoftMeshReport& report() const;
  std::span<const Vec3> points() const;                        ///< [m], at rest
  std::span<const std::array<uint32_t, 4>> tets() const;       ///< of positive volume; none of cloth
  std::span<const std::array<uint32_t, 3>> triangles() const;  ///< of cloth
  /// Of cloth the pairs of triangles that share an edge: its ends, and the corners opposite.
  std::span<const std::array<uint32_t, 4>> hinges() const;
  /// The outer faces of a solid, anticlockwise seen from outside; of cloth its triangles.
  std::span<const std::array<uint32_t, 3>> surface() const;
  bool isCloth() const { return !triangles().empty(); }
  uint32_t sourcePoint(uint32_t point) const;  ///< its index in the definition
  float faceSize() const;                      ///< [m] mean length of the surface's edges
  double volume() const;                       ///< [m^3] of the tetrahedra
  double area() const;                         ///< [m^2] of the surface
  uint64_t contentHash() const;                ///< of points and elements: equal meshes have equal hashes
  const FaceTree& faceTree() const;

  struct Parts;  ///< src/geom
  explicit SoftMeshData(std::unique_ptr<const Parts> parts);
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<const Parts> parts_;
};

/// Throws Error for points that are not finite or beyond 1e6, an index beyond the points, a face of more than two
/// tetrahedra, or a mesh of which no tetrahedron is left.
std::shared_ptr<const SoftMeshData> makeTetMesh(const TetMeshDef& def);

/// A box of half extents h about the origin in nx x ny x nz cells of five tetrahedra each, those of neighbours
/// mirrored. Throws Error for a size that is not positive and finite or a number of cells beyond 1 .. 1000.
std::shared_ptr<const SoftMeshData> makeTetBox(Vec3 h, int nx, int ny, int nz);

/// Throws Error for points that are not finite or beyond 1e6, an index beyond the points, an edge of more than two
/// triangles, or a mesh of which no triangle is left.
std::shared_ptr<const SoftMeshData> makeClothMesh(const ClothMeshDef& def);

/// A rectangle of half extents hx, hz about the origin in the plane y = 0, in nx x nz cells of two triangles, those of
/// neighbours mirrored. Errors as for makeTetBox.
std::shared_ptr<const SoftMeshData> makeClothGrid(float hx, float hz, int nx, int nz);

}  // namespace avbd
