// Box against box: 15 possible separating axes, then the points of the best one.
//
// Axes: the three face normals of each box and the nine cross products of their edges. The one with the largest
// separation is the direction of least overlap, or a lower bound of the distance. Faces come before edges and the
// first box's before the second's unless the others are better by more than a tolerance: a box at rest must not change
// between descriptions of the same contact. Where the boxes are apart and the best axis does not lead to a point of
// both, their nearest points do: a bound of the distance, taken for a gap, would stop bodies short of each other.
#include <limits>

#include "collide/box_pair.h"
#include "lane/wide.h"

namespace avbd {
namespace {

constexpr float kTolerance = 1e-3f;       // of the thinnest half extent
constexpr float kRelative = 0.02f;        // of the separation: what an edge must be better by
constexpr float kSameDirection = 0.995f;  // cosine between an edge axis and a face's normal that may stand for it
constexpr float kRounding = 4e-7f;        // of the lengths that an edge's separation is the difference of
constexpr float kShortAxis = 1e-6f;       // squared sine below which edges count as parallel

struct FaceAxis {
  int axis = -1;
  float separation = 0;
  bool ofB = false;
};

BoxPair makePair(const ShapePair& s, const Mat3& a) {
  BoxPair p;
  const Vec3 h[2] = {s.a.extent, s.b.extent};
  for (int k = 0; k < 2; ++k) {
    float* to = k == 0 ? p.ha : p.hb;
    to[0] = h[k].x, to[1] = h[k].y, to[2] = h[k].z;
  }
  const Mat3 r = matrix(conjugate(s.poseA.q) * s.poseB.q);
  const Vec3 d = mulT(a, s.poseB.p - s.poseA.p), e = mulT(r, d);
  p.da[0] = d.x, p.da[1] = d.y, p.da[2] = d.z;
  p.db[0] = e.x, p.db[1] = e.y, p.db[2] = e.z;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      p.r[i][j] = r.m[i][j];
      p.absR[i][j] = magnitude(r.m[i][j]);
    }
  }
  const auto thinnest = [](const float* x) { return smaller(smaller(x[0], x[1]), x[2]); };
  p.tolerance = kTolerance * smaller(thinnest(p.ha), thinnest(p.hb));
  p.margin = s.margin;
  return p;
}

/// Best face of each box; false if one of them separates by more than the margin: by `clear`.
bool faceAxes(const BoxPair& p, FaceAxis& a, FaceAxis& b, float& clear) {
  float sa[3], sb[3];
  for (int i = 0; i < 3; ++i) {
    const float reach = p.absR[i][0] * p.hb[0] + p.absR[i][1] * p.hb[1] + p.absR[i][2] * p.hb[2];
    sa[i] = magnitude(p.da[i]) - (p.ha[i] + reach);
  }
  clear = larger(larger(sa[0], sa[1]), sa[2]);
  if (clear > p.margin) return false;
  for (int j = 0; j < 3; ++j) {
    const float reach = p.absR[0][j] * p.ha[0] + p.absR[1][j] * p.ha[1] + p.absR[2][j] * p.ha[2];
    sb[j] = magnitude(p.db[j]) - (p.hb[j] + reach);
  }
  clear = larger(larger(sb[0], sb[1]), sb[2]);
  if (clear > p.margin) return false;
  a = {0, sa[0]};
  b = {0, sb[0], true};
  for (int i = 1; i < 3; ++i) {
    if (sa[i] > a.separation) a = {i, sa[i]};
    if (sb[i] > b.separation) b = {i, sb[i], true};
  }
  return true;
}

/// One cross product; a separation is taken only if it beats `floor`, which it then becomes.
template <int I, int J>
inline bool edgeAxis(const BoxPair& p, float& floor, EdgeAxis& best) {
  constexpr int i1 = (I + 1) % 3, i2 = (I + 2) % 3, j1 = (J + 1) % 3, j2 = (J + 2) % 3;
  const float along = p.da[i2] * p.r[i1][J] - p.da[i1] * p.r[i2][J];
  const float reach =
      p.ha[i1] * p.absR[i2][J] + p.ha[i2] * p.absR[i1][J] + p.hb[j1] * p.absR[I][j2] + p.hb[j2] * p.absR[I][j1];
  // Short axes magnify rounding errors: never claim a separation that may be one.
  const float far = magnitude(along), gap = far - reach - kRounding * (far + reach);
  if (gap <= floor && gap <= 0) return true;  // dividing by a length below 1 only lowers it
  const float l2 = p.r[i1][J] * p.r[i1][J] + p.r[i2][J] * p.r[i2][J];
  if (l2 < kShortAxis) return true;
  const float scale = 1 / std::sqrt(l2), separation = gap * scale;
  if (separation > p.margin) {
    floor = separation;
    return false;
  }
  if (!(separation > floor)) return true;
  floor = separation;
  const float k = along < 0 ? -scale : scale;
  Axes n{};
  n[i1] = -p.r[i2][J] * k;
  n[i2] = p.r[i1][J] * k;
  best = {I, J, separation, vec(n)};
  return true;
}

using Row = lane::Wide<4>;

