// Contacts and events of soft bodies: where they are, what they carry, one event for a whole body.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "api/soft_cases.h"

namespace avbd {
namespace {

std::shared_ptr<const SoftMeshData> cube() { return makeTetBox({0.25f, 0.25f, 0.25f}, 3, 3, 3); }
SoftDef stiffCube(double y, bool turned = false) {
  return {.mesh = cube(),
          .pose = {{turned ? 0.03 : 0.0, y, turned ? 0.02 : 0.0}, turned ? Quat{0.96f, 0, 0.28f, 0} : Quat{}},
          .material = {.youngsModulus = 1e6f}};
}

constexpr double kWeight = 125 * 9.81;

/// What two things are: bodies, or soft bodies with all their particles.
using Thing = std::pair<uint32_t, uint32_t>;
Thing thingOf(SoftId soft, ShapeId shape) {
  return soft ? Thing{soft.index | 1u << 31, soft.generation} : Thing{shape.index, shape.generation};
}
template <class T>
std::set<Thing> thingsOf(const T& x) {
  return {thingOf(x.softA, x.shapeA), thingOf(x.softB, x.shapeB)};
}

/// Force on a soft body of all contacts with what is not itself [N].
Vec3d forceOn(const World& world, SoftId soft, SoftId by) {
  Vec3d sum;
  for (const Contact& c : world.contacts()) {
    const bool isB = c.softB == soft && c.softA == by, isA = c.softA == soft && c.softB == by;
    if (!isA && !isB) continue;
    for (int i = 0; i < c.pointCount; ++i) {
      const ContactPoint& p = c.points[static_cast<size_t>(i)];
      const Vec3 force = c.normal * p.normalForce + p.frictionForce;
      sum = sum + toDouble(isB ? force : -force);
    }
  }
  return sum;
}

struct Counts {
  int begins = 0, ends = 0, enters = 0, leaves = 0, hits = 0;
};
Counts countOver(World& world, int steps) {
  Counts n;
  for (int i = 0; i < steps; ++i) {
    world.step(kDt);
    const Events& e = world.events();
    n.begins += static_cast<int>(e.begins.size()), n.ends += static_cast<int>(e.ends.size());
    n.enters += static_cast<int>(e.enters.size()), n.leaves += static_cast<int>(e.leaves.size());
    n.hits += static_cast<int>(e.hits.size());
  }
  return n;
}

struct TwoOnTheGround : testing::Test {
  explicit TwoOnTheGround(const WorldDef& def = {}) : world(def) {}
  World world;
  BodyId ground = world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  SoftId below = world.create(stiffCube(0.27)), above = world.create(stiffCube(0.85, true));
};

TEST_F(TwoOnTheGround, ContactsTellWhatOneCarries) {
  run(world, 120);
  EXPECT_NEAR(forceOn(world, above, below).y, kWeight, 0.01 * kWeight);
  EXPECT_NEAR(forceOn(world, below, above).y, -kWeight, 0.01 * kWeight);
  EXPECT_NEAR(forceOn(world, below, SoftId{}).y, 2 * kWeight, 0.01 * kWeight);
  EXPECT_NEAR(length(forceOn(world, above, below) - Vec3d{0, kWeight, 0}), 0, 0.02 * kWeight);
  int between = 0;
  for (const Contact& c : world.contacts()) {
    EXPECT_LT(c.shapeA, c.shapeB);
    EXPECT_EQ(world.body(c.shapeA), c.bodyA);
    EXPECT_EQ(world.body(c.shapeB), c.bodyB);
    for (const auto& [body, soft] : {std::pair{c.bodyA, c.softA}, std::pair{c.bodyB, c.softB}})
      EXPECT_EQ(world.softBody(body), soft);
    if (!c.softA || !c.softB || !(c.points[0].normalForce > 0)) continue;
    ++between;
    EXPECT_EQ(c.pointCount, 1);
    EXPECT_EQ(c.touch, TouchPhase::Persists);
    EXPECT_NEAR(length(c.normal), 1, 1e-5);
    EXPECT_GT(std::fabs(c.normal.y), 0.9f);
    EXPECT_NEAR(c.points[0].position.y, 0.52, 0.02);
    EXPECT_LT(std::fabs(c.points[0].separation), 0.005f);
    if (c.elementA != kNoElement) EXPECT_LT(c.elementA, world.mesh(c.softA)->surface().size());
    if (c.elementB != kNoElement) EXPECT_LT(c.elementB, world.mesh(c.softB)->surface().size());
  }
  EXPECT_GT(between, 3);
}

/// Begins and ends make a book of what touches, and no contact that carries is missing in it.
void expectBooksBalance(int substeps) {
  World world({.substeps = substeps});
  world.create(BodyDef{.type = BodyType::Static, .position = {0, -1, 0}, .shape = Box{5, 1, 5}});
  for (int i = 0; i < 4; ++i) {
    world.create(stiffCube(0.3 + 1.1 * i, i % 2));
    world.create(BodyDef{.position = {0.1 * i, 0.9 + 1.1 * i, 0}, .shape = Sphere{0.2f}});
  }
  world.create(SoftDef{.mesh = makeClothGrid(1, 1, 6, 6), .pose = {{0, 5, 0}, {}}});
  std::set<std::set<Thing>> open;
  int most = 0, changes = 0;
  for (int step = 0; step < 150 && !testing::Test::HasFailure(); ++step) {
    if (step == 70) world.destroy(world.softBodies()[1]);
    if (step == 80) world.create(stiffCube(3));
    world.step(kDt);
    std::set<std::set<Thing>> begins;
    for (const TouchEvent& e : world.events().begins) {
      EXPECT_TRUE(begins.insert(thingsOf(e)).second) << "two begins at once, step " << step;
      EXPECT_TRUE(open.insert(thingsOf(e)).second || true);
      EXPECT_NEAR(length(e.normal), 1, 1e-5);
      EXPECT_GT(e.impulse, 0);
    }
    for (const TouchEvent& e : world.events().ends)
      EXPECT_EQ(open.erase(thingsOf(e)), 1u) << "ended without a beginning, step " << step;
    changes += static_cast<int>(world.events().begins.size() + world.events().ends.size());
    for (const Contact& c : world.contacts())
      for (int i = 0; i < c.pointCount; ++i)
        if (c.points[static_cast<size_t>(i)].normalForce > 0) {
          EXPECT_EQ(open.count(thingsOf(c)), 1u) << "step " << step;
          EXPECT_EQ(c.touch, begins.count(thingsOf(c)) ? TouchPhase::Begins : TouchPhase::Persists) << "step " << step;
        }
    most = std::max(most, static_cast<int>(open.size()));
  }
  EXPECT_GT(most, 6);
  EXPECT_GT(changes, 10);
}
TEST(SoftEvents, BooksBalance) { expectBooksBalance(1); }
TEST(SoftEvents, BooksBalanceOverSubsteps) { expectBooksBalance(3); }

TEST_F(TwoOnTheGround, OneBeginForEachPair) {
  const Counts n = countOver(world, 120);
  EXPECT_EQ(n.begins - n.ends, 2);
  EXPECT_LE(n.begins, 6);
}

TEST_F(TwoOnTheGround, WhatIsGoneEnds) {
  run(world, 120);
  world.destroy(below);
  run(world, 1);
  ASSERT_EQ(world.events().ends.size(), 2u);
  for (const TouchEvent& e : world.events().ends) EXPECT_TRUE(e.softA == below || e.softB == below);
  EXPECT_TRUE(world.contacts().empty() || world.contacts()[0].bodyA == ground);
}

TEST_F(TwoOnTheGround, SleepersKeepTheirContacts) {
  run(world, 60);
  Counts n;
  int steps = 0;
  for (; world.isAwake(world.particles(above)[0]) && steps < 400; ++steps) n = countOver(world, 1);
  ASSERT_FALSE(world.isAwake(world.particles(above)[0]));
  n = countOver(world, 30);
  EXPECT_EQ(n.begins + n.ends, 0);
  EXPECT_NEAR(forceOn(world, above, below).y, kWeight, 0.02 * kWeight);
  for (const Contact& c : world.contacts())
    if (c.points[0].normalForce > 0) EXPECT_EQ(c.touch, TouchPhase::Persists);
  world.wakeAll();
  n = countOver(world, 5);
  EXPECT_EQ(n.begins + n.ends, 0);
}

TEST_F(TwoOnTheGround, WhoDoesNotAskIsNotTold) {
  world.setContactEvents(above, false);
  EXPECT_FALSE(world.contactEvents(above));
  EXPECT_TRUE(world.contactEvents(below));
  countOver(world, 100);
  for (const Contact& c : world.contacts())
    if (c.softA && c.softB && c.points[0].normalForce > 0) EXPECT_EQ(c.touch, TouchPhase::Persists);
  world.setContactEvents(above, true);
  run(world, 1);
  ASSERT_EQ(world.events().begins.size(), 1u);
  const std::set<SoftId> both{world.events().begins[0].softA, world.events().begins[0].softB};
  EXPECT_EQ(both, (std::set<SoftId>{below, above}));
  world.setContactEvents(below, false);
  run(world, 1);
  EXPECT_EQ(world.events().ends.size(), 2u);  // with the other, and with the ground
  EXPECT_TRUE(world.events().begins.empty());
}

TEST(SoftEvents, DefinitionsAskOrDoNot) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  SoftDef def = stiffCube(0.3);
  def.contactEvents = false, def.hitEvents = true;
  const SoftId soft = world.create(def);
  EXPECT_FALSE(world.contactEvents(soft));
  EXPECT_TRUE(world.hitEvents(soft));
  const Counts n = countOver(world, 60);
  EXPECT_EQ(n.begins + n.ends, 0);
}

TEST(SoftEvents, AHitIsOne) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const SoftId below = world.create(stiffCube(0.26));
  run(world, 60);
  SoftDef def = stiffCube(1.2, true);
  def.velocity.linear = {0, -4, 0};
  def.hitEvents = true;
  const SoftId above = world.create(def);
  std::vector<HitEvent> hits;
  for (int i = 0; i < 20; ++i) {
    world.step(kDt);
    for (const HitEvent& hit : world.events().hits) hits.push_back(hit);
  }
  ASSERT_GE(hits.size(), 1u);
  EXPECT_LE(hits.size(), 4u);
  EXPECT_EQ((std::set<SoftId>{hits[0].softA, hits[0].softB}), (std::set<SoftId>{below, above}));
  EXPECT_NEAR(hits[0].speed, 4.5, 1);
  EXPECT_GT(hits[0].impulse, 50);
}

