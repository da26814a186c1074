// Solids of tetrahedra: made once, shared by any number of soft bodies and worlds.
#pragma once

#include <avbd/types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace avbd {

class FaceTree;  // src/geom

struct TetMeshDef {
  std::span<const Vec3> points{};                   ///< [m], at rest
  std::span<const std::array<uint32_t, 4>> tets{};  ///< indices of points
};

/// What making a mesh found and repaired.
struct TetMeshReport {
  uint32_t tets = 0;        ///< kept
  uint32_t inverted = 0;    ///< turned: two of its corners changed places
  uint32_t degenerate = 0;  ///< dropped: two corners are one, or its least height is below 1e-5 of its longest edge
  uint32_t duplicate = 0;   ///< dropped: the same four corners as another
  uint32_t unused = 0;      ///< points dropped: in no tetrahedron that is kept
};

/// Does not change once made; threads and worlds may share it. Points keep their order; those that no tetrahedron needs
/// are left out, so that an index here may be another than in the definition (sourcePoint).
class TetMeshData {
 public:
  TetMeshData();
  ~TetMeshData();
  const TetMeshReport& report() const { return report_; }
  std::span<const Vec3> points() const { return points_; }                       ///< [m], at rest
  std::span<const std::array<uint32_t, 4>> tets() const { return tets_; }        ///< of positive volume
  std::span<const std::array<uint32_t, 3>> surface() const { return surface_; }  ///< anticlockwise seen from outside
  uint32_t sourcePoint(uint32_t point) const { return sourcePoints_[point]; }    ///< its index in TetMeshDef::points
  float faceSize() const { return faceSize_; }  ///< [m] mean length of the surface's edges
  const FaceTree& faceTree() const { return *faceTree_; }
  double volume() const { return volume_; }       ///< [m^3]
  uint64_t contentHash() const { return hash_; }  ///< of points and tetrahedra: equal meshes have equal hashes

 private:
  friend std::shared_ptr<const TetMeshData> makeTetMesh(const TetMeshDef& def);
  TetMeshReport report_;
  std::vector<Vec3> points_;
  std::vector<std::array<uint32_t, 4>> tets_;
  std::vector<std::array<uint32_t, 3>> surface_;
  std::vector<uint32_t> sourcePoints_;
  std::unique_ptr<const FaceTree> faceTree_;
  float faceSize_ = 0;
  double volume_ = 0;
  uint64_t hash_ = 0;
};

/// Throws Error for points that are not finite or beyond 1e6, an index beyond the points, a face of more than two
/// tetrahedra, or a mesh of which no tetrahedron is left.
std::shared_ptr<const TetMeshData> makeTetMesh(const TetMeshDef& def);

/// A box of half extents h about the origin in nx x ny x nz cells of five tetrahedra each, those of neighbours
/// mirrored. Throws Error for a size that is not positive and finite or a number of cells beyond 1 .. 1000.
std::shared_ptr<const TetMeshData> makeTetBox(Vec3 h, int nx, int ny, int nz);

}  // namespace avbd
