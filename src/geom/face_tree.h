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
  /// Bounds of all nodes, children behind their parents; at(point) tells where a point is.
  template <class At>
  void refit(std::span<const Face> faces, At&& at, std::vector<Aabb>& bounds) const;
  /// Calls f(face) for the faces whose bounds overlap the box.
  template <class F>
  void query(const std::vector<Aabb>& bounds, const Aabb& box, F&& f) const;

 private:
  static constexpr uint32_t kLeaf = 4;  ///< most faces in a leaf
  struct Node {
    uint32_t begin = 0, count = 0;  ///< of a leaf in order_
    uint32_t right = 0;             ///< the left child is the next node
  };
  void build(uint32_t begin, uint32_t end, std::vector<Vec3>& centres);

  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;
};

template <class At>
void FaceTree::refit(std::span<const Face> faces, At&& at, std::vector<Aabb>& bounds) const {
  bounds.resize(nodes_.size());
  const auto add = [](Aabb& box, Vec3 p) {
    box.lower = {p.x < box.lower.x ? p.x : box.lower.x, p.y < box.lower.y ? p.y : box.lower.y,
                 p.z < box.lower.z ? p.z : box.lower.z};
    box.upper = {p.x > box.upper.x ? p.x : box.upper.x, p.y > box.upper.y ? p.y : box.upper.y,
                 p.z > box.upper.z ? p.z : box.upper.z};
  };
  for (size_t i = nodes_.size(); i-- > 0;) {
    const Node& node = nodes_[i];
    if (node.count == 0) {
      bounds[i] = bounds[i + 1];
      add(bounds[i], bounds[node.right].lower), add(bounds[i], bounds[node.right].upper);
      continue;
    }
    const Vec3 first = at(faces[order_[node.begin]][0]);
    bounds[i] = {first, first};
    for (uint32_t k = node.begin; k < node.begin + node.count; ++k)
      for (const uint32_t point : faces[order_[k]]) add(bounds[i], at(point));
  }
}

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

}  // namespace avbd
