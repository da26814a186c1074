// Convex polyhedra swept by a ball (solid_moments.h).
#include <algorithm>
#include <vector>

#include "geom/solid_moments.h"

namespace avbd {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct HalfEdge {
  uint32_t from, to, triangle;
};

/// The sector of a ball at a vertex: its solid angle, and the integrals of u and u u^T over its directions u.
struct Sector {
  double angle = 2 * kPi;
  Vec3d first;
  SymMat3d second;
};

class Rounded {
 public:
  Rounded(std::span<const Vec3d> points, std::span<const std::array<uint32_t, 3>> triangles, double r)
      : points_(points), triangles_(triangles), r_(r), sectors_(points.size()) {}

  MomentSums sums() {
    for (const auto& t : triangles_) addFace(points_[t[0]], points_[t[1]], points_[t[2]]);
    addEdges();
    std::vector<bool> used(points_.size());
    for (const auto& t : triangles_) {
      for (uint32_t v : t) used[v] = true;
    }
    for (size_t v = 0; v < points_.size(); ++v) {
      if (used[v]) addVertex(points_[v], sectors_[v]);
    }
    return sums_;
  }

 private:
  void addFace(Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d n = normalized(cross(b - a, c - a)), up = n * r_;
    normals_.push_back(n);
    sums_.addTetrahedron({}, a, b, c);
    sums_.addTetrahedron(a, b, c, a + up);
    sums_.addTetrahedron(b, c, a + up, b + up);
    sums_.addTetrahedron(c, a + up, b + up, c + up);
  }

  void addEdges() {
    std::vector<HalfEdge> halves;
    for (uint32_t t = 0; t < triangles_.size(); ++t) {
      for (int i = 0; i < 3; ++i) halves.push_back({triangles_[t][i], triangles_[t][(i + 1) % 3], t});
    }
    // Both halves of an edge next to each other, the one from the smaller vertex first.
    std::sort(halves.begin(), halves.end(), [](const HalfEdge& l, const HalfEdge& r) {
      const uint32_t la = std::min(l.from, l.to), lb = std::max(l.from, l.to);
      const uint32_t ra = std::min(r.from, r.to), rb = std::max(r.from, r.to);
      if (la != ra) return la < ra;
      return lb != rb ? lb < rb : l.from < r.from;
    });
    for (size_t i = 0; i + 1 < halves.size(); i += 2) addEdge(halves[i], normals_[halves[i + 1].triangle]);
    for (const HalfEdge& half : halves) addCorner(half);
  }

  /// The wedge along an edge, and its arc's part in the sectors at its ends.
  void addEdge(const HalfEdge& edge, Vec3d right) {
    const Vec3d a = points_[edge.from], b = points_[edge.to], left = normals_[edge.triangle];
    const Vec3d d = b - a, m = (a + b) * 0.5;
    const double l = length(d);
    const Vec3d e = d * (1 / l), across = cross(e, left);
    const double s = dot(across, right), c = dot(left, right), theta = angleOf(c, s);
    // Over the arc from the left normal to the right: integral of u, and of u u^T.
    const Vec3d arc = left * s + across * (1 - c);
    SymMat3d square;
    addOuter(square, left, (theta + s * c) / 2);
    addOuter(square, across, (theta - s * c) / 2);
    addMixed(square, left, across, s * s / 2);

    const double volume = l * r_ * r_ * theta / 2, third = l * r_ * r_ * r_ / 3;
    sums_.volume += volume;
    sums_.first = sums_.first + m * volume + arc * third;
    addOuter(sums_.second, m, volume);
    addOuter(sums_.second, d, volume / 12);
    addMixed(sums_.second, m, arc, third);
    addScaled(sums_.second, square, l * r_ * r_ * r_ * r_ / 4);

    Sector &from = sectors_[edge.from], &to = sectors_[edge.to];
    from.first = from.first - e * (theta / 2);
    to.first = to.first + e * (theta / 2);
    addMixed(from.second, e, arc, -0.5);
    addMixed(to.second, e, arc, 0.5);
  }

  /// The triangle's angle at the vertex opposite to this edge is no part of that vertex's solid angle.
  void addCorner(const HalfEdge& edge) {
    for (uint32_t v : triangles_[edge.triangle]) {
      if (v == edge.from || v == edge.to) continue;
      const Vec3d a = points_[edge.from] - points_[v], b = points_[edge.to] - points_[v];
      sectors_[v].angle -= angleOf(dot(a, b), length(cross(a, b)));
    }
  }

  void addVertex(Vec3d p, Sector s) {
    s.second.xx += s.angle;
    s.second.yy += s.angle;
    s.second.zz += s.angle;
    const double cube = r_ * r_ * r_, volume = s.angle * cube / 3, fourth = cube * r_ / 4;
    sums_.volume += volume;
    sums_.first = sums_.first + p * volume + s.first * fourth;
    addOuter(sums_.second, p, volume);
    addMixed(sums_.second, p, s.first, fourth);
    // 3 times the integral of u u^T is the solid angle plus the arcs' sum.
    addScaled(sums_.second, s.second, cube * r_ * r_ / 15);
  }

  std::span<const Vec3d> points_;
  std::span<const std::array<uint32_t, 3>> triangles_;
  double r_;
  std::vector<Vec3d> normals_;
  std::vector<Sector> sectors_;
  MomentSums sums_;
};

}  // namespace

SolidMoments roundedMoments(std::span<const Vec3d> points, std::span<const std::array<uint32_t, 3>> triangles,
                            double rounding) {
  if (!(rounding > 0)) return polyhedronMoments(points, triangles);
  Vec3d middle;
  for (const Vec3d& p : points) middle = middle + p * (1.0 / static_cast<double>(points.size()));
  std::vector<Vec3d> centered;
  for (const Vec3d& p : points) centered.push_back(p - middle);
  return Rounded(centered, triangles, rounding).sums().about(middle);
}

}  // namespace avbd
