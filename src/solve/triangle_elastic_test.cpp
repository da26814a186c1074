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
  multiply(opAt(x), spun, out);
  for (const V& q : out) EXPECT_NEAR(double{length(q)}, 0, 1e-5);
  const V lifted[4] = {{0, 0, 0.3f}, {0, 0, -0.7f}, {0, 0, 1}, {}};
  multiply(opAt(kRest), lifted, out);
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
    multiply(opAt(at), p, out);
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
      multiply(op, p, hp), multiply(op, r, hr);
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
    multiply(opAt(x), p, out);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(out[i].x + out[i].y + out[i].z));
    for (const V& g : gradientAt(x)) EXPECT_TRUE(std::isfinite(g.x + g.y + g.z));
  }
}

}  // namespace
}  // namespace avbd::rows
