// Farthest points of convex cores (support.h).
#include "collide/support.h"

#include <avbd/hull.h>

namespace avbd {
namespace {

Vec3d ofCylinder(const Vec3d& e, Vec3d d) {
  const double s = std::sqrt(d.x * d.x + d.z * d.z), y = d.y < 0 ? -e.y : e.y;
  if (!(s > 0)) return {0, y, 0};
  const double k = e.x / s;
  return {d.x * k, y, d.z * k};
}

Vec3d ofCone(const Vec3d& e, Vec3d d) {
  const double s = std::sqrt(d.x * d.x + d.z * d.z);
  if (2 * d.y * e.y >= e.x * s) return {0, e.y, 0};
  if (!(s > 0)) return {0, -e.y, 0};
  const double k = e.x / s;
  return {d.x * k, -e.y, d.z * k};
}

Vec3d ofEllipsoid(const Vec3d& e, Vec3d d) {
  const Vec3d m{e.x * d.x, e.y * d.y, e.z * d.z};
  const double l = length(m);
  if (!(l > 0)) return {0, e.y, 0};
  const double k = 1 / l;
  return {e.x * m.x * k, e.y * m.y * k, e.z * m.z * k};
}

Vec3d farthest(const Vec3* points, size_t count, Vec3d d) {
  size_t best = 0;
  double top = points[0].x * d.x + points[0].y * d.y + points[0].z * d.z;
  for (size_t i = 1; i < count; ++i) {
    const double x = points[i].x * d.x + points[i].y * d.y + points[i].z * d.z;
    best = x > top ? i : best;
    top = x > top ? x : top;
  }
  return toDouble(points[best]);
}

}  // namespace

Vec3d supportPoint(const ShapeGeom& g, Vec3d d) {
  const Vec3d e = toDouble(g.extent);
  switch (g.type) {
    case ShapeType::Capsule:
      return {0, d.y < 0 ? -e.y : e.y, 0};
    case ShapeType::Box:
    case ShapeType::RoundedBox:
      return {d.x < 0 ? -e.x : e.x, d.y < 0 ? -e.y : e.y, d.z < 0 ? -e.z : e.z};
    case ShapeType::Cylinder:
      return ofCylinder(e, d);
    case ShapeType::Cone:
      return ofCone(e, d);
    case ShapeType::Ellipsoid:
      return ofEllipsoid(e, d);
    case ShapeType::Hull:
      return farthest(g.hull().vertices().data(), g.hull().vertices().size(), d);
    case ShapeType::Triangle:
      return farthest(g.triangle(), 3, d);
    default:
      return {};
  }
}

Vec3 support(const ShapeGeom& convex, Vec3 direction) { return toFloat(supportPoint(convex, toDouble(direction))); }

Vec3d innerPoint(const ShapeGeom& g) {
  if (g.type == ShapeType::Hull) return toDouble(g.hull().center());
  if (g.type == ShapeType::Triangle) {
    const Vec3* v = g.triangle();
    return (toDouble(v[0]) + v[1] + v[2]) * (1.0 / 3);
  }
  if (g.type == ShapeType::Cone) return {0, -0.5 * g.extent.y, 0};
  return {};
}

double innerBall(const ShapeGeom& g) {
  const double x = g.extent.x, y = g.extent.y, z = g.extent.z;
  const auto least = [](double a, double b) { return a < b ? a : b; };
  switch (g.type) {
    case ShapeType::Box:
    case ShapeType::RoundedBox:
    case ShapeType::Ellipsoid:
      return least(x, least(y, z));
    case ShapeType::Cylinder:
      return least(x, y);
    case ShapeType::Cone:  // distance of the inner point from the base, and from the mantle
      return least(0.5 * y, 1.5 * y * x / std::sqrt(4 * y * y + x * x));
    case ShapeType::Hull:
      return g.hull().innerRadius();
    default:
      return 0;
  }
}

double coreSize(const ShapeGeom& g) {
  if (g.type == ShapeType::Hull || g.type == ShapeType::Triangle) {
    const Vec3d d[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    if (g.type == ShapeType::Hull) {
      const Vec3 lo = g.hull().lower(), hi = g.hull().upper();
      const Vec3 far{larger(-lo.x, hi.x), larger(-lo.y, hi.y), larger(-lo.z, hi.z)};
      return double{far.x} + far.y + far.z + g.radius;
    }
    double size = g.radius;
    for (const Vec3d& n : d) {
      const double reach = dot3(n, supportPoint(g, n));
      size += reach > 0 ? reach : 0;
    }
    return size;
  }
  return double{g.extent.x} + g.extent.y + g.extent.z + g.radius;
}

Mat3d exactMatrix(Quat q) {
  const double w = q.w, x = q.x, y = q.y, z = q.z;
  const double k = 1 / (w * w + x * x + y * y + z * z), k2 = 2 * k;
  return {{{(w * w + x * x - y * y - z * z) * k, (x * y - w * z) * k2, (x * z + w * y) * k2},
           {(x * y + w * z) * k2, (w * w - x * x + y * y - z * z) * k, (y * z - w * x) * k2},
           {(x * z - w * y) * k2, (y * z + w * x) * k2, (w * w - x * x - y * y + z * z) * k}}};
}

CorePair corePair(const ShapeGeom& a, const NearPose& poseA, const ShapeGeom& b, const NearPose& poseB) {
  CorePair p{a, b, exactMatrix(poseA.q), {}, {}, coreSize(a) + coreSize(b)};
  const Mat3d frameB = exactMatrix(poseB.q);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      p.turn.m[i][j] =
          p.frameA.m[0][i] * frameB.m[0][j] + p.frameA.m[1][i] * frameB.m[1][j] + p.frameA.m[2][i] * frameB.m[2][j];
    }
  }
  p.offset = mulT(p.frameA, toDouble(poseB.p) - poseA.p);
  return p;
}

}  // namespace avbd
