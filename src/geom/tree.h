// Dynamic tree of bounds (binary tree of fat boxes) for the broad phase and queries.
#pragma once

#include <span>
#include <vector>

#include "base/jobs.h"
#include "geom/aabb.h"

namespace avbd {

/// A box that moves `length` along a unit direction; half extents zero: a ray. In double, as ways are long and far from
/// the world's origin.
struct BoxWay {
  Vec3d from;  ///< its middle at the start
  Vec3d direction;
  double length = 0;
  Vec3d half;
};

/// Where on its way the moving box meets another: begin > end where it does not.
struct WaySpan {
  double begin = 0, end = 0;
};

/// What of a BoxWay every box needs.
class WayAxes {
 public:
  explicit WayAxes(const BoxWay& way);
  WaySpan meet(const Aabb& box, double length) const;

 private:
  double from_[3], half_[3], inverse_[3];
};

/// Plain relocatable data: nodes in a vector, links by index. The same calls in the same order give the same tree.
/// A new leaf goes where it adds the least surface; rotations on the way up keep the tree low.
class DynamicTree {
 public:
  int32_t insert(const Aabb& box, uint32_t userData);  ///< -> proxy
  void remove(int32_t proxy);
  /// Inserts it anew.
  void move(int32_t proxy, const Aabb& box);
  /// Gives many leaves new boxes. Those that leave what is beside them are inserted anew; the others stay where they
  /// are, and what is above them is refitted and rotated, each node once.
  struct Shift {
    int32_t proxy;
    Aabb box;
  };
  void shift(std::span<const Shift> leaves, Jobs& jobs);
  const Aabb& box(int32_t proxy) const { return nodes_[static_cast<size_t>(proxy)].box; }
  uint32_t userData(int32_t proxy) const { return nodes_[static_cast<size_t>(proxy)].userData; }
  size_t size() const { return leafCount_; }
  int height() const;

  /// Calls f(userData) for every leaf whose box overlaps, in the tree's order. f must not change the tree.
  template <class F>
  void query(const Aabb& box, F&& f) const;
  /// Calls f(userData, length) for the leaves that a moving box meets on the first `length` of its way, nearer parts of
  /// the tree first. f returns how much of the way is left to search: the length given to go on as before, less to cut
  /// it short, a negative number to stop.
  template <class F>
  void along(const BoxWay& way, F&& f) const;
  /// Calls f(userData, reach) for the leaves whose boxes lie within `reach` of this one, nearer parts of the tree
  /// first. f returns the reach that is left to search, negative to stop.
  template <class F>
  void around(const Aabb& box, float reach, F&& f) const;

  struct Node {
    Aabb box;
    int32_t parent = -1;  ///< next free node while unused
    int32_t child[2] = {-1, -1};
    int32_t height = 0;     ///< leaf 0, free -1
    uint32_t userData = 0;  ///< of inner nodes: to be refitted
  };
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Index of the topmost node, -1 while the tree is empty.
  int32_t root() const { return root_; }
  /// Index of the first unused node, -1 if there is none.
  int32_t firstFree() const { return free_; }

  /// What a tree is made of again: of leaves box and userData, of inner nodes the children, of free nodes the next;
  /// heights say which is which: 0, 1, -1.
  struct Saved {
    std::vector<Node> nodes;
    int32_t root = -1, free = -1;
  };
  /// Becomes a tree of these nodes. False where they make none: it must then not be used.
  bool restore(Saved&& saved);
  /// Their memory, to be used again; the tree is empty then.
  std::vector<Node> takeNodes() {
    root_ = free_ = -1, leafCount_ = 0;
    return std::move(nodes_);
  }

 private:
  static constexpr int32_t kUnlinked = -2;
  bool linkFree();
  bool linkUsed();
  Node& at(int32_t i) { return nodes_[static_cast<size_t>(i)]; }
  const Node& at(int32_t i) const { return nodes_[static_cast<size_t>(i)]; }
  int32_t takeNode();
  void freeNode(int32_t i);
  void attach(int32_t leaf);
  void detach(int32_t leaf);
  int32_t bestSibling(const Aabb& box) const;
  /// The other child of its parent, which it has.
  int32_t siblingOf(int32_t i) const {
    const Node& above = at(at(i).parent);
    return above.child[above.child[0] == i ? 1 : 0];
  }
  void refit(int32_t i);
  void refitUpwards(int32_t i);
  bool fitsBeside(int32_t leaf, const Aabb& box) const;
  bool isMarked(int32_t i) const { return at(i).height > 0 && at(i).userData != 0; }
  void refitMarked(Jobs& jobs);
  void refitBelow(int32_t i);
  void rotate(int32_t i);
  void exchange(int32_t parent, int side, int grandSide);

