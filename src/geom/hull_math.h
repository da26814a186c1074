// What hull building, masses and decomposition compute with: double vectors and the distance to a convex set of points.
#pragma once

#include <avbd/types.h>

#include <span>

namespace avbd {

constexpr Vec3d cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// a with length 1; (0, 1, 0) for a = 0.
Vec3d normalized(Vec3d a);
/// Angle of (x, y) from the x axis [rad], -pi .. pi, to 1e-15; of + - * / sqrt alone, so that every platform gives the
/// same.
double angleOf(double x, double y);
/// Total order of points by x, then y, then z.
constexpr bool lexLess(Vec3d a, Vec3d b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

/// The point of the convex hull of `points` (at least one) that is nearest to p.
Vec3d nearestInHull(Vec3d p, std::span<const Vec3d> points);
/// The point of triangle abc that is nearest to p.
Vec3d nearestInTriangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c);

}  // namespace avbd
