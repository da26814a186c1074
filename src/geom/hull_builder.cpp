// Points to vertices and polygons (hull_builder.h).
#include "geom/hull_builder.h"

#include <avbd/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/assert.h"
#include "base/format.h"
#include "geom/hull_exact.h"
#include "geom/hull_merge.h"

namespace avbd {
namespace {

constexpr float kMaxCoordinate = 1e6f;
constexpr double kDefaultTolerance = 1e-4;  // of the largest extent
constexpr double kLeastTolerance = 1e-9;    // of the largest extent: a thousand cells of the grid

[[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& range) {
  throw Error("HullDef", field, value, range);
}

struct Bounds {
  Vec3d lower, upper;
  double extent() const { return std::fmax(upper.x - lower.x, std::fmax(upper.y - lower.y, upper.z - lower.z)); }
};

Bounds checkedBounds(const HullDef& def) {
  if (def.maxVertices < 4 || def.maxVertices > 255) {
    refuse("maxVertices", toText(def.maxVertices), "must be at least 4 and at most 255");
  }
  if (!(def.tolerance >= 0) || !(def.tolerance <= kMaxCoordinate)) {
    refuse("tolerance", toText(def.tolerance), "must be finite and >= 0 and at most 1e+06");
  }
  if (def.points.size() < 4) refuse("points", toText(def.points.size()) + " points", "must be at least 4");
  if (def.points.size() >= 0x7fffffffu) refuse("points", toText(def.points.size()) + " points", "must be below 2^31");
  Bounds b{toDouble(def.points[0]), toDouble(def.points[0])};
  for (size_t i = 0; i < def.points.size(); ++i) {
    const Vec3 p = def.points[i];
    // Written so that NaN fails.
    if (!(std::fabs(p.x) <= kMaxCoordinate && std::fabs(p.y) <= kMaxCoordinate && std::fabs(p.z) <= kMaxCoordinate)) {
      refuse("points[" + toText(i) + "]", toText(p), "must be finite and at most 1e+06 in size");
    }
    b.lower = {std::fmin(b.lower.x, p.x), std::fmin(b.lower.y, p.y), std::fmin(b.lower.z, p.z)};
    b.upper = {std::fmax(b.upper.x, p.x), std::fmax(b.upper.y, p.y), std::fmax(b.upper.z, p.z)};
  }
  return b;
}

void refuseFlat(ExactHull::Flat flat, size_t points, double tolerance) {
  if (flat == ExactHull::Flat::No) return;
  const char* shape = flat == ExactHull::Flat::Point  ? "at one point"
                      : flat == ExactHull::Flat::Line ? "on one line (collinear)"
                                                      : "in one plane (coplanar)";
  refuse("points", toText(points) + " points " + shape,
         "must span a volume: more than " + toText(static_cast<float>(tolerance)) + " m off one plane");
}

using Triangles = std::vector<ExactHull::Triangle>;

/// A few points (in cells) and which of them are vertices now.
class Vertices {
 public:
  Vertices(std::vector<Vec3d> points, double tolerance)
      : points_(std::move(points)), tolerance_(tolerance), links_(points_.size()), cost_(points_.size(), -1) {
    for (uint32_t i = 0; i < points_.size(); ++i) set_.push_back(i);
    rebuild();
  }

  const std::vector<uint32_t>& set() const { return set_; }
  const Triangles& triangles() const { return triangles_; }  ///< indices into set()
  std::vector<Vec3d> positions() const { return take(set_); }

  /// Leaves out what the others span within the tolerance, and the least beyond the limit.
  void simplify(size_t limit) {
    while (set_.size() > limit && set_.size() > 4) {
      findCosts();
      if (leaveOut(leastApart((set_.size() - limit + 3) / 4), true)) continue;
      // What is left would be flat: one at a time, and never one that all the others need.
      const uint32_t least = leastApart(1)[0], gone = set_[least];
      if (cost_[gone] == kNeeded) break;
      if (!leaveOut({least}, true)) cost_[gone] = kNeeded;
    }
    while (set_.size() > 4) {
      findCosts();
      const uint32_t least = leastApart(1)[0], gone = set_[least];
      if (cost_[gone] > tolerance_) return;
      if (!leaveOut({least}, false)) cost_[gone] = kNeeded;
    }
  }

  /// Places of the vertices of least cost, at most so many, no two of them neighbours: their costs do not change
  /// together.
  std::vector<uint32_t> leastApart(size_t count) const {
    std::vector<uint32_t> places(set_.size()), chosen;
    std::iota(places.begin(), places.end(), 0u);
    std::sort(places.begin(), places.end(), [this](uint32_t a, uint32_t b) {
      const double l = cost_[set_[a]], r = cost_[set_[b]];
      return l != r ? l < r : a < b;
    });
    std::vector<bool> taken(points_.size());
    for (uint32_t place : places) {
      if (chosen.size() == count) break;
      if (taken[set_[place]]) continue;
      chosen.push_back(place);
      for (uint32_t v : links_[set_[place]]) taken[v] = true;
    }
    return chosen;
  }

  /// Vertices by place in set(). False, and nothing happens, if what is left would be flat or, unless forced, if some
  /// point left out were too far outside.
  bool leaveOut(const std::vector<uint32_t>& places, bool force) {
    std::vector<uint32_t> kept;
    std::vector<uint32_t> lost = lost_;
    for (uint32_t i = 0; i < set_.size(); ++i) {
      (std::find(places.begin(), places.end(), i) == places.end() ? kept : lost).push_back(set_[i]);
    }
    if (kept.size() < 4) return false;
    const std::vector<Vec3d> corners = take(kept);
    for (size_t i = 0; !force && i < lost.size(); ++i) {
      const Vec3d p = points_[lost[i]];
      if (length(p - nearestInHull(p, corners)) > tolerance_) return false;
    }
    const std::vector<uint32_t> before = set_;
    set_ = kept;
    if (!rebuild()) {
      set_ = before;
      rebuild();
      return false;
    }
    // A forced loss is the limit's; the tolerance does not pay for it.
    if (!force) lost_ = lost;
    for (uint32_t place : places) {
      for (uint32_t v : links_[before[place]]) cost_[v] = -1;
    }
    return true;
  }

 private:
  static constexpr double kNeeded = 1e300;

  std::vector<Vec3d> take(const std::vector<uint32_t>& which) const {
    std::vector<Vec3d> all;
    for (uint32_t i : which) all.push_back(points_[i]);
    return all;
  }

  bool rebuild() {
    const std::vector<Vec3d> corners = take(set_);
    ExactHull hull(corners);
    if (hull.begin(0) != ExactHull::Flat::No) return false;
    hull.grow(0, 1 << 30);
    triangles_ = hull.triangles();
    // Points within the others' hull are no vertices.
    std::vector<uint32_t> place(set_.size(), 0), used;
    for (const auto& t : triangles_) {
      for (uint32_t v : t.vertex) place[v] = 1;
    }
    for (uint32_t i = 0; i < set_.size(); ++i) {
      if (!place[i]) continue;
      place[i] = static_cast<uint32_t>(used.size());
      used.push_back(set_[i]);
    }
    for (auto& t : triangles_) {
      for (uint32_t& v : t.vertex) v = place[v];
    }
    set_ = used;
    return true;
  }

  /// How far each vertex lies outside the hull of the others: as far as outside the hull of its neighbours.
  void findCosts() {
    for (uint32_t v : set_) links_[v].clear();
    for (const auto& t : triangles_) {
      for (int i = 0; i < 3; ++i) links_[set_[t.vertex[i]]].push_back(set_[t.vertex[(i + 1) % 3]]);
    }
    for (uint32_t v : set_) {
      if (cost_[v] >= 0) continue;
      const std::vector<Vec3d> link = take(links_[v]);
      cost_[v] = length(points_[v] - nearestInHull(points_[v], link));
    }
  }

  std::vector<Vec3d> points_;
  double tolerance_;
  std::vector<uint32_t> set_, lost_;
  Triangles triangles_;
  std::vector<std::vector<uint32_t>> links_;
  std::vector<double> cost_;
};

/// Faces of the vertices; leaves out those that turn out to hold nothing up.
MergedFaces facesOf(Vertices& vertices, double tolerance) {
  for (double planar = tolerance; planar > 1; planar = planar > 64 ? planar / 8 : 0) {
    for (;;) {
      MergedFaces faces = mergeFaces(vertices.positions(), vertices.triangles(), planar);
      if (faces.weak.empty()) return faces;
      if (!vertices.leaveOut(faces.weak, false)) break;
    }
  }
  return mergeFaces(vertices.positions(), vertices.triangles(), 0);
}

/// The points in an order that only their places give. Of those that the grid does not tell apart the least: which one
/// stands for them does not depend on who came first either.
std::vector<Vec3> distinct(std::span<const Vec3> points, const HullGrid& grid) {
  std::vector<Vec3> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(), [&](const Vec3& a, const Vec3& b) {
    const Vec3d ga = grid.toGrid(toDouble(a)), gb = grid.toGrid(toDouble(b));
    if (lexLess(ga, gb) || lexLess(gb, ga)) return lexLess(ga, gb);
    return lexLess(toDouble(a), toDouble(b));
  });
  const auto same = [&](const Vec3& a, const Vec3& b) { return grid.toGrid(toDouble(a)) == grid.toGrid(toDouble(b)); };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  return sorted;
}

}  // namespace

std::shared_ptr<const HullData> makeHull(const HullDef& def) {
  const Bounds bounds = checkedBounds(def);
  const double extent = bounds.extent();
  const double asked = def.tolerance > 0 ? def.tolerance : kDefaultTolerance * extent;
  const HullGrid grid(bounds.lower, bounds.upper);
  const double tolerance = grid.toGrid(std::fmax(asked, kLeastTolerance * extent));

  const std::vector<Vec3> given = distinct(def.points, grid);
  std::vector<Vec3d> points;
  points.reserve(given.size());
  for (const Vec3& p : given) points.push_back(grid.toGrid(toDouble(p)));
  ExactHull hull(points);
  refuseFlat(hull.begin(tolerance), def.points.size(), asked);
  hull.grow(tolerance / 2, def.maxVertices + def.maxVertices / 2);

  // Vertices in an order that only their places give.
  std::vector<uint32_t> chosen;
  for (const auto& t : hull.triangles()) chosen.insert(chosen.end(), t.vertex.begin(), t.vertex.end());
  std::sort(chosen.begin(), chosen.end(), [&](uint32_t a, uint32_t b) { return lexLess(points[a], points[b]); });
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  std::vector<Vec3d> corners;
  for (uint32_t i : chosen) corners.push_back(points[i]);
  Vertices vertices(corners, tolerance / 2);
  vertices.simplify(static_cast<size_t>(def.maxVertices));

  const MergedFaces faces = facesOf(vertices, tolerance / 4);
  HullParts parts;
  parts.loops = faces.loops;
  // Adding 0 turns -0 into 0.
  for (uint32_t i : vertices.set()) parts.vertices.push_back(given[chosen[i]] + Vec3{0, 0, 0});

  std::vector<ExactHull::Triangle> triangles = vertices.triangles();
  for (auto& t : triangles) {
    for (uint32_t& v : t.vertex) v = chosen[vertices.set()[v]];
  }
  parts.error = grid.fromGrid(hull.errorOf(triangles));
  const std::shared_ptr<const HullData> made = HullFactory::make(parts);
  // Whose volume no float can hold.
  if (!(made->massProperties(1).mass >= std::numeric_limits<float>::min()))
    refuse("points", toText(def.points.size()) + " points that span " + toText(extent),
           "must enclose more than 1.2e-38");
  if (!(made->innerRadius() > 0))
    refuse("points", toText(def.points.size()) + " points in one plane", "must lie apart by more than their rounding");
  return made;
}

std::vector<std::array<uint32_t, 3>> hullTriangles(std::span<const Vec3d> points) {
  Vec3d lower = points[0], upper = points[0];
  for (const Vec3d& p : points) {
    lower = {std::fmin(lower.x, p.x), std::fmin(lower.y, p.y), std::fmin(lower.z, p.z)};
    upper = {std::fmax(upper.x, p.x), std::fmax(upper.y, p.y), std::fmax(upper.z, p.z)};
  }
  const HullGrid grid(lower, upper);
  std::vector<Vec3d> cells;
  for (const Vec3d& p : points) cells.push_back(grid.toGrid(p));
  ExactHull hull(cells);
  std::vector<std::array<uint32_t, 3>> all;
  if (hull.begin(0) != ExactHull::Flat::No) return all;
  hull.grow(0, 1 << 30);
  for (const auto& t : hull.triangles()) all.push_back(t.vertex);
  return all;
}

}  // namespace avbd
