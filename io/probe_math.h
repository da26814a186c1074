// Vectors and rotations as probes need them.
#pragma once

#include <avbd/types.h>

#include <cmath>

#include "io/mjcf_math.h"

namespace avbd::probe_math {

using mjcf::cross;

/// Products of float rotations are off by their rounding.
inline Quat unit(Quat q) {
  const float size = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / size, q.x / size, q.y / size, q.z / size};
}

/// Angular momentum of an inertia in the axes of a frame; `angular` and the result in world axes.
inline Vec3d spin(const SymMat3& m, Quat frame, Vec3d angular) {
  const Vec3d w = rotate(conjugate(frame), angular);
  return rotate(frame, Vec3d{m.xx * w.x + m.xy * w.y + m.xz * w.z, m.xy * w.x + m.yy * w.y + m.yz * w.z,
                             m.xz * w.x + m.yz * w.y + m.zz * w.z});
}

inline void put(Vec3d v, double* out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

}  // namespace avbd::probe_math
