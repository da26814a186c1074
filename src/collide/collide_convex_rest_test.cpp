// Any two convex shapes at rest on each other, by hand: where the points are and that they stay.
#include <gtest/gtest.h>

#include <set>

#include "collide/collide_convex_oracle.h"

namespace avbd {
namespace {

const float kHalf = std::sqrt(0.5f);
const Quat kLying{kHalf, kHalf, 0, 0};  // the y axis along z

Manifold at(const ShapeGeom& a, NearPose poseA, const ShapeGeom& b, NearPose poseB, float margin = 0.02f) {
  Manifold m;
  collide(a, poseA, b, poseB, margin, m);
  return m;
}

Quat tilted(float angle, Vec3 axis) {
  const float k = std::sin(angle / 2) / length(axis);
  return {std::cos(angle / 2), axis.x * k, axis.y * k, axis.z * k};
}

ShapeGeom boxHull(float x, float y, float z) {
  static std::vector<std::shared_ptr<const HullData>> kept;
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back({k & 1 ? x : -x, k & 2 ? y : -y, k & 4 ? z : -z});
  kept.push_back(makeHull({.points = corners}));
  return toShapeGeom(Hull{kept.back()});
}

/// Half of the area that four points span, up to their order.
double span(const Manifold& m) {
  double most = 0;
  for (int i = 0; i < m.count; ++i) {
    for (int j = 0; j < m.count; ++j) {
      for (int k = 0; k < m.count; ++k) {
        const Vec3 p = m.points[i].position;
        most = std::max<double>(most, length(cross(m.points[j].position - p, m.points[k].position - p)));
      }
    }
  }
  return most / 2;
}

TEST(ConvexRest, boxHullsTouchAsBoxesDo) {
  oracle::Random random(8);
  const ShapeGeom box = toShapeGeom(Box{0.5f, 0.4f, 0.3f}), hull = boxHull(0.5f, 0.4f, 0.3f);
  for (int i = 0; i < 300; ++i) {
    const float e = i % 3 ? 0.002f : 0;
    const NearPose a{{}, tilted(random.within(-e, e), {1, 0, 1})};
    const NearPose b{{random.within(-0.3f, 0.3f), random.within(0.79f, 0.81f), random.within(-0.2f, 0.2f)},
                     tilted(random.within(-0.3f, 0.3f), {0, 1, 0}) * tilted(random.within(-e, e), {1, 0, 0})};
    const Manifold m = at(box, a, box, b);
    for (const Manifold& o : {at(hull, a, hull, b), at(box, a, hull, b), at(hull, a, box, b)}) {
      ASSERT_EQ(m.count, o.count) << i;
      // (Of box and hull the box comes first.)
      const float turn = dot(m.normal, o.normal) < 0 ? -1.0f : 1.0f;
      ASSERT_LT(length(m.normal - o.normal * turn), 2 * e + 1e-6f);
      ASSERT_LT(m.normal == o.normal * turn ? std::fabs(span(m) - span(o)) : 0, 0.05) << i;
      float low[2] = {9, 9};
      for (int k = 0; k < m.count; ++k) {
        low[0] = std::min(low[0], m.points[k].separation);
        low[1] = std::min(low[1], o.points[k].separation);
      }
      ASSERT_NEAR(low[0], low[1], 3e-4) << i;
    }
  }
}

TEST(ConvexRest, normalsOfFaceContactsAreExact) {
  const ShapeGeom hull = boxHull(0.5f, 0.5f, 0.5f), cylinder = toShapeGeom(Cylinder{0.4f, 0.5f});
  const ShapeGeom cone = toShapeGeom(Cone{0.4f, 0.5f}), round = toShapeGeom(Box{0.4f, 0.4f, 0.4f, 0.1f});
  oracle::Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 up{random.within(-0.05f, 0.05f), random.within(0.985f, 1.015f), random.within(-0.05f, 0.05f)};
    for (const ShapeGeom& top : {hull, cylinder, cone, round}) {
      const Manifold m = at(hull, {}, top, {up, {}});
      ASSERT_EQ(m.count, 4);
      EXPECT_EQ(std::fabs(m.normal.y), 1);
      EXPECT_EQ(m.normal.x, 0);
      EXPECT_EQ(m.normal.z, 0);
      for (int k = 0; k < 4; ++k) EXPECT_NEAR(m.points[k].separation, up.y - 1, 2e-6);
    }
    for (const ShapeGeom& lying : {cylinder, toShapeGeom(Capsule{0.4f, 0.4f})}) {
      const Manifold m = at(hull, {}, lying, {{up.x, up.y - 0.1f, up.z}, kLying});
      ASSERT_EQ(m.count, 2);
      EXPECT_EQ(std::fabs(m.normal.y), 1);
    }
  }
}

/// A can on the ground: four points of its rim, well spread, and the same ones while it shakes a little.
TEST(ConvexRest, standingCylinderKeepsItsPoints) {
  oracle::Random random(4);
  const ShapeGeom can = toShapeGeom(Cylinder{0.5f, 0.7f}), ground = toShapeGeom(HalfSpace{});
  const ShapeGeom table = toShapeGeom(Box{2, 0.5f, 2});
  for (const bool plane : {true, false}) {
    std::set<uint32_t> seen;
    for (int i = 0; i < 500; ++i) {
      const float e = 5e-5f;
      const Quat q = tilted(random.within(-e, e), {1, 0, random.within(-1, 1)});
      const NearPose pose{{0, 0.699f, 0}, q};
      const Manifold m = plane ? at(can, pose, ground, {}) : at(can, pose, table, {{0, -0.5f, 0}, {}});
      ASSERT_EQ(m.count, 4);
      EXPECT_GT(span(m), 0.24);
      for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(std::hypot(m.points[k].position.x, m.points[k].position.z), 0.5f, 1e-3);
        seen.insert(m.points[k].feature);
      }
    }
    EXPECT_EQ(seen.size(), 4u);
  }
}

