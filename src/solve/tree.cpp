// Exact trees: stamping, factorisation and solution.
#include "solve/tree.h"

#include <algorithm>

#include "avbd/rows/sinks.h"
#include "base/assert.h"
#include "solve/body_rows.h"
#include "solve/geometric.h"
#include "solve/scalar_joint.h"
#include "solve/tree_fill.h"
#include "solve/tree_parts.h"

namespace avbd {

using rows::Twist;
using rows::V3;

namespace {

void readBlock(const float* row, float (&h)[6][6]) {
  const float* l = row;
  const float* al = row + 6;
  const float* a = row + kAngularBlock;
  h[0][0] = l[0], h[1][1] = l[1], h[2][2] = l[2], h[1][0] = l[3], h[2][0] = l[4], h[2][1] = l[5];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) h[3 + i][j] = al[3 * i + j];
  h[3][3] = a[0], h[4][4] = a[1], h[5][5] = a[2], h[4][3] = a[3], h[5][3] = a[4], h[5][4] = a[5];
}

/// Force and geometric stiffness of a joint.
void addJointForce(const BatchView& v, const TreeJoint& joint, const Twist<float>& wrench, const V3<float>& armA,
                   const V3<float>& armB) {
  const Twist<float> onA = shiftWrench(wrench, armA), onB = shiftWrench(wrench, armB);
  addTwist(v.gradient, joint.rowA, onA);
  addTwist(v.gradient, joint.rowB, {-onB.lin, -onB.ang});
  addAngular(v, joint.rowA, geometricStiffness(-wrench.lin, armA));
  addAngular(v, joint.rowB, geometricStiffness(wrench.lin, armB));
}

void stampJoint(const BatchView& v, TreeJoint& joint) {
  rows::ProbeSink<float, 6> probe;
  const Twist<float> dA = readTwist(v.d, joint.rowA), dB = readTwist(v.d, joint.rowB);
  if (joint.angular) {
    joint.rows.rows(dA, dB, probe);
  } else {
    joint.rows.ball.rows(dA, dB, probe);
  }
  Twist<float> wrench{};
  for (int i = 0; i < joint.m; ++i) {
    const rows::PairRow<float>& row = probe.row[i];
    joint.violation[i] = row.C;
    joint.total[i] = 0;
    wrench.lin += row.lin * *probe.lambda[i];
    wrench.ang += row.ang * *probe.lambda[i];
    fillJacobian(joint.childIsA ? joint.jc[i] : joint.jp[i], row, probe.armA, 1);
    fillJacobian(joint.childIsA ? joint.jp[i] : joint.jc[i], row, probe.armB, -1);
  }
  addJointForce(v, joint, wrench, probe.armA, probe.armB);
}

bool sameAxis(const rows::PairRow<float>& a, const rows::PairRow<float>& b) {
  return a.lin.x == b.lin.x && a.lin.y == b.lin.y && a.lin.z == b.lin.z && a.ang.x == b.ang.x && a.ang.y == b.ang.y &&
         a.ang.z == b.ang.z;
}

/// Adds a row to those that a scalar joint has in this iteration.
void addMixed(const TreeJoint& joint, MixedRows& mixed, const ScalarRows& list, int i, const RowForce& force) {
  const bool exact = force.kind == RowKind::Exact;
  if (mixed.m == kMixedRows) {  // only the turning of a cone's normal, which has no force, finds no room
    AVBD_ASSERT(!exact && i == list.count - 1);
    return;
  }
  const int at = mixed.m++;
  mixed.violation[at] = exact ? list.row[i].C : 0;
  mixed.compliance[at] = exact ? 0 : 1 / force.k;
  mixed.lambda[at] = exact ? list.lambda[i] : nullptr;
  mixed.total[at] = 0;
  fillJacobian(joint.childIsA ? mixed.jc[at] : mixed.jp[at], list.row[i], list.armA, 1);
  fillJacobian(joint.childIsA ? mixed.jp[at] : mixed.jc[at], list.row[i], list.armB, -1);
}

/// The rows that a scalar joint has in this iteration.
void stampMixed(const BatchView& v, const TreeJoint& joint, MixedRows& mixed) {
  const ScalarRows list = rowsOf(v.scalar.joint[mixed.scalar], v);
  Twist<float> wrench{};
  mixed.m = 0;
  int elastic = -1;  // row of `list` that stands for the elastic ones of its axis
  float k = 0;       // of them together
  const auto endAxis = [&] {
    if (k > 0) addMixed(joint, mixed, list, elastic, {RowKind::Elastic, 0, k});
    k = 0;
  };
  for (int i = 0; i < list.count; ++i) {
    const rows::PairRow<float>& row = list.row[i];
    const RowForce force = forceOf(row, *list.lambda[i], true);
    wrench.lin += row.lin * force.force;
    wrench.ang += row.ang * force.force;
    if (force.kind == RowKind::Exact) addMixed(joint, mixed, list, i, force);
    if (force.kind != RowKind::Elastic || force.k <= 0) continue;
    if (k > 0 && !sameAxis(list.row[elastic], row)) endAxis();
    elastic = i, k += force.k;
  }
  endAxis();
  addJointForce(v, joint, wrench, list.armA, list.armB);
}

template <class Rows>
void maskLocked(const TreeJoint& joint, Rows& rows, const BatchView& v) {
  for (uint32_t i = 0; i < v.lockedCount; ++i) {
    const uint32_t row = v.locked[i];
    if (row != joint.rowA && row != joint.rowB) continue;
    auto& j = (row == joint.rowA) == joint.childIsA ? rows.jc : rows.jp;
    for (int axis = 0; axis < 6; ++axis)
      if (v.locks[i] >> axis & 1)
        for (int k = 0; k < rows.m; ++k) j[k][axis] = 0;
  }
}

/// How many rows there are: known to the compiler where all joints of a kind have as many.
template <int kFixed>
int countOf(int m) {
  return kFixed > 0 ? kFixed : m;
}

/// Eliminates the node: its block is complete. Adds what it leaves to the parent.
template <int kFixed, class Rows>
void eliminate(TreeNode& node, Rows& rows, TreeNode* parent) {
  constexpr int kColumns = kFixed > 0 ? (kFixed + 3) / 4 * 4 : Rows::kColumns;
  const int m = countOf<kFixed>(rows.m);
  factorRows<kColumns>(node.h, rows, m);
  if (!parent) return;
  for (int k = 0; k < 6; ++k) {
    float column[Rows::kRows];
    for (int i = 0; i < m; ++i) column[i] = rows.jp[i][k];
    solveLdl(rows.sFactor, m, column);
    for (int i = 0; i < m; ++i) rows.w[i][k] = column[i];
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) {
      float sum = 0;
      for (int k = 0; k < m; ++k) sum += rows.jp[k][i] * rows.w[k][j];
      parent->h[i][j] += sum;
    }
}

/// Leaf to root for one node: y of the parent -= Jp^T S^-1 (Jc Hc^-1 y - b); mu keeps S^-1 (...).
template <int kFixed, class Rows>
void descend(const TreeNode& node, Rows& rows, TreeNode* parent, bool violated) {
  const int m = countOf<kFixed>(rows.m);
  float t[Rows::kRows];
  for (int i = 0; i < m; ++i) t[i] = violated ? rows.violation[i] : 0.0f;
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < m; ++i) t[i] += rows.u[k][i] * node.y[k];
  solveLdl(rows.sFactor, m, t);
  for (int i = 0; i < m; ++i) rows.mu[i] = t[i];
  if (!parent) return;
  for (int k = 0; k < 6; ++k) {
    float sum = 0;
    for (int i = 0; i < m; ++i) sum += rows.jp[i][k] * t[i];
    parent->y[k] -= sum;
  }
}

