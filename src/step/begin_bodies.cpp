// Body rows: masses in world axes, and the motion of kinematic bodies.
#include "step/begin_rows.h"

namespace avbd {

namespace {

void fill(float* row, float mass, const rows::Sym3<float>& inertia) {
  const float value[7] = {mass, inertia.xx, inertia.yy, inertia.zz, inertia.xy, inertia.xz, inertia.yz};
  for (int i = 0; i < 7; ++i) row[i] = value[i];
}

/// Locked axes take no impulse. Translation is one number in a row, so only a lock of all three axes shows there.
void lockInverse(float* row, uint8_t locks) {
  constexpr int kAxisEntries[3][3] = {{1, 4, 5}, {2, 4, 6}, {3, 5, 6}};
  if ((locks & 7) == 7) row[0] = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (locks >> (3 + axis) & 1)
      for (const int entry : kAxisEntries[axis]) row[entry] = 0;
}

}  // namespace

void fillBodies(const WorldData& world, StepData& step) {
  const float h = step.h;
  for (const BatchRange& batch : step.batches)
    for (uint32_t i = 0; i < batch.bodies; ++i) {
      const BodyData& body = world.bodies[step.order[batch.orderBegin + i]];
      const rows::M33<float> turn = rows::toMatrix(toRow(body.rotation));
      const size_t at = size_t(8) * (batch.rowBegin + i);
      // Damping makes a body sluggish for this step: what it damps of a force, the force must bring up, and a body at
      // rest rests on its whole weight.
      const float linear = 1 / (h * h * decay(body.linearDamping * h));
      const float angular = 1 / (h * h * decay(body.angularDamping * h));
      fill(step.mass.data() + at, body.mass * linear, rotated(toRow(body.inertia), turn) * angular);
      fill(step.invMass.data() + at, 1 / body.mass, rotated(toRow(body.invInertia), turn));
      if (body.locks) lockInverse(step.invMass.data() + at, body.locks);
    }
  for (const StepData::KinematicRow& k : step.kinematicRows) {
    const BodyData& body = world.bodies[k.body];
    const Vec3 p = body.linearVelocity * step.h, w = body.angularVelocity * step.h;
    float* d = step.d.data() + size_t(8) * k.row;
    d[0] = p.x, d[1] = p.y, d[2] = p.z, d[4] = w.x, d[5] = w.y, d[6] = w.z;
  }
}

}  // namespace avbd
