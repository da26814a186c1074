// The character mover and bodies: what carries it, what it pushes, what it weighs on.
#include "api/mover_cases.h"

namespace avbd {
namespace {

void makeFloor(World& world) { world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}}); }

TEST(MoverBodies, aProxyThatFollowsItDoesNotKeepItFromBeingCarried) {
  World world;
  world.create(BodyDef{.type = BodyType::Kinematic, .linearVelocity = {1, 0, 0}, .shape = Box{3, 0.2f, 3}});
  const BodyId proxy =
      world.create(BodyDef{.type = BodyType::Kinematic, .position = {0, 1.12, 0}, .shape = Capsule{0.3f, 0.6f}});
  int asked = 0;
  Walker walker(world, {.position = {0, 0.22, 0}, .filter = {.ignore = proxy, .accept = [&](ShapeId) {
                                                               ++asked;
                                                               return true;
                                                             }}});
  walker.walk({}, 1);
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    walker.walk({}, 1);
    world.setPose(proxy, walker.mover.pose());
  }
  EXPECT_NEAR(walker.at().x, 1, 1e-3);
  EXPECT_GT(asked, 0);
}

TEST(MoverBodies, turnedGroundAtRestDoesNotCarryIt) {
  World world;
  const Quat turn{0.8f, 0.36f, 0.48f, 0};
  const BodyId ground = world.create(
      BodyDef{.type = BodyType::Kinematic, .position = {70, -300, 40}, .rotation = turn, .shape = Sphere{300}});
  Walker walker(world, {.position = {70, 0.02, 40}});
  walker.walk({}, 5);
  ASSERT_TRUE(walker.mover.ground());
  ASSERT_EQ(walker.mover.ground().body, ground);
  const Vec3d before = walker.at();
  walker.walk({}, 2000);
  EXPECT_LT(length(walker.at() - before), 1e-6);
}

/// How far a crate goes relative to a platform that moves at this speed, with a walker beside it.
double pushed(float platformSpeed, float walkingSpeed) {
  World world;
  const BodyId platform = world.create(BodyDef{.type = BodyType::Kinematic,
                                               .position = {0, -0.5, 0},
                                               .linearVelocity = {platformSpeed, 0, 0},
                                               .shape = Box{20, 0.5f, 3}});
  // First it finds its ground: in the air, a crate that comes with the platform would run against it.
  Walker walker(world, {.position = {0.18, 0.02, 0}});
  walker.walk({}, 1);
  const BodyId crate = world.create(BodyDef{
      .position = {1, 0.5, 0}, .linearVelocity = {platformSpeed, 0, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = 20});
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    walker.mover.move(world, {walkingSpeed, 0, 0}, kStep);
    EXPECT_TRUE(walker.mover.ground()) << i;
  }
  return world.pose(crate).position.x - 1 - world.pose(platform).position.x;
}

TEST(MoverBodies, pushesOnAMovingPlatformAsOnTheGround) {
  const double atRest = pushed(0, 1.5f);
  EXPECT_GT(atRest, 1.5);
  EXPECT_NEAR(pushed(1.5f, 1.5f), atRest, 0.05);
  EXPECT_NEAR(pushed(-1.5f, 1.5f), atRest, 0.05);
  for (const float speed : {0.0f, 1.5f, -1.5f, 4.0f}) EXPECT_NEAR(pushed(speed, 0), 0, 2e-3) << speed;
}

TEST(MoverBodies, anImpulseAtAnEdgeIsThatOfTheEdge) {
  // A free bar hit at its end gives way by turning: no point of it gets faster than the mover.
  for (const double offset : {0.0, 0.9}) {
    World world({.gravity = {}});
    const Quat alongZ{std::sqrt(0.5f), std::sqrt(0.5f), 0, 0};
    const BodyId bar = world.create(
        BodyDef{.position = {0.4, 1, offset}, .rotation = alongZ, .shape = Capsule{0.05f, 0.95f}, .mass = 20});
    Mover mover({.position = {0, 0.1, 0}});
    mover.move(world, {2, 0, 0}, kStep);
    const Velocity v = world.velocity(bar);
    const Vec3 arm{-0.05f, 0, float(-offset)};
    const Vec3 there = v.linear + cross(v.angular, arm);
    if (offset == 0) {
      EXPECT_NEAR(there.x, 2 * 70 / 90.0, 0.02);
    } else {
      EXPECT_LT(v.angular.y, -1);
      EXPECT_LT(there.x, 2);
      EXPECT_GT(there.x, 1.8);
    }
  }
}

TEST(MoverBodies, standsOnATinyBodyWithoutBlowingItAway) {
  for (const double off : {0.0, 0.004, 0.012}) {
    for (const float half : {0.005f, 0.015f, 0.05f}) {
      World world;
      makeFloor(world);
      const BodyId cube =
          world.create(BodyDef{.position = {off, half, 0}, .shape = Box{half, half, half}, .density = 1000});
      Walker walker(world, {.position = {0, 2 * half + 0.02, 0}});
      for (int i = 0; i < 300; ++i) {
        world.step(kStep);
        Vec3 velocity;
        if (!walker.mover.ground()) velocity.y = walker.mover.velocity().y - 9.81f * kStep;
        ASSERT_NO_THROW(walker.mover.move(world, velocity, kStep));
        const Velocity v = world.velocity(cube);
        ASSERT_LT(length(v.linear), 3) << half << " step " << i;
        ASSERT_LT(length(v.angular) * half, 3) << half << " step " << i;
      }
      EXPECT_TRUE(walker.mover.ground());
    }
  }
}

