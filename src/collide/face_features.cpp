// Nearest points of features, and conservative advancement: no feature goes farther in a time than its fastest point,
// so both may be moved on by the time that their distance lasts, and looked at again (Li et al., Codimensional
// Incremental Potential Contact, 2021, "additive CCD").
#include "collide/face_features.h"

#include <algorithm>

#include "avbd/rows/math.h"

namespace avbd {

NearestOnFace nearestOnFace(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const auto at = [&](float v, float w) { return NearestOnFace{{1 - v - w, v, w}, a + ab * v + ac * w}; };
  const float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
              d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return at(0, 0);
  if (d3 >= 0 && d4 <= d3) return at(1, 0);
  if (d6 >= 0 && d5 <= d6) return at(0, 1);
  const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(d1 / (d1 - d3), 0);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(0, d2 / (d2 - d6));
  const float bc = d4 - d3, cb = d5 - d6;
  if (va <= 0 && bc >= 0 && cb >= 0) return at(1 - bc / (bc + cb), bc / (bc + cb));
  const float sum = va + vb + vc;
  return sum > 0 ? at(vb / sum, vc / sum) : at(0, 0);
}

NearestOnEdges nearestOnEdges(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const float uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const auto clamped = [](float x) { return std::min(std::max(x, 0.0f), 1.0f); };
  const float area = uu * vv - uv * uv;
  float s = area > 1e-6f * uu * vv ? clamped((uv * vw - vv * uw) / area) : 0.5f;
  float t = vv > 0 ? (uv * s + vw) / vv : 0;
  if (t < 0 || t > 1) {
    t = clamped(t);
    s = uu > 0 ? clamped((uv * t - uw) / uu) : 0;
  }
  return {s, t, a + u * s, c + v * t};
}

namespace {

constexpr int kMostAdvances = 512;

float lengthOf(Vec3 v) { return rows::sqrt(dot(v, v)); }

/// Of nodes of which the first `split` are parted from the others by `off`.
Approach approachOf(const FourPoints& p, int split, Vec3 off) {
  Approach now;
  now.distance = lengthOf(off);
  if (!(now.distance > 0)) return now;
  now.speed = -leastApart(split, [&](int i) { return dot(off, p.way[i]) / now.distance; });
  return now;
}

}  // namespace

float pointMeetsFace(const FourPoints& p, Kept kept) {
  return advanceUntil(kept, kMostAdvances, [&](float time) {
    const Vec3 at = p.when(0, time);
    return approachOf(p, 1, at - nearestOnFace(at, p.when(1, time), p.when(2, time), p.when(3, time)).point);
  });
}

float edgesMeet(const FourPoints& p, Kept kept) {
  return advanceUntil(kept, kMostAdvances, [&](float time) {
    const NearestOnEdges near = nearestOnEdges(p.when(0, time), p.when(1, time), p.when(2, time), p.when(3, time));
    return approachOf(p, 2, near.first - near.second);
  });
}

}  // namespace avbd
