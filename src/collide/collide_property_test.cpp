// What holds for every pair of shapes: symmetry, invariance, exact scaling, and depths as the oracle finds them.
#include <gtest/gtest.h>

#include <cstring>

#include "collide/collide_oracle.h"

namespace avbd {
namespace {

using oracle::Random;
using oracle::Scene;

constexpr ShapeType kTypes[] = {ShapeType::Sphere,     ShapeType::Capsule, ShapeType::Box,
                                ShapeType::Cylinder,   ShapeType::Cone,    ShapeType::Ellipsoid,
                                ShapeType::RoundedBox, ShapeType::Hull,    ShapeType::HalfSpace};
constexpr int kConvex = 8;  // of them

/// Whether pairs of this type and another such one have functions of their own.
bool isOld(ShapeType type) { return type <= ShapeType::Box || type == ShapeType::HalfSpace; }

class Pairs : public testing::TestWithParam<std::pair<ShapeType, ShapeType>> {
 protected:
  Scene next() { return oracle::randomScene(random_, GetParam().first, GetParam().second); }
  Random random_{17};
  /// Pairs of the general function are many and slower.
  int rounds() const { return isOld(GetParam().first) && isOld(GetParam().second) ? 6000 : 500; }
};

std::string describe(const Scene& s) {
  char text[800];
  std::snprintf(text, sizeof text,
                "a r%.9g (%.9g %.9g %.9g) p(%.9g %.9g %.9g) q(%.9g %.9g %.9g %.9g)\nb r%.9g (%.9g %.9g %.9g) p(%.9g "
                "%.9g %.9g) q(%.9g %.9g %.9g %.9g) margin %.9g",
                s.a.radius, s.a.extent.x, s.a.extent.y, s.a.extent.z, s.poseA.p.x, s.poseA.p.y, s.poseA.p.z,
                s.poseA.q.w, s.poseA.q.x, s.poseA.q.y, s.poseA.q.z, s.b.radius, s.b.extent.x, s.b.extent.y,
                s.b.extent.z, s.poseB.p.x, s.poseB.p.y, s.poseB.p.z, s.poseB.q.w, s.poseB.q.x, s.poseB.q.y, s.poseB.q.z,
                s.margin);
  return text;
}

TEST_P(Pairs, wellFormed) {
  int touching = 0;
  for (int i = 0; i < rounds(); ++i) {
    const Scene s = next();
    const Manifold m = s.collide();
    ASSERT_GE(m.count, 0);
    ASSERT_LE(m.count, kMaxManifoldPoints);
    if (m.count == 0) continue;
    ++touching;
    ASSERT_NEAR(length(m.normal), 1, 2e-6) << describe(s);
    for (int k = 0; k < m.count; ++k) {
      ASSERT_TRUE(std::isfinite(dot(m.points[k].position, m.points[k].position))) << describe(s);
      ASSERT_LE(m.points[k].separation, s.margin) << describe(s);
      for (int j = 0; j < k; ++j) ASSERT_NE(m.points[k].feature, m.points[j].feature) << describe(s);
    }
  }
  EXPECT_GT(touching, rounds() / 10);
}

TEST_P(Pairs, changingPlacesTurnsTheNormalRound) {
  for (int i = 0; i < rounds(); ++i) {
    const Scene s = next(), r{s.b, s.a, s.poseB, s.poseA, s.margin};
    const Manifold m = s.collide(), o = r.collide();
    ASSERT_EQ(m.count, o.count);
    if (m.count == 0) continue;
    ASSERT_EQ(m.normal, -o.normal) << describe(s);
    for (int k = 0; k < m.count; ++k) {
      ASSERT_EQ(m.points[k].position, o.points[k].position);
      ASSERT_EQ(m.points[k].separation, o.points[k].separation);
    }
  }
}

TEST_P(Pairs, sameBitsAgain) {
  for (int i = 0; i < rounds() / 10; ++i) {
    const Scene s = next();
    const Manifold m = s.collide(), o = s.collide();
    ASSERT_EQ(m.count, o.count);
    for (int k = 0; k < m.count; ++k) ASSERT_EQ(m.points[k].feature, o.points[k].feature);
  }
}

TEST_P(Pairs, translationChangesNothing) {
  for (int i = 0; i < rounds(); ++i) {
    Scene s = next();
    // Positions on a grid, so that the shift is exact.
    const auto snap = [](Vec3 p) {
      return Vec3{std::round(p.x * 4096) / 4096, std::round(p.y * 4096) / 4096, std::round(p.z * 4096) / 4096};
    };
    s.poseA.p = snap(s.poseA.p);
    s.poseB.p = snap(s.poseB.p);
    Scene t = s;
    const Vec3 shift{8, -16, 4};
    t.poseA.p = t.poseA.p + shift;
    t.poseB.p = t.poseB.p + shift;
    const Manifold m = s.collide(), o = t.collide();
    ASSERT_EQ(m.count, o.count) << describe(s);
    if (m.count == 0) continue;
    ASSERT_EQ(m.normal, o.normal);
    for (int k = 0; k < m.count; ++k) {
      // Of a half-space the heights alone are used, of a box the separation does not see where it is.
      ASSERT_EQ(m.points[k].feature, o.points[k].feature);
      ASSERT_NEAR(m.points[k].separation, o.points[k].separation, 4e-6);
      ASSERT_LT(length(m.points[k].position + shift - o.points[k].position), 8e-6);
    }
  }
}

TEST_P(Pairs, powersOfTwoScaleEveryBit) {
  for (int i = 0; i < rounds(); ++i) {
    const Scene s = next();
    for (float k : {1.0f / 128, 128.0f}) {
      const Scene t{oracle::scaled(s.a, k),
                    oracle::scaled(s.b, k),
                    {s.poseA.p * k, s.poseA.q},
                    {s.poseB.p * k, s.poseB.q},
                    s.margin * k};
      const Manifold m = s.collide(), o = t.collide();
      ASSERT_EQ(m.count, o.count) << describe(s);
      if (m.count == 0) continue;
      ASSERT_EQ(m.normal, o.normal) << describe(s);
      for (int j = 0; j < m.count; ++j) {
        ASSERT_EQ(m.points[j].position * k, o.points[j].position);
        ASSERT_EQ(m.points[j].separation * k, o.points[j].separation);
        ASSERT_EQ(m.points[j].feature, o.points[j].feature);
      }
    }
  }
}

/// Smallest separation, normal and points against the oracle; bounded shapes only.
void expectTrue(const Scene& s) {
  const oracle::Solid a = oracle::solidOf(s.a, s.poseA), b = oracle::solidOf(s.b, s.poseB);
  const double truth = oracle::separation(a, b), thin = std::min(oracle::thinnest(s.a), oracle::thinnest(s.b));
  const double slack = 2.5e-3 * thin + 2e-3 * std::min(oracle::size(s.a), oracle::size(s.b)) +
                       0.03 * std::fabs(truth + a.radius + b.radius) + 0.003 * (a.radius + b.radius) + 5e-6;
  const Manifold m = s.collide();
  if (m.count == 0) {
    ASSERT_GT(truth, s.margin - slack) << describe(s);
    return;
  }
  double lowest = 1e9;
  for (int k = 0; k < m.count; ++k) lowest = std::min<double>(lowest, m.points[k].separation);
  ASSERT_LT(truth, s.margin + 5e-6) << describe(s);
  ASSERT_NEAR(lowest, truth, slack) << describe(s);
  const Vec3d n = toDouble(m.normal);
  // Of cores that nearly meet, rounding turns the direction; the overlap is then deep.
  const double turn = 3e-6 / (std::fabs(truth + a.radius + b.radius) + 1e-6) * (oracle::size(s.a) + oracle::size(s.b));
  // A capsule on a face takes the face's normal up to a small angle.
  double snap = s.a.type == ShapeType::Capsule && s.b.type == ShapeType::Box ? 0.0065 * s.a.extent.y : 0;
  // A face may stand for an edge axis of nearly its direction: corners beside it then lie lower than its points.
  if (s.a.type == ShapeType::Box && m.count > 1) snap = 0.15 * (oracle::size(s.a) + oracle::size(s.b));
  ASSERT_NEAR(oracle::gapAlong(a, b, n) - a.radius - b.radius, truth, slack + turn + snap) << describe(s);
  for (int k = 0; k < m.count; ++k) {
    const Vec3d p = toDouble(m.points[k].position);
    const double half = 0.5 * m.points[k].separation;
    // Both ends of the gap lie on the surfaces (of a deep overlap at least on one, and in the other).
    const double onA = oracle::surfaceDistance(a, p - n * half), onB = oracle::surfaceDistance(b, p + n * half);
    const double reach = slack + 0.004 * (a.radius + b.radius);
    ASSERT_LT(onA, reach) << "point " << k << " of " << m.count << "\n" << describe(s);
    ASSERT_LT(onB, reach) << "point " << k << " of " << m.count << "\n" << describe(s);
    // The upper end of a steep capsule has its lowest point within the capsule.
    const bool lowestOne = m.points[k].separation <= lowest;
    if (truth > 0 && (lowestOne || s.a.type != ShapeType::Capsule)) {
      ASSERT_GT(onA, -reach) << describe(s);
      ASSERT_GT(onB, -reach) << describe(s);
    }
  }
}

TEST_P(Pairs, depthAndDistanceAreTrue) {
  if (GetParam().second == ShapeType::HalfSpace) GTEST_SKIP() << "has its own test";
  if (!isOld(GetParam().second)) GTEST_SKIP() << "see collide_convex_test.cpp";
  for (int i = 0; i < rounds(); ++i) {
    expectTrue(next());
    if (HasFatalFailure()) return;
  }
}

/// Every bounded corner nearer than the margin is below the lowest point reported, at most.
TEST_P(Pairs, halfSpaceSeesTheLowestPoint) {
  if (GetParam().second != ShapeType::HalfSpace || !isOld(GetParam().first))
    GTEST_SKIP() << "see collide_convex_test.cpp";
  for (int i = 0; i < rounds(); ++i) {
    const Scene s = next();
    const oracle::Solid a = oracle::solidOf(s.a, s.poseA);
    const Vec3d up = oracle::unitRotate(s.poseB.q, Vec3d{0, 1, 0});
    double truth = 1e9, lowest = 1e9;
    for (const Vec3d& c : a.corners) truth = std::min(truth, dot(up, c - toDouble(s.poseB.p)) - a.radius);
    const Manifold m = s.collide();
    for (int k = 0; k < m.count; ++k) {
      lowest = std::min<double>(lowest, m.points[k].separation);
      const Vec3d p = toDouble(m.points[k].position) + up * (0.5 * m.points[k].separation);
      ASSERT_NEAR(dot(up, toDouble(m.points[k].position) - toDouble(s.poseB.p)), 0.5 * m.points[k].separation, 5e-6);
      // The lowest point of a capsule's upper end may lie within the capsule.
      ASSERT_LT(oracle::surfaceDistance(a, p), 5e-6) << describe(s);
      if (s.a.type == ShapeType::Capsule) continue;
      ASSERT_GT(oracle::surfaceDistance(a, p), -5e-6) << describe(s);
    }
    if (m.count == 0) {
      ASSERT_GT(truth, s.margin - 5e-6);
    } else {
      ASSERT_NEAR(lowest, truth, 5e-6);
      ASSERT_LT(length(toDouble(m.normal) + up), 1e-6);
    }
  }
}

/// A step of a thousandth of the size must not change the result by much more: no jumps of the lowest separation.
TEST_P(Pairs, separationIsContinuous) {
  for (int i = 0; i < rounds() / 2; ++i) {
    const Scene s = next();
    Scene t = s;
    const float step = 1e-3f * std::min(oracle::thinnest(s.a), oracle::thinnest(s.b));
    t.poseB.p = t.poseB.p + rotate(random_.rotation(), Vec3{step, 0, 0});
    const Manifold m = s.collide(), o = t.collide();
    if (m.count == 0 || o.count == 0) continue;
    float low[2] = {1e9f, 1e9f};
    for (int k = 0; k < m.count; ++k) low[0] = std::min(low[0], m.points[k].separation);
    for (int k = 0; k < o.count; ++k) low[1] = std::min(low[1], o.points[k].separation);
    const float core = std::fabs(low[0] + s.a.radius + s.b.radius);
    ASSERT_NEAR(low[0], low[1], 5 * step + 0.03f * core + 0.005f * (s.a.radius + s.b.radius)) << describe(s);
  }
}

std::vector<std::pair<ShapeType, ShapeType>> allPairs() {
  std::vector<std::pair<ShapeType, ShapeType>> all;
  for (int i = 0; i < kConvex; ++i) {
    for (int j = i; j <= kConvex; ++j) all.push_back({kTypes[i], kTypes[j]});
  }
  return all;
}

std::string nameOf(const testing::TestParamInfo<std::pair<ShapeType, ShapeType>>& info) {
  const char* names[] = {"Sphere",    "Capsule",    "Box",  "Cylinder", "Cone",
                         "Ellipsoid", "RoundedBox", "Hull", "Triangle", "HalfSpace"};
  return std::string(names[static_cast<int>(info.param.first)]) + names[static_cast<int>(info.param.second)];
}

INSTANTIATE_TEST_SUITE_P(Collide, Pairs, testing::ValuesIn(allPairs()), nameOf);

TEST(Collide, halfSpacesDoNotTouch) {
  Manifold m;
  m.count = 3;
  collide(toShapeGeom(HalfSpace{}), {}, toShapeGeom(HalfSpace{}), {{0, -1, 0}, {}}, 1, m);
  EXPECT_EQ(m.count, 0);
}

TEST(Collide, coincidentShapesGetAUnitNormal) {
  for (ShapeType a : kTypes) {
    for (ShapeType b : kTypes) {
      if (a == ShapeType::HalfSpace && b == a) continue;
      Random random(3);
      for (int i = 0; i < 50; ++i) {
        const NearPose pose{{1, 2, 3}, i == 0 ? Quat{} : random.usualRotation()};
        const NearPose other{{1, 2, 3}, i % 2 ? pose.q : random.usualRotation()};
        Manifold m;
        collide(random.shape(a), pose, random.shape(b), other, 0.01f, m);
        // A hull need not hold its frame's origin.
        const bool hulls = a == ShapeType::Hull || b == ShapeType::Hull;
        if (m.count == 0 && hulls) continue;
        ASSERT_GT(m.count, 0) << static_cast<int>(a) << " " << static_cast<int>(b) << " " << i;
        ASSERT_NEAR(length(m.normal), 1, 1e-5);
        for (int k = 0; k < m.count; ++k) ASSERT_TRUE(std::isfinite(length(m.points[k].position)));
      }
    }
  }
}

TEST(Collide, extremeSizesStayFinite) {
  Random random(5);
  for (int i = 0; i < 4000; ++i) {
    Scene s = oracle::randomScene(random, kTypes[random.below(7)], kTypes[random.below(7)]);
    const float k = random.below(2) ? 1e-12f : 1e12f;
    s.a.radius *= k, s.b.radius *= k;
    s.a.extent = s.a.extent * k, s.b.extent = s.b.extent * k;
    s.poseA.p = s.poseA.p * k, s.poseB.p = s.poseB.p * k;
    s.margin *= k;
    const Manifold m = s.collide();
    if (m.count == 0) continue;
    ASSERT_NEAR(length(m.normal), 1, 1e-5) << describe(s);
  }
}

TEST(Collide, nanEndsWithoutHarm) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (ShapeType a : kTypes) {
    for (ShapeType b : kTypes) {
      Random random(7);
      Manifold m;
      collide(random.shape(a), {{nan, 0, 0}, {}}, random.shape(b), {}, 0.1f, m);
      ASSERT_LE(m.count, kMaxManifoldPoints);
      collide(random.shape(a), {{}, {nan, nan, nan, nan}}, random.shape(b), {{0.1f, 0, 0}, {}}, 0.1f, m);
      ASSERT_LE(m.count, kMaxManifoldPoints);
    }
  }
}

}  // namespace
}  // namespace avbd
