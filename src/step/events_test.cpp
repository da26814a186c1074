// Events of a step: contacts that begin and end, triggers, hits, moves.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

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
BodyId addGround(World& world) { return world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}}); }
/// With this one shape; a trigger has no mass of its own.
BodyId addBody(World& world, BodyDef def, const ShapeDef& shape) {
  def.shapes.push_back(shape);
  if (def.type == BodyType::Dynamic && shape.isTrigger)
    def.massProperties = MassProperties{.mass = 1, .inertia = {1, 1, 1, 0, 0, 0}};
  return world.create(def);
}

// ---- Touching --------------------------------------------------------------------------------------------------

using Touch = std::array<uint32_t, 4>;
Touch touchOf(ShapeId a, ShapeId b) { return {a.index, a.generation, b.index, b.generation}; }

/// What begins and ends adds up to what the contacts say, whatever comes and goes.
void expectBooksBalance(int substeps, bool moveThem) {
  World world({.substeps = substeps});
  addGround(world);
  std::vector<BodyId> ids;
  const auto addThing = [&](int i) {
    return world.create(BodyDef{.position = {0.31 * (i % 3), 0.4 + 0.5 * (i / 3 % 7), 0.29 * (i % 2)},
                                .shape = i % 2 ? Geometry(Sphere{0.25f}) : Geometry(Box{0.3f, 0.2f, 0.25f}),
                                .material = {.restitution = 0.3f}});
  };
  for (int i = 0; i < 20; ++i) ids.push_back(addThing(i));
  std::set<Touch> open;
  size_t changes = 0;
  for (int step = 0; step < 200 && !testing::Test::HasFailure(); ++step) {
    if (moveThem && step % 7 == 3) {
      const size_t at = static_cast<size_t>(step) % ids.size();
      world.destroy(ids[at]);
      ids[at] = addThing(step);
    }
    if (moveThem && step % 7 == 5) {
      const BodyId id = ids[static_cast<size_t>(step * 5) % ids.size()];
      Pose pose = world.pose(id);
      if (step % 2) pose.position.y += 2;
      world.setPose(id, pose);
    }
    world.step(kDt);
    for (const TouchEvent& e : world.events().begins)
      EXPECT_TRUE(open.insert(touchOf(e.shapeA, e.shapeB)).second) << "began twice, step " << step;
    for (const TouchEvent& e : world.events().ends)
      EXPECT_EQ(open.erase(touchOf(e.shapeA, e.shapeB)), 1u) << "ended without a beginning, step " << step;
    changes += world.events().begins.size() + world.events().ends.size();
    std::set<Touch> touching;
    for (const Contact& c : world.contacts())
      for (int i = 0; i < c.pointCount; ++i)
        if (c.points[static_cast<size_t>(i)].normalForce > 0) touching.insert(touchOf(c.shapeA, c.shapeB));
    if (substeps == 1) {
      EXPECT_EQ(open, touching) << "step " << step;
    } else {
      for (const Touch& touch : touching) EXPECT_EQ(open.count(touch), 1u) << "step " << step;
    }
  }
  EXPECT_GT(changes, 30u);
}
TEST(Touching, BeginsAndEndsAddUpToTheContacts) { expectBooksBalance(1, false); }
TEST(Touching, AlsoWhereBodiesComeAndGo) { expectBooksBalance(1, true); }
TEST(Touching, AlsoWithSubsteps) { expectBooksBalance(3, true); }

TEST(Touching, ABouncingBallBeginsAndEndsWithEachBounce) {
  World world;
  addGround(world);
  const BodyId ball =
      world.create(BodyDef{.position = {0, 2, 0}, .shape = Sphere{0.3f}, .material = {.restitution = 0.8f}});
  int bounces = 0, begins = 0, ends = 0;
  for (int i = 0; i < 120; ++i) {
    const float before = world.velocity(ball).linear.y;
    world.step(kDt);
    if (before < 0 && world.velocity(ball).linear.y > 0) ++bounces;
    begins += static_cast<int>(world.events().begins.size()), ends += static_cast<int>(world.events().ends.size());
  }
  EXPECT_GE(bounces, 2);
  EXPECT_EQ(begins, bounces);
  EXPECT_EQ(ends, bounces);
}

