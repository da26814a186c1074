// Sleep: what falls asleep and when, what a sleeping world still tells, and that it costs nobody a bit.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;
const Box kBox{0.5f, 0.5f, 0.5f};

BodyId addGround(World& world) { return world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}}); }

std::vector<BodyId> addTower(World& world, Vec3d at, int height) {
  std::vector<BodyId> ids;
  for (int i = 0; i < height; ++i)
    ids.push_back(world.create(BodyDef{.position = at + Vec3d{0, 0.5 + i, 0}, .shape = kBox}));
  return ids;
}

void run(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(kDt);
}

bool anyAwake(const World& world, const std::vector<BodyId>& ids) {
  return std::any_of(ids.begin(), ids.end(), [&](BodyId id) { return world.isAwake(id); });
}
bool allAwake(const World& world, const std::vector<BodyId>& ids) {
  return std::all_of(ids.begin(), ids.end(), [&](BodyId id) { return world.isAwake(id); });
}

TEST(Sleep, ATowerAtRestFallsAsleepOnceAndStandsWhereItStood) {
  for (const int substeps : {1, 3}) {
    World world({.substeps = substeps});
    const BodyId ground = addGround(world);
    const std::vector<BodyId> tower = addTower(world, {}, 4);
    EXPECT_TRUE(allAwake(world, tower));
    EXPECT_FALSE(world.isAwake(ground));
    run(world, 25);
    EXPECT_TRUE(allAwake(world, tower)) << "not before its time";
    std::vector<BodyId> slept;
    for (int i = 0; i < 120; ++i) {
      world.step(kDt);
      const Events& e = world.events();
      slept.insert(slept.end(), e.sleeps.begin(), e.sleeps.end());
      EXPECT_TRUE(e.wakes.empty() && e.ends.empty());
    }
    EXPECT_EQ(slept, tower);
    EXPECT_FALSE(anyAwake(world, tower));
    EXPECT_EQ(world.report().bodies, 0u);
    EXPECT_EQ(world.report().asleep, 4u);
    EXPECT_EQ(world.report().pairs, 0u);
    const Pose before = world.pose(tower[3]);
    const uint64_t hash = world.hash();
    run(world, 10);
    EXPECT_EQ(world.hash(), hash);
    EXPECT_EQ(world.pose(tower[3]), before);
    EXPECT_EQ(world.velocity(tower[3]), Velocity{});
  }
}

TEST(Sleep, ContactsOfSleepersAreStillTold) {
  World world;
  addGround(world);
  const std::vector<BodyId> tower = addTower(world, {}, 3);
  run(world, 200);
  ASSERT_FALSE(anyAwake(world, tower));
  const std::vector<BodyId> other = addTower(world, {5, 0, 0}, 2);
  run(world, 20);
  const std::vector<Contact> contacts = world.contacts();
  ASSERT_EQ(contacts.size(), 5u);
  double onGround = 0;
  for (size_t i = 0; i < contacts.size(); ++i) {
    if (i > 0)
      EXPECT_LT(std::make_pair(contacts[i - 1].shapeA, contacts[i - 1].shapeB),
                std::make_pair(contacts[i].shapeA, contacts[i].shapeB));
    if (contacts[i].bodyB != tower[0] && contacts[i].bodyA != tower[0]) continue;
    EXPECT_EQ(contacts[i].touch, TouchPhase::Persists);
    if (contacts[i].bodyB == tower[1]) continue;
    for (int k = 0; k < contacts[i].pointCount; ++k)
      onGround += static_cast<double>(contacts[i].points[static_cast<size_t>(k)].normalForce);
  }
  EXPECT_NEAR(onGround, 3000 * 9.81, 300);
}

