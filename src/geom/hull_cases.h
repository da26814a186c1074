// Clouds of points that break hull builders, for tests and benchmarks.
#pragma once

#include <avbd/types.h>

#include <random>
#include <vector>

namespace avbd {

enum class Cloud { Ball, Sphere, Cube, Grid, TurnedGrid, NearlyFlatBox, Duplicates, Rings, Pancake, Needle, Dome };
inline constexpr int kCloudCount = 11;

/// Numbers and directions from a seed, the same with every library.
class CloudSource {
 public:
  explicit CloudSource(uint32_t seed) : random_(seed) {}
  uint32_t bits() { return random_(); }
  float unit() { return static_cast<float>(random_() >> 8) * 0x1p-23f - 1; }
  Vec3 inCube() {
    const float x = unit(), y = unit(), z = unit();
    return {x, y, z};
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = inCube();
      const float l = length(v);
      if (l > 0.1f && l < 1) return v * (1 / l);
    }
  }
  /// On a box's sides, off by up to 5e-5.
  Vec3 nearBox() {
    const float side = (bits() & 1 ? 1.0f : -1.0f) + 5e-5f * unit();
    const uint32_t axis = bits() % 3;
    const Vec3 p = inCube();
    return {axis == 0 ? side : p.x, axis == 1 ? side : p.y, axis == 2 ? side : p.z};
  }

 private:
  std::mt19937 random_;
};

/// About `count` points within 1 of the origin.
inline std::vector<Vec3> cloud(Cloud kind, size_t count, uint32_t seed) {
  CloudSource from(seed);
  std::vector<Vec3> all;
  const int side = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(count)))), m = side - 1;
  for (int n = 0; n < static_cast<int>(count); ++n) {
    const Vec3 cell{2.0f * (n % side) / m - 1, 2.0f * (n / side % side) / m - 1, 2.0f * (n / side / side) / m - 1};
    Vec3 p = from.inCube();
    switch (kind) {
      case Cloud::Ball:
        p = from.direction() * (0.5f + 0.5f * p.x);
        break;
      case Cloud::Sphere:
        p = from.direction();
        break;
      case Cloud::Cube:
        break;
      case Cloud::Grid:
        p = cell;
        break;
      // Coplanar but for rounding.
      case Cloud::TurnedGrid:
        p = rotate(Quat{0.7f, 0.5f, -0.1f, 0.5f}, cell) * 0.57f;
        break;
      case Cloud::NearlyFlatBox:
        p = from.nearBox();
        break;
      case Cloud::Duplicates:
        p = n < 20 ? from.direction() : all[from.bits() % 20];
        break;
      case Cloud::Rings: {  // cospherical with many coplanar: rings of a globe
        const float t = static_cast<float>(n % 16) * 0.392699082f, h = -0.9f + 0.2f * static_cast<float>(n / 16 % 10);
        const float r = std::sqrt(1 - h * h);
        p = {r * std::cos(t), h, r * std::sin(t)};
        break;
      }
      case Cloud::Pancake:
        p.y *= 1e-3f;
        break;
      case Cloud::Needle:
        p.x *= 1e-3f, p.y *= 1e-3f;
        break;
      case Cloud::Dome:  // one side nearly flat: a cap of a large ball
        p.y = -0.001f * (p.x * p.x + p.z * p.z);
        if (n < 4) all.push_back({n & 1 ? 1.0f : -1.0f, -1, n & 2 ? 1.0f : -1.0f});
        break;
    }
    all.push_back(p);
  }
  return all;
}

}  // namespace avbd
