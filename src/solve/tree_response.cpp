// How a tree answers a force along one of its coordinates (tree_response.h).
#include "solve/tree_response.h"

#include "avbd/rows/sinks.h"
#include "solve/body_rows.h"
#include "solve/tree_parts.h"

namespace avbd {

namespace {

using rows::Twist;
using rows::V3;
using Block = float[6][6];

void massBlock(const BatchView& view, uint32_t row, Block& h) {
  const float* m = view.mass + 8 * row;
  for (auto& line : h)
    for (float& value : line) value = 0;
  h[0][0] = h[1][1] = h[2][2] = m[0];
  h[3][3] = m[1], h[4][4] = m[2], h[5][5] = m[3], h[4][3] = m[4], h[5][3] = m[5], h[5][4] = m[6];
}

/// Keeps the rows that hold both ways whatever the forces are.
template <class Rows, class List>
void keepHard(const TreeJoint& joint, Rows& rows, const List& list, int count) {
  rows.m = 0;
  for (int i = 0; i < count; ++i) {
    const rows::PairRow<float>& row = list.row[i];
    if (row.s != 1 || row.lower != -rows::kInfinity || row.upper != rows::kInfinity) continue;
    fillJacobian(joint.childIsA ? rows.jc[rows.m] : rows.jp[rows.m], row, list.armA, 1);
    fillJacobian(joint.childIsA ? rows.jp[rows.m] : rows.jc[rows.m], row, list.armB, -1);
    ++rows.m;
  }
}

void stampHard(const BatchView& view, Forest& forest, TreeJoint& joint) {
  if (joint.mixed >= 0) {
    MixedRows& mixed = forest.mixed[static_cast<size_t>(joint.mixed)];
    const ScalarRows list = rowsOf(view.scalar.joint[mixed.scalar], view);
    for (float& compliance : mixed.compliance) compliance = 0;
    return keepHard(joint, mixed, list, list.count);
  }
  rows::ProbeSink<float, 6> list;
  const Twist<float> still = rows::zeroTwist<float>();
  joint.angular ? joint.rows.rows(still, still, list) : joint.rows.ball.rows(still, still, list);
  keepHard(joint, static_cast<TreeRows<6>&>(joint), list, joint.angular ? 6 : 3);
}

/// h += Jp^T S^-1 Jp, and W.
template <class Rows>
void leaveToParent(Rows& rows, TreeNode& parent) {
  for (int i = 0; i < rows.m; ++i)
    for (int k = 0; k < 6; ++k) rows.w[i][k] = rows.jp[i][k];
  solveLdlColumns<6>(rows.sFactor, rows.m, rows.w);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j)
      for (int k = 0; k < rows.m; ++k) parent.h[i][j] += rows.jp[k][i] * rows.w[k][j];
}

/// P, and T, which is 0 of a root.
template <class Rows>
void answerAlone(const TreeNode& node, const Rows& rows, TreeResponse& out) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) out.z[i][j] = i == j ? 1.0f : 0.0f, out.t[i][j] = 0;
  solveLdlColumns<6>(node.h, 6, out.z);
  float su[Rows::kRows][6];  // S^-1 U^T
  for (int i = 0; i < rows.m; ++i)
    for (int k = 0; k < 6; ++k) su[i][k] = rows.u[k][i];
  solveLdlColumns<6>(rows.sFactor, rows.m, su);
  for (int k = 0; k < rows.m; ++k)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        out.z[i][j] -= rows.u[i][k] * su[k][j];
        if (node.parent >= 0) out.t[i][j] -= rows.u[i][k] * rows.w[k][j];
      }
}

/// out = a b.
void product(const Block& a, const Block& b, Block& out) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      out[i][j] = 0;
      for (int k = 0; k < 6; ++k) out[i][j] += a[i][k] * b[k][j];
    }
}

/// Z = P + T Z_p T^T.
void addParents(const TreeResponse& parent, TreeResponse& out) {
  Block tz;
  product(out.t, parent.z, tz);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) out.z[i][j] += tz[i][k] * out.t[j][k];
}

float form(const Twist<float>& a, const Block& m, const Twist<float>& b) {
  const std::array<float, 6> left = entries(a), right = entries(b);
  float sum = 0;
  for (size_t i = 0; i < 6; ++i)
    for (size_t j = 0; j < 6; ++j) sum += left[i] * m[i][j] * right[j];
  return sum;
}

}  // namespace

void findResponses(const BatchView& view, Forest& forest, std::vector<TreeResponse>& response) {
  for (TreeJoint& joint : forest.joints) stampHard(view, forest, joint);
  for (TreeNode& node : forest.nodes) massBlock(view, node.row, node.h);
  response.resize(forest.nodes.size());
  for (size_t i = forest.nodes.size(); i-- > 0;) {
    TreeNode& node = forest.nodes[i];
    factorLdl(node.h, 6);
    const auto eliminate = [&](auto& rows) {
      using Rows = std::remove_reference_t<decltype(rows)>;
      factorRows<Rows::kColumns>(node.h, rows, rows.m);
      if (node.parent >= 0) leaveToParent(rows, forest.nodes[static_cast<size_t>(node.parent)]);
      answerAlone(node, rows, response[i]);
    };
    if (node.joint >= 0) {
      withRows(forest, forest.joints[static_cast<size_t>(node.joint)], [&]<int>(auto& rows) { eliminate(rows); });
    } else {
      TreeRows<6> none;
      eliminate(none);
    }
  }
  for (size_t i = 0; i < forest.nodes.size(); ++i)
    if (forest.nodes[i].parent >= 0) addParents(response[static_cast<size_t>(forest.nodes[i].parent)], response[i]);
  for (TreeJoint& joint : forest.joints) joint.m = joint.angular ? 6 : 3;
}

float inverseMassOf(const Forest& forest, const std::vector<TreeResponse>& response, size_t node,
                    const Twist<float>& child, const Twist<float>& parent) {
  float sum = form(child, response[node].z, child);
  const int32_t up = forest.nodes[node].parent;
  if (up < 0) return sum;
  const TreeResponse& above = response[static_cast<size_t>(up)];
  Block tz;
  product(response[node].t, above.z, tz);
  return sum + 2 * form(child, tz, parent) + form(parent, above.z, parent);
}

}  // namespace avbd
