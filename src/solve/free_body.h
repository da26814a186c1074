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
  rows::Q4<R> middle;    ///< rotation at the middle of the step, at which the step takes the body's inertia
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

/// By Cramer's rule, of a matrix of no unit given by its columns; zero where it is singular.
template <class R>
AVBD_INLINE rows::V3<R> solveColumns(const rows::V3<R> (&c)[3], const rows::V3<R>& v) {
  using rows::abs, rows::select, rows::splat;
  const rows::V3<R> across = cross(c[1], c[2]);
  const R size = dot(c[0], across);
  const auto singular = abs(size) < 1e-6f;
  const R scale = select(singular, rows::zero<R>(), 1.0f / select(singular, splat<R>(1), size));
  return {dot(v, across) * scale, dot(v, cross(c[2], c[0])) * scale, dot(v, cross(c[0], c[1])) * scale};
}

/// One step of Newton's for the midpoint rule I w = exp(-h/2 w) L, in the body's axes at the start of the step.
template <class R>
AVBD_INLINE rows::V3<R> newtonSpin(const rows::Sym3<R>& invInertia, const rows::V3<R>& momentum, const rows::V3<R>& w,
                                   float h) {
  using rows::V3, rows::select, rows::splat, rows::sqrt;
  const R o = rows::zero<R>(), one = splat<R>(1);
  const V3<R> t = w * (0.5f * h);
  const rows::Q4<R> turn = rows::expQuat(t);
  const V3<R> there = rotate(conjugate(turn), momentum);
  // A change u of t turns what stands there by u - first t x u + second t x (t x u), with a = |t|,
  // first = (1 - cos a) / a^2, second = (1 - sin a / a) / a^2.
  const R square = lengthSq(t), sine = length(V3<R>{turn.x, turn.y, turn.z});
  const auto small = square < 1e-4f;
  const R whole = select(small, one, square);
  const R first = select(small, splat<R>(0.5f), 2.0f * sine * sine / whole);
  const R second = select(small, splat<R>(1.0f / 6), (1.0f - 2.0f * sine * turn.w / sqrt(whole)) / whole);
  const auto column = [&](const V3<R>& u) {
    const V3<R> across = cross(t, u);
    return u - invInertia * cross(there, u - across * first + cross(t, across) * second) * (0.5f * h);
  };
  return w - solveColumns<R>({column({one, o, o}), column({o, one, o}), column({o, o, one})}, w - invInertia * there);
}

/// w_mid = I(q_mid)^-1 L, in world axes. Newton's steps start from no turn: the first one then solves
/// I w = L - h/2 w x L, which has a bounded solution for every L, and three more find the root up to 200 rad/s at 60
/// Hz. From the last velocity, whose share along a thin axis can be a hundred times that of the middle, they go astray;
/// fixed-point steps part where (I1/I3 - 1) (1 - cos(h w/2)) > 1, for a rod of 2 m x 6 cm from 7 rad/s on.
template <class R>
AVBD_INLINE rows::V3<R> middleSpin(const FreeBody<R>& b, const rows::V3<R>& momentum, float h) {
  const rows::V3<R> local = rotate(conjugate(b.q), momentum);
  rows::V3<R> w = rows::zeroV3<R>();
  for (int i = 0; i < 4; ++i) w = bounded(newtonSpin(b.invInertia, local, w, h), b.mostAngular);
  return rotate(b.q, w);
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
  V3<R> spin = middleSpin(b, free.momentum, h);
  // With locked axes the turn is what the torque makes about the free ones.
  const auto locked = b.lockRotation > 0.0f;
  if (any(locked)) {
    const V3<R> w = (b.w + turnedProduct(b.invInertia, b.q, b.torque) * h) * b.keepAngular;
    spin = select(locked, V3<R>{w.x * b.freeRx, w.y * b.freeRy, w.z * b.freeRz}, spin);
  }
  free.turn = spin * h;
  free.middle = rows::expQuat(free.turn * 0.5f) * b.q;
  return free;
}

/// v = v_free + (dp - y_p) / h, and the angular momentum likewise; with locked axes the angular velocity.
///
/// What rows give is M (d - y) / h with the M that they were solved with, that of the step's middle. With that of its
/// start, a share of w along the thin axis of a rod that a hinge turns by a comes back (I1/I3) sin^2(a) / 2 times as
/// large.
template <class R>
AVBD_INLINE EndMotion<R> endMotion(const FreeBody<R>& b, const FreeMotion<R>& free, const rows::Twist<R>& d, float h) {
  using rows::V3;
  EndMotion<R> end;
  end.q = normalised(rows::expQuat(d.ang) * b.q);
  end.v = bounded(free.velocity + (d.lin - free.displacement) * (1 / h), b.mostLinear);
  const V3<R> gained = turnedProduct(b.inertia, free.middle, (d.ang - free.turn) * (1 / h));
  const V3<R> spin =
      rows::select(b.lockRotation > 0.0f, d.ang * (1 / h), turnedProduct(b.invInertia, end.q, free.momentum + gained));
  end.w = bounded(V3<R>{spin.x * b.freeRx, spin.y * b.freeRy, spin.z * b.freeRz}, b.mostAngular);
  return end;
}

}  // namespace avbd
