// D6 joint: six coordinates of frame B in frame A, each locked, limited, driven, with friction, or free.
//
// Coordinates. Linear: q_i = a_i . (pB - pA), a_i the axes of frame A, p the frames' origins.
// Angular, with b_i the axes of frame B and w the turning of B against A:
// - all three locked: C = log(q_A^-1 q_B) in world axes; J = 1, exact where the frames coincide.
// - twist about x: angle of the twist part of the swing-twist decomposition; J = (a1 + b1) / (1 + a1 . b1). Measured as
//   what the motion of the step adds to it: a stiff drive would feel the rounding of a whole angle's rotations.
// - swing about y and z: the rotation vector (0, sy, sz) that takes a1 to b1, seen in frame A. With the components
//   (bx, by, bz) of b1 in frame A and g = s / sin s of the angle s between them, sz = g by, sy = -g bz;
//   J_sz = g (b1 x a2) + by g' (b1 x a1), J_sy = -g (b1 x a3) - bz g' (b1 x a1), g' = dg/dbx = (bx g - 1) / (1 - bx^2).
// - swing locked: its row is C = by (z) or C = -bz (y), whose J = b1 x a2 and a3 x b1 need no division.
// J is the turning's; on A it acts with the opposite sign. Linear rows act at frame B's origin, so that J takes A's
// turning along. Axes and arms in J are a blend (1 - tau) start + tau end, as the ball joint's are, for the same
// reason.
//
// Rows of an axis: the lock (C = q - held, hard), or a lower and an upper limit (hard, one-sided; one row where they
// meet), a drive (C = q - target, of finite stiffness, bounded), friction (C = q - q_start, bounded on both sides),
// what resists by itself (spring, damper, and the inertia that turns with the coordinate, k = a / h^2 about where it
// would go unhindered), and a given force. Rows of the joint: the cone C = u (n - 1), n = |(sy / ly, sz / lz)|,
// one-sided, u what makes it an angle where the step starts; and the turn to a rotation T, C = -log(q_A T q_B^-1) along
// the axes that A had at the start. The normal of an ellipse turns much in a step that meets it at speed: without the
// derivative of the cone's J by the swing, Newton's steps leap to and fro between two sides of the ellipse and settle
// nowhere. That derivative is lambda u / n t t^T along the ellipse, t = (sy J_sz - sz J_sy) / (n ly lz): a row without
// force, k = lambda u / n and J = t. Left out: any other derivative of J.
#pragma once

#include <avbd/rows/row.h>

#include <cstdint>

