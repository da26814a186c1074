// World's queries: bad input, shapes where they are now, queries beside each other, bulk forms.
#include <gtest/gtest.h>

#include <thread>

#include "query/query_world.h"

namespace avbd {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// what() of the Error that f throws.
template <class F>
std::string refusal(F&& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "nothing was refused";
}

TEST(WorldQueries, refuseBadInput) {
  World world;
  const BodyId dead = world.create(BodyDef{.shape = Sphere{}});
  world.destroy(dead);
  const Ray good{};
  EXPECT_EQ(refusal([&] {
              world.rayClosest({{kNan, 0, 0}, {0, 1, 0}, 1});
            }).substr(0, 34),
            "World::rayClosest.ray.origin = (na");
  EXPECT_EQ(refusal([&] {
              world.rayAny({{}, {0, 0, 0}, 1});
            }),
            "World::rayAny.ray.direction = (0, 0, 0): must be finite and not zero");
  EXPECT_NE(refusal([&] { world.rayAll({{}, {0, kNan, 0}, 1}); }).find("ray.direction"), std::string::npos);
  EXPECT_NE(refusal([&] { world.rayAll({{}, {0, INFINITY, 0}, 1}); }).find("ray.direction"), std::string::npos);
  EXPECT_EQ(refusal([&] {
              world.rayClosest({{}, {0, 1, 0}, 0});
            }),
            "World::rayClosest.ray.length = 0: must be finite and > 0");
  EXPECT_NE(refusal([&] { world.rayClosest({{}, {0, 1, 0}, INFINITY}); }).find("ray.length"), std::string::npos);
  EXPECT_NE(refusal([&] { world.rayClosest(good, {.ignore = dead}); }).find("filter.ignore"), std::string::npos);
  EXPECT_NE(refusal([&] { world.containing({0, 0, kNan}); }).find("World::containing.point"), std::string::npos);
  EXPECT_EQ(refusal([&] { world.overlaps(HalfSpace{}, {}); }),
            "World::overlaps.geometry = HalfSpace: must be convex and bounded");
  EXPECT_NE(refusal([&] { world.overlapsAny(Mesh{}, {}); }).find("data"), std::string::npos);
  EXPECT_NE(refusal([&] { world.overlapsAny(Hull{}, {}); }).find("geometry.data"), std::string::npos);
  EXPECT_NE(refusal([&] { world.nearest(Sphere{-1}, {}, 1); }).find("geometry.radius"), std::string::npos);
  EXPECT_NE(refusal([&] { world.nearest(Sphere{}, {}, kNan); }).find("maxDistance"), std::string::npos);
  EXPECT_NE(refusal([&] {
              world.nearestClosest(Sphere{}, {{}, {0, 0, 0, 0}}, 1);
            }).find("pose.rotation"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              world.castClosest(Sphere{}, {}, {0, 0, 0});
            }).find("World::castClosest.cast.motion"),
            std::string::npos);
  EXPECT_NE(refusal([&] { world.castAll(Sphere{}, {}, {kNan, 0, 0}); }).find("cast.motion"), std::string::npos);
  const std::vector<Ray> rays{good, {{}, {0, kNan, 0}, 1}};
  std::vector<CastHit> hits(2);
  std::vector<uint8_t> flags(1);
  EXPECT_NE(refusal([&] { world.raysClosest(rays, hits); }).find("World::raysClosest.rays[1].direction"),
            std::string::npos);
  EXPECT_EQ(refusal([&] { world.raysAny(rays, flags); }), "World::raysAny.out = 1 values: must be as many as rays: 2");
  const std::vector<PlacedGeometry> placed{{}, {Sphere{kNan}, {}}};
  std::vector<NearHit> near(2);
  EXPECT_NE(
      refusal([&] { world.nearestOfEach(placed, 1, near); }).find("World::nearestOfEach.placed[1].geometry.radius"),
      std::string::npos);
  EXPECT_NE(refusal([&] { world.nearestOfEach({}, -1, {}); }).find("World::nearestOfEach.maxDistance"),
            std::string::npos);
  const std::vector<Vec3d> points{{}, {0, kNan, 0}};
  flags.assign(2, 7);
  EXPECT_NE(refusal([&] { world.pointTests(points, flags); }).find("World::pointTests.points[1]"), std::string::npos);
  EXPECT_EQ(flags[0], 7) << "nothing is answered before everything is checked";
}

