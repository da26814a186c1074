// D6 joint: six coordinates of frame B in frame A, each locked, limited, driven, with friction, or free.
//
// Coordinates. Linear: q_i = a_i . (pB - pA), a_i the axes of frame A, p the frames' origins.
// Angular, with b_i the axes of frame B and w the turning of B against A:
// - all three locked: C = log(q_A^-1 q_B) in world axes; J = 1, exact where the frames coincide.
// - twist about x: angle of the twist part of the swing-twist decomposition; J = (a1 + b1) / (1 + a1 . b1).
// - swing about y and z: the rotation vector (0, sy, sz) that takes a1 to b1, seen in frame A. With the components
//   (bx, by, bz) of b1 in frame A and g = s / sin s of the angle s between them, sz = g by, sy = -g bz;
//   J_sz = g (b1 x a2) + by g' (b1 x a1), J_sy = -g (b1 x a3) - bz g' (b1 x a1), g' = dg/dbx = (bx g - 1) / (1 - bx^2).
// - swing locked: its row is C = by (z) or C = -bz (y), whose J = b1 x a2 and a3 x b1 need no division.
// J is the turning's; on A it acts with the opposite sign. Linear rows act at frame B's origin, so that J takes A's
// turning along. Axes and arms in J are a blend (1 - tau) start + tau end, as the ball joint's are, for the same
// reason.
//
// Rows of an axis: the lock (C = q - held, hard), or a lower and an upper limit (hard, one-sided), a drive
// (C = q - target, of finite stiffness, bounded), and friction (C = q - q_start, bounded on both sides).
// Left out: the derivative of J.
#pragma once

#include <avbd/rows/row.h>

#include <cstdint>

namespace avbd::rows {

/// Which rows a D6 joint has: bits 0 .. 2 linear x, y, z, bits 3 .. 5 twist, swing y, swing z.
struct D6Axes {
  uint8_t locked = 0, limited = 0, driven = 0, rubbing = 0;
  constexpr bool anglesLocked() const { return (locked >> 3) == 7; }
};

/// One coordinate's constants and multipliers. Multipliers act along +q on B.
template <class R>
struct D6Axis {
  R start;                              ///< coordinate at the start of the step, unwrapped [m, rad]
  R held;                               ///< of a lock: what C leaves uncorrected
  R lower, upper;                       ///< of a limit: coordinate at which its row begins to push
  R k, s;                               ///< of lock and limits: stiffness in use and share, 1 where hard
  R target, kDrive, sDrive, driveMost;  ///< of a drive: where C is 0, stiffness in use, share, bound
  R kFriction, frictionMost;
  R lambda, lambdaLower, lambdaUpper, lambdaDrive, lambdaFriction;
};

/// Angle within half a turn of zero that differs from x by whole turns.
template <class R>
AVBD_INLINE R withinHalfTurn(R x) {
  return x - nearest(x * 0.159154943f) * (2 * kPi);
}

template <class R>
struct D6Joint {
  V3<R> offset;      ///< from frame A's origin to frame B's at the start of the step, world axes
  V3<R> armA, armB;  ///< centre of mass to frame A's and to frame B's origin
  Q4<R> qA, qB;      ///< frames to world at the start of the step
  R tau;
  R rawTwist;     ///< twist at the start as the rows see it, within half a turn
  V3<R> logHeld;  ///< of three locked angles: what C leaves uncorrected
  D6Axis<R> axis[6];

  /// The coordinates after the motions, unwrapped.
  AVBD_INLINE void coordinates(const Twist<R>& dA, const Twist<R>& dB, R (&q)[6]) const {
    const Pose6 end = poseAfter(dA, dB);
    for (int i = 0; i < 3; ++i) q[i] = dot(end.a[i], end.offset);
    const V3<R> b = end.inA();
    const R g = swingFactor(b.x);
    q[3] = axis[3].start + withinHalfTurn(twistOf(end) - rawTwist);
    q[4] = -(g * b.z);
    q[5] = g * b.y;
  }

  template <class Sink>
  AVBD_INLINE void rows(const D6Axes& axes, const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    const Pose6 end = poseAfter(dA, dB);
    const Pose6 j = blended(end);
    sink.arms(j.armA, j.armB);
    R q[6];
    coordinates(dA, dB, q);
    for (int i = 0; i < 3; ++i) emitAxis(axes, i, q[i], -j.a[i], zeroV3<R>(), sink);
    if (axes.anglesLocked()) {
      emitLockedAngles(dA, dB, sink);
      return;
    }
    const V3<R> b = end.inA(), atJ = j.inA();
    const R g = swingFactor(atJ.x), slope = swingSlope(atJ.x, g);
    const V3<R> across = cross(j.b1, j.a[0]);
    const V3<R> twist = (j.a[0] + j.b1) * (1.0f / max(1.0f + atJ.x, splat<R>(1e-3f)));
    emitAxis(axes, 3, q[3], zeroV3<R>(), -twist, sink);
    // A locked swing is measured by its sine: no division, and right where it is held.
    const bool lockY = axes.locked >> 4 & 1, lockZ = axes.locked >> 5 & 1;
    const V3<R> swingY = lockY ? cross(j.a[2], j.b1) : -(cross(j.b1, j.a[2]) * g) - across * (atJ.z * slope);
    const V3<R> swingZ = lockZ ? cross(j.b1, j.a[1]) : cross(j.b1, j.a[1]) * g + across * (atJ.y * slope);
    emitAxis(axes, 4, lockY ? -b.z : q[4], zeroV3<R>(), -swingY, sink);
    emitAxis(axes, 5, lockZ ? b.y : q[5], zeroV3<R>(), -swingZ, sink);
  }