namespace avbd::rows {

/// Which rows a D6 joint has: bits 0 .. 2 linear x, y, z, bits 3 .. 5 twist, swing y, swing z.
struct D6Axes {
  uint8_t locked = 0, limited = 0, driven = 0, rubbing = 0;
  uint8_t frozen = 0, passive = 0, forced = 0;  ///< frozen: held at one value by limits that meet
  bool cone = false, slerp = false;
  constexpr bool anglesLocked() const { return (locked >> 3) == 7; }
};

/// One coordinate's constants and multipliers. Multipliers act along +q on B.
template <class R>
struct D6Axis {
  R start;                              ///< coordinate at the start of the step, unwrapped [m, rad]
  R held;                               ///< of a lock: what C leaves uncorrected
  R lower, upper;                       ///< of a limit: coordinate at which its row begins to push
  R k, s;                               ///< of lock and limits: stiffness in use and share, 1 where hard
  R load;                               ///< of hard ones: what carries lambda is at least lambda times this stiff
  R target, kDrive, sDrive, driveMost;  ///< of a drive: where C is 0, stiffness in use, share, bound
  R kFriction, frictionMost;
  R rest, kPassive, sPassive;  ///< of what resists by itself
  R force;                     ///< given
  R lambda, lambdaLower, lambdaUpper, lambdaDrive, lambdaFriction, lambdaPassive, lambdaForce;
};

/// A swing cone.
template <class R>
struct D6Cone {
  R inverseY, inverseZ;  ///< 1 / limit, 0 of a side without one
  R upper;               ///< n at which the row begins to push
  R scale;               ///< u
  R k, s, lambda;
  R none;  ///< multiplier of the row without force
};

/// A turn to a rotation.
template <class R>
struct D6Slerp {
  Q4<R> rotation;
  V3<R> target;  ///< where C is zero, along A's axes at the start
  R k, s, most;
  V3<R> lambda;
};

/// A joint's coordinates and their J on A, about the arms.
template <class R>
struct D6Measure {
  R q[6];  ///< unwrapped
  V3<R> lin[6], ang[6];
  V3<R> armA, armB;
  R y, z;            ///< components of b1 along A's axes: sines of the swing
  V3<R> angY, angZ;  ///< J of -z and y
};

/// Calls emit(C, k, s, lower, upper, lambda) for each row of coordinate i, which stands at q.
template <class R, class Emit>
AVBD_INLINE void axisRows(const D6Axes& axes, int i, D6Axis<R>& x, const R& q, Emit&& emit) {
  const R inf = splat<R>(kInfinity), one = splat<R>(1), o = zero<R>();
  if ((axes.locked | axes.frozen) >> i & 1)
    emit(q - x.held, stiffnessUnder(x.k, x.load, x.lambda), one, -inf, inf, x.lambda);
  if (axes.locked >> i & 1) return;
  if (axes.limited >> i & 1) {
    emit(q - x.lower, stiffnessUnder(x.k, x.load, x.lambdaLower), x.s, -inf, o, x.lambdaLower);
    emit(q - x.upper, stiffnessUnder(x.k, x.load, x.lambdaUpper), x.s, o, inf, x.lambdaUpper);
  }
  if (axes.driven >> i & 1) emit(q - x.target, x.kDrive, x.sDrive, -x.driveMost, x.driveMost, x.lambdaDrive);
  if (axes.rubbing >> i & 1) emit(q - x.start, x.kFriction, one, -x.frictionMost, x.frictionMost, x.lambdaFriction);
  if (axes.passive >> i & 1) emit(q - x.rest, x.kPassive, x.sPassive, -inf, inf, x.lambdaPassive);
  if (axes.forced >> i & 1) emit(o, o, o, -x.force, -x.force, x.lambdaForce);
}

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
  R tau, adapts;     ///< armBlendAt()
  V3<R> logHeld;     ///< of three locked angles: what C leaves uncorrected
  D6Axis<R> axis[6];
  D6Cone<R> cone;
  D6Slerp<R> slerp;

  /// The coordinates after the motions, unwrapped.
  AVBD_INLINE void coordinates(const Twist<R>& dA, const Twist<R>& dB, R (&q)[6]) const {
    coordinatesAt(poseAfter(dA, dB), q);
  }

  /// The twist at the start of the step, within half a turn.
  AVBD_INLINE R twistAtStart() const {
    const Q4<R> turn = conjugate(qA) * qB;
    const R half = atan2(turn.x, turn.w);
    return withinHalfTurn(half + half);
  }

  /// The same with J.
  AVBD_INLINE D6Measure<R> measure(const Twist<R>& dA, const Twist<R>& dB) const {
    const Pose6 end = poseAfter(dA, dB);
    const Pose6 j = blended(end, armBlendAt(tau, adapts, dA, dB));
    D6Measure<R> m;
    coordinatesAt(end, m.q);
    m.armA = j.armA, m.armB = j.armB;
    const V3<R> none = zeroV3<R>(), b = end.inA(), atJ = j.inA();
    m.y = b.y, m.z = b.z;
    for (int i = 0; i < 3; ++i) m.lin[i] = -j.a[i], m.ang[i] = none, m.lin[3 + i] = none;
    const R g = swingFactor(atJ.x), slope = swingSlope(atJ.x, g);
    const V3<R> across = cross(j.b1, j.a[0]);
    m.ang[3] = -((j.a[0] + j.b1) * (1.0f / max(1.0f + atJ.x, splat<R>(1e-3f))));
    m.angY = cross(j.b1, j.a[2]), m.angZ = -cross(j.b1, j.a[1]);
    m.ang[4] = m.angY * g + across * (atJ.z * slope);
    m.ang[5] = m.angZ * g - across * (atJ.y * slope);
    return m;
  }