TEST(WorldQueries, bulkFormsAnswerAsSingleOnes) {
  QueryWorlds worlds(3, 60, {}, 5);
  QueryRandom random(4);
  std::vector<Ray> rays;
  std::vector<ShapeCast> casts;
  std::vector<PlacedGeometry> placed;
  for (int i = 0; i < 100; ++i) {
    rays.push_back({random.point(6), random.direction(), 8});
    const Geometry g = convexGeometry(random, random.below(kConvexTypes));
    const Pose pose{random.point(6), random.rotation()};
    casts.push_back({g, pose, random.direction() * 5.0f});
    placed.push_back({g, pose});
  }
  std::vector<Vec3d> points;
  for (const PlacedGeometry& p : placed) points.push_back(p.pose.position);
  std::vector<NearHit> nearHits(100);
  std::vector<uint8_t> pointFlags(100);
  worlds.all.nearestOfEach(placed, 0.7f, nearHits, {.triggers = true});
  worlds.all.pointTests(points, pointFlags, {.triggers = true});
  int near = 0, held = 0;
  std::vector<CastHit> rayHits(100), castHits(100);
  std::vector<uint8_t> rayFlags(100), overlapFlags(100);
  worlds.all.raysClosest(rays, rayHits);
  worlds.all.raysAny(rays, rayFlags);
  worlds.all.castsClosest(casts, castHits);
  worlds.all.overlapTests(placed, overlapFlags);
  for (size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(rayHits[i].position, worlds.all.rayClosest(rays[i]).position);
    EXPECT_EQ(rayFlags[i], bool(rayHits[i]));
    EXPECT_EQ(castHits[i].position, worlds.all.castClosest(casts[i]).position);
    EXPECT_EQ(castHits[i].shape, worlds.all.castClosest(casts[i]).shape);
    EXPECT_EQ(overlapFlags[i] != 0, worlds.all.overlapsAny(placed[i].geometry, placed[i].pose));
    const NearHit one = worlds.all.nearestClosest(placed[i].geometry, placed[i].pose, 0.7f, {.triggers = true});
    EXPECT_EQ(nearHits[i].shape, one.shape);
    EXPECT_EQ(nearHits[i].onShape, one.onShape);
    EXPECT_EQ(pointFlags[i] != 0, !worlds.all.containing(points[i], {.triggers = true}).empty());
    near += bool(one.shape);
    held += pointFlags[i];
  }
  EXPECT_GT(near, 20);
  EXPECT_GT(held, 2);
}

/// A scaled hull that no shape of the world has is made at the first question with it, not at each.
TEST(WorldQueries, scaledHullsAreKept) {
  QueryRandom random(12);
  const auto hull = rockHull(random, 60);
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = Box{}});
  const auto ask = [&](Vec3 scale) { return world.nearestClosest(Hull{hull, scale}, {{0, 5, 0}, {}}, 20).distance; };
  const float first = ask({1, 2, 1});
  const long users = hull.use_count();
  for (int i = 0; i < 50; ++i) EXPECT_EQ(ask({1, 2, 1}), first);
  EXPECT_EQ(hull.use_count(), users);
  // Many scales: what is kept stays bounded, and answers stay right.
  for (int i = 0; i < 100; ++i) EXPECT_GT(ask({1, 1 + 0.01f * float(i), 1}), ask({1, 1.01f + 0.01f * float(i), 1}));
  EXPECT_LT(hull.use_count(), 20);
  EXPECT_EQ(ask({1, 2, 1}), first);
}

