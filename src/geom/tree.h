// Dynamic tree of bounds (binary tree of fat boxes) for the broad phase and queries.
#pragma once

#include <vector>

#include "geom/aabb.h"

namespace avbd {

/// Plain relocatable data: nodes in a vector, links by index. The same calls in the same order give the same tree.
/// A new leaf goes where it adds the least surface; rotations on the way up keep the tree low.
class DynamicTree {
 public:
  int32_t insert(const Aabb& box, uint32_t userData);  ///< -> proxy
  void remove(int32_t proxy);
  void move(int32_t proxy, const Aabb& box);
  const Aabb& box(int32_t proxy) const { return nodes_[static_cast<size_t>(proxy)].box; }
  uint32_t userData(int32_t proxy) const { return nodes_[static_cast<size_t>(proxy)].userData; }
  size_t size() const { return leafCount_; }
  int height() const;

  /// Calls f(userData) for every leaf whose box overlaps, in the tree's order. f must not change the tree.
  template <class F>
  void query(const Aabb& box, F&& f) const;

  struct Node {
    Aabb box;
    int32_t parent = -1;  ///< next free node while unused
    int32_t child[2] = {-1, -1};
    int32_t height = 0;  ///< leaf 0, free -1
    uint32_t userData = 0;
  };
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Index of the topmost node, -1 while the tree is empty.
  int32_t root() const { return root_; }

 private:
  Node& at(int32_t i) { return nodes_[static_cast<size_t>(i)]; }
  const Node& at(int32_t i) const { return nodes_[static_cast<size_t>(i)]; }
  int32_t takeNode();
  void freeNode(int32_t i);
  void attach(int32_t leaf);
  void detach(int32_t leaf);
  int32_t bestSibling(const Aabb& box) const;
  void refit(int32_t i);
  void refitUpwards(int32_t i);
  void rotate(int32_t i);
  void exchange(int32_t parent, int side, int grandSide);

  std::vector<Node> nodes_;
  int32_t root_ = -1;
  int32_t free_ = -1;
  size_t leafCount_ = 0;
};

/// Nodes still to visit: on the stack while they fit, beyond that on the heap.
class VisitStack {
 public:
  bool empty() const { return top_ == 0; }
  void push(int32_t i) {
    if (top_ < kInline) {
      inline_[top_++] = i;
    } else {
      more_.push_back(i);
    }
  }
  int32_t pop() {
    if (more_.empty()) return inline_[--top_];
    const int32_t i = more_.back();
    more_.pop_back();
    return i;
  }

 private:
  static constexpr int kInline = 128;
  int32_t inline_[kInline];
  int top_ = 0;
  std::vector<int32_t> more_;
};

template <class F>
void DynamicTree::query(const Aabb& box, F&& f) const {
  if (root_ < 0 || !overlaps(at(root_).box, box)) return;
  VisitStack stack;
  stack.push(root_);
  while (!stack.empty()) {
    const Node& node = at(stack.pop());
    if (node.height == 0) {
      f(node.userData);
      continue;
    }
    for (int side = 1; side >= 0; --side) {
      if (overlaps(at(node.child[side]).box, box)) stack.push(node.child[side]);
    }
  }
}

}  // namespace avbd
