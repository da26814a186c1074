// Bounds hold their shape, tightly.
#include "geom/aabb.h"

#include <avbd/hull.h>
#include <gtest/gtest.h>

#include <cfloat>
#include <random>
#include <vector>

namespace avbd {
namespace {

Quat randomRotation(std::mt19937& random) {
  std::normal_distribution<float> normal;
  const Quat q{normal(random), normal(random), normal(random), normal(random)};
  const float k = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * k, q.x * k, q.y * k, q.z * k};
}

void expectHolds(const Aabb& box, Vec3d p) {
  EXPECT_LE(box.lower.x, p.x);
  EXPECT_LE(box.lower.y, p.y);
  EXPECT_LE(box.lower.z, p.z);
  EXPECT_GE(box.upper.x, p.x);
  EXPECT_GE(box.upper.y, p.y);
  EXPECT_GE(box.upper.z, p.z);
}

TEST(Bounds, holdEveryCornerOfABox) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1000, 1000);
  for (int i = 0; i < 2000; ++i) {
    const Pose pose{{place(random), place(random), place(random)}, randomRotation(random)};
    const Vec3 h{0.1f, 0.7f, 2.3f};
    const Aabb box = bounds(toShapeGeom(Box{h.x, h.y, h.z}), pose, 0.01f);
    Vec3d lowest{1e9, 1e9, 1e9}, highest{-1e9, -1e9, -1e9};
    for (int k = 0; k < 8; ++k) {
      const Vec3d corner{k & 1 ? h.x : -h.x, k & 2 ? h.y : -h.y, k & 4 ? h.z : -h.z};
      const Vec3d p = pose.position + rotate(pose.rotation, corner);
      for (double s : {-1.0, 1.0}) expectHolds(box, p + Vec3d{1, 1, 1} * (s * 0.009999));
      lowest = {std::fmin(lowest.x, p.x), std::fmin(lowest.y, p.y), std::fmin(lowest.z, p.z)};
      highest = {std::fmax(highest.x, p.x), std::fmax(highest.y, p.y), std::fmax(highest.z, p.z)};
    }
    EXPECT_NEAR(box.lower.x, lowest.x - 0.01, 2e-4);
    EXPECT_NEAR(box.upper.z, highest.z + 0.01, 2e-4);
  }
}

TEST(Bounds, holdSphereAndCapsule) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-10, 10);
  for (int i = 0; i < 500; ++i) {
    const Pose pose{{place(random), place(random), place(random)}, randomRotation(random)};
    const Aabb sphere = bounds(toShapeGeom(Sphere{0.3f}), pose, 0);
    const Aabb capsule = bounds(toShapeGeom(Capsule{0.3f, 0.6f}), pose, 0);
    for (int k = 0; k < 50; ++k) {
      const Vec3d direction = rotate(randomRotation(random), Vec3d{0.2999999, 0, 0});
      expectHolds(sphere, pose.position + direction);
      for (double s : {-0.5999999, 0.5999999})
        expectHolds(capsule, pose.position + rotate(pose.rotation, Vec3d{0, s, 0}) + direction);
    }
  }
}

TEST(Bounds, roundOutwards) {
  const double x = 1 + 1e-12;  // between two floats
  const Aabb box = bounds(toShapeGeom(Sphere{0.5f}), {{x, -x, 1e8 + 0.25}, {}}, 0);
  expectHolds(box, {x + 0.5, -x - 0.5, 1e8 + 0.75});
  expectHolds(box, {x - 0.5, -x + 0.5, 1e8 - 0.25});
  EXPECT_EQ(box.upper.x, std::nextafterf(1.5f, 2.0f));
  EXPECT_EQ(box.lower.x, 0.5f);
  EXPECT_EQ(box.lower.y, std::nextafterf(-1.5f, -2.0f));
}

TEST(Bounds, exactWhereFloatHoldsThem) {
  const Aabb box = bounds(toShapeGeom(Sphere{0.5f}), {{1, 2, 3}, {}}, 0.25f);
  EXPECT_EQ(box.lower, (Vec3{0.25f, 1.25f, 2.25f}));
  EXPECT_EQ(box.upper, (Vec3{1.75f, 2.75f, 3.75f}));
}

TEST(Bounds, stayFiniteFarAway) {
  const Aabb box = bounds(toShapeGeom(Sphere{0.5f}), {{1e300, -1e300, 0}, {}}, 0);
  EXPECT_EQ(box.upper.x, FLT_MAX);
  EXPECT_EQ(box.lower.y, -FLT_MAX);
}

TEST(Bounds, halfSpaceAlongAnAxis) {
  const ShapeGeom plane = toShapeGeom(HalfSpace{});
  const Aabb up = bounds(plane, {{3, 2, 1}, {}}, 0.5f);
  EXPECT_EQ(up.upper, (Vec3{kFarAway, 2.5f, kFarAway}));
  EXPECT_EQ(up.lower, (Vec3{-kFarAway, -kFarAway, -kFarAway}));
  const float s = std::sqrt(0.5f);
  const Aabb z = bounds(plane, {{3, 2, 1}, {s, s, 0, 0}}, 0.5f);  // y turned to z
  EXPECT_EQ(z.upper, (Vec3{kFarAway, kFarAway, 1.5f}));
  const Aabb down = bounds(plane, {{3, 2, 1}, {0, 1, 0, 0}}, 0.5f);
  EXPECT_EQ(down.lower, (Vec3{-kFarAway, 1.5f, -kFarAway}));
  EXPECT_EQ(down.upper.y, kFarAway);
}

