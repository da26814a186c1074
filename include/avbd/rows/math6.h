// Twists, wrenches and symmetric 6x6 blocks of one body over a real R.
#pragma once

#include <avbd/rows/math3.h>

namespace avbd::rows {

/// Linear and angular part: a displacement (dp, dtheta), or a wrench (force, torque).
template <class R>
struct Twist {
  V3<R> lin, ang;
};
template <class R>
AVBD_INLINE Twist<R> zeroTwist() {
  return {zeroV3<R>(), zeroV3<R>()};
}
template <class R>
AVBD_INLINE Twist<R> operator+(Twist<R> a, Twist<R> b) {
  return {a.lin + b.lin, a.ang + b.ang};
}
template <class R>
AVBD_INLINE Twist<R> operator-(Twist<R> a, Twist<R> b) {
  return {a.lin - b.lin, a.ang - b.ang};
}
template <class R>
AVBD_INLINE Twist<R> operator-(Twist<R> a) {
  return {-a.lin, -a.ang};
}
template <class R>
AVBD_INLINE Twist<R> operator*(Twist<R> a, Same<R> s) {
  return {a.lin * s, a.ang * s};
}
template <class R>
AVBD_INLINE Twist<R> operator*(Same<R> s, Twist<R> a) {
  return {a.lin * s, a.ang * s};
}
template <class R>
AVBD_INLINE Twist<R>& operator+=(Twist<R>& a, Twist<R> b) {
  return a = a + b;
}
template <class R>
AVBD_INLINE Twist<R>& operator-=(Twist<R>& a, Twist<R> b) {
  return a = a - b;
}
template <class R>
AVBD_INLINE R dot(Twist<R> a, Twist<R> b) {
  return dot(a.lin, b.lin) + dot(a.ang, b.ang);
}
template <class R>
AVBD_INLINE Twist<R> select(MaskOf<R> mask, Twist<R> a, Twist<R> b) {
  return {select(mask, a.lin, b.lin), select(mask, a.ang, b.ang)};
}
/// X t: the twist of the point at `arm` from the body's reference, (dp + dtheta x arm, dtheta).
template <class R>
AVBD_INLINE Twist<R> shiftToPoint(Twist<R> t, V3<R> arm) {
  return {t.lin + cross(t.ang, arm), t.ang};
}
/// X^T w: the wrench at that point seen from the body's reference, (f, tau + arm x f).
template <class R>
AVBD_INLINE Twist<R> shiftWrench(Twist<R> w, V3<R> arm) {
  return {w.lin, w.ang + cross(arm, w.lin)};
}

/// Symmetric 6x6 by blocks: [ll, al^T; al, aa].
template <class R>
struct Sym6 {
  Sym3<R> ll;  ///< linear rows and columns
  M33<R> al;   ///< angular rows, linear columns
  Sym3<R> aa;  ///< angular rows and columns
};
template <class R>
AVBD_INLINE Sym6<R> zeroSym6() {
  const V3<R> o = zeroV3<R>();
  return {diagonal(o), {o, o, o}, diagonal(o)};
}
template <class R>
AVBD_INLINE Twist<R> operator*(Sym6<R> k, Twist<R> t) {
  return {k.ll * t.lin + mulTransposed(k.al, t.ang), k.al * t.lin + k.aa * t.ang};
}
template <class R>
AVBD_INLINE Sym6<R> operator+(Sym6<R> a, Sym6<R> b) {
  return {a.ll + b.ll, a.al + b.al, a.aa + b.aa};
}
template <class R>
AVBD_INLINE Sym6<R> operator*(Sym6<R> a, Same<R> s) {
  return {a.ll * s, a.al * s, a.aa * s};
}
/// m += k t t^T
template <class R>
AVBD_INLINE void addOuter(Sym6<R>& m, Same<R> k, Twist<R> t) {
  addOuter(m.ll, k, t.lin);
  m.al = m.al + outer(t.ang * k, t.lin);
  addOuter(m.aa, k, t.ang);
}
template <class R>
AVBD_INLINE Sym6<R>& operator+=(Sym6<R>& a, Sym6<R> b) {
  return a = a + b;
}
/// X^T K X with X of shiftToPoint: stiffness at the point at `arm` seen from the body's reference.
template <class R>
AVBD_INLINE Sym6<R> shifted(Sym6<R> k, V3<R> arm) {
  // With A = [arm]x and X = [1, -A; 0, 1]: al' = al + A ll, aa' = aa - al' A - (al A)^T; row i of M A is row_i x arm.
  const V3<R> c0 = cross(arm, V3<R>{k.ll.xx, k.ll.xy, k.ll.xz});
  const V3<R> c1 = cross(arm, V3<R>{k.ll.xy, k.ll.yy, k.ll.yz});
  const V3<R> c2 = cross(arm, V3<R>{k.ll.xz, k.ll.yz, k.ll.zz});
  const M33<R> al = k.al + M33<R>{{c0.x, c1.x, c2.x}, {c0.y, c1.y, c2.y}, {c0.z, c1.z, c2.z}};
  const V3<R> p0 = cross(al.r0, arm), p1 = cross(al.r1, arm), p2 = cross(al.r2, arm);
  const V3<R> q0 = cross(k.al.r0, arm), q1 = cross(k.al.r1, arm), q2 = cross(k.al.r2, arm);
  const Sym3<R> sum{p0.x + q0.x, p1.y + q1.y, p2.z + q2.z, p0.y + q1.x, p0.z + q2.x, p1.z + q2.y};
  return {k.ll, al, k.aa - sum};
}

/// L D L^T of a Sym6 by blocks: ll = first; `low` is L's lower left block; `second` factors the Schur complement.
template <class R>
struct Ldl6 {
  Ldl3<R> first;
  M33<R> low;
  Ldl3<R> second;
};
template <class R>
AVBD_INLINE Ldl6<R> factor(Sym6<R> k) {
  const Ldl3<R> f = factor(k.ll);
  // Row by row, low = al L1^-T D1^-1.
  const V3<R> y0 = solveLower(f, k.al.r0), y1 = solveLower(f, k.al.r1), y2 = solveLower(f, k.al.r2);
  const V3<R> l0 = solveDiagonal(f, y0), l1 = solveDiagonal(f, y1), l2 = solveDiagonal(f, y2);
  const Sym3<R> schur = k.aa - Sym3<R>{dot(l0, y0), dot(l1, y1), dot(l2, y2), dot(l0, y1), dot(l0, y2), dot(l1, y2)};
  return {f, {l0, l1, l2}, factor(schur)};
}
template <class R>
AVBD_INLINE Twist<R> solve(Ldl6<R> f, Twist<R> b) {
  const V3<R> u = solveLower(f.first, b.lin);
  const V3<R> ang = solve(f.second, b.ang - f.low * u);
  return {solveUpper(f.first, solveDiagonal(f.first, u) - mulTransposed(f.low, ang)), ang};
}
/// L^-T D^-1 L^-1 of one 3x3 factor.
template <class R>
AVBD_INLINE Sym3<R> inverse(Ldl3<R> f) {
  const R m = f.l10 * f.l21 - f.l20;  // L^-1 = [1; -l10 1; m -l21 1]
  const R m2 = m * f.i2, n2 = f.l21 * f.i2;
  return {f.i0 + f.l10 * f.l10 * f.i1 + m * m2, f.i1 + f.l21 * n2, f.i2, -(f.l10 * f.i1) - m * n2, m2, -n2};
}
/// The explicit inverse: as many products as a solve, but a shorter chain, for many right-hand sides.
template <class R>
AVBD_INLINE Sym6<R> inverse(Ldl6<R> f) {
  const Sym3<R> aa = inverse(f.second);
  // g = al ll^-1 = low L1^-1, so row i of g is solveUpper(low_i).
  const V3<R> g0 = solveUpper(f.first, f.low.r0), g1 = solveUpper(f.first, f.low.r1);
  const V3<R> g2 = solveUpper(f.first, f.low.r2);
  const M33<R> h{g0 * aa.xx + g1 * aa.xy + g2 * aa.xz, g0 * aa.xy + g1 * aa.yy + g2 * aa.yz,
                 g0 * aa.xz + g1 * aa.yz + g2 * aa.zz};
  const Sym3<R> own = inverse(f.first);
  const Sym3<R> more{g0.x * h.r0.x + g1.x * h.r1.x + g2.x * h.r2.x, g0.y * h.r0.y + g1.y * h.r1.y + g2.y * h.r2.y,
                     g0.z * h.r0.z + g1.z * h.r1.z + g2.z * h.r2.z, g0.x * h.r0.y + g1.x * h.r1.y + g2.x * h.r2.y,
                     g0.x * h.r0.z + g1.x * h.r1.z + g2.x * h.r2.z, g0.y * h.r0.z + g1.y * h.r1.z + g2.y * h.r2.z};
  return {own + more, {-h.r0, -h.r1, -h.r2}, aa};
}
template <class R>
AVBD_INLINE Sym6<R> inverse(Sym6<R> k) {
  return inverse(factor(k));
}

}  // namespace avbd::rows
