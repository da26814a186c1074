// Fast bodies that meet each other where nothing outside holds them: they go on together, in every common flight alike.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "step/thin_walls.h"

namespace avbd {
namespace {

using Bodies = std::vector<BodyId>;

Vec3d centerOf(const World& world, const Bodies& bodies) {
  Vec3d sum;
  double mass = 0;
  for (const BodyId id : bodies) {
    sum = sum + world.worldCenterOfMass(id) * double{world.mass(id)};
    mass += double{world.mass(id)};
  }
  return sum * (1 / mass);
}

/// Balls and boxes thrown at a row of boxes that touch, and at each other, all in a common flight.
Bodies swarm(World& world, Vec3 flight) {
  Bodies bodies;
  const auto add = [&](const Geometry& shape, Vec3d at, Vec3 velocity, Vec3 spin, float mass) {
    bodies.push_back(world.create(BodyDef{
        .position = at, .linearVelocity = velocity + flight, .angularVelocity = spin, .shape = shape, .mass = mass}));
  };
  for (int i = 0; i < 4; ++i) add(Box{0.2f, 0.2f, 0.2f}, {0.4 * i, 0, 0}, {}, {}, 2);
  add(Box{0.8f, 0.1f, 0.3f}, {0.3, 2, 0}, {0.5f, 0, 0}, {0, 0, 2}, 20);
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.7 * i;
    const Vec3 in{-25 * static_cast<float>(std::cos(angle)), -25 * static_cast<float>(std::sin(angle)), 0.5f};
    const Geometry shape = i % 2 ? Geometry(Sphere{0.08f}) : Geometry(Box{0.08f, 0.1f, 0.06f});
    add(shape, {0.5 + 4 * std::cos(angle), 0.8 + 4 * std::sin(angle), 0.03 * i - 0.1}, in, {1, 2, -1}, 1);
  }
  return bodies;
}

TEST(ContinuousFlight, ASwarmKeepsItsMomentaAndItsCenter) {
  for (const Vec3 flight : {Vec3{}, Vec3{25, 8, 0}}) {
    World world(weightless());
    const Bodies bodies = swarm(world, flight);
    const Vec3d from = centerOf(world, bodies), linear = world.momentum(), angular = world.angularMomentum();
    double mass = 0;
    for (const BodyId id : bodies) mass += double{world.mass(id)};
    uint32_t impacts = 0;
    for (int i = 1; i <= 40; ++i) {
      impacts += world.step(kDt).impacts;
      const Vec3d straight = from + linear * (i * double{kDt} / mass);
      EXPECT_LT(length(centerOf(world, bodies) - straight), 1e-4) << i;
      // Of 200 kg m^2/s and 1000 in flight.
      EXPECT_LT(length(world.angularMomentum() - angular), 0.01) << i;
      EXPECT_LT(length(world.momentum() - linear), 1e-3) << i;
    }
    EXPECT_GT(impacts, 8u);
  }
}

// A bullet and a box: at rest, and both at 25 m/s, along and across.
TEST(ContinuousFlight, AHitInFlightIsThatAtRest) {
  const auto endOf = [](Vec3 flight, uint32_t& impacts) {
    World world(weightless());
    const BodyId box = world.create(BodyDef{.linearVelocity = flight, .shape = Box{0.3f, 0.3f, 0.3f}, .mass = 5});
    const BodyId bullet = world.create(BodyDef{
        .position = {-4, 0.2, 0.1}, .linearVelocity = Vec3{40, 0, 0} + flight, .shape = Sphere{0.08f}, .mass = 1});
    for (int i = 0; i < 20; ++i) impacts += world.step(kDt).impacts;
    return world.pose(bullet).position - world.pose(box).position;
  };
  uint32_t atRest = 0;
  const Vec3d rest = endOf({}, atRest);
  EXPECT_EQ(atRest, 1u);
  for (const Vec3 flight : {Vec3{25, 0, 0}, Vec3{-25, 0, 0}, Vec3{0, 25, 10}}) {
    uint32_t impacts = 0;
    const Vec3d end = endOf(flight, impacts);
    EXPECT_LT(length(end - rest), 1e-3);
    EXPECT_EQ(impacts, atRest);
  }
}

// What goes on together does not go through what stands in its way.
TEST(ContinuousFlight, WhatWasJoinedStopsAtAWall) {
  for (int i = 0; i < 12; ++i) {
    World world(weightless());
    world.create(BodyDef{.type = BodyType::Static, .shape = Box{0.01f, 2, 2}});
    Bodies bodies;
    // One catches up with the other shortly before the wall.
    bodies.push_back(world.create(BodyDef{
        .position = {-1.6 - 0.07 * i, 0, 0}, .linearVelocity = {150, 0, 0}, .shape = Sphere{0.05f}, .mass = 1}));
    bodies.push_back(world.create(
        BodyDef{.position = {-0.5, 0.02, 0}, .linearVelocity = {3, 0, 0}, .shape = Box{0.1f, 0.1f, 0.1f}, .mass = 1}));
    for (int k = 0; k < 10; ++k) {
      world.step(kDt);
      for (const BodyId id : bodies) EXPECT_LT(world.pose(id).position.x, 0.02) << i << " " << k;
    }
  }
}

// A row of fast balls, each slower than the one behind it, runs together in one step.
TEST(ContinuousFlight, ARowRunsTogetherInOrder) {
  World world(weightless());
  Bodies balls;
  for (int i = 0; i < 6; ++i)
    balls.push_back(world.create(BodyDef{.position = {0.3 * i, 0, 0},
                                         .linearVelocity = {150 - 25 * static_cast<float>(i), 0, 0},
                                         .shape = Sphere{0.1f},
                                         .mass = 1}));
  const double from = centerOf(world, balls).x;
  for (int k = 1; k <= 10; ++k) {
    world.step(kDt);
    for (size_t i = 1; i < balls.size(); ++i)
      EXPECT_GT(world.pose(balls[i]).position.x, world.pose(balls[i - 1]).position.x) << k;
    EXPECT_NEAR(centerOf(world, balls).x, from + 87.5 * k * double{kDt}, 1e-4);
  }
}

TEST(ContinuousFlight, WhatWasJoinedPassesATrigger) {
  World world(weightless());
  BodyDef gate{.type = BodyType::Static, .position = {0.9, 0, 0}};
  gate.shapes.push_back({.geometry = Box{0.02f, 1, 1}, .isTrigger = true});
  world.create(gate);
  world.create(BodyDef{.position = {-0.9, 0, 0}, .linearVelocity = {200, 0, 0}, .shape = Sphere{0.05f}, .mass = 4});
  const BodyId slow = world.create(BodyDef{.shape = Sphere{0.1f}, .mass = 1});
  size_t enters = 0;
  for (int i = 0; i < 4; ++i) {
    world.step(kDt);
    for (const TriggerEvent& e : world.events().enters) enters += e.visitorBody == slow;
  }
  EXPECT_EQ(enters, 1u);
}

}  // namespace
}  // namespace avbd
