// Welding, closedness and signed distance (decompose_surface.h).
#include "geom/decompose_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/format.h"

namespace avbd {
namespace {

// Not fmin and fmax: calls, which took half the time of a search.
double least(double a, double b) { return b < a ? b : a; }
double most(double a, double b) { return b > a ? b : a; }
Vec3d least(Vec3d a, Vec3d b) { return {least(a.x, b.x), least(a.y, b.y), least(a.z, b.z)}; }
Vec3d most(Vec3d a, Vec3d b) { return {most(a.x, b.x), most(a.y, b.y), most(a.z, b.z)}; }
double part(Vec3d v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

struct HalfEdge {
  uint32_t low, high, triangle;
  uint8_t corner;
  bool forward;  // from low to high
};

std::vector<HalfEdge> sortedEdges(std::span<const std::array<uint32_t, 3>> triangles) {
  std::vector<HalfEdge> all;
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    for (uint8_t i = 0; i < 3; ++i) {
      const uint32_t a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      all.push_back({std::min(a, b), std::max(a, b), t, i, a < b});
    }
  }
  std::sort(all.begin(), all.end(), [](const HalfEdge& l, const HalfEdge& r) {
    if (l.low != r.low) return l.low < r.low;
    return l.high != r.high ? l.high < r.high : l.triangle < r.triangle;
  });
  return all;
}

/// Calls f(first, last) for each edge's run of half edges.
template <class F>
void forEdges(const std::vector<HalfEdge>& edges, F f) {
  for (size_t i = 0; i < edges.size();) {
    size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    f(i, end);
    i = end;
  }
}

double boxDistanceSquared(Vec3d p, Vec3d lower, Vec3d upper) {
  const Vec3d d = most(most(lower - p, p - upper), {0, 0, 0});
  return dot(d, d);
}

}  // namespace

ClosedSurface::ClosedSurface(std::span<const Vec3> vertices, std::span<const std::array<uint32_t, 3>> triangles) {
  std::vector<uint32_t> byPlace(vertices.size()), name(vertices.size());
  std::iota(byPlace.begin(), byPlace.end(), 0u);
  const auto at = [&](uint32_t i) { return toDouble(vertices[i]); };
  std::sort(byPlace.begin(), byPlace.end(), [&](uint32_t a, uint32_t b) { return lexLess(at(a), at(b)); });
  for (size_t i = 0; i < byPlace.size(); ++i) {
    if (i == 0 || lexLess(vertices_.back(), at(byPlace[i]))) vertices_.push_back(at(byPlace[i]));
    name[byPlace[i]] = static_cast<uint32_t>(vertices_.size() - 1);
  }
  for (const auto& t : triangles) {
    std::array<uint32_t, 3> v{name[t[0]], name[t[1]], name[t[2]]};
    if (length(cross(vertices_[v[1]] - vertices_[v[0]], vertices_[v[2]] - vertices_[v[0]])) == 0) continue;
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    triangles_.push_back(v);
  }
  std::sort(triangles_.begin(), triangles_.end());
  triangles_.erase(std::unique(triangles_.begin(), triangles_.end()), triangles_.end());
  if (triangles_.empty()) return;
  lower_ = upper_ = vertices_[triangles_[0][0]];
  for (const auto& t : triangles_) {
    for (uint32_t v : t) lower_ = least(lower_, vertices_[v]), upper_ = most(upper_, vertices_[v]);
  }
  findOpenEdges();
  findNormals();
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(triangles_.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<uint32_t>(order_.size()));
}

void ClosedSurface::findOpenEdges() {
  const std::vector<HalfEdge> edges = sortedEdges(triangles_);
  forEdges(edges, [&](size_t begin, size_t end) {
    size_t forward = 0;
    for (size_t i = begin; i < end; ++i) forward += edges[i].forward;
    if (end - begin == 2 && forward == 1) return;
    if (++open_.count > 1) return;
    const HalfEdge& e = edges[begin];
    open_.first = "edge " + toText(toFloat(vertices_[e.low])) + " to " + toText(toFloat(vertices_[e.high])) + " of " +
                  toText(end - begin) + (end - begin == 1 ? " triangle" : " triangles") +
                  (end - begin == 2 ? " that disagree about the outside" : "");
  });
}

/// Normals of faces, and for edges and vertices those that tell inside from outside for a point whose nearest point
/// lies there: vertices weigh each face by its angle (Baerentzen and Aanaes, Signed distance computation using the
/// angle weighted pseudonormal, 2005).
void ClosedSurface::findNormals() {
  vertexNormals_.assign(vertices_.size(), {});
  for (const auto& t : triangles_) {
    const Vec3d a = vertices_[t[0]], b = vertices_[t[1]], c = vertices_[t[2]];
    const Vec3d n = normalized(cross(b - a, c - a));
    faceNormals_.push_back(n);
    const auto angle = [](Vec3d u, Vec3d v) { return angleOf(dot(u, v), length(cross(u, v))); };
    vertexNormals_[t[0]] = vertexNormals_[t[0]] + n * angle(b - a, c - a);
    vertexNormals_[t[1]] = vertexNormals_[t[1]] + n * angle(c - b, a - b);
    vertexNormals_[t[2]] = vertexNormals_[t[2]] + n * angle(a - c, b - c);
  }
  edgeNormals_.resize(triangles_.size());
  const std::vector<HalfEdge> edges = sortedEdges(triangles_);
  forEdges(edges, [&](size_t begin, size_t end) {
    Vec3d sum;
    for (size_t i = begin; i < end; ++i) sum = sum + faceNormals_[edges[i].triangle];
    for (size_t i = begin; i < end; ++i) edgeNormals_[edges[i].triangle][edges[i].corner] = sum;
  });
}

void ClosedSurface::build(uint32_t node, uint32_t begin, uint32_t end) {
  Vec3d lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  for (uint32_t i = begin; i < end; ++i) {
    for (const Vec3d& v : triangle(order_[i])) lower = least(lower, v), upper = most(upper, v);
  }
  nodes_[node] = {lower, upper, begin, end - begin};
  if (end - begin <= 4) return;
  const Vec3d size = upper - lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto middle = [&](uint32_t t) {
    const auto v = triangle(t);
    return part(v[0], axis) + part(v[1], axis) + part(v[2], axis);
  };
  const uint32_t half = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end, [&](uint32_t a, uint32_t b) {
    const double l = middle(a), r = middle(b);
    return l != r ? l < r : a < b;
  });
  const uint32_t children = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_.emplace_back();
  nodes_[node].first = children;
  nodes_[node].count = 0;
  build(children, begin, half);
  build(children + 1, half, end);
}

