// Rays against the solids of zones: where along the ray each begins and ends.
#include "io/probe_zone.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace avbd {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The part of a line that lies in something; empty where first > last.
struct Part {
  double first = -kInfinity, last = kInfinity;
  bool isAhead() const { return first <= last && last >= 0; }
};

Part both(Part a, Part b) { return {std::max(a.first, b.first), std::min(a.last, b.last)}; }

/// Where a t^2 + 2 b t + c <= 0, for a >= 0.
Part below(double a, double b, double c) {
  if (a == 0) return c <= 0 ? Part{} : Part{1, 0};
  const double root = b * b - a * c;
  if (root < 0) return {1, 0};
  const double half = std::sqrt(root);
  return {(-b - half) / a, (-b + half) / a};
}

Part ball(Vec3d p, Vec3d d, double radius) { return below(dot(d, d), dot(p, d), dot(p, p) - radius * radius); }

Part slab(double p, double d, double half) {
  if (d == 0) return std::abs(p) <= half ? Part{} : Part{1, 0};
  const double a = (-half - p) / d, b = (half - p) / d;
  return {std::min(a, b), std::max(a, b)};
}

Part tube(Vec3d p, Vec3d d, double radius, double half) {
  const Part round = below(d.x * d.x + d.y * d.y, p.x * d.x + p.y * d.y, p.x * p.x + p.y * p.y - radius * radius);
  return both(round, slab(p.z, d.z, half));
}

Vec3d over(Vec3d v, Vec3d size) { return {v.x / size.x, v.y / size.y, v.z / size.z}; }

}  // namespace

bool meets(const ProbeZone& zone, Vec3d p, Vec3d d) {
  const Vec3d size = zone.size;
  switch (zone.kind) {
    case ProbeZone::Kind::Sphere:
      return ball(p, d, size.x).isAhead();
    case ProbeZone::Kind::Capsule: {
      const Vec3d up{0, 0, size.y};
      return tube(p, d, size.x, size.y).isAhead() || ball(p - up, d, size.x).isAhead() ||
             ball(p + up, d, size.x).isAhead();
    }
    case ProbeZone::Kind::Ellipsoid:
      return ball(over(p, size), over(d, size), 1).isAhead();
    case ProbeZone::Kind::Cylinder:
      return tube(p, d, size.x, size.y).isAhead();
    case ProbeZone::Kind::Box:
      return both(slab(p.x, d.x, size.x), both(slab(p.y, d.y, size.y), slab(p.z, d.z, size.z))).isAhead();
  }
  return false;
}

}  // namespace avbd