TEST(Sleep, WhatMovesSlowlyOrMayNotStaysAwake) {
  World world({.gravity = {}});
  const BodyId slider = world.create(BodyDef{.linearVelocity = {0.03f, 0, 0}, .shape = kBox});
  const BodyId turner = world.create(BodyDef{.position = {5, 0, 0}, .angularVelocity = {0, 0.03f, 0}, .shape = kBox});
  const BodyId still = world.create(BodyDef{.position = {9, 0, 0}, .shape = kBox});
  const BodyId restless = world.create(BodyDef{.position = {12, 0, 0}, .shape = kBox, .canSleep = false});
  run(world, 100);
  EXPECT_TRUE(allAwake(world, {slider, turner, restless}));
  EXPECT_FALSE(world.isAwake(still));
  world.setCanSleep(restless, true);
  EXPECT_TRUE(world.canSleep(restless));
  run(world, 2);
  EXPECT_FALSE(world.isAwake(restless)) << "it has rested all the time";

  World wakeful({.sleep = false});
  addGround(wakeful);
  const std::vector<BodyId> tower = addTower(wakeful, {}, 1);
  run(wakeful, 100);
  EXPECT_TRUE(allAwake(wakeful, tower));
}

TEST(Sleep, ASlowRollOverGroundIsNoRest) {
  World world;
  addGround(world);
  const BodyId ball = world.create(BodyDef{.position = {0, 0.5, 0},
                                           .linearVelocity = {0.04f, 0, 0},
                                           .angularVelocity = {0, 0, -0.08f},
                                           .shape = Sphere{0.5f}});
  run(world, 200);
  EXPECT_TRUE(world.isAwake(ball));
  EXPECT_GT(world.velocity(ball).linear.x, 0.03f);
}

TEST(Sleep, ANeighbourThatMovesKeepsAllAwake) {
  World world;
  addGround(world);
  const BodyId plate = world.create(BodyDef{.position = {0, 0.1, 0}, .shape = Box{2, 0.1f, 2}, .density = 5000});
  const BodyId top = world.create(BodyDef{
      .position = {0, 0.3, 0}, .angularVelocity = {0, 20, 0}, .shape = Sphere{0.1f}, .material = {.friction = 0}});
  run(world, 100);
  EXPECT_TRUE(allAwake(world, {plate, top}));

  // So does what moves by itself, however slowly.
  const BodyId lift = world.create(BodyDef{.type = BodyType::Kinematic,
                                           .position = {9, 0.1, 0},
                                           .linearVelocity = {0, 0.001f, 0},
                                           .shape = Box{1, 0.1f, 1}});
  const BodyId load = world.create(BodyDef{.position = {9, 0.7, 0}, .shape = kBox});
  run(world, 100);
  EXPECT_TRUE(allAwake(world, {lift, load}));
  world.setVelocity(lift, {});
  run(world, 60);
  EXPECT_FALSE(anyAwake(world, {lift, load}));
  world.setVelocity(lift, {{0, 0.5f, 0}, {}});
  EXPECT_TRUE(allAwake(world, {lift, load}));
  const double from = world.pose(load).position.y;
  run(world, 60);
  EXPECT_NEAR(world.pose(load).position.y, from + 0.5, 0.02);
}

TEST(Sleep, JointsMakeOneIsland) {
  World world({.gravity = {}});
  const BodyId a = world.create(BodyDef{.shape = kBox});
  const BodyId b = world.create(BodyDef{.position = {5, 0, 0}, .shape = kBox});
  const BodyId c = world.create(BodyDef{.position = {10, 0, 0}, .shape = kBox});
  world.create(HingeJoint{.bodyA = a, .bodyB = b, .frameA = {{2.5, 0, 0}}, .frameB = {{-2.5, 0, 0}}});
  run(world, 40);
  ASSERT_FALSE(anyAwake(world, {a, b, c}));
  world.wake(b);
  EXPECT_TRUE(allAwake(world, {a, b}));
  EXPECT_FALSE(world.isAwake(c));
  world.step(kDt);
  EXPECT_EQ(world.events().wakes, (std::vector<BodyId>{a, b}));
  EXPECT_EQ(world.report().joints, 1u);
  EXPECT_EQ(world.report().bodies, 2u);
  EXPECT_EQ(world.report().asleep, 1u);
}

