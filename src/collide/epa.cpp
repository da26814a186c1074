// Depth of two overlapping convex cores (epa.h).
#include "collide/epa.h"

#include <limits>

namespace avbd {
namespace {

constexpr int kMaxPoints = 128;
constexpr int kMaxFaces = 2 * kMaxPoints;
constexpr double kFlat = 1e-9;        // of the size: extent below which the difference counts as flat
constexpr double kRounding = 1e-14;   // of the size: gain of a point that may be rounding
constexpr double kCoplanar = 1e-9;    // of the size: faces as near as this to the nearest may lie in its plane
constexpr double kSamePlane = 0.999;  // cosine between their normals
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Face {
  int point[3];  // anticlockwise seen from outside
  int next[3];   // face beyond the edge from point[i] to point[i + 1]
  Vec3d normal;
};

/// An edge between faces that stay (face, edge of it) and those that a new point sees.
struct RimEdge {
  int face, edge;
};

class Polytope {
 public:
  explicit Polytope(const CorePair& pair) : pair_(pair) {}

  /// Four points with volume; false if the difference has none, then `across` is a direction without extent.
  bool begin(const Simplex& s, Vec3d& across);
  /// Face nearest to the origin.
  int nearest() const;
  /// Adds a point that sees the face; false if the polytope is full or the point adds nothing.
  bool add(int face, const DifferencePoint& p);

  double distance(int face) const { return distance_[face]; }
  Vec3d normal(int face) const { return faces_[face].normal; }
  /// The origin's projection onto the nearest face, or onto one in the same plane that holds it.
  void nearestSimplex(double within, Simplex& out) const;

 private:
  double simplexOf(int face, Simplex& out) const;
  void setFace(int f, int a, int b, int c);
  int newFace();
  void markSeen(int face, int from, Vec3d w);
  bool sees(Vec3d w, int f) const { return dot3(faces_[f].normal, w) > distance_[f] + kRounding * pair_.size; }
  bool grow(DifferencePoint* p, Vec3d& across) const;

