// Kept manifolds: carried points agree with points found anew, and nothing near is missed.
#include "collide/kept_manifold.h"

#include <avbd/hull.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "collide/collide.h"

namespace avbd {
namespace {

using What = KeptManifold::What;

constexpr float kMargin = 0.005f;
constexpr KeepLimits kLimits{kMargin, 0.0025f, 0.00125f};
const Box kCube{0.5f, 0.5f, 0.5f};

Quat turned(float angle, Vec3 axis) {
  const float s = std::sin(angle / 2) / length(axis);
  return {std::cos(angle / 2), axis.x * s, axis.y * s, axis.z * s};
}

float radiusOf(const Geometry& g) {
  if (std::holds_alternative<HalfSpace>(g)) return std::numeric_limits<float>::infinity();
  if (const Box* box = std::get_if<Box>(&g)) return length(Vec3{box->x, box->y, box->z});
  return 0.9f;
}

/// Two shapes, the first at the origin as a pair of the world has it.
struct Two {
  Geometry a, b;
  Quat turnA;
  NearPose poseB;

  Manifold find() const {
    Manifold m;
    collide(toShapeGeom(a), {{}, turnA}, toShapeGeom(b), poseB, kMargin, m);
    return m;
  }
  KeptManifold keepFound() const {
    KeptManifold kept;
    keep(find(), {{{}, turnA}, radiusOf(a)}, {poseB, radiusOf(b)}, kept);
    return kept;
  }
  /// B moved against A, then both turned together.
  Two moved(Vec3 by, Quat turn, Quat together) const {
    const NearPose b1{poseB.p + by, turn * poseB.q};
    return {a, b, together * turnA, {rotate(together, b1.p), together * b1.q}};
  }
  Carry carryTo(const KeptManifold& kept, CarriedPoints& out) const {
    return carry(kept, {{}, turnA}, poseB, kLimits, out);
  }
};

/// Every point found anew is within a length of a carried one, with its height over the face.
void expectSame(const Manifold& fresh, const CarriedPoints& now, int count, float sideways, float height) {
  ASSERT_EQ(fresh.count, count);
  EXPECT_NEAR(length(fresh.normal - now.normal), 0, 1e-6f);
  for (int i = 0; i < count; ++i) {
    float least = std::numeric_limits<float>::infinity(), gap = 0;
    for (int k = 0; k < count; ++k) {
      const Vec3 p{now.position.x[k], now.position.y[k], now.position.z[k]};
      const float d = length(p - fresh.points[i].position);
      if (d < least) least = d, gap = now.separation[k] - fresh.points[i].separation;
    }
    EXPECT_LT(least, sideways);
    EXPECT_NEAR(gap, 0, height);
  }
}

TEST(KeptManifold, carriesPointsWithTheirExactHeights) {
  const Two pairs[] = {
      {kCube, kCube, {}, {{0.1f, 0.999f, 0.05f}, {}}},   // the lower one's face
      {kCube, kCube, {}, {{0.1f, -0.999f, 0.05f}, {}}},  // A lies above
      {Box{100, 0.5f, 100}, kCube, {}, {{30, 0.998f, 20}, {}}},
      {kCube, Box{100, 0.5f, 100}, {}, {{30, -0.998f, 20}, {}}},
      {kCube, HalfSpace{}, {}, {{0, -0.499f, 0}, {}}},
      {HalfSpace{}, kCube, {}, {{0, 0.499f, 0}, {}}},
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (const Two& two : pairs) {
    SCOPED_TRACE(&two - pairs);
    const KeptManifold kept = two.keepFound();
    ASSERT_TRUE(kept.what == What::PointsOnA || kept.what == What::PointsOnB);
    for (int i = 0; i < 50; ++i) {
      const Vec3 axis{unit(random), unit(random), unit(random)};
      const bool turns = radiusOf(two.b) < 2;  // a far pivot moves what is here
      const Two later = two.moved(Vec3{unit(random), unit(random), unit(random)} * 2e-4f,
                                  turned(turns ? 4e-4f * unit(random) : 0, axis), turned(unit(random), axis));
      CarriedPoints now;
      ASSERT_EQ(later.carryTo(kept, now), Carry::Points);
      expectSame(later.find(), now, 4, 1.5e-3f, 3e-6f);
    }
  }
}

TEST(KeptManifold, placesInBothBodiesAreThePosition) {
  const Two two{kCube, kCube, turned(0.2f, {1, 2, 0}), {}};
  Two upper = two;
  upper.poseB = {rotate(two.turnA, Vec3{0.1f, 0.999f, 0.2f}), two.turnA};
  const KeptManifold kept = upper.keepFound();
  const Two later = upper.moved({2e-4f, 1e-4f, 0}, turned(3e-4f, {1, 0, 2}), turned(1, {1, 1, 0}));
  CarriedPoints now;
  ASSERT_EQ(later.carryTo(kept, now), Carry::Points);
  const auto [onA, onB] = placesOnBodies(now);
  for (int k = 0; k < 4; ++k) {
    const Vec3 p{now.position.x[k], now.position.y[k], now.position.z[k]};
    EXPECT_NEAR(length(rotate(later.turnA, Vec3{onA.x[k], onA.y[k], onA.z[k]}) - p), 0, 1e-6f);
    EXPECT_NEAR(length(later.poseB * Vec3{onB.x[k], onB.y[k], onB.z[k]} - p), 0, 1e-6f);
  }
}

TEST(KeptManifold, findsAnewWhatMovedOrCloses) {
  const Two two{kCube, kCube, {}, {{0, 0.999f, 0}, {}}};
  const KeptManifold kept = two.keepFound();
  CarriedPoints now;
  EXPECT_EQ(two.moved({0.001f, 0, 0}, {}, {}).carryTo(kept, now), Carry::Points);
  EXPECT_EQ(two.moved({0.002f, 0, 0}, {}, {}).carryTo(kept, now), Carry::Anew);
  EXPECT_EQ(two.moved({}, turned(0.002f, {0, 1, 0}), {}).carryTo(kept, now), Carry::Anew);
  // Looked for farther than when it was found: what was left out may be near enough by now.
  EXPECT_EQ(carry(kept, {{}, two.turnA}, two.poseB, {0.007f, 0.0025f, 0.00125f}, now), Carry::Points);
  EXPECT_EQ(carry(kept, {{}, two.turnA}, two.poseB, {0.008f, 0.0025f, 0.00125f}, now), Carry::Anew);
}

TEST(KeptManifold, keepsNoEdgesAndNothingRound) {
  const Geometry round[] = {Sphere{0.5f}, Capsule{0.3f, 0.5f}, Cylinder{0.5f, 0.5f}, Box{0.4f, 0.4f, 0.4f, 0.1f}};
  for (const Geometry& shape : round) {
    const Two two{kCube, shape, {}, {{0, 0.999f, 0}, {}}};
    EXPECT_EQ(two.keepFound().what, What::Nothing);
  }
  const Two crossed{kCube, kCube, turned(0.785f, {1, 0, 0}), {{0, 1.4f, 0}, turned(0.785f, {0, 0, 1})}};
  ASSERT_EQ(crossed.find().count, 1);
  EXPECT_EQ(crossed.keepFound().what, What::Nothing);
}

TEST(KeptManifold, whileApartNothingIsNear) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back({k & 1 ? 0.5f : -0.5f, k & 2 ? 0.4f : -0.4f, k & 4 ? 0.3f : -0.3f});
  const Hull hull{makeHull({.points = corners})};
  const Geometry shapes[] = {kCube, Box{3, 0.2f, 0.4f}, hull, HalfSpace{}};
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto direction = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  int apart = 0, anew = 0;
  for (int i = 0; i < 4000; ++i) {
    Two two{shapes[i % 3], shapes[i / 3 % 4], turned(unit(random), direction()), {}};
    const Vec3 way = direction();
    two.poseB = {way * ((0.7f + 0.5f * unit(random)) / length(way)), turned(unit(random), direction())};
    const KeptManifold kept = two.keepFound();
    if (kept.what != What::Apart) continue;
    const float size = 0.05f * (1 + unit(random));
    const Two later = two.moved(direction() * size, turned(size * unit(random), direction()), {});
    CarriedPoints now;
    const Carry how = later.carryTo(kept, now);
    ASSERT_NE(how, Carry::Points);
    (how == Carry::Apart ? apart : anew) += 1;
    if (how == Carry::Apart) EXPECT_EQ(later.find().count, 0);
  }
  EXPECT_GT(apart, 100);
  EXPECT_GT(anew, 100);
}

}  // namespace
}  // namespace avbd
