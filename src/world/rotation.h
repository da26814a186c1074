// Inertia in world axes, in double: for what is read or set between steps (the step has its own in lanes).
#pragma once

#include <avbd/body.h>

#include "geom/sym_mat3d.h"

namespace avbd {

constexpr Vec3d operator*(const SymMat3d& m, Vec3d v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

/// R I R^T.
SymMat3d worldInertia(Quat rotation, const SymMat3& inertia);
/// w with I w = impulse on the axes that are not locked, zero on the others.
Vec3 solveUnlocked(SymMat3d inertia, uint8_t locks, Vec3d impulse);

}  // namespace avbd
