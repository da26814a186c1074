// Builder of the static tree: binned surface area heuristic, two cuts at a time (mesh_tree.h).
#include "geom/mesh_tree.h"

#include <cfloat>
#include <utility>

namespace avbd {
namespace {

constexpr int kBins = 12;
constexpr uint32_t kLeafSize = 4;
/// Below this depth ranges are cut in halves by number, so that no input makes the tree deeper than the stack.
constexpr int kMaxUneven = 24;

struct Bounds {
  float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, high[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};

  void add(const Bounds& b) {
    for (int i = 0; i < 3; ++i) {
      low[i] = b.low[i] < low[i] ? b.low[i] : low[i];
      high[i] = b.high[i] > high[i] ? b.high[i] : high[i];
    }
  }
  double halfArea() const {
    const double x = double{high[0]} - low[0], y = double{high[1]} - low[1], z = double{high[2]} - low[2];
    return x * y + y * z + z * x;
  }
};

struct Item {
  Bounds bounds;
  float middle[3];
  uint32_t box;
};

struct Range {
  uint32_t begin, end;
  Bounds bounds;
  uint32_t size() const { return end - begin; }
};

struct Cut {
  int axis = -1, bin = 0;
  double cost = DBL_MAX;
};

class Builder {
 public:
  Builder(std::span<const Aabb> boxes, MeshTree& tree) : tree_(tree), items_(boxes.size()) {
    for (uint32_t i = 0; i < items_.size(); ++i) {
      const Aabb& b = boxes[i];
      Item& item = items_[i];
      item.bounds = {{b.lower.x, b.lower.y, b.lower.z}, {b.upper.x, b.upper.y, b.upper.z}};
      for (int k = 0; k < 3; ++k) item.middle[k] = 0.5f * item.bounds.low[k] + 0.5f * item.bounds.high[k];
      item.box = i;
    }
    tree_.nodes.reserve(items_.size() / 5 + 1);
    build(makeRange(0, static_cast<uint32_t>(items_.size())), 0);
  }

  void order(std::vector<uint32_t>& to) const {
    to.resize(items_.size());
    for (size_t i = 0; i < to.size(); ++i) to[i] = items_[i].box;
  }

 private:
  Range makeRange(uint32_t begin, uint32_t end) const {
    Range range{begin, end, {}};
    for (uint32_t i = begin; i < end; ++i) range.bounds.add(items_[i].bounds);
    return range;
  }

  uint32_t build(const Range& whole, int depth) {
    Range parts[4] = {whole};
    int count = 1;
    while (count < 4) {
      int largest = -1;
      for (int k = 0; k < count; ++k) {
        if (parts[k].size() <= kLeafSize) continue;
        if (largest < 0 || cost(parts[k]) > cost(parts[largest])) largest = k;
      }
      if (largest < 0) break;
      const uint32_t middle = split(parts[largest], depth);
      const Range range = parts[largest];
      parts[largest] = makeRange(range.begin, middle);
      parts[count++] = makeRange(middle, range.end);
    }
    const auto at = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    encode(whole.bounds, parts, count, tree_.nodes.back());
    for (int k = 0; k < count; ++k) {
      const uint32_t n = parts[k].size();
      const uint32_t child =
          n <= kLeafSize ? MeshNode::kLeaf | (n - 1) << 29 | parts[k].begin : build(parts[k], depth + 1);
      tree_.nodes[at].child[k] = child;
    }
    return at;
  }

  static double cost(const Range& range) { return range.bounds.halfArea() * range.size(); }

  /// Reorders the range so that it falls in two at the index returned.
  uint32_t split(const Range& range, int depth) {
    Bounds middles;
    for (uint32_t i = range.begin; i < range.end; ++i) {
      for (int k = 0; k < 3; ++k) {
        const float m = items_[i].middle[k];
        middles.low[k] = m < middles.low[k] ? m : middles.low[k];
        middles.high[k] = m > middles.high[k] ? m : middles.high[k];
      }
    }
    Cut best;
    if (depth < kMaxUneven) {
      for (int axis = 0; axis < 3; ++axis) tryAxis(range, middles, axis, best);
    }
    if (best.axis < 0) return range.begin + range.size() / 2;
    const float low = middles.low[best.axis], factor = binFactor(middles, best.axis);
    uint32_t a = range.begin, b = range.end;
    while (a < b) {
      if (bin(items_[a], best.axis, low, factor) <= best.bin) {
        ++a;
      } else {
        std::swap(items_[a], items_[--b]);
      }
    }
    return a;
  }

