// When two moving shapes meet: by hand, and against the distance along the way.
#include "collide/time_of_impact.h"

#include <avbd/mesh.h>
#include <gtest/gtest.h>

#include "collide/collide_convex_oracle.h"

namespace avbd {
namespace {

constexpr ShapeType kTypes[] = {ShapeType::Sphere, ShapeType::Capsule,   ShapeType::Box,        ShapeType::Cylinder,
                                ShapeType::Cone,   ShapeType::Ellipsoid, ShapeType::RoundedBox, ShapeType::Hull};
constexpr float kTolerance = 1e-4f;

float distanceAt(const ShapeGeom& a, const ShapeMotion& ma, const ShapeGeom& b, const ShapeMotion& mb, float time) {
  return nearest(a, at(ma, time), b, at(mb, time), 1e9f).distance;
}

/// Two shapes that fly towards each other and tumble, about their own middles and about points beside them.
struct Flight {
  ShapeGeom a, b;
  ShapeMotion ma, mb;
};
ShapeMotion tumble(oracle::Random& random, Vec3 place, Vec3 shift) {
  ShapeMotion motion;
  motion.start = {place, random.rotation()};
  motion.center = place + Vec3{random.within(-0.4f, 0.4f), random.within(-0.4f, 0.4f), random.within(-0.4f, 0.4f)};
  motion.shift = shift;
  motion.turn = rotate(random.rotation(), Vec3{random.within(0, 2), 0, 0});
  return motion;
}
Flight flight(oracle::Random& random, ShapeType ta, ShapeType tb) {
  Flight f{random.shape(ta), random.shape(tb), {}, {}};
  const Vec3 place = rotate(random.rotation(), Vec3{random.within(3, 6), 0, 0});
  const Vec3 side{random.within(-1, 1), random.within(-1, 1), random.within(-1, 1)};
  f.ma = tumble(random, {}, place * random.within(0.3f, 1) + side);
  f.mb = tumble(random, place, place * random.within(-0.7f, 0.3f));
  return f;
}

TEST(TimeOfImpact, IsTheFirstTimeAtThatDistance) {
  oracle::Random random(5);
  int hits = 0, misses = 0;
  for (const ShapeType ta : kTypes)
    for (const ShapeType tb : kTypes)
      for (int i = 0; i < 6; ++i) {
        const Flight f = flight(random, ta, tb);
        const float target = i % 3 == 0 ? 0 : i % 3 == 1 ? -0.05f : 0.1f;
        const Impact impact = timeOfImpact(f.a, f.ma, f.b, f.mb, {target, kTolerance});
        const float last = impact.happens ? impact.time : 1;
        const float start = distanceAt(f.a, f.ma, f.b, f.mb, 0);
        if (start <= target) continue;
        for (int k = 0; k < 60; ++k) {
          const float time = last * static_cast<float>(k) / 60;
          ASSERT_GT(distanceAt(f.a, f.ma, f.b, f.mb, time), target - 3e-4f) << int(ta) << " " << int(tb) << " " << time;
        }
        ++(impact.happens ? hits : misses);
        if (!impact.happens) continue;
        ASSERT_NEAR(distanceAt(f.a, f.ma, f.b, f.mb, last), target, 6e-4f) << int(ta) << " " << int(tb);
        ASSERT_NEAR(length(impact.normal), 1, 1e-5f);
      }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 20);
}

TEST(TimeOfImpact, DoesNotDependOnTheOrderOrThePlace) {
  oracle::Random random(6);
  for (const ShapeType ta : kTypes)
    for (const ShapeType tb : kTypes) {
      const Flight f = flight(random, ta, tb);
      const Impact there = timeOfImpact(f.a, f.ma, f.b, f.mb, {0, kTolerance});
      const Impact back = timeOfImpact(f.b, f.mb, f.a, f.ma, {0, kTolerance});
      ShapeMotion ma = f.ma, mb = f.mb;
      for (ShapeMotion* motion : {&ma, &mb}) {
        motion->start.p = motion->start.p + Vec3{4, -2, 8};
        motion->center = motion->center + Vec3{4, -2, 8};
      }
      const Impact moved = timeOfImpact(f.a, ma, f.b, mb, {0, kTolerance});
      if (!there.happens) continue;
      for (const Impact& other : {back, moved}) {
        ASSERT_TRUE(other.happens);
        ASSERT_NEAR(distanceAt(f.a, f.ma, f.b, f.mb, other.time), distanceAt(f.a, f.ma, f.b, f.mb, there.time), 3e-4f);
      }
    }
}

TEST(TimeOfImpact, ByHand) {
  const ShapeGeom ball = toShapeGeom(Sphere{0.5f}), wall = toShapeGeom(Box{0.01f, 2, 2});
  const ShapeMotion flies{{{-5, 0, 0}, {}}, {-5, 0, 0}, {10, 0, 0}, {0, 1, 0}}, stands{};
  const Impact hit = timeOfImpact(ball, flies, wall, stands, {0, kTolerance});
  ASSERT_TRUE(hit.happens);
  EXPECT_NEAR(hit.time, 0.449f, 2e-5f);
  EXPECT_NEAR(hit.before, 4.49f, 1e-5f);
  EXPECT_LT(length(hit.normal - Vec3{1, 0, 0}), 1e-6f);
  EXPECT_FALSE(timeOfImpact(ball, flies, wall, stands, {0, kTolerance, 0, 0.44f}).happens);
  EXPECT_NEAR(timeOfImpact(ball, flies, wall, stands, {-0.25f, kTolerance}).time, 0.474f, 2e-5f);
  // A rod of no thickness but its rounding turns a right angle about its end: meets a ball beside it.
  const ShapeGeom rod = toShapeGeom(Capsule{0.01f, 1}), post = toShapeGeom(Sphere{0.01f});
  const ShapeMotion turns{{{1, 0, 0}, {0.70710678f, 0, 0, 0.70710678f}}, {0, 0, 0}, {}, {0, 0, 1.5f}};
  const ShapeMotion at45{{{0.7f, 0.7f, 0}, {}}, {0.7f, 0.7f, 0}, {}, {}};
  const Impact met = timeOfImpact(rod, turns, post, at45, {0, kTolerance});
  ASSERT_TRUE(met.happens);
  const float angle = 0.78539816f - std::asin(0.02f / (0.7f * std::sqrt(2.0f)));
  EXPECT_NEAR(met.time * 1.5f, angle, 2e-4f);
}

TEST(TimeOfImpact, AHalfSpaceIsMetByTheLowestPoint) {
  const ShapeGeom box = toShapeGeom(Box{1, 1, 1}), ground = toShapeGeom(HalfSpace{});
  const ShapeMotion falls{{{0, 3, 0}, {}}, {0, 3, 0}, {0, -4, 0}, {}}, stands{};
  EXPECT_NEAR(timeOfImpact(box, falls, ground, stands, {0, kTolerance}).time, 0.5f, 3e-5f);
  ShapeMotion tips = falls;
  tips.turn = {0, 0, 1.5707963f};
  const Impact earlier = timeOfImpact(box, tips, ground, stands, {0, kTolerance});
  ASSERT_TRUE(earlier.happens);
  const float t = earlier.time, low = std::cos(1.5707963f * t) + std::sin(1.5707963f * t);
  EXPECT_NEAR(3 - 4 * t, low, 1e-3f);
}

TEST(TimeOfImpact, WhatSlidesOnAFloorNeverComesDeeper) {
  const ShapeGeom box = toShapeGeom(Box{0.5f, 0.5f, 0.5f}), floor = toShapeGeom(Box{100, 1, 100});
  const ShapeMotion slides{{{0, 1.499f, 0}, {}}, {0, 1.499f, 0}, {30, 0, 5}, {}}, stands{};
  EXPECT_TRUE(timeOfImpact(box, slides, floor, stands, {0, kTolerance}).happens);
  EXPECT_FALSE(timeOfImpact(box, slides, floor, stands, {-0.01f, kTolerance}).happens);
  // A wheel that turns half round where it stands.
  const ShapeGeom wheel = toShapeGeom(Cylinder{0.5f, 0.1f});
  const ShapeMotion spins{{{0, 1.499f, 0}, {0.70710678f, 0.70710678f, 0, 0}}, {0, 1.499f, 0}, {2, 0, 0}, {0, 0, -3}};
  EXPECT_FALSE(timeOfImpact(wheel, spins, floor, stands, {-0.05f, kTolerance}).happens);
}

// A box of triangles is met as the box is, from outside; from inside its triangles let pass.
TEST(TimeOfImpact, TrianglesAreMetFromTheFront) {
  std::vector<Vec3> v;
  for (int k = 0; k < 8; ++k) v.push_back({k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f, k & 4 ? 1.0f : -1.0f});
  const std::vector<std::array<uint32_t, 3>> t{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Mesh mesh{makeMesh({.vertices = v, .triangles = t})};
  const ShapeGeom surface = toShapeGeom(mesh), solid = toShapeGeom(Box{1, 1, 1});
  oracle::Random random(7);
  const auto firstOn = [&](const ShapeGeom& a, const ShapeMotion& ma, const ShapeMotion& mb) {
    float first = 2;
    forEachTriangleMet(a, ma, surface, mb, {0, kTolerance}, [&](const MovingTriangle& triangle, float to) {
      const ShapeGeom geom = triangle.geom();
      const Impact impact = timeOfImpact(a, ma, geom, triangle.motion, {0, kTolerance, 0, to});
      if (impact.happens && isInFront(a, ma, triangle, impact.time)) first = std::min(first, impact.time);
      return std::min(to, first);
    });
    return first;
  };
  int hits = 0;
  for (int i = 0; i < 120; ++i) {
    Flight f = flight(random, kTypes[i % 8], ShapeType::Box);
    f.b = solid;
    if (i % 2) f.mb.turn = {};
    f.mb.center = f.mb.start.p;
    if (distanceAt(f.a, f.ma, f.b, f.mb, 0) <= 0.01f) continue;
    const Impact whole = timeOfImpact(f.a, f.ma, f.b, f.mb, {0, kTolerance});
    const float first = firstOn(f.a, f.ma, f.mb);
    ASSERT_EQ(first <= 1, whole.happens);
    if (!whole.happens) continue;
    ++hits;
    ASSERT_NEAR(distanceAt(f.a, f.ma, f.b, f.mb, first), 0, 6e-4f);
    ASSERT_NEAR(first, whole.time, 2e-3f);
  }
  EXPECT_GT(hits, 30);
  const ShapeGeom ball = toShapeGeom(Sphere{0.1f});
  EXPECT_EQ(firstOn(ball, {{}, {}, {5, 0, 0}, {}}, {}), 2);
}

}  // namespace
}  // namespace avbd
