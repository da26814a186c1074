// Capsule against capsule and against box: one point, or two where the capsule lies along something.
//
// The capsule is its core segment and a radius. Apart, the normal is the line between the nearest points of core and
// other shape. With the core inside a box it is the axis of least overlap.
#include "collide/collide_pairs.h"
#include "collide/segment_box.h"

namespace avbd {
namespace {

constexpr float kParallel = 0.03f;   // sine of the largest angle between a capsule and what it lies along
constexpr float kSameSide = 2e-5f;   // 1 - cosine between the nearest direction and a face's normal to be on it
constexpr float kFaceFirst = 1e-3f;  // of the smallest size: what an edge axis must be better by than a face's

/// A segment center + s axis, s in -reach .. reach; axis is unit.
struct Core {
  Vec3 center, axis;
  float reach;
};

/// Where two cores run side by side: an interval of the first one's parameter.
struct Overlap {
  float low, high;
};

Overlap overlapOf(const Core& a, const Core& b) {
  const float middle = dot(a.axis, b.center - a.center), reach = magnitude(dot(a.axis, b.axis)) * b.reach;
  return {larger(-a.reach, middle - reach), smaller(a.reach, middle + reach)};
}

/// Parameters of the nearest points of two segments; sine2 is the squared sine of the angle between them.
void nearestParameters(const Core& a, const Core& b, float sine2, float& s, float& t) {
  const Vec3 d = b.center - a.center;
  const float cosine = dot(a.axis, b.axis), ad = dot(a.axis, d), bd = dot(b.axis, d);
  if (sine2 > 1e-6f) {
    s = clampTo((ad - cosine * bd) / sine2, -a.reach, a.reach);
  } else {
    const Overlap o = overlapOf(a, b);
    s = clampTo(0.5f * (o.low + o.high), -a.reach, a.reach);
  }
  t = clampTo(s * cosine - bd, -b.reach, b.reach);
  s = clampTo(ad + t * cosine, -a.reach, a.reach);
  t = clampTo(s * cosine - bd, -b.reach, b.reach);
}

/// Points at both ends of the stretch where two round bars of nearly the same direction run side by side. The gap is
/// measured along the normal, between circles that may be offset sideways.
void addAlong(const Core& a, const Core& b, const ShapePair& pair, float radiusA, float radiusB, Manifold& out) {
  const Overlap o = overlapOf(a, b);
  if (!(o.low < o.high)) return;
  const float cosine = dot(a.axis, b.axis), ad = dot(a.axis, b.center - a.center), sum = radiusA + radiusB;
  for (int end = 0; end < 2; ++end) {
    const float s = end == 0 ? o.low : o.high, t = clampTo((s - ad) / cosine, -b.reach, b.reach);
    const Vec3 p = a.center + a.axis * s, w = b.center + b.axis * t - p;
    // Of cores that cross, one end lies beyond the other: no deeper than in line.
    const float height = larger(dot(w, out.normal), 0), side2 = larger(dot(w, w) - height * height, 0);
    const float separation = height - std::sqrt(larger(sum * sum - side2, 0));
    if (separation > pair.margin) continue;
    // Which end it is: of a, or of b.
    const uint32_t name = magnitude(s) == a.reach ? (s < 0 ? 0u : 1u) : (t < 0 ? 2u : 3u);
    addPoint(out, p + out.normal * (radiusA + 0.5f * (height - sum)), separation, 4 + name);
  }
}

}  // namespace

void collideCapsuleCapsule(const ShapePair& pair, Manifold& out) {
  const Vec3 up{0, 1, 0};
  const Core a{{}, rotate(pair.poseA.q, up), pair.a.extent.y};
  const Core b{pair.poseB.p - pair.poseA.p, rotate(pair.poseB.q, up), pair.b.extent.y};
  const float ra = pair.a.radius, rb = pair.b.radius, sum = ra + rb;
  const Vec3 across = cross(a.axis, b.axis);
  const float sine2 = dot(across, across);
  float s, t;
  nearestParameters(a, b, sine2, s, t);
  const Vec3 p = a.axis * s, d = b.center + b.axis * t - p;
  const float distance = length(d), separation = distance - sum;
  if (separation > pair.margin) return;
  if (distance > kNoDirection * (sum + a.reach + b.reach)) {
    out.normal = d * (1 / distance);
  } else {  // the cores cross: out across both, or across their one line
    const bool oneLine = sine2 < kNoDirection || a.reach == 0 || b.reach == 0;
    const Quat longer = a.reach < b.reach ? pair.poseB.q : pair.poseA.q;
    out.normal = oneLine ? rotate(longer, Vec3{1, 0, 0}) : across * (1 / std::sqrt(sine2));
    if (dot(out.normal, b.center) < 0) out.normal = -out.normal;
  }
  if (sine2 <= kParallel * kParallel) addAlong(a, b, pair, ra, rb, out);
  if (out.count == 0) addPoint(out, p + out.normal * (ra + 0.5f * separation), separation, 0);
  for (int i = 0; i < out.count; ++i) {
    out.points[i].position = pair.poseA.p + out.points[i].position;
    if (pair.swapped && out.points[i].feature != 0) out.points[i].feature ^= 2;  // ends of the caller's a first
  }
}

namespace {

/// The capsule as it lies in the box's frame.
struct CapsuleInBox {
  Core core;
  Axes center, half, extent;  // half: from the core's centre to its end
  float radius, size;
};

/// The axis of least overlap of a core that meets the box, out of the box: a face's, or (face -1) across an edge along
/// axis `edge`. Returns the (negative) gap to the core.
float leastOverlap(const CapsuleInBox& c, Vec3& normal, int& face, int& edge) {
  float best = 0;
  face = -1;
  for (int i = 0; i < 3; ++i) {
    const float gap = magnitude(c.center[i]) - c.extent[i] - magnitude(c.half[i]);
    if (face < 0 || gap > best) {
      best = gap;
      face = i;
    }
  }
  Axes n{};
  n[face] = c.center[face] < 0 ? -1.0f : 1.0f;
  normal = vec(n);
  const float length2 = c.core.reach * c.core.reach;
  float floor = best + kFaceFirst * c.size;
  for (int i = 0; i < 3; ++i) {
    const int u = kNext[i], v = kLast[i];
    const float l2 = c.half[u] * c.half[u] + c.half[v] * c.half[v];
    if (!(l2 > kNoDirection * length2)) continue;
    const float along = c.center[v] * c.half[u] - c.center[u] * c.half[v], l = std::sqrt(l2);
    const float gap = (magnitude(along) - c.extent[u] * magnitude(c.half[v]) - c.extent[v] * magnitude(c.half[u])) / l;
    if (!(gap > floor)) continue;
    best = floor = gap;
    face = -1;
    edge = i;
    n = {};
    const float k = (along < 0 ? -1.0f : 1.0f) / l;
    n[u] = -c.half[v] * k;
    n[v] = c.half[u] * k;
    normal = vec(n);
  }
  return best;
}

/// The part of the core above a face, cut by the face's side planes. cut: 0 and 1 the core's own ends, 2 .. 5 planes.
struct Cut {
  float t[2] = {-1, 1};
  uint32_t name[2] = {0, 1};
};

bool cutToFace(const CapsuleInBox& c, int face, Cut& cut) {
  for (int k = 0; k < 2; ++k) {
    const int i = k == 0 ? kNext[face] : kLast[face];
    for (int side = 0; side < 2; ++side) {
      const float sign = side == 0 ? -1.0f : 1.0f;
      const float over = sign * c.center[i] - c.extent[i], step = sign * c.half[i];
      if (over + magnitude(step) <= 0) continue;  // all of the core within this plane
      if (over - magnitude(step) > 0) return false;
      const float t = -over / step;
      const int end = step > 0 ? 1 : 0;
      if (end == 1 ? t < cut.t[1] : t > cut.t[0]) {
        cut.t[end] = t;
        cut.name[end] = static_cast<uint32_t>(2 + 2 * k + side);
      }
    }
  }
  return cut.t[0] <= cut.t[1];
}

/// Points where the core lies above (or in) a face, unless all are farther than `nearest`, the true separation: then
/// the core's lowest part is not above the face. Positions in the box's frame; the normal out of the box.
void addOnFace(const CapsuleInBox& c, int face, float sign, float nearest, float margin, Manifold& out) {
  Cut cut;
  if (!cutToFace(c, face, cut)) return;
  Axes n{};
  n[face] = sign;
  const uint32_t name = 64 + 8 * static_cast<uint32_t>(2 * face + (sign > 0 ? 1 : 0));
  float lowest = margin;
  for (int end = 0; end < 2; ++end) {
    if (end == 1 && !(cut.t[0] < cut.t[1])) break;
    const Vec3 p = c.core.center + vec(c.half) * cut.t[end];
    const float separation = sign * axes(p)[face] - c.extent[face] - c.radius;
    if (separation > margin) continue;
    addPoint(out, p - vec(n) * (c.radius + 0.5f * separation), separation, name | cut.name[end]);
    lowest = smaller(lowest, separation);
  }
  if (lowest > nearest + kFaceFirst * c.size) out.count = 0;
  if (out.count > 0) out.normal = vec(n);
}

/// Points where the core lies along an edge of the box, `out.normal` away from it.
void addOnEdge(const CapsuleInBox& c, const ShapePair& pair, Manifold& out) {
  const Axes n = axes(out.normal), along = axes(c.core.axis);
  for (int i = 0; i < 3; ++i) {
    const int u = kNext[i], v = kLast[i];
    if (along[u] * along[u] + along[v] * along[v] > kParallel * kParallel || magnitude(n[i]) > kParallel) continue;
    if (n[u] == 0 || n[v] == 0) continue;  // the nearest point is on another edge
    Axes corner{}, axis{};
    corner[u] = n[u] < 0 ? -c.extent[u] : c.extent[u];
    corner[v] = n[v] < 0 ? -c.extent[v] : c.extent[v];
    axis[i] = 1;
    addAlong({vec(corner), vec(axis), c.extent[i]}, c.core, pair, 0, c.radius, out);
    const uint32_t name = 128 + 16 * static_cast<uint32_t>(i) + (n[u] < 0 ? 0 : 64) + (n[v] < 0 ? 0 : 256);
    for (int k = 0; k < out.count; ++k) out.points[k].feature |= name;
    return;
  }
}

/// The nearest points of core and box, apart by more than a rounding error.
void touchApart(const CapsuleInBox& c, const ShapePair& pair, Vec3 p, float distance, Manifold& out) {
  const Vec3 away = p - clampTo(p, pair.b.extent);
  out.normal = away * (1 / distance);
  const Axes n = axes(out.normal);
  int face = magnitude(n[1]) > magnitude(n[0]) ? 1 : 0;
  if (magnitude(n[2]) > magnitude(n[face])) face = 2;
  const float separation = distance - c.radius;
  if (magnitude(n[face]) > 1 - kSameSide) {
    addOnFace(c, face, n[face] < 0 ? -1.0f : 1.0f, separation, pair.margin, out);
  } else {
    addOnEdge(c, pair, out);
  }
  if (out.count > 0) return;
  addPoint(out, p - out.normal * (c.radius + 0.5f * separation), separation, 0);
}

/// The point of the core that is nearest to the line of the edge which `normal` points out of.
Vec3 nearestToEdge(const CapsuleInBox& c, int i, const Axes& normal) {
  Axes d = c.center;  // from the edge's middle
  for (int k = 0; k < 3; ++k) {
    if (k != i) d[k] -= normal[k] < 0 ? -c.extent[k] : c.extent[k];
  }
  const Axes axis = axes(c.core.axis);
  const int u = kNext[i], v = kLast[i];
  const float s = -(axis[u] * d[u] + axis[v] * d[v]) / (axis[u] * axis[u] + axis[v] * axis[v]);
  return c.core.center + c.core.axis * clampTo(s, -c.core.reach, c.core.reach);
}

/// The core meets the box: out along the axis of least overlap.
void touchInside(const CapsuleInBox& c, const ShapePair& pair, Vec3 p, Manifold& out) {
  int face, edge = 0;
  const float separation = leastOverlap(c, out.normal, face, edge) - c.radius;
  if (face >= 0) {
    addOnFace(c, face, axes(out.normal)[face], separation, pair.margin, out);
  } else {
    p = nearestToEdge(c, edge, axes(out.normal));
  }
  if (out.count > 0) return;
  addPoint(out, p - out.normal * (c.radius + 0.5f * separation), separation, 0);
}

}  // namespace

void collideCapsuleBox(const ShapePair& pair, Manifold& out) {
  const Mat3 box = matrix(pair.poseB.q);
  const Vec3 axis = mulT(box, rotate(pair.poseA.q, Vec3{0, 1, 0}));
  const Core core{mulT(box, pair.poseA.p - pair.poseB.p), axis, pair.a.extent.y};
  const Vec3 h = pair.b.extent;
  const float smallest = smaller(smaller(h.x, h.y), smaller(h.z, pair.a.radius));
  const CapsuleInBox c{core, axes(core.center), axes(axis * core.reach), axes(h), pair.a.radius, smallest};
  const float reach = c.radius + pair.margin;
  for (int i = 0; i < 3; ++i) {
    if (magnitude(c.center[i]) - magnitude(c.half[i]) - c.extent[i] > reach) return;
  }
  const Vec3 p = core.center + vec(c.half) * nearestToBox(c.center, c.half, c.extent);
  const float distance = length(p - clampTo(p, h));
  if (distance > reach) return;
  if (distance > kNoDirection * (h.x + h.y + h.z + c.radius + pair.a.extent.y)) {
    touchApart(c, pair, p, distance, out);
  } else {
    touchInside(c, pair, p, out);
  }
  out.normal = -mul(box, out.normal);
  for (int i = 0; i < out.count; ++i) out.points[i].position = pair.poseB.p + mul(box, out.points[i].position);
}

}  // namespace avbd
