// Faces of two convex cores that touch -> the points of a manifold (clip.h).
#include "collide/clip.h"

namespace avbd {
namespace {

constexpr float kTilt = 1.0f / 4096;  // slope below which no point counts as deeper than another
constexpr float kBetter = 1.02f;      // what a point must be better by than one before it to be chosen
constexpr int kMaxCorners = 2 * SupportFace::kMax + 2;
constexpr uint32_t kSide = 256;  // added to the names of the reference's sides

/// Two directions across the normal and heights w along it, about the reference's first point.
struct Plane {
  Vec3 origin, u, v, w;
};

/// Each in its own array: copies of whole corners just written wait for the store to finish.
struct Polygon {
  int count = 0;
  float u[kMaxCorners], v[kMaxCorners], w[kMaxCorners];
  uint32_t in[kMaxCorners], out[kMaxCorners];  // the lines that the polygon comes and goes along

  void copy(const Polygon& from, int k) { add(from.u[k], from.v[k], from.w[k], from.in[k], from.out[k]); }
  void add(float pu, float pv, float pw, uint32_t comes, uint32_t goes) {
    if (count >= kMaxCorners) return;
    u[count] = pu;
    v[count] = pv;
    w[count] = pw;
    in[count] = comes;
    out[count++] = goes;
  }
};

/// A side: nu u + nv v <= offset is inside; (nu, nv) is unit.
struct Side {
  float nu, nv, offset;
  uint32_t name;
};

void cut(const Polygon& from, const Side& side, float tolerance, Polygon& to) {
  to.count = 0;
  float beyond[kMaxCorners];
  for (int k = 0; k < from.count; ++k) beyond[k] = side.nu * from.u[k] + side.nv * from.v[k] - side.offset;
  // An edge (two corners) is walked once only, not there and back.
  const int steps = from.count == 2 ? 1 : from.count;
  for (int a = 0; a < from.count; ++a) {
    const bool keepA = beyond[a] <= tolerance;
    if (keepA) to.copy(from, a);
    if (a >= steps) break;
    const int b = a + 1 == from.count ? 0 : a + 1;
    const bool keepB = beyond[b] <= tolerance;
    if (keepA == keepB) continue;
    // From the inside out, so that both directions of an edge give the same point.
    const int inner = keepA ? a : b, outer = keepA ? b : a;
    const float t = clampTo(beyond[inner] / (beyond[inner] - beyond[outer]), 0, 1);
    to.add(from.u[inner] + t * (from.u[outer] - from.u[inner]), from.v[inner] + t * (from.v[outer] - from.v[inner]),
           from.w[inner] + t * (from.w[outer] - from.w[inner]), keepA ? from.out[a] : side.name,
           keepA ? side.name : from.out[a]);
  }
}

/// Twice the area of a triangle, positive if it turns left.
float twiceArea(const Polygon& p, int a, int b, int c) {
  return (p.u[b] - p.u[a]) * (p.v[c] - p.v[a]) - (p.v[b] - p.v[a]) * (p.u[c] - p.u[a]);
}

/// The first corner with the largest score, up to a small part: equals must not change places with every rounding
/// error.
template <class Score>
int bestCorner(const Polygon& p, const Score& score) {
  int best = 0;
  float top = score(0);
  for (int k = 1; k < p.count; ++k) {
    const float x = score(k);
    const bool better = x > (top > 0 ? top * kBetter : top);
    top = better ? x : top;
    best = better ? k : best;
  }
  return best;
}

/// Four corners of more: a deepest one, the one farthest from it, and the two that span the most area with them.
void reduce(Polygon& p) {
  // The slight slope decides between equals; without it the choice would follow the noise of a flat contact.
  int a = 0;
  float top = kTilt * (p.u[0] + 0.375f * p.v[0]) - p.w[0];
  for (int k = 1; k < p.count; ++k) {
    const float depth = kTilt * (p.u[k] + 0.375f * p.v[k]) - p.w[k];
    a = depth > top ? k : a;
    top = depth > top ? depth : top;
  }
  const int b = bestCorner(p, [&](int k) {
    const float u = p.u[k] - p.u[a], v = p.v[k] - p.v[a];
    return u * u + v * v;
  });
  const int c = bestCorner(p, [&](int k) { return magnitude(twiceArea(p, a, b, k)); });
  const float turn = twiceArea(p, a, b, c) < 0 ? -1.0f : 1.0f;
  const int d = bestCorner(p, [&](int k) {
    const float ab = -turn * twiceArea(p, a, b, k), bc = -turn * twiceArea(p, b, c, k);
    return larger(larger(ab, bc), -turn * twiceArea(p, c, a, k));
  });
  const int all = p.count;
  p.count = 0;
  for (int k = 0; k < all; ++k) {
    if (k == a || k == b || k == c || k == d) p.copy(p, k);
  }
}

Vec3 across(Vec3 v) {
  const float x = magnitude(v.x), y = magnitude(v.y), z = magnitude(v.z);
  return cross(v, x <= y && x <= z ? Vec3{1, 0, 0} : (y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
}

Plane planeOf(const FacePair& pair) {
  const SupportFace& r = pair.reference;
  Plane p;
  p.w = pair.normal;
  // Corners of a merged face lie a little below its plane: the highest one is on it.
  p.origin = r.point[0];
  for (int i = 1; i < r.count; ++i) {
    if (dot(r.normal, r.point[i]) > dot(r.normal, p.origin)) p.origin = r.point[i];
  }
  // Along the first edge of the face with more corners: what decides between equals turns with it.
  const SupportFace& edged = r.count >= pair.incident.count ? r : pair.incident;
  const Vec3 edge = edged.count > 1 ? edged.point[1] - edged.point[0] : across(p.w),
             level = edge - p.w * dot(edge, p.w);
  p.u = level * (1 / length(level));
  p.v = cross(p.w, p.u);
  return p;
}

/// Sides of the reference face, or both ends of an edge.
int sidesOf(const SupportFace& r, const Plane& plane, Side* sides) {
  int count = 0;
  if (r.count == 0) return 0;
  if (r.count == 2) {
    sides[count++] = {-1, 0, -dot(r.point[0] - plane.origin, plane.u), kSide | (r.feature[0] & 255u)};
    sides[count++] = {1, 0, dot(r.point[1] - plane.origin, plane.u), kSide | (r.feature[1] & 255u)};
    return count;
  }
  for (int i = 0; i < r.count; ++i) {
    const Vec3 a = r.point[i] - plane.origin, b = r.point[i + 1 == r.count ? 0 : i + 1] - plane.origin;
    const float au = dot(a, plane.u), av = dot(a, plane.v);
    const float eu = dot(b, plane.u) - au, ev = dot(b, plane.v) - av, l = std::sqrt(eu * eu + ev * ev);
    if (!(l > 0)) continue;
    const float nu = ev / l, nv = -eu / l;
    sides[count++] = {nu, nv, nu * au + nv * av, kSide | (r.feature[i] & 255u)};
  }
  return count;
}

Polygon polygonOf(const SupportFace& face, const Plane& plane) {
  Polygon p;
  for (int k = 0; k < face.count; ++k) {
    const Vec3 d = face.point[k] - plane.origin;
    const uint32_t before = face.feature[k == 0 ? face.count - 1 : k - 1] & 255u;
    p.add(dot(d, plane.u), dot(d, plane.v), dot(d, plane.w), before, face.feature[k] & 255u);
  }
  return p;
}

/// Few bits of the names of both faces.
uint32_t faceBits(const FacePair& pair) {
  const uint32_t r = pair.reference.count > 0 ? pair.reference.feature[0] >> 8 : 0, i = pair.incident.feature[0] >> 8;
  const uint32_t mixed = (r * 0x9e3779b1u) ^ (i * 0x85ebca6bu + 0x27d4eb2fu);
  return (mixed >> 20 & 0xffeu) | (pair.swapped ? 1u : 0u);
}

}  // namespace

void clipFaces(const FacePair& pair, ClipResult& out) {
  out.count = 0;
  const Plane plane = planeOf(pair);
  Side sides[SupportFace::kMax];
  const int sideCount = sidesOf(pair.reference, plane, sides);
  Polygon first = polygonOf(pair.incident, plane), second, *polygon = &first, *spare = &second;
  for (int i = 0; i < sideCount && polygon->count > 0; ++i) {
    cut(*polygon, sides[i], pair.tolerance, *spare);
    Polygon* t = polygon;
    polygon = spare;
    spare = t;
  }
  if (polygon->count == 0) return;
  // Heights are above the reference's plane, along the normal: of a face that leans, less what it has risen there.
  float riseU = 0, riseV = 0;
  if (pair.reference.count > 2) {
    const Vec3 n = pair.reference.normal;
    const float up = dot(n, plane.w);
    riseU = -dot(n, plane.u) / up;
    riseV = -dot(n, plane.v) / up;
  }
  const int all = polygon->count;
  polygon->count = 0;
  out.lowest = 3e38f;
  float middle[3] = {0, 0, 0};
  for (int k = 0; k < all; ++k) {
    polygon->w[k] -= riseU * polygon->u[k] + riseV * polygon->v[k];
    out.lowest = smaller(out.lowest, polygon->w[k]);
    middle[0] += polygon->u[k], middle[1] += polygon->v[k], middle[2] += polygon->w[k];
    if (polygon->w[k] <= pair.beyond) polygon->copy(*polygon, k);
  }
  const float part = 1 / static_cast<float>(all);
  out.middle = middle[2] * part;
  out.inside = 3e38f;
  for (int i = 0; i < sideCount; ++i) {
    out.inside = smaller(out.inside, sides[i].offset - part * (sides[i].nu * middle[0] + sides[i].nv * middle[1]));
  }
  if (polygon->count > kMaxManifoldPoints) reduce(*polygon);
  const uint32_t face = faceBits(pair) << 19;
  for (int k = 0; k < polygon->count; ++k) {
    const float u = polygon->u[k], v = polygon->v[k];
    const Vec3 on = plane.origin + plane.u * u + plane.v * v + plane.w * (riseU * u + riseV * v);
    out.point[k] = {on, polygon->w[k], face | polygon->in[k] << 9 | polygon->out[k] | 1u << 18};
  }
  out.count = polygon->count;
}

}  // namespace avbd