bool ClosedSurface::isBehind(uint32_t index, Vec3d at, Vec3d p) const {
  const auto& t = triangles_[index];
  const auto v = triangle(index);
  const Vec3d out = p - at;
  // The feature that `at` lies on: the nearest point of a corner or an edge is found exactly there or a rounding off.
  for (int i = 0; i < 3; ++i) {
    const Vec3d d = at - v[i], side = v[(i + 1) % 3] - v[i];
    if (dot(d, d) <= 1e-20 * dot(side, side)) return dot(out, vertexNormals_[t[i]]) < 0;
  }
  for (int i = 0; i < 3; ++i) {
    const Vec3d side = v[(i + 1) % 3] - v[i], off = cross(side, at - v[i]);
    const double square = dot(side, side);
    if (dot(off, off) <= 1e-20 * square * square) return dot(out, edgeNormals_[index][i]) < 0;
  }
  return dot(out, faceNormals_[index]) < 0;
}

ClosedSurface::Found ClosedSurface::search(Vec3d p, double enough) const {
  Found best;
  uint32_t stack[128];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (boxDistanceSquared(p, node.lower, node.upper) >= best.square) continue;
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const auto v = triangle(order_[i]);
      const Vec3d q = nearestInTriangle(p, v[0], v[1], v[2]), d = p - q;
      if (dot(d, d) < best.square) best = {dot(d, d), order_[i], q};
    }
    if (best.square <= enough) return best;
    if (node.count > 0) continue;
    const Node &l = nodes_[node.first], &r = nodes_[node.first + 1];
    const bool leftFirst = boxDistanceSquared(p, l.lower, l.upper) <= boxDistanceSquared(p, r.lower, r.upper);
    stack[depth++] = leftFirst ? node.first + 1 : node.first;
    stack[depth++] = leftFirst ? node.first : node.first + 1;
  }
  return best;
}

ClosedSurface::Nearest ClosedSurface::nearest(Vec3d p) const {
  const Found found = search(p, -1);
  return {std::sqrt(found.square), isBehind(found.triangle, found.at, p)};
}

bool ClosedSurface::isWithin(Vec3d p, double distance) const {
  return search(p, distance * distance).square <= distance * distance;
}

double ClosedSurface::volume() const {
  double sum = 0;
  for (size_t i = 0; i < triangles_.size(); ++i) {
    const auto v = triangle(i);
    sum += dot(cross(v[0] - lower_, v[1] - lower_), v[2] - lower_) / 6;
  }
  return sum;
}

}  // namespace avbd
