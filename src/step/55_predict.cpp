// Prediction: where each body would go alone (target y) and where the iterations start (d).
//
// The start decides how near the frozen friction cones and active sets of the first iteration are to the truth. A body
// that its contacts and joints carry starts from its velocity (at rest: from rest); one that they barely touch starts
// from free motion; one whose contacts all slide starts from the acceleration that it had, because near the threshold
// of sliding the majorised friction rows give way only slowly.
#include "step/begin_rows.h"
#include "step/free_motion.h"
#include "world/joints.h"

namespace avbd {

namespace {

constexpr float kLoaded = 0.1f;      ///< of its weight: a body whose multipliers carry less starts from free motion
constexpr uint8_t kSteadySlide = 3;  ///< steps that a contact must have slid before the acceleration is trusted

/// Sums the forces that contacts and joints gave each body in the last step and sees which bodies only slide.
void sumCarried(const WorldData& world, StepData& step) {
  step.carried.assign(world.bodies.size(), Vec3{});
  step.slidesOnly.assign(world.bodies.size(), 1);
  for (const uint32_t index : step.islandPairs) {
    const PairData& pair = world.pairs[index];
    if (pair.slides < kSteadySlide) step.slidesOnly[pair.bodyA] = step.slidesOnly[pair.bodyB] = 0;
    Vec3 force;
    for (int i = 0; i < pair.pointCount; ++i) {
      const Vec3 l = pair.points[i].lambda;
      force = force + pair.normal * l.x + pair.t1 * l.y + pair.t2 * l.z;
    }
    if (!step.changes.empty()) {
      const ContactChange& change = changeOf(step, index);
      step.carried[pair.bodyA] = step.carried[pair.bodyA] - force * change.scaleA;
      step.carried[pair.bodyB] = step.carried[pair.bodyB] + force * change.scaleB;
      continue;
    }
    step.carried[pair.bodyA] = step.carried[pair.bodyA] - force;
    step.carried[pair.bodyB] = step.carried[pair.bodyB] + force;
  }
  for (const uint32_t slot : step.islandJoints) {
    const JointData& joint = world.joints[slot];
    forEachBody(world, slot, [&](uint32_t body) {
      if (body != kNone) step.slidesOnly[body] = 0;
    });
    if (!hasFrames(joint.type) || joint.type == JointType::Pulley) continue;
    const Vec3 force{joint.lambda[0], joint.lambda[1], joint.lambda[2]};
    if (joint.body[0] != kNone) step.carried[joint.body[0]] = step.carried[joint.body[0]] - force;
    if (joint.body[1] != kNone) step.carried[joint.body[1]] = step.carried[joint.body[1]] + force;
  }
}

/// The acceleration of the last step, never more than gravity's.
Vec3 steadyAcceleration(const BodyData& body, float weight) {
  const float limit = weight / body.mass, size = length(body.acceleration);
  return size > limit ? body.acceleration * (limit / size) : body.acceleration;
}

void write(float* row, Vec3 lin, Vec3 ang) {
  row[0] = lin.x, row[1] = lin.y, row[2] = lin.z;
  row[4] = ang.x, row[5] = ang.y, row[6] = ang.z;
}

void predictBody(const WorldData& world, StepData& step, uint32_t index, size_t at) {
  const uint32_t slot = step.order[index];
  const BodyData& body = world.bodies[slot];
  const FreeMotion& free = step.free[index] = freeMotion(body, world.def.gravity, step.h);
  write(step.target.data() + at, free.displacement, free.turn);
  const float weight = length(world.def.gravity) * rows::abs(body.gravityScale) * body.mass;
  if (length(step.carried[slot]) <= kLoaded * weight) {
    write(step.d.data() + at, free.displacement, free.turn);
    return;
  }
  Vec3 start = body.linearVelocity * step.h;
  if (step.slidesOnly[slot]) start = start + steadyAcceleration(body, weight) * (step.h * step.h);
  write(step.d.data() + at, unlocked(start, body.locks), unlocked(body.angularVelocity * step.h, body.locks >> 3));
}

}  // namespace

void predict(WorldData& world, StepData& step) {
  sumCarried(world, step);
  step.free.resize(step.order.size());
  for (const BatchRange& batch : step.batches)
    for (uint32_t i = 0; i < batch.bodies; ++i)
      predictBody(world, step, batch.orderBegin + i, size_t(8) * (batch.rowBegin + i));
}

}  // namespace avbd
