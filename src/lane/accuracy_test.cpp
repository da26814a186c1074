// The mathematics of avbd/rows against double precision and dense matrices.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "lane/formulas.h"

namespace avbd {
namespace {

using namespace rows;
using formulas::Random;

constexpr float kInfinity = __builtin_inff();

/// Distance in units in the last place of the float nearest to `exact`.
double ulps(float got, double exact) {
  const float near = std::abs(static_cast<float>(exact));
  return std::abs(got - exact) / (std::nextafter(near, kInfinity) - near);
}

TEST(Trigonometry, SinCosWithinThreeUlp) {
  Random random(3);
  double worst = 0;
  const auto look = [&](float x) {
    const SinCos<float> t = sinCos(x);
    worst = std::max({worst, ulps(t.sin, std::sin(double(x))), ulps(t.cos, std::cos(double(x)))});
  };
  for (int i = 0; i < 300000; ++i) {
    look(random.number(1));
    look(random.number(30));
    look(random.number(8000));
  }
  for (int k = -5000; k <= 5000; ++k) {  // where one of them is nearly zero
    const float x = static_cast<float>(k * 1.5707963267948966);
    for (float y : {std::nextafter(x, -1e9f), x, std::nextafter(x, 1e9f)}) look(y);
  }
  EXPECT_LT(worst, 3.0);
  EXPECT_EQ(sinCos(0.0f).cos, 1.0f);
  EXPECT_EQ(sinCos(1e-20f).sin, 1e-20f);
}

TEST(Trigonometry, BoundedForAnyFiniteAngleAndNanForTheRest) {
  Random random(4);
  for (int i = 0; i < 100000; ++i) {
    const float x = std::bit_cast<float>(random.bits());
    const SinCos<float> t = sinCos(x);
    if (std::isfinite(x)) {
      ASSERT_LE(std::abs(t.sin), 1.0f) << x;
      ASSERT_LE(std::abs(t.cos), 1.0f) << x;
    } else {
      ASSERT_TRUE(t.sin != t.sin && t.cos != t.cos);
    }
  }
}

TEST(Trigonometry, ArcTangentWithinThreeUlp) {
  Random random(5);
  double worst = 0;
  const auto look = [&](float y, float x) {
    worst = std::max(worst, ulps(atan2(y, x), std::atan2(double(y), double(x))));
  };
  for (int i = 0; i < 500000; ++i) {
    look(random.number(), random.number());
    look(random.number(), random.number(1e-3f));
    look(random.number(1e-6f), random.number(100));
  }
  for (float x : {0.0f, 1.0f, -1.0f, 3.0f}) look(0.0f, x), look(1.0f, x), look(-1.0f, x);
  EXPECT_LT(worst, 3.0);
  EXPECT_EQ(atan2(0.0f, 0.0f), 0.0f);
  EXPECT_EQ(atan2(-0.0f, -1.0f), -std::atan2(0.0f, -1.0f));
}

TEST(Trigonometry, ArcsBeyondTheirDomainStayAtItsEnds) {
  EXPECT_EQ(acos(1.0000001f), 0.0f);
  EXPECT_FLOAT_EQ(acos(-1.5f), kPi);
  EXPECT_FLOAT_EQ(asin(2.0f), kPi / 2);
  for (float x = -1; x <= 1; x += 0.001f) {
    EXPECT_NEAR(acos(x), std::acos(double(x)), 4e-7);
    EXPECT_NEAR(asin(x), std::asin(double(x)), 4e-7);
  }
}

std::array<double, 4> exactExp(V3<float> v) {
  const double x = v.x, y = v.y, z = v.z, a = std::sqrt(x * x + y * y + z * z);
  const double k = a > 0 ? std::sin(a / 2) / a : 0.5;
  return {std::cos(a / 2), k * x, k * y, k * z};
}
TEST(Rotation, ExponentialAtEverySize) {
  Random random(6);
  for (int i = 0; i < 200000; ++i) {
    const float size = std::exp2(std::round(random.number(37)) - 30);  // up to 128 rad: twenty turns
    const V3<float> v{random.number(size), random.number(size), random.number(size)};
    const Q4<float> q = expQuat(v);
    const auto e = exactExp(v);
    const double bound = 2e-7 + 2e-7 * size;  // the angle itself carries a relative rounding
    ASSERT_NEAR(q.w, e[0], bound);
    ASSERT_NEAR(q.x, e[1], bound);
    ASSERT_NEAR(q.y, e[2], bound);
    ASSERT_NEAR(q.z, e[3], bound);
    ASSERT_NEAR(dot(q, q), 1.0f, 6e-7f);
    if (size < 1) {
      ASSERT_LE(ulps(q.x, e[1]), 4.0) << v.x;
    }
  }
  const Q4<float> tiny = expQuat(V3<float>{1e-30f, 0, -0.0f});  // its square underflows
  EXPECT_EQ(tiny.x, 0.5e-30f);
  EXPECT_EQ(tiny.w, 1.0f);
}
TEST(Rotation, LogarithmUndoesExponentialTheShorterWay) {
  Random random(7);
  for (int i = 0; i < 200000; ++i) {
    const float size = std::exp2(std::round(random.number(16)) - 15);
    V3<float> v{random.number(size), random.number(size), random.number(size)};
    if (length(v) > 3.14f) v = v * (3.14f / length(v));
    Q4<float> q = expQuat(v);
    if (i % 2) q = {-q.w, -q.x, -q.y, -q.z};
    const V3<float> back = logQuat(q);
    ASSERT_LE(length(back - v), 1.5e-6f * length(v) + 1e-37f);
    ASSERT_LE(length(back), 3.1415930f);
  }
  const V3<float> beyond = logQuat(expQuat(V3<float>{4, 0, 0}));
  EXPECT_NEAR(beyond.x, 4 - 2 * kPi, 1e-6f);
  EXPECT_EQ(logQuat(Q4<float>{-1, 0, 0, 0}).x, 0.0f);
  EXPECT_NEAR(logQuat(Q4<float>{0, 0, 2, 0}).y, kPi, 1e-6f);
}
TEST(Rotation, MatrixProductAndRotateAgree) {
  Random random(8);
  for (int i = 0; i < 1000; ++i) {
    const Q4<float> p = expQuat(V3<float>{random.number(3), random.number(3), random.number(3)});
    const Q4<float> q = expQuat(V3<float>{random.number(3), random.number(3), random.number(3)});
    const V3<float> v{random.number(), random.number(), random.number()};
    EXPECT_LT(length(rotate(p * q, v) - rotate(p, rotate(q, v))), 2e-6f);
    EXPECT_LT(length(toMatrix(q) * v - rotate(q, v)), 1e-6f);
    EXPECT_LT(length(rotate(conjugate(q), rotate(q, v)) - v), 2e-6f);
  }
  const V3<float> turned = rotate(expQuat(V3<float>{0, 0, kPi / 2}), V3<float>{1, 0, 0});
  EXPECT_NEAR(turned.y, 1.0f, 1e-6f);
}

TEST(Basis, RightHandedAndSteadyAroundRestingNormals) {
  Random random(9);
  V3<float> t1, t2;
  for (int i = 0; i < 100000; ++i) {
    const V3<float> n = normalised(V3<float>{random.number(), random.number(), random.number()});
    orthonormalBasis(n, t1, t2);
    ASSERT_NEAR(lengthSq(t1), 1, 4e-6f);
    ASSERT_NEAR(dot(t1, n), 0, 1e-6f);
    ASSERT_LT(length(cross(n, t1) - t2), 4e-6f);
  }
  for (float s : {1.0f, -1.0f})
    for (int axis = 0; axis < 3; ++axis) {
      const V3<float> n{axis == 0 ? s : 0, axis == 1 ? s : 0, axis == 2 ? s : 0};
      orthonormalBasis(n, t1, t2);
      EXPECT_EQ(std::abs(t1.x) + std::abs(t1.y) + std::abs(t1.z), 1.0f);  // axes stay exact
      for (int i = 0; i < 100; ++i) {
        V3<float> u1, u2;
        orthonormalBasis(normalised(n + V3<float>{random.number(1e-4f), random.number(1e-4f), random.number(1e-4f)}),
                         u1, u2);
        ASSERT_LT(length(u1 - t1), 1e-3f);
      }
    }
}

// ---- 6x6 against dense double matrices -------------------------------------------------------------------------

using Dense = std::array<std::array<double, 6>, 6>;
using Column = std::array<double, 6>;

Column column(Twist<float> t) { return {t.lin.x, t.lin.y, t.lin.z, t.ang.x, t.ang.y, t.ang.z}; }
Dense dense(Sym6<float> k) {
  const V3<float> r[3] = {k.al.r0, k.al.r1, k.al.r2};
  Dense d{};
  const Sym3<float>* s[2] = {&k.ll, &k.aa};
  for (int b = 0; b < 2; ++b) {
    const double m[3][3] = {
        {s[b]->xx, s[b]->xy, s[b]->xz}, {s[b]->xy, s[b]->yy, s[b]->yz}, {s[b]->xz, s[b]->yz, s[b]->zz}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) d[3 * b + i][3 * b + j] = m[i][j];
  }
  for (int i = 0; i < 3; ++i) {
    const double row[3] = {r[i].x, r[i].y, r[i].z};
    for (int j = 0; j < 3; ++j) d[3 + i][j] = d[j][3 + i] = row[j];
  }
  return d;
}
Dense mul(const Dense& a, const Dense& b) {
  Dense c{};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}
Dense transposedDense(const Dense& a) {
  Dense c{};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) c[i][j] = a[j][i];
  return c;
}
/// Gauss with pivots: a x = b.
Column solveDense(Dense a, Column b) {
  for (int i = 0; i < 6; ++i) {
    int p = i;
    for (int r = i; r < 6; ++r)
      if (std::abs(a[r][i]) > std::abs(a[p][i])) p = r;
    std::swap(a[i], a[p]);
    std::swap(b[i], b[p]);
    for (int r = i + 1; r < 6; ++r) {
      const double f = a[r][i] / a[i][i];
      for (int c = i; c < 6; ++c) a[r][c] -= f * a[i][c];
      b[r] -= f * b[i];
    }
  }
  for (int i = 5; i >= 0; --i) {
    for (int c = i + 1; c < 6; ++c) b[i] -= a[i][c] * b[c];
    b[i] /= a[i][i];
  }
  return b;
}
double largest(const Dense& a) {
  double m = 0;
  for (auto& row : a)
    for (double x : row) m = std::max(m, std::abs(x));
  return m;
}
void expectNear(const Dense& a, const Dense& b, double bound) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) ASSERT_NEAR(a[i][j], b[i][j], bound) << i << ' ' << j;
}
void expectNear(const Column& a, const Column& b, double bound) {
  for (int i = 0; i < 6; ++i) ASSERT_NEAR(a[i], b[i], bound) << i;
}
V3<float> randomV3(Random& r, float size = 1) { return {r.number(size), r.number(size), r.number(size)}; }
Twist<float> randomTwist(Random& r) { return {randomV3(r), randomV3(r)}; }
/// Mass and inertia with a few rows of stiffness up to `stiff` on them.
Sym6<float> randomBlock(Random& r, float stiff) {
  Sym6<float> k = zeroSym6<float>();
  k.ll = diagonal(V3<float>{1, 1, 1});
  k.aa = diagonal(V3<float>{0.5f, 1, 2});
  for (int i = 0; i < 3; ++i) addOuter(k, stiff * std::abs(r.number()), randomTwist(r));
  return k;
}

