// Vectors, rotations and 3x3 matrices over a real R.
#pragma once

#include <avbd/rows/real.h>

namespace avbd::rows {

// ---- Vectors ---------------------------------------------------------------------------------------------------

template <class R>
struct V3 {
  R x, y, z;
};
template <class R>
AVBD_INLINE V3<R> operator+(V3<R> a, V3<R> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class R>
AVBD_INLINE V3<R> operator-(V3<R> a, V3<R> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R>
AVBD_INLINE V3<R> operator-(V3<R> a) {
  return {-a.x, -a.y, -a.z};
}
template <class R>
AVBD_INLINE V3<R> operator*(V3<R> a, Same<R> s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class R>
AVBD_INLINE V3<R> operator*(Same<R> s, V3<R> a) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class R>
AVBD_INLINE V3<R>& operator+=(V3<R>& a, V3<R> b) {
  return a = a + b;
}
template <class R>
AVBD_INLINE V3<R>& operator-=(V3<R>& a, V3<R> b) {
  return a = a - b;
}
template <class R>
AVBD_INLINE V3<R>& operator*=(V3<R>& a, Same<R> s) {
  return a = a * s;
}
template <class R>
AVBD_INLINE R dot(V3<R> a, V3<R> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
AVBD_INLINE V3<R> cross(V3<R> a, V3<R> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class R>
AVBD_INLINE R lengthSq(V3<R> a) {
  return dot(a, a);
}
template <class R>
AVBD_INLINE R length(V3<R> a) {
  return sqrt(dot(a, a));
}
/// a / |a|; a itself where its length is zero.
template <class R>
AVBD_INLINE V3<R> normalised(V3<R> a) {
  const R l = length(a);
  return a * (1.0f / select(l == 0.0f, 1.0f, l));
}
template <class R>
AVBD_INLINE V3<R> select(MaskOf<R> mask, V3<R> a, V3<R> b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
template <class R>
AVBD_INLINE V3<R> splat(V3<float> a) {
  return {R(a.x), R(a.y), R(a.z)};
}
template <class R>
AVBD_INLINE V3<R> zeroV3() {
  return {R(0.0f), R(0.0f), R(0.0f)};
}

/// t1, t2 with (n, t1, t2) right-handed, for a unit n. Turns with n continuously but for one circle 38.7 degrees
/// around -y, kept away from the planes, walls and usual slopes where a resting normal would jitter across it.
template <class R>
AVBD_INLINE void orthonormalBasis(V3<R> n, V3<R>& t1, V3<R>& t2) {
  // The shortest turn of s*y to n, applied to the axes across y.
  const R s = select(n.y < -0.78f, splat<R>(-1.0f), splat<R>(1.0f));
  const R a = 1.0f / (1.0f + s * n.y);
  const R k = n.x * a, m = n.z * a;
  t1 = {1.0f - k * n.x, -s * n.x, -k * n.z};
  t2 = {s * (m * n.x), n.z, s * (m * n.z - 1.0f)};
}

// ---- Rotations -------------------------------------------------------------------------------------------------

template <class R>
struct Q4 {
  R w, x, y, z;
};
template <class R>
AVBD_INLINE Q4<R> identityQuat() {
  return {R(1.0f), R(0.0f), R(0.0f), R(0.0f)};
}
/// Product of rotations: first b, then a.
template <class R>
AVBD_INLINE Q4<R> operator*(Q4<R> a, Q4<R> b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
template <class R>
AVBD_INLINE Q4<R> conjugate(Q4<R> q) {
  return {q.w, -q.x, -q.y, -q.z};
}
template <class R>
AVBD_INLINE V3<R> rotate(Q4<R> q, V3<R> v) {
  const V3<R> u{q.x, q.y, q.z};
  const V3<R> t = 2.0f * cross(u, v);
  return v + q.w * t + cross(u, t);
}
template <class R>
AVBD_INLINE R dot(Q4<R> a, Q4<R> b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}
/// q / |q|; the zero quaternion stays zero.
template <class R>
AVBD_INLINE Q4<R> normalised(Q4<R> q) {
  const R l = sqrt(dot(q, q));
  const R s = 1.0f / select(l == 0.0f, 1.0f, l);
  return {q.w * s, q.x * s, q.y * s, q.z * s};
}
template <class R>
AVBD_INLINE Q4<R> select(MaskOf<R> mask, Q4<R> a, Q4<R> b) {
  return {select(mask, a.w, b.w), select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
/// The finite rotation about v by the angle |v|.
template <class R>
AVBD_INLINE Q4<R> expQuat(V3<R> v) {
  const R half = 0.5f * length(v);
  const SinCos<R> t = sinCos(half);
  // sin(h)/h is exactly 1 for small h, whatever was lost in h; only zero itself (or underflow) needs care.
  const auto tiny = half == 0.0f;
  const R k = 0.5f * select(tiny, 1.0f, t.sin / select(tiny, 1.0f, half));
  return {t.cos, k * v.x, k * v.y, k * v.z};
}
/// Rotation vector of q, angle in [0, pi]: the shorter way. q need not be normalised.
template <class R>
AVBD_INLINE V3<R> logQuat(Q4<R> q) {
  const V3<R> u{q.x, q.y, q.z};
  const R s = length(u);
  const auto tiny = s == 0.0f;
  const R angle = 2.0f * atan2(s, abs(q.w));
  const R k = select(tiny, 2.0f, angle / select(tiny, 1.0f, s));
  return u * select(q.w < 0.0f, -k, k);
}

// ---- 3x3 matrices ----------------------------------------------------------------------------------------------

/// Rows r0, r1, r2.
template <class R>
struct M33 {
  V3<R> r0, r1, r2;
};
template <class R>
AVBD_INLINE V3<R> operator*(M33<R> m, V3<R> v) {
  return {dot(m.r0, v), dot(m.r1, v), dot(m.r2, v)};
}
template <class R>
AVBD_INLINE V3<R> mulTransposed(M33<R> m, V3<R> v) {
  return m.r0 * v.x + m.r1 * v.y + m.r2 * v.z;
}
template <class R>
AVBD_INLINE M33<R> operator+(M33<R> a, M33<R> b) {
  return {a.r0 + b.r0, a.r1 + b.r1, a.r2 + b.r2};
}
template <class R>
AVBD_INLINE M33<R> operator*(M33<R> a, Same<R> s) {
  return {a.r0 * s, a.r1 * s, a.r2 * s};
}
template <class R>
AVBD_INLINE M33<R> transposed(M33<R> m) {
  return {{m.r0.x, m.r1.x, m.r2.x}, {m.r0.y, m.r1.y, m.r2.y}, {m.r0.z, m.r1.z, m.r2.z}};
}
template <class R>
AVBD_INLINE M33<R> operator*(M33<R> a, M33<R> b) {
  return {mulTransposed(b, a.r0), mulTransposed(b, a.r1), mulTransposed(b, a.r2)};
}
/// a b^T
template <class R>
AVBD_INLINE M33<R> outer(V3<R> a, V3<R> b) {
  return {b * a.x, b * a.y, b * a.z};
}
/// Columns are the images of the axes.
template <class R>
AVBD_INLINE M33<R> toMatrix(Q4<R> q) {
  const R x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const R xx = q.x * x2, yy = q.y * y2, zz = q.z * z2;
  const R xy = q.x * y2, xz = q.x * z2, yz = q.y * z2, wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  return {
      {1.0f - (yy + zz), xy - wz, xz + wy}, {xy + wz, 1.0f - (xx + zz), yz - wx}, {xz - wy, yz + wx, 1.0f - (xx + yy)}};
}

template <class R>
struct Sym3 {
  R xx, yy, zz, xy, xz, yz;
};
template <class R>
AVBD_INLINE Sym3<R> diagonal(V3<R> d) {
  return {d.x, d.y, d.z, R(0.0f), R(0.0f), R(0.0f)};
}
template <class R>
AVBD_INLINE V3<R> operator*(Sym3<R> s, V3<R> v) {
  return {s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
          s.xz * v.x + s.yz * v.y + s.zz * v.z};
}
template <class R>
AVBD_INLINE Sym3<R> operator+(Sym3<R> a, Sym3<R> b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
template <class R>
AVBD_INLINE Sym3<R> operator-(Sym3<R> a, Sym3<R> b) {
  return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
}
template <class R>
AVBD_INLINE Sym3<R> operator*(Sym3<R> a, Same<R> s) {
  return {a.xx * s, a.yy * s, a.zz * s, a.xy * s, a.xz * s, a.yz * s};
}
/// s += k v v^T
template <class R>
AVBD_INLINE void addOuter(Sym3<R>& s, Same<R> k, V3<R> v) {
  const V3<R> kv = v * k;
  s = {s.xx + kv.x * v.x, s.yy + kv.y * v.y, s.zz + kv.z * v.z,
       s.xy + kv.x * v.y, s.xz + kv.x * v.z, s.yz + kv.y * v.z};
}
/// M S M^T
template <class R>
AVBD_INLINE Sym3<R> rotated(Sym3<R> s, M33<R> m) {
  const V3<R> a = s * m.r0, b = s * m.r1, c = s * m.r2;
  return {dot(a, m.r0), dot(b, m.r1), dot(c, m.r2), dot(a, m.r1), dot(a, m.r2), dot(b, m.r2)};
}
template <class R>
AVBD_INLINE Sym3<R> rotated(Sym3<R> s, Q4<R> q) {
  return rotated(s, toMatrix(q));
}
/// By cofactors; zero where the determinant is zero.
template <class R>
AVBD_INLINE Sym3<R> inverse(Sym3<R> s) {
  const R cxx = s.yy * s.zz - s.yz * s.yz, cxy = s.xz * s.yz - s.xy * s.zz, cxz = s.xy * s.yz - s.xz * s.yy;
  const R det = s.xx * cxx + s.xy * cxy + s.xz * cxz;
  const auto singular = det == 0.0f;
  const R k = select(singular, 0.0f, 1.0f / select(singular, 1.0f, det));
  return {k * cxx, k * (s.xx * s.zz - s.xz * s.xz), k * (s.xx * s.yy - s.xy * s.xy), k * cxy,
          k * cxz, k * (s.xy * s.xz - s.xx * s.yz)};
}

/// S = L D L^T with unit lower L and inverse pivots i.
template <class R>
struct Ldl3 {
  R l10, l20, l21, i0, i1, i2;
};
/// 1 / pivot; zero where the pivot is not positive: a singular direction does not move. NaN stays NaN.
template <class R>
AVBD_INLINE R inversePivot(R pivot) {
  const auto singular = pivot <= 0.0f;
  return select(singular, 0.0f, 1.0f / select(singular, 1.0f, pivot));
}
template <class R>
AVBD_INLINE Ldl3<R> factor(Sym3<R> s) {
  const R i0 = inversePivot(s.xx);
  const R l10 = s.xy * i0, l20 = s.xz * i0;
  const R i1 = inversePivot(s.yy - l10 * s.xy);
  const R t = s.yz - l20 * s.xy;
  const R l21 = t * i1;
  const R i2 = inversePivot(s.zz - l20 * s.xz - l21 * t);
  return {l10, l20, l21, i0, i1, i2};
}
/// L^-1 v
template <class R>
AVBD_INLINE V3<R> solveLower(Ldl3<R> f, V3<R> v) {
  const R y = v.y - f.l10 * v.x;
  return {v.x, y, v.z - f.l20 * v.x - f.l21 * y};
}
/// L^-T v
template <class R>
AVBD_INLINE V3<R> solveUpper(Ldl3<R> f, V3<R> v) {
  const R y = v.y - f.l21 * v.z;
  return {v.x - f.l10 * y - f.l20 * v.z, y, v.z};
}
/// D^-1 v
template <class R>
AVBD_INLINE V3<R> solveDiagonal(Ldl3<R> f, V3<R> v) {
  return {v.x * f.i0, v.y * f.i1, v.z * f.i2};
}
template <class R>
AVBD_INLINE V3<R> solve(Ldl3<R> f, V3<R> v) {
  return solveUpper(f, solveDiagonal(f, solveLower(f, v)));
}
template <class R>
AVBD_INLINE V3<R> solve3(Sym3<R> s, V3<R> v) {
  return solve(factor(s), v);
}

}  // namespace avbd::rows
