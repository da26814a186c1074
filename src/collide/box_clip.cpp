// Box against box, face contact: the incident face cut by the reference face's side planes (Sutherland-Hodgman), and
// the choice of four points.
//
// A corner of the cut polygon is named by the two lines that meet in it: 0 .. 3 edges of the incident face, 4 .. 7 side
// planes. So names last as long as the same edges and planes meet.
#include "collide/box_pair.h"

namespace avbd {
namespace {

constexpr float kTilt = 1.0f / 256;   // slope below which no corner counts as deeper than another
constexpr float kBetter = 1.02f;      // what a corner must be better by than one before it to be chosen
constexpr int kMaxCorners = 8;

/// u, v across the reference face, w above it.
struct Corner {
  float u, v, w;
  uint8_t in, out;  // the lines that the polygon comes and goes along
};

struct Polygon {
  int count = 0;
  Corner corner[kMaxCorners + 2];  // rounding may cut a corner twice
};

struct Plane {
  bool alongV;
  float sign, extent;
  uint8_t name;
};

float beyond(const Corner& c, const Plane& p) { return p.sign * (p.alongV ? c.v : c.u) - p.extent; }

/// Where the edge from a corner inside to one outside meets the plane.
Corner meet(const Corner& inside, float di, const Corner& outside, float d0, const Plane& p) {
  const float t = clampTo(di / (di - d0), 0, 1);
  Corner c = inside;
  c.u += t * (outside.u - inside.u);
  c.v += t * (outside.v - inside.v);
  c.w += t * (outside.w - inside.w);
  (p.alongV ? c.v : c.u) = p.sign * p.extent;
  return c;
}

/// Corners no farther out than the tolerance stay as they are: those of equal boxes stacked in line would otherwise
/// come and go with every rounding error.
void cut(const Polygon& from, const Plane& plane, float tolerance, Polygon& to) {
  to.count = 0;
  float d = beyond(from.corner[0], plane);
  for (int k = 0; k < from.count; ++k) {
    const int next = k + 1 < from.count ? k + 1 : 0;
    const Corner &a = from.corner[k], &b = from.corner[next];
    const float da = d, db = beyond(b, plane);
    d = db;
    const bool keepA = da <= tolerance, keepB = db <= tolerance;
    if (keepA && to.count < kMaxCorners) to.corner[to.count++] = a;
    if (keepA == keepB || to.count >= kMaxCorners) continue;
    Corner c = keepA ? meet(a, da, b, db, plane) : meet(b, db, a, da, plane);
    c.in = keepA ? a.out : plane.name;
    c.out = keepA ? plane.name : a.out;
    to.corner[to.count++] = c;
  }
}

/// The face of the other box that looks at the reference face.
struct Incident {
  Polygon polygon;
  float middle[2], reach[2];  // of its bounds in u, v
  uint32_t name;
};

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
  r.name = static_cast<uint32_t>(2 * j + (positive ? 1 : 0));
  r.middle[0] = pu[0];
  r.middle[1] = pv[0];
  r.reach[0] = magnitude(pu[1]) + magnitude(pu[2]);
  r.reach[1] = magnitude(pv[1]) + magnitude(pv[2]);
  const float s1[4] = {-1, 1, 1, -1}, s2[4] = {-1, -1, 1, 1};
  r.polygon.count = 4;
  for (int k = 0; k < 4; ++k) {
    const auto at = [&](const float* p) { return p[0] + (s1[k] * p[1] + s2[k] * p[2]); };
    r.polygon.corner[k] = {at(pu), at(pv), sign * at(pw) - view.h[axis], static_cast<uint8_t>((k + 3) & 3),
                           static_cast<uint8_t>(k)};
  }
  return r;
}

/// Twice the area of a triangle, positive if it turns left.
float twiceArea(const Corner& a, const Corner& b, const Corner& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

/// Four corners of more: a deepest one, the one farthest from it, and the two that span the most area with them.
void chooseFour(const Polygon& p, int chosen[4]) {
  const auto best = [&](const auto& score) {
    int k = 0;
    float top = score(p.corner[0]);
    for (int i = 1; i < p.count; ++i) {
      const float x = score(p.corner[i]);
      if (x > (top > 0 ? top * kBetter : top)) {
        top = x;
        k = i;
      }
    }
    return k;
  };
  // The slight slope decides between equals; without it the choice would follow the noise of a flat contact.
  int first = 0;
  const auto depth = [](const Corner& c) { return kTilt * (c.u + 0.375f * c.v) - c.w; };
  for (int i = 1; i < p.count; ++i) {
    if (depth(p.corner[i]) > depth(p.corner[first])) first = i;
  }
  const Corner& a = p.corner[first];
  const int second = best([&](const Corner& c) { return (c.u - a.u) * (c.u - a.u) + (c.v - a.v) * (c.v - a.v); });
  const Corner& b = p.corner[second];
  const int third = best([&](const Corner& c) { return magnitude(twiceArea(a, b, c)); });
  const Corner& c = p.corner[third];
  const float turn = twiceArea(a, b, c) < 0 ? -1.0f : 1.0f;
  const int fourth = best([&](const Corner& d) {
    const float ab = -turn * twiceArea(a, b, d), bc = -turn * twiceArea(b, c, d), ca = -turn * twiceArea(c, a, d);
    return larger(ab, larger(bc, ca));
  });
  const int all[4] = {first, second, third, fourth};
  for (int k = 0; k < 4; ++k) chosen[k] = all[k];
}

/// Drops all corners but four, keeping their order.
void reduce(Polygon& p) {
  int chosen[4];
  chooseFour(p, chosen);
  int count = 0;
  for (int i = 0; i < p.count; ++i) {
    if (i == chosen[0] || i == chosen[1] || i == chosen[2] || i == chosen[3]) p.corner[count++] = p.corner[i];
  }
  p.count = count;
}

}  // namespace

void clipFace(const FaceView& view, FacePoints& out) {
  const int axis = view.face >> 1, u = kNext[axis], v = kLast[axis];
  const float sign = view.face & 1 ? 1.0f : -1.0f;
  Incident incident = incidentFace(view);
  Polygon other, *polygon = &incident.polygon, *spare = &other;
  for (int k = 0; k < 4; ++k) {
    const int w = k >> 1;
    const Plane plane{w == 1, k & 1 ? 1.0f : -1.0f, view.h[w == 1 ? v : u], static_cast<uint8_t>(4 + k)};
    if (plane.sign * incident.middle[w] + incident.reach[w] <= plane.extent + view.tolerance) continue;
    cut(*polygon, plane, view.tolerance, *spare);
    Polygon* full = spare;
    spare = polygon;
    polygon = full;
    if (polygon->count == 0) return;
  }
  int count = 0;
  out.lowest = polygon->corner[0].w;
  for (int k = 0; k < polygon->count; ++k) {
    const Corner c = polygon->corner[k];
    out.lowest = smaller(out.lowest, c.w);
    if (c.w <= view.margin) polygon->corner[count++] = c;
  }
  polygon->count = count;
  if (count > kMaxManifoldPoints) reduce(*polygon);
  const uint32_t faces = incident.name << 6 | static_cast<uint32_t>(view.face) << 9;
  for (int k = 0; k < polygon->count; ++k) {
    const Corner& c = polygon->corner[k];
    Axes p;
    p[u] = c.u;
    p[v] = c.v;
    p[axis] = sign * (view.h[axis] + 0.5f * c.w);
    out.points[k] = {vec(p), c.w, faces | static_cast<uint32_t>(c.in) << 3 | c.out};
  }
  out.count = polygon->count;
}

}  // namespace avbd
