// Free motion of one body.
#include "step/free_motion.h"

#include <algorithm>

#include "step/begin_rows.h"

namespace avbd {

Vec3 unlocked(Vec3 v, int locks) { return {locks & 1 ? 0 : v.x, locks & 2 ? 0 : v.y, locks & 4 ? 0 : v.z}; }

Quat quatFromVector(Vec3 v) { return fromRow(rows::expQuat(toRow(v))); }
Quat unit(Quat q) { return fromRow(rows::normalised(toRow(q))); }

float decay(float x) {
  if (x == 0) return 1;
  int halvings = 0;
  for (x = std::clamp(x, 0.0f, 20.0f); x > 0.25f; x *= 0.5f) ++halvings;
  float y = (1 - x * 0.5f + x * x * (1.0f / 12)) / (1 + x * 0.5f + x * x * (1.0f / 12));
  for (; halvings > 0; --halvings) y *= y;
  return y;
}

Vec3 freeAcceleration(const BodyData& body, Vec3 gravity) {
  return gravity * body.gravityScale + body.force * (1 / body.mass);
}

}  // namespace avbd
