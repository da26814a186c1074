// Wide<N>: N floats in a register as the real R of avbd/rows/math.h, and its mask. Same bits in a lane as in float.
#pragma once

#include <avbd/rows/math.h>

#include <cstdint>
#include <type_traits>
#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__ARM_NEON)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace avbd::lane {

using rows::Same;
// The functions of float, which those of Wide would otherwise hide here.
using rows::abs, rows::all, rows::any, rows::copySign, rows::max, rows::min, rows::select, rows::sqrt;

template <int N>
struct Registers {
  typedef float F __attribute__((vector_size(N * 4)));
  typedef int32_t I __attribute__((vector_size(N * 4)));
  /// The same at an address that is only aligned for its elements, and free to alias any float.
  typedef float FLoose __attribute__((vector_size(N * 4), aligned(4), may_alias));
  typedef int32_t ILoose __attribute__((vector_size(N * 4), aligned(4), may_alias));
  typedef float FAligned __attribute__((vector_size(N * 4), may_alias));
};

/// Per lane all bits set or none.
template <int N>
struct Mask {
  using I = typename Registers<N>::I;
  I v;
  AVBD_INLINE friend Mask operator&(Mask a, Mask b) { return {a.v & b.v}; }
  AVBD_INLINE friend Mask operator|(Mask a, Mask b) { return {a.v | b.v}; }
  AVBD_INLINE friend Mask operator^(Mask a, Mask b) { return {a.v ^ b.v}; }
  AVBD_INLINE friend Mask operator!(Mask a) { return {~a.v}; }
};

// Intrinsics where the generic form would be taken apart lane by lane. `value` is a register of N floats or ints.
template <int N, class V>
AVBD_INLINE V sqrtRegister(V value) {
#if defined(__AVX512F__)
  if constexpr (N == 16) return (V)_mm512_maskz_sqrt_ps(0xffff, (__m512)value);
#endif
#if defined(__AVX__)
  if constexpr (N == 8) return (V)_mm256_sqrt_ps((__m256)value);
#endif
#if defined(__SSE2__)
  if constexpr (N == 4) return (V)_mm_sqrt_ps((__m128)value);
#elif defined(__aarch64__)
  if constexpr (N == 4) return (V)vsqrtq_f32((float32x4_t)value);
#elif defined(__wasm_simd128__)
  if constexpr (N == 4) return (V)wasm_f32x4_sqrt((v128_t)value);
#endif
  V root{};
  for (int i = 0; i < N; ++i) root[i] = __builtin_sqrtf(value[i]);
  return root;
}
/// a < b ? a : b, which is what the x86 instruction does, NaN and signed zeros included.
template <int N, class V>
AVBD_INLINE V minRegister(V a, V b) {
#if defined(__AVX512F__)
  if constexpr (N == 16) return (V)_mm512_maskz_min_ps(0xffff, (__m512)a, (__m512)b);
#endif
#if defined(__AVX__)
  if constexpr (N == 8) return (V)_mm256_min_ps((__m256)a, (__m256)b);
#endif
#if defined(__SSE2__)
  if constexpr (N == 4) return (V)_mm_min_ps((__m128)a, (__m128)b);
#endif
  return a < b ? a : b;
}
/// a > b ? a : b
template <int N, class V>
AVBD_INLINE V maxRegister(V a, V b) {
#if defined(__AVX512F__)
  if constexpr (N == 16) return (V)_mm512_maskz_max_ps(0xffff, (__m512)a, (__m512)b);
#endif
#if defined(__AVX__)
  if constexpr (N == 8) return (V)_mm256_max_ps((__m256)a, (__m256)b);
#endif
#if defined(__SSE2__)
  if constexpr (N == 4) return (V)_mm_max_ps((__m128)a, (__m128)b);
#endif
  return a > b ? a : b;
}
/// Bit i is lane i's sign.
template <int N, class V>
AVBD_INLINE uint32_t signBits(V value) {
#if defined(__AVX512DQ__)
  if constexpr (N == 16) return static_cast<uint32_t>(_mm512_movepi32_mask((__m512i)value));
#endif
#if defined(__AVX__)
  if constexpr (N == 8) return static_cast<uint32_t>(_mm256_movemask_ps((__m256)value));
#endif
#if defined(__SSE2__)
  if constexpr (N == 4) return static_cast<uint32_t>(_mm_movemask_ps((__m128)value));
#endif
  uint32_t bits = 0;
  for (int i = 0; i < N; ++i) bits |= static_cast<uint32_t>(value[i] < 0) << i;
  return bits;
}

template <int N>
struct Wide {
  using F = typename Registers<N>::F;
  using I = typename Registers<N>::I;
  F v;

  Wide() = default;
  AVBD_INLINE Wide(float s) : v(s - F{}) {}  // s - 0 keeps a negative zero, 0 + s would not
  AVBD_INLINE explicit Wide(F r) : v(r) {}
  AVBD_INLINE float operator[](int i) const { return v[i]; }

