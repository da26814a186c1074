// Queries of a world find what asking each shape alone finds, and agree with each other.
#include <gtest/gtest.h>

#include "query/query_world.h"

namespace avbd {
namespace {

class Queries : public testing::TestWithParam<int> {
 protected:
  /// At the origin, and where a float has two millimetres left.
  Vec3d center() const { return GetParam() == 0 ? Vec3d{} : Vec3d{20000.3, -512.7, 31000.1}; }
  QueryWorlds worlds_{7, 110, center(), 6};
  QueryRandom random_{8};
  void SetUp() override { worlds_.addSurfaces(9, center()); }

  Ray ray() {
    const Vec3 d = random_.direction();
    const float far = random_.below(4) ? 8 : 100000;
    return {center() + random_.point(6) - toDouble(d) * double(random_.below(3) ? far : 0), d * random_.size(0.01, 100),
            random_.below(3) ? 2 * far : 4};
  }
  QueryFilter filter() {
    QueryFilter f;
    f.statics = random_.below(4) != 0;
    f.kinematics = random_.below(4) != 0;
    f.dynamics = random_.below(4) != 0;
    f.triggers = random_.below(2) != 0;
    if (random_.below(3) == 0) f.filter.mask = 3;
    if (random_.below(3) == 0) f.filter.category = 2;
    return f;
  }
};

void expectSame(const CastHit& a, const CastHit& b) {
  EXPECT_EQ(a.element, b.element);
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.normal, b.normal);
}

/// all == every single world's answer in order of distance; closest == the first; any == whether there is one.
template <class All, class Closest, class Any>
size_t expectAsAlone(QueryWorlds& worlds, All&& all, Closest&& closest, Any&& any) {
  std::vector<CastHit> expected;
  for (size_t i = 0; i < worlds.single.size(); ++i) {
    CastHit hit = closest(*worlds.single[i]);
    if (!hit) continue;
    hit.shape = worlds.shapes[i];
    hit.body = worlds.bodies[i];
    expected.push_back(hit);
  }
  std::stable_sort(expected.begin(), expected.end(),
                   [](const CastHit& a, const CastHit& b) { return a.distance < b.distance; });
  const std::vector<CastHit> found = all(worlds.all);
  EXPECT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    EXPECT_EQ(found[i].shape.index, expected[i].shape.index) << i;
    EXPECT_EQ(found[i].body, expected[i].body);
    expectSame(found[i], expected[i]);
  }
  for (const CastHit& hit : found) worlds.onTriangles += hit.element != kNoElement;
  const CastHit first = closest(worlds.all);
  EXPECT_EQ(bool(first), !expected.empty());
  if (first && !expected.empty()) {
    EXPECT_EQ(first.shape, expected[0].shape);
    expectSame(first, expected[0]);
  }
  EXPECT_EQ(any(worlds.all), !expected.empty());
  return expected.size();
}

TEST_P(Queries, raysAsEachShapeAlone) {
  size_t hits = 0;
  for (int round = 0; round < 1200 && !HasFailure(); ++round) {
    const Ray r = ray();
    const QueryFilter f = filter();
    hits += expectAsAlone(
        worlds_, [&](const World& w) { return w.rayAll(r, f); }, [&](const World& w) { return w.rayClosest(r, f); },
        [&](const World& w) { return w.rayAny(r, f); });
  }
  EXPECT_GT(hits, 500u);
  EXPECT_GT(worlds_.onTriangles, 100u);
}

TEST_P(Queries, castsAsEachShapeAlone) {
  size_t hits = 0;
  for (int round = 0; round < 250 && !HasFailure(); ++round) {
    const Ray r = ray();
    const QueryFilter f = filter();
    const ShapeCast cast{convexGeometry(random_, random_.below(kConvexTypes)),
                         {r.origin, random_.rotation()},
                         r.direction * (r.length / length(r.direction))};
    hits += expectAsAlone(
        worlds_, [&](const World& w) { return w.castAll(cast, f); },
        [&](const World& w) { return w.castClosest(cast, f); }, [&](const World& w) { return w.castAny(cast, f); });
  }
  EXPECT_GT(hits, 300u);
  EXPECT_GT(worlds_.onTriangles, 30u);
}

