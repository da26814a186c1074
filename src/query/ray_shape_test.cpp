// Rays against single shapes: what is before the hit lies outside, what comes after lies inside, by an oracle of its
// own.
#include "query/ray_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "query/point_shape.h"

namespace avbd {
namespace {

/// > 0 outside, < 0 inside; zero on the surface. Written anew from each shape's definition.
double outsideness(const ShapeGeom& g, Vec3d p) {
  const double r = g.radius, ex = g.extent.x, ey = g.extent.y, ez = g.extent.z, flat = std::hypot(p.x, p.z);
  const auto over = [](double x, double most) { return std::max(std::fabs(x) - most, 0.0); };
  switch (g.type) {
    case ShapeType::Sphere:
      return length(p) - r;
    case ShapeType::Capsule:
      return std::hypot(flat, over(p.y, ey)) - r;
    case ShapeType::Box:
      return std::max({std::fabs(p.x) - ex, std::fabs(p.y) - ey, std::fabs(p.z) - ez});
    case ShapeType::RoundedBox:
      return std::hypot(over(p.x, ex), over(p.y, ey), over(p.z, ez)) - r;
    case ShapeType::Cylinder:
      return std::max(flat - ex, std::fabs(p.y) - ey);
    case ShapeType::Cone: {
      const double slant = std::hypot(2 * ey, ex);
      return std::max(-ey - p.y, (flat * 2 * ey + (p.y - ey) * ex) / slant);
    }
    case ShapeType::Ellipsoid:
      return std::hypot(p.x / ex, p.y / ey, p.z / ez) - 1;
    default:
      return p.y;
  }
}

class Random {
 public:
  explicit Random(uint32_t seed) : random_(seed) {}
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  float size() { return static_cast<float>(within(0.1, 1.5)); }
  Vec3d direction() {
    std::normal_distribution<double> n;
    // Often along an axis or in a plane of two.
    Vec3d d{n(random_), n(random_), n(random_)};
    if (random_() % 4 == 0) d.x = 0;
    if (random_() % 4 == 0) d.y = 0;
    if (random_() % 4 == 0) d.z = 0;
    return length(d) > 0 ? unitOf(d) : Vec3d{0, 1, 0};
  }
  Vec3d point(double reach) { return {within(-reach, reach), within(-reach, reach), within(-reach, reach)}; }

