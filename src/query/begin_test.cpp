// Where casts and rays begin to touch: normals where a surface lies in its bounds, positions of what starts inside.
#include <gtest/gtest.h>

#include "query/query_world.h"

namespace avbd {
namespace {

World standing(const Geometry& geometry, const Pose& pose) {
  World world;
  world.create(
      BodyDef{.type = BodyType::Static, .position = pose.position, .rotation = pose.rotation, .shape = geometry});
  return world;
}

constexpr Vec3 kUp{0, 1, 0};

/// Upright shapes: their tops lie in the top of their bounds, and rounding to floats makes the two overlap in places.
TEST(QueryBegin, obliqueRaysAtFlatTops) {
  QueryRandom random(1);
  for (int round = 0; round < 3000; ++round) {
    const float radius = random.size(0.1, 3), half = random.size(0.05, 30), rounding = random.size(0.01, 0.5);
    const Vec3d at = round % 3 ? random.point(100) : Vec3d{};
    const World can = standing(Cylinder{radius, half, rounding}, {at, {}});
    const double top = at.y + double(half) + double(rounding);
    const Vec3d aim{at.x + 0.5 * double(radius), top, at.z};
    const Vec3 d{random.size(0.1, 3), -1, random.size(-1, 1)};
    const double back = random.within(0.5, 20);
    const CastHit hit = can.rayClosest({aim - toDouble(d) * back, d, 100});
    ASSERT_TRUE(hit) << round;
    EXPECT_LT(length(hit.normal - kUp), 1e-5f) << round;
    EXPECT_LT(length(hit.position - aim), 1e-4) << round;
  }
}

TEST(QueryBegin, obliqueCastsAtFlatTops) {
  QueryRandom random(2);
  const Geometry movers[] = {Box{0.3f, 0.4f, 0.2f}, Cylinder{0.3f, 0.4f}, Cylinder{0.3f, 0.4f, 0.1f},
                             Box{0.3f, 0.4f, 0.2f, 0.05f}, Capsule{0.3f, 0.4f}};
  const double bottoms[] = {0.4, 0.4, 0.5, 0.45, 0.7};
  for (int round = 0; round < 3000; ++round) {
    const float half = round % 2 ? 20 : random.size(0.05, 40);
    const Geometry grounds[] = {Box{5, half, 5}, Cylinder{5, half}, Cylinder{5, half, 0.125f}};
    const int kind = round % 3, mover = round % 5;
    const Vec3d at = round % 4 ? random.point(100) : Vec3d{};
    const World ground = standing(grounds[kind], {at, {}});
    const Vec3d aim = at + Vec3d{0.5, double(half) + (kind == 2 ? 0.125 : 0) + bottoms[mover], 0};
    const Vec3 d{random.size(0.1, 3), -1, random.size(-1, 1)};
    const double back = random.within(0.5, 20);
    const CastHit hit = ground.castClosest(movers[mover], {aim - toDouble(d) * back, {}}, d * 30.0f);
    ASSERT_TRUE(hit) << round;
    EXPECT_LT(length(hit.normal - kUp), 1e-5f) << round << " " << kind << " " << mover;
    EXPECT_NEAR(hit.distance, back * length(toDouble(d)), 1e-4) << round;
    EXPECT_NEAR(hit.position.y, at.y + double(half) + (kind == 2 ? 0.125 : 0), 1e-4) << round;
  }
}

TEST(QueryBegin, obliqueCastsAtALevelMesh) {
  const Vec3 v[4] = {{-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}};
  const std::array<uint32_t, 3> t[2] = {{0, 1, 2}, {0, 2, 3}};
  const auto data = makeMesh({.vertices = v, .triangles = t});
  QueryRandom random(3);
  for (int round = 0; round < 1000; ++round) {
    const Vec3d at = random.point(100);
    const World world = standing(Mesh{data}, {at, {}});
    const Vec3 d{random.size(0.1, 3), -1, random.size(-1, 1)};
    const float half = random.size(0.1, 1);
    const Vec3d aim = at + Vec3d{0.3, double(half), 0.2};
    const CastHit hit = world.castClosest(Box{0.3f, half, 0.2f}, {aim - toDouble(d) * 5.0, {}}, d * 30.0f);
    ASSERT_TRUE(hit) << round;
    EXPECT_LT(length(hit.normal - kUp), 1e-5f) << round;
    EXPECT_NEAR(hit.position.y, at.y, 1e-4);
  }
}

/// Along faces that touch, with no more between them than rounding: whatever is said is a unit normal against the way.
TEST(QueryBegin, slidingOverFlushBoxes) {
  World world;
  for (int i = 0; i < 10; ++i)
    world.create(BodyDef{.type = BodyType::Static, .position = {0.2 * i, -0.3, 0}, .shape = Box{0.1f, 0.3f, 1}});
  for (int i = 0; i < 200; ++i) {
    const float half = 0.1f + 0.001f * float(i);
    for (const CastHit& hit : world.castAll(Box{half, half, half}, {{-3, double(half), 0}, {}}, {6, 0, 0})) {
      EXPECT_NEAR(length(hit.normal), 1, 1e-6);
      EXPECT_LE(hit.normal.x, 1e-6f);
    }
  }
}

/// Close to the surface of the only shape, a convex one: towards its inside, and away in some direction, lies the other
/// side.
bool isOnSurface(const World& world, Vec3d point, Vec3d inside, QueryRandom& random) {
  constexpr double kClose = 3e-5;
  const Vec3d in = inside - point;
  if (world.containing(point + in * (kClose / length(in))).empty()) return false;
  for (int i = 0; i < 100; ++i)
    if (world.containing(point + toDouble(random.direction()) * kClose).empty()) return true;
  return false;
}

/// A ray that starts inside tells its origin; a shape that does tells a point on the surface.
TEST(QueryBegin, positionsOfWhatStartsInside) {
  QueryRandom random(4);
  int rays = 0, casts = 0;
  for (int round = 0; round < 3000; ++round) {
    const int type = round % (kConvexTypes + 1);
    const Geometry g = type == kConvexTypes ? Geometry{HalfSpace{}} : convexGeometry(random, type);
    const Pose pose{round % 2 ? Vec3d{1000, -20, 300} : Vec3d{}, random.rotation()};
    const World world = standing(g, pose);
    const Vec3d from = pose.position + random.point(0.5);
    const Vec3 d = random.direction();
    const CastHit ray = world.rayClosest({from, d, 5});
    if (ray && ray.distance == 0) {
      ++rays;
      EXPECT_EQ(ray.position, from) << g.index();
      EXPECT_LT(length(ray.normal + d), 1e-5f);
      EXPECT_EQ(world.containing(from).size(), 1u);
    }
    const Geometry placed = convexGeometry(random, random.below(kConvexTypes));
    const CastHit cast = world.castClosest(placed, {from, random.rotation()}, d * 3.0f);
    if (!cast || cast.distance > 0) continue;
    ++casts;
    EXPECT_LT(length(cast.normal + d), 1e-5f);
    Vec3 inner{};
    if (const Hull* hull = std::get_if<Hull>(&g)) {
      const Vec3 c = hull->data->center(), k = hull->scale;
      inner = {c.x * k.x, c.y * k.y, c.z * k.z};
    }
    const Vec3d inside = std::holds_alternative<HalfSpace>(g) ? cast.position - rotate(pose.rotation, kUp)
                                                              : pose.position + rotate(pose.rotation, inner);
    EXPECT_TRUE(isOnSurface(world, cast.position, inside, random)) << g.index() << " " << placed.index();
  }
  EXPECT_GT(rays, 600);
  EXPECT_GT(casts, 1500);
}

}  // namespace
}  // namespace avbd
