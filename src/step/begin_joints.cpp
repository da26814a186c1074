// Joint rows: constants and remembered multipliers, in exact trees and in tiles.
#include <algorithm>

#include "step/begin_rows.h"
#include "step/coordinate_rows.h"
#include "step/joint_side.h"

namespace avbd {

namespace {

/// Nets are made of ball joints, and conjugate gradients solve them; a little less stiff under load, they converge
/// better.
constexpr float kBallShare = 0.75f;

rows::FixedJoint<float> jointRows(const WorldData& world, const StepData& step, const JointData& joint) {
  const JointSide a = jointSide(world, joint, 0), b = jointSide(world, joint, 1);
  rows::FixedJoint<float> rows{};
  rows.ball.rA = a.arm, rows.ball.rB = b.arm;
  const float speed = world.def.maxDepenetrationSpeed;
  rows.ball.bias = corrected(step, toRow(a.anchor - b.anchor), speed);
  rows.ball.lambda = {joint.lambda[0], joint.lambda[1], joint.lambda[2]};
  rows.ball.adapts = world.def.jointArmBlend < 0 ? 1 : 0;
  rows.ball.tau =
      world.def.jointArmBlend >= 0 ? world.def.jointArmBlend : armBlend(step, a, b, length(rows.ball.lambda));
  const float w = a.invMass + b.invMass + a.turning * dot(a.arm, a.arm) + b.turning * dot(b.arm, b.arm);
  rows.ball.k = stiffnessInUse(step, w);
  rows.ball.load = kBallShare * loadInUse(step, w, a.invMass + b.invMass);
  if (joint.type != JointType::Fixed) return rows;
  rows.q0 = a.axes * conjugate(b.axes);
  const rows::V3<float> turned = logQuat(rows.q0);
  rows.held = turned - corrected(step, turned, speed / world.def.lengthUnit);
  rows.lambda = {joint.lambda[3], joint.lambda[4], joint.lambda[5]};
  const rows::Sym3<float> turning = a.invInertia + b.invInertia;
  const float wAngular = (turning.xx + turning.yy + turning.zz) / 3;
  rows.kAngular = stiffnessInUse(step, wAngular);
  rows.load = loadInUse(step, wAngular, a.invMass + b.invMass);
  return rows;
}

constexpr float kTetFactor = 1000;  ///< as kJointFactor, for what conjugate gradients alone solve

double volumeOf(const WorldData& world, const JointData& joint) {
  const auto edge = [&](int i) { return world.bodies[joint.body[i]].position - world.bodies[joint.body[0]].position; };
  const Vec3d b = edge(1), c = edge(2), d = edge(3);
  return dot(b, Vec3d{c.y * d.z - c.z * d.y, c.z * d.x - c.x * d.z, c.x * d.y - c.y * d.x}) / 6;
}

rows::TetVolume<float> tetRows(const WorldData& world, const StepData& step, const JointData& joint) {
  const auto edge = [&](int i) {
    return toRow(world.bodies[joint.body[i]].position - world.bodies[joint.body[0]].position);
  };
  rows::TetVolume<float> tet{};
  tet.ab = edge(1), tet.ac = edge(2), tet.ad = edge(3);
  const rows::V3<float> jb = cross(tet.ac, tet.ad), jc = cross(tet.ad, tet.ab), jd = cross(tet.ab, tet.ac);
  const rows::V3<float> j[4] = {-(jb + jc + jd), jb, jc, jd};
  float w = 0;
  for (int i = 0; i < 4; ++i) {
    const BodyData& body = world.bodies[joint.body[i]];
    if (body.type == BodyType::Dynamic) w += dot(j[i], j[i]) / (36 * body.mass);
  }
  const double excess = volumeOf(world, joint) - joint.restVolume;
  const float rho = w > 0 ? kTetFactor / (w * step.h * step.h) : 0;
  const bool hard = joint.stiffness <= 0;
  tet.bias = static_cast<float>(hard ? (1 - step.alpha) * excess : excess);
  tet.k = hard ? rho : joint.stiffness * rho / (joint.stiffness + rho);
  tet.s = hard ? 1 : joint.stiffness / (joint.stiffness + rho);
  tet.lambda = joint.lambda[0];
  return tet;
}

}  // namespace

void fillJoints(const WorldData& world, StepData& step) {
  for (size_t lane = 0; lane < step.ballJoint.size(); ++lane) {
    rows::BallJoint<float> rows{};
    if (step.ballJoint[lane] != kNone) rows = jointRows(world, step, world.joints[step.ballJoint[lane]]).ball;
    step.balls[lane / kTile].set(lane % kTile, rows);
  }
  for (size_t lane = 0; lane < step.fixedJoint.size(); ++lane) {
    rows::FixedJoint<float> rows{};
    rows.q0 = {1, 0, 0, 0};
    if (step.fixedJoint[lane] != kNone) rows = jointRows(world, step, world.joints[step.fixedJoint[lane]]);
    step.fixed[lane / kTile].set(lane % kTile, rows);
  }
  for (size_t lane = 0; lane < step.tetJoint.size(); ++lane) {
    rows::TetVolume<float> rows{};
    if (step.tetJoint[lane] != kNone) rows = tetRows(world, step, world.joints[step.tetJoint[lane]]);
    step.tets[lane / kTile].set(lane % kTile, rows);
  }
  for (uint32_t i = 0; i < step.forestCount; ++i)
    for (TreeJoint& joint : step.forests[i].joints)
      if (joint.mixed < 0) joint.rows = jointRows(world, step, world.joints[joint.slot]);
  fillScalarJoints(world, step);
  weighAccelerationDrives(world, step);
  fillLinkedJoints(world, step);
}

}  // namespace avbd
