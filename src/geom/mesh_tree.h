// A small static tree over boxes: four children a node, bounds as bytes.
//
// A node is one cache line: an origin, what one step of a byte stands for along each axis, and the four children's
// bounds in such steps, rounded outwards so that the decoded bounds always hold the true ones. A leaf is up to four
// neighbouring entries of the caller's array, which the builder puts in order.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/assert.h"
#include "geom/aabb.h"

namespace avbd {

struct MeshNode {
  static constexpr uint32_t kLeaf = 1u << 31, kFirst = (1u << 29) - 1, kNothing = 0xffffffffu;
  float origin[3];
  float step[3];
  uint8_t low[3][4], high[3][4];
  uint32_t child[4];  ///< a node; or kLeaf, entries - 1 in bits 29 and 30, and the first entry; or kNothing
};
static_assert(sizeof(MeshNode) == 64);

struct MeshTree {
  /// More entries than leaves can name would not fit any memory.
  static constexpr size_t kMaxEntries = (size_t{1} << 29) - 8;
  static constexpr int kMaxStack = 192;  ///< entries that a walk may have to come back to
  std::vector<MeshNode> nodes;           ///< the root first
};

/// Orders the boxes so that leaves are runs: order[i] is the box that belongs at i. Binned surface area heuristic; the
/// result depends on nothing but the boxes.
MeshTree buildMeshTree(std::span<const Aabb> boxes, std::vector<uint32_t>& order);

/// Calls f(first, count) for the leaves whose bounds overlap the box, until it returns false.
template <class F>
void walkBox(const MeshTree& tree, const Aabb& box, F&& f) {
  const float lower[3] = {box.lower.x, box.lower.y, box.lower.z}, upper[3] = {box.upper.x, box.upper.y, box.upper.z};
  uint32_t stack[MeshTree::kMaxStack];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const uint32_t at = stack[--size];
    if (at & MeshNode::kLeaf) {
      if (!f(at & MeshNode::kFirst, ((at >> 29) & 3) + 1)) return;
      continue;
    }
    const MeshNode& node = tree.nodes[at];
    bool hit[4] = {true, true, true, true};
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 4; ++k) {
        const float low = node.origin[axis] + static_cast<float>(node.low[axis][k]) * node.step[axis];
        const float high = node.origin[axis] + static_cast<float>(node.high[axis][k]) * node.step[axis];
        hit[k] = hit[k] & (low <= upper[axis]) & (lower[axis] <= high);
      }
    }
    AVBD_ASSERT(size + 4 <= MeshTree::kMaxStack);
    for (int k = 3; k >= 0; --k) {
      if (hit[k] && node.child[k] != MeshNode::kNothing) stack[size++] = node.child[k];
    }
  }
}

/// A box that moves. Whatever it meets on its way is found; a little more may be.
struct SweptBox {
  float from[3], inverse[3], half[3];
  SweptBox(Vec3 start, Vec3 motion, Vec3 halfExtent);
  /// The part of the way on which it may touch a box, from `enter` on; nothing: enter > exit.
  void meet(const float* low, const float* high, float& enter, float& exit) const {
    for (int axis = 0; axis < 3; ++axis) {
      const float a = ((low[axis] - half[axis]) - from[axis]) * inverse[axis];
      const float b = ((high[axis] + half[axis]) - from[axis]) * inverse[axis];
      const float first = a < b ? a : b, last = a < b ? b : a;
      enter = first > enter ? first : enter;
      exit = last < exit ? last : exit;
    }
  }
};

/// Calls f(first, count, fraction) for the leaves that the box may meet before `fraction`, near ones first; f returns
/// the fraction that is left, negative to stop.
template <class F>
void walkAlong(const MeshTree& tree, const SweptBox& swept, F&& f) {
  struct Entry {
    uint32_t at;
    float enter;
  };
  Entry stack[MeshTree::kMaxStack];
  int size = 0;
  stack[size++] = {0, 0};
  float fraction = 1;
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.enter > fraction) continue;
    if (entry.at & MeshNode::kLeaf) {
      fraction = f(entry.at & MeshNode::kFirst, ((entry.at >> 29) & 3) + 1, fraction);
      if (fraction < 0) return;
      continue;
    }
    const MeshNode& node = tree.nodes[entry.at];
    const int base = size;
    AVBD_ASSERT(size + 4 <= MeshTree::kMaxStack);
    for (int k = 3; k >= 0; --k) {
      if (node.child[k] == MeshNode::kNothing) continue;
      float low[3], high[3];
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = node.origin[axis] + static_cast<float>(node.low[axis][k]) * node.step[axis];
        high[axis] = node.origin[axis] + static_cast<float>(node.high[axis][k]) * node.step[axis];
      }
      float enter = 0, exit = fraction;
      swept.meet(low, high, enter, exit);
      if (enter > exit) continue;
      // Farthest at the bottom.
      int i = size++;
      for (; i > base && stack[i - 1].enter < enter; --i) stack[i] = stack[i - 1];
      stack[i] = {node.child[k], enter};
    }
  }
}

}  // namespace avbd
