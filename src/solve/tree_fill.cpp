// Loops in the exact solution (tree_fill.h).
#include "solve/tree_fill.h"

#include "solve/linked_joint.h"
#include "solve/tree_parts.h"

namespace avbd {

namespace {

using rows::Twist;
using rows::V3;

/// Calls f(rows of the node's joint); of a node without one, with no rows.
template <class F>
void withNodeRows(Forest& forest, const TreeNode& node, F&& f) {
  if (node.joint >= 0)
    return withRows(forest, forest.joints[static_cast<size_t>(node.joint)], [&]<int>(auto& rows) { f(rows); });
  TreeRows<6> none;
  f(none);
}

/// Columns of K T with T = [1, -[arm]x; 0, 1]: the wrench at the reference point by the motion of a body.
void columnsAtPoint(const rows::Sym6<float>& k, const V3<float>& arm, Twist<float> (&column)[6]) {
  for (int i = 0; i < 6; ++i) {
    const V3<float> unit{float(i % 3 == 0), float(i % 3 == 1), float(i % 3 == 2)}, none = rows::zeroV3<float>();
    const Twist<float> motion = i < 3 ? Twist<float>{unit, none} : Twist<float>{none, unit};
    column[i] = k * shiftToPoint(motion, arm);
  }
}

/// h += -(T_c^T K T_a), with the arms of the eliminated body and of the other.
void addPairBlock(const PairOp<float>& op, bool childIsA, float (&h)[6][6]) {
  Twist<float> column[6];
  columnsAtPoint(op.stiffness, childIsA ? op.armB : op.armA, column);
  for (int j = 0; j < 6; ++j) {
    const std::array<float, 6> value = entries(shiftWrench(column[j], childIsA ? op.armA : op.armB));
    for (size_t i = 0; i < 6; ++i) h[i][j] -= value[i];
  }
}

void addLinkBlock(const LinkedJoint& joint, const FilledLink& link, float (&h)[6][6]) {
  for (int n = 0; n < joint.stamped.count; ++n) {
    const LinkedRow& row = joint.stamped.row[n];
    if (!(row.k > 0)) continue;
    const std::array<float, 6> left = entries(jacobianOf(joint, row, link.child));
    const std::array<float, 6> right = entries(jacobianOf(joint, row, link.other));
    for (size_t i = 0; i < 6; ++i)
      for (size_t j = 0; j < 6; ++j) h[i][j] += row.k * left[i] * right[j];
  }
}

PairOp<float> opOf(const BatchView& view, const FilledPair& pair) {
  uint32_t tile = view.contacts.tiles;
  if (pair.kind != FilledPair::Kind::Ball) tile += view.balls.tiles;
  if (pair.kind == FilledPair::Kind::Scalar) tile += view.fixed.tiles;
  return view.op[tile + pair.lane / kTile].get(static_cast<int>(pair.lane % kTile));
}

/// A locked axis couples to nothing.
void maskFill(const BatchView& view, Forest& forest, TreeNode& node) {
  for (uint32_t i = 0; i < view.lockedCount; ++i)
    for (int axis = 0; axis < 6; ++axis) {
      if (!(view.locks[i] >> axis & 1)) continue;
      for (TreeFill& fill : forest.front(node))
        for (int k = 0; k < 6; ++k) {
          if (view.locked[i] == node.row) fill.h[axis][k] = 0;
          if (view.locked[i] == forest.nodes[static_cast<size_t>(fill.node)].row) fill.h[k][axis] = 0;
        }
    }
}

/// R and S^-1 R of one node of the front.
template <class Rows>
void fillRows(const TreeNode& node, const Rows& rows, TreeFill& fill) {
  const bool parent = node.joint >= 0 && fill.node == node.parent;
  for (int i = 0; i < rows.m; ++i)
    for (int j = 0; j < 6; ++j) {
      float sum = parent ? rows.jp[i][j] : 0.0f;
      for (int k = 0; k < 6; ++k) sum -= rows.jc[i][k] * fill.v[k][j];
      fill.r[i][j] = fill.w[i][j] = sum;
    }
  solveLdlColumns<6>(rows.sFactor, rows.m, fill.w);
}

/// R_a^T S^-1 R_b - H_ca^T V_b.
void leave(const TreeFill& a, const TreeFill& b, int m, float (&block)[6][6]) {
  for (int k = 0; k < m; ++k)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) block[i][j] += a.r[k][i] * b.w[k][j];
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) block[i][j] -= a.h[k][i] * b.v[k][j];
}

}  // namespace

