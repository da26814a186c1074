// Free motion of one body.
#include "step/free_motion.h"

#include <algorithm>

#include "step/begin_rows.h"

namespace avbd {

Vec3 unlocked(Vec3 v, int locks) { return {locks & 1 ? 0 : v.x, locks & 2 ? 0 : v.y, locks & 4 ? 0 : v.z}; }

Vec3 turnedProduct(const SymMat3& local, Quat q, Vec3 v) {
  const Vec3 u = rotate(conjugate(q), v);
  return rotate(q, fromRow(toRow(local) * toRow(u)));
}

Quat quatFromVector(Vec3 v) { return fromRow(rows::expQuat(toRow(v))); }
Quat unit(Quat q) { return fromRow(rows::normalised(toRow(q))); }

float decay(float x) {
  int halvings = 0;
  for (x = std::clamp(x, 0.0f, 20.0f); x > 0.25f; x *= 0.5f) ++halvings;
  float y = (1 - x * 0.5f + x * x * (1.0f / 12)) / (1 + x * 0.5f + x * x * (1.0f / 12));
  for (; halvings > 0; --halvings) y *= y;
  return y;
}

Vec3 freeAcceleration(const BodyData& body, Vec3 gravity) {
  return gravity * body.gravityScale + body.force * (1 / body.mass);
}

FreeMotion freeMotion(const BodyData& body, Vec3 gravity, float h) {
  FreeMotion free;
  const Vec3 acceleration = freeAcceleration(body, gravity);
  free.velocity = unlocked((body.linearVelocity + acceleration * h) * decay(body.linearDamping * h), body.locks);
  free.displacement = free.velocity * h;
  const float keep = decay(body.angularDamping * h);
  if (body.locks >> 3) {
    const Vec3 spin = body.angularVelocity + turnedProduct(body.invInertia, body.rotation, body.torque) * h;
    free.turn = unlocked(spin * keep, body.locks >> 3) * h;
    free.angularMomentum = turnedProduct(body.inertia, body.rotation, free.turn * (1 / h));
    return free;
  }
  free.angularMomentum = (turnedProduct(body.inertia, body.rotation, body.angularVelocity) + body.torque * h) * keep;
  Vec3 spin = body.angularVelocity;
  for (int i = 0; i < 2; ++i) {
    const Quat middle = quatFromVector(spin * (0.5f * h)) * body.rotation;
    spin = turnedProduct(body.invInertia, middle, free.angularMomentum);
  }
  free.turn = spin * h;
  return free;
}

}  // namespace avbd
