// Building a tree of faces (face_tree.h).
#include "geom/face_tree.h"

#include <algorithm>
#include <numeric>

namespace avbd {

namespace {

float along(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

}  // namespace

FaceTree::FaceTree(std::span<const Vec3> points, std::span<const Face> faces) : order_(faces.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vec3> centres;
  for (const Face& face : faces) centres.push_back((points[face[0]] + points[face[1]] + points[face[2]]) * (1.0f / 3));
  build(0, static_cast<uint32_t>(faces.size()), centres);
}

void FaceTree::refit(std::span<const Aabb> faces, std::vector<Aabb>& bounds) const {
  bounds.resize(nodes_.size());
  for (size_t i = nodes_.size(); i-- > 0;) {
    const Node& node = nodes_[i];
    bounds[i] = node.count > 0 ? faces[order_[node.begin]] : bounds[i + 1];
    if (node.count == 0) bounds[i] = merge(bounds[i], bounds[node.right]);
    for (uint32_t k = node.begin + 1; k < node.begin + node.count; ++k) bounds[i] = merge(bounds[i], faces[order_[k]]);
  }
}

void FaceTree::build(uint32_t begin, uint32_t end, std::vector<Vec3>& centres) {
  const auto node = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back({begin, end - begin, 0});
  if (end - begin <= kLeaf) return;
  Vec3 lower = centres[order_[begin]], upper = lower;
  for (uint32_t i = begin; i < end; ++i) {
    const Vec3 c = centres[order_[i]];
    lower = {std::min(lower.x, c.x), std::min(lower.y, c.y), std::min(lower.z, c.z)};
    upper = {std::max(upper.x, c.x), std::max(upper.y, c.y), std::max(upper.z, c.z)};
  }
  const Vec3 size = upper - lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t middle = begin + (end - begin) / 2;
  std::sort(order_.begin() + begin, order_.begin() + end, [&](uint32_t a, uint32_t b) {
    const float x = along(centres[a], axis), y = along(centres[b], axis);
    return x != y ? x < y : a < b;
  });
  nodes_[node].count = 0;
  build(begin, middle, centres);
  nodes_[node].right = static_cast<uint32_t>(nodes_.size());
  build(middle, end, centres);
}

}  // namespace avbd
