// Queries of worlds against brute force by other code: the oracle of collide_convex_oracle.h in double, filters by
// their definition.
#include <gtest/gtest.h>

#include "collide/collide_convex_oracle.h"
#include "query/query_world.h"

namespace avbd {
namespace {

/// The convex shapes of a world, each as the oracle needs it.
class Brute {
 public:
  explicit Brute(const World& world) : world_(world) {
    for (const BodyId body : world.bodies()) {
      for (const ShapeId shape : world.shapes(body)) {
        keep_.emplace_back();
        geometries_.push_back(std::make_unique<Geometry>(world.geometry(shape)));
        const Pose at = world.pose(body) * world.localPose(shape);
        shapes_.push_back({shape, toShapeGeom(*geometries_.back(), keep_.back()), at});
      }
    }
  }
  struct Entry {
    ShapeId id;
    ShapeGeom geom;
    Pose pose;
  };
  const std::vector<Entry>& shapes() const { return shapes_; }
  const Entry& of(ShapeId id) const {
    return *std::find_if(shapes_.begin(), shapes_.end(), [&](const Entry& e) { return e.id == id; });
  }

  /// Distance or depth by directions; a lower bound that climbing makes good to about 1e-4.
  double gap(const Entry& e, const ShapeGeom& placed, const Pose& pose, Vec3 hint = {}) {
    const oracle::Asked asked{
        placed, e.geom, {{}, pose.rotation}, {toFloat(e.pose.position - pose.position), e.pose.rotation}};
    return oracle::largestGap(asked, toDouble(hint), 120, random_);
  }

  /// By the rules of geometry.h and query.h.
  bool sees(ShapeId id, const QueryFilter& f) const {
    const Filter s = world_.filter(id);
    const BodyType type = world_.type(world_.body(id));
    if (type == BodyType::Static && !f.statics) return false;
    if (type == BodyType::Kinematic && !f.kinematics) return false;
    if (type == BodyType::Dynamic && !f.dynamics) return false;
    if (world_.isTrigger(id) && !f.triggers) return false;
    if (f.ignore && world_.body(id) == f.ignore) return false;
    if (f.accept && !f.accept(id)) return false;
    if (s.group != 0 && s.group == f.filter.group) return s.group > 0;
    const bool one = (f.filter.mask & s.category) != 0, other = (s.mask & f.filter.category) != 0;
    return s.anyMask && f.filter.anyMask ? one || other : one && other;
  }

