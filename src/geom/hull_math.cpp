// The nearest point of a convex set: the point of least norm of a simplex that walks towards the origin (hull_math.h).
#include "geom/hull_math.h"

#include <array>
#include <cmath>

namespace avbd {

Vec3d normalized(Vec3d a) {
  // Twice: the first step brings the length into a range where the square neither under- nor overflows.
  const double size = std::fmax(std::fabs(a.x), std::fmax(std::fabs(a.y), std::fabs(a.z)));
  if (!(size > 0)) return {0, 1, 0};
  a = {a.x / size, a.y / size, a.z / size};
  const double l = length(a);
  return {a.x / l, a.y / l, a.z / l};
}

double angleOf(double x, double y) {
  constexpr double kPi = 3.14159265358979323846;
  const double size = std::sqrt(x * x + y * y);
  if (!(size > 0)) return 0;
  if (y == 0) return x > 0 ? 0 : kPi;
  // tan of half the angle, from the side that does not cancel; halved until the series is short.
  double t = x >= 0 ? y / (size + x) : (size - x) / y;
  double halvings = 2;
  for (int i = 0; i < 4; ++i, halvings *= 2) t = t / (1 + std::sqrt(1 + t * t));
  const double square = t * t;
  double sum = 0;
  for (int n = 21; n > 0; n -= 2) sum = 1.0 / n - square * sum;
  return halvings * t * sum;
}

namespace {

/// Points of a set relative to p, at most four, and the point of least norm of their hull.
struct Simplex {
  std::array<Vec3d, 4> points;
  int count = 0;
  Vec3d nearest;

  void consider(std::initializer_list<Vec3d> subset, Vec3d at, double& best) {
    const double norm = dot(at, at);
    if (!(norm < best)) return;
    best = norm;
    nearest = at;
    kept_ = 0;
    for (const Vec3d& v : subset) keptPoints_[kept_++] = v;
  }

  void edge(Vec3d a, Vec3d b, double& best) {
    const Vec3d d = b - a;
    const double t = -dot(a, d), dd = dot(d, d);
    if (t > 0 && t < dd) consider({a, b}, a + d * (t / dd), best);
  }

  void triangle(Vec3d a, Vec3d b, Vec3d c, double& best) {
    const Vec3d n = cross(b - a, c - a);
    const double nn = dot(n, n);
    if (!(nn > 0)) return;
    const bool inside = dot(cross(a, b), n) >= 0 && dot(cross(b, c), n) >= 0 && dot(cross(c, a), n) >= 0;
    if (inside) consider({a, b, c}, n * (dot(a, n) / nn), best);
  }

  bool holdsOrigin() const {
    if (count < 4) return false;
    const auto& p = points;
    const auto sameSide = [](Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
      const Vec3d n = cross(b - a, c - a);
      const double own = dot(n, d - a), origin = -dot(n, a);
      return own > 0 ? origin >= 0 : own < 0 && origin <= 0;
    };
    return sameSide(p[0], p[1], p[2], p[3]) && sameSide(p[0], p[1], p[3], p[2]) && sameSide(p[0], p[2], p[3], p[1]) &&
           sameSide(p[1], p[2], p[3], p[0]);
  }

  /// Keeps the least subset whose hull holds the point of least norm. Every subset is tried: few and simple.
  void reduce() {
    double best = 1.7e308;
    const auto& p = points;
    for (int i = 0; i < count; ++i) consider({p[i]}, p[i], best);
    for (int i = 0; i < count; ++i)
      for (int j = i + 1; j < count; ++j) edge(p[i], p[j], best);
    for (int i = 0; i < count; ++i)
      for (int j = i + 1; j < count; ++j)
        for (int k = j + 1; k < count; ++k) triangle(p[i], p[j], p[k], best);
    for (int i = 0; i < kept_; ++i) points[i] = keptPoints_[i];
    count = kept_;
  }

 private:
  std::array<Vec3d, 4> keptPoints_;
  int kept_ = 0;
};

}  // namespace

Vec3d nearestInHull(Vec3d p, std::span<const Vec3d> points) {
  Simplex s;
  s.points[0] = s.nearest = points[0] - p;
  s.count = 1;
  for (int round = 0; round < 100; ++round) {
    const Vec3d x = s.nearest;
    const double norm = dot(x, x);
    Vec3d farthest = points[0] - p;
    double least = dot(farthest, x);
    for (const Vec3d& point : points) {
      const Vec3d v = point - p;
      const double along = dot(v, x);
      if (along < least) least = along, farthest = v;
    }
    // No point lies nearer along x: x is the answer.
    if (norm - least <= 1e-13 * norm) break;
    s.points[s.count++] = farthest;
    if (s.holdsOrigin()) return p;
    s.reduce();
    if (!(dot(s.nearest, s.nearest) < norm)) {
      s.nearest = x;
      break;
    }
  }
  return p + s.nearest;
}

// By the signs that tell which corner, side or the inside is nearest (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3d nearestInTriangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3d bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const Vec3d cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double sum = va + vb + vc;
  return a + ab * (vb / sum) + ac * (vc / sum);
}

}  // namespace avbd