TEST(Touching, WhatIsDestroyedEndsInTheNextStep) {
  World world;
  const BodyId ground = addGround(world);
  const BodyId box = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}});
  const ShapeId shape = world.shapes(box)[0], floor = world.shapes(ground)[0];
  EXPECT_EQ(countOver(world, 10).begins, 1);
  world.destroy(box);
  EXPECT_TRUE(world.events().ends.empty());
  world.step(kDt);
  ASSERT_EQ(world.events().ends.size(), 1u);
  const TouchEvent end = world.events().ends[0];
  EXPECT_EQ(end.shapeA, floor);
  EXPECT_EQ(end.shapeB, shape);
  EXPECT_EQ(end.bodyA, ground);
  EXPECT_EQ(end.bodyB, box);
  EXPECT_FALSE(world.isAlive(end.bodyB));
  world.step(kDt);
  EXPECT_TRUE(world.events().ends.empty());
}

TEST(Touching, ATeleportThatLeavesItWhereItIsEndsNothing) {
  World world;
  addGround(world);
  const BodyId box = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}});
  countOver(world, 10);
  world.setPose(box, world.pose(box));
  const Counts n = countOver(world, 3);
  EXPECT_EQ(n.begins + n.ends, 0);
  Pose away = world.pose(box);
  away.position.y += 5;
  world.setPose(box, away);
  world.step(kDt);
  EXPECT_EQ(world.events().ends.size(), 1u);
}

TEST(Touching, BothShapesMustWantTheEvents) {
  for (const bool wants : {true, false}) {
    World world;
    addGround(world);
    const BodyId box = addBody(world, BodyDef{.position = {0, 0.5, 0}}, {.geometry = Box{}, .contactEvents = wants});
    EXPECT_EQ(countOver(world, 10).begins, wants ? 1 : 0);
    world.destroy(box);
    EXPECT_EQ(countOver(world, 1).ends, wants ? 1 : 0);
  }
}

// ---- Triggers --------------------------------------------------------------------------------------------------

TEST(Trigger, SeesWhatFallsThroughAndDoesNotTouchIt) {
  World with, without;
  BodyId ball[2];
  World* worlds[2] = {&with, &without};
  for (int i = 0; i < 2; ++i) ball[i] = worlds[i]->create(BodyDef{.position = {0, 4, 0}, .shape = Sphere{0.25f}});
  const BodyId gate = addBody(with, BodyDef{.type = BodyType::Static, .position = {0, 2, 0}},
                              {.geometry = Box{1, 0.5f, 1}, .isTrigger = true});
  const ShapeId trigger = with.shapes(gate)[0];
  EXPECT_TRUE(with.isTrigger(trigger));
  int enters = 0, leaves = 0;
  for (int i = 0; i < 90; ++i) {
    const double at = with.pose(ball[0]).position.y;
    with.step(kDt), without.step(kDt);
    EXPECT_EQ(with.pose(ball[0]), without.pose(ball[1]));
    EXPECT_TRUE(with.contacts().empty());
    for (const TriggerEvent& e : with.events().enters) {
      ++enters;
      EXPECT_EQ(e.trigger, trigger);
      EXPECT_EQ(e.triggerBody, gate);
      EXPECT_EQ(e.visitorBody, ball[0]);
      EXPECT_LE(at, 2.75);
      EXPECT_GT(at, 2.5);
    }
    for (const TriggerEvent& e : with.events().leaves) {
      ++leaves;
      EXPECT_EQ(e.visitor, with.shapes(ball[0])[0]);
      EXPECT_LT(at, 1.25);
    }
  }
  EXPECT_EQ(enters, 1);
  EXPECT_EQ(leaves, 1);
  EXPECT_TRUE(with.events().begins.empty());
}

