// For the tests of elements: numbers of all kinds, and draws.
#pragma once

#include <avbd/rows/math3.h>
#include <avbd/types.h>
#include <gtest/gtest.h>

#include <array>
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

inline Vec3d toDouble3(const V3<float>& v) { return {double{v.x}, double{v.y}, double{v.z}}; }

/// A tetrahedron at rest, and the gradients of its points' weights.
struct TetAtRest {
  using Points = std::array<Vec3d, 4>;
  static constexpr Points kPoints = {Vec3d{0, 0, 0}, {1, 0.1, 0}, {0.2, 1.1, -0.1}, {0.1, 0.3, 0.9}};
  Vec3d g[4];

  TetAtRest() {
    const Vec3d b = kPoints[1] - kPoints[0], c = kPoints[2] - kPoints[0], d = kPoints[3] - kPoints[0];
    const double six = dot(b, crossOf(c, d));
    g[1] = crossOf(c, d) * (1 / six), g[2] = crossOf(d, b) * (1 / six), g[3] = crossOf(b, c) * (1 / six);
    g[0] = (g[1] + g[2] + g[3]) * -1.0;
  }
  /// Columns of F.
  std::array<Vec3d, 3> deformation(const Points& x) const {
    std::array<Vec3d, 3> f{};
    for (size_t i = 0; i < 4; ++i)
      f[0] = f[0] + x[i] * g[i].x, f[1] = f[1] + x[i] * g[i].y, f[2] = f[2] + x[i] * g[i].z;
    return f;
  }
  template <class Rows>
  void put(Rows& rows, const Points& x) const {
    rows.ab = toFloat3(x[1] - x[0]), rows.ac = toFloat3(x[2] - x[0]), rows.ad = toFloat3(x[3] - x[0]);
    rows.gb = toFloat3(g[1]), rows.gc = toFloat3(g[2]), rows.gd = toFloat3(g[3]);
  }
};

// Of elements with energy(x) in double and rows(x).

template <class Element>
std::array<V3<float>, 4> gradientAt(const Element& e, const TetAtRest::Points& x) {
  const V3<float> none[4] = {};
  V3<float> out[4];
  const auto rows = e.rows(x);
  const auto state = rows.deformation(none);
  rows.gradient(state, rows.op(state), out);
  return {out[0], out[1], out[2], out[3]};
}

template <class Element>
auto opAt(const Element& e, const TetAtRest::Points& x) {
  const V3<float> none[4] = {};
  const auto rows = e.rows(x);
  return rows.op(rows.deformation(none));
}

/// Of x along p, by the difference of gradients.
template <class Element>
std::array<V3<float>, 4> slope(const Element& e, const TetAtRest::Points& x, const V3<float> (&p)[4]) {
  constexpr double kStep = 1e-3;
  TetAtRest::Points up = x, down = x;
  for (size_t i = 0; i < 4; ++i) up[i] = up[i] + toDouble3(p[i]) * kStep, down[i] = down[i] - toDouble3(p[i]) * kStep;
  const auto a = gradientAt(e, up), b = gradientAt(e, down);
  std::array<V3<float>, 4> out;
  for (size_t i = 0; i < 4; ++i) out[i] = (a[i] - b[i]) * static_cast<float>(0.5 / kStep);
  return out;
}

template <class Element>
void expectGradientOfEnergy(const Element& e, const TetAtRest::Points& x, double tolerance) {
  const auto gradient = gradientAt(e, x);
  for (size_t i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) {
      TetAtRest::Points up = x, down = x;
      axisOf(up[i], k) += 1e-5, axisOf(down[i], k) -= 1e-5;
      EXPECT_NEAR(double{axisOf(gradient[i], k)}, (e.energy(up) - e.energy(down)) / 2e-5, tolerance);
    }
}

template <class Element>
void expectTurnsAreFree(const Element& e) {
  TetAtRest::Points x;
  V3<float> spun[4], out[4];
  for (size_t i = 0; i < 4; ++i) {
    x[i] = rotate(Quat{0.5f, 0.5f, -0.5f, 0.5f}, TetAtRest::kPoints[i]);
    spun[i] = toFloat3(crossOf({0.4, -1, 0.8}, x[i]));
  }
  for (const V3<float>& g : gradientAt(e, x)) EXPECT_NEAR(double{length(g)}, 0, 2e-5);
  multiply(opAt(e, x), false, spun, out);
  for (const V3<float>& q : out) EXPECT_NEAR(double{length(q)}, 0, 2e-5);
}

/// `least`: of p H p, by what it is made of.
template <class Op>
void expectSymmetricAndNotNegative(const Op& op, ElementDraws& draws, double least) {
  V3<float> p[4], r[4], hp[4], hr[4];
  draws.draw(p), draws.draw(r);
  multiply(op, true, p, hp), multiply(op, true, r, hr);
  double pHr = 0, rHp = 0, pHp = 0, scale = 0;
  for (size_t i = 0; i < 4; ++i) {
    pHr += double{dot(p[i], hr[i])}, rHp += double{dot(r[i], hp[i])}, pHp += double{dot(p[i], hp[i])};
    scale += double{length(p[i]) * length(hr[i])};
  }
  EXPECT_NEAR(pHr, rHp, 1e-4 * scale);
  EXPECT_GE(pHp, least * scale);
}

}  // namespace avbd::rows
