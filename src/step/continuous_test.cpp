// Fast bodies: what they must not pass, where they stop, and what stays as it was.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "step/thin_walls.h"

namespace avbd {
namespace {

/// One body flies at what stands in the plane x = 0. How far it comes along x, from starts all over a step's way.
template <class Wall>
double farthest(const BodyDef& flyer, Wall addWall, WorldDef def = weightless()) {
  double far = -1e9;
  for (int i = 0; i < 8; ++i) {
    World world(def);
    addWall(world);
    BodyDef body = flyer;
    body.position = {-4 - 0.29 * i, 0.03, 0.02};
    const BodyId id = world.create(body);
    for (int k = 0; k < 20; ++k) {
      world.step(kDt);
      far = std::max(far, world.pose(id).position.x);
    }
  }
  return far;
}
void addBoxWall(World& world) { world.create(BodyDef{.type = BodyType::Static, .shape = Box{0.01f, 2, 2}}); }
void addSheet(World& world) { world.create(BodyDef{.type = BodyType::Static, .shape = sheet(2, false)}); }
void addHeights(World& world) {
  const std::vector<float> heights(25, 0.0f);
  const auto data = makeHeightField({.columns = 5, .rows = 5, .heights = heights});
  // Its y to -x.
  world.create(
      BodyDef{.type = BodyType::Static, .rotation = {0.70710678f, 0, 0, 0.70710678f}, .shape = HeightField{data}});
}
void addHalfSpace(World& world) {
  world.create(BodyDef{.type = BodyType::Static, .rotation = {0.70710678f, 0, 0, 0.70710678f}, .shape = HalfSpace{}});
}
Hull stone() {
  const std::vector<Vec3> points{{0.2f, 0, 0},  {-0.2f, 0, 0.02f}, {0, 0.15f, 0},
                                 {0, -0.1f, 0}, {0, 0.02f, 0.12f}, {0.03f, 0, -0.12f}};
  return Hull{makeHull({.points = points})};
}

std::vector<BodyDef> flyers() {
  std::vector<BodyDef> list;
  const Vec3 fast{150, 3, -2}, spin{8, 12, -15};
  for (const Geometry& shape :
       {Geometry(Sphere{0.05f}), Geometry(Box{0.1f, 0.2f, 0.05f}), Geometry(Capsule{0.03f, 0.3f}), Geometry(stone())})
    list.push_back(BodyDef{.linearVelocity = fast, .angularVelocity = spin, .shape = shape});
  BodyDef dumbbell{.linearVelocity = fast, .angularVelocity = spin};
  for (const double x : {-0.3, 0.3}) dumbbell.shapes.push_back({.geometry = Sphere{0.06f}, .pose = {{x, 0, 0}, {}}});
  list.push_back(dumbbell);
  return list;
}

TEST(Continuous, NothingPassesThroughAnyWall) {
  for (const BodyDef& flyer : flyers())
    for (const auto wall : {addBoxWall, addSheet, addHeights, addHalfSpace})
      EXPECT_LT(farthest(flyer, wall), 0.02) << flyer.shape.has_value();
}

TEST(Continuous, SwitchedOffTheyPass) {
  BodyDef flyer = flyers()[0];
  flyer.continuous = false;
  EXPECT_GT(farthest(flyer, addBoxWall), 1);
  WorldDef def = weightless();
  def.continuous = false;
  EXPECT_GT(farthest(flyers()[0], addBoxWall, def), 1);
  World world;
  const BodyId ball = world.create(flyer);
  EXPECT_FALSE(world.isContinuous(ball));
  world.setContinuous(ball, true);
  EXPECT_TRUE(world.isContinuous(ball));
  world.destroy(ball);
  EXPECT_THROW(world.setContinuous(ball, true), Error);
}

TEST(Continuous, FiltersAndTheBackOfTrianglesLetPass) {
  BodyDef flyer = flyers()[0];
  flyer.filter = {.category = 2, .mask = 2};
  EXPECT_GT(farthest(flyer, addBoxWall), 1);
  const auto behind = [](World& world) {
    world.create(BodyDef{.type = BodyType::Static, .rotation = {0, 0, 1, 0}, .shape = sheet(2, false)});
  };
  EXPECT_GT(farthest(flyers()[0], behind), 1);
}

// Two balls of 1 kg meet at 100 m/s each.
TEST(Continuous, BallsHeadOnKeepTheirMomentum) {
  for (const float e : {0.0f, 1.0f}) {
    World world(weightless());
    BodyDef ball{.position = {-3, 0, 0},
                 .linearVelocity = {100, 0, 0},
                 .shape = Sphere{0.05f},
                 .mass = 1,
                 .material = {.restitution = e}};
    const BodyId left = world.create(ball);
    ball.position = {3.3, 0, 0}, ball.linearVelocity = {-100, 0, 0};
    const BodyId right = world.create(ball);
    uint32_t impacts = 0;
    for (int i = 0; i < 10; ++i) {
      impacts += world.step(kDt).impacts;
      EXPECT_NEAR(world.momentum().x, 0, 1e-4);
      EXPECT_LT(world.pose(left).position.x, world.pose(right).position.x);
    }
    EXPECT_EQ(impacts, 1u);
    // The contact's force of the impact carries on a little into the next step, as at any speed.
    EXPECT_NEAR(world.velocity(left).linear.x, -100 * e, 8);
    EXPECT_NEAR(world.velocity(right).linear.x, 100 * e, 8);
  }
}

TEST(Continuous, TheHitIsToldWithItsSpeed) {
  World world(weightless());
  addBoxWall(world);
  BodyDef ball{.position = {-5, 0, 0}, .linearVelocity = {200, 0, 0}};
  ball.shapes.push_back({.geometry = Sphere{0.05f}, .hitEvents = true});
  const BodyId id = world.create(ball);
  size_t hits = 0;
  for (int i = 0; i < 10; ++i) {
    world.step(kDt);
    for (const HitEvent& hit : world.events().hits) {
      ++hits;
      EXPECT_NEAR(hit.speed, 200, 1e-3);
      EXPECT_NEAR(hit.position.x, -0.01, 2e-3);
      EXPECT_NEAR(hit.impulse, 200 * world.mass(id), 0.02 * 200 * world.mass(id));
    }
  }
  EXPECT_EQ(hits, 1u);
}

// What slides fast over the ground moves to the bit as if nothing was looked for.
TEST(Continuous, SlidingIsNotTouched) {
  for (const int ground : {0, 1, 2})
    for (const Geometry& shape : {Geometry(Box{0.5f, 0.25f, 0.5f}), Geometry(Sphere{0.25f}), Geometry(stone())}) {
      double end[2] = {0, 0};
      for (const bool continuous : {false, true}) {
        World world({.continuous = continuous});
        BodyDef floor{.type = BodyType::Static, .material = {.friction = 0}};
        if (ground == 0) floor.shape = Box{400, 1, 20}, floor.position = {300, -1, 0};
        if (ground == 1) floor.shape = HalfSpace{};
        if (ground == 2) {
          const std::vector<float> flat(11 * 401, 0.0f);
          floor.position = {195, 0, 0};
          floor.shape = HeightField{makeHeightField({.columns = 401, .rows = 11, .heights = flat})};
        }
        world.create(floor);
        const double height = shape.index() == 2 ? 0.25 : shape.index() == 0 ? 0.25 : 0.1;
        const BodyId body = world.create(BodyDef{.position = {0, height, 0.3},
                                                 .linearVelocity = {100, 0, 0},
                                                 .shape = shape,
                                                 .material = {.friction = 0},
                                                 .locks = kLockAngular});
        uint32_t fast = 0, impacts = 0;
        for (int i = 0; i < 60; ++i) {
          const StepReport& report = world.step(kDt);
          fast += report.fastBodies, impacts += report.impacts;
        }
        EXPECT_EQ(fast, continuous ? 60u : 0u);
        EXPECT_EQ(impacts, 0u) << ground << " " << shape.index();
        end[continuous] = world.pose(body).position.x;
      }
      EXPECT_EQ(end[0], end[1]);
    }
}

// A body deep in another one is not held there.
TEST(Continuous, WhatOverlapsAtTheStartMayLeave) {
  World world(weightless());
  world.create(BodyDef{.type = BodyType::Static, .shape = Box{1, 1, 1}});
  const BodyId ball =
      world.create(BodyDef{.position = {0.8, 0, 0}, .linearVelocity = {100, 0, 0}, .shape = Sphere{0.3f}});
  world.step(kDt);
  EXPECT_GT(world.pose(ball).position.x, 2);
}

/// How deep the lines of two rods of half length 1 in the plane z = 0 cross: how far the crossing is from the nearest
/// end.
double crossing(const Pose& a, const Pose& b) {
  const Vec3d u = rotate(a.rotation, Vec3d{0, 1, 0}), v = rotate(b.rotation, Vec3d{0, 1, 0});
  const Vec3d w = b.position - a.position;
  const double area = u.x * v.y - u.y * v.x;
  if (std::abs(area) < 1e-6) return 0;
  const double s = (w.x * v.y - w.y * v.x) / area, t = (w.x * u.y - w.y * u.x) / area;
  return std::min(1 - std::abs(s), 1 - std::abs(t));
}

TEST(Continuous, SpinningRodsDoNotCross) {
  double deepest[2] = {0, 0};
  for (const bool continuous : {false, true})
    for (int i = 0; i < 10; ++i) {
      WorldDef def = weightless();
      def.continuous = continuous;
      World world(def);
      const BodyDef rod{.angularVelocity = {0, 0, 50}, .shape = Capsule{0.02f, 1}, .mass = 2};
      BodyDef other = rod;
      other.position = {0.9, 0.05 * i, 0}, other.angularVelocity = {0, 0, 35};
      const BodyId a = world.create(rod), b = world.create(other);
      for (int k = 0; k < 8; ++k) {
        world.step(kDt);
        deepest[continuous] = std::max(deepest[continuous], crossing(world.pose(a), world.pose(b)));
        EXPECT_NEAR(world.momentum().x, 0, 1e-3);
      }
    }
  EXPECT_GT(deepest[0], 0.2);
  EXPECT_LT(deepest[1], 0.03);
}

// A door on a hinge, swinging, and a ball that comes against it.
TEST(Continuous, ABallMeetsASwingingDoor) {
  for (int i = 0; i < 8; ++i) {
    World world(weightless());
    const BodyId door = world.create(BodyDef{.position = {0, 0, 0.5},
                                             .linearVelocity = {5, 0, 0},
                                             .angularVelocity = {0, 10, 0},
                                             .shape = Box{0.02f, 1, 0.5f},
                                             .mass = 20});
    const Quat up{0.70710678f, 0, 0, 0.70710678f};
    const JointId hinge = world.create(HingeJoint{.bodyB = door, .frameA = {{}, up}, .frameB = {{0, 0, -0.5}, up}});
    const BodyId ball = world.create(
        BodyDef{.position = {8 + 0.3 * i, 0, 0.5}, .linearVelocity = {-150, 0, 0}, .shape = Sphere{0.05f}});
    double gap = 0;
    int after = 0;
    for (int k = 0; k < 10 && after < 3; ++k) {
      after += world.step(kDt).impacts > 0 || after > 0;
      gap = std::max(gap, world.gap(hinge));
      // In the door's frame the ball stays in front.
      EXPECT_GT((inverse(world.pose(door)) * world.pose(ball)).position.x, 0) << i << " " << k;
    }
    EXPECT_EQ(after, 3);
    EXPECT_LT(gap, 0.03);
  }
}

// A thin kinematic wall sweeps a row of resting boxes along.
TEST(Continuous, AFastKinematicWallLeavesNothingBehind) {
  for (const Vec3 spin : {Vec3{}, Vec3{0, 0, 0.5f}}) {
    World world(weightless());
    const BodyId wall = world.create(BodyDef{.type = BodyType::Kinematic,
                                             .position = {-3.3, 0, 0},
                                             .linearVelocity = {90, 0, 0},
                                             .angularVelocity = spin,
                                             .shape = Box{0.02f, 3, 3}});
    std::vector<BodyId> boxes;
    for (int i = 0; i < 4; ++i)
      boxes.push_back(world.create(BodyDef{.position = {0.21 * i, 0, 0}, .shape = Box{0.1f, 0.1f, 0.1f}}));
    for (int k = 0; k < 10; ++k) {
      world.step(kDt);
      for (const BodyId box : boxes) EXPECT_GT((inverse(world.pose(wall)) * world.pose(box)).position.x, 0) << k;
    }
    EXPECT_GT(world.velocity(boxes[0]).linear.x, 80);
  }
}

// Many fast balls at a thin wall and a pile before it.
TEST(Continuous, ManyBallsAtAPileGiveTheSameBitsForAnyWorkers) {
  uint64_t hash = 0;
  for (const bool workers : {false, true}) {
    World world({.workers = workers ? 4 : 1});
    world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    world.create(BodyDef{.type = BodyType::Static, .position = {0, 3, 0}, .shape = Box{0.01f, 3, 5}});
    for (int i = 0; i < 27; ++i)
      world.create(BodyDef{.position = {-0.3 - 0.4 * (i % 3), 0.2 + 0.4 * (i / 9), -0.4 + 0.4 * (i / 3 % 3)},
                           .shape = Box{0.2f, 0.2f, 0.2f},
                           .density = 500});
    std::vector<BodyId> balls;
    for (int i = 0; i < 80; ++i)
      balls.push_back(
          world.create(BodyDef{.position = {-6 - 0.31 * (i % 16), 0.3 + 0.25 * (i / 8 % 5), -1 + 0.26 * (i % 8)},
                               .linearVelocity = {80.0f + static_cast<float>(i % 7) * 15, 0, 0},
                               .shape = i % 2 ? Geometry(Sphere{0.06f}) : Geometry(Box{0.05f, 0.05f, 0.05f})}));
    for (int k = 0; k < 30; ++k) world.step(kDt);
    // Two are thrown aside and fly round the wall's ends; through it comes none.
    int beyond = 0;
    for (const BodyId ball : balls) {
      beyond += world.pose(ball).position.x > 0 && std::abs(world.pose(ball).position.z) < 5;
      EXPECT_GT(world.pose(ball).position.y, 0);
    }
    EXPECT_EQ(beyond, 0);
    if (workers) EXPECT_EQ(world.hash(), hash);
    hash = world.hash();
  }
}

TEST(Continuous, AThinTriggerIsEnteredAndLeftInOneStep) {
  World world(weightless());
  BodyDef gate{.type = BodyType::Static};
  gate.shapes.push_back({.geometry = Box{0.05f, 1, 1}, .isTrigger = true});
  world.create(gate);
  const BodyId ball =
      world.create(BodyDef{.position = {-5, 0, 0}, .linearVelocity = {200, 0, 0}, .shape = Sphere{0.05f}});
  size_t enters = 0, leaves = 0;
  for (int i = 0; i < 6; ++i) {
    world.step(kDt);
    for (const TriggerEvent& e : world.events().enters) enters += e.visitorBody == ball;
    leaves += world.events().leaves.size();
  }
  EXPECT_EQ(enters, 1u);
  EXPECT_EQ(leaves, 1u);
  EXPECT_GT(world.pose(ball).position.x, 10);
}

// A hook that refuses is asked for what was met on the way, too.
TEST(Continuous, WhatTheHookRefusesIsPassed) {
  World world(weightless());
  BodyDef wall{.type = BodyType::Static};
  wall.shapes.push_back({.geometry = Box{0.01f, 2, 2}, .contactHook = true});
  world.create(wall);
  world.setContactHook([](ContactPlan&) { return false; });
  const BodyId ball =
      world.create(BodyDef{.position = {-5, 0, 0}, .linearVelocity = {200, 0, 0}, .shape = Sphere{0.05f}});
  for (int i = 0; i < 6; ++i) world.step(kDt);
  EXPECT_GT(world.pose(ball).position.x, 8);
  EXPECT_EQ(world.velocity(ball).linear.x, 200);
}

}  // namespace
}  // namespace avbd
