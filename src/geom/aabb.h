// Axis-aligned bounds in the world, rounded outwards to float.
#pragma once

#include "geom/shape.h"

namespace avbd {

struct Aabb {
  Vec3 lower, upper;
};

/// Bounds of a shape at a world pose, grown by margin >= 0. A HalfSpace is bounded only where its plane is
/// axis-aligned; otherwise its bounds are the whole space (+-kFarAway).
Aabb bounds(const ShapeGeom& geom, const Pose& pose, float margin);

inline constexpr float kFarAway = 1e18f;

inline bool overlaps(const Aabb& a, const Aabb& b) {
  return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
         a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}
inline bool contains(const Aabb& outer, const Aabb& inner) {
  return outer.lower.x <= inner.lower.x && outer.lower.y <= inner.lower.y && outer.lower.z <= inner.lower.z &&
         inner.upper.x <= outer.upper.x && inner.upper.y <= outer.upper.y && inner.upper.z <= outer.upper.z;
}

inline Vec3 lesser(Vec3 a, Vec3 b) { return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z}; }
inline Vec3 greater(Vec3 a, Vec3 b) { return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z}; }
/// Holds both.
inline Aabb merge(const Aabb& a, const Aabb& b) { return {lesser(a.lower, b.lower), greater(a.upper, b.upper)}; }
inline Aabb grown(const Aabb& box, float by) {
  const Vec3 around{by, by, by};
  return {box.lower - around, box.upper + around};
}
/// All that it passes over on a straight way.
inline Aabb swept(const Aabb& box, Vec3 way) { return {box.lower + lesser(way, {}), box.upper + greater(way, {})}; }

}  // namespace avbd