  AVBD_INLINE friend Wide operator+(Wide a, Wide b) { return Wide(a.v + b.v); }
  AVBD_INLINE friend Wide operator-(Wide a, Wide b) { return Wide(a.v - b.v); }
  AVBD_INLINE friend Wide operator*(Wide a, Wide b) { return Wide(a.v * b.v); }
  AVBD_INLINE friend Wide operator/(Wide a, Wide b) { return Wide(a.v / b.v); }
  AVBD_INLINE friend Wide operator-(Wide a) { return Wide(-a.v); }
  AVBD_INLINE friend Wide& operator+=(Wide& a, Wide b) { return a = a + b; }
  AVBD_INLINE friend Wide& operator-=(Wide& a, Wide b) { return a = a - b; }
  AVBD_INLINE friend Wide& operator*=(Wide& a, Wide b) { return a = a * b; }
  AVBD_INLINE friend Wide& operator/=(Wide& a, Wide b) { return a = a / b; }
  AVBD_INLINE friend Mask<N> operator<(Wide a, Wide b) { return {(I)(a.v < b.v)}; }
  AVBD_INLINE friend Mask<N> operator>(Wide a, Wide b) { return {(I)(a.v > b.v)}; }
  AVBD_INLINE friend Mask<N> operator<=(Wide a, Wide b) { return {(I)(a.v <= b.v)}; }
  AVBD_INLINE friend Mask<N> operator>=(Wide a, Wide b) { return {(I)(a.v >= b.v)}; }
  AVBD_INLINE friend Mask<N> operator==(Wide a, Wide b) { return {(I)(a.v == b.v)}; }
  AVBD_INLINE friend Mask<N> operator!=(Wide a, Wide b) { return {(I)(a.v != b.v)}; }
  AVBD_INLINE friend Wide sqrt(Wide a) { return Wide(sqrtRegister<N>(a.v)); }
  AVBD_INLINE friend Wide abs(Wide a) { return Wide((F)((I)a.v & 0x7fffffff)); }
  AVBD_INLINE friend Wide copySign(Wide size, Wide sign) {
    return Wide((F)(((I)size.v & 0x7fffffff) | ((I)sign.v & static_cast<int32_t>(0x80000000))));
  }
  AVBD_INLINE friend Wide min(Wide a, Wide b) { return Wide(minRegister<N>(a.v, b.v)); }
  AVBD_INLINE friend Wide max(Wide a, Wide b) { return Wide(maxRegister<N>(a.v, b.v)); }
};

template <int N>
AVBD_INLINE Wide<N> select(Mask<N> mask, Same<Wide<N>> a, Same<Wide<N>> b) {
  return Wide<N>(mask.v ? a.v : b.v);
}
/// Bit i is lane i.
template <int N>
AVBD_INLINE uint32_t toBits(Mask<N> mask) {
  return signBits<N>(mask.v);
}
AVBD_INLINE uint32_t toBits(bool mask) { return mask; }
template <int N>
AVBD_INLINE bool any(Mask<N> mask) {
  return toBits(mask) != 0;
}
template <int N>
AVBD_INLINE bool all(Mask<N> mask) {
  return toBits(mask) == (1u << N) - 1;
}

/// The real of N lanes: float for one.
template <int N>
struct RealOfLanes {
  using Type = Wide<N>;
};
template <>
struct RealOfLanes<1> {
  using Type = float;
};
template <int N>
using Real = typename RealOfLanes<N>::Type;

/// From an address aligned to the register's size.
template <class R>
AVBD_INLINE R load(const float* p) {
  if constexpr (std::is_same_v<R, float>)
    return *p;
  else
    return R((typename R::F)(*reinterpret_cast<const typename Registers<rows::Lanes<R>::kCount>::FAligned*>(p)));
}
template <class R>
AVBD_INLINE R loadUnaligned(const float* p) {
  if constexpr (std::is_same_v<R, float>)
    return *p;
  else
    return R((typename R::F)(*reinterpret_cast<const typename Registers<rows::Lanes<R>::kCount>::FLoose*>(p)));
}
AVBD_INLINE void store(float* p, float a) { *p = a; }
AVBD_INLINE void storeUnaligned(float* p, float a) { *p = a; }
template <int N>
AVBD_INLINE void store(float* p, Wide<N> a) {
  *reinterpret_cast<typename Registers<N>::FAligned*>(p) = a.v;
}
template <int N>
AVBD_INLINE void storeUnaligned(float* p, Wide<N> a) {
  *reinterpret_cast<typename Registers<N>::FLoose*>(p) = a.v;
}
/// Mask of the lanes whose entry equals `value`, e.g. kinds or colours.
template <class R>
AVBD_INLINE rows::MaskOf<R> lanesEqual(const uint32_t* p, uint32_t value) {
  if constexpr (std::is_same_v<R, float>)
    return *p == value;
  else
    return {(typename R::I)(*reinterpret_cast<const typename Registers<rows::Lanes<R>::kCount>::ILoose*>(p) ==
                            static_cast<int32_t>(value))};
}
/// Mask of the first `count` lanes.
template <class R>
AVBD_INLINE rows::MaskOf<R> firstLanes(int count) {
  if constexpr (std::is_same_v<R, float>) {
    return count > 0;
  } else {
    typename R::I index{};
    for (int i = 0; i < rows::Lanes<R>::kCount; ++i) index[i] = i;
    return {(typename R::I)(index < count)};
  }
}

}  // namespace avbd::lane

namespace avbd::rows {
template <int N>
struct Lanes<lane::Wide<N>> {
  using Mask = lane::Mask<N>;
  static constexpr int kCount = N;
};
}  // namespace avbd::rows
