// Bounds of shapes at world poses.
#include "geom/aabb.h"

#include <avbd/hull.h>

#include <cfloat>
#include <span>

#include "base/bits.h"
#include "geom/triangles.h"

namespace avbd {
namespace {

/// The float next below (step -1) or above (+1) f, which is finite.
float neighbour(float f, int step) {
  if (f == 0) return static_cast<float>(step) * FLT_TRUE_MIN;
  const uint32_t bits = bitsAs<uint32_t>(f);
  return bitsAs<float>((f > 0) == (step > 0) ? bits + 1 : bits - 1);
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

/// How far a shape that is centred on its frame reaches along a direction of its frame, without its radius.
double reachAlong(ShapeType type, const Vec3d& e, const double* n) {
  switch (type) {
    case ShapeType::Ellipsoid:
      return length(Vec3d{n[0] * e.x, n[1] * e.y, n[2] * e.z});
    case ShapeType::Cylinder:
      return e.x * std::sqrt(n[0] * n[0] + n[2] * n[2]) + magnitude(n[1]) * e.y;
    default:
      return magnitude(n[0]) * e.x + magnitude(n[1]) * e.y + magnitude(n[2]) * e.z;
  }
}

/// Half extents of the bounds of a shape that is centred on its frame.
Vec3d reach(const ShapeGeom& geom, Quat rotation) {
  const double r = geom.radius;
  if (geom.type == ShapeType::Sphere) return {r, r, r};
  const Turn t = turn(rotation);
  // Enlarged by more than double rounding can lose.
  const double k = (1 + 1e-14) / t.scale;
  const Vec3d e{geom.extent.x * k, geom.extent.y * k, geom.extent.z * k};
  return {reachAlong(geom.type, e, t.m[0]) + r, reachAlong(geom.type, e, t.m[1]) + r,
          reachAlong(geom.type, e, t.m[2]) + r};
}

/// Lower and upper ends of a shape that is not centred, about its frame's origin in the world's directions.
struct Ends {
  double lower[3], upper[3];
};

/// Farthest of many points, either way.
void addPoints(std::span<const Vec3> points, const Turn& t, Ends& ends) {
  for (int i = 0; i < 3; ++i) {
    const double* n = t.m[i];
    double low = 1e300, high = -1e300;
    for (const Vec3& p : points) {
      const double x = n[0] * p.x + n[1] * p.y + n[2] * p.z;
      low = x < low ? x : low;
      high = x > high ? x : high;
    }
    ends.lower[i] = low;
    ends.upper[i] = high;
  }
}

/// The tip and the base's rim.
void addCone(const Vec3& extent, const Turn& t, Ends& ends) {
  for (int i = 0; i < 3; ++i) {
    const double* n = t.m[i];
    const double tip = n[1] * extent.y, rim = extent.x * std::sqrt(n[0] * n[0] + n[2] * n[2]);
    const double low = -tip - rim, high = -tip + rim;
    ends.lower[i] = tip < low ? tip : low;
    ends.upper[i] = tip > high ? tip : high;
  }
}

bool isCentred(ShapeType type) {
  return type != ShapeType::Cone && type != ShapeType::Hull && type != ShapeType::Triangle && !isSurface(type);
}

Ends endsOf(const ShapeGeom& geom, const Turn& t) {
  Ends ends;
  if (geom.type == ShapeType::Hull) addPoints(geom.hull().vertices(), t, ends);
  if (geom.type == ShapeType::Triangle) addPoints({geom.triangle(), 3}, t, ends);
  if (geom.type == ShapeType::Cone) addCone(geom.extent, t, ends);
  if (isSurface(geom.type)) {
    const Aabb box = surfaceBounds(geom);
    Vec3 corners[8];
    for (int k = 0; k < 8; ++k) {
      corners[k] = {k & 1 ? box.upper.x : box.lower.x, k & 2 ? box.upper.y : box.lower.y,
                    k & 4 ? box.upper.z : box.lower.z};
    }
    addPoints(corners, t, ends);
  }
  for (int i = 0; i < 3; ++i) {
    // Moved outwards by more than double rounding can lose.
    const double low = ends.lower[i] / t.scale, high = ends.upper[i] / t.scale;
    const double more = 1e-14 * (magnitude(low) + magnitude(high)) + geom.radius;
    ends.lower[i] = low - more;
    ends.upper[i] = high + more;
  }
  return ends;
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

Aabb bounds(const ShapeGeom& geom, const Pose& pose, float margin) {
  if (geom.type == ShapeType::HalfSpace) return halfSpaceBounds(pose, margin);
  if (!isCentred(geom.type)) {
    const Ends e = endsOf(geom, turn(pose.rotation));
    const Vec3d p = pose.position;
    const double m = margin;
    return {{roundDown(p.x + (e.lower[0] - m)), roundDown(p.y + (e.lower[1] - m)), roundDown(p.z + (e.lower[2] - m))},
            {roundUp(p.x + (e.upper[0] + m)), roundUp(p.y + (e.upper[1] + m)), roundUp(p.z + (e.upper[2] + m))}};
  }
  const Vec3d p = pose.position, e = reach(geom, pose.rotation) + Vec3{margin, margin, margin};
  const Vec3d lo = p - e, hi = p + e;
  return {{roundDown(lo.x), roundDown(lo.y), roundDown(lo.z)}, {roundUp(hi.x), roundUp(hi.y), roundUp(hi.z)}};
}

}  // namespace avbd
