// Ball joint: two anchors coincide; three rows along the world axes.
//
// C = xA + rA - xB - rB - alpha C_start, with the arms r turned by the motion of the step (nonlinear).
// J: each arm is a blend (1 - tau) r_start + tau r_end. tau = 0 is SHAKE: symplectic, unstable under heavy loads;
// tau = 1 is fully implicit and eats energy. See docs/method.md. Bodies that turn far let it grow (armBlendAt).
// Left out: the derivative of J (the solver adds the geometric stiffness).
#pragma once

#include <avbd/rows/row.h>

namespace avbd::rows {

template <class R>
struct BallJoint {
  static constexpr int kRows = 3;
  V3<R> rA, rB;   ///< centre of mass to anchor at the start of the step, world axes
  V3<R> bias;     ///< (1 - alpha) times the gap at the start
  R tau, adapts;  ///< armBlendAt()
  R k;            ///< [N/m]
  R load;         ///< [1/m]: what carries lambda is at least lambda times this stiff
  V3<R> lambda;   ///< [N]

  template <class Sink>
  AVBD_INLINE void rows(const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    const V3<R> endA = rotate(expQuat(dA.ang), rA), endB = rotate(expQuat(dB.ang), rB);
    const R blend = armBlendAt(tau, adapts, dA, dB);
    sink.arms(rA + (endA - rA) * blend, rB + (endB - rB) * blend);
    const V3<R> C = bias + (dA.lin - dB.lin) + (endA - rA) - (endB - rB);
    const R o = zero<R>(), one = splat<R>(1), inf = splat<R>(kInfinity);
    const V3<R> none{o, o, o};
    const R stiff = stiffnessUnder(k, load, length(lambda));
    sink.emit(PairRow<R>{C.x, V3<R>{one, o, o}, none, stiff, one, -inf, inf}, lambda.x);
    sink.emit(PairRow<R>{C.y, V3<R>{o, one, o}, none, stiff, one, -inf, inf}, lambda.y);
    sink.emit(PairRow<R>{C.z, V3<R>{o, o, one}, none, stiff, one, -inf, inf}, lambda.z);
  }
};

}  // namespace avbd::rows