  /// Angle s over its sine, from the cosine.
  AVBD_INLINE static R swingFactor(const R& c) {
    const R sine = sqrt(max((1.0f - c) * (1.0f + c), zero<R>()));
    const auto small = sine < 1e-3f;
    const R s = atan2(sine, c);
    // 1 + s^2/6 with s^2 = 2 (1 - c) near zero; a half turn has no direction and keeps a bounded factor.
    return select(small & (c > 0.0f), 1.0f + (1.0f - c) * (1.0f / 3), s / max(sine, splat<R>(1e-3f)));
  }

 private:
  struct Pose6 {
    V3<R> a[3], b1, offset, armA, armB;
    Q4<R> qA, qB;
    AVBD_INLINE V3<R> inA() const { return {dot(a[0], b1), dot(a[1], b1), dot(a[2], b1)}; }
  };

  AVBD_INLINE static R swingSlope(const R& c, const R& g) {
    const R squared = (1.0f - c) * (1.0f + c);
    const auto small = squared < 1e-4f;
    return select(small & (c > 0.0f), splat<R>(-1.0f / 3) - (1.0f - c) * (4.0f / 15),
                  (c * g - 1.0f) / max(squared, splat<R>(1e-6f)));
  }

  AVBD_INLINE static R twistOf(const Pose6& p) {
    const Q4<R> turn = conjugate(p.qA) * p.qB;
    const R half = atan2(turn.x, turn.w);
    return withinHalfTurn(half + half);
  }

  AVBD_INLINE Pose6 poseAt(const Q4<R>& turnedA, const Q4<R>& turnedB) const {
    Pose6 p;
    p.qA = turnedA, p.qB = turnedB;
    const R o = zero<R>(), one = splat<R>(1);
    p.a[0] = rotate(turnedA, V3<R>{one, o, o});
    p.a[1] = rotate(turnedA, V3<R>{o, one, o});
    p.a[2] = rotate(turnedA, V3<R>{o, o, one});
    p.b1 = rotate(turnedB, V3<R>{one, o, o});
    return p;
  }
  AVBD_INLINE Pose6 startPose() const {
    Pose6 p = poseAt(qA, qB);
    p.offset = offset;
    p.armA = armA + offset, p.armB = armB;
    return p;
  }
  AVBD_INLINE Pose6 poseAfter(const Twist<R>& dA, const Twist<R>& dB) const {
    const Q4<R> turnA = expQuat(dA.ang), turnB = expQuat(dB.ang);
    Pose6 p = poseAt(turnA * qA, turnB * qB);
    const V3<R> endA = rotate(turnA, armA), endB = rotate(turnB, armB);
    p.offset = offset + (dB.lin - dA.lin) + (endB - armB) - (endA - armA);
    p.armA = endA + p.offset, p.armB = endB;
    return p;
  }
  /// What J is taken from.
  AVBD_INLINE Pose6 blended(const Pose6& end) const {
    Pose6 p = startPose();
    for (int i = 0; i < 3; ++i) p.a[i] += (end.a[i] - p.a[i]) * tau;
    p.b1 += (end.b1 - p.b1) * tau;
    p.armA += (end.armA - p.armA) * tau;
    p.armB += (end.armB - p.armB) * tau;
    return p;
  }

  template <class Sink>
  AVBD_INLINE void emitLockedAngles(const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    const V3<R> C = logHeld - logQuat(expQuat(dA.ang) * qA * conjugate(expQuat(dB.ang) * qB));
    const R o = zero<R>(), one = splat<R>(1), inf = splat<R>(kInfinity);
    const V3<R> none = zeroV3<R>(), unit[3] = {{one, o, o}, {o, one, o}, {o, o, one}};
    const R c[3] = {C.x, C.y, C.z};
    for (int i = 0; i < 3; ++i)
      sink.emit(PairRow<R>{c[i], none, -unit[i], axis[3 + i].k, one, -inf, inf}, axis[3 + i].lambda);
  }

  /// All rows of one coordinate; lin and ang: J on A.
  template <class Sink>
  AVBD_INLINE void emitAxis(const D6Axes& axes, int i, const R& q, const V3<R>& lin, const V3<R>& ang, Sink& sink) {
    D6Axis<R>& x = axis[i];
    const R inf = splat<R>(kInfinity), one = splat<R>(1);
    if (axes.locked >> i & 1) {
      sink.emit(PairRow<R>{q - x.held, lin, ang, x.k, one, -inf, inf}, x.lambda);
      return;
    }
    if (axes.limited >> i & 1) {
      sink.emit(PairRow<R>{q - x.lower, lin, ang, x.k, x.s, -inf, zero<R>()}, x.lambdaLower);
      sink.emit(PairRow<R>{q - x.upper, lin, ang, x.k, x.s, zero<R>(), inf}, x.lambdaUpper);
    }
    if (axes.driven >> i & 1)
      sink.emit(PairRow<R>{q - x.target, lin, ang, x.kDrive, x.sDrive, -x.driveMost, x.driveMost}, x.lambdaDrive);
    if (axes.rubbing >> i & 1)
      sink.emit(PairRow<R>{q - x.start, lin, ang, x.kFriction, one, -x.frictionMost, x.frictionMost}, x.lambdaFriction);
  }
};

}  // namespace avbd::rows
