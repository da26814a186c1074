// Contacts of pairs that hardly moved: the kept manifold's points carried along, with what they remember.
#include <algorithm>
#include <limits>

#include "step/contacts.h"

namespace avbd {

namespace {

/// [of the smaller half thickness; of the margin that all contacts have] that parts may move against each other while
/// their manifold is kept, and that a part left out of it may come nearer than the margin.
constexpr float kStill = 0.005f, kStillOfMargin = 0.25f, kMissed = 0.5f;

KeepLimits limitsOf(const WorldData& world, const PairData& pair, float margin) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const float least = kSpeculative * world.def.lengthUnit;
  return {margin, kMissed * least, std::min(kStill * smallerSize(a, b), kStillOfMargin * least)};
}

/// What slips sticks from here on. What sticks has moved less than the limits since the manifold was found: that it
/// rolls on shows when it is found anew.
void anchorSlipping(PairData& pair, const CarriedPoints& now) {
  const auto [onA, onB] = placesOnBodies(now);
  for (int i = 0; i < pair.pointCount; ++i) {
    PointMemory& point = pair.points[i];
    if (point.sticks) continue;
    point.anchorA = {onA.x[i], onA.y[i], onA.z[i]};
    point.anchorB = {onB.x[i], onB.y[i], onB.z[i]};
  }
}

/// Multipliers and places of sticking, as rememberPoints() would carry them over from the same points.
void carryMemory(PairData& pair, const CarriedPoints& now) {
  const ContactBasis old{pair.normal, pair.t1, pair.t2};
  turnBasis(pair);
  const float t11 = dot(old.t1, pair.t1), t12 = dot(old.t2, pair.t1);
  const float t21 = dot(old.t1, pair.t2), t22 = dot(old.t2, pair.t2);
  bool allStick = true;
  for (int i = 0; i < pair.pointCount; ++i) {
    PointMemory& point = pair.points[i];
    point.lambda = {point.lambda.x, t11 * point.lambda.y + t12 * point.lambda.z,
                    t21 * point.lambda.y + t22 * point.lambda.z};
    allStick = allStick && point.sticks;
  }
  if (!allStick) anchorSlipping(pair, now);
  pair.mean = kNone;
  pair.gonePoints = 0;
}

void place(const CarriedPoints& now, Manifold& manifold) {
  manifold.normal = now.normal;
  for (int i = 0; i < manifold.count; ++i) {
    manifold.points[i].position = {now.position.x[i], now.position.y[i], now.position.z[i]};
    manifold.points[i].separation = now.separation[i];
  }
}

}  // namespace

bool carryContact(WorldData& world, const StepData& step, PairData& pair, float margin) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  CarriedPoints now;
  const NearPose poseA{{}, a.rotation}, poseB{toFloat(b.position - a.position), b.rotation};
  const Carry how = carry(pair.kept, poseA, poseB, limitsOf(world, pair, margin), now);
  if (how == Carry::Anew) return false;
  if (how == Carry::Apart) {
    forgetContact(world, step, pair);
    return true;
  }
  place(now, pair.manifold);
  pair.origin = a.position;
  combineMaterials(pair, world.shapes[pair.shapeA].material, world.shapes[pair.shapeB].material);
  const bool simple = step.substep == 0 && pair.turn == Vec3{} && pair.torque == Vec3{};
  if (simple && dot(pair.normal, now.normal) > kSameNormal)
    carryMemory(pair, now);
  else
    rememberPoints(world, step, pair);
  return true;
}

void keepContact(const WorldData& world, PairData& pair, float margin, const Manifold& found) {
  const float closing = margin - kSpeculative * world.def.lengthUnit;
  const KeepLimits limits = limitsOf(world, pair, margin);
  pair.kept.what = KeptManifold::What::Nothing;
  // Not what the next step will find moved too far.
  if (found.count > 0 ? closing > limits.allowed : found.clear < margin + closing) return;
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const auto near = [&](const BodyData& body, uint32_t shape) {
    const bool bounded = world.shapes[shape].geom.type != ShapeType::HalfSpace;
    return NearBody{{toFloat(body.position - a.position), body.rotation},
                    bounded ? body.radius : std::numeric_limits<float>::infinity()};
  };
  keep(found, near(a, pair.shapeA), near(b, pair.shapeB), pair.kept);
}

}  // namespace avbd
