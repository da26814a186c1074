// Forces that are no numbers (check_forces.h). A sum of products with zero is zero, or else something in it is not
// finite.
#include "step/check_forces.h"

#include "solve/linked_joint.h"
#include "world/joints.h"

namespace avbd {

namespace {

[[noreturn]] void fail(const WorldData& world, uint32_t slot) {
  const BodyId id = world.bodyIds.id(slot);
  throw NonFiniteError(stageName(Stage::Publish), id.index, id.generation);
}

/// Names the joint's first body that can move.
[[noreturn]] void failJoint(const WorldData& world, uint32_t joint) {
  uint32_t found = kNone;
  forEachBody(world, joint, [&](uint32_t body) {
    if (found == kNone && body != kNone && world.bodies[body].type == BodyType::Dynamic) found = body;
  });
  fail(world, found);
}

bool isFinite(float x) { return x * 0 == 0; }
bool isFinite(const rows::V3<float>& v) { return isFinite(v.x * 0 + v.y * 0 + v.z * 0); }

void checkContacts(const WorldData& world, const StepData& step) {
  const auto check = [&](const rows::Contact<float>& contact, uint32_t pair) {
    float sum = 0;
    for (const auto& p : contact.point) sum += p.lambdaN * 0 + p.lambda1 * 0 + p.lambda2 * 0;
    if (sum == 0) return;
    const PairData& of = world.pairs[pair];
    fail(world, world.bodies[of.bodyA].type == BodyType::Dynamic ? of.bodyA : of.bodyB);
  };
  for (size_t lane = 0; lane < step.contactPair.size(); ++lane)
    if (step.contactPair[lane] != kNone) check(step.contacts[lane / kTile].get(lane % kTile), step.contactPair[lane]);
  for (size_t lane = 0; lane < step.fullPair.size(); ++lane) {
    if (step.fullPair[lane] == kNone) continue;
    const rows::FullContact<float> full = step.full[lane / kTile].get(lane % kTile);
    check(full.contact, step.fullPair[lane]);
    const PairData& of = world.pairs[step.fullPair[lane]];
    if (!isFinite(rows::V3<float>{full.lambdaTorsion, full.lambda1, full.lambda2}))
      fail(world, world.bodies[of.bodyA].type == BodyType::Dynamic ? of.bodyA : of.bodyB);
  }
}

void checkTets(const WorldData& world, const StepData& step) {
  for (size_t lane = 0; lane < step.tetJoint.size(); ++lane) {
    if (step.tetJoint[lane] == kNone) continue;
    const rows::TetVolume<float> tet = step.tets[lane / kTile].get(lane % kTile);
    const rows::V3<float> area = cross(tet.ac, tet.ad) + cross(tet.ad, tet.ab) + cross(tet.ab, tet.ac);
    if (!isFinite(area * (tet.lambda / 6))) failJoint(world, step.tetJoint[lane]);
  }
}

void checkPairs(const WorldData& world, const StepData& step) {
  for (size_t lane = 0; lane < step.ballJoint.size(); ++lane)
    if (step.ballJoint[lane] != kNone && !isFinite(step.balls[lane / kTile].get(lane % kTile).lambda))
      failJoint(world, step.ballJoint[lane]);
  for (size_t lane = 0; lane < step.fixedJoint.size(); ++lane) {
    if (step.fixedJoint[lane] == kNone) continue;
    const rows::FixedJoint<float> fixed = step.fixed[lane / kTile].get(lane % kTile);
    if (!isFinite(fixed.ball.lambda) || !isFinite(fixed.lambda)) failJoint(world, step.fixedJoint[lane]);
  }
  for (uint32_t i = 0; i < step.forestCount; ++i)
    for (const TreeJoint& joint : step.forests[i].joints)
      if (joint.mixed < 0 && (!isFinite(joint.rows.ball.lambda) || (joint.angular && !isFinite(joint.rows.lambda))))
        failJoint(world, joint.slot);
}

void checkScalar(const WorldData& world, StepData& step) {
  for (uint32_t i = 0; i < step.batches.size(); ++i) {
    const BatchView view = step.view(i);
    for (uint32_t n = 0; n < view.scalar.count; ++n) {
      ScalarJoint& joint = view.scalar.joint[n];
      const ScalarRows list = rowsOf(joint, view);
      rows::Twist<float> wrench = rows::zeroTwist<float>();
      for (int r = 0; r < list.count; ++r) {
        wrench.lin += list.row[r].lin * *list.lambda[r];
        wrench.ang += list.row[r].ang * *list.lambda[r];
      }
      if (!isFinite(wrench.lin) || !isFinite(wrench.ang + cross(list.armA, wrench.lin))) failJoint(world, joint.slot);
    }
    for (uint32_t n = 0; n < view.linked.count; ++n) {
      LinkedJoint& joint = view.linked.joint[n];
      LinkedRows list;
      evaluate(joint, view, list);
      rows::Twist<float> sum = rows::zeroTwist<float>();
      for (int r = 0; r < list.count; ++r) sum += list.row[r].j[0] * *list.row[r].lambda;
      if (!isFinite(sum.lin) || !isFinite(sum.ang)) failJoint(world, joint.slot);
    }
  }
}

}  // namespace

void checkForces(const WorldData& world, StepData& step) {
  checkContacts(world, step);
  checkPairs(world, step);
  checkTets(world, step);
  checkScalar(world, step);
}

}  // namespace avbd
