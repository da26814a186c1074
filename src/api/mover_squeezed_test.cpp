// The character mover in overlaps that it can leave and that it cannot.
#include <avbd/mesh.h>

#include <array>

#include "api/mover_cases.h"

namespace avbd {
namespace {

void makeFloor(World& world) { world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}}); }

void fallOrWalk(World& world, Mover& mover, Vec3 wanted, int steps) {
  for (int i = 0; i < steps; ++i) {
    Vec3 velocity = wanted;
    if (!mover.ground()) velocity.y = mover.velocity().y - 9.81f * kStep;
    mover.move(world, velocity, kStep);
  }
}

TEST(MoverSqueezed, isNotPushedThroughAThinWall) {
  World world;
  makeFloor(world);
  fixedBox(world, {1, 1, 0}, {0.005f, 1, 3});
  const BodyId door =
      world.create(BodyDef{.type = BodyType::Kinematic, .position = {-1.66, 1, 0}, .shape = Box{2, 1, 2.5f}});
  Mover mover({.position = {0.66, 0.02, 0}, .radius = 0.3f});
  mover.move(world, {}, kStep);
  EXPECT_NEAR(mover.position().x, 0.66, 0.03);
  world.setPose(door, {{-1.26, 1, 0}, {}});
  for (int i = 0; i < 30; ++i) {
    mover.move(world, {}, kStep);
    ASSERT_LT(mover.position().x, 0.995 - 0.3) << i;
  }
  // It can still walk out along the wall, and when the door opens it is free again.
  Mover out = mover;
  fallOrWalk(world, out, {0, 0, 2}, 150);
  EXPECT_GT(out.position().z, 3);
  world.setPose(door, {{-1.66, 1, 0}, {}});
  fallOrWalk(world, mover, {-2, 0, 0}, 30);
  EXPECT_TRUE(mover.ground());
  EXPECT_LT(world.nearestClosest(mover.geometry(), mover.pose(), 1).distance, 0.03f);
  EXPECT_GT(world.nearestClosest(mover.geometry(), mover.pose(), 1).distance, 0);
}

TEST(MoverSqueezed, walksOutFromUnderACrateOnItsHead) {
  World world;
  makeFloor(world);
  const BodyId crate = world.create(BodyDef{.position = {0, 3, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = 30});
  Mover mover({.position = {0, 0.02, 0}});
  for (int i = 0; i < 90; ++i) {
    world.step(kStep);
    fallOrWalk(world, mover, {}, 1);
    ASSERT_LT(std::abs(mover.position().x), 0.1);
    ASSERT_TRUE(mover.ground()) << i;
    ASSERT_NE(mover.ground().body, crate) << i;
  }
  ASSERT_LT(world.pose(crate).position.y, 2.32) << "it lies on the head";
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    fallOrWalk(world, mover, {2, 0, 0}, 1);
  }
  EXPECT_GT(mover.position().x, 1.8);
  EXPECT_NEAR(mover.position().y, 0.02, 5e-3);
  EXPECT_TRUE(mover.ground());
}

/// A room of one mesh, seen from inside: floor at 0, ceiling, and a wall at x = 3.
std::shared_ptr<const MeshData> room(float ceiling) {
  const std::vector<Vec3> v{{-5, 0, -5},       {-5, 0, 5},       {3, 0, 5},       {3, 0, -5},
                            {-5, ceiling, -5}, {-5, ceiling, 5}, {3, ceiling, 5}, {3, ceiling, -5}};
  const std::vector<std::array<uint32_t, 3>> t{{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}, {3, 2, 6}, {3, 6, 7}};
  return makeMesh({v, t});
}

TEST(MoverSqueezed, walksUnderACeilingThatIsTooLow) {
  for (const bool isMesh : {false, true}) {
    for (const float depth : {0.01f, 0.1f}) {
      World world;
      const float ceiling = 1.82f - depth;
      if (isMesh) {
        world.create(BodyDef{.type = BodyType::Static, .shape = Mesh{room(ceiling)}});
      } else {
        makeFloor(world);
        fixedBox(world, {0, ceiling + 0.5, 0}, {5, 0.5f, 5});
        fixedBox(world, {3.5, 1, 0}, {0.5f, 5, 5});
      }
      Mover mover({.position = {0, 0.02, 0}});
      fallOrWalk(world, mover, {}, 3);
      EXPECT_TRUE(mover.ground()) << isMesh;
      EXPECT_NEAR(mover.ground().point.y, 0, 1e-3) << isMesh;
      fallOrWalk(world, mover, {2, 0, 0}, 60);
      EXPECT_NEAR(mover.position().x, 2, 0.02) << isMesh << " " << depth;
      fallOrWalk(world, mover, {2, 0, 1}, 60);
      // The wall is still one.
      EXPECT_LT(mover.position().x, 2.7) << isMesh << " " << depth;
      EXPECT_GT(mover.position().x, 2.4) << isMesh << " " << depth;
      EXPECT_GT(mover.position().z, 0.8) << isMesh << " " << depth;
      EXPECT_NEAR(mover.position().y, 0.02, 0.02) << isMesh << " " << depth;
      fallOrWalk(world, mover, {0, 3, 0}, 30);
      EXPECT_LT(mover.position().y, 0.03) << "no deeper into it";
    }
  }
}

TEST(MoverSqueezed, airBetweenClosingWallsIsNoGround) {
  World world;
  BodyId walls[2];
  for (int i = 0; i < 2; ++i)
    walls[i] =
        world.create(BodyDef{.type = BodyType::Kinematic, .position = {i ? 1.5 : -1.5, 0, 0}, .shape = Box{1, 20, 2}});
  Mover mover({.position = {0, 5, 0}});
  for (const double gap : {0.33, 0.28, 0.25, 0.2, 0.15}) {
    for (int i = 0; i < 2; ++i) world.setPose(walls[i], {{(i ? 1 : -1) * (1 + gap), 0, 0}, {}});
    const double before = mover.position().y;
    fallOrWalk(world, mover, {}, 5);
    EXPECT_FALSE(mover.ground()) << gap;
    EXPECT_LT(mover.position().y, before - 0.01) << gap;
  }
}

TEST(MoverSqueezed, floorBetweenClosingWallsIsGround) {
  World world;
  makeFloor(world);
  for (const double side : {-1.0, 1.0}) fixedBox(world, {side * 1.25, 0, 0}, {1, 20, 2});
  Mover mover({.position = {0, 0.02, 0}});
  fallOrWalk(world, mover, {}, 5);
  EXPECT_TRUE(mover.ground());
  EXPECT_NEAR(mover.ground().point.y, 0, 1e-3);
  fallOrWalk(world, mover, {0, 0, 2}, 120);
  EXPECT_GT(mover.position().z, 3);
}

}  // namespace
}  // namespace avbd
