// Prediction: where each body would go alone (target y) and where the iterations start (d).
#include "step/begin_rows.h"
#include "step/free_motion.h"

namespace avbd {

namespace {

constexpr float kLoaded = 0.1f;  ///< of its weight: a body whose multipliers carry less starts from free motion

/// Sum of the forces that contacts and joints gave each body in the last step.
void sumCarried(const WorldData& world, StepData& step) {
  step.carried.assign(world.bodies.size(), Vec3{});
  for (const uint32_t index : step.islandPairs) {
    const PairData& pair = world.pairs[index];
    Vec3 force;
    for (int i = 0; i < pair.pointCount; ++i) {
      const Vec3 l = pair.points[i].lambda;
      force = force + pair.normal * l.x + pair.t1 * l.y + pair.t2 * l.z;
    }
    step.carried[pair.bodyA] = step.carried[pair.bodyA] - force;
    step.carried[pair.bodyB] = step.carried[pair.bodyB] + force;
  }
  for (const uint32_t slot : step.islandJoints) {
    const JointData& joint = world.joints[slot];
    if (joint.type == JointType::TetVolume) continue;
    const Vec3 force{joint.lambda[0], joint.lambda[1], joint.lambda[2]};
    if (joint.body[0] != kNone) step.carried[joint.body[0]] = step.carried[joint.body[0]] - force;
    if (joint.body[1] != kNone) step.carried[joint.body[1]] = step.carried[joint.body[1]] + force;
  }
}

void write(float* row, Vec3 lin, Vec3 ang) {
  row[0] = lin.x, row[1] = lin.y, row[2] = lin.z;
  row[4] = ang.x, row[5] = ang.y, row[6] = ang.z;
}

}  // namespace

void predict(WorldData& world, StepData& step) {
  sumCarried(world, step);
  for (const BatchRange& batch : step.batches)
    for (uint32_t i = 0; i < batch.bodies; ++i) {
      const uint32_t slot = step.order[batch.orderBegin + i];
      const BodyData& body = world.bodies[slot];
      const FreeMotion free = freeMotion(body, world.def.gravity, step.h);
      const size_t at = size_t(8) * (batch.rowBegin + i);
      write(step.target.data() + at, free.displacement, free.turn);
      const float weight = length(world.def.gravity) * body.gravityScale * body.mass;
      const bool loaded = length(step.carried[slot]) > kLoaded * rows::abs(weight);
      if (loaded) {
        write(step.d.data() + at, unlocked(body.linearVelocity * step.h, body.locks),
              unlocked(body.angularVelocity * step.h, body.locks >> 3));
      } else {
        write(step.d.data() + at, free.displacement, free.turn);
      }
    }
}

}  // namespace avbd
