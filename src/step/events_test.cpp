// Events of a step: contacts that begin and end, triggers, moves.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "step/event_counts.h"

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

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

/// Of normal forces on a body in the last step, as an impulse.
double normalImpulse(const World& world, BodyId id) {
  double sum = 0;
  for (const Contact& c : world.contacts())
    for (int i = 0; i < c.pointCount; ++i)
      if (c.bodyA == id || c.bodyB == id) sum += double{c.points[static_cast<size_t>(i)].normalForce} * kDt;
  return sum;
}

TEST(Touching, TellsWhereAndHowHard) {
  for (const int substeps : {1, 4}) {
    World world({.substeps = substeps});
    const BodyId ground = addGround(world);
    const BodyId ball = world.create(BodyDef{.position = {2, 1.5, -1}, .shape = Sphere{0.5f}, .mass = 3});
    std::vector<TouchEvent> begins, ends;
    for (int i = 0; i < 60; ++i) {
      world.step(kDt);
      for (const TouchEvent& e : world.events().begins) {
        begins.push_back(e);
        EXPECT_GT(e.impulse, 0);
        EXPECT_NEAR(e.impulse, normalImpulse(world, ball), 1e-3 * e.impulse);
        EXPECT_EQ(world.contacts().at(0).touch, TouchPhase::Begins);
      }
    }
    ASSERT_GE(begins.size(), 1u);
    EXPECT_EQ(begins[0].bodyA, ground);
    EXPECT_LT(length(begins[0].position - Vec3d{2, 0, -1}), 0.05);
    EXPECT_NEAR(begins[0].normal.y, 1, 1e-6);
    EXPECT_EQ(world.contacts().at(0).touch, TouchPhase::Persists);
    EXPECT_NEAR(normalImpulse(world, ball), 3 * 9.81 * kDt, 1e-2);
    world.setVelocity(ball, {{0, 8, 0}, {}});
    for (int i = 0; i < 4; ++i) {
      world.step(kDt);
      for (const TouchEvent& e : world.events().ends) ends.push_back(e);
      for (const Contact& c : world.contacts()) EXPECT_EQ(c.touch, TouchPhase::None);
    }
    ASSERT_EQ(ends.size(), 1u);
    EXPECT_LT(length(ends[0].position - Vec3d{2, 0, -1}), 0.1);
    EXPECT_NEAR(ends[0].normal.y, 1, 1e-6);
    EXPECT_EQ(ends[0].impulse, 0);
  }
}

TEST(Touching, TheEndOfWhatIsDestroyedKnowsItsPlaceToo) {
  World world;
  addGround(world);
  const BodyId box = world.create(BodyDef{.position = {3, 0.5, 0}, .shape = Box{0.1f, 0.5f, 0.1f}});
  countOver(world, 10);
  world.destroy(box);
  world.step(kDt);
  ASSERT_EQ(world.events().ends.size(), 1u);
  EXPECT_LT(length(world.events().ends[0].position - Vec3d{3, 0, 0}), 0.2);
  EXPECT_NEAR(world.events().ends[0].normal.y, 1, 1e-6);
}

// The ball is out of reach again before the step is over.
TEST(Touching, ABounceWithinOneStepBeginsAndEnds) {
  int within = 0;
  for (int k = 0; k < 24; ++k) {
    World world({.gravity = {}, .substeps = 4});
    const BodyId floor = world.create(BodyDef{.type = BodyType::Static, .shape = Box{1, 0.1f, 1}});
    const BodyId ball =
        addBody(world, BodyDef{.position = {0, 0.9 + 0.02 * k, 0}, .linearVelocity = {0, -25, 0}, .mass = 2},
                {.geometry = Sphere{0.2f}, .material = {.restitution = 1}, .hitEvents = true});
    Counts n;
    for (int i = 0; i < 6; ++i) {
      const Counts now = countOver(world, 1);
      if (now.begins && now.ends) ++within;
      n.begins += now.begins, n.ends += now.ends, n.hits += now.hits;
      for (const TouchEvent& e : world.events().begins) {
        EXPECT_EQ(e.bodyA, floor);
        EXPECT_EQ(e.bodyB, ball);
        EXPECT_NEAR(e.impulse, 2 * 2 * 25, 1);
        EXPECT_NEAR(e.position.y, 0.1, 0.15);
        EXPECT_NEAR(world.events().hits.at(0).impulse, e.impulse, 1e-3);
      }
      for (const TouchEvent& e : world.events().ends) EXPECT_NEAR(e.normal.y, 1, 1e-6);
    }
    EXPECT_EQ(n.begins, 1) << k;
    EXPECT_EQ(n.ends, 1) << k;
    EXPECT_EQ(n.hits, 1) << k;
    EXPECT_NEAR(world.velocity(ball).linear.y, 25, 0.3);
  }
  EXPECT_GT(within, 3);
}