TEST(Bounds, slopedHalfSpaceIsEverywhere) {
  const Aabb box = bounds(toShapeGeom(HalfSpace{}), {{0, 0, 0}, {0.9f, 0.1f, 0, 0}}, 0);
  EXPECT_EQ(box.upper, (Vec3{kFarAway, kFarAway, kFarAway}));
  EXPECT_EQ(box.lower, (Vec3{-kFarAway, -kFarAway, -kFarAway}));
}

TEST(Bounds, scaleExactlyByPowersOfTwo) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-10, 10);
  for (int i = 0; i < 200; ++i) {
    const Quat q = randomRotation(random);
    const Vec3d p{place(random), place(random), place(random)};
    const Aabb a = bounds(toShapeGeom(Box{0.3f, 0.7f, 1.1f}), {p, q}, 0.01f);
    const Aabb b = bounds(toShapeGeom(Box{0.3f * 128, 0.7f * 128, 1.1f * 128}), {p * 128, q}, 0.01f * 128);
    EXPECT_EQ(a.lower * 128, b.lower);
    EXPECT_EQ(a.upper * 128, b.upper);
  }
}

/// Least and most of a shape along the world's axes, by its own formulas, beside its bounds.
void expectTight(const ShapeGeom& g, const Pose& pose, const std::vector<Vec3d>& points) {
  const Aabb box = bounds(g, pose, 0.125f);
  const float lower[3] = {box.lower.x, box.lower.y, box.lower.z}, upper[3] = {box.upper.x, box.upper.y, box.upper.z};
  double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
  for (const Vec3d& p : points) {
    const Vec3d w = pose.position + rotate(pose.rotation, p);
    const double c[3] = {w.x, w.y, w.z};
    for (int i = 0; i < 3; ++i) low[i] = std::fmin(low[i], c[i]), high[i] = std::fmax(high[i], c[i]);
  }
  const double grown = 0.125 + g.radius, rounding = 2e-6;
  for (int i = 0; i < 3; ++i) {
    EXPECT_LE(lower[i], low[i] - grown + rounding);
    EXPECT_GE(lower[i], low[i] - grown - 2e-3) << static_cast<int>(g.type);
    EXPECT_GE(upper[i], high[i] + grown - rounding);
    EXPECT_LE(upper[i], high[i] + grown + 2e-3) << static_cast<int>(g.type);
  }
}

TEST(Bounds, areTightAboutEveryConvexShape) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> place(-5, 5);
  std::vector<Vec3> cloud;
  for (int i = 0; i < 20; ++i) {
    cloud.push_back({static_cast<float>(place(random)) * 0.2f, static_cast<float>(place(random)) * 0.1f,
                     static_cast<float>(place(random)) * 0.02f + 3});
  }
  const Hull hull{makeHull({.points = cloud}), {1, 1, 1}, 0.05f};
  const Vec3 corners[3] = {{1, 2, 3}, {-1, 0.5f, 3}, {0, 0, -1}};
  ShapeGeom triangle{ShapeType::Triangle, 0.01f, {}};
  triangle.data = corners;
  std::vector<Vec3d> ofHull, ofTriangle, ofCylinder, ofCone{{0, 0.7, 0}}, ofEllipsoid;
  for (const Vec3& v : hull.data->vertices()) ofHull.push_back(toDouble(v));
  for (const Vec3& v : corners) ofTriangle.push_back(toDouble(v));
  for (int i = 0; i < 400; ++i) {
    const double t = i * 6.283185307179586 / 400, x = 0.4 * std::cos(t), z = 0.4 * std::sin(t);
    for (double y : {-0.7, 0.7}) ofCylinder.push_back({x, y, z});
    ofCone.push_back({x, -0.7, z});
    for (int k = 1; k < 200; ++k) {
      const double y = std::cos(k * 3.141592653589793 / 200), r = std::sqrt(1 - y * y);
      ofEllipsoid.push_back({0.3 * r * std::cos(t), 0.6 * y, 0.9 * r * std::sin(t)});
    }
  }
  for (int i = 0; i < 40; ++i) {
    const Pose pose{{place(random), place(random), place(random)}, randomRotation(random)};
    expectTight(toShapeGeom(hull), pose, ofHull);
    expectTight(triangle, pose, ofTriangle);
    expectTight(toShapeGeom(Cylinder{0.4f, 0.7f, 0.1f}), pose, ofCylinder);
    expectTight(toShapeGeom(Cone{0.4f, 0.7f, 0.1f}), pose, ofCone);
    expectTight(toShapeGeom(Ellipsoid{0.3f, 0.6f, 0.9f}), pose, ofEllipsoid);
  }
}

}  // namespace
}  // namespace avbd
