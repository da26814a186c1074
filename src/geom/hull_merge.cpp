// Polygons of a hull (hull_merge.h).
#include "geom/hull_merge.h"

#include <algorithm>
#include <cmath>

namespace avbd {
namespace {

constexpr double kFolded = 0.2;  // least cosine between a face and its triangles

class Merger {
 public:
  Merger(std::span<const Vec3d> points, std::span<const ExactHull::Triangle> triangles, double tolerance)
      : points_(points), triangles_(triangles), tolerance_(tolerance), next_(points.size(), kNone) {
    for (uint32_t t = 0; t < triangles.size(); ++t) {
      const auto& v = triangles[t].vertex;
      areas_.push_back(cross(points[v[1]] - points[v[0]], points[v[2]] - points[v[0]]));
      groupOf_.push_back(t);
      groups_.push_back({t});
    }
  }

  void merge() {
    struct Edge {
      double bend;
      uint32_t a, b, triangle, across;
    };
    std::vector<Edge> edges;
    for (uint32_t t = 0; t < triangles_.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const uint32_t a = triangles_[t].vertex[i], b = triangles_[t].vertex[(i + 1) % 3];
        if (a < b) edges.push_back({bend(t, triangles_[t].across[i]), a, b, t, triangles_[t].across[i]});
      }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& l, const Edge& r) {
      if (l.bend != r.bend) return l.bend < r.bend;
      return l.a != r.a ? l.a < r.a : l.b < r.b;
    });
    // A bend of many times the tolerance never merges.
    while (!edges.empty() && edges.back().bend > 8 * tolerance_) edges.pop_back();
    for (bool again = true; again;) {
      again = false;
      for (const Edge& e : edges) {
        const uint32_t left = groupOf_[e.triangle], right = groupOf_[e.across];
        if (left != right && join(left, right)) again = true;
      }
    }
  }

  MergedFaces result() {
    MergedFaces faces;
    std::vector<uint32_t> degree(points_.size());
    std::vector<bool> weak(points_.size());
    for (const auto& group : groups_) {
      if (group.empty()) continue;
      findRim(group);
      const Vec3d normal = normalized(area(group));
      for (size_t i = 0; i < rim_.size(); ++i) {
        ++degree[rim_[i]];
        if (rim_.size() > 3 && corner(i, normal) <= 0) weak[rim_[i]] = true;
      }
      std::rotate(rim_.begin(), std::min_element(rim_.begin(), rim_.end()), rim_.end());
      faces.loops.push_back(rim_);
    }
    std::sort(faces.loops.begin(), faces.loops.end());
    for (uint32_t v = 0; v < points_.size(); ++v) {
      if (degree[v] < 3 || weak[v]) faces.weak.push_back(v);
    }
    return faces;
  }

 private:
  static constexpr uint32_t kNone = ~0u;

  /// How far the neighbour's free corner lies below the triangle's plane, or the triangle's below the neighbour's.
  double bend(uint32_t t, uint32_t across) const {
    const auto below = [this](uint32_t from, uint32_t other) {
      const Vec3d normal = normalized(areas_[from]), a = points_[triangles_[from].vertex[0]];
      double deepest = 0;
      for (uint32_t v : triangles_[other].vertex) deepest = std::fmax(deepest, -dot(normal, points_[v] - a));
      return deepest;
    };
    return std::fmin(below(t, across), below(across, t));
  }

  Vec3d area(const std::vector<uint32_t>& group) const {
    Vec3d sum;
    for (uint32_t t : group) sum = sum + areas_[t];
    return sum;
  }

  /// The group's rim in order. False where it is not one loop that meets no vertex twice.
  bool findRim(const std::vector<uint32_t>& group) {
    rim_.clear();
    const uint32_t own = groupOf_[group[0]];
    size_t edges = 0;
    uint32_t start = kNone;
    bool simple = true;
    for (uint32_t t : group) {
      for (int i = 0; i < 3; ++i) {
        if (groupOf_[triangles_[t].across[i]] == own) continue;
        const uint32_t a = triangles_[t].vertex[i];
        if (next_[a] != kNone) simple = false;
        next_[a] = triangles_[t].vertex[(i + 1) % 3];
        start = std::min(start, a);
        ++edges;
      }
    }
    for (uint32_t v = start; v != kNone && next_[v] != kNone;) {
      rim_.push_back(v);
      const uint32_t after = next_[v];
      next_[v] = kNone;
      v = after;
    }
    for (uint32_t t : group) {
      for (uint32_t v : triangles_[t].vertex) next_[v] = kNone;
    }
    return simple && rim_.size() == edges;
  }

  /// How far corner i of the rim stands out of the line between its neighbours, in the plane of `normal`.
  double corner(size_t i, Vec3d normal) const {
    const size_t n = rim_.size();
    const Vec3d before = points_[rim_[(i + n - 1) % n]], at = points_[rim_[i]], after = points_[rim_[(i + 1) % n]];
    const double span = length(after - before);
    return span > 0 ? dot(cross(at - before, after - at), normal) / span : 0;
  }

  bool join(uint32_t left, uint32_t right) {
    std::vector<uint32_t> both = groups_[left];
    both.insert(both.end(), groups_[right].begin(), groups_[right].end());
    const Vec3d normal = normalized(area(both));
    for (uint32_t t : both) {
      if (dot(normalized(areas_[t]), normal) < kFolded) return false;
    }
    const Vec3d origin = points_[triangles_[both[0]].vertex[0]];
    double lowest = 0, support = 0;
    for (uint32_t t : both) {
      for (uint32_t v : triangles_[t].vertex) lowest = std::fmin(lowest, dot(normal, points_[v] - origin));
    }
    for (const Vec3d& p : points_) support = std::fmax(support, dot(normal, p - origin));
    if (support - lowest > tolerance_) return false;
    for (uint32_t t : groups_[right]) groupOf_[t] = left;
    bool good = findRim(both) && rim_.size() >= 3;
    for (size_t i = 0; good && i < rim_.size(); ++i) good = corner(i, normal) >= -tolerance_;
    if (!good) {
      for (uint32_t t : groups_[right]) groupOf_[t] = right;
      return false;
    }
    groups_[left] = std::move(both);
    groups_[right].clear();
    return true;
  }

  std::span<const Vec3d> points_;
  std::span<const ExactHull::Triangle> triangles_;
  double tolerance_;
  std::vector<Vec3d> areas_;
  std::vector<uint32_t> groupOf_;              // of a triangle
  std::vector<std::vector<uint32_t>> groups_;  // triangles; empty where merged into another
  std::vector<uint32_t> next_, rim_;
};

}  // namespace

MergedFaces mergeFaces(std::span<const Vec3d> points, std::span<const ExactHull::Triangle> triangles,
                       double tolerance) {
  Merger merger(points, triangles, tolerance);
  if (tolerance > 0) merger.merge();
  return merger.result();
}

Vec3d loopArea(std::span<const Vec3d> points, std::span<const uint32_t> loop) {
  Vec3d sum;
  for (size_t i = 2; i < loop.size(); ++i) {
    sum = sum + cross(points[loop[i - 1]] - points[loop[0]], points[loop[i]] - points[loop[0]]);
  }
  return sum;
}

}  // namespace avbd
