// A tree over the faces of a surface that bends: made once, its bounds refitted to where the points are.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/aabb.h"

namespace avbd {

class FaceTree {
 public:
  using Face = std::array<uint32_t, 3>;

  /// Halves at the middle of the longest side of the faces' centres, by their places at rest.
  FaceTree(std::span<const Vec3> points, std::span<const Face> faces);

  size_t nodeCount() const { return nodes_.size(); }
  /// Bounds of all nodes from those of the faces.
  void refit(std::span<const Aabb> faces, std::vector<Aabb>& bounds) const;
  /// A value for each node: of(face), and merge(value, value) of those below it.
  template <class T, class Of, class Merge>
  void refit(std::vector<T>& nodes, Of&& of, Merge&& merge) const;
  /// Calls f(face) for the faces whose bounds overlap the box.
  template <class F>
  void query(const std::vector<Aabb>& bounds, const Aabb& box, F&& f) const;
  /// Bounds of the nodes of one surface, and what to add to them where they meet another's.
  struct Placed {
    std::span<const Aabb> faces, nodes;
    Vec3 lower, upper;
  };
  /// Calls f(face, other's face) for all faces of this tree and another whose bounds overlap.
  template <class F>
  void pairs(const Placed& at, const FaceTree& other, const Placed& otherAt, F&& f) const;
  /// The same within this tree, each two faces once; none of two nodes where skip(node, node).
  template <class Skip, class F>
  void pairs(const Placed& at, Skip&& skip, F&& f) const;
  /// Calls f(face), which returns the square of a distance from p, for the faces whose bounds are within the least
  /// that it has returned yet, or `within`. Those near p come first.
  template <class F>
  void nearest(const std::vector<Aabb>& bounds, Vec3 p, float within, F&& f) const;

 private:
  static constexpr uint32_t kLeaf = 4;  ///< most faces in a leaf
  struct Node {
    uint32_t begin = 0, count = 0;  ///< of a leaf in order_
    uint32_t right = 0;             ///< the left child is the next node
  };
  struct NodePair {
    uint32_t a, b;
  };
  static constexpr int kStack = 256;  ///< deeper than two trees of 2^32 faces
  /// Puts the pairs below one of two nodes on the stack, the children of the one that is no leaf or comes first.
  static void descend(NodePair pair, const Node& a, const Node& b, NodePair* stack, int& size) {
    if (b.count > 0 || (a.count == 0 && pair.a <= pair.b)) {
      stack[size++] = {a.right, pair.b}, stack[size++] = {pair.a + 1, pair.b};
    } else {
      stack[size++] = {pair.a, b.right}, stack[size++] = {pair.a, pair.b + 1};
    }
  }
  void build(uint32_t begin, uint32_t end, std::vector<Vec3>& centres);
  template <class F>
  void leafPairs(const Placed& at, const Node& a, const FaceTree& other, const Placed& otherAt, const Node& b,
                 F&& f) const;

  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;
};

template <class F>
void FaceTree::query(const std::vector<Aabb>& bounds, const Aabb& box, F&& f) const {
  uint32_t stack[64];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const uint32_t i = stack[--size];
    if (!overlaps(bounds[i], box)) continue;
    const Node& node = nodes_[i];
    for (uint32_t k = node.begin; k < node.begin + node.count; ++k) f(order_[k]);
    if (node.count == 0) stack[size++] = node.right, stack[size++] = i + 1;
  }
}

template <class T, class Of, class Merge>
void FaceTree::refit(std::vector<T>& nodes, Of&& of, Merge&& merge) const {
  nodes.resize(nodes_.size());
  for (size_t i = nodes_.size(); i-- > 0;) {
    const Node& node = nodes_[i];
    nodes[i] = node.count > 0 ? of(order_[node.begin]) : merge(nodes[i + 1], nodes[node.right]);
    for (uint32_t k = node.begin + 1; k < node.begin + node.count; ++k) nodes[i] = merge(nodes[i], of(order_[k]));
  }
}

