// Capsule against capsule, box and half-space, in cases with known answers.
#include <gtest/gtest.h>

#include "collide/collide.h"

namespace avbd {
namespace {

const float kHalf = std::sqrt(0.5f);
const Quat kAlongX{kHalf, 0, 0, -kHalf};  // the y axis turned to x
const Quat kAlongZ{kHalf, kHalf, 0, 0};   // to z

Quat slightly(float angle) { return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}; }

Manifold touch(const Geometry& a, NearPose pa, const Geometry& b, NearPose pb, float margin = 0.1f) {
  Manifold m;
  collide(toShapeGeom(a), pa, toShapeGeom(b), pb, margin, m);
  return m;
}

/// The two points' x, in order.
void expectEnds(const Manifold& m, float low, float high) {
  ASSERT_EQ(m.count, 2);
  const float a = m.points[0].position.x, b = m.points[1].position.x;
  EXPECT_NEAR(std::fmin(a, b), low, 1e-4f);
  EXPECT_NEAR(std::fmax(a, b), high, 1e-4f);
  EXPECT_NE(m.points[0].feature, m.points[1].feature);
}

TEST(CollideCapsule, crossedCapsulesTouchInOnePoint) {
  const Manifold m = touch(Capsule{0.5f, 2}, {{}, kAlongX}, Capsule{0.25f, 2}, {{0.5f, 0.7f, -1}, kAlongZ});
  ASSERT_EQ(m.count, 1);
  EXPECT_LT(length(m.normal - Vec3{0, 1, 0}), 1e-6f);
  EXPECT_LT(length(m.points[0].position - Vec3{0.5f, 0.475f, 0}), 1e-6f);
  EXPECT_NEAR(m.points[0].separation, -0.05f, 1e-6f);
}

TEST(CollideCapsule, parallelCapsulesTouchAtBothEndsOfTheirOverlap) {
  const Manifold m = touch(Capsule{0.5f, 2}, {{}, kAlongX}, Capsule{0.25f, 1}, {{1.5f, 0.7f, 0}, kAlongX});
  expectEnds(m, 0.5f, 2);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(m.points[k].separation, -0.05f, 1e-6f);
}

TEST(CollideCapsule, slightlyTurnedCapsulesKeepBothPoints) {
  const Manifold m =
      touch(Capsule{0.5f, 1}, {{}, kAlongX}, Capsule{0.5f, 1}, {{0, 0.99f, 0}, slightly(0.01f) * kAlongX});
  expectEnds(m, -1, 1);
  EXPECT_NEAR(std::fabs(m.points[0].separation - m.points[1].separation), 0.02f, 1e-3f);
}

TEST(CollideCapsule, endToEnd) {
  const Manifold m = touch(Capsule{0.5f, 1}, {{}, kAlongX}, Capsule{0.5f, 1}, {{2.95f, 0, 0}, kAlongX});
  ASSERT_EQ(m.count, 1);
  EXPECT_LT(length(m.normal - Vec3{1, 0, 0}), 1e-6f);
  EXPECT_NEAR(m.points[0].separation, -0.05f, 1e-6f);
}

TEST(CollideCapsule, coresOnOneLineOrCrossing) {
  const Manifold line = touch(Capsule{0.5f, 1}, {{}, kAlongX}, Capsule{0.5f, 1}, {{0.5f, 0, 0}, kAlongX});
  ASSERT_GT(line.count, 0);
  EXPECT_NEAR(line.normal.x, 0, 1e-5f);
  EXPECT_NEAR(line.points[0].separation, -1, 1e-5f);
  const Manifold cross = touch(Capsule{0.5f, 1}, {{}, kAlongX}, Capsule{0.5f, 1}, {{0.5f, 0, 0}, kAlongZ});
  ASSERT_EQ(cross.count, 1);
  EXPECT_NEAR(std::fabs(cross.normal.y), 1, 1e-5f);
  EXPECT_NEAR(cross.points[0].separation, -1, 1e-5f);
}

TEST(CollideCapsule, withoutCylinderIsASphere) {
  const Manifold a = touch(Capsule{0.5f, 0}, {}, Capsule{0.5f, 0}, {{0.6f, 0.7f, 0}, kAlongX});
  const Manifold b = touch(Sphere{0.5f}, {}, Sphere{0.5f}, {{0.6f, 0.7f, 0}, {}});
  ASSERT_EQ(a.count, 1);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.points[0].separation, b.points[0].separation);
}

