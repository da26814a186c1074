// Rows of pulleys, couplings and users' joints: constants and remembered multipliers.
#include <array>

#include "solve/body_rows.h"
#include "solve/linked_joint.h"
#include "step/coordinate_rows.h"
#include "step/joint_side.h"
#include "world/joint_coordinates.h"
#include "world/joints.h"

namespace avbd {

namespace {

using rows::Twist;
using rows::V3;

/// J M^-1 J^T of one body. A body that stands in a row more than once is counted apart each time: an estimate.
float inverseMass(const WorldData& world, uint32_t slot, const Twist<float>& j) {
  if (!isDynamic(world, slot)) return 0;
  const BodyData& body = world.bodies[slot];
  const float linear = (body.locks & 7) == 7 ? 0 : dot(j.lin, j.lin) / body.mass;
  if ((body.locks >> 3) == 7) return linear;
  return linear + dot(j.ang, rotated(toRow(body.invInertia), toRow(body.rotation)) * j.ang);
}

float speedAlong(const WorldData& world, uint32_t slot, const Twist<float>& j) {
  if (slot == kNone) return 0;
  return dot(j.lin, toRow(world.bodies[slot].linearVelocity)) + dot(j.ang, toRow(world.bodies[slot].angularVelocity));
}

/// Sum of the bodies' inverse masses.
float masslessOf(const WorldData& world, const LinkedJoint& joint) {
  float sum = 0;
  forEachBody(world, joint.slot, [&](uint32_t slot) {
    if (isDynamic(world, slot)) sum += 1 / world.bodies[slot].mass;
  });
  return sum;
}

void fillPulley(const WorldData& world, const StepData& step, LinkedJoint& joint) {
  const JointData& data = world.joints[joint.slot];
  const LinkData& link = world.links[joint.slot];
  PulleyRows& pulley = joint.pulley;
  float w = 0, whole = 0;
  for (int i = 0; i < 2; ++i) {
    const JointSide side = jointSide(world, data, i);
    pulley.arm[i] = side.arm;
    pulley.offset[i] = toRow(side.anchor - link.wheel[i]);
    pulley.start[i] = length(pulley.offset[i]);
    const float factor = i == 0 ? 1 : link.ratio;
    whole += factor * pulley.start[i];
    const V3<float> n = pulley.offset[i] * (factor / rows::max(pulley.start[i], 1e-30f));
    w += inverseMass(world, data.body[i], {n, cross(side.arm, n)});
  }
  pulley.ratio = link.ratio, pulley.slack = link.slack;
  const float beyond = whole - link.max;
  pulley.held = beyond > 0 || !link.slack ? -corrected(step, beyond, world.def.maxDepenetrationSpeed) : -beyond;
  pulley.k = stiffnessInUse(step, w);
  pulley.load = loadInUse(step, w, masslessOf(world, joint));
  pulley.lambda = data.lambda[0];
}

void fillCoupling(const WorldData& world, StepData& step, const BatchView& view, LinkedJoint& joint) {
  const LinkData& link = world.links[joint.slot];
  CouplingRows& coupling = joint.coupling;
  for (int i = 0; i < coupling.terms; ++i) {
    const LinkTerm& from = link.terms[static_cast<size_t>(i)];
    CouplingRows::Term& term = coupling.term[i];
    const ScalarJoint& scalar = view.scalar.joint[term.scalar];
    term.axis = static_cast<int>(innerAxis(world.d6[scalar.slot], from.axis));
    term.curve = from.curve;
    coupling.start += term.curve.value(static_cast<double>(scalar.rows.axis[term.axis].start));
  }
  Twist<float> j[kLinkBodies];
  V3<float> arm[kLinkBodies];
  couplingMeasure(joint, view, j, arm);
  D6Axis axis = link.axis;
  CoordinateState at{axis, link.lambda};
  int body = 0;
  forEachBody(world, joint.slot, [&](uint32_t slot) {
    at.w += inverseMass(world, slot, j[body]);
    at.speed += speedAlong(world, slot, j[body++]);
  });
  at.chordSpeed = at.speed, at.massless = masslessOf(world, joint);
  at.lock = link.rest - coupling.start, at.force = link.force;
  at.correction = world.def.maxDepenetrationSpeed / world.def.lengthUnit;
  // Its coordinate counts from the step's start.
  const float shift = static_cast<float>(coupling.start);
  axis.limit.lower -= shift, axis.limit.upper -= shift;
  axis.drive.position -= shift, axis.spring.position -= shift;
  const float stiffness = world.joints[joint.slot].stiffness;
  if (axis.motion == AxisMotion::Locked && stiffness > 0)
    axis = {AxisMotion::Free, {}, {}, 0, {stiffness, link.damping, static_cast<float>(at.lock)}};
  coupling.axis = {};
  fillCoordinate(world, step, at, coupling.axes, coupling.axis);
}

void fillCustom(const WorldData& world, const StepData& step, const BatchView& view, LinkedJoint& joint) {
  const JointData& data = world.joints[joint.slot];
  const LinkData& link = world.links[joint.slot];
  CustomRows& custom = joint.custom;
  custom.family = link.family.get();
  custom.constants = link.constants, custom.memory = link.memory;
  custom.bodies = link.bodies, custom.rows = link.family->rowCount(), custom.h = step.h;
  for (int i = 0; i < link.bodies; ++i) {
    custom.start[i] = customBodyOf(world, data.body[i]);
    custom.center[i] = data.body[i] == kNone ? Vec3{} : world.bodies[data.body[i]].center;
  }
  for (int i = 0; i < custom.rows; ++i) custom.held[i] = custom.rho[i] = 0, custom.lambda[i] = data.lambda[i];
  LinkedRows list;
  evaluate(joint, view, list);
  const float massless = masslessOf(world, joint);
  for (int i = 0; i < custom.rows; ++i) {
    const LinkedRow& row = list.row[i];
    float w = 0;
    for (int b = 0; b < link.bodies; ++b) w += inverseMass(world, data.body[b], row.j[b]);
    custom.rho[i] = stiffnessInUse(step, w);
    if (!(row.upper < rows::kInfinity && row.lower > -rows::kInfinity))
      custom.rho[i] = rows::stiffnessUnder(custom.rho[i], loadInUse(step, w, massless), data.lambda[i]);
    // One-sided rows that do not push yet may go all the way.
    const bool open = (row.lower == 0 && row.C < 0) || (row.upper == 0 && row.C > 0);
    custom.held[i] = open ? 0 : row.C * step.alpha;
  }
}

}  // namespace

void fillLinkedJoints(const WorldData& world, StepData& step) {
  for (size_t batch = 0; batch < step.batches.size(); ++batch) {
    const BatchView view = step.view(batch);
    for (uint32_t i = 0; i < view.linked.count; ++i) {
      LinkedJoint& joint = view.linked.joint[i];
      if (joint.kind == LinkedJoint::Kind::Pulley) fillPulley(world, step, joint);
      if (joint.kind == LinkedJoint::Kind::Coupling) fillCoupling(world, step, view, joint);
      if (joint.kind == LinkedJoint::Kind::Custom) fillCustom(world, step, view, joint);
    }
  }
}

}  // namespace avbd
