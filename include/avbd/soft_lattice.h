// Soft meshes from closed surfaces, and how good their tetrahedra are.
//
// The solid is filled with a body-centred cubic lattice, whose tetrahedra are all alike and nearly regular. Where the
// surface passes, lattice points that lie near it are moved onto it, and the tetrahedra that it still cuts are replaced
// by a few within the solid (isosurface stuffing: Labelle and Shewchuk, 2007). Whatever the surface is like, angles
// between two faces of a tetrahedron stay above 9 degrees. Edges and corners that lie between lattice points are
// bevelled, and what is thinner than a cell may be missing.
#pragma once

#include <avbd/soft_mesh.h>

namespace avbd {

enum class LatticeFit : uint8_t {
  Surface,  ///< points of the outside lie on the surface
  Cover,    ///< whole tetrahedra of the lattice: all that the solid touches, so that it lies within them
};

struct SoftLatticeDef {
  std::span<const Vec3> points{};                        ///< [m]; equal ones are one
  std::span<const std::array<uint32_t, 3>> triangles{};  ///< anticlockwise seen from outside
  float cellSize = 0;  ///< [m] > 0: edge of the lattice's cubes, of 12 tetrahedra each
  LatticeFit fit = LatticeFit::Surface;
};

/// Throws Error: points that are not finite or beyond 1e6; an index beyond the points; no triangle with area; a surface
/// that is not closed (naming an edge that is not of two triangles which agree about the outside, and how many there
/// are) or faces inwards; a cell size that is not finite and > 0, is less than 1e-4 of the largest coordinate, makes
/// more than 500,000 cubes of the surface's bounds, or is so large that no tetrahedron is left. Parts of the surface
/// must not cross each other: what lies in two of them may be missing.
std::shared_ptr<const SoftMeshData> makeTetLattice(const SoftLatticeDef& def);

/// Of the tetrahedra of a solid at rest; of cloth, of its triangles.
struct SoftMeshQuality {
  double leastAngle = 0, greatestAngle = 0;  ///< [rad] between faces of a tetrahedron, or edges of a triangle
  double leastRadiusRatio = 0;               ///< of inscribed to circumscribed; 1: regular, 0: flat
  double leastHeight = 0;                    ///< [m] of a corner over what lies opposite: stiffness grows as it falls
  uint32_t pieces = 0;                       ///< that share no point with each other
};

SoftMeshQuality qualityOf(const SoftMeshData& mesh);

}  // namespace avbd
