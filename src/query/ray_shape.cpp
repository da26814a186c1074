// Rays against spheres, capsules, boxes, ellipsoids, hulls and half-spaces (ray_shape.h).
#include "query/ray_shape.h"

#include <avbd/hull.h>

#include <algorithm>
#include <cmath>

#include "query/ray_round.h"

namespace avbd {
namespace {

LocalHit inside(const LocalRay& ray) { return {0, -ray.direction}; }

LocalHit raySphere(const LocalRay& ray, Vec3d center, double radius) {
  const double t = sphereEntry(ray, center, radius);
  if (t < 0) return {};
  if (t == 0) return inside(ray);
  return {t, unitOf(ray.from + ray.direction * t - center)};
}

LocalHit rayCapsule(const LocalRay& ray, Vec3d a, Vec3d b, double radius) {
  const double t = capsuleEntry(ray, a, b, radius);
  if (t < 0) return {};
  if (t == 0) return inside(ray);
  const Vec3d p = ray.from + ray.direction * t, ab = b - a;
  const double squared = dot(ab, ab);
  const double s = squared > 0 ? std::clamp(dot(p - a, ab) / squared, 0.0, 1.0) : 0;
  return {t, unitOf(p - (a + ab * s))};
}

struct Slabs {
  double in = 0, out = 0;
  int axis = -1;  ///< through whose faces the ray comes in; -1: starts inside
};

/// Box about the origin. Misses: in > out.
Slabs slabs(const LocalRay& ray, Vec3d half) {
  const double o[3] = {ray.from.x, ray.from.y, ray.from.z}, h[3] = {half.x, half.y, half.z};
  const double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
  Slabs s{0, ray.length, -1};
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0) {
      if (std::abs(o[i]) > h[i]) return {1, 0, -1};
      continue;
    }
    const double side = d[i] > 0 ? h[i] : -h[i];
    const double in = (-side - o[i]) / d[i], out = (side - o[i]) / d[i];
    if (in > s.in) {
      s.in = in;
      s.axis = i;
    }
    s.out = std::min(s.out, out);
  }
  return s;
}

Vec3d axisAgainst(const LocalRay& ray, int axis) {
  const double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
  double n[3] = {0, 0, 0};
  n[axis] = d[axis] > 0 ? -1 : 1;
  return {n[0], n[1], n[2]};
}

LocalHit rayBox(const LocalRay& ray, Vec3d half) {
  const Slabs s = slabs(ray, half);
  if (s.in > s.out) return {};
  if (s.axis < 0) return inside(ray);
  return {s.in, axisAgainst(ray, s.axis)};
}

/// The box grown by the radius is met first; where that is beside the core's edges, the edges' capsules at the nearest
/// corner decide (Ericson, Real-Time Collision Detection, 5.5.7).
LocalHit rayRoundedBox(const LocalRay& ray, Vec3d half, double radius) {
  const Slabs s = slabs(ray, half + Vec3d{radius, radius, radius});
  if (s.in > s.out) return {};
  const Vec3d p = ray.from + ray.direction * s.in;
  const int beside = (std::abs(p.x) > half.x) + (std::abs(p.y) > half.y) + (std::abs(p.z) > half.z);
  if (beside < 2) return s.axis < 0 ? inside(ray) : LocalHit{s.in, axisAgainst(ray, s.axis)};
  const Vec3d corner{std::copysign(half.x, p.x), std::copysign(half.y, p.y), std::copysign(half.z, p.z)};
  LocalHit best;
  const Vec3d ends[3] = {
      {-corner.x, corner.y, corner.z}, {corner.x, -corner.y, corner.z}, {corner.x, corner.y, -corner.z}};
  for (const Vec3d& end : ends) {
    const LocalHit hit = rayCapsule(ray, corner, end, radius);
    if (hit && (!best || hit.distance < best.distance)) best = hit;
  }
  return best;
}

LocalHit rayEllipsoid(const LocalRay& ray, Vec3d half) {
  // The ellipsoid is a unit ball in coordinates over its half axes.
  const auto over = [&](Vec3d v) { return Vec3d{v.x / half.x, v.y / half.y, v.z / half.z}; };
  const Vec3d stretched = over(ray.direction);
  const double k = length(stretched);
  const LocalRay round{over(ray.from), stretched * (1 / k), ray.length * k};
  const double t = sphereEntry(round, {}, 1);
  if (t < 0) return {};
  if (t == 0) return inside(ray);
  return {t / k, unitOf(over(round.from + round.direction * t))};
}

