// Any two convex shapes against the oracle: distance, depth, normal, points.
#include <gtest/gtest.h>

#include "collide/collide_convex_oracle.h"

namespace avbd {
namespace {

using oracle::Asked;
using oracle::Random;

constexpr ShapeType kTypes[] = {ShapeType::Sphere,     ShapeType::Capsule, ShapeType::Box,
                                ShapeType::Cylinder,   ShapeType::Cone,    ShapeType::Ellipsoid,
                                ShapeType::RoundedBox, ShapeType::Hull,    ShapeType::Triangle};
const char* const kNames[] = {"Sphere",    "Capsule",    "Box",  "Cylinder", "Cone",
                              "Ellipsoid", "RoundedBox", "Hull", "Triangle"};

bool isCurved(ShapeType type) {
  return type == ShapeType::Cylinder || type == ShapeType::Cone || type == ShapeType::Ellipsoid;
}

class ConvexPairs : public testing::TestWithParam<std::pair<int, int>> {
 protected:
  ShapeGeom shape(int which, Vec3* corners) {
    if (kTypes[which] != ShapeType::Triangle) return random_.shape(kTypes[which]);
    for (int i = 0; i < 3; ++i) corners[i] = {random_.within(-1, 1), random_.within(-1, 1), random_.within(-1, 1)};
    ShapeGeom g{ShapeType::Triangle, random_.rounding(), {}};
    g.data = corners;
    return g;
  }
  /// Deep inside to well apart, any rotation or nearly aligned.
  Asked next() {
    Asked s{shape(GetParam().first, cornersA_), shape(GetParam().second, cornersB_), {}, {}};
    s.poseA = {{random_.within(-1, 1), random_.within(-1, 1), random_.within(-1, 1)}, random_.usualRotation()};
    s.poseB.q = random_.usualRotation();
    Vec3 d = rotate(random_.rotation(), Vec3{1, 0, 0});
    if (random_.below(4) == 0) d = {0, 1, 0};
    s.poseB.p = s.poseA.p + d * (random_.within(0, 2.4f));
    return s;
  }
  double sizeOf(const Asked& s) {
    const auto one = [](const ShapeGeom& g) { return g.type == ShapeType::Triangle ? 1.7 : oracle::size(g); };
    return one(s.a) + one(s.b);
  }

  Random random_{23};
  std::mt19937 climbing_{5};
  Vec3 cornersA_[3], cornersB_[3];
  static constexpr int kRounds = 60;
};

/// The normal shows the distance that is claimed, up to float rounding; no direction shows more.
TEST_P(ConvexPairs, nearestIsTheLargestGap) {
  int overlapping = 0;
  for (int i = 0; i < kRounds; ++i) {
    const Asked s = next();
    const Nearest n = nearest(s.a, s.poseA, s.b, s.poseB, 100);
    ASSERT_FALSE(n.apart);
    const Vec3d normal = oracle::unitOf(toDouble(n.normal));
    const double size = sizeOf(s);
    ASSERT_NEAR(length(n.normal), 1, 1e-6);
    ASSERT_NEAR(s.gap(normal), n.distance, 1e-6 * size) << i;
    const bool curved = isCurved(s.a.type) || isCurved(s.b.type);
    ASSERT_LT(oracle::largestGap(s, normal, 300, climbing_), n.distance + (curved ? 1e-4 : 1e-6) * size) << i;
    overlapping += n.distance < 0;
  }
  EXPECT_GT(overlapping, kRounds / 10);
  EXPECT_LT(overlapping, kRounds);
}

TEST_P(ConvexPairs, nearestPointsLieOnTheSurfaces) {
  for (int i = 0; i < kRounds; ++i) {
    const Asked s = next();
    const Nearest n = nearest(s.a, s.poseA, s.b, s.poseB, 100);
    const double size = sizeOf(s);
    const Vec3d normal = toDouble(n.normal), a = toDouble(n.pointA), b = toDouble(n.pointB);
    ASSERT_LT(length(b - a - normal * n.distance), 2e-6 * size) << i;
    // Of curved cores that overlap deeply the points lie a little beside each other.
    const double beside = isCurved(s.a.type) || isCurved(s.b.type) ? 5e-3 : 1e-5;
    ASSERT_LT(oracle::sticksOut(s.a, s.poseA, a, 200), 1e-5 * size) << i;
    ASSERT_LT(oracle::sticksOut(s.b, s.poseB, b, 200), (n.distance < 0 ? beside : 1e-5) * size) << i;
    const double onA =
        dot(normal, a - s.poseA.p) - oracle::reach(s.a, oracle::unitRotate(Asked::back(s.poseA.q), normal));
    ASSERT_NEAR(onA, 0, 1e-5 * size) << i;
  }
}

TEST_P(ConvexPairs, farApartIsFoundEarly) {
  for (int i = 0; i < kRounds; ++i) {
    Asked s = next();
    s.poseB.p = s.poseA.p + rotate(random_.rotation(), Vec3{random_.within(1, 9), 0, 0});
    const Nearest whole = nearest(s.a, s.poseA, s.b, s.poseB, 100);
    const float beyond = random_.within(-0.1f, 1);
    const Nearest part = nearest(s.a, s.poseA, s.b, s.poseB, beyond);
    ASSERT_EQ(part.apart, whole.distance >= beyond) << i;
    ASSERT_LE(part.distance, whole.distance + (part.apart ? 1e-5f : 0.0f));
    if (part.apart) continue;
    ASSERT_EQ(part.distance, whole.distance);
  }
}

TEST_P(ConvexPairs, manifoldsAreTrue) {
  for (int i = 0; i < kRounds; ++i) {
    const Asked s = next();
    const float margin = random_.below(2) ? 0.02f : 0.3f;
    const Nearest n = nearest(s.a, s.poseA, s.b, s.poseB, 100);
    Manifold m;
    collide(s.a, s.poseA, s.b, s.poseB, margin, m);
    const double size = sizeOf(s), thin = std::min(oracle::thinnest(s.a), oracle::thinnest(s.b));
    const double core = n.distance + s.a.radius + s.b.radius;
    const double slack = 2e-3 * thin + 0.021 * std::fabs(core) + 3e-5 * size;
    if (m.count == 0) {
      ASSERT_GT(n.distance, margin - slack) << i;
      continue;
    }
    ASSERT_LT(n.distance, margin + 1e-5 * size) << i;
    double lowest = 1e9;
    for (int k = 0; k < m.count; ++k) lowest = std::min<double>(lowest, m.points[k].separation);
    ASSERT_NEAR(lowest, n.distance, slack) << i;
    const Vec3d normal = toDouble(m.normal);
    for (int k = 0; k < m.count; ++k) {
      const Vec3d p = toDouble(m.points[k].position);
      const double half = 0.5 * m.points[k].separation;
      ASSERT_LT(oracle::sticksOut(s.a, s.poseA, p - normal * half, 200), slack) << i << " point " << k;
      ASSERT_LT(oracle::sticksOut(s.b, s.poseB, p + normal * half, 200), slack) << i << " point " << k;
    }
  }
}

std::vector<std::pair<int, int>> allPairs() {
  std::vector<std::pair<int, int>> all;
  for (int i = 0; i < 9; ++i) {
    for (int j = i; j < 9; ++j) all.push_back({i, j});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Collide, ConvexPairs, testing::ValuesIn(allPairs()),
                         [](const auto& of) { return std::string(kNames[of.param.first]) + kNames[of.param.second]; });

}  // namespace
}  // namespace avbd
