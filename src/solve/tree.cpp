// Exact trees: stamping, factorisation and solution.
#include "solve/tree.h"

#include "avbd/rows/sinks.h"
#include "solve/geometric.h"

namespace avbd {

using rows::Twist;
using rows::V3;

namespace {

Twist<float> readTwist(const float* array, uint32_t row) {
  const float* p = array + 8 * row;
  return {{p[0], p[1], p[2]}, {p[4], p[5], p[6]}};
}

void addTwist(float* array, uint32_t row, const Twist<float>& t) {
  float* p = array + 8 * row;
  p[0] += t.lin.x, p[1] += t.lin.y, p[2] += t.lin.z;
  p[4] += t.ang.x, p[5] += t.ang.y, p[6] += t.ang.z;
}

/// Order of a Sym6's 21 floats in a hessian row: linear 6, angular-linear 9, angular 6.
constexpr int kAngular = 15;

void addAngular(const BatchView& v, uint32_t row, const rows::Sym3<float>& g) {
  float* h = v.hessian + kHessianRow * row + kAngular;
  float* d = v.diagonal + 8 * row + 1;
  const float value[6] = {g.xx, g.yy, g.zz, g.xy, g.xz, g.yz};
  for (int i = 0; i < 6; ++i) {
    h[i] += value[i];
    d[i] += value[i];
  }
}

void readBlock(const float* row, float (&h)[6][6]) {
  const float* l = row;
  const float* al = row + 6;
  const float* a = row + kAngular;
  h[0][0] = l[0], h[1][1] = l[1], h[2][2] = l[2], h[1][0] = l[3], h[2][0] = l[4], h[2][1] = l[5];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) h[3 + i][j] = al[3 * i + j];
  h[3][3] = a[0], h[4][4] = a[1], h[5][5] = a[2], h[4][3] = a[3], h[5][3] = a[4], h[5][4] = a[5];
}

/// In place LDL^T of the lower triangle; the diagonal keeps inverse pivots. Only the first n rows.
template <int kMax>
void factorLdl(float (&a)[kMax][kMax], int n) {
  for (int j = 0; j < n; ++j) {
    const float inverse = rows::inversePivot(a[j][j]);
    for (int i = j + 1; i < n; ++i) {
      const float l = a[i][j] * inverse;
      for (int k = j + 1; k <= i; ++k) a[i][k] -= l * a[k][j];
    }
    for (int i = j + 1; i < n; ++i) a[i][j] *= inverse;
    a[j][j] = inverse;
  }
}

template <int kMax>
void solveLdl(const float (&a)[kMax][kMax], int n, float* x) {
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j) x[i] -= a[i][j] * x[j];
  for (int i = 0; i < n; ++i) x[i] *= a[i][i];
  for (int i = n - 2; i >= 0; --i)
    for (int j = i + 1; j < n; ++j) x[i] -= a[j][i] * x[j];
}

/// The same for kColumns right-hand sides side by side.
template <int kColumns>
void solveLdlColumns(const float (&a)[6][6], float (&x)[6][8]) {
  for (int i = 1; i < 6; ++i)
    for (int j = 0; j < i; ++j)
      for (int c = 0; c < kColumns; ++c) x[i][c] -= a[i][j] * x[j][c];
  for (int i = 0; i < 6; ++i)
    for (int c = 0; c < kColumns; ++c) x[i][c] *= a[i][i];
  for (int i = 4; i >= 0; --i)
    for (int j = i + 1; j < 6; ++j)
      for (int c = 0; c < kColumns; ++c) x[i][c] -= a[j][i] * x[j][c];
}

