// Block Gauss-Seidel: the order of things.
#include "solve/sweep.h"

#include <algorithm>

#include "solve/body_rows.h"
#include "solve/geometric.h"
#include "solve/linked_joint.h"
#include "solve/locks.h"
#include "solve/scalar_joint.h"
#include "solve/swept_contact.h"

namespace avbd {

namespace {

/// Adds a scalar joint to those of its bodies that this colour moves, by place.
void stampScalarSides(const BatchView& view, ScalarJoint& joint, const Colors& colors, uint32_t color,
                      const SweepPlan& plan) {
  const auto moves = [&](uint32_t row) { return row < view.bodies && colors.of[row] == color; };
  const bool a = moves(joint.rowA), b = moves(joint.rowB);
  if (!a && !b) return;
  const ScalarRows list = rowsOf(joint, view);
  const ScalarStamp stamp = stampOf(joint, list);
  const auto add = [&](uint32_t row, const rows::V3<float>& arm, const rows::Twist<float>& wrench) {
    const uint32_t place = plan.placeOf(row);
    rows::Sym6<float> block = shifted(stamp.stiffness, arm);
    block.aa = block.aa + rows::geometricStiffness(-wrench.lin, arm);
    addTwist(view.gradient, place, shiftWrench(wrench, arm));
    addBlock(view.hessian, place, block);
  };
  if (a) add(joint.rowA, list.armA, stamp.wrench);
  if (b) add(joint.rowB, list.armB, -stamp.wrench);
}

/// The same of a joint over any number of bodies.
void stampLinkedSides(const BatchView& view, LinkedJoint& joint, const Colors& colors, uint32_t color,
                      const SweepPlan& plan) {
  const auto moves = [&](uint32_t row) { return row < view.bodies && colors.of[row] == color; };
  if (std::none_of(joint.row, joint.row + joint.bodies, moves)) return;
  evaluate(joint, view, joint.stamped);
  for (int i = 0; i < joint.stamped.count; ++i) {
    const LinkedRow& row = joint.stamped.row[i];
    const RowForce force = forceOf(row);
    for (int b = 0; b < joint.bodies; ++b) {
      if (!moves(joint.row[b]) || joint.first[b] != b) continue;
      const rows::Twist<float> j = jacobianOf(joint, row, b);
      rows::Sym6<float> block = rows::zeroSym6<float>();
      addOuter(block, force.k, j);
      addTwist(view.gradient, plan.placeOf(joint.row[b]), j * force.force);
      addBlock(view.hessian, plan.placeOf(joint.row[b]), block);
    }
  }
}

}  // namespace

void solveSweep(const BatchView& view, const Backend& backend, const SolveSettings& settings, const Colors& colors,
                SweepPlan& plan) {
  plan.build(view, colors);
  const SweepView sweep = plan.view();
  for (int i = 0; i < settings.iterations; ++i) {
    if (i > 0) lineariseSwept(view);
    backend.stageRecords(view, sweep, settings, i > 0);
    // Always in the same order. To and fro, the last colour would be the next iteration's first, where little has moved
    // since: with the few colours of a pile that wastes a good part of the work (docs/performance.md).
    if (i > 0) {
      for (uint32_t n = 0; n < view.scalar.count; ++n) moveMultipliers(view.scalar.joint[n], view, settings.jointLeak);
      for (uint32_t n = 0; n < view.linked.count; ++n) moveMultipliers(view.linked.joint[n], view, settings.jointLeak);
    }
    for (uint32_t c = 0; c < plan.colors().size(); ++c) {
      const SweepColor& color = plan.colors()[c];
      backend.stampColor(view, sweep, color);
      for (uint32_t n = 0; n < view.scalar.count; ++n) stampScalarSides(view, view.scalar.joint[n], colors, c, plan);
      for (uint32_t n = 0; n < view.linked.count; ++n) stampLinkedSides(view, view.linked.joint[n], colors, c, plan);
      if (color.lockedCount) applyLocks(plan.lockedIn(view, color));
      backend.solveColor(view, sweep, color);
    }
  }
}

}  // namespace avbd
