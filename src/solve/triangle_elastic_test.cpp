// Elements of cloth: the gradient is that of the energy, the Hessian that of the gradient where it may be, and never
// negative; no turn costs anything, and out of its plane an unstrained sheet has no stiffness.
#include "avbd/rows/triangle_elastic.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "lane/tile.h"
#include "solve/elastic_cases.h"

namespace avbd::rows {
namespace {

using Points = std::array<Vec3d, 3>;
using V = V3<float>;

const Points kRest = {Vec3d{0, 0, 0}, {1.2, 0, 0}, {0.3, 0.9, 0}};
constexpr double kMu = 3, kLambda = 7;

TriangleElastic<float> rowsAt(const Points& x) {
  TriangleElastic<float> rows{};
  rows.ab = toFloat3(x[1] - x[0]), rows.ac = toFloat3(x[2] - x[0]);
  rows.bx = static_cast<float>(1 / 1.2), rows.by = static_cast<float>(-0.3 / (1.2 * 0.9));
  rows.cx = 0, rows.cy = static_cast<float>(1 / 0.9);
  rows.mu = static_cast<float>(kMu), rows.lambda = static_cast<float>(kLambda);
  return rows;
}

double energy(const Points& x) {
  const Vec3d b = x[1] - x[0], c = x[2] - x[0];
  const Vec3d f0 = b * (1 / 1.2), f1 = b * (-0.3 / (1.2 * 0.9)) + c * (1 / 0.9), m = crossOf(f0, f1);
  const double off = std::sqrt(dot(m, m)) - 1 - kMu / kLambda;
  return kMu / 2 * (dot(f0, f0) + dot(f1, f1) - 2) + kLambda / 2 * off * off;
}

ElementDraws draws;
Points moved(double size) { return draws.moved(kRest, size); }

std::array<V, 4> gradientAt(const Points& x) {
  const V none[4] = {};
  V out[4];
  const auto rows = rowsAt(x);
  rows.gradient(rows.stretch(none), out);
  return {out[0], out[1], out[2], out[3]};
}

TriangleOp<float> opAt(const Points& x) {
  const V none[4] = {};
  const auto rows = rowsAt(x);
  return rows.op(rows.stretch(none));
}

void draw(V (&p)[4]) { draws.draw(p); }

TEST(TriangleElastic, GradientIsTheDerivativeOfTheEnergy) {
  for (int trial = 0; trial < 20; ++trial) {
    const Points x = moved(0.3);
    const auto gradient = gradientAt(x);
    for (size_t i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        Points up = x, down = x;
        axisOf(up[i], k) += 1e-5, axisOf(down[i], k) -= 1e-5;
        EXPECT_NEAR(double{axisOf(gradient[i], k)}, (energy(up) - energy(down)) / 2e-5, 1e-4);
      }
  }
}

TEST(TriangleElastic, ATurnAndABendCostNothing) {
  const Quat turn{0.5f, 0.5f, -0.5f, 0.5f};
  Points x;
  V spun[4] = {}, out[4];
  for (size_t i = 0; i < 3; ++i) {
    x[i] = rotate(turn, kRest[i]);
    spun[i] = toFloat3(crossOf({0.4, -1, 0.8}, x[i]));
  }
  for (const V& g : gradientAt(x)) EXPECT_NEAR(double{length(g)}, 0, 1e-5);
  multiply(opAt(x), true, spun, out);
  for (const V& q : out) EXPECT_NEAR(double{length(q)}, 0, 1e-5);
  const V lifted[4] = {{0, 0, 0.3f}, {0, 0, -0.7f}, {0, 0, 1}, {}};
  multiply(opAt(kRest), true, lifted, out);
  for (const V& q : out) EXPECT_NEAR(double{length(q)}, 0, 1e-5);
}

TEST(TriangleElastic, HessianIsTheDerivativeOfTheGradientInAPulledStrip) {
  // No stress sideways: lambda (J - 1) = mu (1 - side / along).
  const double along = 1.2;
  double low = 0.5, high = 1;
  while (high - low > 1e-12) {
    const double side = (low + high) / 2;
    (kLambda * (along * side - 1) > kMu * (1 - side / along) ? high : low) = side;
  }
  Points pulled = kRest;
  for (Vec3d& p : pulled) p = {p.x * along, p.y * low, 0};
  for (const Points& at : {kRest, pulled}) {
    V p[4], out[4];
    draw(p);
    p[3] = {};
    multiply(opAt(at), true, p, out);
    Points up = at, down = at;
    for (size_t i = 0; i < 3; ++i) {
      const Vec3d way = Vec3d{double{p[i].x}, double{p[i].y}, double{p[i].z}} * 1e-3;
      up[i] = up[i] + way, down[i] = down[i] - way;
    }
    const auto a = gradientAt(up), b = gradientAt(down);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(double{length(out[i] - (a[i] - b[i]) * 500.0f)}, 0, 0.02);
  }
}

TEST(TriangleElastic, HessianIsSymmetricAndNeverNegative) {
  for (const double size : {0.1, 0.5, 2.0})
    for (int trial = 0; trial < 200; ++trial) {
      const TriangleOp<float> op = opAt(moved(size));
      V p[4], r[4], hp[4], hr[4];
      draw(p), draw(r);
      p[3] = r[3] = {};
      multiply(op, true, p, hp), multiply(op, true, r, hr);
      double pHr = 0, rHp = 0, pHp = 0, scale = 0;
      for (size_t i = 0; i < 3; ++i) {
        pHr += double{dot(p[i], hr[i])}, rHp += double{dot(r[i], hp[i])}, pHp += double{dot(p[i], hp[i])};
        scale += double{length(p[i]) * length(hr[i])} + double{length(p[i]) * length(hp[i])};
      }
      EXPECT_NEAR(pHr, rHp, 1e-4 * scale);
      EXPECT_GE(pHp, -0.01 * scale) << "size " << size;
    }
}

TEST(TriangleElastic, OfNoAreaItIsFinite) {
  const Points flat = {Vec3d{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, point = {};
  for (const Points& x : {flat, point}) {
    V p[4], out[4];
    draw(p);
    multiply(opAt(x), true, p, out);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(out[i].x + out[i].y + out[i].z));
    for (const V& g : gradientAt(x)) EXPECT_TRUE(std::isfinite(g.x + g.y + g.z));
  }
}

// ---- Threads, viscosity, limit -----------------------------------------------------------------------------------

constexpr double kWarp = 20, kWeft = 5, kShear = 2, kDamping = 0.6;

struct Squares {
  double xx, yy, xy;
};

Squares squaresAt(const Points& x) {
  const Vec3d b = x[1] - x[0], c = x[2] - x[0];
  const Vec3d f0 = b * (1 / 1.2), f1 = b * (-0.3 / (1.2 * 0.9)) + c * (1 / 0.9);
  return {dot(f0, f0), dot(f1, f1), dot(f0, f1)};
}

/// Of threads at a place, and of viscosity on the way to it.
double threadEnergy(const Points& from, const Points& to) {
  const Squares a = squaresAt(from), c = squaresAt(to);
  const double warp = std::sqrt(c.xx) - 1, weft = std::sqrt(c.yy) - 1;
  const double xx = c.xx - a.xx, yy = c.yy - a.yy, xy = c.xy - a.xy, trace = xx + yy;
  return kWarp / 2 * warp * warp + kWeft / 2 * weft * weft + kShear / 2 * c.xy * c.xy +
         kDamping * (kMu / 4 * (xx * xx + yy * yy + 2 * xy * xy) + (kLambda - kMu) / 8 * trace * trace +
                     kWarp / 8 * xx * xx + kWeft / 8 * yy * yy + kShear / 2 * xy * xy);
}

/// From one place to another.
struct WovenStep {
  TriangleElastic<float> rows;
  V d[4] = {};
  WovenStep(const Points& from, const Points& to) : rows(rowsAt(from)) {
    rows.warp = static_cast<float>(kWarp), rows.weft = static_cast<float>(kWeft);
    rows.shear = static_cast<float>(kShear), rows.damping = static_cast<float>(kDamping);
    for (size_t i = 0; i < 3; ++i) d[i] = toFloat3(to[i] - from[i]);
  }
  std::array<V, 3> gradient() const {
    V out[4];
    rows.gradient(rows.stretch(d), out);
    return {out[0], out[1], out[2]};
  }
  TriangleOp<float> op() const { return rows.op(rows.stretch(d)); }
};

TEST(TriangleElastic, ForcesOfThreadsAndViscosityAreTheDerivativeOfTheEnergy) {
  for (int trial = 0; trial < 20; ++trial) {
    const Points from = moved(0.2), to = moved(0.2);
    const auto gradient = WovenStep(from, to).gradient();
    for (size_t i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        Points up = to, down = to;
        axisOf(up[i], k) += 1e-5, axisOf(down[i], k) -= 1e-5;
        const double slope = (energy(up) - energy(down) + threadEnergy(from, up) - threadEnergy(from, down)) / 2e-5;
        EXPECT_NEAR(double{axisOf(gradient[i], k)}, slope, 1e-3);
      }
  }
}

/// Of rows at a place, along one axis of one corner.
void expectHessian(const WovenStep& step, double tolerance) {
  for (size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      V p[4] = {}, out[4];
      axisOf(p[i], k) = 1;
      multiply(step.op(), true, p, out);
      const float x[3] = {-(step.rows.bx + step.rows.cx), step.rows.bx, step.rows.cx};
      const float y[3] = {-(step.rows.by + step.rows.cy), step.rows.by, step.rows.cy};
      WovenStep up = step, down = step;
      axisOf(up.d[i], k) += 1e-3f, axisOf(down.d[i], k) -= 1e-3f;
      const auto a = up.gradient(), b = down.gradient();
      for (size_t n = 0; n < 3; ++n)
        EXPECT_NEAR(double{length(out[n] - (a[n] - b[n]) * 500.0f)}, 0, tolerance) << i << " " << k;
      // The curvature of J is not in the blocks, and only out of the plane at rest.
      if (k < 2)
        EXPECT_NEAR(double{axisOf(out[i], k) - axisOf(triangleBlock(step.op(), x[i], y[i]) * p[i], k)}, 0, 1e-3);
    }
}

TEST(TriangleElastic, HessianOfThreadsAndViscosityIsTheDerivativeOfTheForces) {
  expectHessian(WovenStep(kRest, kRest), 0.05);
}

TEST(TriangleElastic, ThreadsAndViscosityDoNotHinderATurn) {
  const Quat turn{0.5f, 0.5f, -0.5f, 0.5f};
  Points x;
  for (size_t i = 0; i < 3; ++i) x[i] = rotate(turn, kRest[i]);
  for (const V& g : WovenStep(kRest, x).gradient()) EXPECT_NEAR(double{length(g)}, 0, 5e-5);
}

TEST(TriangleElastic, HessianOfThreadsIsSymmetricAndNeverNegative) {
  for (const double size : {0.1, 0.5, 2.0})
    for (int trial = 0; trial < 200; ++trial) {
      WovenStep step(moved(size), moved(size));
      step.rows.floor = 30, step.rows.most = 0.1f, step.rows.load = 1, step.rows.tension = {3, 2, 1};
      V p[4], r[4], hp[4], hr[4];
      draw(p), draw(r);
      p[3] = r[3] = {};
      multiply(step.op(), true, p, hp), multiply(step.op(), true, r, hr);
      double pHr = 0, rHp = 0, pHp = 0, scale = 0;
      for (size_t i = 0; i < 3; ++i) {
        pHr += double{dot(p[i], hr[i])}, rHp += double{dot(r[i], hp[i])}, pHp += double{dot(p[i], hp[i])};
        scale += double{length(p[i]) * length(hr[i])} + double{length(p[i]) * length(hp[i])};
      }
      EXPECT_NEAR(pHr, rHp, 1e-4 * scale);
      EXPECT_GE(pHp, -0.01 * scale) << "size " << size;
    }
}

TEST(TriangleElastic, ATensionIsTheNearestMatrixThatPulls) {
  for (int trial = 0; trial < 50; ++trial) {
    V draws3[4];
    draw(draws3);
    const Plane<float> m{draws3[0].x, draws3[0].y, draws3[0].z}, t = pulling(m);
    EXPECT_GE(t.xx + t.yy, -1e-6f);
    EXPECT_GE(t.xx * t.yy - t.xy * t.xy, -1e-5f);
    // What is left pushes, and is of other directions.
    const Plane<float> left{m.xx - t.xx, m.yy - t.yy, m.xy - t.xy};
    EXPECT_LE(left.xx + left.yy, 1e-6f);
    EXPECT_GE(left.xx * left.yy - left.xy * left.xy, -1e-5f);
    EXPECT_NEAR(left.xx * t.xx + left.yy * t.yy + 2 * left.xy * t.xy, 0, 1e-5);
  }
  const Plane<float> none = pulling<float>({0, 0, 0});
  EXPECT_EQ(none.xx + none.yy + none.xy, 0);
}

TEST(TriangleElastic, ALimitPullsAlongWhatIsTooLongAndNotBelow) {
  TriangleElastic<float> rows = rowsAt(kRest);
  rows.mu = rows.lambda = 0;
  rows.most = 0.1f, rows.floor = 50, rows.load = 1;
  const V none[4] = {};
  V out[4];
  rows.gradient(rows.stretch(none), out);
  for (const V& g : out) EXPECT_EQ(length(g), 0);
  V pulled[4] = {};
  for (size_t i = 0; i < 3; ++i) pulled[i].x = 0.3f * toFloat3(kRest[i]).x;  // E = 0.345 along x
  const Plane<float> t = rows.limitTension(rows.stretch(pulled));
  EXPECT_NEAR(t.xx, 50 * (0.345f - 0.1f), 1e-3);
  EXPECT_NEAR(t.yy, 0, 1e-5);
  EXPECT_NEAR(t.xy, 0, 1e-5);
}

}  // namespace
}  // namespace avbd::rows
