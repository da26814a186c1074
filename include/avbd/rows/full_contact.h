// Full contact: a contact with what few contacts have: torsional and rolling friction, and scaled inverse masses.
//
// Three rows more, on the bodies' relative rotation since the step's start, for all points together: about the normal,
// C = bias + n . (dA - dB), with a torque of at most `torsional` times the sum of the normal forces found just now;
// about the tangents likewise, both in a disc of `rolling` times that sum. bias is (1 - alpha) times the angle turned
// since the rotation stuck. scaleA, scaleB: the contact's wrench acts on A times scaleA and on B times scaleB, so that
// each body's velocity changes by the contact as if its inverse mass and inertia were that much larger. C and J are not
// scaled: the motion is the true one. Who applies a wrench or a Hessian to the bodies takes the scales from here. The
// derivative of the scaled forces, diag(s) J^T k J, is not symmetric where the scales differ; the Hessian in its place
// is k (J_A hessianA, J_B hessianB)^T (J_A hessianA, J_B hessianB) with hessian = s sqrt((s . w) / (s^2 . w)), w the
// bodies' inverse masses along the normal. For one contact alone the iteration d -= H^-1 gradient is then nilpotent:
// exact after two. A body of scale 0 does not move at all.
#pragma once

#include <avbd/rows/contact.h>

namespace avbd::rows {

template <class R>
struct FullContact {
  static constexpr int kRows = 15;
  Contact<R> contact;
  R torsional, rolling;               ///< [m]
  R biasTorsion, bias1, bias2;        ///< [rad]
  R kTorsion, kRolling;               ///< [N m/rad]; 0 where the coefficient is
  R lambdaTorsion, lambda1, lambda2;  ///< [N m]
  R scaleA, scaleB;                   ///< of the inverse masses
  R hessianA, hessianB;

  template <class Sink>
  AVBD_INLINE void rows(const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    const R load = contact.rows(dA, dB, sink);
    const V3<R> turn = dA.ang - dB.ang;
    const R inf = splat<R>(kInfinity), one = splat<R>(1);
    const V3<R>&n = contact.n, &t1 = contact.t1, &t2 = contact.t2;
    const V3<R> none = zeroV3<R>();
    sink.emitBounded(PairRow<R>{biasTorsion + dot(n, turn), none, n, kTorsion, one, -inf, inf}, lambdaTorsion,
                     torsional * load);
    sink.emitCone(PairRow<R>{bias1 + dot(t1, turn), none, t1, kRolling, one, -inf, inf},
                  PairRow<R>{bias2 + dot(t2, turn), none, t2, kRolling, one, -inf, inf}, lambda1, lambda2,
                  rolling * load);
  }
};

}  // namespace avbd::rows