template <int kFixed, class Rows>
void ascend(TreeNode& node, Rows& rows, const float* parentZ) {
  const int m = countOf<kFixed>(rows.m);
  for (int i = 0; i < m; ++i) {
    if (parentZ)
      for (int k = 0; k < 6; ++k) rows.mu[i] += rows.w[i][k] * parentZ[k];
    rows.total[i] += rows.mu[i];
  }
  solveLdl(node.h, 6, node.y);
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < m; ++i) node.y[k] -= rows.u[k][i] * rows.mu[i];
}

}  // namespace

void Forest::stamp(const BatchView& view, const uint8_t* active) {
  for (TreeJoint& joint : joints) {
    if (!active[joint.island]) continue;
    if (joint.mixed >= 0) {
      stampMixed(view, joint, mixed[static_cast<size_t>(joint.mixed)]);
    } else {
      stampJoint(view, joint);
    }
    if (view.lockedCount) withRows(*this, joint, [&]<int>(auto& rows) { maskLocked(joint, rows, view); });
  }
}

void Forest::clear() {
  nodes.clear(), joints.clear(), mixed.clear();
  fills.clear(), filledPairs.clear(), filledLinks.clear();
}

uint32_t Forest::fillOf(int32_t deeper, int32_t other) const {
  const TreeNode& node = nodes[static_cast<size_t>(deeper)];
  const uint32_t end = node.fillBegin + node.fillCount;
  uint32_t fill = node.fillBegin;
  while (fill < end && fills[fill].node != other) ++fill;
  AVBD_ASSERT(fill < end);
  return fill;
}

