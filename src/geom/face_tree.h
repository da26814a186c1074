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
  /// The same within this tree, each two faces once.
  template <class F>
  void pairs(const Placed& at, F&& f) const;

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

template <class F>
void FaceTree::pairs(const Placed& at, F&& f) const {
  NodePair stack[kStack];
  int size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const NodePair pair = stack[--size];
    const Node &a = nodes_[pair.a], &b = nodes_[pair.b];
    if (pair.a != pair.b && !overlaps(at.nodes[pair.a], at.nodes[pair.b])) continue;
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