TEST(Touching, WishesMayChangeInTheMiddle) {
  World world;
  addGround(world);
  const BodyId box = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}});
  const ShapeId shape = world.shapes(box)[0];
  EXPECT_EQ(countOver(world, 10).begins, 1);
  world.setContactEvents(shape, false);
  EXPECT_FALSE(world.contactEvents(shape));
  Counts n = countOver(world, 3);
  EXPECT_EQ(n.ends, 1);
  EXPECT_EQ(n.begins, 0);
  world.setContactEvents(shape, true);
  n = countOver(world, 3);
  EXPECT_EQ(n.ends, 0);
  EXPECT_EQ(n.begins, 1);
  // Both at once, and of what is moved or gone by then.
  world.setContactEvents(shape, false), world.setContactEvents(shape, true);
  n = countOver(world, 3);
  EXPECT_EQ(n.begins + n.ends, 0);
  world.setContactEvents(shape, false);
  world.setPose(box, world.pose(box));
  EXPECT_EQ(countOver(world, 3).ends, 1);
  world.setContactEvents(shape, true);
  EXPECT_EQ(countOver(world, 3).begins, 1);
  world.setContactEvents(shape, false);
  world.destroy(box);
  EXPECT_EQ(countOver(world, 3).ends, 1);
}

TEST(Touching, ContactsMayBeReadIntoTheSameArray) {
  World world;
  addGround(world);
  for (int i = 0; i < 5; ++i) world.create(BodyDef{.position = {2.0 * i, 0.5, 0}, .shape = Box{}});
  countOver(world, 3);
  std::vector<Contact> contacts;
  world.getContacts(contacts);
  ASSERT_EQ(contacts.size(), 5u);
  const Contact* memory = contacts.data();
  world.step(kDt);
  world.getContacts(contacts);
  ASSERT_EQ(contacts.size(), 5u);
  EXPECT_EQ(contacts.data(), memory);
  EXPECT_EQ(contacts[3].shapeB, world.contacts()[3].shapeB);
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

TEST(Trigger, SeesAVisitOfLessThanAStep) {
  int within = 0;
  for (int k = 0; k < 20; ++k) {
    World world({.gravity = {}, .substeps = 4});
    addBody(world, BodyDef{.type = BodyType::Static}, {.geometry = Box{1, 0.1f, 1}, .isTrigger = true});
    world.create(BodyDef{.position = {0, 1.5 + 0.05 * k, 0}, .linearVelocity = {0, -60, 0}, .shape = Sphere{0.1f}});
    Counts n;
    for (int i = 0; i < 6; ++i) {
      const Counts now = countOver(world, 1);
      if (now.enters && now.leaves) ++within;
      n.enters += now.enters, n.leaves += now.leaves;
    }
    EXPECT_EQ(n.enters, 1) << k;
    EXPECT_EQ(n.leaves, 1) << k;
  }
  EXPECT_GT(within, 3);
}

TEST(Trigger, DoesNotChangeHowItsBodyMoves) {
  for (const float size : {0.01f, 3.0f}) {
    World with, without;
    BodyId ids[2][3];
    World* worlds[2] = {&with, &without};
    for (int w = 0; w < 2; ++w) {
      worlds[w]->create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
      for (int i = 0; i < 3; ++i) {
        BodyDef def{.position = {0.2 * i, 0.6 + 1.1 * i, 0},
                    .linearVelocity = {0, -20, 0},
                    .angularVelocity = {9, 0, 3},
                    .shape = Box{0.5f, 0.5f, 0.4f}};
        ids[w][i] = worlds[w]->create(def);
      }
      if (w == 0)
        for (const BodyId id : ids[0]) with.create(id, {.geometry = Sphere{size}, .isTrigger = true});
    }
    for (int i = 0; i < 60; ++i) {
      with.step(kDt), without.step(kDt);
      for (int k = 0; k < 3; ++k) ASSERT_EQ(with.pose(ids[0][k]), without.pose(ids[1][k])) << size << ", step " << i;
    }
  }
}

// ---- Moves -----------------------------------------------------------------------------------------------------

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
