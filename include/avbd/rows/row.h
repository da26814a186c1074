// A row: one scalar condition on the motions of a few blocks, as a family emits it to a sink.
//
// A family is one function template over the real type R (float, or a vector of lanes). It reads the blocks' motions
// d since the start of the step and emits its rows; who listens decides what happens with them (sinks.h). The force of
// a row is F = clamp(s lambda + k C, lower, upper); its sign convention is that of the energy's gradient: the row adds
// J^T F to the gradient, so the force on the blocks is -J^T F.
//
// Two shapes of row:
// - PairRow: between two bodies, force and counter-force at one reference point. The family first calls
//   sink.arms(armA, armB), the vectors from each centre of mass to the reference point; then each row is given as a
//   wrench (lin, ang) about that point: J_A = (lin, armA x lin + ang), J_B = -(lin, armB x lin + ang). Action equals
//   reaction by construction.
// - BlockRow<N>: any N blocks, by their linear motions only (particles, centres of mass): J_i = lin[i].
#pragma once

#include <avbd/rows/math.h>

namespace avbd::rows {

inline constexpr float kInfinity = __builtin_huge_valf();

template <class R>
struct PairRow {
  R C;             ///< violation, stabilised
  V3<R> lin, ang;  ///< wrench about the reference point, on A
  R k;             ///< stiffness in use
  R s;             ///< share of the multiplier: 1 for hard rows, K / (K + rho) for a finite stiffness K
  R lower, upper;  ///< bounds of the force
};

template <class R, int N>
struct BlockRow {
  R C;
  V3<R> lin[N];
  R k, s, lower, upper;
};

/// Motion of A relative to B at the reference point, given the bodies' motions since the start of the step.
template <class R>
AVBD_INLINE Twist<R> relativeMotion(const Twist<R>& dA, const Twist<R>& dB, const V3<R>& armA, const V3<R>& armB) {
  return {dA.lin + cross(dA.ang, armA) - dB.lin - cross(dB.ang, armB), dA.ang - dB.ang};
}

/// The stiffness in use of a hard row that no tree solves: k, or where it carries more, `load` times its multiplier; a
/// row that a spike has reached gets no stiffer than a float can hold beside the mass.
template <class R>
AVBD_INLINE R stiffnessUnder(const R& k, const R& load, const R& lambda) {
  constexpr float kMost = 300;
  return max(k, min(k * kMost, load * abs(lambda)));
}

/// [rad] that a body may turn in a step before joints let their arms in J follow; at twice that they are halfway.
inline constexpr float kFreeTurn = 0.3f;

/// How far the arms in a joint's J go from the start of the step to its end: tau, or, where `adapts` is 1, more if a
/// body turns far. J of the start leads an iteration nowhere near a radian; halfway it is the secant of the turn, but
/// for a twelfth of its square.
template <class R>
AVBD_INLINE R armBlendAt(const R& tau, const R& adapts, const Twist<R>& dA, const Twist<R>& dB) {
  const R turn = sqrt(max(dot(dA.ang, dA.ang), dot(dB.ang, dB.ang)));
  const R beyond = clamp((turn - kFreeTurn) * (1 / kFreeTurn), 0.0f, 1.0f);
  return max(tau, beyond * 0.5f * adapts);
}

}  // namespace avbd::rows
