// Contact rows: constants of the step and remembered multipliers of every manifold.
#include <algorithm>

#include "step/begin_rows.h"
#include "step/restitution.h"

namespace avbd {

namespace {

/// Penetration beyond the slop, of which only a share is corrected in one step and never faster than allowed; or the
/// whole gap, so that nothing stops short of touching.
float normalBias(const WorldData& world, const StepData& step, float separation) {
  const float gap = separation + step.slop;
  if (gap >= 0) return -gap;
  return std::min((1 - step.alpha) * -gap, world.def.maxDepenetrationSpeed * step.h);
}

rows::ContactPointRows<float> pointRows(const WorldData& world, const StepData& step, PairData& pair, int i) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  PointMemory& memory = pair.points[i];
  const Vec3 slip =
      rotate(a.rotation, memory.anchorA) - rotate(b.rotation, memory.anchorB) - toFloat(b.position - a.position);
  // The force of an impact is no guess for the step after it.
  if (memory.rebound > 0) memory.lambda = {};
  const float leak = step.solve.contactLeak;
  rows::ContactPointRows<float> p{};
  p.arm = toRow(pair.manifold.points[i].position);
  p.biasN = normalBias(world, step, pair.manifold.points[i].separation);
  if (pair.restitution > 0) {
    const Rebound answer = rebound(world, step, pair, i);
    memory.rebound = answer.speed;
    if (answer.speed > 0) p.biasN += step.slop + answer.height;
  } else {
    memory.rebound = 0;
  }
  p.bias1 = (1 - step.alpha) * dot(slip, pair.t1);
  p.bias2 = (1 - step.alpha) * dot(slip, pair.t2);
  p.mu = pair.slides > 1 || pair.landedSliding ? pair.friction : pair.staticFriction;
  p.lambdaN = leak * memory.lambda.x;
  p.lambda1 = leak * memory.lambda.y;
  p.lambda2 = leak * memory.lambda.z;
  p.floorN = p.floorT = 1;  // a point is here; prepareContacts puts the stiffness
  return p;
}

rows::Contact<float> contactRows(const WorldData& world, const StepData& step, PairData& pair) {
  rows::Contact<float> c{};
  c.n = toRow(pair.normal), c.t1 = toRow(pair.t1), c.t2 = toRow(pair.t2);
  c.loadStiffness = 1 / step.loadDepth;
  c.stiffest = 2 * step.islands[islandOfPair(step, pair)].mass / (step.h * step.h);
  Vec3 reference;
  for (int i = 0; i < pair.pointCount; ++i) reference = reference + pair.manifold.points[i].position;
  reference = reference * (1.0f / static_cast<float>(pair.pointCount));
  c.armA = toRow(reference);
  c.armB = toRow(reference - toFloat(world.bodies[pair.bodyB].position - world.bodies[pair.bodyA].position));
  for (int i = 0; i < pair.pointCount; ++i) {
    c.point[i] = pointRows(world, step, pair, i);
    c.point[i].arm = c.point[i].arm - c.armA;
  }
  return c;
}

}  // namespace

void fillContacts(WorldData& world, StepData& step) {
  for (size_t lane = 0; lane < step.contactPair.size(); ++lane) {
    const uint32_t pair = step.contactPair[lane];
    rows::Contact<float> c{};
    if (pair != kNone) c = contactRows(world, step, world.pairs[pair]);
    step.contacts[lane / kTile].set(lane % kTile, c);
  }
}

}  // namespace avbd