Row row(float x, float y, float z) { return Row(Row::F{x, y, z, 0}); }

/// Whether any edge axis can count against `floor`: all nine at once, as edgeAxis() does it.
bool mayBeEdge(const BoxPair& p, float floor) {
  Row r[3], size[3];
  for (int i = 0; i < 3; ++i) r[i] = row(p.r[i][0], p.r[i][1], p.r[i][2]), size[i] = abs(r[i]);
  const Row next = row(p.hb[1], p.hb[2], p.hb[0]), last = row(p.hb[2], p.hb[0], p.hb[1]);
  uint32_t found = 0;
  for (int i = 0; i < 3; ++i) {
    const int i1 = kNext[i], i2 = kLast[i];
    const Row far = abs(p.da[i2] * r[i1] - p.da[i1] * r[i2]);
    const Row sizeNext(__builtin_shufflevector(size[i].v, size[i].v, 1, 2, 0, 3));
    const Row sizeLast(__builtin_shufflevector(size[i].v, size[i].v, 2, 0, 1, 3));
    const Row reach = p.ha[i1] * size[i2] + p.ha[i2] * size[i1] + next * sizeLast + last * sizeNext;
    const Row gap = far - reach - kRounding * (far + reach);
    found |= toBits(!(gap <= smaller(floor, 0)));
  }
  return (found & 7) != 0;
}

/// False if an edge axis separates by more than the margin: by `floor`.
bool edgeAxes(const BoxPair& p, float& floor, EdgeAxis& best) {
  if (!mayBeEdge(p, floor)) return true;
  return edgeAxis<0, 0>(p, floor, best) && edgeAxis<0, 1>(p, floor, best) && edgeAxis<0, 2>(p, floor, best) &&
         edgeAxis<1, 0>(p, floor, best) && edgeAxis<1, 1>(p, floor, best) && edgeAxis<1, 2>(p, floor, best) &&
         edgeAxis<2, 0>(p, floor, best) && edgeAxis<2, 1>(p, floor, best) && edgeAxis<2, 2>(p, floor, best);
}

/// Name of an edge: its axis and on which sides of the other two it lies.
uint32_t edgeName(int axis, const Axes& middle) {
  return static_cast<uint32_t>(axis) * 4 + (middle[kNext[axis]] > 0 ? 1 : 0) + (middle[kLast[axis]] > 0 ? 2 : 0);
}

/// The point where two edges cross, in a's frame; false where the lines come nearest beyond the edges' ends.
bool touchEdges(const BoxPair& p, const EdgeAxis& axis, bool swapped, Manifold& out) {
  const int i = axis.i, j = axis.j;
  const Axes n = axes(axis.normal);
  Axes pa{}, localB{};  // middles of the edges
  for (int k = 0; k < 3; ++k) {
    const float nb = p.r[0][k] * n[0] + p.r[1][k] * n[1] + p.r[2][k] * n[2];
    if (k != i) pa[k] = n[k] < 0 ? -p.ha[k] : p.ha[k];
    if (k != j) localB[k] = nb > 0 ? -p.hb[k] : p.hb[k];
  }
  Axes w;
  for (int k = 0; k < 3; ++k) {
    w[k] = p.da[k] + p.r[k][0] * localB[0] + p.r[k][1] * localB[1] + p.r[k][2] * localB[2] - pa[k];
  }
  const float cosine = p.r[i][j], wb = w[0] * p.r[0][j] + w[1] * p.r[1][j] + w[2] * p.r[2][j];
  const float sine2 = p.r[kNext[i]][j] * p.r[kNext[i]][j] + p.r[kLast[i]][j] * p.r[kLast[i]][j];
  const float freeS = (w[i] - cosine * wb) / sine2, s = clampTo(freeS, -p.ha[i], p.ha[i]);
  const float freeT = cosine * freeS - wb, t = clampTo(freeT, -p.hb[j], p.hb[j]);
  const bool within = magnitude(s - freeS) <= p.tolerance && magnitude(t - freeT) <= p.tolerance;
  pa[i] = s;
  Axes gap;
  for (int k = 0; k < 3; ++k) gap[k] = w[k] + t * p.r[k][j] - (k == i ? s : 0);
  const Vec3 normal = axis.normal;
  const float separation = dot(normal, vec(gap));
  const uint32_t a = edgeName(i, pa), b = edgeName(j, localB);
  out.normal = normal;
  out.count = 0;
  out.carrier = Carrier::None;
  if (separation > p.margin) return within;
  addPoint(out, vec(pa) + vec(gap) * 0.5f, separation, swapped ? 0x10000u | b << 4 | a : 0x10000u | a << 4 | b);
  return within;
}

/// The view of the reference box: a, or b where `ofB`.
FaceView viewOf(const BoxPair& p, bool ofB, int axis) {
  FaceView v;
  v.h = ofB ? p.hb : p.ha;
  v.other = ofB ? p.ha : p.hb;
  for (int i = 0; i < 3; ++i) {
    v.center[i] = ofB ? -p.db[i] : p.da[i];
    for (int j = 0; j < 3; ++j) v.turn[i][j] = ofB ? p.r[j][i] : p.r[i][j];
  }
  v.face = 2 * axis + (v.center[axis] < 0 ? 0 : 1);
  v.tolerance = p.tolerance;
  v.margin = p.margin;
  return v;
}

