// Two convex cores as GJK and EPA see them: points of the difference b - a, farthest along a direction, in double.
//
// Everything happens in a's frame, so that a needs no turning and only where b lies relative to a enters: the same
// bits for any place of the pair. The difference of two convex sets is convex; its point nearest to the origin is the
// distance, and where it holds the origin, its boundary point nearest to the origin is the depth.
#pragma once

#include "collide/convex.h"

namespace avbd {

inline constexpr double dot3(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline constexpr Vec3d cross3(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// m[row][column].
struct Mat3d {
  double m[3][3];
};
/// Rotation matrix of a quaternion that need not be unit.
Mat3d exactMatrix(Quat q);
inline Vec3d mul(const Mat3d& a, Vec3d v) {
  return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
          a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}
inline Vec3d mulT(const Mat3d& a, Vec3d v) {
  return {a.m[0][0] * v.x + a.m[1][0] * v.y + a.m[2][0] * v.z, a.m[0][1] * v.x + a.m[1][1] * v.y + a.m[2][1] * v.z,
          a.m[0][2] * v.x + a.m[1][2] * v.y + a.m[2][2] * v.z};
}

/// Two cores; b's frame in a's is x -> turn x + offset.
struct CorePair {
  const ShapeGeom& a;
  const ShapeGeom& b;
  Mat3d frameA;  ///< a's rotation
  Mat3d turn;
  Vec3d offset;
  double size;  ///< both shapes' lengths together: the scale of all tolerances
};
CorePair corePair(const ShapeGeom& a, const NearPose& poseA, const ShapeGeom& b, const NearPose& poseB);

/// A point of the difference and the point of a that it came from.
struct DifferencePoint {
  Vec3d w;  ///< b - a
  Vec3d a;
};

/// support() in double.
Vec3d supportPoint(const ShapeGeom& convex, Vec3d direction);

/// The point of b - a that lies farthest against a direction: a's farthest along it, b's farthest against it.
inline DifferencePoint lowest(const CorePair& pair, Vec3d direction) {
  const Vec3d onA = supportPoint(pair.a, direction);
  const Vec3d back = mulT(pair.turn, direction) * -1.0;
  const Vec3d onB = mul(pair.turn, supportPoint(pair.b, back)) + pair.offset;
  return {onB - onA, onA};
}

/// A point well inside a core, in its frame.
Vec3d innerPoint(const ShapeGeom& convex);
/// Radius of a ball about innerPoint that lies within the core.
double innerBall(const ShapeGeom& convex);
/// Largest length of a core from its frame's origin, with its radius.
double coreSize(const ShapeGeom& convex);

/// Whether a core has flat faces only (or is an edge or a point).
constexpr bool isPolytope(ShapeType type) {
  return type != ShapeType::Cylinder && type != ShapeType::Cone && type != ShapeType::Ellipsoid;
}

}  // namespace avbd
