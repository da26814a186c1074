// For the tests: distances and depths found in double by trying everything, sharing no code with the engine.
#pragma once

#include <avbd/hull.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "collide/collide.h"
#include "geom/hull.h"

namespace avbd::oracle {

inline Vec3d unitRotate(Quat q, Vec3d v) {
  const double w = q.w, x = q.x, y = q.y, z = q.z, n = w * w + x * x + y * y + z * z;
  return {((w * w + x * x - y * y - z * z) * v.x + 2 * (x * y - w * z) * v.y + 2 * (x * z + w * y) * v.z) / n,
          (2 * (x * y + w * z) * v.x + (w * w - x * x + y * y - z * z) * v.y + 2 * (y * z - w * x) * v.z) / n,
          (2 * (x * z - w * y) * v.x + 2 * (y * z + w * x) * v.y + (w * w - x * x - y * y + z * z) * v.z) / n};
}

inline Vec3d crossOf(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/// A convex core (corners, edges, faces' normals) and a radius about it.
struct Solid {
  std::vector<Vec3d> corners;
  std::vector<std::pair<int, int>> edges;
  std::vector<Vec3d> axes;  ///< of a box: its three axes
  Vec3d center, extent;
  double radius = 0;
};

inline Solid solidOf(const ShapeGeom& g, const NearPose& pose) {
  Solid s;
  s.center = toDouble(pose.p);
  s.radius = g.radius;
  s.extent = toDouble(g.extent);
  if (g.type == ShapeType::Sphere) s.corners = {s.center};
  if (g.type == ShapeType::Capsule) {
    const Vec3d half = unitRotate(pose.q, Vec3d{0, g.extent.y, 0});
    s.corners = {s.center - half, s.center + half};
    s.edges = {{0, 1}};
  }
  if (g.type == ShapeType::Box) {
    for (int k = 0; k < 8; ++k) {
      const Vec3d c{k & 1 ? g.extent.x : -g.extent.x, k & 2 ? g.extent.y : -g.extent.y,
                    k & 4 ? g.extent.z : -g.extent.z};
      s.corners.push_back(s.center + unitRotate(pose.q, c));
      for (int bit = 1; bit < 8; bit *= 2) {
        if (!(k & bit)) s.edges.push_back({k, k | bit});
      }
    }
    s.axes = {unitRotate(pose.q, Vec3d{1, 0, 0}), unitRotate(pose.q, Vec3d{0, 1, 0}),
              unitRotate(pose.q, Vec3d{0, 0, 1})};
  }
  return s;
}

/// Gap between two cores along a direction: negative where they overlap along it.
inline double gapAlong(const Solid& a, const Solid& b, Vec3d n) {
  double top = -1e300, bottom = 1e300;
  for (const Vec3d& c : a.corners) top = std::max(top, dot(n, c));
  for (const Vec3d& c : b.corners) bottom = std::min(bottom, dot(n, c));
  return bottom - top;
}

/// Largest gap over every axis that can matter: minus the depth of overlap where the cores overlap.
inline double leastOverlap(const Solid& a, const Solid& b) {
  std::vector<Vec3d> tries = a.axes;
  tries.insert(tries.end(), b.axes.begin(), b.axes.end());
  for (const auto& i : a.edges) {
    for (const auto& j : b.edges) {
      const Vec3d n = crossOf(a.corners[static_cast<size_t>(i.second)] - a.corners[static_cast<size_t>(i.first)],
                              b.corners[static_cast<size_t>(j.second)] - b.corners[static_cast<size_t>(j.first)]);
      const double l = length(n);
      if (l > 1e-7) tries.push_back(n * (1 / l));
    }
  }
  double best = -1e300;
  for (const Vec3d& n : tries) best = std::max({best, gapAlong(a, b, n), gapAlong(a, b, n * -1)});
  return best;
}

inline double segmentDistance(Vec3d p1, Vec3d q1, Vec3d p2, Vec3d q2) {
  // The squared distance is convex: the inner minimum over t is exact, the outer one by golden section.
  const Vec3d d1 = q1 - p1, d2 = q2 - p2;
  const auto at = [&](double s) {
    const Vec3d p = p1 + d1 * s;
    const double dd = dot(d2, d2), t = dd > 0 ? std::clamp(dot(p - p2, d2) / dd, 0.0, 1.0) : 0;
    return length(p2 + d2 * t - p);
  };
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) * 0.381966, b = low + (high - low) * 0.618034;
    (at(a) < at(b) ? high : low) = at(a) < at(b) ? b : a;
  }
  return std::min({at(0.5 * (low + high)), at(0), at(1)});
}

