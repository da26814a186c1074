// Mass of compound bodies against closed forms; eigenvalues and inverses against products.
#include "world/mass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "world/rotation.h"

namespace avbd {
namespace {

TEST(PrincipalMoments, DiagonalAndTurned) {
  const auto plain = principalMoments({3, 1, 2, 0, 0, 0});
  EXPECT_EQ(plain, (std::array<double, 3>{1, 2, 3}));
  // diag(1, 2, 3) seen from turned frames.
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 200; ++i) {
    Quat q{normal(random), normal(random), normal(random), normal(random)};
    const float size = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    q = {q.w / size, q.x / size, q.y / size, q.z / size};
    const SymMat3d m = worldInertia(q, {1, 2, 3, 0, 0, 0});
    const auto moments =
        principalMoments({float(m.xx), float(m.yy), float(m.zz), float(m.xy), float(m.xz), float(m.yz)});
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(moments[k], static_cast<double>(k + 1), 5e-6);
  }
}

TEST(Inverse, TimesMatrixIsOne) {
  const SymMat3 m{4, 5, 6, 1, -0.5f, 0.7f}, i = inverse(m);
  const SymMat3d md{m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}, id{i.xx, i.yy, i.zz, i.xy, i.xz, i.yz};
  const Vec3d axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vec3d axis : axes) EXPECT_LT(length(md * (id * axis) - axis), 1e-6);
}

TEST(ShapesMass, TwoBoxesAreOneLongBox) {
  // Two cubes of side 1 side by side are a 2 x 1 x 1 bar about the middle.
  const std::vector<ShapeDef> halves = {{.geometry = Box{0.5f, 0.5f, 0.5f}, .pose = {{1, 0, 0}, {}}, .density = 3},
                                        {.geometry = Box{0.5f, 0.5f, 0.5f}, .pose = {{2, 0, 0}, {}}, .density = 3}};
  const MassProperties m = shapesMass(halves, 0);
  EXPECT_FLOAT_EQ(m.mass, 6);
  EXPECT_EQ(m.center, (Vec3{1.5f, 0, 0}));
  EXPECT_FLOAT_EQ(m.inertia.xx, 6.0f * (1 + 1) / 12);
  EXPECT_FLOAT_EQ(m.inertia.yy, 6.0f * (4 + 1) / 12);
  EXPECT_FLOAT_EQ(m.inertia.zz, 6.0f * (4 + 1) / 12);
}

TEST(ShapesMass, ScalesToTheGivenMass) {
  const std::vector<ShapeDef> shapes = {{.geometry = Box{0.5f, 0.5f, 0.5f}, .density = 1},
                                        {.geometry = Box{0.5f, 0.5f, 0.5f}, .pose = {{4, 0, 0}, {}}, .density = 3}};
  const MassProperties free = shapesMass(shapes, 0), scaled = shapesMass(shapes, 10);
  EXPECT_EQ(scaled.mass, 10);
  EXPECT_EQ(scaled.center, (Vec3{3, 0, 0}));
  EXPECT_FLOAT_EQ(scaled.inertia.yy, free.inertia.yy * 10 / 4);
}

TEST(ShapesMass, WithoutDensityAllAreAlike) {
  const std::vector<ShapeDef> shapes = {{.geometry = Box{0.5f, 0.5f, 0.5f}, .density = 0},
                                        {.geometry = Box{0.5f, 0.5f, 0.5f}, .pose = {{4, 0, 0}, {}}, .density = 0}};
  EXPECT_EQ(shapesMass(shapes, 0).mass, 0);
  EXPECT_EQ(shapesMass(shapes, 8).mass, 8);
  EXPECT_EQ(shapesMass(shapes, 8).center, (Vec3{2, 0, 0}));
  EXPECT_EQ(shapesMass({}, 8).mass, 0);
}

TEST(SolveUnlocked, LockedAxesStayStillAndTheOthersObeyTheirRows) {
  const SymMat3d m{4, 5, 6, 1, -0.5, 0.7};
  const Vec3d impulse{1, 2, 3};
  for (int locks = 0; locks < 8; ++locks) {
    const Vec3 w = solveUnlocked(m, static_cast<uint8_t>(locks * kLockAngularX), impulse);
    const Vec3d l = m * toDouble(w);
    const double got[3] = {l.x, l.y, l.z}, want[3] = {1, 2, 3};
    const float spin[3] = {w.x, w.y, w.z};
    for (int axis = 0; axis < 3; ++axis) {
      if (locks & (1 << axis)) {
        EXPECT_EQ(spin[axis], 0);
      } else {
        EXPECT_NEAR(got[axis], want[axis], 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace avbd