TEST(SoftEvents, ATriggerSeesAWholeBody) {
  World world(WorldDef{.gravity = {}});
  BodyDef gate{.type = BodyType::Static};
  gate.shapes.push_back({.geometry = Box{0.2f, 2, 2}, .isTrigger = true});
  const BodyId trigger = world.create(gate);
  SoftDef def = stiffCube(0);
  def.pose.position.x = -1, def.velocity.linear = {2, 0, 0};
  const SoftId soft = world.create(def);
  int enters = 0, leaves = 0;
  for (int i = 0; i < 90; ++i) {
    world.step(kDt);
    for (const TriggerEvent& e : world.events().enters) {
      ++enters;
      EXPECT_EQ(e.visitorSoft, soft);
      EXPECT_EQ(e.triggerBody, trigger);
      EXPECT_EQ(world.softBody(e.visitorBody), soft);
    }
    leaves += static_cast<int>(world.events().leaves.size());
    if (i == 30) EXPECT_EQ(enters - leaves, 1);
  }
  EXPECT_EQ(enters, 1);
  EXPECT_EQ(leaves, 1);
}

TEST(SoftEvents, ASleeperStaysInItsTrigger) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  BodyDef room{.type = BodyType::Static};
  room.shapes.push_back({.geometry = Box{1, 1, 1}, .isTrigger = true});
  world.create(room);
  const SoftId soft = world.create(stiffCube(0.27));
  Counts n = countOver(world, 300);
  ASSERT_FALSE(world.isAwake(world.particles(soft)[0]));
  EXPECT_EQ(n.enters, 1);
  EXPECT_EQ(n.leaves, 0);
  world.wakeAll();
  n = countOver(world, 5);
  EXPECT_EQ(n.enters + n.leaves, 0);
  world.destroy(soft);
  EXPECT_EQ(countOver(world, 1).leaves, 1);
}