/// Distance of a point from a box; inside, minus the distance to the nearest face.
inline double boxDistance(const Solid& box, Vec3d p) {
  const Vec3d d = p - box.center;
  const double h[3] = {box.extent.x, box.extent.y, box.extent.z};
  double outside = 0, inside = -1e300;
  for (int i = 0; i < 3; ++i) {
    const double over = std::fabs(dot(box.axes[static_cast<size_t>(i)], d)) - h[i];
    outside += over > 0 ? over * over : 0;
    inside = std::max(inside, over);
  }
  return outside > 0 ? std::sqrt(outside) : inside;
}

/// Distance of a point from a solid's surface, negative inside.
inline double surfaceDistance(const Solid& s, Vec3d p) {
  if (!s.axes.empty()) return boxDistance(s, p);
  return segmentDistance(p, p, s.corners.front(), s.corners.back()) - s.radius;
}

/// Distance of two cores that do not overlap.
inline double coreDistance(const Solid& a, const Solid& b) {
  double best = 1e300;
  for (const Solid* s : {&a, &b}) {
    const Solid& o = s == &a ? b : a;
    for (const Vec3d& c : s->corners) {
      if (!o.axes.empty()) best = std::min(best, boxDistance(o, c));
      if (o.corners.size() <= 2) best = std::min(best, segmentDistance(c, c, o.corners.front(), o.corners.back()));
    }
  }
  for (const auto& i : a.edges) {
    for (const auto& j : b.edges)
      best = std::min(
          best, segmentDistance(a.corners[static_cast<size_t>(i.first)], a.corners[static_cast<size_t>(i.second)],
                                b.corners[static_cast<size_t>(j.first)], b.corners[static_cast<size_t>(j.second)]));
  }
  return best;
}

/// Gap of two bounded shapes: their distance, or minus the least depth of overlap.
inline double separation(const Solid& a, const Solid& b) {
  const bool volume = !a.axes.empty() || !b.axes.empty();
  const double overlap = volume ? leastOverlap(a, b) : 1;
  return (overlap < 0 ? overlap : coreDistance(a, b)) - a.radius - b.radius;
}

/// Hulls of all sorts, made once: boxes, wedges, balls, needles, pancakes.
inline const std::vector<std::shared_ptr<const HullData>>& hulls() {
  static const std::vector<std::shared_ptr<const HullData>> all = [] {
    std::vector<std::shared_ptr<const HullData>> made;
    std::mt19937 random(99);
    std::uniform_real_distribution<float> unit(-1, 1);
    const Vec3 stretch[] = {{1, 1, 1}, {0.6f, 0.3f, 0.9f}, {0.05f, 0.7f, 0.06f}, {0.8f, 0.04f, 0.8f}};
    for (int i = 0; i < 32; ++i) {
      std::vector<Vec3> points;
      const Vec3 k = stretch[i % 4];
      const int count = i < 4 ? 8 : (i < 8 ? 4 : 6 + i);
      while (static_cast<int>(points.size()) < count) {
        const size_t n = points.size();
        const Vec3 p{unit(random), unit(random), unit(random)};
        const float l = length(p);
        if (i < 4) {
          points.push_back({n & 1 ? k.x : -k.x, n & 2 ? k.y : -k.y, n & 4 ? k.z : -k.z});
        } else if (l > 0.1f) {
          points.push_back({p.x / l * k.x + 0.1f * k.x, p.y / l * k.y, p.z / l * k.z});
        }
      }
      made.push_back(makeHull({.points = points}));
    }
    return made;
  }();
  return all;
}

/// The shape k times as large.
inline ShapeGeom scaled(const ShapeGeom& g, float k) {
  static std::map<std::pair<const void*, float>, std::shared_ptr<const HullData>> kept;
  ShapeGeom s = g;
  s.radius *= k;
  s.extent = s.extent * k;
  if (g.type == ShapeType::Hull) {
    for (const auto& hull : hulls()) {
      if (hull.get() != g.data) continue;
      auto& large = kept[{g.data, k}];
      if (!large) large = scaledHull(hull, {k, k, k});
      s.data = large.get();
    }
  }
  return s;
}

