// When two moving shapes meet: conservative advancement over translation and rotation.
//
// The signed distance of two convex shapes is the largest of their separations along a direction, overlapping or not.
// So the separation along the direction n of now bounds it from below for ever: how fast that shrinks is known, as each
// shape goes straight and turns about a fixed axis. Both are moved on until this bound is used up, then looked at
// again. No time is left out, so nothing is passed, and the answer is never late.
#pragma once

#include "base/function_ref.h"
#include "geom/shape.h"

namespace avbd {

/// How a shape moves over the time 0 .. 1: its centre of turning goes straight, and it turns steadily about it. Places
/// are relative to the pair's origin.
struct ShapeMotion {
  NearPose start;  ///< of the shape, at time 0
  Vec3 center;     ///< of turning, at time 0
  Vec3 shift;      ///< [m] of the centre, over the whole time
  Vec3 turn;       ///< [rad] rotation vector, over the whole time
};
NearPose at(const ShapeMotion& motion, float time);

struct ImpactQuery {
  float distance = 0;   ///< [m] signed, that is looked for: negative for a depth
  float tolerance = 0;  ///< [m] > 0: how much farther apart they may still be
  float from = 0, to = 1;
};

struct Impact {
  bool happens = false;
  float time = 0;    ///< the first at which they are no farther apart than asked for
  float before = 0;  ///< [m] signed distance at `from`; where they do not come near, a lower bound of it
  Vec3 normal;       ///< unit, from a to b, then
};

/// a convex (Triangle included), b convex or a HalfSpace that does not turn.
Impact timeOfImpact(const ShapeGeom& a, const ShapeMotion& motionA, const ShapeGeom& b, const ShapeMotion& motionB,
                    const ImpactQuery& query);

/// A triangle of a surface as a moving shape.
struct MovingTriangle {
  Vec3 v[3];           ///< relative to the first
  ShapeMotion motion;  ///< of a frame at the first corner, with the surface's axes
  bool doubleSided;
  ShapeGeom geom() const { return {ShapeType::Triangle, 0, {}, v}; }
};
/// Whether a convex shape's inner point is then before the triangle's front (doubleSided: always).
bool isInFront(const ShapeGeom& convex, const ShapeMotion& motion, const MovingTriangle& triangle, float time);
/// Calls f for the triangles of a surface that a convex shape may come as near to as asked for, without those of which
/// isInFront is false all the time. f returns up to what time to go on: the time given, or an earlier one.
void forEachTriangleMet(const ShapeGeom& convex, const ShapeMotion& motion, const ShapeGeom& surface,
                        const ShapeMotion& surfaceMotion, const ImpactQuery& query,
                        FunctionRef<float(const MovingTriangle&, float to)> f);

/// Signed distance of a convex shape from the triangles of a surface, or `beyond` where it is no less.
float distanceToSurface(const ShapeGeom& convex, const NearPose& pose, const ShapeGeom& surface,
                        const NearPose& surfacePose, float beyond);

}  // namespace avbd
