// Publication: poses, velocities, multipliers and reactions go back to the world.
#include <algorithm>

#include "step/begin_rows.h"
#include "step/free_motion.h"

namespace avbd {

namespace {

constexpr float kSlipping = 0.999f;  ///< of the cone: a friction force beyond it belongs to a point that slips

void publishBodies(WorldData& world, const StepData& step) {
  for (size_t i = 0; i < step.order.size(); ++i) {
    BodyData& body = world.bodies[step.order[i]];
    body.position = step.end[i].position;
    body.rotation = step.end[i].rotation;
    body.acceleration = (step.end[i].linearVelocity - body.linearVelocity) * (1 / step.h);
    body.linearVelocity = step.end[i].linearVelocity;
    body.angularVelocity = step.end[i].angularVelocity;
  }
  for (const uint32_t slot : step.kinematic) {
    BodyData& body = world.bodies[slot];
    body.position = body.position + body.linearVelocity * step.h;
    body.rotation = unit(quatFromVector(body.angularVelocity * step.h) * body.rotation);
  }
}

bool insideCone(const rows::ContactPointRows<float>& p) {
  const float friction = p.lambda1 * p.lambda1 + p.lambda2 * p.lambda2;
  const float bound = kSlipping * p.mu * p.lambdaN;
  return friction < bound * bound;
}

void publishContacts(WorldData& world, const StepData& step) {
  for (size_t lane = 0; lane < step.contactPair.size(); ++lane) {
    if (step.contactPair[lane] == kNone) continue;
    PairData& pair = world.pairs[step.contactPair[lane]];
    const rows::Contact<float> c = step.contacts[lane / kTile].get(lane % kTile);
    bool slides = true;
    for (int i = 0; i < pair.pointCount; ++i) {
      PointMemory& point = pair.points[i];
      const rows::ContactPointRows<float>& p = c.point[i];
      point.lambda = {p.lambdaN, p.lambda1, p.lambda2};
      point.sticks = insideCone(p) ? 1 : 0;
      if (point.sticks) slides = false;
    }
    pair.slides = slides ? static_cast<uint8_t>(std::min(pair.slides + 1, 255)) : uint8_t{0};
    pair.landedSliding = pair.landedSliding && slides;
  }
}

void publishJoint(JointData& joint, const rows::BallJoint<float>& ball, rows::V3<float> torque) {
  const float lambda[6] = {ball.lambda.x, ball.lambda.y, ball.lambda.z, torque.x, torque.y, torque.z};
  for (int i = 0; i < 6; ++i) joint.lambda[i] = lambda[i];
  joint.reaction = {fromRow(-ball.lambda), fromRow(-torque)};
}

void publishJoints(WorldData& world, const StepData& step) {
  const rows::V3<float> none{0, 0, 0};
  for (size_t lane = 0; lane < step.ballJoint.size(); ++lane)
    if (step.ballJoint[lane] != kNone)
      publishJoint(world.joints[step.ballJoint[lane]], step.balls[lane / kTile].get(lane % kTile), none);
  for (size_t lane = 0; lane < step.fixedJoint.size(); ++lane) {
    if (step.fixedJoint[lane] == kNone) continue;
    const rows::FixedJoint<float> rows = step.fixed[lane / kTile].get(lane % kTile);
    publishJoint(world.joints[step.fixedJoint[lane]], rows.ball, rows.lambda);
  }
  for (uint32_t i = 0; i < step.forestCount; ++i)
    for (const TreeJoint& joint : step.forests[i].joints)
      publishJoint(world.joints[joint.slot], joint.rows.ball, joint.angular ? joint.rows.lambda : none);
  for (size_t lane = 0; lane < step.tetJoint.size(); ++lane) {
    if (step.tetJoint[lane] == kNone) continue;
    JointData& joint = world.joints[step.tetJoint[lane]];
    const rows::TetVolume<float> rows = step.tets[lane / kTile].get(lane % kTile);
    joint.lambda[0] = rows.lambda;
    joint.reaction = {
        fromRow((cross(rows.ac, rows.ad) + cross(rows.ad, rows.ab) + cross(rows.ab, rows.ac)) * (rows.lambda / 6)), {}};
  }
}

}  // namespace

void publish(WorldData& world, StepData& step) {
  publishBodies(world, step);
  publishContacts(world, step);
  publishJoints(world, step);
  world.report.simdWidth = static_cast<uint32_t>(step.backend->width);
}

}  // namespace avbd
