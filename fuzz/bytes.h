// The fuzzer's input as a stream of choices and numbers.
#pragma once

#include <avbd/types.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace avbd::fuzz {

/// Reads from the front; past the end everything is zero.
class Bytes {
 public:
  Bytes(const uint8_t* data, size_t size) : data_(data), left_(size) {}
  bool empty() const { return left_ == 0; }
  uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  uint32_t below(uint32_t n) { return byte() % n; }
  bool flag() { return byte() & 1; }
  template <class T>
  T raw() {
    std::array<uint8_t, sizeof(T)> bytes;
    for (size_t i = 0; i < sizeof(T); ++i) bytes[i] = byte();
    return std::bit_cast<T>(bytes);
  }
  /// Mostly within -8 .. 8 in steps of 1/16, sometimes a value at or beyond the bounds of what is allowed.
  float number() {
    const uint8_t kind = byte();
    if (kind < 240) return static_cast<float>(static_cast<int8_t>(byte())) / 16;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kExtremes[] = {0,    -0.0f, 1e-30f, -1e-30f, 1e-7f,     1e-6f,     1e6f,
                                   1e9f, 1e18f, 3e38f,  -3e38f,  kInfinity, -kInfinity};
    if (kind < 252) return kExtremes[byte() % std::size(kExtremes)];
    return kind < 254 ? std::numeric_limits<float>::quiet_NaN() : raw<float>();
  }
  float positive() {
    const float x = number();
    return x < 0 ? -x : x;
  }
  Vec3 vector() { return {number(), number(), number()}; }
  Vec3d position() { return toDouble(vector()); }
  Quat rotation() {
    if (byte() < 128) return {};
    const Quat q{number(), number(), number(), number()};
    if (byte() < 16) return q;
    const float l = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return l > 0 ? Quat{q.w / l, q.x / l, q.y / l, q.z / l} : Quat{};
  }
  Pose pose() { return {position(), rotation()}; }

 private:
  const uint8_t* data_;
  size_t left_;
};

}  // namespace avbd::fuzz