TEST(CollideCapsule, liesOnABox) {
  const Manifold m = touch(Capsule{0.25f, 1}, {{0.5f, 1.2f, 0}, kAlongX}, Box{2, 1, 1}, {});
  expectEnds(m, -0.5f, 1.5f);
  EXPECT_LT(length(m.normal - Vec3{0, -1, 0}), 1e-6f);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(m.points[k].separation, -0.05f, 1e-6f);
    EXPECT_NEAR(m.points[k].position.y, 0.975f, 1e-6f);
  }
}

TEST(CollideCapsule, overhangsABoxOnBothSides) {
  for (float tilt : {0.0f, 1e-4f, -2e-3f}) {
    const Manifold m = touch(Capsule{0.25f, 3}, {{0, 1.24f, 0}, slightly(tilt) * kAlongX}, Box{1, 1, 1}, {});
    ASSERT_EQ(m.count, 2);
    EXPECT_LT(length(m.normal - Vec3{0, -1, 0}), 1e-6f);
    EXPECT_NEAR(m.points[0].position.x + m.points[1].position.x, 0, 2e-3f);
    EXPECT_NEAR(std::fabs(m.points[0].position.x), 1, 2e-3f);
  }
}

TEST(CollideCapsule, standsOnABox) {
  const Manifold m = touch(Capsule{0.25f, 1}, {{0.5f, 2.2f, 0}, {}}, Box{1, 1, 1}, {});
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(m.points[0].separation, -0.05f, 1e-6f);
  EXPECT_LT(length(m.normal - Vec3{0, -1, 0}), 1e-6f);
}

TEST(CollideCapsule, liesAlongAnEdge) {
  // Diagonally off the box's edge along x, at y = z = 1.
  const Manifold m = touch(Capsule{0.25f, 2}, {{0, 1.2f, 1.2f}, kAlongX}, Box{1, 1, 1}, {});
  expectEnds(m, -1, 1);
  EXPECT_LT(length(m.normal - Vec3{0, -kHalf, -kHalf}), 1e-6f);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(m.points[k].separation, 0.2f * std::sqrt(2.0f) - 0.25f, 1e-6f);
}

TEST(CollideCapsule, crossesAnEdgeInOnePoint) {
  const Quat tilted = slightly(-0.7f) * kAlongX;  // leans on the edge at x = 1
  const Manifold m =
      touch(Capsule{0.25f, 2}, {Vec3{1, 1, 0} + rotate(slightly(-0.7f), Vec3{0, 0.2f, 0}), tilted}, Box{1, 1, 1}, {});
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(m.points[0].separation, -0.05f, 1e-6f);
  EXPECT_LT(length(m.normal + rotate(slightly(-0.7f), Vec3{0, 1, 0})), 1e-6f);
}

TEST(CollideCapsule, coreInsideABoxLeavesTheShortestWay) {
  const Manifold flat = touch(Capsule{0.25f, 0.5f}, {{0, 0.9f, 0}, kAlongX}, Box{2, 1, 2}, {});
  ASSERT_EQ(flat.count, 2);
  EXPECT_LT(length(flat.normal - Vec3{0, -1, 0}), 1e-6f);
  EXPECT_NEAR(flat.points[0].separation, -0.35f, 1e-6f);
  const Manifold poked = touch(Capsule{0.25f, 1}, {{0, 1.9f, 0}, {}}, Box{2, 1, 2}, {});
  ASSERT_EQ(poked.count, 1);
  EXPECT_LT(length(poked.normal - Vec3{0, -1, 0}), 1e-6f);
  EXPECT_NEAR(poked.points[0].separation, -0.35f, 1e-6f);
}

TEST(CollideCapsule, liesAndStandsOnAHalfSpace) {
  const Manifold lying = touch(Capsule{0.25f, 1}, {{0, 0.2f, 0}, kAlongX}, HalfSpace{}, {});
  expectEnds(lying, -1, 1);
  EXPECT_NEAR(lying.points[0].separation, -0.05f, 1e-6f);
  EXPECT_EQ(touch(Capsule{0.25f, 1}, {{0, 1.2f, 0}, {}}, HalfSpace{}, {}).count, 1);
  EXPECT_EQ(touch(Capsule{0.25f, 1}, {{0, 1.4f, 0}, {}}, HalfSpace{}, {}).count, 0);
}

}  // namespace
}  // namespace avbd