TEST(Block, ProductAndOuterMatchDense) {
  Random random(10);
  for (int i = 0; i < 500; ++i) {
    const Sym6<float> k = randomBlock(random, 10);
    const Twist<float> t = randomTwist(random);
    const Column c = column(t);
    Column want{};
    for (int r = 0; r < 6; ++r)
      for (int j = 0; j < 6; ++j) want[r] += dense(k)[r][j] * c[j];
    expectNear(column(k * t), want, 5e-5);
    Sym6<float> more = k;
    addOuter(more, 2.5f, t);
    Dense d = dense(k);
    for (int r = 0; r < 6; ++r)
      for (int j = 0; j < 6; ++j) d[r][j] += 2.5 * c[r] * c[j];
    expectNear(dense(more), d, 1e-5);
    expectNear(dense(k + more * 2.0f), dense(more * 2.0f + k), 0);
  }
}

TEST(Block, ShiftIsTheDenseTransform) {
  Random random(11);
  for (int i = 0; i < 500; ++i) {
    const Sym6<float> k = randomBlock(random, 10);
    const V3<float> arm = randomV3(random, 2);
    Dense x{};
    for (int r = 0; r < 6; ++r) {
      Column unit{};
      unit[r] = 1;
      const auto f = [&](int n) { return static_cast<float>(unit[n]); };
      const Column image = column(shiftToPoint(Twist<float>{{f(0), f(1), f(2)}, {f(3), f(4), f(5)}}, arm));
      for (int j = 0; j < 6; ++j) x[j][r] = image[j];
    }
    // dtheta x arm, written out once by hand.
    EXPECT_EQ(x[0][4], arm.z);
    EXPECT_EQ(x[0][5], -arm.y);
    EXPECT_EQ(x[1][5], arm.x);
    const Dense want = mul(transposedDense(x), mul(dense(k), x));
    expectNear(dense(shifted(k, arm)), want, 3e-6 * largest(want));
    // Virtual work: w . X t = X^T w . t.
    const Twist<float> w = randomTwist(random), t = randomTwist(random);
    EXPECT_NEAR(dot(w, shiftToPoint(t, arm)), dot(shiftWrench(w, arm), t), 1e-5f);
  }
}