LocalHit rayHalfSpace(const LocalRay& ray) {
  if (ray.from.y <= 0) return inside(ray);
  if (ray.direction.y >= 0) return {};
  const double t = ray.from.y / -ray.direction.y;
  return t <= ray.length ? LocalHit{t, {0, 1, 0}} : LocalHit{};
}

/// Cut by every face's plane.
LocalHit rayHull(const LocalRay& ray, const HullData& hull) {
  const Vec3d lower = toDouble(hull.lower()), upper = toDouble(hull.upper());
  const LocalRay centred{ray.from - (lower + upper) * 0.5, ray.direction, ray.length};
  const Slabs s = slabs(centred, (upper - lower) * (0.5 * (1 + 1e-6)));
  if (s.in > s.out) return {};
  double in = 0, out = ray.length;
  const HullData::Face* entered = nullptr;
  for (const HullData::Face& face : hull.faces()) {
    const Vec3d n = toDouble(face.normal);
    const double above = dot(n, ray.from) - static_cast<double>(face.offset), speed = dot(n, ray.direction);
    if (speed == 0) {
      if (above > 0) return {};
      continue;
    }
    const double t = -above / speed;
    if (speed < 0 && t > in) {
      in = t;
      entered = &face;
    }
    if (speed > 0) out = std::min(out, t);
    if (in > out) return {};
  }
  return entered ? LocalHit{in, unitOf(toDouble(entered->normal))} : inside(ray);
}

}  // namespace

bool hasExactRay(const ShapeGeom& geom) {
  const bool onlySharp =
      geom.type == ShapeType::Cylinder || geom.type == ShapeType::Cone || geom.type == ShapeType::Hull;
  return geom.type != ShapeType::Triangle && !isSurface(geom.type) && !(onlySharp && geom.radius > 0) &&
         !(geom.type == ShapeType::Ellipsoid && geom.radius > 0);
}

LocalHit rayShape(const ShapeGeom& geom, const LocalRay& ray) {
  const double radius = geom.radius;
  const Vec3d half = toDouble(geom.extent);
  switch (geom.type) {
    case ShapeType::Sphere:
      return raySphere(ray, {}, radius);
    case ShapeType::Capsule:
      return rayCapsule(ray, {0, -half.y, 0}, {0, half.y, 0}, radius);
    case ShapeType::Box:
    case ShapeType::RoundedBox:
      return radius > 0 ? rayRoundedBox(ray, half, radius) : rayBox(ray, half);
    case ShapeType::Cylinder:
      return rayCylinder(ray, half.x, half.y);
    case ShapeType::Cone:
      return rayCone(ray, half.x, half.y);
    case ShapeType::Ellipsoid:
      return rayEllipsoid(ray, half);
    case ShapeType::Hull:
      return rayHull(ray, geom.hull());
    case ShapeType::HalfSpace:
      return rayHalfSpace(ray);
    default:
      return {};
  }
}

LocalHit rayTriangle(const Vec3 (&v)[3], const LocalRay& ray, bool backFaces) {
  // Signed volumes of the ray with each edge, taken in one order for both triangles of an edge: their signs agree
  // exactly, so that nothing slips between them.
  const Vec3d a = toDouble(v[0]) - ray.from, b = toDouble(v[1]) - ray.from, c = toDouble(v[2]) - ray.from;
  const double u = dot(ray.direction, crossOf(b, c)), w = dot(ray.direction, crossOf(c, a));
  const double x = dot(ray.direction, crossOf(a, b));
  const Vec3d n = crossOf(b - a, c - a);
  const double speed = dot(n, ray.direction);
  if (speed == 0 || (speed > 0 && !backFaces)) return {};
  const bool front = u <= 0 && w <= 0 && x <= 0, back = u >= 0 && w >= 0 && x >= 0;
  if (!(speed < 0 ? front : back)) return {};
  const double t = dot(n, a) / speed;
  if (!(t >= 0 && t <= ray.length)) return {};
  return {t, unitOf(speed < 0 ? n : -n)};
}

}  // namespace avbd
