// Joints whose rows are evaluated one at a time (scalar_joint.h).
#include "solve/scalar_joint.h"

#include "solve/body_rows.h"
#include "solve/geometric.h"

namespace avbd {

namespace {

using rows::PairRow;
using rows::Twist;

void stampLoop(const BatchView& view, const ScalarJoint& joint, const ScalarRows& list, const ScalarStamp& stamp) {
  const Twist<float> onA = shiftWrench(stamp.wrench, list.armA), onB = shiftWrench(stamp.wrench, list.armB);
  addTwist(view.gradient, joint.rowA, onA);
  addTwist(view.gradient, joint.rowB, -onB);
  addBlock(view.hessian, joint.rowA, shifted(stamp.stiffness, list.armA));
  addBlock(view.hessian, joint.rowB, shifted(stamp.stiffness, list.armB));
  addAngular(view, joint.rowA, rows::geometricStiffness(-stamp.wrench.lin, list.armA));
  addAngular(view, joint.rowB, rows::geometricStiffness(stamp.wrench.lin, list.armB));
}

}  // namespace

ScalarRows rowsOf(ScalarJoint& joint, const BatchView& view) {
  ScalarRows list;
  const Twist<float> dA = readTwist(view.d, joint.rowA), dB = readTwist(view.d, joint.rowB);
  if (joint.kind == ScalarJoint::Kind::Distance)
    joint.distance.rows(dA, dB, list);
  else
    joint.rows.rows(joint.axes, dA, dB, list);
  return list;
}

namespace {

bool isOneSided(const PairRow<float>& row) {
  return (row.lower == 0 && row.upper == rows::kInfinity) || (row.upper == 0 && row.lower == -rows::kInfinity);
}

}  // namespace

RowForce forceOf(const PairRow<float>& row, float lambda, bool inTree) {
  const float trial = row.s * lambda + row.k * row.C;
  if (row.s == 1 && isOneSided(row)) {
    const float decides = lambda + kActiveShare * row.k * row.C;
    if (row.lower == 0 ? decides <= 0 : decides >= 0) return {};
    return inTree ? RowForce{RowKind::Exact, lambda, 0} : RowForce{RowKind::Elastic, trial, row.k};
  }
  const bool below = trial <= row.lower, above = trial >= row.upper;
  if (below || above) {
    const float bound = below ? row.lower : row.upper;
    if (bound == 0) return {};
    return {RowKind::Elastic, bound, row.k > 0 ? row.k * (bound / trial) : 0};
  }
  const bool bounded = row.lower > -rows::kInfinity && row.upper < rows::kInfinity;
  if (inTree && row.s == 1 && !bounded) return {RowKind::Exact, lambda, 0};
  return {RowKind::Elastic, trial, row.k};
}

float multiplierOf(const PairRow<float>& row, float lambda, bool inTree) {
  return rows::clamp(forceOf(row, lambda, inTree).force, row.lower, row.upper);
}

ScalarStamp stampOf(const ScalarJoint& joint, const ScalarRows& list) {
  ScalarStamp stamp;
  for (int i = 0; i < list.count; ++i) {
    const PairRow<float>& row = list.row[i];
    const RowForce force = forceOf(row, *list.lambda[i], joint.inTree);
    stamp.wrench.lin += row.lin * force.force;
    stamp.wrench.ang += row.ang * force.force;
    if (force.kind == RowKind::Elastic) addOuter(stamp.stiffness, force.k, Twist<float>{row.lin, row.ang});
  }
  return stamp;
}

void moveMultipliers(ScalarJoint& joint, const BatchView& view, float leak) {
  const ScalarRows list = rowsOf(joint, view);
  for (int i = 0; i < list.count; ++i) {
    const float force = multiplierOf(list.row[i], *list.lambda[i], joint.inTree);
    *list.lambda[i] = list.row[i].s == 1 && !joint.inTree ? leak * force : force;
  }
}

void stampScalar(const BatchView& view, float leak, bool dual, const uint8_t* active) {
  Tile<PairOp>* op = view.op + view.contacts.tiles + view.balls.tiles + view.fixed.tiles;
  for (uint32_t n = 0; n < view.scalar.count; ++n) {
    ScalarJoint& joint = view.scalar.joint[n];
    if (!active[joint.island]) continue;
    if (dual) moveMultipliers(joint, view, leak);
    const ScalarRows list = rowsOf(joint, view);
    const ScalarStamp stamp = stampOf(joint, list);
    op[n / kTile].set(static_cast<int>(n % kTile), PairOp<float>{list.armA, list.armB, stamp.stiffness});
    if (!joint.inTree) stampLoop(view, joint, list, stamp);
  }
}

void updateScalar(const BatchView& view) {
  for (uint32_t n = 0; n < view.scalar.count; ++n) moveMultipliers(view.scalar.joint[n], view, 1);
}

}  // namespace avbd