TEST(Block, FactorSolvesAndInverts) {
  Random random(12);
  for (float stiff : {0.0f, 1.0f, 100.0f, 1e4f})
    for (int i = 0; i < 300; ++i) {
      const Sym6<float> k = randomBlock(random, stiff);
      const Twist<float> b = randomTwist(random);
      const Column want = solveDense(dense(k), column(b));
      const double bound = 2e-6 * (1 + stiff);  // the block's condition number is about the stiffness
      expectNear(column(solve(factor(k), b)), want, bound);
      expectNear(column(inverse(k) * b), want, 3 * bound);
    }
}
TEST(Block, SolveLeavesASmallResidualAtHighMassRatios) {
  Random random(13);
  for (int i = 0; i < 1000; ++i) {
    const Sym6<float> k = randomBlock(random, 1e5f);
    const Twist<float> b = randomTwist(random);
    const Column x = column(solve(factor(k), b));
    const Dense d = dense(k);
    double size = 0;
    for (double v : x) size = std::max(size, std::abs(v));
    for (int r = 0; r < 6; ++r) {
      double residual = -column(b)[r];
      for (int j = 0; j < 6; ++j) residual += d[r][j] * x[j];
      ASSERT_LT(std::abs(residual), 1e-5 * (largest(d) * size + 1));
    }
  }
}
TEST(Block, SingularDirectionsDoNotMove) {
  Sym6<float> k = zeroSym6<float>();
  const Twist<float> none = solve(factor(k), Twist<float>{{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(dot(none, none), 0.0f);
  k.ll = diagonal(V3<float>{2, 0, 4});
  const Twist<float> some = solve(factor(k), Twist<float>{{1, 1, 1}, {1, 1, 1}});
  EXPECT_EQ(some.lin.x, 0.5f);
  EXPECT_EQ(some.lin.y, 0.0f);
  EXPECT_EQ(some.ang.z, 0.0f);
  k.ll.xx = std::nanf("");
  const float seen = solve(factor(k), some).lin.x;
  EXPECT_TRUE(seen != seen);
}

TEST(Sym3, InverseSolveAndRotation) {
  Random random(14);
  for (int i = 0; i < 1000; ++i) {
    const Sym3<float> s = randomBlock(random, 5).ll;
    const V3<float> v = randomV3(random);
    EXPECT_LT(length(s * (inverse(s) * v) - v), 3e-5f);
    EXPECT_LT(length(s * solve3(s, v) - v), 1e-5f);
    EXPECT_LT(length(inverse(factor(s)) * v - solve3(s, v)), 1e-5f);
    const Q4<float> q = expQuat(randomV3(random, 3));
    EXPECT_LT(length(rotated(s, q) * v - rotate(q, s * rotate(conjugate(q), v))), 2e-5f);
  }
  EXPECT_EQ(inverse(diagonal(V3<float>{1, 0, 1})).xx, 0.0f);
}

}  // namespace
}  // namespace avbd
