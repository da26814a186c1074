// Box against box, face contact: the incident face cut by the reference face's side planes (Sutherland-Hodgman), and
// the choice of four points.
//
// A corner of the cut polygon is named by what meets in it: a corner of the box, or an edge or side plane and a side
// plane. So names last as long as the same things meet, also where another face through that edge becomes incident.
#include <utility>

#include "collide/box_pair.h"

namespace avbd {
namespace {

constexpr float kTilt = 1.0f / 512;  // slope below which no corner counts as deeper than another
constexpr float kBetter = 1.02f;     // what a corner must be better by than one before it to be chosen
constexpr int kMaxCorners = 8;

/// u, v across the reference face, w above it. Each in its own array: copies of whole corners just written wait for the
/// store to finish.
struct Polygon {
  int count = 0;
  float u[kMaxCorners], v[kMaxCorners], w[kMaxCorners];
  // The lines that the polygon comes and goes along: 0 .. 3 edges of the incident face, 4 .. 7 side planes.
  uint32_t in[kMaxCorners], out[kMaxCorners];

  void copy(const Polygon& from, int k) {
    const int to = count++;
    u[to] = from.u[k];
    v[to] = from.v[k];
    w[to] = from.w[k];
    in[to] = from.in[k];
    out[to] = from.out[k];
  }
};

/// A side plane across u (0) or v (1).
template <int Across>
struct Plane {
  float sign, extent;
  uint32_t name;
  float beyond(const Polygon& p, int k) const { return sign * (Across == 0 ? p.u[k] : p.v[k]) - extent; }
};

/// Adds the point of the edge between two corners that lies on the plane, at the part t of the way.
template <int Across>
void addMeeting(const Polygon& p, int inside, int outside, float t, const Plane<Across>& plane, Polygon& to) {
  const float at = plane.sign * plane.extent;
  const int k = to.count++;
  to.u[k] = Across == 0 ? at : p.u[inside] + t * (p.u[outside] - p.u[inside]);
  to.v[k] = Across == 1 ? at : p.v[inside] + t * (p.v[outside] - p.v[inside]);
  to.w[k] = p.w[inside] + t * (p.w[outside] - p.w[inside]);
}

/// Corners no farther out than the tolerance stay as they are: those of equal boxes stacked in line would otherwise
/// come and go with every rounding error.
template <int Across>
void cut(const Polygon& from, const Plane<Across>& plane, float tolerance, Polygon& to) {
  to.count = 0;
  const float first = plane.beyond(from, 0);
  float next = first;
  for (int a = 0; a < from.count; ++a) {
    const bool last = a + 1 == from.count;
    const int b = last ? 0 : a + 1;
    const float da = next, db = last ? first : plane.beyond(from, b);
    next = db;
    const bool keepA = da <= tolerance, keepB = db <= tolerance;
    if (keepA && to.count < kMaxCorners) to.copy(from, a);
    if (keepA == keepB || to.count >= kMaxCorners) continue;
    const int k = to.count;
    if (keepA) {
      addMeeting(from, a, b, clampTo(da / (da - db), 0, 1), plane, to);
    } else {
      addMeeting(from, b, a, clampTo(db / (db - da), 0, 1), plane, to);
    }
    to.in[k] = keepA ? from.out[a] : plane.name;
    to.out[k] = keepA ? plane.name : from.out[a];
  }
}

/// Cuts by both planes across u or v; true if something is left. The two polygons change places with every cut.
template <int Across>
bool cutAcross(const FaceView& view, float middle, float reach, Polygon*& polygon, Polygon*& spare) {
  const int axis = view.face >> 1;
  const float extent = view.h[Across == 0 ? kNext[axis] : kLast[axis]];
  for (int side = 0; side < 2; ++side) {
    const Plane<Across> plane{side == 0 ? -1.0f : 1.0f, extent, static_cast<uint32_t>(4 + 2 * Across + side)};
    if (plane.sign * middle + reach <= extent + view.tolerance) continue;
    cut(*polygon, plane, view.tolerance, *spare);
    std::swap(polygon, spare);
    if (polygon->count == 0) return false;
  }
  return true;
}

/// The face of the other box that looks at the reference face.
struct Incident {
  Polygon polygon;
  float middle[2], reach[2];  // of its bounds in u, v
  int axis;
  bool positive;  // on the positive side of that axis
};

constexpr float kSign1[4] = {-1, 1, 1, -1}, kSign2[4] = {-1, -1, 1, 1};  // of the corners, on the face's two axes

Incident incidentFace(const FaceView& view) {
  const int axis = view.face >> 1, u = kNext[axis], v = kLast[axis];
  const float sign = view.face & 1 ? 1.0f : -1.0f;
  const float* n = view.turn[axis];
  int j = magnitude(n[1]) > magnitude(n[0]) ? 1 : 0;
  if (magnitude(n[2]) > magnitude(n[j])) j = 2;
  const int j1 = kNext[j], j2 = kLast[j];
  const bool positive = sign * n[j] < 0;
  const float hj = positive ? view.other[j] : -view.other[j], h1 = view.other[j1], h2 = view.other[j2];
  const auto part = [&](int i, float* to) {
    to[0] = view.center[i] + hj * view.turn[i][j];
    to[1] = h1 * view.turn[i][j1];
    to[2] = h2 * view.turn[i][j2];
  };
  float pu[3], pv[3], pw[3];
  part(u, pu);
  part(v, pv);
  part(axis, pw);
  Incident r;
  r.axis = j;
  r.positive = positive;
  r.middle[0] = pu[0];
  r.middle[1] = pv[0];
  r.reach[0] = magnitude(pu[1]) + magnitude(pu[2]);
  r.reach[1] = magnitude(pv[1]) + magnitude(pv[2]);
  r.polygon.count = 4;
  for (int k = 0; k < 4; ++k) {
    const auto at = [&](const float* p) { return p[0] + (kSign1[k] * p[1] + kSign2[k] * p[2]); };
    r.polygon.u[k] = at(pu);
    r.polygon.v[k] = at(pv);
    r.polygon.w[k] = sign * at(pw) - view.h[axis];
    r.polygon.in[k] = static_cast<uint32_t>(k + 3) & 3u;
    r.polygon.out[k] = static_cast<uint32_t>(k);
  }
  return r;
}

/// 0 .. 11 for an edge of the other box, 12 .. 15 for a side plane.
uint32_t lineName(const Incident& face, uint32_t line) {
  if (line >= 4) return 8 + line;
  const uint32_t positive = face.positive ? 1 : 0, high = line == 1 || line == 2 ? 1 : 0;
  // Lines 0 and 2 run along the first axis of the face, 1 and 3 along the second.
  if (line % 2 == 0) return static_cast<uint32_t>(kNext[face.axis]) * 4 + high + 2 * positive;
  return static_cast<uint32_t>(kLast[face.axis]) * 4 + positive + 2 * high;
}

uint32_t cornerName(const Incident& face, uint32_t in, uint32_t out) {
  if (in < 4 && out < 4) {
    const uint32_t high1 = kSign1[out] > 0 ? 1 : 0, high2 = kSign2[out] > 0 ? 1 : 0;
    return 256 | (face.positive ? 1u : 0u) << face.axis | high1 << kNext[face.axis] | high2 << kLast[face.axis];
  }
  const uint32_t a = lineName(face, in), b = lineName(face, out);
  return a < b ? a << 4 | b : b << 4 | a;
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
void chooseFour(const Polygon& p, int chosen[4]) {
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
  chosen[0] = a, chosen[1] = b, chosen[2] = c, chosen[3] = d;
}

/// Drops all corners but four, keeping their order.
void reduce(Polygon& p) {
  int chosen[4];
  chooseFour(p, chosen);
  const int all = p.count;
  p.count = 0;
  for (int k = 0; k < all; ++k) {
    if (k == chosen[0] || k == chosen[1] || k == chosen[2] || k == chosen[3]) p.copy(p, k);
  }
}

}  // namespace

void clipFace(const FaceView& view, FacePoints& out) {
  const int axis = view.face >> 1, u = kNext[axis], v = kLast[axis];
  const float sign = view.face & 1 ? 1.0f : -1.0f;
  Incident incident = incidentFace(view);
  Polygon other, *polygon = &incident.polygon, *spare = &other;
  if (!cutAcross<0>(view, incident.middle[0], incident.reach[0], polygon, spare)) return;
  if (!cutAcross<1>(view, incident.middle[1], incident.reach[1], polygon, spare)) return;
  const int all = polygon->count;
  polygon->count = 0;
  out.lowest = polygon->w[0];
  for (int k = 0; k < all; ++k) {
    out.lowest = smaller(out.lowest, polygon->w[k]);
    if (polygon->w[k] <= view.margin) polygon->copy(*polygon, k);
  }
  if (polygon->count > kMaxManifoldPoints) reduce(*polygon);
  const uint32_t face = static_cast<uint32_t>(view.face) << 9;
  for (int k = 0; k < polygon->count; ++k) {
    const float w = polygon->w[k];
    Axes p;
    p[u] = polygon->u[k];
    p[v] = polygon->v[k];
    p[axis] = sign * (view.h[axis] + 0.5f * w);
    out.points[k] = {vec(p), w, face | cornerName(incident, polygon->in[k], polygon->out[k])};
  }
  out.count = polygon->count;
}

}  // namespace avbd
