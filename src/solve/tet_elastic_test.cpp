// Elastic elements: the gradient is that of the energy, the Hessian that of the gradient where it may be, and never
// negative; no turn costs anything; every width gives the bits of float.
#include "avbd/rows/tet_elastic.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "lane/tile.h"
#include "solve/elastic_cases.h"

namespace avbd::rows {
namespace {

using Points = TetAtRest::Points;
using V = V3<float>;

constexpr Points kRest = TetAtRest::kPoints;

struct Element : TetAtRest {
  float mu = 3, lambda = 11;

  TetElastic<float> rows(const Points& x) const {
    TetElastic<float> rows;
    put(rows, x);
    rows.mu = mu, rows.lambda = lambda, rows.damping = 0;
    return rows;
  }
  /// By the formula, in double.
  double energy(const Points& x) const {
    const std::array<Vec3d, 3> f = deformation(x);
    const double m = double{mu}, l = double{lambda}, J = dot(f[0], crossOf(f[1], f[2])), off = J - 1 - m / l;
    return m / 2 * (dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2]) - 3) + l / 2 * off * off;
  }
};

ElementDraws draws;
Points moved(double size) { return draws.moved(kRest, size); }

TEST(TetElastic, GradientIsTheDerivativeOfTheEnergy) {
  const Element e;
  for (int trial = 0; trial < 20; ++trial) expectGradientOfEnergy(e, moved(0.4), 2e-4);
}

TEST(TetElastic, AtRestNothingPulls) {
  for (const V& g : gradientAt(Element(), kRest)) EXPECT_NEAR(double{length(g)}, 0, 1e-5);
}

TEST(TetElastic, ATurnCostsNothingAndItsHessianSaysSo) { expectTurnsAreFree(Element()); }

void draw(V (&p)[4]) { draws.draw(p); }

TEST(TetElastic, HessianIsTheDerivativeOfTheGradientInAStretchedBar) {
  // No stress sideways: the curvature of J is taken whole.
  const Element e;
  const double y = 1.15, volume = 1 + 3.0 * (y - 1) / (11 * y), side = std::sqrt(volume / y);
  Points x = kRest;
  for (Vec3d& p : x) p = {p.x * side, p.y * y, p.z * side};
  for (const Points& at : {kRest, x}) {
    V p[4], out[4];
    draw(p);
    multiply(opAt(e, at), false, p, out);
    const auto expected = slope(e, at, p);
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(double{length(out[i] - expected[i])}, 0, 0.02);
  }
}

TEST(TetElastic, HessianIsSymmetricAndNeverNegative) {
  const Element e;
  for (const double size : {0.1, 0.5, 2.0})
    for (int trial = 0; trial < 200; ++trial) {
      SCOPED_TRACE(size);
      expectSymmetricAndNotNegative(opAt(e, moved(size)), draws, -0.05);
    }
}

TEST(TetElastic, BlocksAreThoseOfTheHessian) {
  const Element e;
  const Points x = moved(0.3);
  const V none[4] = {};
  const TetElastic<float> rows = e.rows(x);
  const auto state = rows.deformation(none);
  for (size_t i = 0; i < 4; ++i) {
    const Sym3<float> block = solidBlock(rows.op(state).solid, toFloat3(e.g[i]));
    for (int k = 0; k < 3; ++k) {
      V p[4] = {}, out[4];
      p[i] = {k == 0 ? 1.0f : 0, k == 1 ? 1.0f : 0, k == 2 ? 1.0f : 0};
      multiply(opAt(e, x), false, p, out);
      EXPECT_NEAR(double{length(out[i] - block * p[i])}, 0, 1e-4);
    }
  }
}

// ---- Viscosity ---------------------------------------------------------------------------------------------------

constexpr float kDamping = 0.7f;

/// A step from one place to another, by the displacements.
struct Step {
  TetElastic<float> rows;
  V d[4];
  Step(const Element& e, const Points& from, const Points& to) : rows(e.rows(from)) {
    rows.damping = kDamping;
    for (size_t i = 0; i < 4; ++i) d[i] = toFloat3(to[i] - from[i]);
  }
  std::array<V, 4> gradient() const {
    V out[4];
    const auto state = rows.deformation(d);
    rows.gradient(state, rows.op(state), out);
    return {out[0], out[1], out[2], out[3]};
  }
};