TEST(Sleep, PutToSleepTakesTheWholeIslandAndOnlyIt) {
  World world;
  const BodyId ground = addGround(world);
  const std::vector<BodyId> tower = addTower(world, {}, 3), other = addTower(world, {5, 0, 0}, 2);
  run(world, 5);
  world.putToSleep(tower[1]);
  EXPECT_FALSE(anyAwake(world, tower));
  EXPECT_TRUE(allAwake(world, other));
  EXPECT_EQ(world.velocity(tower[2]), Velocity{});
  world.step(kDt);
  EXPECT_EQ(world.events().sleeps, tower);
  EXPECT_EQ(world.contacts().size(), 5u);
  EXPECT_THROW(world.putToSleep(ground), Error);
  // Between steps it is as if nothing had been.
  world.wake(tower[0]);
  world.putToSleep(tower[2]);
  world.step(kDt);
  EXPECT_TRUE(world.events().sleeps.empty() && world.events().wakes.empty());
  run(world, 60);
  EXPECT_FALSE(anyAwake(world, tower));
}

TEST(Sleep, BadSettingsAreRefusedByName) {
  const auto refused = [](const WorldDef& def, const char* field) {
    try {
      World world(def);
      ADD_FAILURE() << field;
    } catch (const Error& error) {
      EXPECT_EQ(error.definition(), "WorldDef");
      EXPECT_EQ(error.field(), field);
    }
  };
  for (const float bad : {-1.0f, std::nanf(""), INFINITY}) {
    refused({.sleepTime = bad}, "sleepTime");
    refused({.sleepSpeed = bad}, "sleepSpeed");
  }
}

// What sleeps far away is as if it were not there: the same bits for all others, whatever it does.
TEST(Sleep, AnUnrelatedSleeperChangesNoBit) {
  World plain, with;
  std::vector<BodyId> ids, same;
  for (World* world : {&plain, &with}) {
    addGround(*world);
    std::vector<BodyId>& list = world == &plain ? ids : same;
    for (int i = 0; i < 12; ++i)
      list.push_back(world->create(BodyDef{.position = {0.3 * (i % 3), 0.6 + 1.05 * (i / 3), 0.2 * (i % 2)},
                                           .angularVelocity = {0.3f, 0, 0.2f},
                                           .shape = i % 2 ? Geometry(Sphere{0.5f}) : Geometry(kBox)}));
  }
  const std::vector<BodyId> far = addTower(with, {1000, 0, 0}, 3);
  with.step(kDt), plain.step(kDt);
  with.putToSleep(far[0]);
  for (int i = 0; i < 150; ++i) {
    if (i == 100) with.wake(far[0]);
    plain.step(kDt), with.step(kDt);
    for (size_t k = 0; k < ids.size(); ++k) {
      ASSERT_EQ(plain.pose(ids[k]), with.pose(same[k])) << i;
      ASSERT_EQ(plain.velocity(ids[k]), with.velocity(same[k])) << i;
    }
  }
}

TEST(Sleep, VisitorsOfATriggerSleepInIt) {
  World world;
  addGround(world);
  world.create(BodyDef{
      .type = BodyType::Static, .position = {0, 0.5, 0}, .shapes = {{.geometry = Box{2, 1, 2}, .isTrigger = true}}});
  const BodyId box = addTower(world, {}, 1)[0];
  int enters = 0, leaves = 0;
  const auto count = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      world.step(kDt);
      enters += static_cast<int>(world.events().enters.size()),
          leaves += static_cast<int>(world.events().leaves.size());
    }
  };
  count(100);
  ASSERT_FALSE(world.isAwake(box));
  EXPECT_EQ(enters, 1);
  world.wake(box);
  count(100);
  EXPECT_EQ(enters, 1);
  EXPECT_EQ(leaves, 0);
  ASSERT_FALSE(world.isAwake(box));
  world.destroy(box);
  count(1);
  EXPECT_EQ(leaves, 1);
}

TEST(Sleep, QueriesSeeSleepers) {
  World world;
  addGround(world);
  const BodyId box = world.create(BodyDef{.position = {0, 1.2, 0}, .shape = kBox});
  run(world, 150);
  ASSERT_FALSE(world.isAwake(box));
  const CastHit hit = world.rayClosest({.origin = {0, 5, 0}, .direction = {0, -1, 0}, .length = 10});
  EXPECT_NEAR(hit.distance, 4, 0.01);
  EXPECT_FALSE(world.isAwake(box));
}

}  // namespace
}  // namespace avbd
