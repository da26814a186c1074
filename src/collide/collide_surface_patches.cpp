// Touches on triangles -> patches: clusters of normals and materials, four points each.
#include <algorithm>

#include "collide/collide_surface_parts.h"

namespace avbd {
namespace {

/// Cosine of the angle within which normals make one patch: 6 degrees.
constexpr float kOnePatch = 0.9945f;
constexpr uint32_t kTaken = 0xffffffffu;

struct PatchPoint {
  Vec3 position;
  float separation;
  uint32_t feature, triangle;
};

float squareOf(Vec3 a) { return dot(a, a); }

/// Index of the candidate for which `value` is largest; of equals the first.
template <class F>
int largest(const std::vector<PatchPoint>& all, F&& value) {
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
void reduce(const ConvexView& convex, Vec3 normal, std::vector<PatchPoint>& all) {
  if (all.size() <= 2) return;
  float least = all[0].separation;
  Vec3 mean;
  for (const PatchPoint& c : all) {
    least = smaller(least, c.separation);
    mean = mean + c.position;
  }
  mean = mean * (1 / static_cast<float>(all.size()));
  const float depth = least + 10 * convex.touch;
  const auto at = [&](int i) { return all[static_cast<size_t>(i)]; };
  const PatchPoint a =
      at(largest(all, [&](const PatchPoint& c) { return c.separation <= depth ? squareOf(c.position - mean) : -1; }));
  const PatchPoint b = at(largest(all, [&](const PatchPoint& c) { return squareOf(c.position - a.position); }));
  const auto area = [&](const PatchPoint& c) {
    return dot(normal, cross(b.position - a.position, c.position - a.position));
  };
  const PatchPoint left = at(largest(all, area));
  const PatchPoint right = at(largest(all, [&](const PatchPoint& c) { return -area(c); }));
  const float thin = convex.touch * length(b.position - a.position);
  const bool hasLeft = area(left) > thin, hasRight = area(right) < -thin;
  all.clear();
  all.push_back(a);
  all.push_back(b);
  if (hasLeft) all.push_back(left);
  if (hasRight) all.push_back(right);
}

/// The points of a patch in the making. Many are found by the cells of a grid, so that gathering stays linear.
class PatchPoints {
 public:
  std::vector<PatchPoint> all;

  void begin(const ConvexView& convex) {
    all.clear();
    near_ = 2 * convex.touch;
    isGrid_ = false;
  }

  /// Adds a touch unless a point is already there; of two stays the shape's own corner, else the deeper.
  void add(const Touch& touch, Vec3 normal) {
    const Vec3 gap = touch.onConvex - touch.onSurface;
    const float separation = touch.normal == normal ? touch.separation : dot(normal, gap);
    const PatchPoint c{(touch.onConvex + touch.onSurface) * 0.5f, separation, touch.feature, touch.triangle};
    const uint32_t had = isGrid_ ? findInGrid(c.position) : findInAll(c.position);
    if (had == kNone) {
      all.push_back(c);
      if (isGrid_) {
        next_.push_back(kNone);
        link(static_cast<uint32_t>(all.size() - 1));
      } else if (all.size() > kFew) {
        makeGrid();
      }
      return;
    }
    PatchPoint& other = all[had];
    const bool isCorner = (c.feature & kCorner) != 0, wasCorner = (other.feature & kCorner) != 0;
    if (!(isCorner != wasCorner ? isCorner : c.separation < other.separation)) return;
    if (isGrid_) unlink(had);
    other = c;
    if (isGrid_) link(had);
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffu;
  static constexpr size_t kFew = 32;  // up to so many are asked one by one
  static constexpr uint32_t kSlots = 4096;

  struct Cell {
    int32_t x, y, z;
  };
  /// Places near each other lie in one cell or in two that touch.
  Cell cellOf(Vec3 p) const {
    const auto place = [&](float v) { return static_cast<int32_t>(clampTo(std::floor(v / (2 * near_)), -1e9f, 1e9f)); };
    return {place(p.x), place(p.y), place(p.z)};
  }
  static uint32_t slot(Cell c) {
    return mixed(mixed(static_cast<uint32_t>(c.x), static_cast<uint32_t>(c.y)), static_cast<uint32_t>(c.z)) &
           (kSlots - 1);
  }
  bool isHere(uint32_t index, Vec3 p) const { return !(squareOf(all[index].position - p) > near_ * near_); }

  uint32_t findInAll(Vec3 p) const {
    for (uint32_t i = 0; i < all.size(); ++i) {
      if (isHere(i, p)) return i;
    }
    return kNone;
  }
  /// The same: the first of those that are near.
  uint32_t findInGrid(Vec3 p) const {
    // With cells twice as wide as near, a place's neighbours are in the cells of the corners of a box about it.
    const float reach = 1.001f * near_;  // more than distances round
    const Cell low = cellOf(p - Vec3{reach, reach, reach}), high = cellOf(p + Vec3{reach, reach, reach});
    uint32_t first = kNone;
    for (int32_t x = low.x; x <= high.x; ++x) {
      for (int32_t y = low.y; y <= high.y; ++y) {
        for (int32_t z = low.z; z <= high.z; ++z) {
          for (uint32_t i = heads_[slot({x, y, z})]; i != kNone; i = next_[i]) {
            if (i < first && isHere(i, p)) first = i;
          }
        }
      }
    }
    return first;
  }
  void makeGrid() {
    isGrid_ = true;
    heads_.assign(kSlots, kNone);
    next_.assign(all.size(), kNone);
    for (uint32_t i = 0; i < all.size(); ++i) link(i);
  }
  void link(uint32_t index) {
    uint32_t& head = heads_[slot(cellOf(all[index].position))];
    next_[index] = head;
    head = index;
  }
  void unlink(uint32_t index) {
    uint32_t* at = &heads_[slot(cellOf(all[index].position))];
    while (*at != index) at = &next_[*at];
    *at = next_[index];
  }

  float near_ = 0;
  bool isGrid_ = false;
  std::vector<uint32_t> heads_, next_;
};

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

void finish(std::vector<PatchPoint>& points, const std::vector<NearTriangle>& triangles, SurfacePatch& patch) {
  patch.manifold.count = 0;
  for (size_t k = 0; k < points.size(); ++k) {
    ManifoldPoint& p = patch.manifold.points[patch.manifold.count++];
    p = {points[k].position, points[k].separation, points[k].feature};
    for (int other = 0; other + 1 < patch.manifold.count; ++other) {
      if (patch.manifold.points[other].feature == p.feature)
        p.feature = mixed(p.feature, 0x10000u + static_cast<uint32_t>(k));
    }
  }
  patch.element = triangles[points[0].triangle].element;
}

}  // namespace

void makePatches(const ConvexView& convex, const std::vector<NearTriangle>& triangles, std::vector<Touch>& touches,
                 std::vector<SurfacePatch>& out) {
  thread_local std::vector<uint32_t> order;
  thread_local PatchPoints points;
  order.resize(touches.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return touches[a].separation != touches[b].separation ? touches[a].separation < touches[b].separation : a < b;
  });
  for (size_t first = 0; first < order.size(); ++first) {
    if (order[first] == kTaken) continue;
    const Vec3 normal = touches[order[first]].normal;
    const uint16_t material = triangles[touches[order[first]].triangle].material;
    points.begin(convex);
    for (size_t k = first; k < order.size(); ++k) {
      if (order[k] == kTaken) continue;
      const Touch& touch = touches[order[k]];
      if (triangles[touch.triangle].material != material || dot(touch.normal, normal) < kOnePatch) continue;
      points.add(touch, normal);
      order[k] = kTaken;
    }
    reduce(convex, normal, points.all);
    SurfacePatch& patch = out.emplace_back();
    patch.manifold.normal = -normal;
    patch.material = material;
    finish(points.all, triangles, patch);
  }
  if (out.size() > 1) makeUnique(out);
}

}  // namespace avbd
