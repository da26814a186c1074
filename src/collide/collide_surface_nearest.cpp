// Nearest points of a convex shape and one triangle: spheres and capsules exactly, the rest by nearest().
#include "collide/collide_surface_parts.h"

namespace avbd {
namespace {

/// Nearest points of the segments p .. p + d and q .. q + e.
/// Ericson, Real-Time Collision Detection (2005), section 5.1.9.
void closestOnSegments(Vec3 p, Vec3 d, Vec3 q, Vec3 e, Vec3& onFirst, Vec3& onSecond) {
  const Vec3 r = p - q;
  const float a = dot(d, d), b = dot(d, e), c = dot(d, r), f = dot(e, r), ee = dot(e, e);
  const float area = a * ee - b * b;
  float s = area > 1e-7f * a * ee ? clampTo((b * f - c * ee) / area, 0, 1) : 0.5f;
  float t = ee > 0 ? (b * s + f) / ee : 0;
  if (t < 0 || t > 1) {
    t = clampTo(t, 0, 1);
    s = a > 0 ? clampTo((b * t - c) / a, 0, 1) : 0;
  }
  onFirst = p + d * s;
  onSecond = q + e * t;
}

struct Best {
  Vec3 a, b;
  float squared = 1e30f;
  void take(Vec3 onA, Vec3 onB) {
    const float d = dot(onA - onB, onA - onB);
    if (d < squared) *this = {onA, onB, d};
  }
};

/// Whether the segment passes through the triangle.
bool crosses(Vec3 start, Vec3 end, const NearTriangle& t) {
  const float h0 = dot(t.normal, start - t.v[0]), h1 = dot(t.normal, end - t.v[0]);
  if ((h0 > 0) == (h1 > 0)) return false;
  const Vec3 at = start + (end - start) * (h0 / (h0 - h1));
  for (int i = 0; i < 3; ++i) {
    if (dot(cross(t.v[(i + 1) % 3] - t.v[i], t.normal), at - t.v[i]) > 0) return false;
  }
  return true;
}

Nearest fromCore(const ConvexView& convex, const NearTriangle& t, const Best& best) {
  const float r = convex.geom.radius, distance = std::sqrt(best.squared);
  Nearest n;
  n.distance = distance - r;
  n.apart = n.distance >= convex.margin;
  n.normal = distance > kNoDirection * convex.size ? (best.b - best.a) * (1 / distance) : -t.normal;
  n.pointA = best.a + n.normal * r;
  n.pointB = best.b;
  return n;
}

}  // namespace

/// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
Vec3 closestOnTriangle(Vec3 p, const Vec3* v) {
  const Vec3 ab = v[1] - v[0], ac = v[2] - v[0], ap = p - v[0];
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return v[0];
  const Vec3 bp = p - v[1];
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return v[1];
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return v[0] + ab * (d1 / (d1 - d3));
  const Vec3 cp = p - v[2];
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return v[2];
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return v[0] + ac * (d2 / (d2 - d6));
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return v[1] + (v[2] - v[1]) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  const float sum = va + vb + vc;
  return v[0] + ab * (vb / sum) + ac * (vc / sum);
}

Nearest nearestOnTriangle(const ConvexView& convex, const NearTriangle& t) {
  Best best;
  if (convex.geom.type == ShapeType::Sphere) {
    best.take({}, closestOnTriangle({}, t.v));
    return fromCore(convex, t, best);
  }
  if (convex.geom.type == ShapeType::Capsule) {
    const Vec3 end = column(convex.turn, 1) * convex.geom.extent.y, start = -end;
    if (!crosses(start, end, t)) {
      best.take(start, closestOnTriangle(start, t.v));
      best.take(end, closestOnTriangle(end, t.v));
      for (int i = 0; i < 3; ++i) {
        Vec3 a, b;
        closestOnSegments(start, end - start, t.v[i], t.v[(i + 1) % 3] - t.v[i], a, b);
        best.take(a, b);
      }
      return fromCore(convex, t, best);
    }
  }
  ShapeGeom triangle{ShapeType::Triangle, 0, {}};
  triangle.data = t.v;
  return nearest(convex.geom, convex.pose, triangle, {}, convex.margin);
}

}  // namespace avbd