class Random {
 public:
  explicit Random(uint32_t seed) : random_(seed) {}
  float unit() { return std::uniform_real_distribution<float>(0, 1)(random_); }
  float within(float low, float high) { return low + (high - low) * unit(); }
  int below(int n) { return static_cast<int>(random_() % static_cast<uint32_t>(n)); }
  Quat rotation() {
    std::normal_distribution<float> normal;
    return normalized({normal(random_), normal(random_), normal(random_), normal(random_)});
  }
  static Quat normalized(Quat q) {
    const float k = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {q.w * k, q.x * k, q.y * k, q.z * k};
  }
  /// Anything, or near an alignment that piles have.
  Quat usualRotation() {
    const float tilt[] = {0, 1e-7f, 1e-5f, 1e-3f, 0.02f, 0.1f};
    const float e = tilt[below(6)], yaw = tilt[below(6)] * 5;
    const float s = std::sqrt(0.5f);
    const Quat quarter[] = {{1, 0, 0, 0}, {s, s, 0, 0}, {s, 0, s, 0}, {s, 0, 0, -s}, {0.5f, 0.5f, 0.5f, 0.5f}};
    if (below(3) == 0) return rotation();
    const Quat q{1, within(-e, e), within(-yaw, yaw), within(-e, e)};
    return normalized(q * quarter[below(5)]);
  }
  float rounding() { return below(3) ? 0 : within(0.01f, 0.2f); }
  ShapeGeom shape(ShapeType type) {
    const bool thin = below(4) == 0;
    switch (type) {
      case ShapeType::Sphere:
        return toShapeGeom(Sphere{within(0.1f, 1)});
      case ShapeType::Capsule:
        return toShapeGeom(Capsule{within(0.1f, 1), below(5) ? within(0.1f, 1) : 0});
      case ShapeType::Box:
        return toShapeGeom(Box{within(0.1f, 1), thin ? 0.02f : within(0.1f, 1), within(0.1f, 1)});
      case ShapeType::Cylinder:
        return toShapeGeom(Cylinder{within(0.1f, 1), thin ? 0.02f : within(0.1f, 1), rounding()});
      case ShapeType::Cone:
        return toShapeGeom(Cone{within(0.1f, 1), within(0.1f, 1), rounding()});
      case ShapeType::Ellipsoid:
        return toShapeGeom(Ellipsoid{within(0.1f, 1), thin ? 0.05f : within(0.1f, 1), within(0.1f, 1)});
      case ShapeType::RoundedBox:
        return toShapeGeom(Box{within(0.1f, 1), thin ? 0.02f : within(0.1f, 1), within(0.1f, 1), within(0.01f, 0.3f)});
      case ShapeType::Hull:
        return toShapeGeom(Hull{hulls()[static_cast<size_t>(below(32))], {1, 1, 1}, rounding()});
      default:
        break;
    }
    return toShapeGeom(HalfSpace{});
  }

 private:
  std::mt19937 random_;
};

/// Two shapes near each other, and a margin.
struct Scene {
  ShapeGeom a, b;
  NearPose poseA, poseB;
  float margin;
  Manifold collide() const {
    Manifold m;
    avbd::collide(a, poseA, b, poseB, margin, m);
    return m;
  }
};

inline float size(const ShapeGeom& g) {
  if (g.type == ShapeType::Hull) {
    const Vec3 lo = g.hull().lower(), hi = g.hull().upper();
    return g.radius + std::max({-lo.x, -lo.y, -lo.z, hi.x, hi.y, hi.z});
  }
  return g.radius + std::max({g.extent.x, g.extent.y, g.extent.z});
}
inline float thinnest(const ShapeGeom& g) {
  if (g.type == ShapeType::Hull) return g.radius + g.hull().innerRadius();
  if (g.type > ShapeType::Box && isConvex(g.type)) return g.radius + std::min({g.extent.x, g.extent.y, g.extent.z});
  if (g.type == ShapeType::Box) return std::min({g.extent.x, g.extent.y, g.extent.z});
  return g.type == ShapeType::HalfSpace ? 1e9f : g.radius;
}

inline Scene randomScene(Random& random, ShapeType a, ShapeType b) {
  Scene s{random.shape(a), random.shape(b), {}, {}, 0};
  s.poseA = {{random.within(-1, 1), random.within(-1, 1), random.within(-1, 1)}, random.usualRotation()};
  s.poseB.q = random.usualRotation();
  // Distances around touching, from deep inside to apart; sometimes level or in line.
  const float reach = (size(s.a) + size(s.b)) * random.within(0.0f, 1.2f);
  Vec3 d = rotate(random.rotation(), Vec3{1, 0, 0});
  if (random.below(3) == 0) d = {0, random.below(2) ? 1.0f : -1.0f, 0};
  if (random.below(3) == 0) d.z = 0;
  s.poseB.p = s.poseA.p + d * reach;
  s.margin = (random.below(2) ? 0.02f : 0.3f) * std::min(size(s.a), size(s.b));
  return s;
}

}  // namespace avbd::oracle