 private:
  std::mt19937 random_;
};

ShapeGeom randomGeom(ShapeType type, Random& random) {
  const Vec3 e{random.size(), random.size(), random.size()};
  switch (type) {
    case ShapeType::Sphere:
      return {type, e.x, {}};
    case ShapeType::Capsule:
      return {type, e.x, {0, e.y, 0}};
    case ShapeType::RoundedBox:
      return {type, 0.3f * random.size(), e};
    case ShapeType::Cylinder:
    case ShapeType::Cone:
      return {type, 0, {e.x, e.y, e.x}};
    default:
      return {type, 0, e};
  }
}

class RayShape : public testing::TestWithParam<ShapeType> {};

TEST_P(RayShape, meetsTheFirstPointInside) {
  Random random(3 + static_cast<uint32_t>(GetParam()));
  int hits = 0, insideStarts = 0;
  for (int round = 0; round < 6000; ++round) {
    const ShapeGeom geom = randomGeom(GetParam(), random);
    // From near, from inside, and from a thousand kilometres away.
    const double far = round % 3 == 0 ? 1e6 : round % 3 == 1 ? 4 : 0.5;
    const Vec3d d = random.direction(), aim = random.point(1.2);
    const LocalRay ray{aim - d * far, d, round % 5 == 0 ? far : 2 * far};
    const LocalHit hit = rayShape(geom, ray);
    const double startsAt = outsideness(geom, ray.from), tolerance = far > 1e5 ? 1e-8 : 1e-12;
    if (startsAt < -tolerance) {
      ++insideStarts;
      ASSERT_EQ(hit.distance, 0);
      ASSERT_EQ(length(hit.normal + d), 0);
      continue;
    }
    // The nearest to inside that the ray gets within its length: convex shapes, so that a ternary search finds it.
    double low = 0, high = ray.length;
    for (int i = 0; i < 120; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (outsideness(geom, ray.from + d * a) < outsideness(geom, ray.from + d * b) ? high : low) =
          outsideness(geom, ray.from + d * a) < outsideness(geom, ray.from + d * b) ? b : a;
    }
    const double deepest = outsideness(geom, ray.from + d * low);
    if (!hit) {
      ASSERT_GT(deepest, -tolerance * 10) << round;
      continue;
    }
    ++hits;
    ASSERT_LE(hit.distance, ray.length);
    ASSERT_LT(std::fabs(outsideness(geom, ray.from + d * hit.distance)), 10 * tolerance) << round;
    if (hit.distance > 0) {
      ASSERT_NEAR(length(hit.normal), 1, 1e-12);
      ASSERT_LE(dot(hit.normal, d), 1e-9);
      // Nothing of the shape lies between.
      ASSERT_GT(outsideness(geom, ray.from + d * (hit.distance * 0.5)), -tolerance) << round;
      ASSERT_GT(outsideness(geom, ray.from + d * (hit.distance - 1e-4)), -tolerance) << round;
      // The normal leads out.
      ASSERT_GT(outsideness(geom, ray.from + d * hit.distance + hit.normal * 1e-5), -tolerance) << round;
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(insideStarts, 150);
}

TEST_P(RayShape, pointsInsideAsTheOracleHasThem) {
  Random random(30 + static_cast<uint32_t>(GetParam()));
  for (int round = 0; round < 6000; ++round) {
    const ShapeGeom geom = randomGeom(GetParam(), random);
    const Vec3d p = random.point(2);
    const double out = outsideness(geom, p);
    if (std::fabs(out) < 1e-12) continue;
    ASSERT_EQ(containsPoint(geom, p), out < 0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, RayShape,
                         testing::Values(ShapeType::Sphere, ShapeType::Capsule, ShapeType::Box, ShapeType::RoundedBox,
                                         ShapeType::Cylinder, ShapeType::Cone, ShapeType::Ellipsoid,
                                         ShapeType::HalfSpace));

TEST(RayShape, roundedConeAndCylinderHoldWhatIsNearTheirCores) {
  Random random(5);
  for (const ShapeType type : {ShapeType::Cylinder, ShapeType::Cone}) {
    for (int round = 0; round < 4000; ++round) {
      ShapeGeom geom = randomGeom(type, random);
      geom.radius = 0.2f * random.size();
      // A point at a known distance out of the core's surface, found by a ray from outside.
      const Vec3d d = random.direction();
      ShapeGeom core = geom;
      core.radius = 0;
      const LocalRay ray{d * -5.0, d, 10};
      const LocalHit hit = rayShape(core, ray);
      if (!hit) continue;
      const Vec3d surface = ray.from + d * hit.distance;
      ASSERT_TRUE(containsPoint(geom, surface + hit.normal * (geom.radius * 0.999)));
      ASSERT_FALSE(containsPoint(geom, surface + hit.normal * (geom.radius * 1.001)));
    }
  }
}

TEST(RayShape, slidingAlongAFaceTouches) {
  const ShapeGeom box{ShapeType::Box, 0, {1, 1, 1}};
  EXPECT_EQ(rayShape(box, {{-3, 1, 0}, {1, 0, 0}, 10}).distance, 2);
  EXPECT_FALSE(rayShape(box, {{-3, 1.0000001, 0}, {1, 0, 0}, 10}));
  EXPECT_FALSE(rayShape(box, {{-3, 0, 0}, {1, 0, 0}, 1.999}));
  EXPECT_FALSE(rayShape(box, {{-3, 0, 0}, {-1, 0, 0}, 10}));
}

TEST(RayTriangle, facesAndEdges) {
  const Vec3 v[3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};  // looks up
  const LocalHit hit = rayTriangle(v, {{0.25, 2, 0.25}, {0, -1, 0}, 5}, false);
  EXPECT_EQ(hit.distance, 2);
  EXPECT_EQ(hit.normal.y, 1);
  EXPECT_FALSE(rayTriangle(v, {{0.25, -2, 0.25}, {0, 1, 0}, 5}, false));
  const LocalHit back = rayTriangle(v, {{0.25, -2, 0.25}, {0, 1, 0}, 5}, true);
  EXPECT_EQ(back.distance, 2);
  EXPECT_EQ(back.normal.y, -1);
  EXPECT_FALSE(rayTriangle(v, {{0.6, 2, 0.6}, {0, -1, 0}, 5}, true));
  EXPECT_FALSE(rayTriangle(v, {{0.25, 2, 0.25}, {0, -1, 0}, 1.9}, true));
}

TEST(RayTriangle, noCrackBetweenNeighbours) {
  Random random(9);
  int onlyOne = 0;
  for (int round = 0; round < 6000; ++round) {
    const auto corner = [&](double x, double z) {
      return toFloat(Vec3d{x + random.within(-0.2, 0.2), random.within(-0.2, 0.2), z + random.within(-0.2, 0.2)});
    };
    const Vec3 a = corner(0, 0), b = corner(0, 1), c = corner(1, 1), e = corner(1, 0);
    const Vec3 first[3] = {a, b, c}, second[3] = {a, c, e};
    // At a point of the edge that both share, from far away.
    const double s = random.within(0.05, 0.95);
    const Vec3d target = toDouble(a) * (1 - s) + toDouble(c) * s;
    const Vec3d from = target + Vec3d{random.within(-300, 300), 1000, random.within(-300, 300)};
    const LocalRay ray{from, unitOf(target - from), 5000};
    const bool hitFirst = bool(rayTriangle(first, ray, false)), hitSecond = bool(rayTriangle(second, ray, false));
    ASSERT_TRUE(hitFirst || hitSecond) << round;
    onlyOne += hitFirst != hitSecond;
  }
  EXPECT_GT(onlyOne, 3000);
}

}  // namespace
}  // namespace avbd
