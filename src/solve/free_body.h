// Motion of single bodies, sixteen at a time: where each would go alone, and what its velocities are once the solve has
// said where it went.
#pragma once

#include "avbd/rows/math.h"

namespace avbd {

/// A body at the start of a step. All that is 0 stands for a lane without a body.
template <class R>
struct FreeBody {
  rows::Q4<R> q;
  rows::V3<R> v, w;                   ///< velocities
  rows::V3<R> acceleration, torque;   ///< what gravity and the user's forces make
  rows::Sym3<R> inertia, invInertia;  ///< body axes
  R mass, invMass;
  R keepLinear, keepAngular;                      ///< what damping leaves of velocities over the step
  R freeX, freeY, freeZ, freeRx, freeRy, freeRz;  ///< 0 along locked axes, else 1
  R lockRotation;                                 ///< 1 where any turn is locked, else 0
  R mostLinear, mostAngular;                      ///< greatest speeds
};

/// Its free motion in a step.
template <class R>
struct FreeMotion {
  rows::V3<R> velocity, displacement, turn;
  rows::V3<R> momentum;  ///< angular, world axes, at the end of the step
};

/// Its end after the solve.
template <class R>
struct EndMotion {
  rows::Q4<R> q;
  rows::V3<R> v, w;
};

template <class R>
AVBD_INLINE rows::V3<R> turnedProduct(const rows::Sym3<R>& local, const rows::Q4<R>& q, const rows::V3<R>& v) {
  return rotate(q, local * rotate(conjugate(q), v));
}

template <class R>
AVBD_INLINE rows::V3<R> bounded(const rows::V3<R>& v, const R& most) {
  using rows::select;
  const R size = length(v);
  const auto fast = size > most;
  return v * select(fast, most / select(fast, size, rows::splat<R>(1)), rows::splat<R>(1));
}

/// Explicit for the velocity; for the turn an angular-momentum-conserving midpoint: w = I(q_mid)^-1 L.
template <class R>
AVBD_INLINE FreeMotion<R> freeMotion(const FreeBody<R>& b, float h) {
  using rows::V3, rows::any, rows::select;
  FreeMotion<R> free;
  const V3<R> v = (b.v + b.acceleration * h) * b.keepLinear;
  free.velocity = {v.x * b.freeX, v.y * b.freeY, v.z * b.freeZ};
  free.displacement = free.velocity * h;
  free.momentum = (turnedProduct(b.inertia, b.q, b.w) + b.torque * h) * b.keepAngular;
  V3<R> spin = b.w;
  for (int i = 0; i < 2; ++i) spin = turnedProduct(b.invInertia, rows::expQuat(spin * (0.5f * h)) * b.q, free.momentum);
  // With locked axes the turn is what the torque makes about the free ones, and the momentum is what that has.
  const auto locked = b.lockRotation > 0.0f;
  if (any(locked)) {
    const V3<R> w = (b.w + turnedProduct(b.invInertia, b.q, b.torque) * h) * b.keepAngular;
    const V3<R> about{w.x * b.freeRx, w.y * b.freeRy, w.z * b.freeRz};
    spin = select(locked, about, spin);
    free.momentum = select(locked, turnedProduct(b.inertia, b.q, about), free.momentum);
  }
  free.turn = spin * h;
  return free;
}

/// v = v_free + (dp - y_p) / h, and the angular momentum likewise.
template <class R>
AVBD_INLINE EndMotion<R> endMotion(const FreeBody<R>& b, const FreeMotion<R>& free, const rows::Twist<R>& d, float h) {
  using rows::V3;
  EndMotion<R> end;
  end.q = normalised(rows::expQuat(d.ang) * b.q);
  end.v = bounded(free.velocity + (d.lin - free.displacement) * (1 / h), b.mostLinear);
  const V3<R> gained = turnedProduct(b.inertia, b.q, (d.ang - free.turn) * (1 / h));
  const V3<R> spin = turnedProduct(b.invInertia, end.q, free.momentum + gained);
  end.w = bounded(V3<R>{spin.x * b.freeRx, spin.y * b.freeRy, spin.z * b.freeRz}, b.mostAngular);
  return end;
}

}  // namespace avbd
