// Rays against balls, capsules, cylinders and cones (ray_round.h).
#include "query/ray_round.h"

#include <algorithm>
#include <cmath>

namespace avbd {
namespace {

LocalHit nearer(const LocalHit& a, const LocalHit& b) {
  if (!a) return b;
  return b && b.distance < a.distance ? b : a;
}

LocalHit within(const LocalRay& ray, double t, Vec3d normal) {
  return t >= 0 && t <= ray.length ? LocalHit{t, normal} : LocalHit{};
}

/// First crossing of the disc at this height, for a ray that comes from the normal's side.
LocalHit rayDisc(const LocalRay& ray, double y, double radius, double normal) {
  if (!(ray.direction.y * normal < 0)) return {};
  const double t = (y - ray.from.y) / ray.direction.y;
  const double px = ray.from.x + ray.direction.x * t, pz = ray.from.z + ray.direction.z * t;
  return px * px + pz * pz <= radius * radius ? within(ray, t, {0, normal, 0}) : LocalHit{};
}

}  // namespace

double sphereEntry(const LocalRay& ray, Vec3d center, double radius) {
  const Vec3d o = ray.from - center;
  if (dot(o, o) <= radius * radius) return 0;
  const double along = dot(o, ray.direction);
  if (along >= 0) return -1;
  // From the ray's nearest point: the usual discriminant loses a small ball far away.
  const Vec3d near = o - ray.direction * along;
  const double left = radius * radius - dot(near, near);
  if (left < 0) return -1;
  const double t = std::max(0.0, -along - std::sqrt(left));
  return t <= ray.length ? t : -1;
}

double capsuleEntry(const LocalRay& ray, Vec3d a, Vec3d b, double radius) {
  const Vec3d ab = b - a;
  const double squared = dot(ab, ab);
  if (!(squared > 0)) return sphereEntry(ray, a, radius);
  const Vec3d axis = ab * (1 / std::sqrt(squared));
  // Across the axis the side is a circle.
  const Vec3d o = ray.from - a;
  const Vec3d across = o - axis * dot(o, axis);
  const double speedAlong = dot(ray.direction, axis);
  const Vec3d d = ray.direction - axis * speedAlong;
  const double s = std::clamp(dot(o, axis) / std::sqrt(squared), 0.0, 1.0);
  const Vec3d apart = o - ab * s;
  if (dot(apart, apart) <= radius * radius) return 0;
  const double speed = length(d);
  if (speed > 1e-12) {
    const LocalRay flat{across, d * (1 / speed), ray.length * speed};
    const double reach = sphereEntry(flat, {}, radius);
    if (reach < 0) return -1;
    const double t = reach / speed;
    const double height = dot(o, axis) + speedAlong * t;
    // The ray may start within the endless cylinder but beyond the ends.
    if (t > 0 && height >= 0 && height * height <= squared) return t <= ray.length ? t : -1;
  }
  const double first = sphereEntry(ray, a, radius), second = sphereEntry(ray, b, radius);
  if (first < 0 || second < 0) return std::max(first, second);
  return std::min(first, second);
}

LocalHit rayCylinder(const LocalRay& ray, double radius, double halfHeight) {
  const Vec3d flat{ray.from.x, 0, ray.from.z}, d{ray.direction.x, 0, ray.direction.z};
  const bool inCircle = dot(flat, flat) <= radius * radius;
  if (inCircle && std::abs(ray.from.y) <= halfHeight) return {0, -ray.direction};
  const double side = ray.from.y > 0 ? 1 : -1;
  LocalHit hit;
  if (std::abs(ray.from.y) > halfHeight) hit = rayDisc(ray, side * halfHeight, radius, side);
  const double speed = length(d);
  if (inCircle || !(speed > 0)) return hit;
  const double reach = sphereEntry({flat, d * (1 / speed), ray.length * speed}, {}, radius);
  if (reach < 0) return hit;
  const double t = reach / speed;
  const Vec3d p = ray.from + ray.direction * t;
  if (std::abs(p.y) > halfHeight) return hit;
  return nearer(hit, within(ray, t, unitOf({p.x, 0, p.z})));
}

LocalHit rayCone(const LocalRay& ray, double radius, double halfHeight) {
  // x^2 + z^2 = (k (halfHeight - y))^2 below the tip.
  const double k = radius / (2 * halfHeight), down = halfHeight - ray.from.y;
  const Vec3d o = ray.from, d = ray.direction;
  const double flat = o.x * o.x + o.z * o.z;
  if (std::abs(o.y) <= halfHeight && flat <= k * k * down * down) return {0, -d};
  LocalHit hit = rayDisc(ray, -halfHeight, radius, -1);
  // Solved about the ray's point nearest to the middle, so that far starts lose nothing.
  const double shift = -dot(o, d);
  const Vec3d c = o + d * shift;
  const double drop = halfHeight - c.y;
  const double qa = d.x * d.x + d.z * d.z - k * k * d.y * d.y;
  const double qb = c.x * d.x + c.z * d.z + k * k * drop * d.y;
  const double qc = c.x * c.x + c.z * c.z - k * k * drop * drop;
  const double disc = qb * qb - qa * qc;
  if (disc < 0) return hit;
  const double root = std::sqrt(disc), q = qb > 0 ? -qb - root : -qb + root;
  for (const double t : {qa != 0 ? q / qa : -1e300, q != 0 ? qc / q : -1e300}) {
    const Vec3d p = c + d * t;
    if (!(std::abs(p.y) <= halfHeight)) continue;
    const Vec3d out{p.x, k * k * (halfHeight - p.y), p.z};
    const double size = length(out);
    if (!(size > 0) || dot(out, d) > 0) continue;
    hit = nearer(hit, within(ray, shift + t, out * (1 / size)));
  }
  return hit;
}

}  // namespace avbd