  template <class Sink>
  AVBD_INLINE void rows(const D6Axes& axes, const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    D6Measure<R> m = measure(dA, dB);
    sink.arms(m.armA, m.armB);
    for (int i = 0; i < 3; ++i) emitAxis(axes, i, m, sink);
    if (axes.anglesLocked()) {
      emitLockedAngles(dA, dB, sink);
      return;
    }
    // A locked swing is measured by its sine: no division, and right where it is held.
    if (axes.locked >> 4 & 1) m.q[4] = -m.z, m.ang[4] = m.angY;
    if (axes.locked >> 5 & 1) m.q[5] = m.y, m.ang[5] = m.angZ;
    for (int i = 3; i < 6; ++i) emitAxis(axes, i, m, sink);
    if (axes.cone) emitCone(m, sink);
    if (axes.slerp) emitSlerp(dA, dB, sink);
    if (axes.cone) emitConeTurning(m, sink);
  }

  /// n of the cone.
  AVBD_INLINE R coneMeasure(const R& y, const R& z) const {
    const R ny = y * cone.inverseY, nz = z * cone.inverseZ;
    return sqrt(ny * ny + nz * nz);
  }

  /// C of the turn to a rotation, along A's axes at the start.
  AVBD_INLINE V3<R> slerpMeasure(const Twist<R>& dA, const Twist<R>& dB) const {
    const V3<R> C = -logQuat(expQuat(dA.ang) * qA * slerp.rotation * conjugate(expQuat(dB.ang) * qB));
    const Pose6 start = poseAt(qA, qB);
    return {dot(start.a[0], C), dot(start.a[1], C), dot(start.a[2], C)};
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
    Q4<R> turn;  ///< of B against A in the step
    AVBD_INLINE V3<R> inA() const { return {dot(a[0], b1), dot(a[1], b1), dot(a[2], b1)}; }
  };

  AVBD_INLINE void coordinatesAt(const Pose6& end, R (&q)[6]) const {
    for (int i = 0; i < 3; ++i) q[i] = dot(end.a[i], end.offset);
    const V3<R> b = end.inA();
    const R g = swingFactor(b.x);
    q[3] = twistAfter(end.turn);
    q[4] = -(g * b.z);
    q[5] = g * b.y;
  }

  AVBD_INLINE static R swingSlope(const R& c, const R& g) {
    const R squared = (1.0f - c) * (1.0f + c);
    const auto small = squared < 1e-4f;
    return select(small & (c > 0.0f), splat<R>(-1.0f / 3) - (1.0f - c) * (4.0f / 15),
                  (c * g - 1.0f) / max(squared, splat<R>(1e-6f)));
  }

  /// With r the turning of B against A in the step, q0 = q_A^-1 q_B turns to q0 + q_A^-1 (r - 1) q_B, whose second term
  /// is as exact as the step is small; half the twist is the angle of (w, x).
  AVBD_INLINE R twistAfter(Q4<R> r) const {
    const R sine2 = r.x * r.x + r.y * r.y + r.z * r.z;
    r.w = select(r.w > 0.0f, -sine2 / (1.0f + r.w), r.w - 1.0f);
    const Q4<R> start = conjugate(qA) * qB, more = conjugate(qA) * r * qB;
    const R half =
        atan2(more.x * start.w - start.x * more.w, start.w * (start.w + more.w) + start.x * (start.x + more.x));
    return axis[3].start + withinHalfTurn(half + half);
  }

