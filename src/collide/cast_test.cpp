// A convex shape moving against another one: the time of touch, by hand and against the distance along the way.
#include <gtest/gtest.h>

#include "collide/collide_convex_oracle.h"

namespace avbd {
namespace {

constexpr ShapeType kTypes[] = {ShapeType::Sphere, ShapeType::Capsule,   ShapeType::Box,        ShapeType::Cylinder,
                                ShapeType::Cone,   ShapeType::Ellipsoid, ShapeType::RoundedBox, ShapeType::Hull};

float gapAfter(const ShapeGeom& a, NearPose pose, Vec3 way, const ShapeGeom& b, const NearPose& poseB) {
  pose.p = pose.p + way;
  return nearest(a, pose, b, poseB, 1e9f).distance;
}

TEST(Cast, touchesWhereTheGapCloses) {
  oracle::Random random(2);
  int hits = 0, misses = 0;
  for (const ShapeType ta : kTypes) {
    for (const ShapeType tb : kTypes) {
      for (int i = 0; i < 60; ++i) {
        const ShapeGeom a = random.shape(ta), b = random.shape(tb);
        const NearPose pa{{}, random.usualRotation()};
        const NearPose pb{rotate(random.rotation(), Vec3{random.within(1.5f, 8), 0, 0}), random.usualRotation()};
        const Vec3 side{random.within(-1.5f, 1.5f), random.within(-1.5f, 1.5f), random.within(-1.5f, 1.5f)};
        const Vec3 motion = pb.p * random.within(0.5f, 2) + side;
        const Meeting m = cast(a, pa, motion, b, pb, 1);
        if (gapAfter(a, pa, {}, b, pb) <= 0) {
          ASSERT_TRUE(m.meets);
          ASSERT_EQ(m.fraction, 0);
          continue;
        }
        // Nothing is met before; at the touch the gap is closed.
        for (int k = 0; k <= 12; ++k) {
          const float t = (m.meets ? m.fraction : 1) * static_cast<float>(k) / 12;
          ASSERT_GT(gapAfter(a, pa, motion * t, b, pb), -1e-5f);
        }
        ++(m.meets ? hits : misses);
        if (!m.meets) continue;
        const Vec3 way = motion * m.fraction;
        ASSERT_NEAR(gapAfter(a, pa, way, b, pb), 0, 2e-5f);
        ASSERT_LT(dot(m.normal, motion), 0);
        ASSERT_LT(oracle::sticksOut(b, pb, toDouble(m.point), 100), 1e-4);
        ASSERT_LT(oracle::sticksOut(a, {way, pa.q}, toDouble(m.point), 100), 1e-4);
      }
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(misses, 500);
}

TEST(Cast, byHand) {
  const ShapeGeom ball = toShapeGeom(Sphere{0.5f}), box = toShapeGeom(Box{1, 1, 1});
  const Meeting m = cast(ball, {{0.25f, 5, 0}, {}}, {0, -10, 0}, box, {}, 1);
  ASSERT_TRUE(m.meets);
  EXPECT_NEAR(m.fraction, 0.35f, 1e-6);
  EXPECT_EQ(m.normal, (Vec3{0, 1, 0}));
  EXPECT_LT(length(m.point - Vec3{0.25f, 1, 0}), 1e-6f);
  EXPECT_FALSE(cast(ball, {{0.25f, 5, 0}, {}}, {0, -10, 0}, box, {}, 0.34f).meets);
  EXPECT_FALSE(cast(ball, {{0.25f, 5, 0}, {}}, {0, 10, 0}, box, {}, 1).meets);
}

TEST(Cast, withoutMotionOnlyOverlapsMeet) {
  const ShapeGeom box = toShapeGeom(Box{1, 1, 1}), can = toShapeGeom(Cylinder{1, 1});
  EXPECT_FALSE(cast(can, {{0, 2.1f, 0}, {}}, {}, box, {}, 1).meets);
  const Meeting m = cast(can, {{0, 1.9f, 0}, {}}, {}, box, {}, 1);
  ASSERT_TRUE(m.meets);
  EXPECT_EQ(m.fraction, 0);
  EXPECT_NEAR(m.normal.y, 1, 1e-6);
}

TEST(Cast, overlapAtTheStartMeetsAgainstTheMotion) {
  const ShapeGeom box = toShapeGeom(Box{1, 1, 1});
  const Meeting m = cast(box, {{0.5f, 1, 0}, {}}, {0, 0, 3}, box, {}, 1);
  ASSERT_TRUE(m.meets);
  EXPECT_EQ(m.fraction, 0);
  EXPECT_EQ(m.normal, (Vec3{0, 0, -1}));
}

/// A kilometre at a sheet of a tenth of a millimetre.
TEST(Cast, longWayAtAThinSheet) {
  const ShapeGeom sheet = toShapeGeom(Box{5, 5e-5f, 5}), can = toShapeGeom(Cylinder{0.5f, 0.5f});
  const Meeting m = cast(can, {{1, 700, 2}, {}}, {0, -1000, 0}, sheet, {}, 1);
  ASSERT_TRUE(m.meets);
  EXPECT_NEAR(m.fraction * 1000, 699.49995f, 1e-4f);
  EXPECT_NEAR(m.normal.y, 1, 1e-6);
}

/// Balls that pass at almost exactly the sum of their radii.
TEST(Cast, grazing) {
  const ShapeGeom ball = toShapeGeom(Sphere{0.5f}), egg = toShapeGeom(Ellipsoid{0.5f, 0.5f, 0.5f});
  for (const ShapeGeom& still : {ball, egg}) {
    for (const float side : {0.99f, 0.999f, 0.9999f}) {
      const Meeting m = cast(ball, {{-3, side, 0}, {}}, {6, 0, 0}, still, {}, 1);
      ASSERT_TRUE(m.meets) << side;
      const double x = -std::sqrt(1 - double{side} * side);
      EXPECT_NEAR(-3 + 6 * m.fraction, x, 2e-4) << side;
    }
    EXPECT_FALSE(cast(ball, {{-3, 1.0001f, 0}, {}}, {6, 0, 0}, still, {}, 1).meets);
  }
}

}  // namespace
}  // namespace avbd