void Forest::factor(const BatchView& view, const uint8_t* active) {
  if (!fills.empty()) stampFill(view, *this, active);
  for (TreeNode& node : nodes)
    if (active[node.island]) readBlock(view.hessian + kHessianRow * node.row, node.h);
  for (size_t i = nodes.size(); i-- > 0;) {
    TreeNode& node = nodes[i];
    if (!active[node.island]) continue;
    factorLdl(node.h, 6);
    if (node.fillCount > 0) {
      eliminateFilled(*this, node);
      continue;
    }
    if (node.joint < 0) continue;
    TreeJoint& joint = joints[static_cast<size_t>(node.joint)];
    TreeNode* parent = node.parent >= 0 ? &nodes[static_cast<size_t>(node.parent)] : nullptr;
    withRows(*this, joint, [&]<int kFixed>(auto& rows) { eliminate<kFixed>(node, rows, parent); });
  }
}

void Forest::down(const BatchView& view, const uint8_t* active, bool violated) {
  for (TreeNode& node : nodes) {
    if (!active[node.island]) continue;
    const std::array<float, 6> r = entries(readTwist(view.r, node.row));
    std::copy(r.begin(), r.end(), node.y);
  }
  for (size_t i = nodes.size(); i-- > 0;) {
    TreeNode& node = nodes[i];
    if (!active[node.island]) continue;
    if (node.fillCount > 0) {
      descendFilled(*this, node, violated);
      continue;
    }
    if (node.joint < 0) continue;
    TreeJoint& joint = joints[static_cast<size_t>(node.joint)];
    TreeNode* parent = node.parent >= 0 ? &nodes[static_cast<size_t>(node.parent)] : nullptr;
    withRows(*this, joint, [&]<int kFixed>(auto& rows) { descend<kFixed>(node, rows, parent, violated); });
  }
}

void Forest::up(const BatchView& view, const uint8_t* active) {
  for (TreeNode& node : nodes) {
    if (!active[node.island]) continue;
    // What stands in y afterwards is read by those eliminated before.
    if (node.fillCount > 0) {
      ascendFilled(*this, node);
    } else if (node.joint < 0) {
      solveLdl(node.h, 6, node.y);
    } else {
      TreeJoint& joint = joints[static_cast<size_t>(node.joint)];
      const float* parentZ = node.parent >= 0 ? nodes[static_cast<size_t>(node.parent)].y : nullptr;
      withRows(*this, joint, [&]<int kFixed>(auto& rows) { ascend<kFixed>(node, rows, parentZ); });
    }
    float* out = view.z + 8 * node.row;
    for (int k = 0; k < 3; ++k) out[k] = node.y[k], out[4 + k] = node.y[3 + k];
  }
}

void Forest::takeFromResidual(const BatchView& view, const uint8_t* active) {
  for (const TreeNode& node : nodes) {
    // Where nothing else couples the island, nobody reads its residual again.
    if (node.joint < 0 || !active[node.island] || !view.island[node.island].coupled) continue;
    float* child = view.r + 8 * node.row;
    float* parent = node.parent >= 0 ? view.r + 8 * nodes[static_cast<size_t>(node.parent)].row : nullptr;
    withRows(*this, joints[static_cast<size_t>(node.joint)], [&]<int>(auto& rows) {
      for (int i = 0; i < rows.m; ++i) {
        if (complianceOf(rows, i) > 0) continue;  // elastic rows are part of H
        for (int k = 0; k < 6; ++k) {
          const int at = k < 3 ? k : k + 1;
          child[at] -= rows.jc[i][k] * rows.mu[i];
          if (parent) parent[at] -= rows.jp[i][k] * rows.mu[i];
        }
      }
    });
  }
}

void Forest::solve(const BatchView& view, const uint8_t* active, bool violated) {
  down(view, active, violated);
  up(view, active);
  takeFromResidual(view, active);
}

void Forest::updateMultipliers(const uint8_t* active) {
  for (TreeJoint& joint : joints) {
    if (!active[joint.island]) continue;
    if (joint.mixed >= 0) {
      const MixedRows& rows = mixed[static_cast<size_t>(joint.mixed)];
      for (int i = 0; i < rows.m; ++i)
        if (rows.lambda[i]) *rows.lambda[i] += rows.total[i];
      continue;
    }
    float* lambda[6] = {&joint.rows.ball.lambda.x, &joint.rows.ball.lambda.y, &joint.rows.ball.lambda.z,
                        &joint.rows.lambda.x,      &joint.rows.lambda.y,      &joint.rows.lambda.z};
    for (int i = 0; i < joint.m; ++i) *lambda[i] += joint.total[i];
  }
}

}  // namespace avbd
