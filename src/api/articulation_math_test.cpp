// Sines, rotation vectors and their rates against libm and differences.
#include "api/articulation_math.h"

#include <gtest/gtest.h>

namespace avbd::articulation {
namespace {

TEST(ArticulationMath, SinesAreExact) {
  for (int i = -40000; i <= 40000; ++i) {
    const double angle = 0.013 * i;
    const SinCos t = sinCos(angle);
    ASSERT_NEAR(t.sin, std::sin(angle), 4e-16) << angle;
    ASSERT_NEAR(t.cos, std::cos(angle), 4e-16) << angle;
  }
  EXPECT_NEAR(sinCos(1e5).sin, std::sin(1e5), 1e-15);
}

TEST(ArticulationMath, RotationVectorsThereAndBack) {
  const Vec3d axis{2.0 / 7, -3.0 / 7, 6.0 / 7};
  for (const double angle : {0.0, 1e-13, 1e-9, 1e-5, 0.09, 0.11, 1.0, 3.0, 3.1415}) {
    const Quatd q = rotationOf(axis * angle);
    EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-15) << angle;
    EXPECT_LT(length(rotationVectorOf(q) - axis * angle), 2e-15) << angle;
    EXPECT_LT(length(rotationVectorOf({-q.w, -q.x, -q.y, -q.z}) - axis * angle), 2e-15) << angle;
  }
  // Farther round is the other way.
  EXPECT_LT(length(rotationVectorOf(rotationOf(axis * 4)) - axis * (4 - 6.28318530717958648)), 1e-14);
}

TEST(ArticulationMath, TurningIsTheRateOfARotation) {
  const Vec3d axis{2.0 / 7, -3.0 / 7, 6.0 / 7}, rate{0.3, 0.5, -0.2};
  for (const double angle : {0.0, 1e-6, 0.3, 0.9999, 1.0001, 2.0, 5.0}) {
    const Vec3d s = axis * angle;
    const TurningFactors f = turningFactors(s);
    const Vec3d across = cross(s, rate), turning = rate + across * f.a + cross(s, across) * f.b;
    const double h = 1e-5;
    const Quatd after = rotationOf(s + rate * h), before = rotationOf(s - rate * h);
    EXPECT_LT(length(rotationVectorOf(after * conjugate(before)) * (0.5 / h) - turning), 1e-9) << angle;
    // The slopes, along the axis where the length changes by h.
    const TurningFactors up = turningFactors(s + axis * h), down = turningFactors(s - axis * h);
    EXPECT_NEAR((up.a - down.a) / (2 * h), f.aSlope * angle, 1e-9) << angle;
    EXPECT_NEAR((up.b - down.b) / (2 * h), f.bSlope * angle, 1e-9) << angle;
  }
}

}  // namespace
}  // namespace avbd::articulation
