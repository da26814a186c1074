// Rows of hinges, sliders, D6 and distance joints: constants and remembered multipliers.
#include "solve/scalar_joint.h"
#include "step/coordinate_rows.h"
#include "step/joint_side.h"
#include "world/joints.h"

namespace avbd {

namespace {

using rows::Twist;
using rows::V3;

/// What all coordinates of one joint share.
struct Frame {
  JointSide a, b;
  rows::D6Measure<float> at;  ///< at the start of the step
  Twist<float> velocityA, velocityB;
  bool inTree;
};

Twist<float> velocityOf(const WorldData& world, uint32_t body) {
  if (body == kNone) return rows::zeroTwist<float>();
  return {toRow(world.bodies[body].linearVelocity), toRow(world.bodies[body].angularVelocity)};
}

float inverseMassAlong(const JointSide& side, const Twist<float>& j) {
  return side.invMass * dot(j.lin, j.lin) + dot(j.ang, side.invInertia * j.ang);
}

/// Inverse mass that a row feels, and the speed of what it measures.
struct Felt {
  float w = 0, speed = 0;
};
Felt feltBy(const Frame& frame, const V3<float>& lin, const V3<float>& ang) {
  const Twist<float> onA = shiftWrench(Twist<float>{lin, ang}, frame.at.armA);
  const Twist<float> onB = shiftWrench(Twist<float>{lin, ang}, frame.at.armB);
  return {inverseMassAlong(frame.a, onA) + inverseMassAlong(frame.b, onB),
          dot(onA.lin, frame.velocityA.lin) + dot(onA.ang, frame.velocityA.ang) - dot(onB.lin, frame.velocityB.lin) -
              dot(onB.ang, frame.velocityB.ang)};
}

/// From where the bodies would have come at their velocities.
float chordSpeed(const StepData& step, const Frame& frame, const rows::D6Joint<float>& rows, int i) {
  float before[6];
  rows.coordinates(frame.velocityA * -step.h, frame.velocityB * -step.h, before);
  return (rows.axis[i].start - before[i]) / step.h;
}

void fillAxis(const WorldData& world, const StepData& step, const Frame& frame, const D6Data& data, int i,
              ScalarJoint& joint) {
  const Felt felt = feltBy(frame, frame.at.lin[i], frame.at.ang[i]);
  CoordinateState at{data.axis[i], data.lambda[i]};
  at.chordSpeed = data.axis[i].armature > 0 ? chordSpeed(step, frame, joint.rows, i) : felt.speed;
  at.massless = frame.a.invMass + frame.b.invMass;
  at.axis = i, at.speed = felt.speed, at.w = felt.w, at.force = data.force[i], at.inTree = frame.inTree;
  at.correction = world.def.maxDepenetrationSpeed / (i < 3 ? 1 : world.def.lengthUnit);
  fillCoordinate(world, step, at, joint.axes, joint.rows.axis[i]);
}

void fillCone(const WorldData& world, const StepData& step, const Frame& frame, const D6Data& data,
              ScalarJoint& joint) {
  const SwingCone& cone = data.cone;
  if (!(cone.y < rows::kInfinity) && !(cone.z < rows::kInfinity)) return;
  joint.axes.cone = true;
  rows::D6Cone<float>& row = joint.rows.cone;
  const float y = frame.at.q[4], z = frame.at.q[5];
  row.inverseY = 1 / cone.y, row.inverseZ = 1 / cone.z;
  const float n = joint.rows.coneMeasure(y, z), swing = rows::sqrt(y * y + z * z);
  row.scale = n > 1e-3f ? swing / n : rows::min(cone.y, cone.z);
  const float beyond = rows::max(n - 1, 0.0f) * row.scale;
  const float rho = stiffnessInUse(step, feltBy(frame, frame.at.lin[4], frame.at.ang[4]).w);
  row.k = rho, row.s = 1;
  row.lambda = data.coneLambda;
  row.upper = 1;
  if (cone.stiffness > 0) {
    const float whole = cone.stiffness + (beyond > 0 ? cone.damping / step.h : 0);
    if (beyond > 0) row.upper = n - beyond / row.scale * (cone.stiffness / whole);
    const ElasticRow e = elasticRow(whole, rho, frame.inTree);
    row.k = e.k, row.s = e.s;
  } else if (beyond > 0) {
    const float speed = world.def.maxDepenetrationSpeed / world.def.lengthUnit;
    row.upper = n - corrected(step, beyond, speed) / row.scale;
  }
}

void fillSlerp(const StepData& step, const Frame& frame, const D6Data& data, ScalarJoint& joint) {
  const SlerpDrive& drive = data.slerp;
  const V3<float>& axis = frame.at.ang[3];
  const float w = dot(axis, frame.a.invInertia * axis) + dot(axis, frame.b.invInertia * axis);
  const float inertia = drive.acceleration && w > 0 ? 1 / w : 1;
  const float whole = (drive.stiffness + drive.damping / step.h) * inertia;
  if (!(whole > 0)) return;
  joint.axes.slerp = true;
  rows::D6Slerp<float>& row = joint.rows.slerp;
  row.rotation = toRow(drive.rotation);
  const Twist<float> still = rows::zeroTwist<float>();
  const V3<float> start = joint.rows.slerpMeasure(still, still);
  row.target = start + (toRow(drive.velocity) * drive.damping - start * drive.stiffness) * (inertia / whole);
  const ElasticRow e = elasticRow(whole, stiffnessInUse(step, w), frame.inTree);
  row.k = e.k, row.s = e.s, row.most = drive.maxForce;
  row.lambda = toRow(data.slerpLambda);
}

void findCoordinates(const D6Data& data, rows::D6Joint<float>& rows) {
  const Twist<float> still = rows::zeroTwist<float>();
  float q[6];
  rows.axis[3].start = 0;
  rows.coordinates(still, still, q);
  q[3] = rows.twistAtStart();
  for (int i = 0; i < 6; ++i) rows.axis[i].start = q[i];
  if (data.twistKnown) rows.axis[3].start = data.twist + rows::withinHalfTurn(q[3] - data.twist);
}

float blendOf(const WorldData& world, const StepData& step, const JointData& joint, const Frame& frame) {
  if (world.def.jointArmBlend >= 0) return world.def.jointArmBlend;
  const V3<float> force{joint.lambda[0], joint.lambda[1], joint.lambda[2]};
  return armBlend(step, frame.a, frame.b, length(force));
}

/// Places the rows of a joint, which hold nothing else then.
template <class Rows>
Frame place(const WorldData& world, const StepData& step, const ScalarJoint& joint, Rows& rows) {
  const JointData& data = world.joints[joint.slot];
  const Frame frame{jointSide(world, data, 0),       jointSide(world, data, 1),       {},
                    velocityOf(world, data.body[0]), velocityOf(world, data.body[1]), joint.inTree};
  rows = {};
  rows.armA = frame.a.arm, rows.armB = frame.b.arm;
  rows.offset = toRow(frame.b.anchor - frame.a.anchor);
  rows.tau = blendOf(world, step, data, frame);
  rows.adapts = world.def.jointArmBlend < 0 ? 1 : 0;
  return frame;
}

void fillD6(const WorldData& world, const StepData& step, ScalarJoint& joint) {
  const D6Data& d6 = world.d6[joint.slot];
  rows::D6Joint<float>& rows = joint.rows;
  Frame frame = place(world, step, joint, rows);
  rows.qA = frame.a.axes, rows.qB = frame.b.axes;
  findCoordinates(d6, rows);
  const Twist<float> still = rows::zeroTwist<float>();
  frame.at = rows.measure(still, still);
  joint.axes = {};
  // Locked swings are measured by their sines.
  if (d6.axis[4].motion == AxisMotion::Locked) rows.axis[4].start = -frame.at.z;
  if (d6.axis[5].motion == AxisMotion::Locked) rows.axis[5].start = frame.at.y;
  for (int i = 0; i < 6; ++i) fillAxis(world, step, frame, d6, i, joint);
  fillCone(world, step, frame, d6, joint);
  fillSlerp(step, frame, d6, joint);
  const V3<float> turned = logQuat(rows.qA * conjugate(rows.qB));
  rows.logHeld = turned - corrected(step, turned, world.def.maxDepenetrationSpeed / world.def.lengthUnit);
}

/// A range of one length is a rod.
void fillDistance(const WorldData& world, const StepData& step, ScalarJoint& joint) {
  const JointData& data = world.joints[joint.slot];
  const LinkData& link = world.links[joint.slot];
  rows::Distance<float>& rows = joint.distance;
  Frame frame = place(world, step, joint, rows);
  rows.start = length(rows.offset);
  rows.direction = rows.start > 0 ? rows.offset * (1 / rows.start) : V3<float>{0, -1, 0};
  frame.at.armA = rows.armA + rows.offset, frame.at.armB = rows.armB;
  const Felt felt = feltBy(frame, -rows.direction, rows::zeroV3<float>());
  const auto across = [](const JointSide& side) { return side.invMass + side.turning * dot(side.arm, side.arm); };
  rows.swing = step.h * step.h * (across(frame.a) + across(frame.b));
  const D6Axis axis{AxisMotion::Free, {link.min, link.max, data.stiffness, link.damping}, {}, 0};
  CoordinateState at{axis, link.lambda};
  at.speed = at.chordSpeed = felt.speed, at.w = felt.w, at.inTree = frame.inTree,
  at.correction = world.def.maxDepenetrationSpeed, at.massless = frame.a.invMass + frame.b.invMass;
  rows::D6Axes axes;
  rows::D6Axis<float> x{};
  x.start = rows.start;
  fillCoordinate(world, step, at, axes, x);
  rows.k = x.k, rows.s = x.s, rows.load = x.load, rows.lower = x.lower, rows.upper = x.upper;
  rows.lambdaLower = x.lambdaLower, rows.lambdaUpper = x.lambdaUpper;
  rows.hasLower = link.min > 0 ? 1 : 0, rows.hasUpper = link.max < rows::kInfinity ? 1 : 0;
  if (link.min < link.max) return;
  rows.rigid = 1;
  rows.upper = rows.start - corrected(step, rows.start - link.max, at.correction);
  if (data.stiffness > 0) {
    const float whole = data.stiffness + link.damping / step.h;
    const ElasticRow e = elasticRow(whole, stiffnessInUse(step, felt.w), frame.inTree);
    rows.k = e.k, rows.s = e.s, rows.load = 0;
    rows.upper = rows.start - (rows.start - link.max) * (data.stiffness / whole);
  }
  rows.lambdaUpper = link.lambda.lock + link.lambda.lower + link.lambda.upper;
}

}  // namespace

void fillScalarJoints(const WorldData& world, StepData& step) {
  for (const BatchRange& batch : step.batches)
    for (uint32_t i = 0; i < batch.scalarCount; ++i) {
      ScalarJoint& joint = step.scalar[batch.scalarTile * kTile + i];
      joint.kind == ScalarJoint::Kind::D6 ? fillD6(world, step, joint) : fillDistance(world, step, joint);
    }
  // Lanes that stand for nothing.
  for (const BatchRange& batch : step.batches) {
    const size_t first = size_t(batch.contactTile) + batch.contactTiles + batch.ballTile + batch.ballTiles +
                         batch.fixedTile + batch.fixedTiles + batch.scalarTile;
    for (uint32_t lane = batch.scalarCount; lane < batch.scalarTiles * kTile; ++lane)
      step.op[first + lane / kTile].set(static_cast<int>(lane % kTile), PairOp<float>{});
  }
}

}  // namespace avbd
