// Snapshots: vectors by what they differ from those that are expected.
#pragma once

#include <avbd/rows/real.h>

#include "base/bits.h"
#include "world/snapshot_codec.h"

namespace avbd::snapshot {

// Floats as integers in their order, so that near ones differ by little. Each undoes itself.
inline int32_t ordered(float x) {
  const int32_t bits = bitsAs<int32_t>(x);
  return bits ^ (bits >> 31 & 0x7fffffff);
}
inline float unordered(int32_t n) { return bitsAs<float>(n ^ (n >> 31 & 0x7fffffff)); }
inline uint32_t zigzag(uint32_t d) { return d << 1 ^ (0u - (d >> 31)); }
inline uint32_t unzigzag(uint32_t z) { return z >> 1 ^ (0u - (z & 1)); }

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

/// Writes a value and goes on behind it only if it `counts`: no branch to be guessed.
template <class T>
void putIf(std::byte*& to, bool counts, const T& value) {
  static_assert(kIsLeaf<T>);
  std::memcpy(to, &value, sizeof(T));
  to += counts ? sizeof(T) : 0;
}

// Without branches: which way a number goes cannot be guessed.
constexpr std::array<uint8_t, 4> kBytesOfWay{0, 2, 3, 4};
constexpr std::array<uint32_t, 4> kMaskOfWay{0, 0xffff, 0xffffff, 0xffffffff};

/// Numbers by what they differ from the expected ones: 0, 2, 3 or 4 bytes each. Returns which. Up to 4 bytes behind
/// them are overwritten.
template <size_t n>
AVBD_INLINE uint32_t putNear(std::byte*& to, const std::array<float, n>& now, const std::array<float, n>& expected) {
  std::array<uint32_t, n> apart;
  uint32_t all = 0;
  for (size_t i = 0; i < n; ++i) {
    apart[i] = zigzag(static_cast<uint32_t>(ordered(now[i])) - static_cast<uint32_t>(ordered(expected[i])));
    all |= apart[i];
  }
  const uint32_t way = uint32_t(all > 0) + uint32_t(all >= 1u << 16) + uint32_t(all >= 1u << 24);
  const size_t bytes = kBytesOfWay[way];
  for (const uint32_t d : apart) {
    std::memcpy(to, &d, sizeof(d));  // what is beyond the width is overwritten
    to += bytes;
  }
  return way;
}
template <size_t n>
AVBD_INLINE void putNear(const std::byte*& from, std::array<float, n>& now, const std::array<float, n>& expected,
                         uint32_t way) {
  const uint32_t mask = kMaskOfWay[way];
  const size_t bytes = kBytesOfWay[way];
  for (size_t i = 0; i < n; ++i) {
    uint32_t d = 0;
    std::memcpy(&d, from, sizeof(d));
    from += bytes;
    now[i] = unordered(static_cast<int32_t>(static_cast<uint32_t>(ordered(expected[i])) + unzigzag(d & mask)));
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

// The same of doubles: 0, 2, 4 or 8 bytes each.
inline int64_t ordered(double x) {
  const int64_t bits = bitsAs<int64_t>(x);
  return bits < 0 ? bits ^ 0x7fffffffffffffff : bits;
}
inline double unordered(int64_t n) { return bitsAs<double>(n < 0 ? n ^ 0x7fffffffffffffff : n); }
constexpr std::array<size_t, 4> kBytesOfDoubles{0, 2, 4, 8};

inline uint32_t putNear(std::byte*& to, Vec3d now, Vec3d expected) {
  const auto apart = [](double a, double b) {
    const uint64_t d = static_cast<uint64_t>(ordered(a)) - static_cast<uint64_t>(ordered(b));
    return d << 1 ^ (d >> 63 ? ~uint64_t{0} : 0);
  };
  const std::array<uint64_t, 3> all{apart(now.x, expected.x), apart(now.y, expected.y), apart(now.z, expected.z)};
  const uint64_t any = all[0] | all[1] | all[2];
  const uint32_t way = any == 0 ? 0 : any < uint64_t{1} << 16 ? 1 : any < uint64_t{1} << 32 ? 2 : 3;
  for (const uint64_t d : all) {
    std::memcpy(to, &d, kBytesOfDoubles[way]);
    to += kBytesOfDoubles[way];
  }
  return way;
}
inline void putNear(const std::byte*& from, Vec3d& now, Vec3d expected, uint32_t way) {
  const auto from1 = [&](double& x, double near) {
    uint64_t d = 0;
    std::memcpy(&d, from, kBytesOfDoubles[way]);
    from += kBytesOfDoubles[way];
    x = unordered(static_cast<int64_t>(static_cast<uint64_t>(ordered(near)) + (d >> 1 ^ (d & 1 ? ~uint64_t{0} : 0))));
  };
  from1(now.x, expected.x), from1(now.y, expected.y), from1(now.z, expected.z);
}

}  // namespace avbd::snapshot
