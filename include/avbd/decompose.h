// Convex decomposition: a closed surface of triangles as a few convex hulls, so that it can collide as a moving body.
//
// The solid is cut by axis-aligned planes where that removes most of the volume that hulls would add, each part is
// wrapped in the hull of the true surface within it, and parts whose common hull is good enough are put together again.
// How far the hulls reach out of the solid, and the solid out of the hulls, is measured on the surface itself, not on
// voxels.
#pragma once

#include <avbd/hull.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace avbd {

struct DecomposeDef {
  std::span<const Vec3> vertices;                      ///< [m]; equal ones are one
  std::span<const std::array<uint32_t, 3>> triangles;  ///< anticlockwise seen from outside
  int maxHulls = 32;                                   ///< 1 .. 1024
  /// [m] >= 0: parts are cut until no hull reaches farther out of the solid, as far as that can be told: what reaches
  /// out by less than a 128th of the largest extent, or half a voxel, may be missed. 0 takes 0.02 of that extent.
  float maxError = 0;
  int resolution = 64;          ///< voxels along the largest extent, 8 .. 256: where cuts may lie
  int maxVerticesPerHull = 64;  ///< 4 .. 255
  /// Repairs a surface with holes or with edges that more or fewer than two triangles share: what cannot be reached
  /// from outside without crossing a voxel that a triangle touches is solid. That closes holes and gaps narrower than a
  /// voxel; a wider one leaves a shell a voxel thick. Otherwise such a surface is refused.
  bool seal = false;
};

struct Decomposition {
  std::vector<std::shared_ptr<const HullData>> hulls;
  /// [m] No point of a hull lies farther outside the solid, and no point of the solid farther outside all hulls: a
  /// bound, at most half a voxel above what it bounds. Hollows that cannot be reached from outside count as solid.
  /// Above maxError where maxHulls or the resolution did not allow better.
  float error = 0;
  float errorFound = 0;    ///< [m] the farthest such point that was found: what `error` bounds lies between the two
  float tolerance = 0;     ///< [m] HullDef::tolerance with which each hull's vertices make the same hull again
  float volume = 0;        ///< [m^3] of the solid, by voxels where the surface was sealed
  uint32_t openEdges = 0;  ///< that `seal` let pass: edges not shared by two triangles that agree about the outside
};

/// Throws Error: vertices not finite or beyond 1e6, an index out of range, no triangle with area, options out of range,
/// and, without `seal`, a surface that is not closed (naming an edge and how many there are).
Decomposition decompose(const DecomposeDef& def);

}  // namespace avbd
