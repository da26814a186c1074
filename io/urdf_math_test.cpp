// Angles and inertias of URDF files.
#include "io/urdf_math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace avbd::urdf {
namespace {

TEST(UrdfMath, SineAndCosineAreThoseOfTheLibrary) {
  for (int i = -20000; i <= 20000; ++i) {
    const double x = 0.005 * i;
    EXPECT_NEAR(sinCos(x).sin, std::sin(x), 1e-15) << x;
    EXPECT_NEAR(sinCos(x).cos, std::cos(x), 1e-15) << x;
  }
  EXPECT_NEAR(sinCos(1e9).sin, std::sin(1e9), 1e-6);
  EXPECT_EQ(sinCos(0).sin, 0);
  EXPECT_EQ(sinCos(0).cos, 1);
}

TEST(UrdfMath, RollPitchYawTurnsAboutFixedAxes) {
  const double h = M_PI / 2;
  const auto expect = [](Vec3d rpy, Vec3d from, Vec3d to) {
    const Vec3d got = rotate(fromRollPitchYaw(rpy), from);
    EXPECT_NEAR(length(got - to), 0, 1e-15);
  };
  expect({h, 0, 0}, {0, 1, 0}, {0, 0, 1});
  expect({0, h, 0}, {0, 0, 1}, {1, 0, 0});
  expect({0, 0, h}, {1, 0, 0}, {0, 1, 0});
  // Roll first: y goes to z, pitch takes it to x, yaw to y.
  expect({h, h, h}, {0, 1, 0}, {0, 1, 0});
  expect({h, 0, h}, {0, 1, 0}, {0, 0, 1});
}

mjcf::Sym3d turned(mjcf::Sym3d m) { return mjcf::rotated(m, fromRollPitchYaw({0.4, -1, 2})); }

TEST(UrdfMath, PossibleInertiasAreKept) {
  for (const mjcf::Sym3d& m :
       {mjcf::Sym3d{1, 1, 1}, mjcf::Sym3d{1, 2, 3}, mjcf::Sym3d{1e-9, 1e-9, 1.999e-9}, mjcf::Sym3d{1e-4, 1, 1}}) {
    mjcf::Sym3d kept = m;
    EXPECT_EQ(repair(kept), InertiaFault::None);
    EXPECT_EQ(kept.xx, m.xx);
    EXPECT_EQ(kept.zz, m.zz);
    mjcf::Sym3d other = turned(m);
    EXPECT_EQ(repair(other), InertiaFault::None);
  }
}

TEST(UrdfMath, RoundedDigitsOfAPlateAreNoFault) {
  mjcf::Sym3d plate = turned({1, 2, 3.01});
  EXPECT_EQ(repair(plate), InertiaFault::None);
  const auto p = mjcf::principal(plate).values;
  const double most = std::max({p[0], p[1], p[2]});
  EXPECT_NEAR(p[0] + p[1] + p[2] - 2 * most, 0, 1e-12);
}

TEST(UrdfMath, ImpossibleInertiasBecomeTheNearestPossible) {
  // Second moments (b + c - a) / 2 are 2.5, 2.5 and -1.5: the last becomes 1e-3 of the largest.
  mjcf::Sym3d m = turned({1, 1, 5});
  EXPECT_EQ(repair(m), InertiaFault::Repaired);
  const mjcf::Sym3d expected = turned({2.5025, 2.5025, 5});
  EXPECT_NEAR(m.xx, expected.xx, 1e-12);
  EXPECT_NEAR(m.xy, expected.xy, 1e-12);
  EXPECT_NEAR(m.yz, expected.yz, 1e-12);
  mjcf::Sym3d rod{0, 1, 1};
  EXPECT_EQ(repair(rod), InertiaFault::Repaired);
  EXPECT_NEAR(rod.xx, 0.002, 1e-15);
  mjcf::Sym3d negative{-1, -1, -1};
  EXPECT_EQ(repair(negative), InertiaFault::Hopeless);
  mjcf::Sym3d none;
  EXPECT_EQ(repair(none), InertiaFault::Unset);
}

}  // namespace
}  // namespace avbd::urdf
