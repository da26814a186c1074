// The parts of collideSurface: triangles near the convex shape, what it touches of each, patches.
//
// All in the surface's axes with the origin at the convex shape's own, so that numbers are small.
//
// A triangle offers its face's normal, and at an edge or corner the directions between the normals of the faces that
// meet there, if the surface bends away from its front there. The contact of the convex shape with one triangle alone
// may ask for another direction: out across an edge behind which the surface goes on. Such a direction is refused: a
// direction u at a point y is offered only if no triangle that holds y rises above the plane through y across u. That
// needs no neighbours, so it also holds where triangles meet without sharing vertices. Where it is refused, or where a
// face's own direction is asked for, the contact is the convex shape's support face cut by the triangle's sides. What
// is left are triangles entered from behind, through another: a triangle from which another's shallower contact frees
// the convex shape has none of its own.
#pragma once

#include <vector>

#include "collide/collide_surface.h"
#include "collide/convex.h"
#include "geom/triangles.h"

namespace avbd {

/// The convex shape as the parts see it.
struct ConvexView {
  const ShapeGeom& geom;
  NearPose pose;  ///< at the origin
  Mat3 turn;
  Vec3 center;  ///< a point well inside
  float margin;
  float size;   ///< half the longest side of its bounds
  float touch;  ///< distance below which places are one
  bool sunk;    ///< below a height field, within its thickness

  ConvexView(const ShapeGeom& g, Quat rotation, float contactMargin);
  Vec3 support(Vec3 direction) const { return mul(turn, avbd::support(geom, mulT(turn, direction))); }
  /// Least of u . x over the shape.
  float lowest(Vec3 u) const { return dot(u, support(-u)) - geom.radius; }
};

/// A triangle near the convex shape, turned to it, and what came of it.
struct NearTriangle {
  Vec3 v[3];
  Vec3 normal, across[3];
  bool isSharp[3];  ///< rim or ridge: an edge that may be touched itself
  bool isRim[3];
  uint32_t element;
  uint16_t material;
  bool isBehind = false;  ///< seen from behind: touches nothing, but directions into it are refused
  bool isNear = false;    ///< its plane is within the margin; of others the edges are not known
  bool isFace = false;    ///< the touches below are by the face's normal
  uint32_t first = 0;     ///< of its touches
  uint32_t count = 0;
  float separation = 0;  ///< least of its touches
};

/// A point of contact before it joins a patch.
struct Touch {
  Vec3 normal;  ///< out of the surface
  Vec3 onConvex, onSurface;
  float separation;
  uint32_t feature;
  uint32_t triangle;   ///< index into the near triangles
  bool spare = false;  ///< counts only where no triangle beside has one
};

/// The near triangles by where they begin along x, so that those at a point are found without asking all.
class NearAlong {
 public:
  void clear() { starts_.clear(); }
  /// Triangles that may come as near as `reach` to a point, ascending.
  const std::vector<uint32_t>& at(const std::vector<NearTriangle>& all, Vec3 point, float reach);

 private:
  struct Start {
    float x;
    uint32_t triangle;
  };
  std::vector<Start> starts_;  ///< made when first asked for
  float widest_ = 0;
  std::vector<uint32_t> found_;
};

/// Angle below which directions are one, as its sine.
inline constexpr float kSameDirection = 0.01f;
/// Cosine of that angle.
inline constexpr float kSameCosine = 0.99995f;

/// Set in names of the convex shape's own corners, which keep them from triangle to triangle.
inline constexpr uint32_t kCorner = 1u << 31;

inline uint32_t mixed(uint32_t a, uint32_t b) {
  const uint64_t x = (uint64_t{a} << 32 | b) * 0x9e3779b97f4a7c15u;
  return static_cast<uint32_t>((x ^ (x >> 29)) * 0xbf58476d1ce4e5b9u >> 32);
}

// collide_surface_nearest.cpp
Vec3 closestOnTriangle(Vec3 p, const Vec3* v);
/// Nearest points of the convex shape (a) and a triangle (b).
Nearest nearestOnTriangle(const ConvexView& convex, const NearTriangle& triangle);

// collide_surface_face.cpp
/// A convex polygon or a line. Corners know the lines that come to them and leave them. `name`: of a corner of the
/// convex shape; 0 for those that cuts made.
struct CutPolygon {
  struct Corner {
    Vec3 x;
    uint32_t in, out, name;
  };
  Corner corner[SupportFace::kMax + 3];
  int count = 0;
  bool closed = true;
};
/// The last support face that was asked for, as neighbouring triangles ask for the same, and room to cut it in.
struct FaceRoom {
  Vec3 normal;  ///< (0, 0, 0): none yet
  SupportFace face;
  CutPolygon whole, part[2];
};
/// Adds the touches of the convex shape's support face on the triangle's face, within the margin.
void touchFace(const ConvexView& convex, const NearTriangle& triangle, uint32_t index, FaceRoom& room,
               std::vector<Touch>& out);

// collide_surface_edge.cpp
/// What the surface says to a direction at an edge or corner of a triangle.
enum class Offer : uint8_t {
  Given,
  Refused,  ///< the surface goes on there
  Covered   ///< the direction is the normal of a neighbour, which makes the contact itself
};
/// The corners of a triangle that lie farthest along u: bit k for corner k.
int farthestCorners(const NearTriangle& triangle, Vec3 u);
/// Of the direction out of the surface that `nearest` asks of a triangle on whose edge or corner its point lies.
Offer offerAt(const ConvexView& convex, const std::vector<NearTriangle>& all, NearAlong& along, uint32_t index,
              const Nearest& nearest);
/// Adds the touches on the edge or corner of the triangle that lies farthest along the direction.
void touchEdge(const ConvexView& convex, const NearTriangle& triangle, uint32_t index, const Nearest& nearest,
               std::vector<Touch>& out);

// collide_surface_patches.cpp
/// Gathers touches into patches: normals within a few degrees and one material each, four points at most.
void makePatches(const ConvexView& convex, const std::vector<NearTriangle>& triangles, std::vector<Touch>& touches,
                 std::vector<SurfacePatch>& out);

}  // namespace avbd