TEST_P(Queries, overlapsAndPointsAsEachShapeAlone) {
  size_t hits = 0, holds = 0;
  for (int round = 0; round < 700 && !HasFailure(); ++round) {
    const QueryFilter f = filter();
    const Geometry g = convexGeometry(random_, random_.below(kConvexTypes));
    const Pose pose{center() + random_.point(6), random_.rotation()};
    std::vector<ShapeId> expected, expectedHolds;
    for (size_t i = 0; i < worlds_.single.size(); ++i) {
      if (worlds_.single[i]->overlapsAny(g, pose, f)) expected.push_back(worlds_.shapes[i]);
      if (!worlds_.single[i]->containing(pose.position, f).empty()) expectedHolds.push_back(worlds_.shapes[i]);
    }
    EXPECT_EQ(worlds_.all.overlaps(g, pose, f), expected);
    EXPECT_EQ(worlds_.all.overlapsAny(g, pose, f), !expected.empty());
    EXPECT_EQ(worlds_.all.containing(pose.position, f), expectedHolds);
    hits += expected.size();
    holds += expectedHolds.size();
  }
  EXPECT_GT(hits, 300u);
  EXPECT_GT(holds, 50u);
}

TEST_P(Queries, nearestAsEachShapeAlone) {
  size_t hits = 0;
  for (int round = 0; round < 200 && !HasFailure(); ++round) {
    const QueryFilter f = filter();
    const Geometry g = convexGeometry(random_, random_.below(kConvexTypes));
    const Pose pose{center() + random_.point(7), random_.rotation()};
    const float reach = round % 10 ? random_.size(0, 2) : 1000;
    std::vector<NearHit> expected;
    for (size_t i = 0; i < worlds_.single.size(); ++i) {
      NearHit hit = worlds_.single[i]->nearestClosest(g, pose, reach, f);
      if (!hit.shape) continue;
      hit.shape = worlds_.shapes[i];
      expected.push_back(hit);
    }
    std::stable_sort(expected.begin(), expected.end(),
                     [](const NearHit& a, const NearHit& b) { return a.distance < b.distance; });
    const std::vector<NearHit> found = worlds_.all.nearest(g, pose, reach, f);
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].shape, expected[i].shape);
      EXPECT_EQ(found[i].distance, expected[i].distance);
      EXPECT_EQ(found[i].onShape, expected[i].onShape);
      EXPECT_NEAR(length(found[i].normal), 1, 1e-5);
      // The points lie as far apart as said.
      EXPECT_NEAR(dot(found[i].onQuery - found[i].onShape, toDouble(found[i].normal)), found[i].distance, 2e-5);
    }
    const NearHit first = worlds_.all.nearestClosest(g, pose, reach, f);
    ASSERT_EQ(bool(first.shape), !expected.empty());
    if (first.shape) {
      EXPECT_EQ(first.shape, found[0].shape);
      EXPECT_EQ(first.distance, found[0].distance);
      EXPECT_EQ(first.element, found[0].element);
    }
    hits += found.size();
  }
  EXPECT_GT(hits, 500u);
}

TEST_P(Queries, hitsLieOnTheSurfaceAndNothingLiesBefore) {
  size_t hits = 0;
  for (int round = 0; round < 400; ++round) {
    const Ray r = ray();
    const CastHit hit = worlds_.all.rayClosest(r);
    if (!hit) continue;
    ++hits;
    const Vec3d d = toDouble(r.direction) * (1 / length(toDouble(r.direction)));
    EXPECT_LE(dot(toDouble(hit.normal), d), 1e-5);
    if (hit.distance == 0) continue;
    // A small ball at the hit touches the shape; one that goes along until shortly before it touches nothing.
    const Pose at{hit.position, {}};
    const std::vector<ShapeId> there = worlds_.all.overlaps(Sphere{2e-3f}, at);
    EXPECT_NE(std::find(there.begin(), there.end(), hit.shape), there.end()) << round;
    const Ray before{r.origin, r.direction, hit.distance * 0.99999f - 1e-3f};
    EXPECT_FALSE(before.length > 0 && worlds_.all.rayAny(before)) << round;
  }
  EXPECT_GT(hits, 150u);
}