/// Turns points in a box's frame to the pair's.
void place(const Mat3& box, Vec3 center, Manifold& out) {
  out.normal = mul(box, out.normal);
  for (int k = 0; k < out.count; ++k) out.points[k].position = center + mul(box, out.points[k].position);
}

/// The best face's normal in a's frame, from a to b.
Vec3 normalOf(const BoxPair& p, const FaceAxis& face) {
  const int k = face.axis;
  if (face.ofB) return Vec3{p.r[0][k], p.r[1][k], p.r[2][k]} * (p.db[k] < 0 ? -1.0f : 1.0f);
  Axes n{};
  n[k] = p.da[k] < 0 ? -1.0f : 1.0f;
  return vec(n);
}

/// Points on the best face, in the pair's frame. Returns the smallest separation of the part of the other box's face
/// that lies over this one; infinite if none does.
float touchFace(const ShapePair& s, const Mat3& a, const BoxPair& p, const FaceAxis& face, Manifold& out) {
  const FaceView view = viewOf(p, face.ofB, face.axis);
  FacePoints found;
  clipFace(view, found);
  Axes n{};
  n[face.axis] = (view.face & 1) == (face.ofB ? 0 : 1) ? 1.0f : -1.0f;  // from a to b
  out.normal = vec(n);
  out.count = found.count;
  const uint32_t name = 0x20000u | (face.ofB != s.swapped ? 1u << 12 : 0u);
  for (int k = 0; k < found.count; ++k) {
    out.points[k] = found.points[k];
    out.points[k].feature |= name;
  }
  place(face.ofB ? matrix(s.poseB.q) : a, face.ofB ? s.poseB.p : s.poseA.p, out);
  out.carrier = face.ofB ? Carrier::B : Carrier::A;
  return found.count > 0 ? found.lowest : std::numeric_limits<float>::infinity();
}

/// Points of the edge axis. Where a face of almost the same direction shows the same gap, its points are better: edges
/// cross there, too, but in several places at once. False if the edges are not the nearest points.
bool touchEdgesOrFace(const ShapePair& s, const Mat3& a, const BoxPair& p, const FaceAxis& face, const EdgeAxis& edge,
                      Manifold& out) {
  if (dot(normalOf(p, face), edge.normal) > kSameDirection) {
    const float lowest = touchFace(s, a, p, face, out), slack = p.tolerance + kRelative * magnitude(edge.separation);
    if (out.count > 1 && magnitude(lowest - edge.separation) <= slack) return true;
  }
  const bool exact = touchEdges(p, edge, s.swapped, out);
  place(a, s.poseA.p, out);
  return exact;
}

/// The best axis did not lead to nearest points: those themselves, unless the points of a face are as near. `best` is
/// the axis' separation.
void touchOtherwise(const ShapePair& s, const Mat3& a, const BoxPair& p, float best, bool isFace, Manifold& out) {
  Manifold points;
  const float distance = touchNearest(p, points);
  if (out.count > 0) {
    if (best <= 0 || distance < p.tolerance) return;
    float nearest = out.points[0].separation;
    for (int k = 1; k < out.count; ++k) nearest = smaller(nearest, out.points[k].separation);
    if (isFace && distance >= nearest - p.tolerance) return;
  }
  if (s.swapped) {  // in names the caller's a comes first
    for (int k = 0; k < points.count; ++k) {
      const uint32_t name = points.points[k].feature, low = name & 31u, high = name >> 5 & 31u;
      points.points[k].feature = (name & ~1023u) | low << 5 | high;
    }
  }
  const Vec3 axis = out.normal;
  const bool keepAxis = distance < p.tolerance || best <= 0;
  if (keepAxis) {
    points.count = 1;
    points.points[0].separation = best;
  } else if (!(distance <= p.margin)) {
    points.count = 0;
  }
  out = points;
  place(a, s.poseA.p, out);
  if (keepAxis) out.normal = axis;
}

}  // namespace

void collideBoxBox(const ShapePair& s, Manifold& out) {
  const Mat3 a = matrix(s.poseA.q);
  const BoxPair p = makePair(s, a);
  FaceAxis faceA, faceB;
  if (!faceAxes(p, faceA, faceB, out.clear)) return;
  const FaceAxis& face = faceB.separation > faceA.separation + p.tolerance ? faceB : faceA;
  EdgeAxis edge;
  out.clear = face.separation + p.tolerance + kRelative * magnitude(face.separation);
  if (!edgeAxes(p, out.clear, edge)) return;
  out.clear = 0;
  const bool isFace = edge.i < 0;
  const float best = isFace ? face.separation : edge.separation;
  const bool exact = isFace ? touchFace(s, a, p, face, out) <= larger(best, 0) + p.tolerance
                            : touchEdgesOrFace(s, a, p, face, edge, out);
  if (!exact && (best > 0 || out.count == 0)) touchOtherwise(s, a, p, best, isFace, out);
}

}  // namespace avbd
