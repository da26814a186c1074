// Bounds of shapes at world poses.
#include "geom/aabb.h"

#include <avbd/hull.h>

#include <bit>
#include <cfloat>

#include "geom/triangles.h"

namespace avbd {
namespace {

/// The float next below (step -1) or above (+1) f, which is finite.
float neighbour(float f, int step) {
  if (f == 0) return static_cast<float>(step) * FLT_TRUE_MIN;
  const uint32_t bits = std::bit_cast<uint32_t>(f);
  return std::bit_cast<float>((f > 0) == (step > 0) ? bits + 1 : bits - 1);
}

float roundDown(double x) {
  if (x <= -FLT_MAX) return -FLT_MAX;
  if (x >= FLT_MAX) return FLT_MAX;
  const float f = static_cast<float>(x);
  return f > x ? neighbour(f, -1) : f;
}

float roundUp(double x) { return -roundDown(-x); }

double magnitude(double x) { return x < 0 ? -x : x; }

/// Rotation matrix times |q|^2: entries that ought to be zero for quarter turns are exactly zero.
struct Turn {
  double m[3][3];
  double scale;
};

Turn turn(Quat q) {
  const double w = q.w, x = q.x, y = q.y, z = q.z;
  return {{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}},
          w * w + x * x + y * y + z * z};
}

/// Half extents of the bounds of an ellipsoid: along a direction n it reaches |(a n.x, b n.y, c n.z)|.
Vec3d ellipsoidReach(const ShapeGeom& geom, const Turn& t) {
  const double k = (1 + 1e-14) / t.scale;
  const auto row = [&](const double* m) {
    return k * length(Vec3d{m[0] * geom.extent.x, m[1] * geom.extent.y, m[2] * geom.extent.z});
  };
  return {row(t.m[0]), row(t.m[1]), row(t.m[2])};
}

/// Half extents of the bounds of a shape that is centred on its frame; of a cylinder or cone: of the box about it.
Vec3d reach(const ShapeGeom& geom, Quat rotation) {
  const double r = geom.radius;
  if (geom.type == ShapeType::Sphere) return {r, r, r};
  const Turn t = turn(rotation);
  if (geom.type == ShapeType::Ellipsoid) return ellipsoidReach(geom, t);
  // Enlarged by more than double rounding can lose.
  const double k = (1 + 1e-14) / t.scale;
  const double x = geom.extent.x * k, y = geom.extent.y * k, z = geom.extent.z * k;
  const auto row = [&](const double* m) { return magnitude(m[0]) * x + magnitude(m[1]) * y + magnitude(m[2]) * z + r; };
  return {row(t.m[0]), row(t.m[1]), row(t.m[2])};
}

Aabb halfSpaceBounds(const Pose& pose, double margin) {
  const Turn t = turn(pose.rotation);
  const double n[3] = {t.m[0][1], t.m[1][1], t.m[2][1]};
  const double p[3] = {pose.position.x, pose.position.y, pose.position.z};
  float lower[3] = {-kFarAway, -kFarAway, -kFarAway}, upper[3] = {kFarAway, kFarAway, kFarAway};
  for (int i = 0; i < 3; ++i) {
    if (n[(i + 1) % 3] != 0 || n[(i + 2) % 3] != 0) continue;
    if (n[i] > 0) upper[i] = roundUp(p[i] + margin);
    if (n[i] < 0) lower[i] = roundDown(p[i] - margin);
  }
  return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
}

}  // namespace

namespace {

/// Bounds of a box in a frame, as a shape that is not centred on it has them.
struct LocalBounds {
  Vec3 lower, upper;
};

LocalBounds localBounds(const ShapeGeom& geom) {
  if (geom.type == ShapeType::Hull) return {geom.hull().lower(), geom.hull().upper()};
  const Aabb box = surfaceBounds(geom);
  return {box.lower, box.upper};
}

bool isCentred(ShapeType type) { return type < ShapeType::Hull; }

}  // namespace

Aabb bounds(const ShapeGeom& geom, const Pose& pose, float margin) {
  if (geom.type == ShapeType::HalfSpace) return halfSpaceBounds(pose, margin);
  if (!isCentred(geom.type)) {
    const LocalBounds local = localBounds(geom);
    const Vec3d middle = (toDouble(local.lower) + toDouble(local.upper)) * 0.5;
    // One rounding more, so that the box about the middle holds both ends.
    const Vec3d half = (toDouble(local.upper) - toDouble(local.lower)) * (0.5 * (1 + 1e-7));
    const Vec3 extent{roundUp(half.x), roundUp(half.y), roundUp(half.z)};
    return bounds({ShapeType::RoundedBox, geom.radius, extent}, pose * Pose{middle, {}}, margin);
  }
  const Vec3d p = pose.position, e = reach(geom, pose.rotation) + Vec3{margin, margin, margin};
  const Vec3d lo = p - e, hi = p + e;
  return {{roundDown(lo.x), roundDown(lo.y), roundDown(lo.z)}, {roundUp(hi.x), roundUp(hi.y), roundUp(hi.z)}};
}

}  // namespace avbd
