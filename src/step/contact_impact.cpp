// Impacts of contacts.
#include "step/contact_impact.h"

#include <algorithm>

#include "step/begin_rows.h"

namespace avbd {

namespace {

/// A body as an impulse along the normal meets it.
struct Side {
  float invMass = 0;
  rows::Sym3<float> invInertia{};
  rows::V3<float> levers{0, 0, 0};  ///< sum of arm x normal
  float along(const rows::V3<float>& lever, const rows::V3<float>& other) const {
    return dot(lever, invInertia * other);
  }
};

Side sideOf(const BodyData& body) {
  Side side;
  if (body.type != BodyType::Dynamic) return side;
  if ((body.locks & 7) != 7) side.invMass = 1 / body.mass;
  if ((body.locks >> 3) != 7) side.invInertia = rotated(toRow(body.invInertia), toRow(body.rotation));
  return side;
}

/// [m] that each point would be too deep at the end of the step, went the bodies on as they move; 0 where they rest or
/// do not meet, and where the point rebounds. False if all are 0.
bool findClosing(const WorldData& world, const StepData& step, const PairData& pair, const rows::Contact<float>& c,
                 float (&closing)[kMaxManifoldPoints]) {
  const auto motionOf = [&](uint32_t body) {
    return rows::Twist<float>{toRow(world.bodies[body].linearVelocity), toRow(world.bodies[body].angularVelocity)};
  };
  const rows::Twist<float> motion = relativeMotion(motionOf(pair.bodyA), motionOf(pair.bodyB), c.armA, c.armB);
  const float together = dot(c.n, motion.lin);
  bool found = false;
  for (int i = 0; i < pair.pointCount; ++i) {
    const rows::ContactPointRows<float>& p = c.point[i];
    const float speed = together + dot(motion.ang, cross(p.arm, c.n));
    const bool meets = speed > step.restingSpeed && !(pair.points[i].rebound > 0);
    closing[i] = meets ? std::max(p.biasN + speed * step.h, 0.0f) : 0;
    found = found || closing[i] > 0;
  }
  return found;
}

}  // namespace

void takeImpact(PointMemory& memory) {
  if (memory.rebound > 0) memory.lambda = {};
  const float force = memory.lambda.x;
  if (force > 0) memory.lambda = memory.lambda * (std::max(force - memory.impact, 0.0f) / force);
  memory.impact = 0;
}

void noteImpacts(const WorldData& world, const StepData& step, PairData& pair, const rows::Contact<float>& c) {
  float closing[kMaxManifoldPoints];
  if (!findClosing(world, step, pair, c, closing)) return;
  // As if all points that meet were pushed alike: together they stop the bodies once.
  Side a = sideOf(world.bodies[pair.bodyA]), b = sideOf(world.bodies[pair.bodyB]);
  rows::V3<float> leverA[kMaxManifoldPoints], leverB[kMaxManifoldPoints];
  float count = 0;
  for (int i = 0; i < pair.pointCount; ++i) {
    leverA[i] = cross(c.armA + c.point[i].arm, c.n), leverB[i] = cross(c.armB + c.point[i].arm, c.n);
    if (!(closing[i] > 0)) continue;
    a.levers += leverA[i], b.levers += leverB[i];
    count += 1;
  }
  const float invMass = a.invMass + b.invMass;
  for (int i = 0; i < pair.pointCount; ++i) {
    if (!(closing[i] > 0)) continue;
    const float alone = invMass + a.along(leverA[i], leverA[i]) + b.along(leverB[i], leverB[i]);
    const float all = count * invMass + a.along(leverA[i], a.levers) + b.along(leverB[i], b.levers);
    const float w = std::max(alone, all);
    if (w > 0) pair.points[i].impact = closing[i] / (w * step.h * step.h);
  }
}

}  // namespace avbd
