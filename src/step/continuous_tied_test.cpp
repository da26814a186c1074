// Fast bodies that joints tie to others: what they must not pass, and what stays as it was.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "step/thin_walls.h"

namespace avbd {
namespace {

/// Where they do not pass what joints tie to others.
WorldDef jointed() {
  WorldDef def = weightless();
  def.continuousJointed = true;
  return def;
}

Quat turned(Vec3 axis, double angle) {
  const auto s = static_cast<float>(std::sin(angle / 2));
  return {static_cast<float>(std::cos(angle / 2)), axis.x * s, axis.y * s, axis.z * s};
}

/// Capsules in a row along their axes, held together by balls, first and last at the ends.
struct Chain {
  std::vector<BodyId> links;
  std::vector<JointId> joints;

  Chain(World& world, int count, const BodyDef& first, float half, float radius) {
    const Vec3 along = rotate(first.rotation, Vec3{0, 1, 0});
    const float reach = half + radius;
    for (int i = 0; i < count; ++i) {
      BodyDef link = first;
      const Vec3 from = along * (-2 * reach * static_cast<float>(i));
      link.position = first.position + from;
      link.linearVelocity = first.linearVelocity + cross(first.angularVelocity, from);
      link.shape = Capsule{radius, half};
      links.push_back(world.create(link));
      if (i > 0)
        joints.push_back(world.create(BallJoint{.bodyA = links[static_cast<size_t>(i) - 1],
                                                .bodyB = links.back(),
                                                .frameA = {{0, -reach, 0}, {}},
                                                .frameB = {{0, reach, 0}, {}}}));
    }
  }
  double gap(const World& world) const {
    double most = 0;
    for (const JointId joint : joints) most = std::max(most, world.gap(joint));
    return most;
  }
  double farthest(const World& world) const {
    double most = -1e9;
    for (const BodyId link : links) most = std::max(most, world.pose(link).position.x);
    return most;
  }
};

void addWall(World& world) { world.create(BodyDef{.type = BodyType::Static, .shape = Box{0.01f, 4, 4}}); }

// Two links fly at a wall of 2 cm, 1.7 m a step, at any angle.
TEST(TiedContinuous, TwoLinksDoNotPassAThinWall) {
  double gap = 0;
  for (int turn = 0; turn < 12; ++turn)
    for (int i = 0; i < 6; ++i) {
      World world(jointed());
      addWall(world);
      const BodyDef first{.position = {-3 - 0.29 * i, 0.03, 0.02},
                          .rotation = turned({0, 0, 1}, 0.26 + turn * 0.5236),
                          .linearVelocity = {100, 3, -2}};
      const Chain chain(world, 2, first, 0.15f, 0.05f);
      for (int k = 0; k < 12; ++k) {
        world.step(kDt);
        ASSERT_LT(chain.farthest(world), 0) << turn << " " << i << " " << k;
        gap = std::max(gap, chain.gap(world));
      }
    }
  // Links that whip at 300 rad/s, five a step, part for a while.
  EXPECT_LT(gap, 0.6);
}

TEST(TiedContinuous, JointsHoldAtThirtyMetresASecond) {
  int open = 0;
  double gap = 0;
  for (int turn = 0; turn < 24; ++turn) {
    World world(jointed());
    addWall(world);
    const BodyDef first{.position = {-2.4, 0.03, 0.02},
                        .rotation = turned({0, 0, 1}, 0.26 + turn * 0.2618),
                        .linearVelocity = {30, 3, -2}};
    const Chain chain(world, 2, first, 0.15f, 0.05f);
    double most = 0;
    for (int k = 0; k < 12; ++k) {
      world.step(kDt);
      ASSERT_LT(chain.farthest(world), 0) << turn << " " << k;
      most = std::max(most, chain.gap(world));
    }
    open += most > 0.01;
    gap = std::max(gap, most);
  }
  EXPECT_LT(gap, 0.1);
  EXPECT_LE(open, 2);
}

// The same where nobody asks for it: it passes.
TEST(TiedContinuous, SwitchedOffItPasses) {
  WorldDef def = jointed();
  def.continuousJointed = false;
  World world(def);
  addWall(world);
  const Chain chain(world, 2, {.position = {-3.2, 0, 0}, .linearVelocity = {100, 0, 0}}, 0.15f, 0.05f);
  for (int k = 0; k < 12; ++k) world.step(kDt);
  EXPECT_GT(chain.farthest(world), 1);
}

// Swung by its first link against a post, at 40 m/s at the end.
TEST(TiedContinuous, AChainDoesNotPassAPost) {
  double gap = 0;
  for (int i = 0; i < 8; ++i) {
    World world(jointed());
    const float angle = 0.5f + 0.1f * static_cast<float>(i);
    const Vec3d post{1.2 * std::cos(angle), 1.2 * std::sin(angle), 0};
    world.create(BodyDef{.type = BodyType::Static, .position = post, .shape = Box{0.02f, 0.02f, 1}});
    // Along x from the origin on, turning about z.
    const Chain chain(
        world, 10, {.position = {0.1, 0, 0}, .rotation = turned({0, 0, 1}, 1.5707963), .angularVelocity = {0, 0, 20}},
        0.08f, 0.02f);
    world.create(BallJoint{.bodyB = chain.links[0], .frameB = {{0, 0.1f, 0}, {}}});
    for (int k = 0; k < 30; ++k) {
      world.step(kDt);
      gap = std::max(gap, chain.gap(world));
      for (const BodyId link : chain.links) {
        const Pose pose = world.pose(link);
        const Vec3d end = rotate(pose.rotation, Vec3d{0, 0.1, 0});
        const Vec3d a = pose.position - end, b = pose.position + end;
        const Vec3d way = b - a, to = post - a;
        const double s = std::clamp((to.x * way.x + to.y * way.y) / (way.x * way.x + way.y * way.y), 0.0, 1.0);
        const double dx = to.x - s * way.x, dy = to.y - s * way.y;
        EXPECT_GT(std::sqrt(dx * dx + dy * dy), 0.02) << i << " " << k;
      }
      // The chain from the pivot to the post has not turned past it.
      const Pose inner = world.pose(chain.links[3]);
      const double turnedBy = std::atan2(inner.position.y, inner.position.x);
      EXPECT_LT(turnedBy, angle + 0.1) << i << " " << k;
    }
  }
  EXPECT_LT(gap, 0.03);
}

// Past the edge of a box with six centimetres of room, a little more than contacts of the start of a step look ahead.
TEST(TiedContinuous, WhatPassesBesideIsNotTouched) {
  for (int i = 0; i < 6; ++i) {
    std::vector<Pose> free;
    for (const bool box : {false, true}) {
      World world(jointed());
      if (box) world.create(BodyDef{.type = BodyType::Static, .position = {0, -0.41, 0}, .shape = Box{0.01f, 0.3f, 1}});
      const Chain chain(world, 2,
                        {.position = {-3 - 0.29 * i, 0, 0},
                         .rotation = turned({0, 0, 1}, -1.5707963),
                         .linearVelocity = {100, 0, 0},
                         .angularVelocity = {30, 0, 0}},
                        0.2f, 0.05f);
      for (int k = 0; k < 8; ++k) {
        world.step(kDt);
        for (const BodyId link : chain.links) {
          if (!box) {
            free.push_back(world.pose(link));
            continue;
          }
          const Pose pose = world.pose(link);
          const Pose& other = free[static_cast<size_t>(2 * k) + (link == chain.links[1] ? 1 : 0)];
          EXPECT_EQ(pose.position.x, other.position.x);
          EXPECT_EQ(pose.position.y, other.position.y);
          EXPECT_EQ(pose.rotation.w, other.rotation.w);
        }
      }
    }
  }
}

TEST(TiedContinuous, ALightBoxIsPushedAndMomentumKept) {
  for (const double aside : {0.0, 0.1, 0.2})
    for (int i = 0; i < 6; ++i) {
      World world(jointed());
      const BodyId box =
          world.create(BodyDef{.position = {0, aside - 0.2, 0}, .shape = Box{0.02f, 0.8f, 0.3f}, .mass = 0.5f});
      const Chain chain(world, 2, {.position = {-2.5 - 0.29 * i, 0, 0}, .linearVelocity = {100, 0, 0}, .mass = 2},
                        0.15f, 0.05f);
      const Vec3d before = world.momentum(), spin = world.angularMomentum({});
      for (int k = 0; k < 8; ++k) {
        world.step(kDt);
        for (const BodyId link : chain.links)
          EXPECT_LT((inverse(world.pose(box)) * world.pose(link)).position.x, 0) << i << " " << k;
      }
      EXPECT_NEAR(world.momentum().x, before.x, 0.01);
      EXPECT_NEAR(world.momentum().y, 0, 0.01);
      EXPECT_NEAR(world.angularMomentum({}).z, spin.z, 0.01 * spin.z);
      EXPECT_GT(world.velocity(box).linear.x, 60);
    }
}

// What does not rebound goes on together.
TEST(TiedContinuous, TwoPairsHeadOn) {
  for (int i = 0; i < 6; ++i) {
    World world(jointed());
    const Chain left(world, 2, {.position = {-3 - 0.17 * i, 0.1, 0}, .linearVelocity = {60, 0, 0}}, 0.15f, 0.05f);
    const Chain right(world, 2, {.position = {3, 0.13, 0}, .linearVelocity = {-60, 0, 0}}, 0.15f, 0.05f);
    for (int k = 0; k < 10; ++k) {
      world.step(kDt);
      EXPECT_NEAR(world.momentum().x, 0, 0.01);
    }
    for (const Chain* chain : {&left, &right})
      for (const BodyId link : chain->links) EXPECT_LT(length(world.velocity(link).linear), 40) << i;
  }
}

TEST(TiedContinuous, WhatTheHookRefusesAndTriggersLetPass) {
  for (const bool trigger : {false, true}) {
    World world(jointed());
    BodyDef wall{.type = BodyType::Static};
    wall.shapes.push_back({.geometry = Box{0.01f, 2, 2}, .isTrigger = trigger, .contactHook = !trigger});
    world.create(wall);
    int asked = 0;
    world.setContactHook([&](ContactPlan& plan) {
      for (int i = 0; i < plan.pointCount; ++i) EXPECT_LT(plan.velocities[static_cast<size_t>(i)].x, 400);
      return ++asked, false;
    });
    const Chain chain(world, 2, {.position = {-3.2, 0, 0}, .linearVelocity = {100, 0, 0}}, 0.15f, 0.05f);
    for (int k = 0; k < 6; ++k) world.step(kDt);
    EXPECT_GT(chain.farthest(world), 6);
    EXPECT_EQ(world.velocity(chain.links[0]).linear.x, 100);
    EXPECT_EQ(asked > 0, !trigger);
  }
}

TEST(TiedContinuous, TrianglesHoldFromTheirFront) {
  for (int turn = 0; turn < 6; ++turn)
    for (const bool front : {true, false}) {
      World world(jointed());
      world.create(
          BodyDef{.type = BodyType::Static, .rotation = front ? Quat{} : Quat{0, 0, 1, 0}, .shape = sheet(4, false)});
      const Chain chain(world, 2,
                        {.position = {-3.2, 0.03, 0.02},
                         .rotation = turned({0, 0, 1}, 0.2 + turn * 0.5236),
                         .linearVelocity = {60, 3, -2}},
                        0.15f, 0.05f);
      for (int k = 0; k < 8; ++k) world.step(kDt);
      if (front)
        EXPECT_LT(chain.farthest(world), 0) << turn;
      else
        EXPECT_GT(chain.farthest(world), 3);
    }
}

// A thin kinematic wall sweeps two links along.
TEST(TiedContinuous, AFastKinematicWallTakesThemAlong) {
  World world(jointed());
  const BodyId wall = world.create(BodyDef{
      .type = BodyType::Kinematic, .position = {-3.3, 0, 0}, .linearVelocity = {90, 0, 0}, .shape = Box{0.02f, 3, 3}});
  const Chain chain(world, 2, {.position = {0, 0, 0}, .rotation = turned({0, 0, 1}, 0.7)}, 0.15f, 0.05f);
  for (int k = 0; k < 10; ++k) {
    world.step(kDt);
    for (const BodyId link : chain.links) EXPECT_GT(world.pose(link).position.x, world.pose(wall).position.x) << k;
  }
}

TEST(TiedContinuous, WhatSleepsIsWoken) {
  World world({.continuousJointed = true});
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const BodyId box = world.create(BodyDef{.position = {0, 0.3, 0}, .shape = Box{0.02f, 0.3f, 0.3f}, .mass = 3});
  for (int k = 0; k < 120 && world.isAwake(box); ++k) world.step(kDt);
  ASSERT_FALSE(world.isAwake(box));
  const Chain chain(
      world, 2, {.position = {-3.2, 0.4, 0}, .rotation = turned({0, 0, 1}, 1.5707963), .linearVelocity = {100, 0, 0}},
      0.15f, 0.05f);
  for (int k = 0; k < 3; ++k) world.step(kDt);
  EXPECT_TRUE(world.isAwake(box));
  EXPECT_GT(world.velocity(box).linear.x, 5);
}

// Many ragged chains at a wall: for any number of workers and any lane width, and from a snapshot.
TEST(TiedContinuous, ManyGiveTheSameBits) {
  const auto build = [](int workers, int width) {
    auto world = std::make_unique<World>(WorldDef{.workers = workers, .continuousJointed = true, .simdWidth = width});
    world->create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    addWall(*world);
    for (int i = 0; i < 20; ++i)
      Chain(*world, 4,
            {.position = {-3 - 0.3 * (i % 7), 0.5 + 0.3 * (i / 5), -1.5 + 0.6 * (i % 5)},
             .rotation = turned({0, 0, 1}, 0.3 * i),
             .linearVelocity = {60.0f + 5 * static_cast<float>(i % 9), 0, 0}},
            0.08f, 0.03f);
    return world;
  };
  const auto hashOf = [](World& world, int steps) {
    for (int k = 0; k < steps; ++k) world.step(kDt);
    return world.hash();
  };
  auto world = build(1, 0);
  const uint64_t hash = hashOf(*world, 20);
  EXPECT_EQ(hashOf(*build(4, 0), 20), hash);
  for (const int width : {1, 4}) EXPECT_EQ(hashOf(*build(1, width), 20), hash);
  // Amid the impacts.
  for (const int steps : {2, 3, 4, 5}) {
    auto half = build(1, 0), other = build(1, 0);
    hashOf(*half, steps);
    std::vector<std::byte> snapshot;
    half->save(snapshot);
    other->restore(snapshot);
    EXPECT_EQ(hashOf(*other, 20 - steps), hash) << steps;
  }
}

TEST(TiedContinuous, SubstepsHoldToo) {
  for (int turn = 0; turn < 12; ++turn) {
    WorldDef def = jointed();
    def.substeps = 4;
    World world(def);
    addWall(world);
    const Chain chain(world, 2,
                      {.position = {-3.2, 0.03, 0.02},
                       .rotation = turned({0, 0, 1}, 0.26 + turn * 0.5236),
                       .linearVelocity = {100, 3, -2}},
                      0.15f, 0.05f);
    for (int k = 0; k < 8; ++k) {
      world.step(kDt);
      ASSERT_LT(chain.farthest(world), 0) << turn << " " << k;
    }
    EXPECT_LT(chain.gap(world), 0.04) << turn;
  }
}

}  // namespace
}  // namespace avbd
