// Dynamic tree of bounds: building and keeping it.
#include "geom/tree.h"

#include <limits>

namespace avbd {
namespace {

/// Half the surface: the chance that a query meets the box.
float area(const Aabb& a) {
  const Vec3 e = a.upper - a.lower;
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

constexpr int kMostLopsided = 8;
constexpr size_t kParts = 24;     ///< that may be refitted at once
constexpr float kMostBeside = 2;  ///< of its own surface: what a shifted leaf may add to that of its sibling

}  // namespace

int DynamicTree::height() const { return root_ < 0 ? 0 : at(root_).height; }

int32_t DynamicTree::insert(const Aabb& box, uint32_t userData) {
  const int32_t leaf = takeNode();
  at(leaf).box = box;
  at(leaf).userData = userData;
  attach(leaf);
  ++leafCount_;
  return leaf;
}

void DynamicTree::remove(int32_t proxy) {
  detach(proxy);
  freeNode(proxy);
  --leafCount_;
}

void DynamicTree::move(int32_t proxy, const Aabb& box) {
  detach(proxy);
  at(proxy).box = box;
  attach(proxy);
}

/// Whether the leaf with another box still adds little to the surface of what is beside it. What rotations mend of a
/// crowd that mixes is not enough.
bool DynamicTree::fitsBeside(int32_t leaf, const Aabb& box) const {
  const int32_t joint = at(leaf).parent;
  if (joint < 0) return true;
  const Aabb& beside = at(siblingOf(leaf)).box;
  return area(merge(beside, box)) - area(beside) <= kMostBeside * area(box);
}

void DynamicTree::shift(std::span<const Shift> leaves, Jobs& jobs) {
  for (const auto& [proxy, box] : leaves)
    if (fitsBeside(proxy, box))
      at(proxy).box = box;
    else
      move(proxy, box);
  for (const auto& [proxy, box] : leaves)
    for (int32_t i = at(proxy).parent; i >= 0 && !at(i).userData; i = at(i).parent) at(i).userData = 1;
  refitMarked(jobs);
}

/// A node's refit and rotation read and write nothing but what is below it, so parts of the tree that do not hold each
/// other may go at once, and what is above them after.
void DynamicTree::refitMarked(Jobs& jobs) {
  above_.clear();
  if (root_ >= 0 && isMarked(root_)) above_.push_back(root_);
  size_t parts = 0;  // from here on
  for (; parts < above_.size() && above_.size() - parts < kParts; ++parts)
    for (const int32_t child : at(above_[parts]).child)
      if (isMarked(child)) above_.push_back(child);
  jobs.forRange(static_cast<uint32_t>(above_.size() - parts), 1,
                [&](uint32_t part, uint32_t, int) { refitBelow(above_[parts + part]); });
  while (parts-- > 0) {
    at(above_[parts]).userData = 0;
    refit(above_[parts]);
    rotate(above_[parts]);
  }
}

/// The marked node and those below it.
void DynamicTree::refitBelow(int32_t i) {
  at(i).userData = 0;
  for (int side = 0; side < 2; ++side)
    if (isMarked(at(i).child[side])) refitBelow(at(i).child[side]);
  refit(i);
  rotate(i);
}

int32_t DynamicTree::takeNode() {
  if (free_ < 0) {
    nodes_.emplace_back();
    return static_cast<int32_t>(nodes_.size()) - 1;
  }
  const int32_t i = free_;
  free_ = at(i).parent;
  at(i) = Node{};
  return i;
}

void DynamicTree::freeNode(int32_t i) {
  at(i) = Node{};
  at(i).parent = free_;
  at(i).height = -1;
  free_ = i;
}

/// Greedy descent to the node beside which a new leaf adds the least area to the tree. Equal costs go down and to
/// the lower side, so that equal boxes make a balanced tree.
int32_t DynamicTree::bestSibling(const Aabb& box) const {
  const float leafArea = area(box);
  int32_t i = root_, best = root_;
  float direct = area(merge(at(i).box, box)), bestCost = direct, inherited = 0;
  while (at(i).height > 0) {
    const Node& node = at(i);
    inherited += direct - area(node.box);  // what every ancestor of a place below here grows by
    float directOf[2], least[2];
    for (int side = 0; side < 2; ++side) {
      const Node& child = at(node.child[side]);
      directOf[side] = area(merge(child.box, box));
      const float cost = inherited + directOf[side];
      if (cost <= bestCost) {
        bestCost = cost;
        best = node.child[side];
      }
      least[side] = child.height == 0 ? cost : inherited + (directOf[side] - area(child.box)) + leafArea;
    }
    int side = least[1] < least[0] ? 1 : 0;
    if (least[0] == least[1]) side = at(node.child[1]).height < at(node.child[0]).height ? 1 : 0;
    if (!(least[side] <= bestCost)) break;
    direct = directOf[side];
    i = node.child[side];
  }
  return best;
}

void DynamicTree::attach(int32_t leaf) {
  if (root_ < 0) {
    root_ = leaf;
    at(leaf).parent = -1;
    return;
  }
  const int32_t sibling = bestSibling(at(leaf).box), above = at(sibling).parent, joint = takeNode();
  at(joint).parent = above;
  at(joint).child[0] = sibling;
  at(joint).child[1] = leaf;
  at(sibling).parent = joint;
  at(leaf).parent = joint;
  if (above < 0) {
    root_ = joint;
  } else {
    at(above).child[at(above).child[0] == sibling ? 0 : 1] = joint;
  }
  refitUpwards(joint);
}

void DynamicTree::detach(int32_t leaf) {
  const int32_t joint = at(leaf).parent;
  if (joint < 0) {
    root_ = -1;
    return;
  }
  const int32_t sibling = siblingOf(leaf), above = at(joint).parent;
  at(leaf).parent = -1;
  at(sibling).parent = above;
  freeNode(joint);
  if (above < 0) {
    root_ = sibling;
    return;
  }
  at(above).child[at(above).child[0] == joint ? 0 : 1] = sibling;
  refitUpwards(above);
}

void DynamicTree::refit(int32_t i) {
  Node& node = at(i);
  const Node &a = at(node.child[0]), &b = at(node.child[1]);
  node.box = merge(a.box, b.box);
  node.height = 1 + (a.height > b.height ? a.height : b.height);
}

void DynamicTree::refitUpwards(int32_t i) {
  for (; i >= 0; i = at(i).parent) {
    refit(i);
    rotate(i);
  }
}

/// Exchanges a child of node i with a grandchild on the other side where that shrinks the child between them; where it
/// shrinks nothing, but lowers a lopsided tree, too. A very lopsided one (boxes inside each other) is lowered at any
/// price, so that no order of insertion makes the tree a list.
void DynamicTree::rotate(int32_t i) {
  const Node node = at(i);
  if (node.height < 2) return;
  const int tilt = at(node.child[0]).height - at(node.child[1]).height;
  const bool mustLower = tilt > kMostLopsided || tilt < -kMostLopsided;
  float bestGain = mustLower ? -std::numeric_limits<float>::infinity() : 0;
  int bestSide = -1, bestGrand = -1;
  for (int side = 0; side < 2; ++side) {
    const Node& stay = at(node.child[side]);      // goes down, beside one grandchild
    const Node& open = at(node.child[1 - side]);  // gives up the other one
    if (open.height == 0) continue;
    const float before = area(open.box);
    for (int grand = 0; grand < 2; ++grand) {
      const Node &up = at(open.child[grand]), &down = at(open.child[1 - grand]);
      const float gain = before - area(merge(stay.box, down.box));
      const bool lowers = up.height > stay.height && up.height > down.height && stay.height + 1 < open.height;
      const bool better = gain > bestGain || (gain == bestGain && bestSide < 0 && lowers);
      if (better && (lowers || !mustLower)) {
        bestGain = gain;
        bestSide = side;
        bestGrand = grand;
      }
    }
  }
  if (bestSide >= 0) exchange(i, bestSide, bestGrand);
}

void DynamicTree::exchange(int32_t parent, int side, int grandSide) {
  const int32_t goesDown = at(parent).child[side], open = at(parent).child[1 - side];
  const int32_t goesUp = at(open).child[grandSide];
  at(parent).child[side] = goesUp;
  at(goesUp).parent = parent;
  at(open).child[grandSide] = goesDown;
  at(goesDown).parent = open;
  refit(open);
  refit(parent);
}

}  // namespace avbd
