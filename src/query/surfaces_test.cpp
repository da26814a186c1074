// Meshes and height fields in queries: fronts and backs, nearest triangles against a loop over all, ground to stand in.
#include <gtest/gtest.h>

#include "query/query_world.h"

namespace avbd {
namespace {

/// One square that looks up.
World squareWorld(bool doubleSided) {
  const Vec3 v[4] = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
  const std::array<uint32_t, 3> t[2] = {{0, 1, 2}, {0, 2, 3}};
  World world;
  world.create(BodyDef{.type = BodyType::Static,
                       .shape = Mesh{makeMesh({.vertices = v, .triangles = t, .doubleSided = doubleSided})}});
  return world;
}

TEST(QuerySurfaces, frontsAndBacks) {
  const World one = squareWorld(false), both = squareWorld(true);
  const Ray up{{0.3, -2, 0.2}, {0, 1, 0}, 5}, down{{0.3, 2, 0.2}, {0, -1, 0}, 5};
  EXPECT_EQ(one.rayClosest(down).distance, 2);
  EXPECT_EQ(one.rayClosest(down).normal, (Vec3{0, 1, 0}));
  EXPECT_FALSE(one.rayClosest(up));
  EXPECT_EQ(one.rayClosest(up, {.backFaces = true}).normal, (Vec3{0, -1, 0}));
  EXPECT_EQ(both.rayClosest(up).distance, 2);
  const Pose from{{0.3, -2, 0.2}, {}};
  EXPECT_FALSE(one.castClosest(Sphere{0.5f}, from, {0, 5, 0}));
  EXPECT_NEAR(one.castClosest(Sphere{0.5f}, from, {0, 5, 0}, {.backFaces = true}).distance, 1.5, 1e-5);
  EXPECT_NEAR(both.castClosest(Sphere{0.5f}, from, {0, 5, 0}).distance, 1.5, 1e-5);
  EXPECT_NEAR(one.castClosest(Box{0.5f, 0.5f, 0.5f}, {{0, 3, 0}, {}}, {0, -9, 0}).distance, 2.5, 1e-5);
  EXPECT_TRUE(one.overlapsAny(Sphere{0.5f}, {{0, -0.4, 0}, {}}));
  EXPECT_FALSE(one.overlapsAny(Sphere{0.5f}, {{0, -0.6, 0}, {}}));
  EXPECT_TRUE(one.containing({0, 0, 0}).empty());
}

TEST(QuerySurfaces, nearestAndFirstTriangleOfALoopOverAll) {
  QueryRandom random(21);
  const auto data = bumpyMesh(14, 0.8f, random);
  const Vec3 scale{1.5f, 2, -1};
  World mesh;
  mesh.create(BodyDef{.type = BodyType::Static, .shape = Mesh{data, scale}});
  // Each triangle alone, with its corners scaled here; a mirrored one turns round.
  std::vector<std::unique_ptr<World>> single;
  for (uint32_t e = 0; e < data->triangleCount(); ++e) {
    std::array<Vec3, 3> v = data->triangle(e);
    for (Vec3& p : v) p = {p.x * scale.x, p.y * scale.y, p.z * scale.z};
    std::swap(v[1], v[2]);
    const std::array<uint32_t, 3> t[1] = {{0, 1, 2}};
    single.push_back(std::make_unique<World>());
    single.back()->create(BodyDef{.type = BodyType::Static, .shape = Mesh{makeMesh({.vertices = v, .triangles = t})}});
  }
  int hits = 0;
  for (int round = 0; round < 60; ++round) {
    const Vec3d from = random.point(6) + Vec3d{0, 4, 0};
    const Geometry g = convexGeometry(random, random.below(kConvexTypes));
    const Pose pose{from, random.rotation()};
    const Ray ray{from, random.direction(), 20};
    float first = 1e30f, firstCast = 1e30f, least = 1e30f;
    for (const auto& world : single) {
      if (const CastHit hit = world->rayClosest(ray)) first = std::min(first, hit.distance);
      if (const CastHit hit = world->castClosest(g, pose, ray.direction * 20.0f))
        firstCast = std::min(firstCast, hit.distance);
      const NearHit near = world->nearestClosest(g, pose, 30);
      if (near.shape) least = std::min(least, near.distance);
    }
    const CastHit hit = mesh.rayClosest(ray), cast = mesh.castClosest(g, pose, ray.direction * 20.0f);
    ASSERT_EQ(bool(hit), first < 1e30f);
    ASSERT_EQ(bool(cast), firstCast < 1e30f);
    hits += bool(hit) + bool(cast);
    EXPECT_NEAR(hit ? hit.distance : 1e30f, first, 1e-5);
    EXPECT_NEAR(cast ? cast.distance : 1e30f, firstCast, 1e-4);
    EXPECT_NEAR(mesh.nearestClosest(g, pose, 30).distance, least, 1e-4) << round;
    EXPECT_EQ(mesh.overlapsAny(g, pose), least <= 0);
  }
  EXPECT_GT(hits, 20);
}

TEST(QuerySurfaces, groundHoldsWhatIsBelowIt) {
  QueryRandom random(5);
  std::vector<float> heights;
  for (int i = 0; i < 9 * 7; ++i) heights.push_back(random.size(0, 1));
  World world;
  world.create(BodyDef{
      .type = BodyType::Static,
      .position = {3, 1, -2},
      .shape = HeightField{
          makeHeightField(
              {.columns = 9, .rows = 7, .spacingX = 0.5f, .spacingZ = 0.75f, .heights = heights, .thickness = 2}),
          {2, 1, 1}}});
  int inside = 0;
  for (int round = 0; round < 500; ++round) {
    const Vec3d top{3 + random.within(-4.5, 4.5), 10, -2 + random.within(-2.5, 2.5)};
    const CastHit hit = world.rayClosest({top, {0, -1, 0}, 30});
    if (!hit) {
      EXPECT_TRUE(world.containing({top.x, 1, top.z}).empty());
      continue;
    }
    ++inside;
    const Vec3d p = hit.position;
    EXPECT_EQ(world.containing(p - Vec3{0, 1e-4f, 0}).size(), 1u);
    EXPECT_EQ(world.containing(p - Vec3{0, 1.99f, 0}).size(), 1u);
    EXPECT_TRUE(world.containing(p + Vec3{0, 1e-4f, 0}).empty());
    EXPECT_TRUE(world.overlapsAny(Sphere{0.01f}, {p - Vec3{0, 0.5f, 0}, {}}));
  }
  EXPECT_GT(inside, 300);
}

}  // namespace
}  // namespace avbd
