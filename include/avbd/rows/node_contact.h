// Contact of a surface of a soft body: three rows over four nodes, of which the first may be a body that turns.
//
// u = sum of weight_i d_i + weight_0 (turn x arm) is the motion of what touches of the second side against the first
// since the step's start: weights of the first side are negative, and all sum to zero. A point of weight -1 and the
// corners of a face, the ends of two edges, or a body's point, arm from its centre of mass, and the corners of a face.
// C_n = bias_n + n . u with n from the second side to the first, C_t = bias_t + t . u; J_i = weight_i times the
// direction, of the turn weight_0 (arm x direction); constant over the step. Bounds, stiffness and cone are those of a
// contact of bodies (contact.h).
#pragma once

#include <avbd/rows/row.h>

namespace avbd::rows {

template <class R>
struct NodeContact {
  static constexpr int kBlocks = 4;
  V3<R> n, t1, t2;
  V3<R> arm;              ///< of the first node; 0 of a point that does not turn
  R weight[4];            ///< they sum to zero
  R biasN, bias1, bias2;  ///< [m]
  R floorN, floorT;       ///< [N/m]; 0 where there is no contact
  R loadStiffness;        ///< [1/m]
  R stiffest;             ///< [N/m]
  R mu;
  R lambdaN, lambda1, lambda2;  ///< [N]

  template <class Sink>
  AVBD_INLINE void rows(const V3<R> (&d)[4], const V3<R>& turn, Sink& sink) {
    const R inf = splat<R>(kInfinity), one = splat<R>(1);
    const V3<R> none = zeroV3<R>();
    const V3<R> u =
        d[0] * weight[0] + d[1] * weight[1] + d[2] * weight[2] + d[3] * weight[3] + cross(turn, arm) * weight[0];
    const R load = min(stiffest, lambdaN * loadStiffness);
    const R kN = select(floorN > zero<R>(), max(floorN, load), zero<R>());
    const R kT = select(floorT > zero<R>(), max(floorT, load), zero<R>());
    const R normal = sink.emit(PairRow<R>{biasN + dot(n, u), n, none, kN, one, zero<R>(), inf}, lambdaN);
    sink.emitCone(PairRow<R>{bias1 + dot(t1, u), t1, none, kT, one, -inf, inf},
                  PairRow<R>{bias2 + dot(t2, u), t2, none, kT, one, -inf, inf}, lambda1, lambda2, mu * normal);
  }
};

/// What the products with H need of it.
template <class R>
struct NodeContactOp {
  R weight[4];
  V3<R> arm;
  Sym3<R> stiffness;
};

/// H p of the four blocks and of the first one's turn.
template <class R>
AVBD_INLINE void multiply(const NodeContactOp<R>& o, const V3<R> (&p)[4], const V3<R>& turn, V3<R> (&out)[4],
                          V3<R>& outTurn) {
  const V3<R> u = p[0] * o.weight[0] + p[1] * o.weight[1] + p[2] * o.weight[2] + p[3] * o.weight[3] +
                  cross(turn, o.arm) * o.weight[0];
  const V3<R> force = o.stiffness * u;
  for (int i = 0; i < 4; ++i) out[i] = force * o.weight[i];
  outTurn = cross(o.arm, out[0]);
}

}  // namespace avbd::rows
