// Touches on triangles -> patches: clusters of normals and materials, four points each.
#include <algorithm>

#include "collide/collide_surface_parts.h"

namespace avbd {
namespace {

/// Cosine of the angle within which normals make one patch: 6 degrees.
constexpr float kOnePatch = 0.9945f;
constexpr uint32_t kTaken = 0xffffffffu;

struct Candidate {
  Vec3 position;
  float separation;
  uint32_t feature, triangle;
};

float squareOf(Vec3 a) { return dot(a, a); }

/// Index of the candidate for which `value` is largest; of equals the first.
template <class F>
int largest(const std::vector<Candidate>& all, F&& value) {
  int best = -1;
  float most = 0;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const float x = value(all[static_cast<size_t>(i)]);
    if (best >= 0 && !(x > most)) continue;
    best = i;
    most = x;
  }
  return best;
}

/// The deepest (of several equal ones the outermost), the farthest from it, and on both sides of the line between them
/// those that span most.
void reduce(const ConvexView& convex, Vec3 normal, std::vector<Candidate>& all) {
  if (all.size() <= 2) return;
  float least = all[0].separation;
  Vec3 mean;
  for (const Candidate& c : all) {
    least = smaller(least, c.separation);
    mean = mean + c.position;
  }
  mean = mean * (1 / static_cast<float>(all.size()));
  const float depth = least + 10 * convex.touch;
  const auto at = [&](int i) { return all[static_cast<size_t>(i)]; };
  const Candidate a =
      at(largest(all, [&](const Candidate& c) { return c.separation <= depth ? squareOf(c.position - mean) : -1; }));
  const Candidate b = at(largest(all, [&](const Candidate& c) { return squareOf(c.position - a.position); }));
  const auto area = [&](const Candidate& c) {
    return dot(normal, cross(b.position - a.position, c.position - a.position));
  };
  const Candidate left = at(largest(all, area));
  const Candidate right = at(largest(all, [&](const Candidate& c) { return -area(c); }));
  const float thin = convex.touch * length(b.position - a.position);
  const bool hasLeft = area(left) > thin, hasRight = area(right) < -thin;
  all.clear();
  all.push_back(a);
  all.push_back(b);
  if (hasLeft) all.push_back(left);
  if (hasRight) all.push_back(right);
}

/// Adds a touch unless a point is already there; of two stays the shape's own corner, else the deeper.
void addCandidate(const ConvexView& convex, const Touch& touch, Vec3 normal, std::vector<Candidate>& all) {
  const Vec3 gap = touch.onConvex - touch.onSurface;
  const float separation = touch.normal == normal ? touch.separation : dot(normal, gap);
  const Candidate c{(touch.onConvex + touch.onSurface) * 0.5f, separation, touch.feature, touch.triangle};
  const float near = 4 * convex.touch * convex.touch;
  for (Candidate& other : all) {
    if (squareOf(other.position - c.position) > near) continue;
    const bool isCorner = (c.feature & kCorner) != 0, wasCorner = (other.feature & kCorner) != 0;
    if (isCorner != wasCorner ? isCorner : c.separation < other.separation) other = c;
    return;
  }
  all.push_back(c);
}

bool comesBefore(Vec3 a, Vec3 b) { return a.x != b.x ? a.x < b.x : (a.y != b.y ? a.y < b.y : a.z < b.z); }

/// A corner that touches in several patches has one name for each: by the order of their normals, which does not change
/// as the depths do.
void makeUnique(std::vector<SurfacePatch>& patches) {
  const auto rank = [&](const SurfacePatch& own, uint32_t feature) {
    uint32_t before = 0;
    for (const SurfacePatch& p : patches) {
      if (&p == &own || !comesBefore(p.manifold.normal, own.manifold.normal)) continue;
      for (int k = 0; k < p.manifold.count; ++k) before += p.manifold.points[k].feature == feature ? 1 : 0;
    }
    return before;
  };
  thread_local std::vector<uint32_t> ranks;
  ranks.clear();
  for (const SurfacePatch& p : patches) {
    for (int k = 0; k < p.manifold.count; ++k) ranks.push_back(rank(p, p.manifold.points[k].feature));
  }
  size_t i = 0;
  for (SurfacePatch& p : patches) {
    for (int k = 0; k < p.manifold.count; ++k, ++i) {
      if (ranks[i] > 0) p.manifold.points[k].feature = mixed(p.manifold.points[k].feature, ranks[i]);
    }
  }
}

void finish(std::vector<Candidate>& points, const std::vector<NearTriangle>& triangles, SurfacePatch& patch) {
  size_t deepest = 0;
  patch.manifold.count = 0;
  for (size_t k = 0; k < points.size(); ++k) {
    if (points[k].separation < points[deepest].separation) deepest = k;
    ManifoldPoint& p = patch.manifold.points[patch.manifold.count++];
    p = {points[k].position, points[k].separation, points[k].feature};
    for (int other = 0; other + 1 < patch.manifold.count; ++other) {
      if (patch.manifold.points[other].feature == p.feature)
        p.feature = mixed(p.feature, 0x10000u + static_cast<uint32_t>(k));
    }
  }
  patch.element = triangles[points[deepest].triangle].element;
}

}  // namespace

void makePatches(const ConvexView& convex, const std::vector<NearTriangle>& triangles, std::vector<Touch>& touches,
                 std::vector<SurfacePatch>& out) {
  thread_local std::vector<uint32_t> order;
  thread_local std::vector<Candidate> points;
  order.resize(touches.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return touches[a].separation != touches[b].separation ? touches[a].separation < touches[b].separation : a < b;
  });
  for (size_t first = 0; first < order.size(); ++first) {
    if (order[first] == kTaken) continue;
    const Vec3 normal = touches[order[first]].normal;
    const uint16_t material = triangles[touches[order[first]].triangle].material;
    points.clear();
    for (size_t k = first; k < order.size(); ++k) {
      if (order[k] == kTaken) continue;
      const Touch& touch = touches[order[k]];
      if (triangles[touch.triangle].material != material || dot(touch.normal, normal) < kOnePatch) continue;
      addCandidate(convex, touch, normal, points);
      order[k] = kTaken;
    }
    reduce(convex, normal, points);
    SurfacePatch& patch = out.emplace_back();
    patch.manifold.normal = -normal;
    patch.material = material;
    finish(points, triangles, patch);
  }
  if (out.size() > 1) makeUnique(out);
}

}  // namespace avbd
