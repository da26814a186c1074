// Geometric stiffness of a joint: how its torque r x f changes when the arm r turns, made positive semi-definite.
#pragma once

#include "avbd/rows/math.h"

namespace avbd::rows {

/// G = (f . r) I - sym(f r^T) + (|f||r| - f . r) / 2 I for the force f on a body at the arm r.
template <class R>
AVBD_INLINE Sym3<R> geometricStiffness(const V3<R>& f, const V3<R>& r) {
  const R fr = dot(f, r);
  const R size = sqrt(dot(f, f) * dot(r, r));
  const R d = fr + (size - fr) * 0.5f;
  return {d - f.x * r.x,
          d - f.y * r.y,
          d - f.z * r.z,
          -0.5f * (f.x * r.y + f.y * r.x),
          -0.5f * (f.x * r.z + f.z * r.x),
          -0.5f * (f.y * r.z + f.z * r.y)};
}

}  // namespace avbd::rows
