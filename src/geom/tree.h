// Dynamic tree of bounds (balanced binary tree of fat boxes) for the broad phase and queries.
#pragma once

#include "geom/aabb.h"

#include <vector>

namespace avbd {

/// Plain relocatable data: nodes in a vector, links by index. The same calls in the same order give the same tree.
class DynamicTree {
 public:
  int32_t insert(const Aabb& box, uint32_t userData);  ///< -> proxy
  void remove(int32_t proxy);
  void move(int32_t proxy, const Aabb& box);
  const Aabb& box(int32_t proxy) const { return nodes_[static_cast<size_t>(proxy)].box; }
  uint32_t userData(int32_t proxy) const { return nodes_[static_cast<size_t>(proxy)].userData; }
  size_t size() const { return leafCount_; }
  int height() const;

  /// Calls f(userData) for every leaf whose box overlaps, in the tree's order.
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

 private:
  std::vector<Node> nodes_;
  int32_t root_ = -1;
  int32_t free_ = -1;
  size_t leafCount_ = 0;
};

}  // namespace avbd
