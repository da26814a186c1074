// The count of crossings sees what it should.
#include "scenes/crossings.h"

#include <gtest/gtest.h>

#include "scenes/build.h"

namespace avbd::scenes {
namespace {

SoftId cloth(World& world, Pose pose) {
  return world.create(SoftDef{.mesh = makeClothGrid(0.5f, 0.5f, 4, 4), .pose = pose});
}

TEST(Crossings, OfParallelClothAreNone) {
  World world;
  cloth(world, {{0, 1, 0}, {}});
  cloth(world, {{0.03, 1.001, 0.01}, {}});
  EXPECT_EQ(crossings(world), 0);
}

TEST(Crossings, OfOneClothThroughAnotherAreSeen) {
  World world;
  cloth(world, {{0, 1, 0}, {}});
  cloth(world, {{0.03, 1.1, 0.01}, {0.70710678f, 0, 0, 0.70710678f}});
  EXPECT_GE(crossings(world), 4);
}

TEST(Crossings, OfAPointThatIsPulledThroughItsOwnClothAreSeen) {
  World world;
  const SoftId id = cloth(world, {{0, 1, 0}, {}});
  EXPECT_EQ(crossings(world), 0);
  const BodyId corner = world.particles(id)[0];
  world.setPose(corner, {{0.1, 0.9, 0.13}, {}});
  world.setPose(world.particles(id)[1], {{0.13, 1.1, 0.07}, {}});
  EXPECT_GT(crossings(world), 0);
}

TEST(Crossings, AreNoneOfAPointThrownOutOfItsOwnSolid) {
  for (const float speed : {2.0f, 4.0f, 8.0f})
    for (size_t at = 0; at < 27; ++at) {
      World world(WorldDef{.gravity = {}});
      const SoftId id = world.create(SoftDef{
          .mesh = makeTetBox({0.1f, 0.1f, 0.1f}, 2, 2, 2), .material = {.youngsModulus = 1e3f}, .radius = 0.004f});
      world.setVelocity(world.particles(id)[at], {{speed, -0.5f * speed, 0.2f * speed}, {}});
      for (int i = 0; i < 20; ++i) {
        world.step(1.0f / 60);
        ASSERT_EQ(crossings(world), 0) << "point " << at << " at " << speed << " m/s, step " << i;
      }
    }
}

TEST(Crossings, DistanceIsThatOfTheSolid) {
  const Pose pose{{1, 2, 3}, turned({0, 0, 1}, 0.5)};
  const auto at = [&](Vec3d p) { return pose.position + rotate(pose.rotation, p); };
  EXPECT_NEAR(distanceTo({pose, Box{1, 2, 3}}, at({0, 1.5, 0})), -0.5, 1e-6);
  EXPECT_NEAR(distanceTo({pose, Box{1, 2, 3}}, at({4, 6, 0})), 5, 1e-6);
  EXPECT_NEAR(distanceTo({pose, Sphere{0.5f}}, at({0, 0, 2})), 1.5, 1e-6);
  EXPECT_NEAR(distanceTo({pose, Capsule{0.5f, 1}}, at({0, 3, 0})), 1.5, 1e-6);
}

}  // namespace
}  // namespace avbd::scenes