/// Tilted, a can stands on the lowest point of its rim wherever that is.
TEST(ConvexRest, tiltedCylinderHasItsLowestPoint) {
  oracle::Random random(6);
  const ShapeGeom can = toShapeGeom(Cylinder{0.5f, 0.7f}), ground = toShapeGeom(HalfSpace{});
  for (int i = 0; i < 500; ++i) {
    const float angle = random.within(0.0005f, 0.6f), way = random.within(-3, 3);
    const Quat q = tilted(angle, {std::cos(way), 0, std::sin(way)});
    const double lowest = -(0.5 * std::sin(double{angle}) + 0.7 * std::cos(double{angle}));
    const Manifold m = at(can, {{0, static_cast<float>(-lowest) - 0.01f, 0}, q}, ground, {});
    ASSERT_GT(m.count, 0);
    double low = 9;
    for (int k = 0; k < m.count; ++k) low = std::min<double>(low, m.points[k].separation);
    ASSERT_NEAR(low, -0.01, 4e-5) << angle << " " << way;
  }
}

TEST(ConvexRest, rollingCylinderHasTwoPointsAtItsEnds) {
  const ShapeGeom can = toShapeGeom(Cylinder{0.5f, 0.7f}), ground = toShapeGeom(HalfSpace{});
  for (int i = 0; i < 100; ++i) {
    const Quat q = kLying * tilted(0.0628f * static_cast<float>(i), {0, 1, 0});
    const Manifold m = at(can, {{0, 0.499f, 0}, q}, ground, {});
    ASSERT_EQ(m.count, 2);
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(std::fabs(m.points[k].position.z), 0.7f, 1e-5);
      EXPECT_NEAR(m.points[k].position.x, 0, 1e-5);
      EXPECT_NEAR(m.points[k].separation, -0.001f, 1e-6);
    }
    const Manifold log = at(can, {{0, 0.999f, 0}, q}, can, {{}, kLying});
    ASSERT_EQ(log.count, 2);
    EXPECT_NEAR(log.normal.y, -1, 1e-6);
    EXPECT_NEAR(log.normal.x, 0, 2e-4);
  }
}