/// A face of cloth between its points lies on a small ball.
TEST(SoftEvents, AFaceOnAShape) {
  World world;
  const BodyId ball = world.create(BodyDef{.type = BodyType::Static, .shape = Sphere{0.05f}});
  const SoftId cloth =
      world.create(SoftDef{.mesh = makeClothGrid(0.4f, 0.4f, 1, 1), .pose = {{-0.04, 0.08, 0.07}, {}}});
  int touches = 0;
  for (int i = 0; i < 20; ++i) {
    world.step(kDt);
    for (const Contact& c : world.contacts()) {
      if (!(c.points[0].normalForce > 0)) continue;
      ++touches;
      EXPECT_TRUE((c.bodyA == ball && c.softB == cloth && c.normal.y > 0) ||
                  (c.bodyB == ball && c.softA == cloth && c.normal.y < 0));
      EXPECT_NEAR(length(c.points[0].position), 0.05, 0.004);
      EXPECT_LT(c.bodyA == ball ? c.elementB : c.elementA, 2u);
    }
  }
  EXPECT_GT(touches, 5);
}

TEST(SoftEvents, ABodyTouchesItself) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const SoftId cloth = world.create(SoftDef{.mesh = makeClothGrid(1, 0.3f, 20, 6), .pose = {{0, 0.011, 0}, {}}});
  foldOver(world, cloth, 0.06);
  int within = 0, begins = 0;
  for (int i = 0; i < 60; ++i) {
    world.step(kDt);
    for (const TouchEvent& e : world.events().begins) {
      ++begins;
      within += e.softA == cloth && e.softB == cloth;
    }
  }
  EXPECT_GE(within, 1);
  EXPECT_LE(begins, 6);
  int carry = 0;
  for (const Contact& c : world.contacts()) {
    if (c.softA != cloth || c.softB != cloth || !(c.points[0].normalForce > 0)) continue;
    ++carry;
    EXPECT_EQ(c.touch, TouchPhase::Persists);
    EXPECT_NE(c.bodyA, c.bodyB);
  }
  EXPECT_GT(carry, 10);
}