TEST(Trigger, SeesWhatMovesButNothingStaticAndNoOtherTrigger) {
  struct Case {
    BodyType trigger, visitor;
    bool visitorIsTrigger, seen;
  };
  for (const Case& c : {Case{BodyType::Static, BodyType::Dynamic, false, true},
                        Case{BodyType::Static, BodyType::Kinematic, false, true},
                        Case{BodyType::Kinematic, BodyType::Kinematic, false, true},
                        Case{BodyType::Dynamic, BodyType::Kinematic, false, true},
                        Case{BodyType::Dynamic, BodyType::Static, false, false},
                        Case{BodyType::Kinematic, BodyType::Static, false, false},
                        Case{BodyType::Static, BodyType::Dynamic, true, false}}) {
    World world({.gravity = {}});
    addBody(world, BodyDef{.type = c.trigger}, {.geometry = Box{}, .isTrigger = true});
    const BodyId b = addBody(world, BodyDef{.type = c.visitor, .position = {0.3, 0, 0}},
                             {.geometry = Sphere{}, .isTrigger = c.visitorIsTrigger});
    EXPECT_EQ(countOver(world, 3).enters, c.seen ? 1 : 0);
    EXPECT_EQ(countOver(world, 3).leaves, 0);
    world.destroy(b);
    EXPECT_EQ(countOver(world, 1).leaves, c.seen ? 1 : 0);
  }
}

// ---- Hits and moves --------------------------------------------------------------------------------------------

TEST(Hit, TellsSpeedAndImpulse) {
  for (const int substeps : {1, 4}) {
    World world({.substeps = substeps, .hitSpeed = 2});
    addGround(world);
    const BodyId ball =
        addBody(world, BodyDef{.position = {1, 1.5, 0}, .mass = 3}, {.geometry = Sphere{0.5f}, .hitEvents = true});
    std::vector<HitEvent> hits;
    double gained = 0;
    for (int i = 0; i < 120; ++i) {
      const float before = world.velocity(ball).linear.y;
      world.step(kDt);
      for (const HitEvent& hit : world.events().hits) hits.push_back(hit);
      if (!world.events().hits.empty()) gained = world.velocity(ball).linear.y - before + 9.81 * kDt;
    }
    ASSERT_EQ(hits.size(), 1u);
    const double speed = std::sqrt(2 * 9.81 * 1.0);
    EXPECT_NEAR(hits[0].speed, speed, 0.05 * speed);
    EXPECT_GT(gained, 0.1);
    EXPECT_NEAR(hits[0].impulse, 3 * gained, 1e-3 * 3 * gained);
    EXPECT_NEAR(hits[0].position.x, 1, 1e-3);
    EXPECT_NEAR(hits[0].position.y, 0, 0.05);
    EXPECT_NEAR(std::fabs(hits[0].normal.y), 1, 1e-6);
    EXPECT_EQ(hits[0].bodyB, ball);
  }
}

TEST(Hit, NotBelowTheSpeedAndNotWhereNobodyAsked) {
  for (const bool asked : {true, false}) {
    World world({.hitSpeed = asked ? 5.0f : 1.0f});
    addGround(world);
    addBody(world, BodyDef{.position = {1, 1.5, 0}, .mass = 3}, {.geometry = Sphere{0.5f}, .hitEvents = asked});
    EXPECT_EQ(countOver(world, 120).hits, 0);
  }
}

TEST(Move, ListsWhatMoved) {
  World world({.gravity = {}, .moveEvents = true});
  world.create(BodyDef{.position = {5, 0, 0}, .shape = Sphere{}});
  const BodyId mover =
      world.create(BodyDef{.linearVelocity = {1, 0, 0}, .shape = Box{0.1f, 0.2f, 0.3f}, .userData = 77});
  const BodyId turner = world.create(
      BodyDef{.type = BodyType::Kinematic, .position = {0, 9, 0}, .angularVelocity = {0, 1, 0}, .shape = Sphere{}});
  world.step(kDt);
  ASSERT_EQ(world.events().moves.size(), 2u);
  EXPECT_EQ(world.events().moves[0].body, mover);
  EXPECT_EQ(world.events().moves[0].pose, world.pose(mover));
  EXPECT_EQ(world.events().moves[0].userData, 77u);
  EXPECT_EQ(world.events().moves[1].body, turner);
  world.setVelocity(mover, {});
  world.step(kDt);
  EXPECT_EQ(world.events().moves.size(), 1u);
}

}  // namespace
}  // namespace avbd
