// Fixed joint: two frames coincide; the ball joint's three rows and three for the rotation.
//
// C_angular = log(exp(dA) q0 exp(-dB)) - alpha log(q0), q0 = rotation from B's joint frame to A's at the step's start,
// in world axes. J_angular is taken as the identity on A and its negative on B, which is exact where the rotations
// coincide; that is where the row keeps them.
#pragma once

#include <avbd/rows/ball_joint.h>

namespace avbd::rows {

template <class R>
struct FixedJoint {
  static constexpr int kRows = 6;
  BallJoint<R> ball;
  Q4<R> q0;
  V3<R> held;    ///< alpha log(q0) [rad]
  R kAngular;    ///< [N m/rad]
  R load;        ///< [1/rad]: as the ball joint's
  V3<R> lambda;  ///< [N m]

  template <class Sink>
  AVBD_INLINE void rows(const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    ball.rows(dA, dB, sink);
    const V3<R> C = logQuat(expQuat(dA.ang) * q0 * conjugate(expQuat(dB.ang))) - held;
    const R o = zero<R>(), one = splat<R>(1), inf = splat<R>(kInfinity);
    const V3<R> none{o, o, o};
    const R stiff = stiffnessUnder(kAngular, load, length(lambda));
    sink.emit(PairRow<R>{C.x, none, V3<R>{one, o, o}, stiff, one, -inf, inf}, lambda.x);
    sink.emit(PairRow<R>{C.y, none, V3<R>{o, one, o}, stiff, one, -inf, inf}, lambda.y);
    sink.emit(PairRow<R>{C.z, none, V3<R>{o, o, one}, stiff, one, -inf, inf}, lambda.z);
  }
};

}  // namespace avbd::rows