void fillJacobian(float (&j)[6], const rows::PairRow<float>& row, const V3<float>& arm, float sign) {
  const V3<float> ang = cross(arm, row.lin) + row.ang;
  j[0] = sign * row.lin.x, j[1] = sign * row.lin.y, j[2] = sign * row.lin.z;
  j[3] = sign * ang.x, j[4] = sign * ang.y, j[5] = sign * ang.z;
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
  const Twist<float> onA = shiftWrench(wrench, probe.armA), onB = shiftWrench(wrench, probe.armB);
  addTwist(v.gradient, joint.rowA, onA);
  addTwist(v.gradient, joint.rowB, {-onB.lin, -onB.ang});
  addAngular(v, joint.rowA, geometricStiffness(-wrench.lin, probe.armA));
  addAngular(v, joint.rowB, geometricStiffness(wrench.lin, probe.armB));
}

void maskLocked(TreeJoint& joint, const BatchView& v) {
  for (uint32_t i = 0; i < v.lockedCount; ++i) {
    const uint32_t row = v.locked[i];
    if (row != joint.rowA && row != joint.rowB) continue;
    auto& j = (row == joint.rowA) == joint.childIsA ? joint.jc : joint.jp;
    for (int axis = 0; axis < 6; ++axis)
      if (v.locks[i] >> axis & 1)
        for (int k = 0; k < joint.m; ++k) j[k][axis] = 0;
  }
}

/// Eliminates the node: its block is complete. Adds what it leaves to the parent.
template <int kRows>
void eliminate(TreeNode& node, TreeJoint& joint, TreeNode* parent) {
  constexpr int kColumns = kRows <= 4 ? 4 : 8;
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < kColumns; ++i) joint.u[k][i] = i < kRows ? joint.jc[i][k] : 0.0f;
  solveLdlColumns<kColumns>(node.h, joint.u);
  for (int i = 0; i < kRows; ++i) {
    float sum[kColumns] = {};
    for (int k = 0; k < 6; ++k)
      for (int j = 0; j < kColumns; ++j) sum[j] += joint.jc[i][k] * joint.u[k][j];
    for (int j = 0; j <= i; ++j) joint.sFactor[i][j] = sum[j];
  }
  factorLdl(joint.sFactor, kRows);
  if (!parent) return;
  for (int k = 0; k < 6; ++k) {
    float column[kRows];
    for (int i = 0; i < kRows; ++i) column[i] = joint.jp[i][k];
    solveLdl(joint.sFactor, kRows, column);
    for (int i = 0; i < kRows; ++i) joint.w[i][k] = column[i];
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) {
      float sum = 0;
      for (int k = 0; k < kRows; ++k) sum += joint.jp[k][i] * joint.w[k][j];
      parent->h[i][j] += sum;
    }
}

/// Leaf to root for one node: y of the parent -= Jp^T S^-1 (Jc Hc^-1 y - b); mu keeps S^-1 (...).
template <int kRows>
void descend(const TreeNode& node, TreeJoint& joint, TreeNode* parent, bool violated) {
  float t[kRows];
  for (int i = 0; i < kRows; ++i) t[i] = violated ? joint.violation[i] : 0.0f;
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < kRows; ++i) t[i] += joint.u[k][i] * node.y[k];
  solveLdl(joint.sFactor, kRows, t);
  for (int i = 0; i < kRows; ++i) joint.mu[i] = t[i];
  if (!parent) return;
  for (int k = 0; k < 6; ++k) {
    float sum = 0;
    for (int i = 0; i < kRows; ++i) sum += joint.jp[i][k] * t[i];
    parent->y[k] -= sum;
  }
}

template <int kRows>
void ascend(const TreeNode& node, TreeJoint& joint, const float* parentZ, float* z) {
  for (int i = 0; i < kRows; ++i) {
    if (parentZ)
      for (int k = 0; k < 6; ++k) joint.mu[i] += joint.w[i][k] * parentZ[k];
    joint.total[i] += joint.mu[i];
  }
  for (int k = 0; k < 6; ++k) z[k] = node.y[k];
  solveLdl(node.h, 6, z);
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < kRows; ++i) z[k] -= joint.u[k][i] * joint.mu[i];
}

}  // namespace

