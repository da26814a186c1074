// Where the iterations of soft bodies start.
//
// The conjugate gradients of a stiff body may end before they are done; what they leave undone stays as the start has
// it. From the particles' velocities alone a stiff mode would then swing on without the force that turns it back, and
// gain energy. So a body starts from rest with as much of its motion as a whole, and as much of the rest of its
// velocities, as lowers the energy of the step (startSofts() in solve/krylov.cpp finds how much).
#include "step/begin_rows.h"
#include "step/free_motion.h"
#include "world/mass.h"
#include "world/soft.h"

namespace avbd {

namespace {

constexpr float kFalling = 0.1f;  ///< of gravity: so near to it is the acceleration of what nothing carries

bool fallsFreely(const WorldData& world, const SoftData& soft) {
  for (const uint32_t slot : soft.bodies) {
    const BodyData& body = world.bodies[slot];
    // A particle is light: alone, what pulls it would take it far out of the body.
    if (dot(body.force, body.force) > 0) return false;
    const Vec3 gravity = world.def.gravity * body.gravityScale, off = body.acceleration - gravity;
    if (dot(off, off) > kFalling * kFalling * dot(gravity, gravity)) return false;
  }
  return true;
}

struct Rigid {
  Vec3d center;
  Vec3 linear, angular;
};

/// The motion as a whole, of the same momentum and angular momentum.
Rigid rigidMotion(const WorldData& world, const SoftData& soft) {
  const Vec3d origin = world.bodies[soft.bodies[0]].position;
  float mass = 0;
  Vec3 moment, momentum;
  for (const uint32_t slot : soft.bodies) {
    const BodyData& body = world.bodies[slot];
    mass += body.mass;
    moment = moment + toFloat(body.position - origin) * body.mass;
    momentum = momentum + body.linearVelocity * body.mass;
  }
  const Vec3 center = moment * (1 / mass), velocity = momentum * (1 / mass);
  SymMat3 inertia{};
  Vec3 spin;
  for (const uint32_t slot : soft.bodies) {
    const BodyData& body = world.bodies[slot];
    const Vec3 r = toFloat(body.position - origin) - center;
    const float m = body.mass;
    inertia.xx += m * (r.y * r.y + r.z * r.z), inertia.yy += m * (r.x * r.x + r.z * r.z);
    inertia.zz += m * (r.x * r.x + r.y * r.y);
    inertia.xy -= m * r.x * r.y, inertia.xz -= m * r.x * r.z, inertia.yz -= m * r.y * r.z;
    spin = spin + cross(r, body.linearVelocity - velocity) * m;
  }
  // So that a straight row of points has one.
  const float least = 1e-5f * (inertia.xx + inertia.yy + inertia.zz);
  inertia.xx += least, inertia.yy += least, inertia.zz += least;
  const SymMat3 inverted = inverse(inertia);
  const Vec3 angular{inverted.xx * spin.x + inverted.xy * spin.y + inverted.xz * spin.z,
                     inverted.xy * spin.x + inverted.yy * spin.y + inverted.yz * spin.z,
                     inverted.xz * spin.x + inverted.yz * spin.y + inverted.zz * spin.z};
  return {origin + toDouble(center), velocity, angular};
}

void write(float* row, Vec3 v) { row[0] = v.x, row[1] = v.y, row[2] = v.z, row[4] = row[5] = row[6] = 0; }

void startSoft(const WorldData& world, StepData& step, const BatchRange& batch, const SoftData& soft) {
  const bool falls = fallsFreely(world, soft);
  const Rigid rigid = falls ? Rigid{} : rigidMotion(world, soft);
  for (const uint32_t slot : soft.bodies) {
    const BodyData& body = world.bodies[slot];
    const size_t at = size_t(8) * (batch.rowBegin + step.rowOf[slot]);
    if (falls) {
      std::copy_n(step.target.data() + at, 8, step.d.data() + at);
      continue;
    }
    const Vec3 whole = rigid.linear + cross(rigid.angular, toFloat(body.position - rigid.center));
    const Vec3 start = unlocked(whole * step.h, body.locks);
    write(step.d.data() + at, {});
    write(step.whole.data() + at, start);
    write(step.deform.data() + at, unlocked(body.linearVelocity * step.h, body.locks) - start);
  }
}

}  // namespace

void predictSofts(const WorldData& world, StepData& step) {
  if (step.islandSofts.empty()) return;
  step.whole.assign(8 * step.rows(), 0);
  step.deform.assign(8 * step.rows(), 0);
  for (const BatchRange& batch : step.batches)
    for (uint32_t n = batch.islandBegin; n < batch.islandBegin + batch.islandCount; ++n)
      for (uint32_t i = 0; i < step.islands[n].softCount; ++i)
        startSoft(world, step, batch, world.softs[step.islandSofts[step.islands[n].softBegin + i]]);
}

}  // namespace avbd
