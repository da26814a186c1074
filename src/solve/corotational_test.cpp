// Co-rotational solids: the rotation is the nearest of any F; the gradient is that of the energy, the Hessian that of
// the gradient where it may be, and never negative; no turn costs anything; every width gives the bits of float.
#include "avbd/rows/corotational.h"

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
using F = Columns<float>;
/// Columns, in double.
using Exact = std::array<Vec3d, 3>;

constexpr Points kRest = TetAtRest::kPoints;
const Quat kTurn{0.5f, 0.5f, -0.5f, 0.5f};

ElementDraws draws;
Points moved(double size) { return draws.moved(kRest, size); }

Exact toExact(const F& f) { return {toDouble3(f.x), toDouble3(f.y), toDouble3(f.z)}; }
F toColumns(const Exact& f) { return {toFloat3(f[0]), toFloat3(f[1]), toFloat3(f[2])}; }
double contraction(const Exact& a, const Exact& b) { return dot(a[0], b[0]) + dot(a[1], b[1]) + dot(a[2], b[2]); }

/// The nearest rotation by another way: turns about the axes of what is left of a moment, in double, from a start.
Exact nearestRotation(const Exact& f, Exact r) {
  r[0] = r[0] * (1 / std::sqrt(dot(r[0], r[0])));  // a start of floats has no right angles in double
  r[1] = r[1] - r[0] * dot(r[0], r[1]), r[1] = r[1] * (1 / std::sqrt(dot(r[1], r[1])));
  r[2] = crossOf(r[0], r[1]);
  for (int i = 0; i < 2000; ++i) {
    Vec3d moment;
    for (size_t k = 0; k < 3; ++k) moment = moment + crossOf(r[k], f[k]);
    const Vec3d axis = moment * (1 / (std::fabs(contraction(r, f)) + 1e-9));
    const double angle = std::sqrt(dot(axis, axis));
    if (angle < 1e-13) break;
    const Vec3d n = axis * (1 / angle);
    for (Vec3d& v : r)
      v = v * std::cos(angle) + crossOf(n, v) * std::sin(angle) + n * (dot(n, v) * (1 - std::cos(angle)));
  }
  return r;
}

Exact anyF(double size) {
  const Points p = draws.moved(Points{}, size);
  return {p[0], p[1], p[2]};
}

void expectRotation(const F& r) {
  const Exact e = toExact(r);
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(dot(e[i], e[k]), i == k, 5e-7);
  EXPECT_GT(dot(e[0], crossOf(e[1], e[2])), 0);
}