void Forest::stamp(const BatchView& view, const uint8_t* active) {
  for (TreeJoint& joint : joints) {
    if (!active[joint.island]) continue;
    stampJoint(view, joint);
    if (view.lockedCount) maskLocked(joint, view);
  }
}

void Forest::factor(const BatchView& view, const uint8_t* active) {
  for (TreeNode& node : nodes)
    if (active[node.island]) readBlock(view.hessian + kHessianRow * node.row, node.h);
  for (size_t i = nodes.size(); i-- > 0;) {
    TreeNode& node = nodes[i];
    if (!active[node.island]) continue;
    factorLdl(node.h, 6);
    if (node.joint < 0) continue;
    TreeJoint& joint = joints[static_cast<size_t>(node.joint)];
    TreeNode* parent = node.parent >= 0 ? &nodes[static_cast<size_t>(node.parent)] : nullptr;
    joint.angular ? eliminate<6>(node, joint, parent) : eliminate<3>(node, joint, parent);
  }
}

void Forest::down(const BatchView& view, const uint8_t* active, bool violated) {
  for (TreeNode& node : nodes) {
    if (!active[node.island]) continue;
    const Twist<float> r = readTwist(view.r, node.row);
    const float y[6] = {r.lin.x, r.lin.y, r.lin.z, r.ang.x, r.ang.y, r.ang.z};
    for (int k = 0; k < 6; ++k) node.y[k] = y[k];
  }
  for (size_t i = nodes.size(); i-- > 0;) {
    TreeNode& node = nodes[i];
    if (node.joint < 0 || !active[node.island]) continue;
    TreeJoint& joint = joints[static_cast<size_t>(node.joint)];
    TreeNode* parent = node.parent >= 0 ? &nodes[static_cast<size_t>(node.parent)] : nullptr;
    joint.angular ? descend<6>(node, joint, parent, violated) : descend<3>(node, joint, parent, violated);
  }
}

void Forest::up(const BatchView& view, const uint8_t* active) {
  for (TreeNode& node : nodes) {
    if (!active[node.island]) continue;
    float z[6];
    if (node.joint < 0) {
      for (int k = 0; k < 6; ++k) z[k] = node.y[k];
      solveLdl(node.h, 6, z);
    } else {
      TreeJoint& joint = joints[static_cast<size_t>(node.joint)];
      const float* parentZ = node.parent >= 0 ? nodes[static_cast<size_t>(node.parent)].y : nullptr;
      joint.angular ? ascend<6>(node, joint, parentZ, z) : ascend<3>(node, joint, parentZ, z);
    }
    float* out = view.z + 8 * node.row;
    for (int k = 0; k < 3; ++k) out[k] = z[k], out[4 + k] = z[3 + k];
    for (int k = 0; k < 6; ++k) node.y[k] = z[k];  // children read it
  }
}

void Forest::takeFromResidual(const BatchView& view, const uint8_t* active) {
  for (const TreeNode& node : nodes) {
    if (node.joint < 0 || !active[node.island]) continue;
    const TreeJoint& joint = joints[static_cast<size_t>(node.joint)];
    float* child = view.r + 8 * node.row;
    float* parent = node.parent >= 0 ? view.r + 8 * nodes[static_cast<size_t>(node.parent)].row : nullptr;
    for (int i = 0; i < joint.m; ++i)
      for (int k = 0; k < 6; ++k) {
        const int at = k < 3 ? k : k + 1;
        child[at] -= joint.jc[i][k] * joint.mu[i];
        if (parent) parent[at] -= joint.jp[i][k] * joint.mu[i];
      }
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
    float* lambda[6] = {&joint.rows.ball.lambda.x, &joint.rows.ball.lambda.y, &joint.rows.ball.lambda.z,
                        &joint.rows.lambda.x,      &joint.rows.lambda.y,      &joint.rows.lambda.z};
    for (int i = 0; i < joint.m; ++i) *lambda[i] += joint.total[i];
  }
}

}  // namespace avbd
