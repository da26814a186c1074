// Distance of two points: one or two rows along the line between them.
//
// q = |pB - pA|, J_A = -n, n the line's direction. Arms and direction in J are a blend (1 - tau) start + tau end, as
// the ball joint's are, for the same reason. Rows: C = q - upper (pulls, lambda >= 0) and C = q - lower (pushes). Where
// the points meet the line has no direction: it keeps that of the start. Left out: the derivative of n.
#pragma once

#include <avbd/rows/row.h>

namespace avbd::rows {

template <class R>
struct Distance {
  V3<R> offset;      ///< from A's to B's point at the start of the step, world axes [m]
  V3<R> armA, armB;  ///< centre of mass to A's and to B's point
  V3<R> direction;   ///< unit, of the line at the start, or what stands for it
  R tau, adapts;     ///< armBlendAt()
  R swing;           ///< h^2 w, w the inverse mass that swings the line [m/N]
  R start;           ///< distance at the start of the step
  R lower, upper;    ///< at which the rows begin to act
  R k, s;            ///< stiffness in use and share, 1 where hard
  R load;            ///< [1/m] as D6Axis::load
  R lambdaLower, lambdaUpper;
  R lambdaAcross[2];     ///< always 0
  R hasLower, hasUpper;  ///< 1 or 0
  R rigid;               ///< 1: one row that pulls and pushes, at `upper`

  /// How much longer the line is than at the start: no difference of two lengths, which would lose it in rounding.
  AVBD_INLINE R change(const V3<R>& moved) const {
    const V3<R> end = offset + moved;
    const R sum = length(end) + start;
    return dot(moved, end + offset) / max(sum, splat<R>(1e-30f));
  }

  template <class Sink>
  AVBD_INLINE void rows(const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    const V3<R> endA = rotate(expQuat(dA.ang), armA), endB = rotate(expQuat(dB.ang), armB);
    const V3<R> moved = (dB.lin - dA.lin) + (endB - armB) - (endA - armA);
    const V3<R> end = offset + moved;
    const R size = length(end);
    const V3<R> n1 = end * (1.0f / max(size, splat<R>(1e-30f)));
    const auto degenerate = size <= start * 1e-6f;
    const V3<R> now = select(degenerate, direction, n1);
    const R force = lambdaLower + lambdaUpper;
    const R chi = swing * abs(force) / max(size, splat<R>(1e-30f));
    const R lineTurn = sqrt(max(2.0f - 2.0f * dot(now, direction), zero<R>()));
    const R beyond = max((chi - 1.0f) * (1.0f / 3), (lineTurn - kFreeTurn) * (1 / kFreeTurn));
    const R blend = max(armBlendAt(tau, adapts, dA, dB), clamp(beyond, 0.0f, 1.0f) * 0.5f * adapts);
    V3<R> n = direction + (now - direction) * blend;
    n = n * (1.0f / max(length(n), splat<R>(1e-6f)));
    // The rows act at B's point, so that J takes A's turning along.
    sink.arms(armA + (endA - armA) * blend + offset + moved * blend, armB + (endB - armB) * blend);
    const R q = start + change(moved), inf = splat<R>(kInfinity), o = zero<R>();
    const V3<R> none = zeroV3<R>();
    const R across = blend * max(force, o) / max(size, splat<R>(1e-30f));
    if (across > 0.0f) {
      V3<R> t1, t2;
      orthonormalBasis(n, t1, t2);
      sink.emit(PairRow<R>{o, t1, none, across, o, -inf, inf}, lambdaAcross[0]);
      sink.emit(PairRow<R>{o, t2, none, across, o, -inf, inf}, lambdaAcross[1]);
    }
    const R stiff = stiffnessUnder(k, load, force);
    if (rigid > 0.0f) {
      sink.emit(PairRow<R>{q - upper, -n, none, stiff, s, -inf, inf}, lambdaUpper);
      return;
    }
    if (hasLower > 0.0f) sink.emit(PairRow<R>{q - lower, -n, none, stiff, s, -inf, o}, lambdaLower);
    if (hasUpper > 0.0f) sink.emit(PairRow<R>{q - upper, -n, none, stiff, s, o, inf}, lambdaUpper);
  }
};

}  // namespace avbd::rows
