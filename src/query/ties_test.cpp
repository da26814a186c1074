// Answers at one distance: the lower shape id comes first, whatever the tree's order; reaches hold their end.
#include <gtest/gtest.h>

#include "query/query_world.h"

namespace avbd {
namespace {

/// Copies of one shape at one place among others, with the tree in some order: made in turn with bodies elsewhere, some
/// of which go again.
struct Coincident {
  World world;
  std::vector<ShapeId> copies;

  Coincident(QueryRandom& random, const Geometry& geometry, const Pose& pose) {
    std::vector<BodyId> others;
    const int count = 2 + random.below(5);
    for (int i = 0; i < count; ++i) {
      for (int k = random.below(4); k > 0; --k)
        others.push_back(world.create(BodyDef{.type = BodyType::Static,
                                              .position = pose.position + random.point(4) + Vec3d{0, 80, 0},
                                              .shape = Box{random.size(), random.size(), random.size()}}));
      const BodyId body = world.create(
          BodyDef{.type = BodyType::Static, .position = random.point(100), .rotation = {}, .shape = geometry});
      copies.push_back(world.shapes(body)[0]);
      if (!others.empty() && random.below(3) == 0) {
        world.destroy(others.back());
        others.pop_back();
      }
    }
    // Moved to their place in another order: the leaves' order in the tree is not that of the ids.
    std::vector<ShapeId> order = copies;
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[static_cast<size_t>(random.below(int(i)))]);
    for (const ShapeId id : order) world.setPose(world.body(id), pose);
    // Slots of the dead are used again, so creation is not the order of ids either.
    std::sort(copies.begin(), copies.end(), [](ShapeId a, ShapeId b) { return a.index < b.index; });
  }
};

void expectFirst(const Coincident& c, const std::vector<CastHit>& all, const CastHit& closest, int round) {
  ASSERT_EQ(all.size(), c.copies.size()) << round;
  for (size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].shape, c.copies[i]) << round;
  EXPECT_EQ(closest.shape, c.copies[0]) << round;
  EXPECT_EQ(closest.distance, all[0].distance);
  EXPECT_EQ(closest.position, all[0].position);
  EXPECT_EQ(closest.normal, all[0].normal);
}

TEST(QueryTies, theLowerIdOfCoincidentShapes) {
  QueryRandom random(11);
  int rays = 0, casts = 0;
  for (int round = 0; round < 1100; ++round) {
    const int type = round % (kConvexTypes + 1);
    const Geometry g = type == kConvexTypes ? Geometry{Mesh{bumpyMesh(3, 0.6f, random)}} : convexGeometry(random, type);
    const Pose pose{round % 2 ? Vec3d{2000.1, 30, -777} : Vec3d{}, round % 3 ? random.rotation() : Quat{}};
    const Coincident c(random, g, pose);
    const Vec3 d = random.direction() * random.size(0.1, 40);
    const double back = round % 5 ? random.within(1, 20) : 0;
    const Vec3d from = pose.position + random.point(0.4) - toDouble(d) * (back / double(length(d)));
    const Ray ray{from, d, 30};
    if (const CastHit closest = c.world.rayClosest(ray, {.backFaces = true})) {
      ++rays;
      expectFirst(c, c.world.rayAll(ray, {.backFaces = true}), closest, round);
    }
    const ShapeCast cast{convexGeometry(random, random.below(kConvexTypes)),
                         {from, round % 3 ? random.rotation() : Quat{}},
                         d * (30 / length(d))};
    if (const CastHit closest = c.world.castClosest(cast, {.backFaces = true})) {
      ++casts;
      expectFirst(c, c.world.castAll(cast, {.backFaces = true}), closest, round);
    }
    const NearHit near = c.world.nearestClosest(cast.geometry, cast.pose, 50);
    ASSERT_TRUE(near.shape);
    EXPECT_EQ(near.shape, c.copies[0]) << round;
    EXPECT_EQ(c.world.nearest(cast.geometry, cast.pose, 50)[0].shape, c.copies[0]);
  }
  EXPECT_GT(rays, 500);
  EXPECT_GT(casts, 600);
}

