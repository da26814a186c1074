// Exact trees: bodies that joints hold together in a tree are solved as one block, the joints' multipliers being
// unknowns of their own. Linear time, leaf to root and back (after Baraff 1996).
//
// For a body c with its joint to the parent p, with S = Jc Hc^-1 Jc^T:
//   leaf to root  Hp += Jp^T S^-1 Jp,   rp -= Jp^T S^-1 (Jc Hc^-1 rc - b)
//   root to leaf  mu = S^-1 (Jc Hc^-1 rc - b + Jp xp),   xc = Hc^-1 (rc - Jc^T mu)
// which solves H x + J^T mu = r, J x = b for block-diagonal H.
#pragma once

#include <span>
#include <vector>

#include "solve/batch.h"
#include "solve/scalar_joint.h"

namespace avbd {

/// What the factorisation keeps of a joint of up to kMost rows.
template <int kMost>
struct TreeRows {
  static constexpr int kRows = kMost;
  static constexpr int kColumns = (kMost + 3) / 4 * 4;
  int m = 0;
  float violation[kMost], mu[kMost], total[kMost];
  float jc[kMost][6], jp[kMost][6];  ///< rows of J
  float u[6][kColumns];              ///< Hc^-1 Jc^T; columns beyond m are 0 (a register at a time)
  float sFactor[kMost][kMost];       ///< LDL^T of S, inverse pivots on the diagonal
  float w[kMost][6];                 ///< S^-1 Jp
};

/// A joint of a forest.
struct TreeJoint : TreeRows<6> {
  uint32_t rowA = 0, rowB = 0;  ///< body rows; the static row for the world
  uint32_t slot = 0;            ///< of the world's joint
  uint32_t island = 0;          ///< of the batch
  bool angular = false;         ///< fixed joint: six rows; ball joint: three, in fixed.ball
  bool childIsA = true;
  int32_t mixed = -1;  ///< in Forest::mixed: a scalar joint; `rows` and TreeRows<6> are then unused
  rows::FixedJoint<float> rows;
};

/// Most rows that a scalar joint has in a tree: an exact and an elastic one along each of six axes, and of the whole
/// joint the cone and a turn to a rotation.
inline constexpr int kMixedRows = 16;

/// A scalar joint in a tree: exact rows, and elastic ones, which enter as multipliers too: S gets 1/k on its diagonal,
/// so that a stiff spring costs no digits. Elastic rows along one axis are one.
struct MixedRows : TreeRows<kMixedRows> {
  uint32_t scalar = 0;           ///< in BatchView::scalar
  float* lambda[kMixedRows];     ///< of exact rows; null of elastic ones
  float compliance[kMixedRows];  ///< 1/k of elastic rows; 0 of exact ones
};

struct TreeNode {
  uint32_t row = 0;
  uint32_t island = 0;                    ///< of the batch
  int32_t parent = -1;                    ///< node
  int32_t joint = -1;                     ///< to the parent or to the world; -1 for a free root
  uint32_t fillBegin = 0, fillCount = 0;  ///< its front, in Forest::fills; 0: its parent alone
  float h[6][6];                          ///< block, then its LDL^T
  float y[6];                             ///< right side on the way down
};

/// A block of the factor beside the tree, of a node and of one that is eliminated after it (tree_fill.h).
struct TreeFill {
  int32_t node = -1;       ///< the other one
  float h[6][6];           ///< of H: rows of the eliminated node, columns of the other
  float v[6][6];           ///< Hc^-1 h
  float r[kMixedRows][6];  ///< of the rows of the node's joint: Jp - Jc v
  float w[kMixedRows][6];  ///< S^-1 r
};

/// A pair of bodies that rows outside of the tree couple, and the block that they fill.
struct FilledPair {
  enum class Kind : uint8_t { Ball, Fixed, Scalar };
  Kind kind = Kind::Ball;
  bool childIsA = true;  ///< A is eliminated first
  uint32_t lane = 0;     ///< among those of its kind
  uint32_t island = 0;
  uint32_t fill = 0;  ///< in Forest::fills
};

/// The same of two of a linked joint's bodies.
struct FilledLink {
  uint32_t linked = 0;       ///< in BatchView::linked
  int child = 0, other = 0;  ///< of its bodies
  uint32_t island = 0;
  uint32_t fill = 0;
};

/// All trees of a batch; parents stand before children. `active` tells of each island of the batch whether it takes
/// part; the others are not touched, so that how long an island iterates changes nothing in its neighbours.
class Forest {
 public:
  std::vector<TreeNode> nodes;
  std::vector<TreeJoint> joints;
  std::vector<MixedRows> mixed;
  std::vector<TreeFill> fills;
  std::vector<FilledPair> filledPairs;
  std::vector<FilledLink> filledLinks;

  void clear();
  /// Index of the block of two nodes of one front; `deeper` is eliminated first.
  uint32_t fillOf(int32_t deeper, int32_t other) const;
  std::span<TreeFill> front(const TreeNode& node) { return {fills.data() + node.fillBegin, node.fillCount}; }

  /// Adds the joints' forces and geometric stiffness to gradient, hessian and diagonal, and keeps J and C.
  void stamp(const BatchView& view, const uint8_t* active);
  void factor(const BatchView& view, const uint8_t* active);
  /// Solves for the rows z of its bodies from r. `violated`: J z = -C, else J z = 0. Takes J^T mu off r.
  void solve(const BatchView& view, const uint8_t* active, bool violated);
  /// Multipliers of the joints += those found since stamp().
  void updateMultipliers(const uint8_t* active);

 private:
  void down(const BatchView& view, const uint8_t* active, bool violated);
  void up(const BatchView& view, const uint8_t* active);
  void takeFromResidual(const BatchView& view, const uint8_t* active);
};

}  // namespace avbd
