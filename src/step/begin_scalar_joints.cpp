// Rows of hinges, sliders and D6 joints: constants and remembered multipliers.
#include "solve/scalar_joint.h"
#include "step/joint_side.h"
#include "world/joints.h"

namespace avbd {

namespace {

using rows::V3;

/// What all coordinates of one joint share.
struct Frame {
  JointSide a, b;
  V3<float> axis[3];     ///< of frame A, world
  V3<float> armA, armB;  ///< to frame B's origin
  bool inTree;
};

float inverseMassAlong(const JointSide& side, const V3<float>& arm, const V3<float>& direction) {
  const V3<float> turn = cross(arm, direction);
  return side.invMass + dot(turn, side.invInertia * turn);
}

/// Inverse mass that the rows of a coordinate feel.
float inverseMassOf(const Frame& frame, int i) {
  const V3<float>& axis = frame.axis[i % 3];
  if (i < 3) return inverseMassAlong(frame.a, frame.armA, axis) + inverseMassAlong(frame.b, frame.armB, axis);
  return dot(axis, frame.a.invInertia * axis) + dot(axis, frame.b.invInertia * axis);
}

struct Elastic {
  float k = 0, s = 0;
};

/// A row of finite stiffness: exact at once in a tree; elsewhere its stiffness in use is bounded by rho, and its
/// multiplier finds the rest.
Elastic elastic(float stiffness, float rho, bool inTree) {
  if (inTree || !(rho > 0)) return {stiffness, 0};
  return {stiffness * (rho / (stiffness + rho)), stiffness / (stiffness + rho)};
}

/// speed: at which what lies beyond a stop is brought back at most, in the coordinate's unit.
void fillLimit(const StepData& step, const JointLimit& limit, rows::D6Axis<float>& x, float rho, bool inTree,
               float speed) {
  x.k = rho, x.s = 1;
  // Inside, the stop is where it is; beyond it, a part of the way back is asked for.
  const float below = std::min(x.start - limit.lower, 0.0f), above = std::max(x.start - limit.upper, 0.0f);
  if (limit.stiffness <= 0) {
    x.lower = below < 0 ? x.start - corrected(step, below, speed) : limit.lower;
    x.upper = above > 0 ? x.start - corrected(step, above, speed) : limit.upper;
    return;
  }
  const bool beyond = below < 0 || above > 0;
  const float damping = beyond ? limit.damping / step.h : 0, whole = limit.stiffness + damping;
  const float share = limit.stiffness / whole;
  x.lower = below < 0 ? x.start - below * share : limit.lower;
  x.upper = above > 0 ? x.start - above * share : limit.upper;
  const Elastic e = elastic(whole, rho, inTree);
  x.k = e.k, x.s = e.s;
}

void fillDrive(const StepData& step, const JointDrive& drive, rows::D6Axis<float>& x, float rho, float w, bool inTree) {
  const float scale = drive.acceleration && w > 0 ? 1 / w : 1;
  const float stiffness = drive.stiffness * scale, damping = drive.damping * scale;
  const float whole = stiffness + damping / step.h;
  const Elastic e = elastic(whole, rho, inTree);
  x.kDrive = e.k, x.sDrive = e.s, x.driveMost = drive.maxForce;
  x.target = x.start + (stiffness * (drive.position - x.start) + damping * drive.velocity) / whole;
}

bool isLimited(const JointLimit& limit) { return limit.lower > -rows::kInfinity || limit.upper < rows::kInfinity; }

void fillAxis(const WorldData& world, const StepData& step, const Frame& frame, const D6Data& data, int i,
              ScalarJoint& joint) {
  const D6Axis& axis = data.axis[i];
  rows::D6Axis<float>& x = joint.rows.axis[i];
  const float w = inverseMassOf(frame, i), rho = w > 0 ? kJointFactor / (w * step.h * step.h) : 0;
  const float speed = world.def.maxDepenetrationSpeed / (i < 3 ? 1 : world.def.lengthUnit);
  const auto bit = static_cast<uint8_t>(1 << i);
  const D6Data::Multipliers& l = data.lambda[i];
  x.lambda = l.lock, x.lambdaLower = l.lower, x.lambdaUpper = l.upper;
  x.lambdaDrive = l.drive, x.lambdaFriction = l.friction;
  x.k = rho, x.s = 1;
  if (axis.motion == AxisMotion::Locked) {
    joint.axes.locked |= bit;
    x.held = x.start - corrected(step, x.start, speed);
    return;
  }
  if (isLimited(axis.limit)) {
    joint.axes.limited |= bit;
    fillLimit(step, axis.limit, x, rho, frame.inTree, speed);
  }
  if (axis.drive.stiffness > 0 || axis.drive.damping > 0) {
    joint.axes.driven |= bit;
    fillDrive(step, axis.drive, x, rho, w, frame.inTree);
  }
  if (axis.friction > 0) {
    joint.axes.rubbing |= bit;
    x.kFriction = rho, x.frictionMost = axis.friction;
  }
}

void findCoordinates(const D6Data& data, rows::D6Joint<float>& rows) {
  const rows::Twist<float> still = rows::zeroTwist<float>();
  float q[6];
  rows.axis[3].start = rows.rawTwist = 0;
  rows.coordinates(still, still, q);
  rows.rawTwist = q[3];
  for (int i = 0; i < 6; ++i) rows.axis[i].start = q[i];
  if (data.twistKnown) rows.axis[3].start = data.twist + rows::withinHalfTurn(q[3] - data.twist);
}

void fillScalarJoint(const WorldData& world, const StepData& step, ScalarJoint& joint) {
  const JointData& data = world.joints[joint.slot];
  const D6Data& d6 = world.d6[joint.slot];
  Frame frame{jointSide(world, data, 0), jointSide(world, data, 1), {}, {}, {}, joint.inTree};
  rows::D6Joint<float>& rows = joint.rows;
  rows = {};
  rows.armA = frame.a.arm, rows.armB = frame.b.arm;
  rows.qA = frame.a.axes, rows.qB = frame.b.axes;
  rows.offset = toRow(frame.b.anchor - frame.a.anchor);
  frame.armA = rows.armA + rows.offset, frame.armB = rows.armB;
  const V3<float> unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) frame.axis[i] = rotate(rows.qA, unit[i]);
  const V3<float> force{data.lambda[0], data.lambda[1], data.lambda[2]};
  rows.tau = world.def.jointArmBlend >= 0 ? world.def.jointArmBlend : armBlend(step, frame.a, frame.b, length(force));
  findCoordinates(d6, rows);
  joint.axes = {};
  for (int i = 0; i < 6; ++i) fillAxis(world, step, frame, d6, i, joint);
  const V3<float> turned = logQuat(rows.qA * conjugate(rows.qB));
  rows.logHeld = turned - corrected(step, turned, world.def.maxDepenetrationSpeed / world.def.lengthUnit);
}

}  // namespace

void fillScalarJoints(const WorldData& world, StepData& step) {
  for (const BatchRange& batch : step.batches)
    for (uint32_t i = 0; i < batch.scalarCount; ++i)
      fillScalarJoint(world, step, step.scalar[batch.scalarTile * kTile + i]);
  // Lanes that stand for nothing.
  for (const BatchRange& batch : step.batches) {
    const size_t first = size_t(batch.contactTile) + batch.contactTiles + batch.ballTile + batch.ballTiles +
                         batch.fixedTile + batch.fixedTiles + batch.scalarTile;
    for (uint32_t lane = batch.scalarCount; lane < batch.scalarTiles * kTile; ++lane)
      step.op[first + lane / kTile].set(static_cast<int>(lane % kTile), PairOp<float>{});
  }
}

}  // namespace avbd