TEST(Polar, IsTheNearestRotation) {
  for (int trial = 0; trial < 500; ++trial) {
    const Exact f = anyF(2);
    const Polar<float> polar = polarOf(toColumns(f));
    expectRotation(polar.turn);
    EXPECT_GE(polar.most, polar.mean - 1e-5f);
    EXPECT_GE(polar.mean, std::fabs(polar.least) - 1e-5f);
    // No rotation has a greater tr(R^T F): not where a search from it ends, nor from others.
    const double reached = contraction(toExact(polar.turn), f);
    EXPECT_NEAR(reached, double{polar.most + polar.mean + polar.least}, 3e-6 * reached);
    for (const Exact& start : {toExact(polar.turn), Exact{Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               Exact{Vec3d{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}})
      EXPECT_LE(contraction(nearestRotation(f, start), f), reached * (1 + 1e-6));
  }
}

TEST(Polar, OfASmallStrainHasItsTurnToTheLastBits) {
  for (int trial = 0; trial < 200; ++trial) {
    Exact f = anyF(0.01);
    f[0].x += 1, f[1].y += 1, f[2].z += 1;
    for (Vec3d& v : f) v = rotate(kTurn, v);
    const Exact r = toExact(polarOf(toColumns(f)).turn), exact = nearestRotation(f, r);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(dot(r[i] - exact[i], r[i] - exact[i]), 0, 4e-7 * 4e-7);
  }
}

TEST(Polar, OfAFlatACollapsedAndAMirroredFIsARotation) {
  const V o{0, 0, 0}, x{1, 0, 0}, y{0, 2, 0}, z{0, 0, 0.5f}, tiny{1e-20f, 1e-22f, 0};
  for (const F& f : {F{x, y, o}, F{o, y, z}, F{x, x, x}, F{o, o, z}, F{o, o, o}, F{x, y, -z}, F{-x, -x, -x},
                     F{V{-1, 0, 0}, V{0, -1, 0}, V{0, 0, -1}}, F{tiny, y, x}, F{tiny, tiny, tiny}, F{y, x, z}}) {
    const Polar<float> polar = polarOf(f);
    expectRotation(polar.turn);
    EXPECT_TRUE(std::isfinite(polar.least));
  }
}

struct Element : TetAtRest {
  float mu = 3, lambda = 5;

  TetCorotational<float> rows(const Points& x) const {
    TetCorotational<float> rows;
    put(rows, x);
    rows.mu = mu, rows.lambda = lambda, rows.damping = 0;
    return rows;
  }
  /// By the formula, in double.
  double energy(const Points& x) const {
    const Exact f = deformation(x), r = nearestRotation(f, toExact(polarOf(toColumns(f)).turn));
    const Exact off{f[0] - r[0], f[1] - r[1], f[2] - r[2]};
    const double trace = contraction(r, f) - 3;
    return double{mu} * contraction(off, off) + double{lambda} / 2 * trace * trace;
  }
};

/// Of stretches that nearly cancel neither energy nor forces have a derivative.
bool isSmooth(const Element& e, const Points& x) {
  const Polar<float> polar = polarOf(toColumns(e.deformation(x)));
  return polar.mean + polar.least > 0.2f;
}

TEST(TetCorotational, GradientIsTheDerivativeOfTheEnergy) {
  const Element e;
  int inverted = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Points x = moved(0.8);
    if (!isSmooth(e, x)) continue;
    inverted += polarOf(toColumns(e.deformation(x))).least < 0;
    expectGradientOfEnergy(e, x, 3e-4);
  }
  EXPECT_GT(inverted, 3);
}

TEST(TetCorotational, AtRestNothingPulls) {
  for (const V& g : gradientAt(Element(), kRest)) EXPECT_NEAR(double{length(g)}, 0, 1e-5);
}

TEST(TetCorotational, ATurnCostsNothingAndItsHessianSaysSo) { expectTurnsAreFree(Element()); }

TEST(TetCorotational, ForcesTurnWithTheElement) {
  const Element e;
  for (int trial = 0; trial < 20; ++trial) {
    const Points x = moved(0.3);
    Points turned;
    for (size_t i = 0; i < 4; ++i) turned[i] = rotate(kTurn, x[i]);
    const auto here = gradientAt(e, x), there = gradientAt(e, turned);
    for (size_t i = 0; i < 4; ++i) {
      const Vec3d off = rotate(kTurn, toDouble3(here[i])) - toDouble3(there[i]);
      EXPECT_NEAR(std::sqrt(dot(off, off)), 0, 3e-5);
    }
  }
}

TEST(TetCorotational, HookesLawAtASmallStrain) {
  const Element e;
  const F small{{1.001f, 0.0004f, 0.0002f}, {0.0004f, 0.9995f, 0}, {0.0002f, 0, 1.0007f}};
  const CorotationalOp<float> op = corotationalOp<float>(small, e.mu, e.lambda, 0);
  const F stress = elasticStress(op);
  const float pressure = e.lambda * (0.001f - 0.0005f + 0.0007f);
  EXPECT_NEAR(stress.x.x, 2 * e.mu * 0.001f + pressure, 1e-5f);
  EXPECT_NEAR(stress.y.y, 2 * e.mu * -0.0005f + pressure, 1e-5f);
  EXPECT_NEAR(stress.z.z, 2 * e.mu * 0.0007f + pressure, 1e-5f);
  EXPECT_NEAR(stress.x.y, 2 * e.mu * 0.0004f, 1e-5f);
  EXPECT_NEAR(stress.z.x, 2 * e.mu * 0.0002f, 1e-5f);
}

TEST(TetCorotational, HessianIsTheDerivativeOfTheGradientAtRestAndWhereItIsStretched) {
  const Element e;
  for (int trial = 0; trial < 20; ++trial) {
    // With p >= 0 and no sum of two stretches below 2 nothing is bounded.
    Points x = kRest;
    const double a = 1 + 0.02 * trial, b = 1 + 0.01 * trial;
    for (Vec3d& at : x) at = rotate(kTurn, Vec3d{at.x * a, at.y * b + 0.01 * trial * at.x, at.z});
    V p[4], out[4];
    draws.draw(p);
    multiply(opAt(e, x), false, p, out);
    const auto expected = slope(e, x, p);
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(double{length(out[i] - expected[i])}, 0, 0.02) << trial;
  }
}

TEST(TetCorotational, HessianIsSymmetricAndNeverNegative) {
  const Element e;
  for (const double size : {0.1, 0.5, 2.0})
    for (int trial = 0; trial < 500; ++trial) {
      SCOPED_TRACE(size);
      expectSymmetricAndNotNegative(opAt(e, moved(size)), draws, -1e-5);
    }
}

TEST(TetCorotational, BlocksAreThoseOfTheHessian) {
  const Element e;
  for (const double size : {0.3, 1.5}) {
    const Points x = moved(size);
    TetCorotational<float> rows = e.rows(x);
    rows.damping = 0.7f;
    const V none[4] = {};
    const auto op = rows.op(rows.deformation(none));
    for (size_t i = 0; i < 4; ++i) {
      const Sym3<float> block = solidBlock(op.solid, toFloat3(e.g[i]));
      for (int k = 0; k < 3; ++k) {
        V p[4] = {}, out[4], without[4];
        p[i] = {k == 0 ? 1.0f : 0, k == 1 ? 1.0f : 0, k == 2 ? 1.0f : 0};
        multiply(op, true, p, out), multiply(op, false, p, without);
        EXPECT_GT(double{length(out[i] - without[i])}, 0.1);
        EXPECT_NEAR(double{length(out[i] - block * p[i])}, 0, 1e-5 * double{length(out[i])} + 1e-4);
      }
    }
  }
}

/// Down the forces alone.
TEST(TetCorotational, AnInvertedElementComesBack) {
  const Element e;
  for (int trial = 0; trial < 30; ++trial) {
    Points x = draws.moved(Points{kRest[0], kRest[1], kRest[2], Vec3d{0.4, 0.4, -0.8}}, 0.1);
    const double before = e.energy(x);
    for (int i = 0; i < 2000; ++i) {
      const auto g = gradientAt(e, x);
      for (size_t n = 0; n < 4; ++n) x[n] = x[n] - toDouble3(g[n]) * 0.01;
    }
    EXPECT_GT(before, 1);
    EXPECT_LT(e.energy(x), 1e-4) << trial;
  }
}

template <int N>
void expectBitsOfFloat() {
  const Element e;
  lane::Tile<TetCorotational> tile;
  for (int l = 0; l < lane::kTile; ++l) tile.set(l, e.rows(l == 3 ? Points{} : moved(l % 2 ? 0.1 : 1)));
  using R = lane::Real<N>;
  for (int o = 0; o < lane::kTile; o += N) {
    const TetCorotational<R> wide = tile.template load<N>(o);
    const V3<R> none[4] = {zeroV3<R>(), zeroV3<R>(), zeroV3<R>(), zeroV3<R>()};
    lane::Tile<TetCorotationalOp> ops;
    ops.template store<N>(o, wide.op(wide.deformation(none)));
    for (int l = o; l < o + N; ++l) {
      const TetCorotational<float> one = tile.get(l);
      const V zero[4] = {};
      const TetCorotationalOp<float> expected = one.op(one.deformation(zero)), got = ops.get(l);
      EXPECT_EQ(std::memcmp(&expected, &got, sizeof(got)), 0) << N << " lanes, lane " << l;
    }
  }
}

TEST(TetCorotational, EveryWidthGivesTheBitsOfFloat) {
  expectBitsOfFloat<4>();
  expectBitsOfFloat<8>();
  expectBitsOfFloat<16>();
}

}  // namespace
}  // namespace avbd::rows
