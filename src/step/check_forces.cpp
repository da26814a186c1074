// Forces that are no numbers (check_forces.h). A sum of products with zero is zero, or else something in it is not
// finite.
#include "step/check_forces.h"

#include <cstddef>

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
    if (found == kNone && isDynamic(world, body)) found = body;
  });
  fail(world, found);
}

bool isFinite(float x) { return x * 0 == 0; }
bool isFinite(const rows::V3<float>& v) { return isFinite(v.x * 0 + v.y * 0 + v.z * 0); }

uint32_t movableOf(const WorldData& world, const PairData& pair) {
  return isDynamic(world, pair.bodyA) ? pair.bodyA : pair.bodyB;
}

/// Line of a tile that holds the first multiplier of a contact's point; the other two follow.
constexpr size_t multiplierLine(size_t point) {
  using Point = rows::ContactPointRows<float>;
  return (offsetof(rows::Contact<float>, point) + point * sizeof(Point) + offsetof(Point, lambdaN)) / sizeof(float);
}

/// Only the multipliers of each tile are read, sixteen contacts at a time. A full contact begins with a contact.
template <template <class> class Family>
void checkContactTiles(const WorldData& world, const StepData& step, const UnwrittenVector<Tile<Family>>& tiles,
                       const std::vector<uint32_t>& pairs) {
  step.jobs->forRange(static_cast<uint32_t>(pairs.size() / kTile), 64, [&](uint32_t begin, uint32_t end, int) {
    for (size_t t = begin; t < end; ++t) {
      float sum[kTile] = {};
      for (size_t point = 0; point < size_t(kMaxManifoldPoints); ++point)
        for (size_t line = multiplierLine(point); line < multiplierLine(point) + 3; ++line)
          for (size_t lane = 0; lane < kTile; ++lane) sum[lane] += tiles[t].data[line][lane] * 0;
      for (size_t lane = 0; lane < kTile; ++lane)
        if (!(sum[lane] == 0) && pairs[kTile * t + lane] != kNone)
          fail(world, movableOf(world, world.pairs[pairs[kTile * t + lane]]));
    }
  });
}

void checkContacts(const WorldData& world, const StepData& step) {
  static_assert(offsetof(rows::FullContact<float>, contact) == 0);
  checkContactTiles(world, step, step.contacts, step.contactPair);
  checkContactTiles(world, step, step.full, step.fullPair);
  for (size_t lane = 0; lane < step.fullPair.size(); ++lane) {
    if (step.fullPair[lane] == kNone) continue;
    const rows::FullContact<float> full = step.full[lane / kTile].get(lane % kTile);
    if (!isFinite(rows::V3<float>{full.lambdaTorsion, full.lambda1, full.lambda2}))
      fail(world, movableOf(world, world.pairs[step.fullPair[lane]]));
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

/// The whole force of a scalar joint on A, about its anchor.
rows::Twist<float> reactionOf(ScalarJoint& joint, const BatchView& view) {
  const ScalarRows list = rowsOf(joint, view);
  rows::Twist<float> wrench = rows::zeroTwist<float>();
  for (int r = 0; r < list.count; ++r) {
    wrench.lin += list.row[r].lin * *list.lambda[r];
    wrench.ang += list.row[r].ang * *list.lambda[r];
  }
  // A distance joint's force goes through both points.
  if (joint.kind == ScalarJoint::Kind::Distance) return {wrench.lin, rows::zeroV3<float>()};
  return {wrench.lin, wrench.ang + cross(list.armA - joint.rows.armA, wrench.lin)};
}

void checkScalar(const WorldData& world, StepData& step) {
  for (uint32_t i = 0; i < step.batches.size(); ++i) {
    const BatchView view = step.view(i);
    for (uint32_t n = 0; n < view.scalar.count; ++n) {
      ScalarJoint& joint = view.scalar.joint[n];
      joint.reaction = reactionOf(joint, view);
      if (!isFinite(joint.reaction.lin) || !isFinite(joint.reaction.ang)) failJoint(world, joint.slot);
    }
    for (uint32_t n = 0; n < view.linked.count; ++n) {
      LinkedJoint& joint = view.linked.joint[n];
      evaluate(joint, view, joint.stamped);
      const rows::Twist<float> sum = reactionOf(joint);
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