 private:
  const World& world_;
  std::vector<std::shared_ptr<const HullData>> keep_;
  std::vector<std::unique_ptr<Geometry>> geometries_;
  std::vector<Entry> shapes_;
  std::mt19937 random_{77};
};

class QueryBrute : public testing::TestWithParam<int> {
 protected:
  Vec3d center() const { return GetParam() == 0 ? Vec3d{} : Vec3d{-800000.3, 512.7, 310000.1}; }
  /// Random filters of all kinds on shapes that lie close.
  World crowd(QueryRandom& random, int count) const {
    World world;
    for (int i = 0; i < count; ++i) {
      BodyDef def;
      def.type = static_cast<BodyType>(random.below(3));
      def.position = center() + random.point(2.5);
      def.rotation = random.rotation();
      ShapeDef shape;
      shape.geometry = convexGeometry(random, i % kConvexTypes);
      if (random.below(3) == 0) shape.pose = {random.point(0.5), random.rotation()};
      shape.isTrigger = random.below(6) == 0;
      shape.filter = filter(random);
      def.shapes = {shape};
      def.massProperties = MassProperties{};
      world.create(def);
    }
    return world;
  }
  static Filter filter(QueryRandom& random) {
    if (random.below(3) == 0) return {};
    const uint32_t masks[] = {0xffffffffu, 1, 2, 6, 5};
    return {1u << random.below(3), masks[random.below(5)], random.below(5) - 2, random.below(2) == 0};
  }
  QueryFilter question(QueryRandom& random, const World& world) const {
    QueryFilter f;
    f.filter = filter(random);
    f.statics = random.below(5) != 0;
    f.kinematics = random.below(5) != 0;
    f.dynamics = random.below(5) != 0;
    f.triggers = random.below(2) == 0;
    const std::vector<BodyId> bodies = world.bodies();
    if (random.below(3) == 0) f.ignore = bodies[static_cast<size_t>(random.below(int(bodies.size())))];
    if (random.below(4) == 0) f.accept = [](ShapeId id) { return id.index % 3 != 0; };
    return f;
  }
};

TEST_P(QueryBrute, filtersByTheirDefinition) {
  QueryRandom random(41);
  int seen = 0, hidden = 0;
  for (int worlds = 0; worlds < 15; ++worlds) {
    const World world = crowd(random, 44);
    const Brute brute(world);
    const Pose all{center(), {}};
    for (int round = 0; round < 60; ++round) {
      const QueryFilter f = question(random, world);
      std::vector<ShapeId> expected;
      for (const Brute::Entry& e : brute.shapes())
        if (brute.sees(e.id, f)) expected.push_back(e.id);
      std::sort(expected.begin(), expected.end());
      ASSERT_EQ(world.overlaps(Sphere{50}, all, f), expected);
      ASSERT_EQ(world.nearest(Sphere{0.1f}, all, 50, f).size(), expected.size());
      // A plank swept through everything.
      ASSERT_EQ(world.castAll(Box{20, 0.1f, 20}, {center() - Vec3d{0, 30, 0}, {}}, {0, 60, 0}, f).size(),
                expected.size());
      ASSERT_EQ(world.castAny({Box{20, 0.1f, 20}, {center() - Vec3d{0, 30, 0}, {}}, {0, 60, 0}}, f), !expected.empty());
      for (const CastHit& hit : world.rayAll({center() - Vec3d{0, 9, 0}, {0, 1, 0}, 18}, f))
        ASSERT_TRUE(brute.sees(hit.shape, f));
      for (const ShapeId id : world.containing(center(), f)) ASSERT_TRUE(brute.sees(id, f));
      seen += int(expected.size());
      hidden += int(brute.shapes().size() - expected.size());
    }
  }
  EXPECT_GT(seen, 3000);
  EXPECT_GT(hidden, 3000);
}

TEST_P(QueryBrute, overlapsAndNearest) {
  QueryRandom random(42);
  int over = 0, apart = 0;
  for (int worlds = 0; worlds < 4; ++worlds) {
    const World world = crowd(random, 22);
    Brute brute(world);
    for (int round = 0; round < 40; ++round) {
      QueryFilter f = question(random, world);
      f.filter = {};
      const Geometry g = convexGeometry(random, random.below(kConvexTypes));
      const Pose pose{center() + random.point(3.5), random.rotation()};
      std::shared_ptr<const HullData> keep;
      const ShapeGeom placed = toShapeGeom(g, keep);
      const std::vector<ShapeId> overlaps = world.overlaps(g, pose, f);
      const std::vector<NearHit> near = world.nearest(g, pose, 1.5f, f);
      double least = 1e300;
      for (const Brute::Entry& e : brute.shapes()) {
        const auto told = std::find_if(near.begin(), near.end(), [&](const NearHit& h) { return h.shape == e.id; });
        const bool listed = std::find(overlaps.begin(), overlaps.end(), e.id) != overlaps.end();
        if (!brute.sees(e.id, f)) {
          EXPECT_FALSE(listed || told != near.end());
          continue;
        }
        const double gap = brute.gap(e, placed, pose, told != near.end() ? -told->normal : Vec3{});
        least = std::min(least, gap);
        if (std::fabs(gap) > 1e-3) {
          EXPECT_EQ(listed, gap < 0) << gap;
          ++(gap < 0 ? over : apart);
        }
        if (std::fabs(gap - 1.5) > 1e-3) {
          EXPECT_EQ(told != near.end(), gap < 1.5) << gap;
        }
        if (told == near.end()) continue;
        EXPECT_NEAR(double(told->distance), gap, 1e-3) << g.index();
      }
      EXPECT_EQ(world.overlapsAny(g, pose, f), !overlaps.empty());
      const NearHit first = world.nearestClosest(g, pose, 1.5f, f);
      ASSERT_EQ(bool(first.shape), !near.empty());
      if (!first.shape) continue;
      EXPECT_EQ(first.shape, near[0].shape);
      EXPECT_EQ(first.distance, near[0].distance);
      EXPECT_NEAR(double(first.distance), least, 1e-3);
    }
  }
  EXPECT_GT(over, 50);
  EXPECT_GT(apart, 300);
}

/// At a hit the shapes touch, along the normal that was told; halfway there nothing that is seen overlaps.
TEST_P(QueryBrute, castsTouchWhereTheySay) {
  QueryRandom random(43);
  int hits = 0;
  for (int worlds = 0; worlds < 4; ++worlds) {
    const World world = crowd(random, 22);
    Brute brute(world);
    for (int round = 0; round < 25; ++round) {
      const Geometry g = convexGeometry(random, random.below(kConvexTypes));
      const Vec3 d = random.direction();
      const Pose from{center() + random.point(1.5) - toDouble(d) * 9.0, random.rotation()};
      std::shared_ptr<const HullData> keep;
      const ShapeGeom placed = toShapeGeom(g, keep);
      const QueryFilter f{.triggers = true};
      const CastHit hit = world.castClosest(g, from, d * 18.0f, f);
      const double way = hit ? double(hit.distance) : 18;
      for (const Brute::Entry& e : brute.shapes()) {
        if (!brute.sees(e.id, f)) continue;
        for (const double part : {0.5, 0.9, 0.99}) {
          const Pose at{from.position + toDouble(d) * (way * part), from.rotation};
          ASSERT_GT(brute.gap(e, placed, at), -1e-3) << "nothing is passed through";
        }
      }
      if (!hit || hit.distance == 0) continue;
      ++hits;
      const Brute::Entry& e = brute.of(hit.shape);
      const Pose at{from.position + toDouble(d) * way, from.rotation};
      EXPECT_NEAR(length(hit.normal), 1, 1e-5f);
      EXPECT_LE(dot(hit.normal, d), 1e-5f);
      EXPECT_NEAR(brute.gap(e, placed, at, -hit.normal), 0, 1e-3);
      // The plane across the normal parts the two: along it they overlap by no more than rounding.
      const oracle::Asked asked{
          placed, e.geom, {{}, at.rotation}, {toFloat(e.pose.position - at.position), e.pose.rotation}};
      EXPECT_NEAR(asked.gap(toDouble(-hit.normal)), 0, 1e-3) << g.index();
      EXPECT_LT(oracle::sticksOut(e.geom, {{}, e.pose.rotation}, hit.position - e.pose.position, 200), 1e-3);
      EXPECT_LT(oracle::sticksOut(placed, {{}, at.rotation}, hit.position - at.position, 200), 1e-3);
    }
  }
  EXPECT_GT(hits, 60);
}

INSTANTIATE_TEST_SUITE_P(Where, QueryBrute, testing::Values(0, 1),
                         [](const auto& name) { return name.param == 0 ? "origin" : "far"; });

}  // namespace
}  // namespace avbd
