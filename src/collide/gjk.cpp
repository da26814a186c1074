// Distance of two convex cores (gjk.h).
#include "collide/gjk.h"

namespace avbd {
namespace {

constexpr int kMaxSteps = 96;
constexpr double kFlat = 1e-12;    // of the size: height of a tetrahedron that may be rounding
constexpr double kEnough = 1e-12;  // of the squared distance: gap between the bounds at which the walk ends

void keep(Simplex& s, int i, double wi) {
  s.point[0] = s.point[i];
  s.weight[0] = wi;
  s.count = 1;
}

/// i < j.
void keep(Simplex& s, int i, double wi, int j, double wj) {
  s.point[0] = s.point[i];
  s.point[1] = s.point[j];
  s.weight[0] = wi;
  s.weight[1] = wj;
  s.count = 2;
}

/// Nearest point of the segment of points i < j to the origin.
void nearestOnSegment(Simplex& s, int i, int j) {
  const Vec3d a = s.point[i].w, ab = s.point[j].w - a;
  const double t = -dot3(a, ab), l = dot3(ab, ab);
  if (t <= 0 || !(l > 0)) return keep(s, i, 1);
  if (t >= l) return keep(s, j, 1);
  const double k = t / l;
  keep(s, i, 1 - k, j, k);
}

/// Nearest point of the triangle of points 0, 1, 2 (Ericson, Real-Time Collision Detection, 5.1.5).
void nearestOnTriangle(Simplex& s) {
  const Vec3d a = s.point[0].w, b = s.point[1].w, c = s.point[2].w, ab = b - a, ac = c - a;
  const double d1 = -dot3(ab, a), d2 = -dot3(ac, a);
  if (d1 <= 0 && d2 <= 0) return keep(s, 0, 1);
  const double d3 = -dot3(ab, b), d4 = -dot3(ac, b);
  if (d3 >= 0 && d4 <= d3) return keep(s, 1, 1);
  const Vec3d n = cross3(ab, ac);
  // Parts of the area by triple products: far less rounding than differences of products of the dots above.
  const double vc = dot3(n, cross3(a, b));
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return keep(s, 0, d3 / (d3 - d1), 1, d1 / (d1 - d3));
  const double d5 = -dot3(ab, c), d6 = -dot3(ac, c);
  if (d6 >= 0 && d5 <= d6) return keep(s, 2, 1);
  const double vb = dot3(n, cross3(c, a));
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return keep(s, 0, d6 / (d6 - d2), 2, d2 / (d2 - d6));
  const double va = dot3(n, cross3(b, c));
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double l = (d4 - d3) + (d5 - d6);
    if (l > 0) return keep(s, 1, (d5 - d6) / l, 2, (d4 - d3) / l);
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return nearestOnSegment(s, 0, dot3(ab, ab) > dot3(ac, ac) ? 1 : 2);
  s.weight[0] = va / sum;
  s.weight[1] = vb / sum;
  s.weight[2] = vc / sum;
}

Vec3d pointOf(const Simplex& s) {
  Vec3d p = s.point[0].w * s.weight[0];
  for (int i = 1; i < s.count; ++i) p = p + s.point[i].w * s.weight[i];
  return p;
}

/// Four points that lie in a plane up to the rounding of coordinates of this size.
bool isFlat(const Simplex& s, double size) {
  const Vec3d a = s.point[0].w, ab = s.point[1].w - a, ac = s.point[2].w - a, ad = s.point[3].w - a;
  const double volume = dot3(cross3(ab, ac), ad), b2 = dot3(ab, ab), c2 = dot3(ac, ac), d2 = dot3(ad, ad);
  const double rounding = kFlat * size;
  return volume * volume <= rounding * rounding * (b2 * c2 + c2 * d2 + d2 * b2);
}

/// Nearest of the faces that have the origin on their outer side; none: the simplex holds it and stays. Of a flat one
/// nothing says which side is the outer one.
void nearestOnTetrahedron(Simplex& s, double size) {
  constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  const bool flat = isFlat(s, size);
  Simplex best;
  double least = 0;
  for (const int* f : kFaces) {
    const Vec3d a = s.point[f[0]].w;
    const Vec3d n = cross3(s.point[f[1]].w - a, s.point[f[2]].w - a);
    const double origin = -dot3(n, a), inside = dot3(n, s.point[f[3]].w - a);
    if (!flat && (inside > 0 ? origin >= 0 : origin <= 0)) continue;
    Simplex t;
    t.count = 3;
    for (int i = 0; i < 3; ++i) t.point[i] = s.point[f[i]];
    nearestOnTriangle(t);
    const Vec3d v = pointOf(t);
    const double d = dot3(v, v);
    if (best.count > 0 && d >= least) continue;
    best = t;
    least = d;
  }
  if (best.count > 0) {
    s = best;
  } else {
    for (double& w : s.weight) w = 0.25;
  }
}

void nearestOn(Simplex& s, double size) {
  if (s.count == 1) s.weight[0] = 1;
  if (s.count == 2) nearestOnSegment(s, 0, 1);
  if (s.count == 3) nearestOnTriangle(s);
  if (s.count == 4) nearestOnTetrahedron(s, size);
}

bool has(const Simplex& s, Vec3d w) {
  for (int i = 0; i < s.count; ++i) {
    if (s.point[i].w == w) return true;
  }
  return false;
}

}  // namespace

Gjk gjk(const CorePair& pair, Vec3d start, double beyond) {
  Gjk g;
  const double touching = kTouching * pair.size;
  if (!(dot3(start, start) > 0)) start = {0, 1, 0};
  g.simplex.point[0] = lowest(pair, start);
  g.simplex.count = 1;
  g.simplex.weight[0] = 1;
  g.v = g.simplex.point[0].w;
  double squared = dot3(g.v, g.v);
  for (int step = 0; step < kMaxSteps; ++step) {
    if (squared <= touching * touching) return g;
    const DifferencePoint p = lowest(pair, g.v);
    const double along = dot3(g.v, p.w);
    if (along > 0) {
      const double bound = along / std::sqrt(squared);
      if (bound > g.lower) g.lower = bound;
      if (g.lower > beyond) {
        g.result = GjkResult::Apart;
        return g;
      }
    }
    g.result = GjkResult::Near;
    if (squared - along <= kEnough * squared || has(g.simplex, p.w)) return g;
    Simplex next = g.simplex;
    next.point[next.count++] = p;
    nearestOn(next, pair.size);
    if (next.count == 4) {
      g.simplex = next;
      g.result = GjkResult::Overlap;
      return g;
    }
    const Vec3d v = pointOf(next);
    const double now = dot3(v, v);
    if (!(now < squared)) return g;
    g.simplex = next;
    g.v = v;
    squared = now;
    g.result = GjkResult::Overlap;
  }
  g.result = GjkResult::Near;
  return g;
}

}  // namespace avbd