TEST_P(Queries, aCastBallIsARayAgainstGrownShapes) {
  const float radius = 0.15f;
  QueryWorlds grown(7, 0, {}, 1);
  std::vector<size_t> same;
  for (size_t i = 0; i < worlds_.defs.size(); ++i) {
    BodyDef def = worlds_.defs[i];
    if (def.shapes.empty()) continue;
    Geometry& g = def.shapes[0].geometry;
    if (auto* s = std::get_if<Sphere>(&g)) s->radius += radius;
    if (auto* s = std::get_if<Capsule>(&g)) s->radius += radius;
    if (auto* s = std::get_if<Box>(&g)) s->rounding += radius;
    if (auto* s = std::get_if<Cylinder>(&g)) s->rounding += radius;
    if (auto* s = std::get_if<Cone>(&g)) s->rounding += radius;
    if (auto* s = std::get_if<Hull>(&g)) s->rounding += radius;
    if (std::holds_alternative<Ellipsoid>(g)) continue;
    grown.add(def);
    same.push_back(i);
  }
  size_t hits = 0;
  for (int round = 0; round < 300; ++round) {
    const Ray r = ray();
    const Vec3 motion = r.direction * (r.length / length(r.direction));
    for (size_t k = 0; k < same.size(); ++k) {
      const CastHit ball = worlds_.single[same[k]]->castClosest(Sphere{radius}, {r.origin, random_.rotation()}, motion);
      const CastHit point = grown.single[k]->rayClosest(r);
      if (bool(ball) != bool(point)) {
        // Only where it grazes.
        const CastHit slim = worlds_.single[same[k]]->castClosest(Sphere{radius * 0.99f}, {r.origin, {}}, motion);
        EXPECT_FALSE(slim) << same[k];
        continue;
      }
      if (!ball) continue;
      ++hits;
      EXPECT_NEAR(ball.distance, point.distance, 1e-4 + 2e-7 * point.distance) << same[k] % kConvexTypes;
    }
  }
  EXPECT_GT(hits, 60u);
}

INSTANTIATE_TEST_SUITE_P(Where, Queries, testing::Values(0, 1),
                         [](const auto& name) { return name.param == 0 ? "origin" : "far"; });

TEST(QueriesLaws, nearestIsSymmetric) {
  QueryRandom random(3);
  for (int round = 0; round < 400; ++round) {
    const Geometry a = convexGeometry(random, random.below(kConvexTypes));
    const Geometry b = convexGeometry(random, random.below(kConvexTypes));
    const Pose poseA{random.point(2), random.rotation()}, poseB{random.point(2), random.rotation()};
    World withA, withB;
    withA.create(BodyDef{.type = BodyType::Static, .position = poseA.position, .rotation = poseA.rotation, .shape = a});
    withB.create(BodyDef{.type = BodyType::Static, .position = poseB.position, .rotation = poseB.rotation, .shape = b});
    const NearHit ab = withB.nearestClosest(a, poseA, 10), ba = withA.nearestClosest(b, poseB, 10);
    ASSERT_TRUE(ab.shape && ba.shape);
    EXPECT_NEAR(ab.distance, ba.distance, 2e-4f) << round << " " << a.index() << " " << b.index();
    EXPECT_EQ(withB.overlapsAny(a, poseA), ab.distance <= 0);
    if (ab.distance > 0.01f) {
      EXPECT_GT(dot(ab.normal, -ba.normal), 0.99f);
      EXPECT_LT(length(ab.onQuery - ba.onShape), 0.05);
    }
  }
}

TEST(QueriesLaws, overlapIsACastThatStartsTouching) {
  QueryWorlds worlds(5, 88, {}, 5);
  QueryRandom random(6);
  int touching = 0;
  for (int round = 0; round < 500; ++round) {
    const Geometry g = convexGeometry(random, random.below(kConvexTypes));
    const Pose pose{random.point(5), random.rotation()};
    const Vec3 motion = random.direction();
    for (size_t i = 0; i < worlds.single.size(); i += 3) {
      const NearHit near = worlds.single[i]->nearestClosest(g, pose, 10);
      if (!near.shape || std::fabs(near.distance) < 1e-4f) continue;
      const CastHit hit = worlds.single[i]->castClosest(g, pose, motion);
      EXPECT_EQ(near.distance < 0, hit && hit.distance == 0) << near.distance;
      touching += near.distance < 0;
    }
  }
  EXPECT_GT(touching, 50);
}

}  // namespace
}  // namespace avbd