World pile(const WorldDef& def) {
  World world(def);
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  for (int i = 0; i < 3; ++i) world.create(stiffCube(0.3 + 0.56 * i, i % 2));
  world.create(SoftDef{.mesh = makeClothGrid(1, 1, 5, 5), .pose = {{0, 2, 0}, {}}});
  return world;
}

/// All that is told, as numbers.
std::vector<double> toldOver(World& world, int steps) {
  std::vector<double> all;
  for (int i = 0; i < steps; ++i) {
    world.step(kDt);
    for (const TouchEvent& e : world.events().begins)
      all.insert(all.end(), {double(e.shapeA.index), double(e.shapeB.index), e.position.x, double{e.impulse}});
    for (const TouchEvent& e : world.events().ends)
      all.insert(all.end(), {double(e.shapeA.index), double(e.shapeB.index), e.position.x});
    for (const Contact& c : world.contacts())
      for (int k = 0; k < c.pointCount; ++k) {
        const ContactPoint& p = c.points[static_cast<size_t>(k)];
        all.insert(all.end(), {double(c.shapeA.index), double(c.shapeB.index), double(c.touch), p.position.x,
                               double{p.normalForce}, double{p.frictionForce.x}, double(p.feature)});
      }
  }
  return all;
}

TEST(SoftEvents, TheSameForAllWidthsAndWorkers) {
  World alone = pile({.substeps = 2});
  const std::vector<double> expected = toldOver(alone, 60);
  for (const int width : {4, 16})
    for (const int workers : {2, 5}) {
      World world = pile({.workers = workers, .substeps = 2, .simdWidth = width});
      EXPECT_EQ(toldOver(world, 60), expected) << width << " lanes, " << workers << " workers";
    }
}

TEST(SoftEvents, GoOnFromSnapshots) {
  World world = pile({});
  run(world, 25);
  std::vector<std::byte> bytes;
  world.save(bytes);
  const size_t contacts = world.contacts().size();
  const std::vector<double> expected = toldOver(world, 40);
  World other = pile({});
  for (World* again : {&world, &other}) {
    again->restore(bytes);
    EXPECT_EQ(again->contacts().size(), contacts);
    EXPECT_EQ(toldOver(*again, 40), expected);
  }
}

/// Over substeps the forces are means: what is told carries the weight.
struct TwoOnTheGroundInSubsteps : TwoOnTheGround {
  TwoOnTheGroundInSubsteps() : TwoOnTheGround(WorldDef{.substeps = 4}) {}
};
TEST_F(TwoOnTheGroundInSubsteps, ContactsTellMeans) {
  run(world, 120);
  EXPECT_NEAR(forceOn(world, above, below).y, kWeight, 0.01 * kWeight);
}

/// A contact of what has been put elsewhere is none, as of shapes.
TEST_F(TwoOnTheGround, ATeleportEndsContacts) {
  run(world, 60);
  ASSERT_GT(forceOn(world, above, below).y, 1);
  for (const BodyId id : world.particles(above)) {
    Pose pose = world.pose(id);
    pose.position.y += 3;
    world.setPose(id, pose);
  }
  EXPECT_EQ(forceOn(world, above, below), Vec3d{});
  run(world, 1);
  EXPECT_EQ(world.events().ends.size(), 1u);
}

}  // namespace
}  // namespace avbd
