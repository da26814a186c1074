// For the tests of elements: numbers of all kinds, and draws.
#pragma once

#include <avbd/rows/math3.h>
#include <avbd/types.h>

#include <random>

namespace avbd::rows {

inline V3<float> toFloat3(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline Vec3d crossOf(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

inline double& axisOf(Vec3d& v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }
inline float& axisOf(V3<float>& v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }
inline float axisOf(const V3<float>& v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

/// The places of a test's element, each moved by up to `size`, and directions to multiply.
class ElementDraws {
 public:
  template <class Points>
  Points moved(const Points& rest, double size) {
    std::uniform_real_distribution<double> draw(-size, size);
    Points x = rest;
    for (Vec3d& p : x) p = p + Vec3d{draw(generator_), draw(generator_), draw(generator_)};
    return x;
  }
  void draw(V3<float> (&p)[4]) {
    std::uniform_real_distribution<float> number(-1, 1);
    for (V3<float>& v : p) v = {number(generator_), number(generator_), number(generator_)};
  }

 private:
  std::mt19937 generator_{5};
};

}  // namespace avbd::rows