  const CorePair& pair_;
  DifferencePoint points_[kMaxPoints];
  Face faces_[kMaxFaces];
  double distance_[kMaxFaces];  // of the face's plane along its normal; infinite: no face here
  bool live_[kMaxFaces];
  int free_[kMaxFaces];
  RimEdge rim_[kMaxFaces];
  int pointCount_ = 0, faceCount_ = 0, freeCount_ = 0, rimCount_ = 0;
};

/// The point of the difference farthest from p in any of the directions +-d.
DifferencePoint farther(const CorePair& pair, Vec3d d, Vec3d from, double& reach) {
  const DifferencePoint p = lowest(pair, d), q = lowest(pair, d * -1.0);
  const double rp = dot3(d, from - p.w), rq = dot3(d, q.w - from);
  reach = rp >= rq ? rp : rq;
  return rp >= rq ? p : q;
}

Vec3d unit(Vec3d v) { return v * (1 / length(v)); }

/// A unit vector across v.
Vec3d anyAcross(Vec3d v) {
  const double x = v.x < 0 ? -v.x : v.x, y = v.y < 0 ? -v.y : v.y, z = v.z < 0 ? -v.z : v.z;
  return unit(cross3(v, x <= y && x <= z ? Vec3d{1, 0, 0} : (y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1})));
}

bool Polytope::grow(DifferencePoint* p, Vec3d& across) const {
  const double least = kFlat * pair_.size;
  double reach = 0;
  const Vec3d axis[3] = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
  for (int i = 0; i < 3 && !(reach > least); ++i) p[1] = farther(pair_, axis[i], p[0].w, reach);
  across = {0, 1, 0};
  if (!(reach > least)) return false;
  const Vec3d along = unit(p[1].w - p[0].w), side = anyAcross(along);
  p[2] = farther(pair_, side, p[0].w, reach);
  if (!(reach > least)) p[2] = farther(pair_, cross3(along, side), p[0].w, reach);
  across = side;
  if (!(reach > least)) return false;
  across = unit(cross3(along, p[2].w - p[0].w));
  p[3] = farther(pair_, across, p[0].w, reach);
  return reach > least;
}

bool Polytope::begin(const Simplex& s, Vec3d& across) {
  DifferencePoint p[4];
  for (int i = 0; i < s.count; ++i) p[i] = s.point[i];
  const auto volume = [&] { return dot3(cross3(p[1].w - p[0].w, p[2].w - p[0].w), p[3].w - p[0].w); };
  const double large = 1e-9 * pair_.size * pair_.size * pair_.size;
  const double v = s.count == 4 ? volume() : 0;
  if (!(v > large || v < -large) && !grow(p, across)) return false;
  if (volume() > 0) {
    const DifferencePoint t = p[1];
    p[1] = p[2];
    p[2] = t;
  }
  // Now the first three turn left seen from outside.
  for (int i = 0; i < 4; ++i) points_[i] = p[i];
  pointCount_ = 4;
  faceCount_ = 4;
  setFace(0, 0, 1, 2);
  setFace(1, 0, 3, 1);
  setFace(2, 1, 3, 2);
  setFace(3, 2, 3, 0);
  constexpr int kNextFace[4][3] = {{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}};
  for (int f = 0; f < 4; ++f) {
    for (int i = 0; i < 3; ++i) faces_[f].next[i] = kNextFace[f][i];
  }
  return true;
}

void Polytope::setFace(int f, int a, int b, int c) {
  Face& face = faces_[f];
  face.point[0] = a, face.point[1] = b, face.point[2] = c;
  const Vec3d pa = points_[a].w, n = cross3(points_[b].w - pa, points_[c].w - pa);
  const double l = length(n);
  live_[f] = true;
  // A face without area is part of the surface but never the nearest.
  if (l > 1e-24 * pair_.size * pair_.size) {
    face.normal = n * (1 / l);
    distance_[f] = dot3(face.normal, pa);
  } else {
    face.normal = {};
    distance_[f] = kInfinity;
  }
}

int Polytope::nearest() const {
  int best = 0;
  double least = kInfinity;
  for (int f = 0; f < faceCount_; ++f) {
    best = distance_[f] < least ? f : best;
    least = distance_[f] < least ? distance_[f] : least;
  }
  return best;
}

int Polytope::newFace() {
  if (freeCount_ > 0) return free_[--freeCount_];
  return faceCount_ < kMaxFaces ? faceCount_++ : -1;
}

/// Takes away a face and all seen ones about it, round its edges from `from` on; the rim is found in order.
void Polytope::markSeen(int f, int from, Vec3d w) {
  live_[f] = false;
  for (int i = 0; i < (from < 0 ? 3 : 2); ++i) {
    const int edge = from < 0 ? i : (from + 1 + i) % 3, other = faces_[f].next[edge];
    if (!live_[other]) continue;
    int back = 0;
    while (back < 2 && faces_[other].next[back] != f) ++back;
    if (sees(w, other)) {
      markSeen(other, back, w);
    } else if (rimCount_ < kMaxFaces) {
      rim_[rimCount_++] = {other, back};
    }
  }
  distance_[f] = kInfinity;
  free_[freeCount_++] = f;
}

bool Polytope::add(int face, const DifferencePoint& p) {
  if (pointCount_ >= kMaxPoints) return false;
  for (int i = 0; i < pointCount_; ++i) {
    if (points_[i].w == p.w) return false;
  }
  const int point = pointCount_++;
  points_[point] = p;
  rimCount_ = 0;
  markSeen(face, -1, p.w);
  if (rimCount_ < 3) return false;
  int first = -1, last = -1;
  for (int i = 0; i < rimCount_; ++i) {
    const int f = newFace();
    if (f < 0) return false;
    Face& stays = faces_[rim_[i].face];
    const int e = rim_[i].edge, a = stays.point[(e + 1) % 3], b = stays.point[e];
    setFace(f, a, b, point);
    faces_[f].next[0] = rim_[i].face;
    stays.next[e] = f;
    if (last >= 0) {
      if (faces_[last].point[1] != a) return false;
      faces_[last].next[1] = f;
      faces_[f].next[2] = last;
    } else {
      first = f;
    }
    last = f;
  }
  faces_[last].next[1] = first;
  faces_[first].next[2] = last;
  return faces_[last].point[1] == faces_[first].point[0];
}

/// The face with the weights of the origin's projection onto it, cut off at its edges; the least weight before that.
double Polytope::simplexOf(int f, Simplex& out) const {
  out.count = 3;
  double sum = 0, area[3];
  const Vec3d n = faces_[f].normal;
  for (int i = 0; i < 3; ++i) {
    out.point[i] = points_[faces_[f].point[i]];
    // Twice the area of the origin's projection with the edge across from the point.
    area[i] = dot3(n, cross3(points_[faces_[f].point[(i + 1) % 3]].w, points_[faces_[f].point[(i + 2) % 3]].w));
    sum += area[i];
  }
  double least = kInfinity, kept = 0;
  for (int i = 0; i < 3; ++i) {
    least = area[i] < least ? area[i] : least;
    out.weight[i] = area[i] > 0 ? area[i] : 0;
    kept += out.weight[i];
  }
  for (int i = 0; i < 3; ++i) out.weight[i] = kept > 0 ? out.weight[i] / kept : 1.0 / 3;
  return sum > 0 ? least / sum : -kInfinity;
}

void Polytope::nearestSimplex(double within, Simplex& out) const {
  const int best = nearest();
  const double limit = distance_[best] + within;
  double inside = simplexOf(best, out);
  for (int f = 0; f < faceCount_ && inside < 0; ++f) {
    if (f == best || !(distance_[f] <= limit)) continue;
    if (dot3(faces_[f].normal, faces_[best].normal) < kSamePlane) continue;
    Simplex other;
    const double now = simplexOf(f, other);
    if (!(now > inside)) continue;
    inside = now;
    out = other;
  }
}

}  // namespace

void epa(const CorePair& pair, const Simplex& simplex, double tolerance, Depth& out) {
  Polytope polytope(pair);
  Vec3d across;
  if (!polytope.begin(simplex, across)) {
    out = {};
    out.flat = true;
    out.normal = dot3(across, pair.offset) < 0 ? across * -1.0 : across;
    out.face = simplex;
    return;
  }
  out.depth = kInfinity;
  const double enough = tolerance * pair.size;
  while (true) {
    const int f = polytope.nearest();
    const double lower = polytope.distance(f);
    if (!(lower < kInfinity)) return;
    // The face looks along n; b moved by the depth along -n parts them, so the normal from a to b is -n.
    const Vec3d n = polytope.normal(f);
    const DifferencePoint p = lowest(pair, n * -1.0);
    const double upper = dot3(n, p.w);
    out.lower = lower;
    const bool done = upper - lower <= enough;
    // The last face, whose corners all lie on the surface, even where one before it showed as little.
    if (upper < out.depth || done) {
      out.depth = upper;
      out.normal = n * -1.0;
      polytope.nearestSimplex(kCoplanar * pair.size, out.face);
    }
    if (done) return;
    if (!polytope.add(f, p)) return;
  }
}

}  // namespace avbd
