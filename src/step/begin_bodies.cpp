// Body rows: free motion, masses in world axes, and the motion of kinematic bodies.
#include "step/begin_chunks.h"
#include "step/free_motion.h"

namespace avbd {

namespace {

/// Locked axes take no impulse. Translation is one number in a row, so only a lock of all three axes shows there.
void lockInverse(float* row, uint8_t locks) {
  constexpr int kAxisEntries[3][3] = {{1, 4, 5}, {2, 4, 6}, {3, 5, 6}};
  if ((locks & 7) == 7) row[0] = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (locks >> (3 + axis) & 1)
      for (const int entry : kAxisEntries[axis]) row[entry] = 0;
}

FreeBody<float> freeBody(const BodyData& body, Vec3 gravity, float h) {
  FreeBody<float> b{};
  b.q = toRow(body.rotation), b.v = toRow(body.linearVelocity), b.w = toRow(body.angularVelocity);
  b.acceleration = toRow(freeAcceleration(body, gravity)), b.torque = toRow(body.torque);
  b.inertia = toRow(body.inertia), b.invInertia = toRow(body.invInertia);
  b.mass = body.mass, b.invMass = 1 / body.mass;
  b.keepLinear = decay(body.linearDamping * h), b.keepAngular = decay(body.angularDamping * h);
  const auto isFree = [&](int axis) { return body.locks >> axis & 1 ? 0.0f : 1.0f; };
  b.freeX = isFree(0), b.freeY = isFree(1), b.freeZ = isFree(2);
  b.freeRx = isFree(3), b.freeRy = isFree(4), b.freeRz = isFree(5);
  b.lockRotation = body.locks >> 3 ? 1.0f : 0.0f;
  b.mostLinear = body.maxLinearSpeed, b.mostAngular = body.maxAngularSpeed;
  return b;
}

void fillTiles(const WorldData& world, StepData& step, const WorkUnit& unit) {
  const BatchRange& batch = step.batches[unit.batch];
  for (uint32_t i = unit.rows.begin; i < roundUp(unit.rows.end); ++i) {
    FreeBody<float> body{};
    if (i < unit.rows.end) body = freeBody(world.bodies[step.order[batch.orderBegin + i]], world.def.gravity, step.h);
    step.body[(batch.rowBegin + i) / kTile].set(static_cast<int>(i % kTile), body);
  }
}

}  // namespace

void fillBodies(const WorldData& world, StepData& step) {
  const float h = step.h;
  forUnits(step, [&](const WorkUnit& unit) {
    fillTiles(world, step, unit);
    const Slice rows{unit.rows.begin, roundUp(unit.rows.end)};
    step.backend->freeMotions(step.view(unit.batch), h, rows);
    step.backend->massRows(step.view(unit.batch), h, rows);
    forBodies(step, unit, [&](uint32_t index, uint32_t row) {
      const uint8_t locks = world.bodies[step.order[index]].locks;
      if (locks) lockInverse(step.invMass.data() + size_t(8) * row, locks);
    });
  });
  for (const StepData::KinematicRow& k : step.kinematicRows) {
    const BodyData& body = world.bodies[k.body];
    const Vec3 p = body.linearVelocity * h, w = body.angularVelocity * h;
    float* d = step.d.data() + size_t(8) * k.row;
    d[0] = p.x, d[1] = p.y, d[2] = p.z, d[4] = w.x, d[5] = w.y, d[6] = w.z;
  }
}

}  // namespace avbd