TEST(MoverBodies, aCrateBearsItsWeight) {
  World world;
  makeFloor(world);
  const BodyId crate = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = 200});
  Walker walker(world, {.position = {0.3, 1.02, 0}});
  for (int i = 0; i < 180; ++i) {
    world.step(kStep);
    walker.walk({}, 1);
    ASSERT_TRUE(walker.mover.ground() || i < 3);
  }
  EXPECT_LT(length(world.velocity(crate).linear), 1e-3f);
  EXPECT_NEAR(world.pose(crate).position.y, 0.5, 2e-3);
}

/// Sum of the forces that the ground of a world bears, upwards.
double borne(const World& world) {
  double sum = 0;
  for (const Contact& c : world.contacts())
    for (int i = 0; i < c.pointCount; ++i)
      if (world.type(c.bodyA) == BodyType::Static || world.type(c.bodyB) == BodyType::Static)
        sum += std::abs(double(c.points[size_t(i)].normalForce * c.normal.y));
  return sum;
}

TEST(MoverBodies, aPlankOnTwoSupportsBearsTheWholeWeight) {
  World world;
  for (const double x : {-1.8, 1.8}) fixedBox(world, {x, 0.5, 0}, {0.2f, 0.5f, 1});
  const BodyId plank = world.create(BodyDef{.position = {0, 1.05, 0}, .shape = Box{2, 0.05f, 0.5f}, .mass = 20});
  Walker walker(world, {.position = {-1, 1.12, 0}});
  double least = INFINITY, most = 0;
  for (int i = 0; i < 240; ++i) {
    world.step(kStep);
    walker.walk({0.5f, 0, 0}, 1);
    ASSERT_TRUE(walker.mover.ground() || i < 3) << i;
    ASSERT_LT(length(world.velocity(plank).linear), i < 3 ? 0.2f : 0.05f) << i;  // it lands at first
    if (i < 120) continue;
    least = std::min(least, borne(world));
    most = std::max(most, borne(world));
  }
  EXPECT_NEAR(least, 90 * 9.81, 20);
  EXPECT_NEAR(most, 90 * 9.81, 20);
  EXPECT_NEAR(world.pose(plank).position.y, 1.05, 5e-3);
}

TEST(MoverBodies, tipsAPlankWhoseEndIsInTheAir) {
  World world;
  makeFloor(world);
  fixedBox(world, {-1, 0.5, 0}, {1, 0.5f, 1});
  const BodyId plank = world.create(BodyDef{.position = {-0.3, 1.05, 0}, .shape = Box{1.5f, 0.05f, 0.5f}, .mass = 20});
  Walker walker(world, {.position = {0.6, 1.12, 0}});
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    Vec3 velocity;
    if (!walker.mover.ground()) velocity.y = walker.mover.velocity().y - 9.81f * kStep;
    walker.mover.move(world, velocity, kStep);
    ASSERT_LT(length(world.velocity(plank).linear), 6) << i;
  }
  EXPECT_LT(walker.at().y, 0.5) << "it went down with its end of the plank";
}

TEST(MoverBodies, fallsWithFreeGroundAsFastAsThat) {
  World world;
  const BodyId crate = world.create(BodyDef{.position = {0, 50, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = 5});
  Walker walker(world, {.position = {0, 50.52, 0}});
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    walker.walk({}, 1);
  }
  EXPECT_NEAR(world.velocity(crate).linear.y, -9.81, 0.6);
}

TEST(MoverBodies, landsOnWhatGivesWay) {
  World world({.gravity = {}});
  const BodyId crate = world.create(BodyDef{.position = {0, -0.5, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = 70});
  Mover mover({.position = {0, 0.05, 0}});
  mover.move(world, {0, -4, 0}, kStep);
  ASSERT_TRUE(mover.ground());
  EXPECT_NEAR(world.velocity(crate).linear.y, -2, 0.02);
}

TEST(MoverBodies, nothingChangesWhereItThrows) {
  World world({.gravity = {0, -1e6f, 0}});
  const BodyId crate = world.create(BodyDef{.position = {0, -0.5, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = 70});
  const BodyId beside = world.create(BodyDef{.position = {0.85, 1, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = 70});
  Mover mover({.position = {0, 0.02, 0}, .mass = 1e18f});
  const uint64_t before = world.hash();
  EXPECT_THROW(mover.move(world, {3, 0, 0}, kStep), Error) << "its weight is no force that the world takes";
  EXPECT_EQ(world.hash(), before);
  EXPECT_EQ(mover.position(), (Vec3d{0, 0.02, 0}));
  EXPECT_FALSE(mover.ground());
  world.setGravity({0, -1, 0});
  EXPECT_NO_THROW(mover.move(world, {1e9f, 0, 0}, kStep)) << "nor is its push, but that is bounded by the speeds";
  EXPECT_GT(world.velocity(beside).linear.x, 1);
  EXPECT_LT(length(world.velocity(crate).linear), 1e9f);
}

}  // namespace
}  // namespace avbd
