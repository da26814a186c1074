// Points of soft bodies against faces of others: where they are nearest, what they carry, what they keep.
#include "step/soft_touches.h"

#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

std::shared_ptr<const SoftMeshData> cube() { return makeTetBox({0.25f, 0.25f, 0.25f}, 3, 3, 3); }

void run(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(kDt);
}

double groundForce(const World& world) {
  double force = 0;
  for (const Contact& contact : world.contacts())
    for (int i = 0; i < contact.pointCount && !(contact.softA && contact.softB); ++i)
      force += double{contact.points[static_cast<size_t>(i)].normalForce};
  return force;
}

double lowest(const World& world, SoftId id) {
  double y = 1e9;
  for (const BodyId p : world.particles(id)) y = std::min(y, world.pose(p).position.y);
  return y;
}
double highest(const World& world, SoftId id) {
  double y = -1e9;
  for (const BodyId p : world.particles(id)) y = std::max(y, world.pose(p).position.y);
  return y;
}

/// Turned, so that no point lies over another's.
struct TwoOnTheGround : testing::Test {
  World world;
  BodyId ground = world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  SoftId below = world.create(SoftDef{.mesh = cube(), .pose = {{0, 0.27, 0}, {}}, .material = {.youngsModulus = 1e6f}});
  SoftId above = world.create(
      SoftDef{.mesh = cube(), .pose = {{0.03, 0.85, 0.02}, {0.96f, 0, 0.28f, 0}}, .material = {.youngsModulus = 1e6f}});
};

TEST_F(TwoOnTheGround, OneCarriesTheOther) {
  run(world, 120);
  EXPECT_NEAR(groundForce(world), 2 * 125 * 9.81, 0.01 * 2 * 125 * 9.81);
  const double gap = lowest(world, above) - highest(world, below);
  EXPECT_GT(gap, 0.012);  // faces bulge
  EXPECT_LT(gap, 0.03);
}

TEST_F(TwoOnTheGround, SleepTogetherAndWakeTogether) {
  run(world, 300);
  EXPECT_FALSE(world.isAwake(world.particles(below)[0]));
  EXPECT_FALSE(world.isAwake(world.particles(above)[0]));
  world.addImpulse(world.particles(above)[5], {0, 0, 3});
  EXPECT_TRUE(world.isAwake(world.particles(below)[0]));
  const uint64_t hash = world.hash();
  run(world, 60);
  EXPECT_NE(world.hash(), hash);
  EXPECT_NEAR(groundForce(world), 2 * 125 * 9.81, 0.02 * 2 * 125 * 9.81);
}

TEST_F(TwoOnTheGround, PutToSleepThroughAParticle) {
  run(world, 60);
  world.putToSleep(world.particles(above)[7]);
  for (const SoftId id : {below, above})
    for (const BodyId p : world.particles(id)) EXPECT_FALSE(world.isAwake(p));
  run(world, 2);
  EXPECT_EQ(world.report().bodies, 0u);
}

TEST_F(TwoOnTheGround, WhatIsGoneTouchesNothing) {
  run(world, 120);
  world.destroy(below);
  run(world, 60);
  EXPECT_LT(lowest(world, above), 0.1);
  EXPECT_NEAR(groundForce(world), 125 * 9.81, 0.05 * 125 * 9.81);
}

TEST_F(TwoOnTheGround, FallingOnASleeperWakesIt) {
  world.destroy(above);
  run(world, 240);
  ASSERT_FALSE(world.isAwake(world.particles(below)[0]));
  const SoftId next =
      world.create(SoftDef{.mesh = cube(), .pose = {{0, 1.2, 0}, {}}, .material = {.youngsModulus = 1e6f}});
  bool woke = false;
  for (int i = 0; i < 120; ++i) {
    world.step(kDt);
    woke = woke || world.isAwake(world.particles(below)[0]);
  }
  EXPECT_TRUE(woke);
  EXPECT_GT(lowest(world, next), highest(world, below) + 0.015);
}

TEST(SoftTouches, KeepMomentum) {
  World world(WorldDef{.gravity = {}});
  world.create(SoftDef{.mesh = cube(), .pose = {{-0.4, 0, 0}, {}}, .velocity = {{2, 0, 0}, {}}});
  world.create(SoftDef{.mesh = cube(), .pose = {{0.4, 0.1, 0.05}, {0.96f, 0, 0.28f, 0}}, .velocity = {{-1, 0, 0}, {}}});
  const Vec3d before = world.momentum(), spin = world.angularMomentum();
  run(world, 60);
  EXPECT_NEAR(world.momentum().x, before.x, 1e-3 * 125 * 3);
  EXPECT_NEAR(world.momentum().y, before.y, 1e-3 * 125 * 3);
  EXPECT_NEAR(world.angularMomentum().z, spin.z, 0.01 * 125 * 3 * 0.1);
  double left = 0, right = 0;
  const auto ids = world.softBodies();
  for (const BodyId p : world.particles(ids[0])) left += world.pose(p).position.x / 64;
  for (const BodyId p : world.particles(ids[1])) right += world.pose(p).position.x / 64;
  EXPECT_LT(left, right - 0.4);
}

TEST(SoftTouches, FiltersCount) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const auto at = [&](double y) {
    return world.create(SoftDef{.mesh = cube(), .pose = {{0, y, 0}, {}}, .filter = {.category = 2, .mask = 1}});
  };
  at(0.3);
  const SoftId above = at(1);
  run(world, 120);
  EXPECT_LT(lowest(world, above), 0.05);
}

World falling(const WorldDef& def) {
  World world(def);
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  for (int i = 0; i < 3; ++i)
    world.create(SoftDef{.mesh = cube(), .pose = {{0.1 * i, 0.3 + 0.55 * i, 0}, {0.96f, 0, 0.28f, 0}}});
  return world;
}

TEST(SoftTouches, TheSameBitsForAllWidthsAndWorkers) {
  std::set<uint64_t> hashes;
  for (const int width : {1, 4, 8, 16})
    for (const int workers : {1, 3}) {
      World world = falling({.workers = workers, .substeps = 2, .simdWidth = width});
      run(world, 40);
      hashes.insert(world.hash());
    }
  EXPECT_EQ(hashes.size(), 1u);
}

TEST(SoftTouches, AreInSnapshots) {
  World world = falling({});
  run(world, 30);
  std::vector<std::byte> bytes;
  world.save(bytes);
  run(world, 30);
  const uint64_t hash = world.hash();
  World other = falling({});
  for (World* again : {&world, &other}) {
    again->restore(bytes);
    run(*again, 30);
    EXPECT_EQ(again->hash(), hash);
  }
}

}  // namespace
}  // namespace avbd