/// Green's strain, twice it and plus I, at some points: of the element's linear deformation.
std::array<std::array<double, 3>, 3> squaresAt(const Element& e, const Points& x) {
  const std::array<Vec3d, 3> f = e.deformation(x);
  std::array<std::array<double, 3>, 3> c;
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) c[i][k] = dot(f[i], f[k]);
  return c;
}

/// By the formula of solid.h.
double dissipated(const Element& e, const Points& from, const Points& to) {
  const auto a = squaresAt(e, from), b = squaresAt(e, to);
  double squares = 0, trace = 0;
  for (size_t i = 0; i < 3; ++i) {
    trace += b[i][i] - a[i][i];
    for (size_t k = 0; k < 3; ++k) squares += (b[i][k] - a[i][k]) * (b[i][k] - a[i][k]);
  }
  const double eta = double{kDamping} * double{e.mu}, zeta = double{kDamping} * double{e.lambda - e.mu};
  return eta / 4 * squares + zeta / 8 * trace * trace;
}

TEST(TetElastic, ViscousForceIsTheDerivativeOfWhatTheStepDissipates) {
  const Element e;
  for (int trial = 0; trial < 20; ++trial) {
    const Points from = moved(0.2), to = moved(0.2);
    const auto gradient = Step(e, from, to).gradient();
    for (size_t i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) {
        Points up = to, down = to;
        axisOf(up[i], k) += 1e-5, axisOf(down[i], k) -= 1e-5;
        const double slope =
            (e.energy(up) - e.energy(down) + dissipated(e, from, up) - dissipated(e, from, down)) / 2e-5;
        EXPECT_NEAR(double{axisOf(gradient[i], k)}, slope, 1e-3);
      }
  }
}

TEST(TetElastic, ViscosityDoesNotHinderATurn) {
  const Quat turn = Quat{0.5f, 0.5f, -0.5f, 0.5f};
  Points x;
  for (size_t i = 0; i < 4; ++i) x[i] = rotate(turn, kRest[i]);
  for (const V& g : Step(Element(), kRest, x).gradient()) EXPECT_NEAR(double{length(g)}, 0, 5e-5);
}

TEST(TetElastic, ViscousHessianIsTheDerivativeOfTheForceAndItsBlocksAreThere) {
  const Element e;
  Step step(e, kRest, kRest);
  const auto state = step.rows.deformation(step.d);
  for (size_t i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) {
      V p[4] = {}, out[4];
      p[i] = {k == 0 ? 1.0f : 0, k == 1 ? 1.0f : 0, k == 2 ? 1.0f : 0};
      multiply(step.rows.op(state), true, p, out);
      EXPECT_NEAR(double{length(out[i] - solidBlock(step.rows.op(state).solid, toFloat3(e.g[i])) * p[i])}, 0, 1e-4);
      Points up = kRest, down = kRest;
      axisOf(up[i], k) += 1e-3, axisOf(down[i], k) -= 1e-3;
      const auto a = Step(e, kRest, up).gradient(), b = Step(e, kRest, down).gradient();
      for (size_t n = 0; n < 4; ++n) EXPECT_NEAR(double{length(out[n] - (a[n] - b[n]) * 500.0f)}, 0, 0.03);
    }
}

template <int N>
void expectBitsOfFloat() {
  const Element e;
  lane::Tile<TetElastic> tile;
  for (int l = 0; l < lane::kTile; ++l) tile.set(l, e.rows(moved(0.4)));
  using R = lane::Real<N>;
  for (int o = 0; o < lane::kTile; o += N) {
    const TetElastic<R> wide = tile.template load<N>(o);
    const V3<R> none[4] = {zeroV3<R>(), zeroV3<R>(), zeroV3<R>(), zeroV3<R>()};
    const auto op = wide.op(wide.deformation(none));
    lane::Tile<ElasticOp> ops;
    ops.template store<N>(o, op);
    for (int l = o; l < o + N; ++l) {
      const TetElastic<float> one = tile.get(l);
      const V zero[4] = {};
      const ElasticOp<float> expected = one.op(one.deformation(zero)), got = ops.get(l);
      EXPECT_EQ(std::memcmp(&expected, &got, sizeof(got)), 0) << N << " lanes, lane " << l;
    }
  }
}

TEST(TetElastic, EveryWidthGivesTheBitsOfFloat) {
  expectBitsOfFloat<4>();
  expectBitsOfFloat<8>();
  expectBitsOfFloat<16>();
}

}  // namespace
}  // namespace avbd::rows