TEST(WorldQueries, filtersAndAccept) {
  World world;
  const BodyId low = world.create(BodyDef{.type = BodyType::Static, .position = {0, 1, 0}, .shape = Box{}});
  const BodyId high =
      world.create(BodyDef{.position = {0, 3, 0}, .shape = Box{}, .filter = {.category = 4, .mask = 2}});
  const Ray down{{0, 10, 0}, {0, -1, 0}, 20};
  // The higher box wants to touch category 2 only.
  EXPECT_EQ(world.rayClosest(down).body, low);
  EXPECT_EQ(world.rayClosest(down, {.filter = {.category = 2}}).body, high);
  EXPECT_EQ(world.rayClosest(down, {.filter = {.category = 2}, .dynamics = false}).body, low);
  EXPECT_EQ(world.rayClosest(down, {.filter = {.category = 2}, .ignore = high}).body, low);
  const ShapeId shape = world.shapes(high)[0];
  int asked = 0;
  const QueryFilter picky{.filter = {.category = 2}, .accept = [&](ShapeId id) {
                            ++asked;
                            return id != shape;
                          }};
  EXPECT_EQ(world.rayClosest(down, picky).body, low);
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(world.rayAll(down, picky).size(), 1u);
  EXPECT_FALSE(world.rayClosest(down, {.filter = {.mask = 0}}));
}

/// One ray from above and what it ought to hit.
BodyId below(const World& world, double x) { return world.rayClosest({{x, 100, 0}, {0, -1, 0}, 200}).body; }

TEST(WorldQueries, shapesAreWhereTheyAreNow) {
  World world;
  const BodyId a = world.create(BodyDef{.type = BodyType::Static, .shape = Box{}});
  EXPECT_EQ(below(world, 0), a);
  world.setPose(a, {{50, 0, 0}, {}});
  EXPECT_FALSE(below(world, 0));
  EXPECT_EQ(below(world, 50), a);
  const BodyId b = world.create(BodyDef{.position = {0, 2, 0}, .shape = Sphere{}});
  EXPECT_EQ(below(world, 0), b);
  world.step(0.01f);
  world.setPose(b, {{-30, 2, 0}, {}});
  EXPECT_EQ(below(world, -30), b);
  const ShapeId extra = world.create(a, {.geometry = Sphere{}, .pose = {{5, 0, 0}, {}}});
  EXPECT_EQ(below(world, 55), a);
  world.destroy(extra);
  EXPECT_FALSE(below(world, 55));
  world.destroy(a);
  EXPECT_FALSE(below(world, 50));
}

TEST(WorldQueries, bodiesThatAStepTookOutOfTheirBounds) {
  World world({.gravity = {}});
  std::vector<BodyId> bodies;
  for (int i = 0; i < 20; ++i) {
    bodies.push_back(world.create(BodyDef{.position = {20.0 * i, 0, 0}, .shape = Box{}, .mass = 1}));
  }
  // At rest when the step fits the bounds, then thrown two metres to the side, each another way.
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 20; ++i)
      world.addForce(bodies[static_cast<size_t>(i)], {round % 2 ? -30000.0f : 20000.0f, 0, 100.0f * float(i)});
    world.step(0.01f);
    for (const BodyId id : bodies) {
      const Vec3d p = world.pose(id).position;
      const std::vector<ShapeId> found = world.overlaps(Sphere{0.01f}, {p, {}});
      ASSERT_EQ(found.size(), 1u);
      EXPECT_EQ(found[0], world.shapes(id)[0]);
      EXPECT_EQ(world.containing(p).size(), 1u);
      EXPECT_EQ(world.rayClosest({p + Vec3d{0, 3, 0}, {0, -1, 0}, 5}).body, id);
    }
  }
}

