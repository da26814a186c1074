// Contact: up to four points between two bodies that share a normal; three rows a point.
//
// C_n = bias_n + n . u,  C_t = bias_t + t . u,  u = relative motion of A against B at the point since the step's start.
// bias_n is the penetration beyond the slop at the step's start (negative: a gap); a penetration is scaled down so that
// only a share of it is corrected in one step. J is constant over the step: the arms are those of the step's start.
// Bounds: normal force >= 0; the two tangent forces lie in a disc of radius mu times the normal force found just now.
// Stiffness: k = max(floor, load / depth): the floor is 10 / (w h^2) with w the inverse mass that the row feels, and
// the second part lets a loaded row hold its load at a bounded depth, whatever the masses. Left out: rolling and
// torsional friction (full_contact.h).
#pragma once

#include <avbd/rows/row.h>

namespace avbd::rows {

template <class R>
struct ContactPointRows {
  V3<R> arm;              ///< from the reference point
  R biasN, bias1, bias2;  ///< [m]
  R floorN, floorT;       ///< [N/m]; both 0 where there is no point
  R mu;
  R lambdaN, lambda1, lambda2;  ///< [N]
};

template <class R>
struct Contact {
  static constexpr int kRows = 12;
  V3<R> n, t1, t2;   ///< n from A to B
  V3<R> armA, armB;  ///< centre of mass to reference point, at the start of the step
  R loadStiffness;   ///< [1/m]: 1 / depth
  R stiffest;        ///< [N/m] bound of the load's part: what it takes to move the whole island
  ContactPointRows<R> point[4];

  /// Returns the sum of the normal forces [N].
  template <class Sink>
  AVBD_INLINE R rows(const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    sink.arms(armA, armB);
    const Twist<R> motion = relativeMotion(dA, dB, armA, armB);
    R load = zero<R>();
    for (int i = 0; i < 4; ++i) load = load + pointRows(point[i], motion, sink);
    return load;
  }

 private:
  template <class Sink>
  AVBD_INLINE R pointRows(ContactPointRows<R>& p, const Twist<R>& motion, Sink& sink) {
    const R inf = splat<R>(kInfinity);
    const V3<R> u = motion.lin + cross(motion.ang, p.arm);
    const R one = splat<R>(1);
    const R load = min(stiffest, p.lambdaN * loadStiffness);
    const R kN = select(p.floorN > zero<R>(), max(p.floorN, load), zero<R>());
    const R kT = select(p.floorT > zero<R>(), max(p.floorT, load), zero<R>());
    const R normal = sink.emit(PairRow<R>{p.biasN + dot(n, u), n, cross(p.arm, n), kN, one, zero<R>(), inf}, p.lambdaN);
    sink.emitCone(PairRow<R>{p.bias1 + dot(t1, u), t1, cross(p.arm, t1), kT, one, -inf, inf},
                  PairRow<R>{p.bias2 + dot(t2, u), t2, cross(p.arm, t2), kT, one, -inf, inf}, p.lambda1, p.lambda2,
                  p.mu * normal);
    return normal;
  }
};

}  // namespace avbd::rows