inline float squaredDistance(const Aabb& box, Vec3 p) {
  const auto beyond = [](float lower, float upper, float x) {
    return x < lower ? lower - x : x > upper ? x - upper : 0;
  };
  const Vec3 off{beyond(box.lower.x, box.upper.x, p.x), beyond(box.lower.y, box.upper.y, p.y),
                 beyond(box.lower.z, box.upper.z, p.z)};
  return dot(off, off);
}

template <class F>
void FaceTree::nearest(const std::vector<Aabb>& bounds, Vec3 p, float within, F&& f) const {
  struct Entry {
    uint32_t node;
    float distance2;
  };
  Entry stack[64];
  int size = 0;
  float least2 = within * within;
  stack[size++] = {0, squaredDistance(bounds[0], p)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.distance2 > least2) continue;
    const Node& node = nodes_[entry.node];
    for (uint32_t k = node.begin; k < node.begin + node.count; ++k) least2 = std::min(least2, f(order_[k]));
    if (node.count > 0) continue;
    Entry left{entry.node + 1, squaredDistance(bounds[entry.node + 1], p)};
    Entry right{node.right, squaredDistance(bounds[node.right], p)};
    if (left.distance2 < right.distance2) std::swap(left, right);
    stack[size++] = left, stack[size++] = right;
  }
}

inline bool meet(const Aabb& a, const FaceTree::Placed& atB, const Aabb& b) {
  return overlaps(a, {b.lower + atB.lower, b.upper + atB.upper});
}

template <class F>
void FaceTree::leafPairs(const Placed& at, const Node& a, const FaceTree& other, const Placed& otherAt, const Node& b,
                         F&& f) const {
  for (uint32_t i = a.begin; i < a.begin + a.count; ++i) {
    const uint32_t face = order_[i];
    const Aabb box{at.faces[face].lower + at.lower, at.faces[face].upper + at.upper};
    for (uint32_t k = b.begin; k < b.begin + b.count; ++k)
      if (meet(box, otherAt, otherAt.faces[other.order_[k]])) f(face, other.order_[k]);
  }
}

template <class F>
void FaceTree::pairs(const Placed& at, const FaceTree& other, const Placed& otherAt, F&& f) const {
  NodePair stack[kStack];
  int size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const NodePair pair = stack[--size];
    const Aabb& box = at.nodes[pair.a];
    if (!meet({box.lower + at.lower, box.upper + at.upper}, otherAt, otherAt.nodes[pair.b])) continue;
    const Node &a = nodes_[pair.a], &b = other.nodes_[pair.b];
    if (a.count > 0 && b.count > 0)
      leafPairs(at, a, other, otherAt, b, f);
    else
      descend(pair, a, b, stack, size);
  }
}

template <class Skip, class F>
void FaceTree::pairs(const Placed& at, Skip&& skip, F&& f) const {
  NodePair stack[kStack];
  int size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const NodePair pair = stack[--size];
    const Node &a = nodes_[pair.a], &b = nodes_[pair.b];
    if (pair.a != pair.b && !overlaps(at.nodes[pair.a], at.nodes[pair.b])) continue;
    if (skip(pair.a, pair.b)) continue;
    if (a.count > 0 && b.count > 0) {
      if (pair.a != pair.b) {
        leafPairs(at, a, *this, at, b, f);
        continue;
      }
      for (uint32_t i = a.begin; i < a.begin + a.count; ++i)
        for (uint32_t k = i + 1; k < a.begin + a.count; ++k)
          if (overlaps(at.faces[order_[i]], at.faces[order_[k]])) f(order_[i], order_[k]);
    } else if (pair.a == pair.b) {
      stack[size++] = {pair.a + 1, a.right}, stack[size++] = {a.right, a.right};
      stack[size++] = {pair.a + 1, pair.a + 1};
    } else {
      descend(pair, a, b, stack, size);
    }
  }
}

}  // namespace avbd
