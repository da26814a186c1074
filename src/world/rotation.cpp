// Inertia in world axes (rotation.h).
#include "world/rotation.h"

namespace avbd {

SymMat3d worldInertia(Quat q, const SymMat3& i) {
  const SymMat3d body{i.xx, i.yy, i.zz, i.xy, i.xz, i.yz};
  // Columns of I R^T are I times the world axes seen from the body; R turns each back.
  const Quat back = conjugate(q);
  const Vec3d x = rotate(q, body * rotate(back, Vec3d{1, 0, 0}));
  const Vec3d y = rotate(q, body * rotate(back, Vec3d{0, 1, 0}));
  const Vec3d z = rotate(q, body * rotate(back, Vec3d{0, 0, 1}));
  return {x.x, y.y, z.z, 0.5 * (x.y + y.x), 0.5 * (x.z + z.x), 0.5 * (y.z + z.y)};
}

Vec3 solveUnlocked(SymMat3d m, uint8_t locks, Vec3d impulse) {
  // A locked axis gets a row of its own that says "zero".
  if (locks & kLockAngularX) m.xx = 1, m.xy = m.xz = 0, impulse.x = 0;
  if (locks & kLockAngularY) m.yy = 1, m.xy = m.yz = 0, impulse.y = 0;
  if (locks & kLockAngularZ) m.zz = 1, m.xz = m.yz = 0, impulse.z = 0;
  const SymMat3d c{m.yy * m.zz - m.yz * m.yz, m.xx * m.zz - m.xz * m.xz, m.xx * m.yy - m.xy * m.xy,
                   m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy, m.xy * m.xz - m.xx * m.yz};
  const double determinant = m.xx * c.xx + m.xy * c.xy + m.xz * c.xz;
  return toFloat(c * impulse * (1 / determinant));
}

}  // namespace avbd
