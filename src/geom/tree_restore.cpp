// A dynamic tree from what a snapshot says of it: its shape is checked, boxes and heights follow from the leaves.
#include "geom/tree.h"

namespace avbd {

bool DynamicTree::restore(Saved&& saved) {
  nodes_ = std::move(saved.nodes);
  root_ = saved.root;
  free_ = saved.free;
  leafCount_ = 0;
  return linkFree() && (nodes_.empty() ? root_ == -1 : linkUsed());
}

/// Walks the free list, which ends and holds nothing twice; marks its nodes.
bool DynamicTree::linkFree() {
  const auto size = static_cast<int32_t>(nodes_.size());
  int32_t left = size;
  for (int32_t i = free_; i != -1; i = at(i).parent) {
    if (i < 0 || i >= size || at(i).height != -1 || left-- == 0) return false;
  }
  // A node that is free and not in the list would be lost, and one that is not free is used.
  for (const Node& node : nodes_) left -= node.height != -1;
  return left == 0;
}

/// From the root down, then up again: every node that is not free has one parent.
bool DynamicTree::linkUsed() {
  const auto size = static_cast<int32_t>(nodes_.size());
  int32_t used = 0;
  for (Node& node : nodes_) {
    used += node.height >= 0;
    if (node.height >= 0) node.parent = kUnlinked;
  }
  if (used == 0) return root_ == -1;
  if (root_ < 0 || root_ >= size || at(root_).height < 0) return false;
  at(root_).parent = -1;
  int32_t linked = 1;
  int32_t i = root_;
  // Down the first children; a leaf goes up to the first node whose second child was not visited.
  for (;;) {
    while (at(i).height > 0) {
      for (const int32_t child : at(i).child) {
        if (child < 0 || child >= size || at(child).height < 0 || at(child).parent != kUnlinked) return false;
        at(child).parent = i;
        ++linked;
      }
      i = at(i).child[0];
    }
    ++leafCount_;
    while (at(i).parent >= 0 && at(at(i).parent).child[1] == i) {
      i = at(i).parent;
      refit(i);
    }
    if (at(i).parent < 0) break;
    i = at(at(i).parent).child[1];
  }
  return linked == used;
}

}  // namespace avbd