/// Faces at one height, not one shape: distances that are equal but for rounding come in order of what is told.
TEST(QueryTies, theFirstOfAllAmongFlushShapes) {
  QueryRandom random(12);
  for (int round = 0; round < 600; ++round) {
    World world;
    const float top = random.size(0.1, 30);
    for (int i = 0; i < 8; ++i) {
      const float half = random.size(0.1, 5);
      const Geometry kinds[] = {Box{2, half, 2}, Cylinder{2, half}, Cylinder{2, half - 0.05f, 0.05f}, Box{2, half, 2}};
      world.create(BodyDef{.type = BodyType::Static,
                           .position = {random.within(-1, 1), double(top) - double(half), random.within(-1, 1)},
                           .shape = kinds[random.below(4)]});
    }
    const Vec3 d{random.size(-0.3, 0.3), -1, random.size(-0.3, 0.3)};
    const Vec3d from = Vec3d{0, double(top), 0} - toDouble(d) * random.within(1, 30);
    const CastHit ray = world.rayClosest({from, d, 90});
    ASSERT_TRUE(ray);
    EXPECT_EQ(ray.shape, world.rayAll({from, d, 90})[0].shape) << round;
    for (const Geometry& mover :
         {Geometry{Box{0.3f, 0.2f, 0.3f}}, Geometry{Sphere{0.2f}}, Geometry{Cone{0.3f, 0.2f}}}) {
      const CastHit hit = world.castClosest(mover, {from, {}}, d * 90.0f);
      const std::vector<CastHit> all = world.castAll(mover, {from, {}}, d * 90.0f);
      ASSERT_TRUE(hit);
      EXPECT_EQ(hit.shape, all[0].shape) << round;
      EXPECT_EQ(hit.distance, all[0].distance) << round;
    }
  }
}

/// What is exactly maxDistance away is no farther than that.
TEST(QueryTies, exactlyAsFarAsAsked) {
  QueryRandom random(13);
  const Geometry kinds[] = {Sphere{0.5f},         Box{0.5f, 0.5f, 0.5f}, Capsule{0.25f, 0.25f},
                            Cylinder{0.5f, 0.5f}, Ellipsoid{1, 0.5f, 1}, HalfSpace{}};
  for (const Geometry& g : kinds) {
    World world;
    const double bottom = std::holds_alternative<HalfSpace>(g) ? 0 : 0.5;
    world.create(BodyDef{.type = BodyType::Static, .position = {0, -bottom, 0}, .shape = g});
    for (const float gap : {0.25f, 1.0f, 8.0f, 0.0f}) {
      const Pose pose{{0, 0.5 + double(gap), 0}, {}};
      EXPECT_EQ(world.nearest(Box{0.5f, 0.5f, 0.5f}, pose, gap).size(), 1u) << g.index() << " " << gap;
      EXPECT_TRUE(world.nearestClosest(Sphere{0.5f}, pose, gap).shape) << g.index() << " " << gap;
      if (gap > 0) {
        EXPECT_FALSE(world.nearestClosest(Sphere{0.5f}, pose, gap * 0.999f).shape) << g.index();
      }
    }
  }
  const Vec3 v[3] = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 0}};
  const std::array<uint32_t, 3> t[1] = {{0, 1, 2}};
  World mesh;
  mesh.create(BodyDef{.type = BodyType::Static, .shape = Mesh{makeMesh({.vertices = v, .triangles = t})}});
  EXPECT_TRUE(mesh.nearestClosest(Sphere{0.5f}, {{0, 1, 0}, {}}, 0.5f).shape);
  // Any distance that was told is enough to ask with.
  QueryWorlds worlds(14, 60, {}, 6);
  worlds.addSurfaces(15, {});
  for (int round = 0; round < 300; ++round) {
    const Geometry g = convexGeometry(random, random.below(kConvexTypes));
    const Pose pose{random.point(7), random.rotation()};
    const NearHit hit = worlds.all.nearestClosest(g, pose, 20);
    if (!hit.shape || hit.distance < 0) continue;
    EXPECT_EQ(worlds.all.nearestClosest(g, pose, hit.distance).shape, hit.shape) << round;
  }
}

}  // namespace
}  // namespace avbd
