// The real number R and its trigonometry. All mathematics is written once over R: R is float, or a register whose lanes
// are independent blocks.
//
// Every lane must give the bits that float gives, so formulas use only + - * / sqrt and compare-and-select, in the
// written order, and never branch on a value of type R. What R offers besides its operators is the float part below;
// a wide R brings the same functions in its own namespace.
#pragma once

#include <type_traits>

/// Files built for different instruction sets must share no out-of-line function: the linker would keep any one copy.
#define AVBD_INLINE [[gnu::always_inline]] inline

namespace avbd::rows {

// ---- The real number -------------------------------------------------------------------------------------------

/// What a real type is made of; a wide real specialises it.
template <class R>
struct Lanes;
template <>
struct Lanes<float> {
  using Mask = bool;
  static constexpr int kCount = 1;
};
template <class R>
using MaskOf = typename Lanes<R>::Mask;
/// A parameter that does not take part in deduction, so that a plain float may stand for it.
template <class R>
using Same = std::type_identity_t<R>;

template <class R>
AVBD_INLINE R splat(float s) {
  return R(s);
}
template <class R>
AVBD_INLINE R zero() {
  return R(0.0f);
}
AVBD_INLINE float select(bool mask, float a, float b) { return mask ? a : b; }
AVBD_INLINE float sqrt(float a) { return __builtin_sqrtf(a); }
AVBD_INLINE float abs(float a) { return __builtin_fabsf(a); }
AVBD_INLINE float copySign(float size, float sign) { return __builtin_copysignf(size, sign); }
/// b where neither is smaller: a NaN in b comes through, a NaN in a does not.
AVBD_INLINE float min(float a, float b) { return a < b ? a : b; }
AVBD_INLINE float max(float a, float b) { return a > b ? a : b; }
AVBD_INLINE bool any(bool mask) { return mask; }
AVBD_INLINE bool all(bool mask) { return mask; }
/// x within [low, high]; NaN stays NaN, so that a bad state is seen and not repaired.
template <class R>
AVBD_INLINE R clamp(R x, Same<R> low, Same<R> high) {
  return min(high, max(low, x));
}

// ---- Trigonometry: own, because libm differs between platforms -------------------------------------------------

inline constexpr float kPi = 3.14159265358979f;

template <class R>
struct SinCos {
  R sin, cos;
};

/// Nearest integer for |x| < 2^22, by the rounding of a sum whose unit in the last place is one.
template <class R>
AVBD_INLINE R nearest(R x) {
  return (x + 12582912.0f) - 12582912.0f;
}

/// Sine and cosine to 3 ulp for |x| < 8000 rad; bounded, if wrong, for any larger finite angle.
template <class R>
AVBD_INLINE SinCos<R> sinCos(R x) {
  const R k = nearest(x * 0.636619772f);
  // pi/2 in four parts so short that k times each of the first three is exact.
  R r = x - k * 1.5703125f;
  r = r - k * 4.837512969970703e-4f;
  r = r - k * 7.549533620476723e-8f;
  r = r - k * 2.563344068257089e-12f;
  r = clamp(r, -0.79f, 0.79f);
  const R z = r * r;
  // Minimax on [-pi/4, pi/4], relative error 4e-9 and 1e-10.
  const R s = r + r * z * (-0.16666655f + z * (0.008332156f + z * -0.00019514632f));
  const R c = (1.0f - z * 0.5f) + z * z * (0.041666646f + z * (-0.0013887309f + z * 2.4432413e-05f));
  const R turn = k - 4.0f * nearest(k * 0.25f);  // quadrant, -2 .. 2
  const R quarter = abs(turn);
  const auto odd = quarter == 1.0f;
  const auto half = quarter == 2.0f;
  const R sinOdd = select(turn > 0.0f, c, -c);
  const R cosOdd = select(turn > 0.0f, -s, s);
  return {select(odd, sinOdd, select(half, -s, s)), select(odd, cosOdd, select(half, -c, c))};
}

/// Angle of (x, y) in [-pi, pi] to 3 ulp; atan2(0, 0) is 0, the side of a zero x is the positive one.
template <class R>
AVBD_INLINE R atan2(R y, Same<R> x) {
  const R ax = abs(x), ay = abs(y);
  const auto steep = ay > ax;
  const R big = select(steep, ay, ax), small = select(steep, ax, ay);
  // Above tan(pi/8) turn by 45 degrees; one division serves both cases.
  const auto turned = small > big * 0.41421356f;
  const R below = select(turned, big + small, big);
  const R t = select(turned, small - big, small) / select(below == 0.0f, 1.0f, below);
  const R z = t * t;
  R a = t + t * z * (-0.33332947f + z * (0.1997765f + z * (-0.13876975f + z * 0.08051281f)));
  a = select(turned, 0.785398163f + (a - 2.18556941e-8f), a);
  a = select(steep, 1.57079633f - (a + 4.37113883e-8f), a);
  a = select(x < 0.0f, 3.14159265f - (a + 8.74227766e-8f), a);
  return copySign(a, y);
}

/// Arc functions of a value that rounding may have put outside [-1, 1].
template <class R>
AVBD_INLINE R acos(R x) {
  const R c = clamp(x, -1.0f, 1.0f);
  return atan2(sqrt((1.0f - c) * (1.0f + c)), c);
}
template <class R>
AVBD_INLINE R asin(R x) {
  const R s = clamp(x, -1.0f, 1.0f);
  return atan2(s, sqrt((1.0f - s) * (1.0f + s)));
}

}  // namespace avbd::rows
