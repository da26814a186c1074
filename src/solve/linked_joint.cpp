// Joints over any number of bodies: rows, forces and products (linked_joint.h).
#include "solve/linked_joint.h"

#include <array>

#include "solve/body_rows.h"
#include "solve/geometric.h"

namespace avbd {

namespace {

using rows::Twist;
using rows::V3;

float apply(const Twist<float>& j, const Twist<float>& motion) {
  return dot(j.lin, motion.lin) + dot(j.ang, motion.ang);
}

void clear(Twist<float> (&j)[kLinkBodies]) {
  for (Twist<float>& t : j) t = rows::zeroTwist<float>();
}

/// What a pulled line resists with across itself: stiffness without a force.
void addAcross(PulleyRows& pulley, int side, const V3<float>& n, const V3<float>& arm, float size, LinkedRows& out) {
  const float factor = side == 0 ? 1 : pulley.ratio;
  const float k = rows::max(pulley.lambda, 0.0f) * factor / rows::max(size, 1e-30f);
  if (!(k > 0)) return;
  V3<float> across[2];
  orthonormalBasis(n * (1 / factor), across[0], across[1]);
  for (int i = 0; i < 2; ++i) {
    LinkedRow& row = out.row[out.count++];
    clear(row.j);
    row.C = 0, row.k = k, row.s = 0, row.lower = -rows::kInfinity, row.upper = rows::kInfinity;
    row.lambda = &pulley.lambdaAcross[2 * side + i];
    row.j[side] = {across[i], cross(arm, across[i])};
  }
}

void pulleyRows(LinkedJoint& joint, const BatchView& view, LinkedRows& out) {
  PulleyRows& pulley = joint.pulley;
  LinkedRow& row = out.row[0];
  out.count = 1;
  clear(row.j);
  float grown = 0;
  for (int i = 0; i < 2; ++i) {
    const Twist<float> d = readTwist(view.d, joint.row[i]);
    const V3<float> arm = out.arm[i] = rotate(rows::expQuat(d.ang), pulley.arm[i]);
    const V3<float> moved = d.lin + arm - pulley.arm[i], end = pulley.offset[i] + moved;
    const float size = length(end), factor = i == 0 ? 1 : pulley.ratio;
    grown += factor * dot(moved, end + pulley.offset[i]) / rows::max(size + pulley.start[i], 1e-30f);
    const V3<float> n = end * (factor / rows::max(size, 1e-30f));
    row.j[i] = {n, cross(arm, n)};
    addAcross(pulley, i, n, arm, size, out);
  }
  row.C = grown - pulley.held;
  row.k = rows::stiffnessUnder(pulley.k, pulley.load, pulley.lambda), row.s = 1;
  row.lower = pulley.slack ? 0 : -rows::kInfinity, row.upper = rows::kInfinity;
  row.lambda = &pulley.lambda;
}

void couplingRows(LinkedJoint& joint, const BatchView& view, LinkedRows& out) {
  CouplingRows& coupling = joint.coupling;
  Twist<float> j[kLinkBodies];
  const float q = couplingMeasure(joint, view, j, out.arm);
  out.count = 0;
  axisRows(coupling.axes, 0, coupling.axis, q, [&](float C, float k, float s, float lower, float upper, float& lambda) {
    LinkedRow& row = out.row[out.count++];
    row.C = C, row.k = k, row.s = s, row.lower = lower, row.upper = upper, row.lambda = &lambda;
    for (int i = 0; i < joint.bodies; ++i) row.j[i] = j[i];
  });
}

void customRows(LinkedJoint& joint, const BatchView& view, LinkedRows& out) {
  CustomRows& custom = joint.custom;
  std::array<CustomBody, 4> now;
  for (int i = 0; i < custom.bodies; ++i)
    now[static_cast<size_t>(i)] = customBody(custom, i, readTwist(view.d, joint.row[i]));
  std::array<CustomRow, kCustomRows> given{};
  const size_t bodies = static_cast<size_t>(custom.bodies), count = static_cast<size_t>(custom.rows);
  custom.family->evaluate({now.data(), bodies}, {custom.start, bodies}, custom.h, custom.constants, custom.memory,
                          {given.data(), count});
  out.count = custom.rows;
  for (int i = 0; i < custom.rows; ++i) {
    const CustomRow& from = given[static_cast<size_t>(i)];
    LinkedRow& row = out.row[i];
    const bool hard = !(from.stiffness > 0);
    const float rho = custom.rho[i], sum = from.stiffness + rho;
    row.C = static_cast<float>(hard ? from.C - static_cast<double>(custom.held[i]) : from.C);
    row.k = hard ? rho : sum > 0 ? from.stiffness * (rho / sum) : 0;
    row.s = hard ? 1 : sum > 0 ? from.stiffness / sum : 0;
    row.lower = from.lower, row.upper = from.upper, row.lambda = &custom.lambda[i];
    for (size_t b = 0; b < bodies; ++b) {
      const Vec3 lin = from.linear[b], ang = from.angular[b];
      row.j[b] = {{lin.x, lin.y, lin.z}, {ang.x, ang.y, ang.z}};
    }
  }
}

/// J times an array of body rows, over the bodies that move.
float moved(const LinkedJoint& joint, const LinkedRow& row, const BatchView& view, const float* array) {
  float sum = 0;
  for (int b = 0; b < joint.bodies; ++b)
    if (joint.row[b] < view.bodies) sum += apply(row.j[b], readTwist(array, joint.row[b]));
  return sum;
}

/// J k J^T of one body's block.
rows::Sym6<float> blockOf(float k, const Twist<float>& j) {
  rows::Sym6<float> block = rows::zeroSym6<float>();
  addOuter(block, k, j);
  return block;
}

void stamp(const BatchView& view, LinkedJoint& joint) {
  evaluate(joint, view, joint.stamped);
  for (int i = 0; i < joint.stamped.count; ++i) {
    LinkedRow& row = joint.stamped.row[i];
    const RowForce force = forceOf(row);
    row.k = force.k, row.force = force.force;
    for (int b = 0; b < joint.bodies; ++b) {
      addTwist(view.gradient, joint.row[b], row.j[b] * force.force);
      addAngular(view, joint.row[b], rows::geometricStiffness(row.j[b].lin * -force.force, joint.stamped.arm[b]));
      if (force.k > 0 && joint.first[b] == b)
        addBlock(view.hessian, joint.row[b], blockOf(force.k, jacobianOf(joint, row, b)));
    }
  }
}

}  // namespace

RowForce forceOf(const LinkedRow& row) {
  const rows::PairRow<float> of = withoutJacobian(row);
  const bool bounded = row.lower > -rows::kInfinity && row.upper < rows::kInfinity;
  // A hard row is at its bound where the force that it needs is, not where its stiffness would take it.
  const float needs = *row.lambda + kActiveShare * row.k * row.C;
  if (row.s == 1 && bounded && needs > row.lower && needs < row.upper)
    return {RowKind::Elastic, *row.lambda + row.k * row.C, row.k};
  return forceOf(of, *row.lambda, false);
}

float couplingMeasure(const LinkedJoint& joint, const BatchView& view, Twist<float> (&j)[kLinkBodies],
                      V3<float> (&arm)[kLinkBodies]) {
  const CouplingRows& coupling = joint.coupling;
  clear(j);
  double sum = 0;
  for (int i = 0; i < coupling.terms; ++i) {
    const CouplingRows::Term& term = coupling.term[i];
    const ScalarJoint& scalar = view.scalar.joint[term.scalar];
    const rows::D6Measure<float> m =
        scalar.rows.measure(readTwist(view.d, scalar.rowA), readTwist(view.d, scalar.rowB));
    const double q = static_cast<double>(m.q[term.axis]);
    sum += term.curve.value(q);
    const float slope = static_cast<float>(term.curve.slope(q));
    const Twist<float> wrench{m.lin[term.axis] * slope, m.ang[term.axis] * slope};
    j[2 * i] = shiftWrench(wrench, m.armA);
    j[2 * i + 1] = -shiftWrench(wrench, m.armB);
    arm[2 * i] = m.armA, arm[2 * i + 1] = m.armB;
  }
  return static_cast<float>(sum - coupling.start);
}

Twist<float> jacobianOf(const LinkedJoint& joint, const LinkedRow& row, int body) {
  Twist<float> sum = rows::zeroTwist<float>();
  for (int b = 0; b < joint.bodies; ++b)
    if (joint.first[b] == body) sum += row.j[b];
  return sum;
}

Twist<float> reactionOf(const LinkedJoint& joint) {
  Twist<float> sum = rows::zeroTwist<float>();
  for (int i = 0; i < joint.stamped.count; ++i) sum += joint.stamped.row[i].j[0] * *joint.stamped.row[i].lambda;
  return sum;
}

CustomBody customBody(const CustomRows& custom, int body, const Twist<float>& moved) {
  const CustomBody& start = custom.start[body];
  CustomBody now;
  const rows::Q4<float> turn = rows::expQuat(moved.ang);
  now.center = start.center + Vec3d{moved.lin.x, moved.lin.y, moved.lin.z};
  now.pose.rotation = Quat{turn.w, turn.x, turn.y, turn.z} * start.pose.rotation;
  now.pose.position = now.center - rotate(now.pose.rotation, toDouble(custom.center[body]));
  return now;
}

void evaluate(LinkedJoint& joint, const BatchView& view, LinkedRows& out) {
  if (joint.kind == LinkedJoint::Kind::Pulley) return pulleyRows(joint, view, out);
  if (joint.kind == LinkedJoint::Kind::Coupling) return couplingRows(joint, view, out);
  customRows(joint, view, out);
}

void moveMultipliers(LinkedJoint& joint, const BatchView& view, float leak) {
  LinkedRows list;
  evaluate(joint, view, list);
  for (int i = 0; i < list.count; ++i) {
    const LinkedRow& row = list.row[i];
    const float force = multiplierOf(withoutJacobian(row), *row.lambda, false);
    *row.lambda = row.s == 1 ? leak * force : force;
  }
}

void stampLinked(const BatchView& view, float leak, const uint8_t* active) {
  for (uint32_t n = 0; n < view.linked.count; ++n) {
    LinkedJoint& joint = view.linked.joint[n];
    if (!active[joint.island]) continue;
    for (int i = 0; i < joint.stamped.count; ++i)
      if (joint.stamped.row[i].s == 1) *joint.stamped.row[i].lambda *= leak;
    stamp(view, joint);
  }
}

void takeLinkedForces(const BatchView& view, const uint8_t* active) {
  for (uint32_t n = 0; n < view.linked.count; ++n) {
    const LinkedJoint& joint = view.linked.joint[n];
    if (!active[joint.island]) continue;
    for (int i = 0; i < joint.stamped.count; ++i) {
      const LinkedRow& row = joint.stamped.row[i];
      *row.lambda = rows::clamp(row.force + row.k * moved(joint, row, view, view.x), row.lower, row.upper);
    }
  }
}

void multiplyLinked(const BatchView& view, const uint8_t* active) {
  for (uint32_t n = 0; n < view.linked.count; ++n) {
    const LinkedJoint& joint = view.linked.joint[n];
    if (!active[joint.island]) continue;
    for (int i = 0; i < joint.stamped.count; ++i) {
      const LinkedRow& row = joint.stamped.row[i];
      if (!(row.k > 0)) continue;
      const float sum = moved(joint, row, view, view.p);
      for (int b = 0; b < joint.bodies; ++b)
        if (joint.row[b] < view.bodies) addTwist(view.q, joint.row[b], row.j[b] * (row.k * sum));
    }
  }
}

void updateLinked(const BatchView& view) {
  for (uint32_t n = 0; n < view.linked.count; ++n) moveMultipliers(view.linked.joint[n], view, 1);
}

}  // namespace avbd