  AVBD_INLINE Pose6 poseAt(const Q4<R>& turnedA, const Q4<R>& turnedB) const {
    Pose6 p;
    p.turn = identityQuat<R>();
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
    p.turn = conjugate(turnA) * turnB;
    const V3<R> endA = rotate(turnA, armA), endB = rotate(turnB, armB);
    p.offset = offset + (dB.lin - dA.lin) + (endB - armB) - (endA - armA);
    p.armA = endA + p.offset, p.armB = endB;
    return p;
  }
  /// What J is taken from.
  AVBD_INLINE Pose6 blended(const Pose6& end, const R& blend) const {
    Pose6 p = startPose();
    for (int i = 0; i < 3; ++i) p.a[i] += (end.a[i] - p.a[i]) * blend;
    p.b1 += (end.b1 - p.b1) * blend;
    p.armA += (end.armA - p.armA) * blend;
    p.armB += (end.armB - p.armB) * blend;
    return p;
  }

  template <class Sink>
  AVBD_INLINE void emitLockedAngles(const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    const V3<R> C = logHeld - logQuat(expQuat(dA.ang) * qA * conjugate(expQuat(dB.ang) * qB));
    const R o = zero<R>(), one = splat<R>(1), inf = splat<R>(kInfinity);
    const V3<R> none = zeroV3<R>(), unit[3] = {{one, o, o}, {o, one, o}, {o, o, one}};
    const R c[3] = {C.x, C.y, C.z};
    for (int i = 0; i < 3; ++i) {
      const R stiff = stiffnessUnder(axis[3 + i].k, axis[3 + i].load, axis[3 + i].lambda);
      sink.emit(PairRow<R>{c[i], none, -unit[i], stiff, one, -inf, inf}, axis[3 + i].lambda);
    }
  }

  template <class Sink>
  AVBD_INLINE void emitCone(const D6Measure<R>& m, Sink& sink) {
    const R n = coneMeasure(m.q[4], m.q[5]), share = cone.scale / max(n, splat<R>(1e-6f));
    const R y = m.q[4] * cone.inverseY * cone.inverseY * share, z = m.q[5] * cone.inverseZ * cone.inverseZ * share;
    const V3<R> ang = m.ang[4] * y + m.ang[5] * z;
    const R o = zero<R>(), inf = splat<R>(kInfinity);
    sink.emit(PairRow<R>{cone.scale * (n - cone.upper), zeroV3<R>(), ang, cone.k, cone.s, o, inf}, cone.lambda);
  }

  /// The turning of the cone's normal. Last of all rows: where a tree has no room left it may go.
  template <class Sink>
  AVBD_INLINE void emitConeTurning(const D6Measure<R>& m, Sink& sink) {
    const R inverseN = 1.0f / max(coneMeasure(m.q[4], m.q[5]), splat<R>(1e-6f));
    const R k = cone.lambda * cone.scale * inverseN, size = cone.inverseY * cone.inverseZ * inverseN;
    const V3<R> ang = (m.ang[5] * m.q[4] - m.ang[4] * m.q[5]) * size;
    const R o = zero<R>(), inf = splat<R>(kInfinity);
    sink.emit(PairRow<R>{o, zeroV3<R>(), ang, k, o, -inf, inf}, cone.none);
  }

  template <class Sink>
  AVBD_INLINE void emitSlerp(const Twist<R>& dA, const Twist<R>& dB, Sink& sink) {
    const V3<R> C = slerpMeasure(dA, dB) - slerp.target;
    const Pose6 start = poseAt(qA, qB);
    const R c[3] = {C.x, C.y, C.z};
    R* lambda[3] = {&slerp.lambda.x, &slerp.lambda.y, &slerp.lambda.z};
    for (int i = 0; i < 3; ++i)
      sink.emit(PairRow<R>{c[i], zeroV3<R>(), -start.a[i], slerp.k, slerp.s, -slerp.most, slerp.most}, *lambda[i]);
  }

  /// All rows of one coordinate.
  template <class Sink>
  AVBD_INLINE void emitAxis(const D6Axes& axes, int i, const D6Measure<R>& m, Sink& sink) {
    axisRows(axes, i, axis[i], m.q[i],
             [&](const R& C, const R& k, const R& s, const R& lower, const R& upper, R& lambda) {
               sink.emit(PairRow<R>{C, m.lin[i], m.ang[i], k, s, lower, upper}, lambda);
             });
  }
};

}  // namespace avbd::rows
