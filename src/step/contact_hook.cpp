// The user's contact hook: what it sees, what it may say, and what becomes of it.
#include <algorithm>

#include "step/contacts.h"
#include "step/swept_contacts.h"
#include "world/check.h"
#include "world/limits.h"
#include "world/pairs.h"

namespace avbd {

namespace {

constexpr double kMaxMassScale = 1e3;

ContactPlan planOf(const WorldData& world, const StepData& step, const PairData& pair) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  ContactPlan plan;
  plan.shapeA = pair.shapeId(0), plan.shapeB = pair.shapeId(1);
  plan.bodyA = pair.bodyId(0), plan.bodyB = pair.bodyId(1);
  if (pair.hasSurface) (isSurface(world.shapes[pair.shapeA].geom.type) ? plan.elementA : plan.elementB) = pair.element;
  plan.normal = pair.manifold.normal;
  plan.pointCount = pair.manifold.count;
  for (int i = 0; i < pair.manifold.count; ++i) {
    const ContactArms arms = armsOf(world, step, pair, i);
    const size_t at = static_cast<size_t>(i);
    plan.positions[at] = pair.origin + pair.manifold.points[i].position;
    plan.separations[at] = pair.manifold.points[i].separation;
    plan.velocities[at] =
        b.linearVelocity + cross(b.angularVelocity, arms.b) - a.linearVelocity - cross(a.angularVelocity, arms.a);
  }
  plan.staticFriction = pair.staticFriction, plan.friction = pair.friction, plan.restitution = pair.restitution;
  plan.torsionalFriction = pair.torsionalFriction, plan.rollingFriction = pair.rollingFriction;
  return plan;
}

void checkPlan(const ContactPlan& plan, float unit) {
  const Path path("ContactPlan");
  check(path / "friction", plan.friction, notNegative(kMaxRate));
  // Written so that NaN is refused.
  if (!(plan.staticFriction >= plan.friction && plan.staticFriction <= static_cast<float>(kMaxRate)))
    (path / "staticFriction").refuse(toText(plan.staticFriction), "must be >= friction and at most 1e+06");
  check(path / "restitution", plan.restitution, Range{0, 1});
  check(path / "torsionalFriction", plan.torsionalFriction, notNegative(kMaxSize * unit));
  check(path / "rollingFriction", plan.rollingFriction, notNegative(kMaxSize * unit));
  check(path / "surfaceVelocity", plan.surfaceVelocity, symmetric(kMaxSpeed * unit));
  check(path / "inverseMassScaleA", plan.inverseMassScaleA, notNegative(kMaxMassScale));
  check(path / "inverseMassScaleB", plan.inverseMassScaleB, notNegative(kMaxMassScale));
}

/// Nothing in it carried force in the last step.
bool isNew(const PairData& pair) {
  for (int i = 0; i < pair.pointCount; ++i)
    if (pair.points[i].lambda != Vec3{}) return false;
  return pair.slides == 0;
}

/// A belt moves on under what lies on it: nothing sticks to a place.
void loosen(const WorldData& world, PairData& pair) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const Vec3 fromAToB = toFloat(b.position - a.position);
  for (int i = 0; i < pair.pointCount; ++i) {
    pair.points[i].anchorA = toBody(a, pair.manifold.points[i].position);
    pair.points[i].anchorB = toBody(b, pair.manifold.points[i].position - fromAToB);
  }
}

void obey(const WorldData& world, StepData& step, uint32_t index, PairData& pair, const ContactPlan& plan) {
  pair.staticFriction = plan.staticFriction, pair.friction = plan.friction, pair.restitution = plan.restitution;
  pair.torsionalFriction = plan.torsionalFriction, pair.rollingFriction = plan.rollingFriction;
  ContactChange change;
  change.pair = index;
  change.belt = plan.surfaceVelocity - pair.normal * dot(pair.normal, plan.surfaceVelocity);
  change.scaleA = plan.inverseMassScaleA, change.scaleB = plan.inverseMassScaleB;
  const bool moves = change.belt != Vec3{}, scales = change.scaleA != 1 || change.scaleB != 1;
  pair.isFull = scales || pair.torsionalFriction > 0 || pair.rollingFriction > 0;
  if (isNew(pair)) beginSlide(world, step, pair, change.belt);
  if (moves) loosen(world, pair);
  if (moves || scales) step.changes.push_back(change);
}

/// Whether the hook accepts a pair's contact.
bool ask(WorldData& world, StepData& step, uint32_t index) {
  PairData& pair = world.pairs[index];
  ContactPlan plan = planOf(world, step, pair);
  const bool accepted = world.contactHook(plan);
  if (accepted) {
    checkPlan(plan, world.def.lengthUnit);
    obey(world, step, index, pair, plan);
  } else {
    forgetContact(world, step, pair);
    step.touchChanges.push_back(pair.key());
  }
  step.found[index] = foundContact(world, pair);
  return accepted;
}

}  // namespace

void askHook(WorldData& world, StepData& step) {
  for (uint32_t i = 0; i < world.pairs.size(); ++i) {
    const int points = step.found[i].points;
    if (points == 0 || !world.pairs[i].hasHook || ask(world, step, i)) continue;
    --world.report.contacts;
    world.report.points -= static_cast<uint32_t>(points);
  }
}

void askHookAgain(WorldData& world, StepData& step) {
  for (const SweptPair& swept : step.swept) {
    const auto index = static_cast<uint32_t>(findPair(world, swept.key) + swept.patch);
    const PairData& pair = world.pairs[index];
    if (!pair.hasHook || pair.pointCount == 0 || swept.round != step.round) continue;
    std::erase_if(step.changes, [&](const ContactChange& change) { return change.pair == index; });
    if (!ask(world, step, index)) step.tied.refused.push_back(swept.key);
  }
  std::sort(step.changes.begin(), step.changes.end(),
            [](const ContactChange& x, const ContactChange& y) { return x.pair < y.pair; });
}

void rememberPairs(const WorldData& world, StepData& step) {
  step.pairsBefore = world.pairs;
  step.unpairedBefore = world.unpaired;
  step.pairsKept = true;
}

/// The bounds in the tree have moved on, so the next step looks for all pairs anew.
void restorePairs(WorldData& world, StepData& step) {
  std::swap(world.pairs, step.pairsBefore);
  world.means.swap(step.meansBefore);
  world.lostTouches.resize(step.lostBefore);
  world.unpaired = step.unpairedBefore;
  for (const uint32_t slot : world.sleep.awake) {
    if (world.bodies[slot].asleep) continue;  // again: the step had woken it
    for (uint32_t s = world.bodies[slot].firstShape; s != kNone; s = world.shapes[s].next) world.unpaired.push_back(s);
  }
  std::sort(world.unpaired.begin(), world.unpaired.end());
  world.unpaired.erase(std::unique(world.unpaired.begin(), world.unpaired.end()), world.unpaired.end());
}

}  // namespace avbd