TEST(ConvexRest, coneRestsOnItsBaseAndOnItsSide) {
  const ShapeGeom cone = toShapeGeom(Cone{0.5f, 0.5f}), ground = toShapeGeom(HalfSpace{});
  const Manifold base = at(cone, {{0, 0.5f, 0}, {}}, ground, {});
  EXPECT_EQ(base.count, 4);
  EXPECT_GT(span(base), 0.24);
  const float slope = std::atan2(0.5f, 1.0f);  // between axis and mantle
  const Quat side = tilted(1.57079633f + slope, {1, 0, 0});
  const float height = 0.5f * std::sin(slope);  // of the middle of the axis
  const Manifold m = at(cone, {{0, height, 0}, side}, ground, {});
  ASSERT_EQ(m.count, 2);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(m.points[k].separation, 0, 2e-6);
  EXPECT_NEAR(length(m.points[0].position - m.points[1].position), std::sqrt(1.25f), 1e-5);
}

TEST(ConvexRest, ellipsoidTouchesInOnePoint) {
  const ShapeGeom egg = toShapeGeom(Ellipsoid{0.5f, 0.3f, 0.4f});
  for (const Manifold& m : {at(egg, {{0, 0.299f, 0}, {}}, toShapeGeom(HalfSpace{}), {}),
                            at(egg, {{0, 0.299f, 0}, {}}, toShapeGeom(Box{1, 1, 1}), {{0, -1, 0}, {}})}) {
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(std::fabs(m.normal.y), 1, 1e-6);
    EXPECT_NEAR(m.points[0].separation, -0.001f, 1e-6);
    EXPECT_NEAR(length(m.points[0].position), 0.0005f, 1e-5);
  }
}

/// Faces with many corners are cut down to four that still span most of the face.
TEST(ConvexRest, manyCorneredFacesAreReduced) {
  std::vector<Vec3> points;
  for (int i = 0; i < 24; ++i) {
    const float t = 0.261799388f * static_cast<float>(i);
    for (float y : {-0.2f, 0.2f}) points.push_back({std::cos(t), y, std::sin(t)});
  }
  const auto drum = makeHull({.points = points});
  const ShapeGeom g = toShapeGeom(Hull{drum});
  for (const Manifold& m : {at(g, {{0, 0.1999f, 0}, {}}, toShapeGeom(HalfSpace{}), {}),
                            at(g, {{0, 0.3999f, 0}, tilted(0.1f, {0, 1, 0})}, g, {})}) {
    ASSERT_EQ(m.count, 4);
    EXPECT_GT(span(m), 0.9);
  }
}

/// Sizes far apart: a hull of a centimetre on a box of a hundred metres, far from its middle.
TEST(ConvexRest, smallOnHuge) {
  const ShapeGeom small = boxHull(0.005f, 0.005f, 0.005f), huge = toShapeGeom(Box{50, 50, 50, 1e-3f});
  const Manifold m = at(huge, {{0, -50.001f, 0}, {}}, small, {{40, 0.0049f, -40}, {}}, 0.001f);
  ASSERT_EQ(m.count, 4);
  EXPECT_EQ(m.normal.y, 1);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(m.points[k].separation, -1e-4, 8e-6);
}

/// Little motions change normal and depth little while a corner slides over a face.
TEST(ConvexRest, slidingIsContinuous) {
  const ShapeGeom hull = boxHull(0.5f, 0.5f, 0.5f), cylinder = toShapeGeom(Cylinder{0.4f, 0.5f});
  const Quat corner = tilted(0.6f, {1, 0, 0.7f});
  for (const ShapeGeom& top : {hull, cylinder}) {
    Manifold last;
    float lowLast = 0;
    for (int i = 0; i < 400; ++i) {
      const Manifold m = at(hull, {}, top, {{-0.2f + 0.001f * static_cast<float>(i), 1.12f, 0.1f}, corner}, 0.5f);
      float low = 9;
      for (int k = 0; k < m.count; ++k) low = std::min(low, m.points[k].separation);
      if (i > 0) {
        ASSERT_LT(length(m.normal - last.normal), 0.05f) << i;
        ASSERT_NEAR(low, lowLast, 2e-3f) << i;
      }
      last = m;
      lowLast = low;
    }
  }
}

}  // namespace
}  // namespace avbd