TEST(WorldQueries, queriesDoNotChangeTheSimulation) {
  uint64_t hash[2];
  for (int asks = 0; asks < 2; ++asks) {
    World world({.substeps = 2});
    world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    QueryRandom random(1);
    std::vector<BodyId> bodies;
    for (int i = 0; i < 60; ++i) {
      bodies.push_back(world.create(BodyDef{.position = random.point(2) + Vec3d{0, 4, 0},
                                            .rotation = random.rotation(),
                                            .shape = Box{0.3f, 0.2f, 0.4f}}));
    }
    for (int step = 0; step < 90; ++step) {
      if (step % 30 == 20) {
        for (const BodyId id : bodies) world.addImpulse(id, random.direction() * 900.0f);
      }
      world.step(1.0f / 60);
      if (asks) world.rayAny({{0, 10, 0}, {0, -1, 0}, 20});
      if (asks) world.nearest(Sphere{}, {}, 1);
    }
    hash[asks] = world.hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

TEST(WorldQueries, manyReadersGetTheSameAnswers) {
  World world({.gravity = {}});
  QueryRandom random(2);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 300; ++i) {
    bodies.push_back(world.create(BodyDef{.position = random.point(10),
                                          .rotation = random.rotation(),
                                          .shape = convexGeometry(random, i % kConvexTypes),
                                          .mass = 1}));
  }
  std::vector<Ray> rays;
  for (int i = 0; i < 300; ++i) rays.push_back({random.point(15), random.direction(), 30});
  for (int round = 0; round < 3; ++round) {
    for (const BodyId id : bodies) world.addForce(id, random.direction() * 5000.0f);
    world.step(0.02f);
    // The first queries after the step come from all threads at once.
    std::vector<std::vector<CastHit>> answers(8, std::vector<CastHit>(rays.size()));
    std::vector<size_t> overlaps(8);
    std::vector<std::thread> readers;
    for (size_t t = 0; t < answers.size(); ++t) {
      readers.emplace_back([&, t] {
        for (size_t i = 0; i < rays.size(); ++i) {
          answers[t][i] = world.rayClosest(rays[i]);
          overlaps[t] += world.overlaps(Capsule{}, {rays[i].origin, {}}).size();
          overlaps[t] += world.nearest(Box{}, {rays[i].origin, {}}, 1).size();
        }
      });
    }
    for (std::thread& reader : readers) reader.join();
    for (size_t t = 1; t < answers.size(); ++t) {
      EXPECT_EQ(overlaps[t], overlaps[0]);
      for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(answers[t][i].shape, answers[0][i].shape);
        ASSERT_EQ(answers[t][i].position, answers[0][i].position);
      }
    }
  }
}

TEST(WorldQueries, longRaysFarFromTheOrigin) {
  World world;
  const Vec3d at{8e8, -3e8, 5e8};
  world.create(BodyDef{.type = BodyType::Static, .position = at, .shape = Sphere{0.5f}});
  const CastHit hit = world.rayClosest({at + Vec3d{0, 1e6, 0.25}, {0, -1, 0}, 2e6f});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit.position.y - at.y, std::sqrt(0.1875), 1e-6);
  EXPECT_FALSE(world.rayClosest({at + Vec3d{0, 1e6, 0.5001}, {0, -1, 0}, 2e6f}));
  const Ray endless{at + Vec3d{0, 3, 0}, {0, -1e-30f, 0}, std::numeric_limits<float>::max()};
  EXPECT_NEAR(world.rayClosest(endless).distance, 2.5, 1e-6);
  // Casts, too: the way begins where the bounds meet.
  const CastHit cast = world.castClosest(Box{0.5f, 0.5f, 0.5f}, {at + Vec3d{0, 1e6, 0.25}, {}}, {0, -2e6f, 0});
  ASSERT_TRUE(cast);
  EXPECT_NEAR(cast.position.y - at.y, 0.5, 1e-5);
}

}  // namespace
}  // namespace avbd