  std::vector<Node> nodes_;
  int32_t root_ = -1;
  int32_t free_ = -1;
  size_t leafCount_ = 0;
  std::vector<int32_t> above_;  ///< spare memory of shift()
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

/// Nodes still to visit, each with the least that anything in it can be away.
class RankedStack {
 public:
  struct Entry {
    double rank;
    int32_t node;
  };
  bool empty() const { return top_ == 0; }
  void push(int32_t node, double rank) {
    if (top_ < kInline) {
      inline_[top_++] = {rank, node};
    } else {
      more_.push_back({rank, node});
    }
  }
  Entry pop() {
    if (more_.empty()) return inline_[--top_];
    const Entry entry = more_.back();
    more_.pop_back();
    return entry;
  }

 private:
  static constexpr int kInline = 128;
  Entry inline_[kInline];
  int top_ = 0;
  std::vector<Entry> more_;
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

inline WayAxes::WayAxes(const BoxWay& way) {
  const double from[3] = {way.from.x, way.from.y, way.from.z}, half[3] = {way.half.x, way.half.y, way.half.z};
  const double d[3] = {way.direction.x, way.direction.y, way.direction.z};
  for (int i = 0; i < 3; ++i) {
    from_[i] = from[i];
    half_[i] = half[i];
    // Not infinite, so that a box that begins where the ray is gives 0, not NaN.
    constexpr double kMost = 1e290;
    const double size = d[i] < 0 ? -d[i] : d[i];
    inverse_[i] = size * kMost > 1 ? 1 / d[i] : kMost;
  }
}

inline WaySpan WayAxes::meet(const Aabb& box, double length) const {
  const float lower[3] = {box.lower.x, box.lower.y, box.lower.z}, upper[3] = {box.upper.x, box.upper.y, box.upper.z};
  WaySpan span{0, length};
  for (int i = 0; i < 3; ++i) {
    const double a = (static_cast<double>(lower[i]) - half_[i] - from_[i]) * inverse_[i];
    const double b = (static_cast<double>(upper[i]) + half_[i] - from_[i]) * inverse_[i];
    // A little wider than rounding can be wrong.
    const double in = (a < b ? a : b), out = (a < b ? b : a) * (1 + 1e-15);
    span.begin = in > span.begin ? in : span.begin;
    span.end = out < span.end ? out : span.end;
  }
  return span;
}

/// Squared gap between two boxes; 0 where they overlap.
inline float squaredGap(const Aabb& a, const Aabb& b) {
  const auto gap = [](float lowA, float highA, float lowB, float highB) {
    const float after = lowB - highA, before = lowA - highB, most = after > before ? after : before;
    return most > 0 ? most : 0.0f;
  };
  const Vec3 g{gap(a.lower.x, a.upper.x, b.lower.x, b.upper.x), gap(a.lower.y, a.upper.y, b.lower.y, b.upper.y),
               gap(a.lower.z, a.upper.z, b.lower.z, b.upper.z)};
  return dot(g, g);
}

template <class F>
void DynamicTree::along(const BoxWay& way, F&& f) const {
  if (root_ < 0) return;
  const WayAxes axes(way);
  double left = way.length;
  const WaySpan whole = axes.meet(at(root_).box, left);
  if (whole.begin > whole.end) return;
  RankedStack stack;
  stack.push(root_, whole.begin);
  while (!stack.empty()) {
    const RankedStack::Entry next = stack.pop();
    if (next.rank > left) continue;
    const Node& node = at(next.node);
    if (node.height == 0) {
      left = f(node.userData, left);
      if (left < 0) return;
      continue;
    }
    WaySpan span[2];
    for (int side = 0; side < 2; ++side) span[side] = axes.meet(at(node.child[side]).box, left);
    const int far = span[1].begin < span[0].begin ? 0 : 1;
    for (const int side : {far, 1 - far})
      if (span[side].begin <= span[side].end) stack.push(node.child[side], span[side].begin);
  }
}

template <class F>
void DynamicTree::around(const Aabb& box, float reach, F&& f) const {
  if (root_ < 0) return;
  // A little wider than rounding can be wrong.
  const auto within = [](float r) { return double(r) * double(r) * (1 + 1e-6); };
  double left = within(reach);
  RankedStack stack;
  stack.push(root_, static_cast<double>(squaredGap(at(root_).box, box)));
  while (!stack.empty()) {
    const RankedStack::Entry next = stack.pop();
    if (next.rank > left) continue;
    const Node& node = at(next.node);
    if (node.height == 0) {
      reach = f(node.userData, reach);
      if (reach < 0) return;
      left = within(reach);
      continue;
    }
    double gap[2];
    for (int side = 0; side < 2; ++side) gap[side] = static_cast<double>(squaredGap(at(node.child[side]).box, box));
    const int far = gap[1] < gap[0] ? 0 : 1;
    for (const int side : {far, 1 - far})
      if (gap[side] <= left) stack.push(node.child[side], gap[side]);
  }
}

}  // namespace avbd
