// Any two convex shapes: support points, distance, depth, cast. All ShapeGeoms of a convex type, Triangle included.
#pragma once

#include "collide/collide_pairs.h"

namespace avbd {

/// The point of the core (without the radius) that lies farthest along a direction, in the shape's frame. direction
/// need not be unit but must not be zero.
Vec3 support(const ShapeGeom& convex, Vec3 direction);

/// A flat part of a core's surface: a face, an edge, or a point, as a convex polygon in the shape's frame.
struct SupportFace {
  static constexpr int kMax = 32;
  Vec3 point[kMax];        ///< anticlockwise seen from outside
  uint32_t feature[kMax];  ///< names each point and with it the edge to the next
  int count = 0;
  Vec3 normal;  ///< of a face (count > 2), unit and outwards; else the direction asked for
};
/// The part of the core that looks most along a unit direction.
void supportFace(const ShapeGeom& convex, Vec3 direction, SupportFace& out);

/// How two convex shapes, radii included, lie to each other.
struct Nearest {
  float distance = 0;   ///< negative: the least translation that parts them, as a depth
  Vec3 normal;          ///< unit, from a to b: along the distance, or the way out of least depth
  Vec3 pointA, pointB;  ///< on the surfaces, relative to the pair's origin
  bool apart = false;   ///< no less than `beyond` away: then nothing but a lower bound in `distance` is set
};
/// Distance or depth. Search ends once the shapes are known to be farther apart than `beyond`.
Nearest nearest(const ShapeGeom& a, const NearPose& poseA, const ShapeGeom& b, const NearPose& poseB, float beyond);

/// A convex shape a moving by `motion` (no rotation) against b at rest.
struct Meeting {
  bool meets = false;
  float fraction = 0;  ///< 0 .. 1 of motion
  Vec3 normal;         ///< unit, out of b; against the motion where they overlap at the start
  Vec3 point;          ///< on b's surface, relative to the pair's origin
};
Meeting cast(const ShapeGeom& a, const NearPose& poseA, Vec3 motion, const ShapeGeom& b, const NearPose& poseB,
             float maxFraction);

/// The manifold of any two convex shapes: at most four points chosen for area and depth, features that stay. The pair
/// function of all pairs in the table that have no special one.
void collideConvex(const ShapePair& pair, Manifold& out);
/// A convex shape (first) against a HalfSpace.
void collideConvexHalfSpace(const ShapePair& pair, Manifold& out);

}  // namespace avbd
