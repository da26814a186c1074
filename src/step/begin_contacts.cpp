// Contact rows: constants of the step and remembered multipliers of every manifold.
#include <algorithm>

#include "step/begin_rows.h"
#include "step/contact_impact.h"
#include "step/contacts.h"
#include "step/restitution.h"
#include "step/settings.h"
#include "step/swept_contacts.h"

namespace avbd {

namespace {

/// Of contacts with what does not move: how many times as stiff as others under their load, and the most that it comes
/// to, in island masses over h^2; of others `kMost`.
constexpr float kGroundedLoad = 4, kGroundedMost = 200, kMost = 2;

/// What an iteration of the batch leaves of its multipliers.
float leakOf(const StepData& step, const BatchRange& batch) {
  return withIterations(step.solve, batch.iterations).contactLeak;
}

rows::ContactPointRows<float> pointRows(const WorldData& world, const StepData& step, PairData& pair, int i,
                                        float leak) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  PointMemory& memory = pair.points[i];
  const Vec3 slip =
      rotate(a.rotation, memory.anchorA) - rotate(b.rotation, memory.anchorB) - toFloat(b.position - a.position);
  // Later rounds find the next one's in its place.
  if (step.round == 0) forgetImpact(memory);
  memory.impact = 0;
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

/// Unlike others, a belt gives no place to stick to, only a velocity.
void moveSurface(const StepData& step, const PairData& pair, Vec3 belt, rows::Contact<float>& c) {
  for (int i = 0; i < pair.pointCount; ++i) {
    c.point[i].bias1 = dot(belt, pair.t1) * step.h;
    c.point[i].bias2 = dot(belt, pair.t2) * step.h;
  }
}

/// Of a contact that is met on the way: the rows are those of where it is.
void followSwept(const StepData& step, const PairData& pair, rows::Contact<float>& c) {
  const SweptPair* swept = sweptOf(step, pair);
  if (swept) linearise(swept->rows, swept->rows.metA, swept->rows.metB, c);
}

rows::Contact<float> contactRows(const WorldData& world, const StepData& step, PairData& pair, float leak) {
  rows::Contact<float> c{};
  c.n = toRow(pair.normal), c.t1 = toRow(pair.t1), c.t2 = toRow(pair.t2);
  // What stands on something that does not move couples nothing, so its stiffness costs the conjugate gradients
  // nothing, and a tall load on a light base needs it: it feels the lever.
  const bool grounded = !isDynamic(world, pair.bodyA) || !isDynamic(world, pair.bodyB);
  c.loadStiffness = (grounded ? kGroundedLoad : 1) / step.loadDepth;
  c.stiffest = (grounded ? kGroundedMost : kMost) * step.islands[islandOfPair(step, pair)].mass / (step.h * step.h);
  Vec3 reference;
  for (int i = 0; i < pair.pointCount; ++i) reference = reference + pair.manifold.points[i].position;
  reference = reference * (1.0f / static_cast<float>(pair.pointCount));
  c.armA = toRow(reference);
  c.armB = toRow(reference - toFloat(world.bodies[pair.bodyB].position - world.bodies[pair.bodyA].position));
  for (int i = 0; i < pair.pointCount; ++i) {
    c.point[i] = pointRows(world, step, pair, i, leak);
    c.point[i].arm = c.point[i].arm - c.armA;
  }
  // A particle touches at one point and does not turn.
  if (isParticle(world, pair.bodyA)) c.armA = {};
  if (isParticle(world, pair.bodyB)) c.armB = {};
  if (!step.swept.empty()) followSwept(step, pair, c);
  noteImpacts(world, step, pair, c);
  return c;
}

rows::Contact<float> changedRows(WorldData& world, const StepData& step, uint32_t index, float leak) {
  rows::Contact<float> c = contactRows(world, step, world.pairs[index], leak);
  if (step.changes.empty()) return c;
  const ContactChange& change = changeOf(step, index);
  if (change.belt != Vec3{}) moveSurface(step, world.pairs[index], change.belt, c);
  return c;
}

rows::FullContact<float> fullRows(WorldData& world, const StepData& step, uint32_t index, float leak) {
  const PairData& pair = world.pairs[index];
  const ContactChange& change = changeOf(step, index);
  const float share = 1 - step.alpha;
  rows::FullContact<float> full{};
  full.contact = changedRows(world, step, index, leak);
  full.torsional = pair.torsionalFriction, full.rolling = pair.rollingFriction;
  full.biasTorsion = share * pair.turn.x, full.bias1 = share * pair.turn.y, full.bias2 = share * pair.turn.z;
  full.lambdaTorsion = leak * pair.torque.x;
  full.lambda1 = leak * pair.torque.y, full.lambda2 = leak * pair.torque.z;
  full.scaleA = change.scaleA, full.scaleB = change.scaleB;
  return full;
}

}  // namespace

void fillContacts(WorldData& world, StepData& step, const WorkUnit& unit) {
  const BatchRange& batch = step.batches[unit.batch];
  const float leak = leakOf(step, batch);
  for (size_t tile = batch.contactTile + unit.tiles.begin; tile < batch.contactTile + unit.tiles.end; ++tile)
    for (int lane = 0; lane < kTile; ++lane) {
      const size_t at = kTile * tile + static_cast<size_t>(lane);
      const uint32_t pair = step.contactPair[at];
      prefetchAhead(world, step.contactPair, at);
      rows::Contact<float> c{};
      if (pair != kNone) c = changedRows(world, step, pair, leak);
      step.contacts[tile].set(lane, c);
    }
}

void fillFullContacts(WorldData& world, StepData& step) {
  for (const BatchRange& batch : step.batches) {
    const float leak = leakOf(step, batch);
    for (size_t lane = size_t(batch.fullTile) * kTile; lane < size_t(batch.fullTile + batch.fullTiles) * kTile;
         ++lane) {
      const uint32_t pair = step.fullPair[lane];
      rows::FullContact<float> full{};
      if (pair != kNone) full = fullRows(world, step, pair, leak);
      step.full[lane / kTile].set(static_cast<int>(lane % kTile), full);
    }
  }
}

}  // namespace avbd
