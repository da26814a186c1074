// Snapshots: vectors by what they differ from those that are expected.
#pragma once

#include "base/bits.h"
#include "world/snapshot_codec.h"

namespace avbd::snapshot {

// Floats as integers in their order, so that near ones differ by little. Each undoes itself.
inline int32_t ordered(float x) {
  const int32_t bits = bitsAs<int32_t>(x);
  return bits < 0 ? bits ^ 0x7fffffff : bits;
}
inline float unordered(int32_t n) { return bitsAs<float>(n < 0 ? n ^ 0x7fffffff : n); }
inline uint32_t zigzag(uint32_t d) { return d << 1 ^ (d >> 31 ? 0xffffffffu : 0u); }
inline uint32_t unzigzag(uint32_t z) { return z >> 1 ^ (z & 1 ? 0xffffffffu : 0u); }

template <class T>
void put(std::byte*& to, const T& value) {
  static_assert(kIsLeaf<T>);
  std::memcpy(to, &value, sizeof(T));
  to += sizeof(T);
}
template <class T>
void put(const std::byte*& from, T& value) {
  static_assert(kIsLeaf<T> && !std::is_same_v<T, bool>);
  std::memcpy(&value, from, sizeof(T));
  from += sizeof(T);
}

/// Numbers by what they differ from the expected ones: 0, 2, 3 or 4 bytes each. Returns which.
template <size_t n>
uint32_t putNear(std::byte*& to, const std::array<float, n>& now, const std::array<float, n>& expected) {
  std::array<uint32_t, n> apart;
  uint32_t all = 0;
  for (size_t i = 0; i < n; ++i) {
    apart[i] = zigzag(static_cast<uint32_t>(ordered(now[i])) - static_cast<uint32_t>(ordered(expected[i])));
    all |= apart[i];
  }
  if (all == 0) return 0;
  const uint32_t way = all < 1u << 16 ? 1 : all < 1u << 24 ? 2 : 3;
  for (const uint32_t d : apart) {
    std::memcpy(to, &d, sizeof(d));  // what is beyond the width is overwritten
    to += way + 1;
  }
  return way;
}
template <size_t n>
void putNear(const std::byte*& from, std::array<float, n>& now, const std::array<float, n>& expected, uint32_t way) {
  now = expected;
  if (way == 0) return;
  for (float& x : now) {
    uint32_t d = 0;
    std::memcpy(&d, from, sizeof(d));
    d &= 0xffffffffu >> (8 * (3 - way));
    from += way + 1;
    x = unordered(static_cast<int32_t>(static_cast<uint32_t>(ordered(x)) + unzigzag(d)));
  }
}

inline uint32_t putNear(std::byte*& to, Vec3 now, Vec3 expected) {
  return putNear<3>(to, {now.x, now.y, now.z}, {expected.x, expected.y, expected.z});
}
inline void putNear(const std::byte*& from, Vec3& now, Vec3 expected, uint32_t way) {
  std::array<float, 3> numbers;
  putNear<3>(from, numbers, {expected.x, expected.y, expected.z}, way);
  now = {numbers[0], numbers[1], numbers[2]};
}
inline uint32_t putNear(std::byte*& to, float now, float expected) { return putNear<1>(to, {now}, {expected}); }
inline void putNear(const std::byte*& from, float& now, float expected, uint32_t way) {
  std::array<float, 1> number;
  putNear<1>(from, number, {expected}, way);
  now = number[0];
}

struct Matrix {
  Vec3 x, y, z;  ///< columns
};
inline Matrix matrixOf(Quat q) {
  const float x = q.x + q.x, y = q.y + q.y, z = q.z + q.z;
  const float xx = q.x * x, yy = q.y * y, zz = q.z * z, xy = q.x * y, xz = q.x * z, yz = q.y * z;
  const float wx = q.w * x, wy = q.w * y, wz = q.w * z;
  return {{1 - (yy + zz), xy + wz, xz - wy}, {xy - wz, 1 - (xx + zz), yz + wx}, {xz + wy, yz - wx, 1 - (xx + yy)}};
}
inline Vec3 operator*(const Matrix& m, Vec3 v) { return m.x * v.x + m.y * v.y + m.z * v.z; }
inline Vec3 transposed(const Matrix& m, Vec3 v) { return {dot(m.x, v), dot(m.y, v), dot(m.z, v)}; }

}  // namespace avbd::snapshot