  static float binFactor(const Bounds& middles, int axis) {
    return static_cast<float>(kBins) / (middles.high[axis] - middles.low[axis]);
  }
  static int bin(const Item& item, int axis, float low, float factor) {
    const int k = static_cast<int>((item.middle[axis] - low) * factor);
    return k < kBins ? k : kBins - 1;
  }

  void tryAxis(const Range& range, const Bounds& middles, int axis, Cut& best) const {
    const float extent = middles.high[axis] - middles.low[axis], factor = binFactor(middles, axis);
    if (!(extent > 0) || !(factor < FLT_MAX)) return;
    Bounds bounds[kBins];
    uint32_t count[kBins] = {};
    for (uint32_t i = range.begin; i < range.end; ++i) {
      const int k = bin(items_[i], axis, middles.low[axis], factor);
      bounds[k].add(items_[i].bounds);
      ++count[k];
    }
    double right[kBins];
    Bounds sum;
    uint32_t n = 0;
    for (int k = kBins - 1; k > 0; --k) {
      sum.add(bounds[k]);
      n += count[k];
      right[k - 1] = n == 0 ? DBL_MAX : sum.halfArea() * n;
    }
    sum = {};
    n = 0;
    for (int k = 0; k + 1 < kBins; ++k) {
      sum.add(bounds[k]);
      n += count[k];
      if (n == 0 || n == range.size()) continue;
      const double both = sum.halfArea() * n + right[k];
      if (both < best.cost) best = {axis, k, both};
    }
  }

  static void encode(const Bounds& whole, const Range* parts, int count, MeshNode& node) {
    for (int axis = 0; axis < 3; ++axis) {
      const float origin = whole.low[axis], top = whole.high[axis];
      float step = (top - origin) / 255;
      while (origin + 255 * step < top) step = step > 0 ? step * 1.000001f + FLT_TRUE_MIN : FLT_MIN;
      node.origin[axis] = origin;
      node.step[axis] = step;
      for (int k = 0; k < 4; ++k) {
        node.low[axis][k] = 255;
        node.high[axis][k] = 0;
        if (k >= count) continue;
        int low = steps(parts[k].bounds.low[axis], origin, step);
        while (low > 0 && origin + static_cast<float>(low) * step > parts[k].bounds.low[axis]) --low;
        int high = steps(parts[k].bounds.high[axis], origin, step);
        while (high < 255 && origin + static_cast<float>(high) * step < parts[k].bounds.high[axis]) ++high;
        node.low[axis][k] = static_cast<uint8_t>(low);
        node.high[axis][k] = static_cast<uint8_t>(high);
      }
    }
    for (uint32_t& child : node.child) child = MeshNode::kNothing;
  }
  static int steps(float x, float origin, float step) {
    if (!(step > 0)) return 0;
    const float k = (x - origin) / step;
    return k < 255 ? static_cast<int>(k) : 255;
  }

  MeshTree& tree_;
  std::vector<Item> items_;
};

}  // namespace

MeshTree buildMeshTree(std::span<const Aabb> boxes, std::vector<uint32_t>& order) {
  AVBD_ASSERT(!boxes.empty() && boxes.size() <= MeshTree::kMaxEntries);
  MeshTree tree;
  Builder(boxes, tree).order(order);
  tree.nodes.shrink_to_fit();
  return tree;
}

SweptBox::SweptBox(Vec3 start, Vec3 motion, Vec3 halfExtent) {
  const float s[3] = {start.x, start.y, start.z}, m[3] = {motion.x, motion.y, motion.z};
  const float h[3] = {halfExtent.x, halfExtent.y, halfExtent.z};
  // An axis without motion: outside is never met, inside always.
  constexpr float kStill = 1e-30f;
  for (int i = 0; i < 3; ++i) {
    from[i] = s[i];
    half[i] = h[i];
    inverse[i] = m[i] > kStill || m[i] < -kStill ? 1 / m[i] : (m[i] < 0 ? -1 / kStill : 1 / kStill);
  }
}

}  // namespace avbd