void stampFill(const BatchView& view, Forest& forest, const uint8_t* active) {
  for (TreeFill& fill : forest.fills)
    for (auto& row : fill.h)
      for (float& value : row) value = 0;
  for (const FilledPair& pair : forest.filledPairs)
    if (active[pair.island]) addPairBlock(opOf(view, pair), pair.childIsA, forest.fills[pair.fill].h);
  for (const FilledLink& link : forest.filledLinks)
    if (active[link.island]) addLinkBlock(view.linked.joint[link.linked], link, forest.fills[link.fill].h);
  if (view.lockedCount == 0) return;
  for (TreeNode& node : forest.nodes) maskFill(view, forest, node);
}

void eliminateFilled(Forest& forest, TreeNode& node) {
  withNodeRows(forest, node, [&](auto& rows) {
    using Rows = std::remove_reference_t<decltype(rows)>;
    factorRows<Rows::kColumns>(node.h, rows, rows.m);
    const std::span<TreeFill> front = forest.front(node);
    for (TreeFill& fill : front) {
      __builtin_memcpy(fill.v, fill.h, sizeof(fill.v));
      solveLdlColumns<6>(node.h, 6, fill.v);
      fillRows(node, rows, fill);
    }
    // The front stands in the order of elimination.
    for (size_t a = 0; a < front.size(); ++a) {
      leave(front[a], front[a], rows.m, forest.nodes[static_cast<size_t>(front[a].node)].h);
      for (size_t b = a + 1; b < front.size(); ++b)
        leave(front[a], front[b], rows.m, forest.fills[forest.fillOf(front[a].node, front[b].node)].h);
    }
  });
}

void descendFilled(Forest& forest, TreeNode& node, bool violated) {
  withNodeRows(forest, node, [&](auto& rows) {
    using Rows = std::remove_reference_t<decltype(rows)>;
    float t[Rows::kRows];
    for (int i = 0; i < rows.m; ++i) {
      t[i] = violated ? rows.violation[i] : 0.0f;
      for (int k = 0; k < 6; ++k) t[i] += rows.u[k][i] * node.y[k];
    }
    solveLdl(rows.sFactor, rows.m, t);
    for (int i = 0; i < rows.m; ++i) rows.mu[i] = t[i];
    for (const TreeFill& fill : forest.front(node)) {
      float* y = forest.nodes[static_cast<size_t>(fill.node)].y;
      for (int k = 0; k < 6; ++k)
        for (int j = 0; j < 6; ++j) y[j] -= fill.v[k][j] * node.y[k];
      for (int i = 0; i < rows.m; ++i)
        for (int j = 0; j < 6; ++j) y[j] -= fill.r[i][j] * t[i];
    }
  });
}

void ascendFilled(Forest& forest, TreeNode& node) {
  withNodeRows(forest, node, [&](auto& rows) {
    float z[6];
    for (int k = 0; k < 6; ++k) z[k] = node.y[k];
    solveLdl(node.h, 6, z);
    for (const TreeFill& fill : forest.front(node)) {
      const float* x = forest.nodes[static_cast<size_t>(fill.node)].y;
      for (int i = 0; i < rows.m; ++i)
        for (int j = 0; j < 6; ++j) rows.mu[i] += fill.w[i][j] * x[j];
      for (int k = 0; k < 6; ++k)
        for (int j = 0; j < 6; ++j) z[k] -= fill.v[k][j] * x[j];
    }
    for (int i = 0; i < rows.m; ++i) {
      rows.total[i] += rows.mu[i];
      for (int k = 0; k < 6; ++k) z[k] -= rows.u[k][i] * rows.mu[i];
    }
    for (int k = 0; k < 6; ++k) node.y[k] = z[k];
  });
}

}  // namespace avbd
