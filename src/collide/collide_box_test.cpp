// Box against box and half-space: known answers, and manifolds that stay as they are while nothing changes.
#include <gtest/gtest.h>

#include <set>

#include "collide/collide_oracle.h"

namespace avbd {
namespace {

Quat turned(float angle, Vec3 axis) {
  const float s = std::sin(angle / 2) / length(axis);
  return {std::cos(angle / 2), axis.x * s, axis.y * s, axis.z * s};
}

Manifold touch(const Geometry& a, NearPose pa, const Geometry& b, NearPose pb, float margin = 0.05f) {
  Manifold m;
  collide(toShapeGeom(a), pa, toShapeGeom(b), pb, margin, m);
  return m;
}

const Box kCube{0.5f, 0.5f, 0.5f};

/// Points as (x, z) pairs rounded to a millimetre.
std::set<std::pair<int, int>> footprint(const Manifold& m) {
  std::set<std::pair<int, int>> all;
  for (int k = 0; k < m.count; ++k) {
    const Vec3 p = m.points[k].position;
    all.insert({static_cast<int>(std::lround(p.x * 1000)), static_cast<int>(std::lround(p.z * 1000))});
  }
  return all;
}

std::set<uint32_t> features(const Manifold& m) {
  std::set<uint32_t> all;
  for (int k = 0; k < m.count; ++k) all.insert(m.points[k].feature);
  return all;
}

TEST(CollideBox, stackedTouchesAtFourCorners) {
  const Manifold m = touch(kCube, {}, kCube, {{0, 0.98f, 0}, {}});
  ASSERT_EQ(m.count, 4);
  EXPECT_EQ(m.normal, (Vec3{0, 1, 0}));
  EXPECT_EQ(footprint(m), (std::set<std::pair<int, int>>{{-500, -500}, {-500, 500}, {500, -500}, {500, 500}}));
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(m.points[k].separation, -0.02f, 1e-6f);
    EXPECT_NEAR(m.points[k].position.y, 0.49f, 1e-6f);
  }
}

TEST(CollideBox, shiftedTouchesOnTheOverlap) {
  const Manifold m = touch(kCube, {}, kCube, {{0.25f, 1.01f, -0.5f}, {}});
  ASSERT_EQ(m.count, 4);
  EXPECT_EQ(footprint(m), (std::set<std::pair<int, int>>{{-250, -500}, {-250, 0}, {500, -500}, {500, 0}}));
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(m.points[k].separation, 0.01f, 1e-6f);
}

TEST(CollideBox, smallOnLargeTouchesAtTheSmallOnesCorners) {
  const Manifold m = touch(kCube, {{30, 1.5f, 40}, turned(0.3f, {0, 1, 0})}, Box{100, 1, 100}, {});
  ASSERT_EQ(m.count, 4);
  EXPECT_EQ(m.normal, (Vec3{0, -1, 0}));
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(length(m.points[k].position - Vec3{30, 1, 40}), std::sqrt(0.5f), 1e-4f);
}

TEST(CollideBox, turnedByAnEighthKeepsFourPointsOfTheOctagon) {
  const Manifold m = touch(kCube, {}, kCube, {{0, 0.99f, 0}, turned(0.785398f, {0, 1, 0})});
  ASSERT_EQ(m.count, 4);
  // Area of the quadrilateral of what was kept: most of the octagon's 0.828.
  float area = 0;
  for (int k = 0; k < 4; ++k) {
    const Vec3 a = m.points[k].position, b = m.points[(k + 1) % 4].position;
    area += 0.5f * (a.x * b.z - a.z * b.x);
  }
  EXPECT_GT(std::fabs(area), 0.5f);
}

TEST(CollideBox, tiltedReportsTheDeepestPoint) {
  for (float tilt : {0.0005f, 0.01f, 0.05f}) {
    const Quat q = turned(0.785398f, {0, 1, 0}) * turned(tilt, {1, 0, 0.3f});
    const NearPose pose{{0, 1, 0}, q};
    const Manifold m = touch(kCube, {}, kCube, pose, 0.2f);
    const auto solid = [](const NearPose& p) { return oracle::solidOf(toShapeGeom(kCube), p); };
    float lowest = 1;
    for (int k = 0; k < m.count; ++k) lowest = std::fmin(lowest, m.points[k].separation);
    EXPECT_NEAR(lowest, oracle::separation(solid({}), solid(pose)), 1e-3);
    // Its corners hang over: it is edges that lie on edges, at all four corners of the octagon.
    EXPECT_EQ(m.count, 4);
  }
}

TEST(CollideBox, onAnEdgeTouchesInTwoPoints) {
  const Manifold m = touch(kCube, {}, kCube, {{0, 0.5f + std::sqrt(0.5f) - 0.01f, 0}, turned(0.785398f, {1, 0, 0})});
  ASSERT_EQ(m.count, 2);
  EXPECT_LT(length(m.normal - Vec3{0, 1, 0}), 1e-6f);
  EXPECT_NEAR(m.points[0].separation, -0.01f, 1e-5f);
  EXPECT_NEAR(std::fabs(m.points[0].position.x - m.points[1].position.x), 1, 1e-5f);
}

TEST(CollideBox, onACornerTouchesInOnePoint) {
  const Quat corner = turned(0.955317f, {1, 0, -1});  // the cube's diagonal upright
  const Manifold m = touch(kCube, {}, kCube, {{0.1f, 0.5f + std::sqrt(0.75f) - 0.01f, 0}, corner});
  ASSERT_EQ(m.count, 1);
  EXPECT_LT(length(m.normal - Vec3{0, 1, 0}), 1e-6f);
  EXPECT_NEAR(m.points[0].separation, -0.01f, 1e-5f);
  EXPECT_NEAR(m.points[0].position.x, 0.1f, 1e-5f);
}

/// Two long bars, each on an edge, crossed.
Manifold crossedEdges(float gap, float margin) {
  const Box bar{2, 0.5f, 0.5f};
  const Quat edgeUp = turned(0.785398f, {1, 0, 0});
  const float h = 2 * std::sqrt(0.5f);
  return touch(bar, {{}, edgeUp}, bar, {{0.3f, h + gap, 0.2f}, turned(1.570796f, {0, 1, 0}) * edgeUp}, margin);
}

TEST(CollideBox, crossedEdgesTouchInOnePoint) {
  for (float gap : {-0.05f, 0.04f}) {
    const Manifold m = crossedEdges(gap, 0.05f);
    ASSERT_EQ(m.count, 1);
    EXPECT_LT(length(m.normal - Vec3{0, 1, 0}), 1e-5f);
    EXPECT_NEAR(m.points[0].separation, gap, 1e-5f);
    EXPECT_LT(length(m.points[0].position - Vec3{0.3f, std::sqrt(0.5f) + gap / 2, 0}), 1e-5f);
  }
  EXPECT_EQ(crossedEdges(0.06f, 0.05f).count, 0);
}

TEST(CollideBox, cornerApartReportsTheDistanceNotTheAxisGap) {
  // Diagonal neighbours: 0.03 apart along x and 0.04 along y, so 0.05 in truth.
  const Manifold m = touch(kCube, {}, kCube, {{1.03f, 1.04f, 0.2f}, {}}, 0.1f);
  ASSERT_EQ(m.count, 2);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(m.points[k].separation, 0.05f, 1e-6f);
  EXPECT_LT(length(m.normal - Vec3{0.6f, 0.8f, 0}), 1e-5f);
  EXPECT_EQ(touch(kCube, {}, kCube, {{1.03f, 1.04f, 0.2f}, {}}, 0.045f).count, 0);
  const Manifold corner = touch(kCube, {}, kCube, {{1.03f, 1.04f, 1.12f}, {}}, 0.2f);
  ASSERT_EQ(corner.count, 1);
  EXPECT_NEAR(corner.points[0].separation, 0.13f, 1e-6f);
}

TEST(CollideBox, besideEachOtherWithinTheMarginOfAnEdgeIsNoFaceContact) {
  // Beside the lower cube and above its top: falling past must not meet a plane across its way.
  const Manifold m = touch(kCube, {}, kCube, {{1.02f, 1.01f, 0}, {}}, 0.015f);
  EXPECT_EQ(m.count, 0);
}

TEST(CollideBox, deepOverlapTakesTheShortestWayOut) {
  const Manifold m = touch(Box{1, 1, 1}, {}, Box{1, 1, 1}, {{0.3f, -0.2f, 1.4f}, {}});
  EXPECT_EQ(m.normal, (Vec3{0, 0, 1}));
  ASSERT_EQ(m.count, 4);
  EXPECT_NEAR(m.points[0].separation, -0.6f, 1e-6f);
}

TEST(CollideBox, onAHalfSpace) {
  const Manifold flat = touch(kCube, {{1, 0.49f, 2}, turned(0.4f, {0, 1, 0})}, HalfSpace{}, {});
  ASSERT_EQ(flat.count, 4);
  EXPECT_EQ(features(flat).size(), 4u);
  EXPECT_LT(length(flat.normal - Vec3{0, -1, 0}), 1e-6f);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(flat.points[k].separation, -0.01f, 1e-6f);
  EXPECT_EQ(touch(kCube, {{0, 0.72f, 0}, turned(0.785398f, {0, 0, 1})}, HalfSpace{}, {}).count, 2);
  EXPECT_EQ(touch(kCube, {{0, 0.6f, 0}, {}}, HalfSpace{}, {}).count, 0);
  EXPECT_EQ(touch(kCube, {{0, -50, 0}, {}}, HalfSpace{}, {}).count, 4);
}

struct Resting {
  const char* name;
  Box a, b;
  NearPose poseA, poseB;
};

class RestingBoxes : public testing::TestWithParam<Resting> {};

TEST_P(RestingBoxes, keepTheirPointsThroughNoise) {
  const Resting& r = GetParam();
  const Manifold still = touch(r.a, r.poseA, r.b, r.poseB);
  ASSERT_GT(still.count, 1);
  oracle::Random random(11);
  for (int i = 0; i < 2000; ++i) {
    NearPose a = r.poseA, b = r.poseB;
    for (NearPose* p : {&a, &b}) {
      const auto noise = [&] { return random.within(-1e-5f, 1e-5f); };
      p->p = p->p + Vec3{noise(), noise(), noise()};
      p->q = oracle::Random::normalized(Quat{1, noise(), noise(), noise()} * p->q);
    }
    const Manifold m = touch(r.a, a, r.b, b);
    ASSERT_EQ(features(m), features(still)) << i;
    for (int k = 0; k < m.count; ++k) {
      ASSERT_LT(length(m.points[k].position - still.points[k].position), 1e-3f);
      ASSERT_NEAR(m.points[k].separation, still.points[k].separation, 5e-4f);
    }
    ASSERT_LT(length(m.normal - still.normal), 2e-4f);
  }
}

const Box kPlank{1, 0.05f, 0.2f};
INSTANTIATE_TEST_SUITE_P(
    Collide, RestingBoxes,
    testing::Values(Resting{"InLine", kCube, kCube, {}, {{0, 0.999f, 0}, {}}},
                    Resting{"Shifted", kCube, kCube, {}, {{0.3f, 0.999f, 0.1f}, {}}},
                    Resting{"Eighth", kCube, kCube, {}, {{0, 0.999f, 0}, turned(0.785398f, {0, 1, 0})}},
                    Resting{"Yaw", kCube, kCube, {}, {{0.1f, 0.999f, 0.05f}, turned(0.4f, {0, 1, 0})}},
                    Resting{"OnGround", Box{20, 1, 20}, kCube, {}, {{3, 1.499f, 4}, turned(0.2f, {0, 1, 0})}},
                    Resting{"SideBySide", kCube, kCube, {}, {{0.999f, 0, 0}, {}}},
                    Resting{"InFront", kCube, kCube, {}, {{0, 0, -0.999f}, {}}},
                    Resting{"LyingPlank", kPlank, kCube, {}, {{0.8f, 0.549f, 0}, turned(0.1f, {0, 1, 0})}},
                    Resting{"QuarterTurned",
                            kCube,
                            kCube,
                            {{}, turned(1.5707963f, {0, 0, 1})},
                            {{0, 0.999f, 0}, turned(1.5707963f, {1, 0, 0})}},
                    Resting{"OnEdge", kCube, kCube, {}, {{0.1f, 1.206f, 0}, turned(0.785398f, {0, 0, 1})}}),
    [](const auto& resting) { return resting.param.name; });

/// Mirrored scenes give mirrored contacts, up to rounding.
TEST(CollideBox, mirrored) {
  oracle::Random random(13);
  for (int i = 0; i < 3000; ++i) {
    const float tilt = random.below(2) ? 0.0f : 0.02f;
    const Quat q = oracle::Random::normalized(
        Quat{1, random.within(-tilt, tilt), random.within(-0.2f, 0.2f), random.within(-tilt, tilt)});
    const Vec3 p{random.within(-0.6f, 0.6f), 1 + random.within(-0.01f, 0.01f), random.within(-0.6f, 0.6f)};
    const Box a{0.5f, 0.5f, 0.6f}, b{0.4f, 0.5f, 0.5f};
    const Manifold m = touch(a, {}, b, {p, q}, 0.3f);
    const Manifold o = touch(a, {}, b, {{-p.x, p.y, p.z}, {q.w, q.x, -q.y, -q.z}}, 0.3f);
    EXPECT_LT(length(m.normal - Vec3{-o.normal.x, o.normal.y, o.normal.z}), 1e-5f);
    float low[2] = {1, 1};
    for (int k = 0; k < m.count; ++k) low[0] = std::fmin(low[0], m.points[k].separation);
    for (int k = 0; k < o.count; ++k) low[1] = std::fmin(low[1], o.points[k].separation);
    // Of more than four points the choice may differ by what a slight slope lifts one.
    ASSERT_NEAR(low[0], low[1], 6e-3f);
  }
}

}  // namespace
}  // namespace avbd
