// What a surface that bends is at rest: where its faces are and face, and a frame about each point by which it can be
// told how the surface there has turned since.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/face_tree.h"

namespace avbd {

/// Of right angles: a unit normal, and what a neighbour's direction is along the surface.
struct SurfaceFrame {
  Vec3 normal, along;
};

/// Of several faces at rest: their centres and normals stand between these.
struct RestRange {
  Aabb centres, normals;
};

struct SurfaceAtRest {
  std::vector<Vec3> centres, normals;  ///< of the faces; normals are units
  std::vector<uint32_t> neighbour;     ///< by point: another of the same face; itself of a point of no face
  std::vector<SurfaceFrame> frames;    ///< by point
  std::vector<RestRange> ranges;       ///< by node of the tree

  SurfaceAtRest() = default;
  SurfaceAtRest(std::span<const Vec3> points, const FaceTree& tree, std::span<const std::array<uint32_t, 3>> faces);

  /// Whether two faces lie beside each other: nearer than `size`, and neither before the other. While the surface
  /// around them turns as one, they do not come together.
  bool areBeside(uint32_t a, uint32_t b, float size, bool isCloth) const;
  /// Whether all faces below two nodes of the tree do.
  bool nodesAreBeside(uint32_t a, uint32_t b, float size) const;
};

/// Unit normal of a triangle; 0 of one without area.
Vec3 unitNormal(Vec3 a, Vec3 b, Vec3 c);

/// The frame of a point with a normal and its neighbour off it; false, where they tell none.
bool surfaceFrame(Vec3 normal, Vec3 toNeighbour, SurfaceFrame& frame);

}  // namespace avbd
