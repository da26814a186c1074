// The character mover on stairs, slopes, platforms, surfaces and in corners.
#include "api/mover_cases.h"
#include "query/query_world.h"

namespace avbd {
namespace {

/// A floor and stairs that rise along x from x = 1, ten of them, 0.4 deep.
void makeStairs(World& world, float height) {
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  for (int i = 0; i < 10; ++i)
    fixedBox(world, {1.2 + 0.4 * i, 0.5 * height * (i + 1), 0}, {0.2f, 0.5f * height * float(i + 1), 2});
  fixedBox(world, {10, 5 * height, 0}, {5, 5 * height, 2});
}

TEST(Mover, standsAndFalls) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  Walker walker(world, {.position = {0, 2, 0}});
  EXPECT_FALSE(walker.mover.ground());
  walker.walk({}, 20);
  EXPECT_FALSE(walker.mover.ground());
  walker.walk({}, 60);
  ASSERT_TRUE(walker.mover.ground());
  EXPECT_NEAR(walker.at().y, walker.mover.definition().skin, 1e-3);
  const Vec3d before = walker.at();
  walker.walk({}, 60);
  EXPECT_LT(length(walker.at() - before), 1e-6);
  walker.walk({3, 0, 0}, 60);
  EXPECT_NEAR(walker.at().x, 3, 1e-4);
  EXPECT_NEAR(walker.mover.velocity().x, 3, 1e-3);
}

TEST(Mover, climbsStepsNoHigherThanItsStepHeight) {
  for (const float speed : {0.5f, 2.0f, 6.0f}) {
    World world;
    makeStairs(world, 0.3f);
    Walker able(world, {.position = {0, 0.02, 0}, .stepHeight = 0.35f});
    able.walk({speed, 0, 0}, static_cast<int>(7 / speed / kStep));
    EXPECT_GT(able.at().x, 6) << speed;
    EXPECT_NEAR(able.at().y, 3.02, 5e-3) << speed;
    EXPECT_TRUE(able.mover.ground());
    Walker unable(world, {.position = {0, 0.02, 0}, .stepHeight = 0.2f});
    unable.walk({speed, 0, 0}, static_cast<int>(7 / speed / kStep));
    EXPECT_LT(unable.at().x, 1) << speed;
    EXPECT_NEAR(unable.at().y, 0.02, 5e-3) << speed;
  }
}

TEST(Mover, itsStepHeightIsTheLimit) {
  for (const float speed : {0.5f, 2.0f, 6.0f}) {
    for (const float height : {0.34f, 0.36f}) {
      World world;
      world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
      fixedBox(world, {6, 0.5 * height, 0}, {5, 0.5f * height, 5});
      Walker walker(world, {.position = {0, 0.02, 0}, .stepHeight = 0.35f});
      walker.walk({speed, 0, 0}, static_cast<int>(3 / speed / kStep));
      if (height < 0.35f) {
        EXPECT_GT(walker.at().x, 2.5) << speed;
        EXPECT_NEAR(walker.at().y, height + 0.02, 1e-3) << speed;
      } else {
        EXPECT_LT(walker.at().x, 0.7) << speed;
        EXPECT_NEAR(walker.at().y, 0.02, 1e-3) << speed;
      }
    }
  }
}

TEST(Mover, itsMaxSlopeIsTheLimit) {
  // The default: atan 1.2 = 50.194 degrees.
  for (const double degrees : {50.1, 50.3}) {
    World world;
    fixedBox(world, {0, -1, 0}, {20, 1, 20}, {});
    const Quat turn = aboutZ(degrees);
    fixedBox(world, toDouble(rotate(turn, Vec3{0, -1, 0})), {20, 1, 20}, turn);
    Walker walker(world, {.position = {-2, 0.02, 0}});
    walker.walk({2, 0, 0}, 180);
    if (degrees < 50.194) {
      EXPECT_TRUE(walker.mover.ground());
      EXPECT_GT(walker.at().y, 3);
    } else {
      EXPECT_LT(walker.at().y, 0.3);
    }
  }
}

TEST(Mover, aVerticalWallIsNoGroundWhateverTheSlope) {
  World world;
  for (const double degrees : {0.0, 17.0, 71.0}) {
    const double half = degrees * 0.5 * 3.14159265358979 / 180;
    const Quat turn{float(std::cos(half)), 0, float(std::sin(half)), 0};
    const Vec3d out = rotate(turn, Vec3d{1, 0, 0});
    const BodyId wall = fixedBox(world, out * 1.5, {0.5f, 50, 5}, turn);
    Walker walker(world, {.position = out * 0.6, .maxSlope = 100});
    walker.walk(toFloat(out) * 2, 1);
    for (int i = 0; i < 60; ++i) {
      walker.walk(toFloat(out) * 2, 1);
      ASSERT_FALSE(walker.mover.ground()) << degrees;
      ASSERT_TRUE(std::isfinite(walker.at().x + walker.at().y + walker.at().z));
    }
    EXPECT_LT(walker.at().y, -4) << degrees;
    world.destroy(wall);
  }
  EXPECT_THROW(Mover({.maxSlope = 101}), Error);
}

TEST(Mover, meetsNothingThatItsFilterLeavesOut) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const BodyId wall = fixedBox(world, {2, 1, 0}, {0.1f, 1, 5});
  const auto reached = [&](const QueryFilter& filter) {
    Walker walker(world, {.position = {0, 0.02, 0}, .filter = filter});
    walker.walk({3, 0, 0}, 60);
    EXPECT_TRUE(walker.mover.ground());
    return walker.at().x;
  };
  EXPECT_LT(reached({}), 1.6);
  EXPECT_NEAR(reached({.ignore = wall}), 3, 1e-3);
  EXPECT_NEAR(reached({.accept = [&](ShapeId s) { return world.body(s) != wall; }}), 3, 1e-3);
  world.destroy(wall);
  Mover mover({.filter = {.ignore = wall}});
  const Vec3d before = mover.position();
  EXPECT_THROW(mover.move(world, {1, 0, 0}, kStep), Error) << "a dead body";
  EXPECT_THROW(mover.move(world, {1, 0, 0}, 1e-38f), Error) << "a step whose inverse is no number";
  EXPECT_EQ(mover.position(), before);
}

TEST(Mover, walksDownStairsWithoutFalling) {
  World world;
  makeStairs(world, 0.3f);
  Walker walker(world, {.position = {7, 3.02, 0}});
  walker.walk({}, 5);
  int airborne = 0;
  for (int i = 0; i < 240; ++i) {
    walker.walk({-2, 0, 0}, 1);
    airborne += !walker.mover.ground();
  }
  EXPECT_EQ(airborne, 0);
  EXPECT_NEAR(walker.at().y, 0.02, 5e-3);
}

TEST(Mover, walksUpThirtyDegreesAndSlidesDownSixty) {
  for (const double degrees : {30.0, 60.0}) {
    World world;
    fixedBox(world, {0, -1, 0}, {20, 1, 20}, {});
    // A slope whose top face passes through the origin.
    const Quat turn = aboutZ(degrees);
    fixedBox(world, toDouble(rotate(turn, Vec3{0, -1, 0})), {20, 1, 20}, turn);
    Walker walker(world, {.position = {-2, 0.02, 0}});
    walker.walk({3, 0, 0}, 120);
    const double tangent = std::tan(degrees * 3.14159265358979 / 180);
    if (degrees == 30) {
      EXPECT_TRUE(walker.mover.ground());
      // As fast as on the level, but for where the slope begins.
      EXPECT_NEAR(walker.at().x, 4, 0.1);
      EXPECT_NEAR(walker.at().y, walker.at().x * tangent, 0.15);
      const Vec3d before = walker.at();
      walker.walk({}, 60);
      EXPECT_LT(length(walker.at() - before), 1e-5);
    } else {
      EXPECT_LT(walker.at().y, 0.3);
      walker.mover.setPosition({2, 2 * tangent + 0.5, 0});
      walker.walk({}, 30);
      EXPECT_FALSE(walker.mover.ground());
      walker.walk({}, 200);
      EXPECT_LT(walker.at().x, 0.3);
      EXPECT_LT(walker.at().y, 0.3);
    }
  }
}

TEST(Mover, isCarriedByAMovingAndTurningPlatform) {
  World world({.gravity = {0, -9.81f, 0}});
  const BodyId platform =
      world.create(BodyDef{.type = BodyType::Kinematic, .linearVelocity = {1, 0.5f, 0}, .shape = Box{3, 0.2f, 3}});
  Walker walker(world, {.position = {0.5, 0.22, 0}});
  walker.walk({}, 5);
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    walker.walk({}, 1);
    ASSERT_TRUE(walker.mover.ground()) << i;
  }
  const Vec3d p = world.pose(platform).position;
  EXPECT_NEAR(p.x, 2, 1e-4);
  EXPECT_NEAR(walker.at().x - p.x, 0.5, 1e-3);
  EXPECT_NEAR(walker.at().y - p.y, 0.22, 5e-3);
  EXPECT_LT(length(walker.mover.velocity()), 0.02f);
  // Turning: stays at its place of the platform. Down, too, it does not lose the ground.
  world.setVelocity(platform, {{0, -1, 0}, {0, 1, 0}});
  const Vec3d local = (inverse(world.pose(platform)) * Pose{walker.at(), {}}).position;
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    walker.walk({}, 1);
    ASSERT_TRUE(walker.mover.ground()) << i;
  }
  EXPECT_LT(length((inverse(world.pose(platform)) * Pose{walker.at(), {}}).position - local), 0.02);
  EXPECT_NEAR(walker.mover.ground().velocity.y, -1, 1e-3);
}

TEST(Mover, doesNotTrembleInACorner) {
  for (const double opening : {90.0, 40.0, 15.0}) {
    World world;
    world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    for (const double side : {1.0, -1.0}) {
      // Two walls that meet at the origin and open towards -x.
      const double half = side * opening * 0.25 * 3.14159265358979 / 180;
      const Quat turn{float(std::cos(half)), 0, float(std::sin(half)), 0};
      const Vec3d inside = rotate(turn, Vec3d{-5, 0, side * 0.5});
      fixedBox(world, {inside.x, 2, inside.z}, {5, 2, 0.5f}, turn);
    }
    Walker walker(world, {.position = {-4, 0.02, 0.1}});
    walker.walk({4, 0, 0.5f}, 120);
    Vec3d last = walker.at();
    double most = 0;
    for (int i = 0; i < 120; ++i) {
      walker.walk({4, 0, i % 2 ? 0.5f : -0.5f}, 1);
      most = std::max(most, length(walker.at() - last));
      last = walker.at();
    }
    EXPECT_LT(most, 2e-3) << opening;
    EXPECT_LT(walker.at().x, 0);
  }
}

TEST(Mover, isNotShotThroughAThinWall) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  fixedBox(world, {5, 1, 0}, {0.005f, 1, 5});
  Walker walker(world, {.position = {0, 0.02, 0}});
  walker.walk({}, 2);
  walker.walk({5000, 0, 0}, 5);
  EXPECT_NEAR(walker.at().x, 5 - 0.005 - 0.3 - 0.02, 5e-3);
  walker.mover.setPosition({0, 500, 0});
  walker.mover.move(world, {0, -1e6f, 0}, 0.01f);
  EXPECT_NEAR(walker.at().y, 0.02, 5e-3);
}

TEST(Mover, leavesWhatItOverlaps) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const BodyId wall = fixedBox(world, {0, 1, 0}, {0.5f, 1, 5});
  Mover mover({.position = {0.6, -0.1, 0}});
  for (int i = 0; i < 5; ++i) mover.move(world, {}, kStep);
  EXPECT_GE(mover.position().x, 0.8);
  EXPECT_GE(mover.position().y, 0);
  // A door that closes pushes it.
  world.setPose(wall, {{0.3, 1, 0}, {}});
  mover.move(world, {}, kStep);
  EXPECT_GE(mover.position().x, 1.1);
}

TEST(Mover, pushesWhatIsLightAndNotWhatIsHeavy) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const BodyId crate = world.create(BodyDef{.position = {2, 0.5, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = 20});
  const BodyId rock = world.create(BodyDef{.position = {2, 1, 20}, .shape = Box{1, 1, 1}, .mass = 50000});
  Walker light(world, {.position = {0, 0.02, 0}}), heavy(world, {.position = {0, 0.02, 20}});
  for (int i = 0; i < 180; ++i) {
    world.step(kStep);
    light.walk({1.5f, 0, 0}, 1);
    heavy.walk({1.5f, 0, 0}, 1);
  }
  EXPECT_GT(world.pose(crate).position.x, 3);
  EXPECT_LT(world.pose(rock).position.x, 2.05);
  EXPECT_LT(heavy.at().x, 0.75);
  for (int i = 0; i < 60; ++i) world.step(kStep);
  // Without a mass everything is a wall.
  Walker ghost(world, {.position = {world.pose(crate).position.x - 2, 0.02, 0}, .mass = 0});
  const double before = world.pose(crate).position.x;
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    ghost.walk({1.5f, 0, 0}, 1);
  }
  EXPECT_NEAR(world.pose(crate).position.x, before, 0.02);
}

TEST(Mover, walksOverAMeshAndAHeightField) {
  QueryRandom random(4);
  for (const bool isMesh : {true, false}) {
    World world;
    BodyDef ground{.type = BodyType::Static};
    if (isMesh) {
      ground.shape = Mesh{bumpyMesh(30, 1, random)};
    } else {
      ground.shape = HeightField{hills(31, 1, random)};
    }
    world.create(ground);
    Walker walker(world, {.position = {-12, 2, 0.3}});
    walker.walk({}, 60);
    ASSERT_TRUE(walker.mover.ground());
    int airborne = 0;
    for (int i = 0; i < 300; ++i) {
      walker.walk({4, 0, 0.3f}, 1);
      airborne += !walker.mover.ground();
      ASSERT_GT(walker.at().y, 0);
      ASSERT_LT(walker.at().y, 0.75);
    }
    EXPECT_GT(walker.at().x, 6) << isMesh;
    EXPECT_LT(airborne, 10) << isMesh;
  }
}

TEST(Mover, anyDirectionIsUp) {
  double reached[3];
  const Vec3 ups[3] = {{0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
  for (int k = 0; k < 3; ++k) {
    World world;
    const Quat turns[3] = {{}, {std::sqrt(0.5f), std::sqrt(0.5f), 0, 0}, {0, 1, 0, 0}};
    world.create(BodyDef{.type = BodyType::Static, .rotation = turns[k], .shape = HalfSpace{}});
    fixedBox(world, toDouble(rotate(turns[k], Vec3{2, 0.1f, 0})), {1, 0.1f, 1}, turns[k]);
    Mover mover({.position = toDouble(ups[k]) * 0.5, .up = ups[k]});
    for (int i = 0; i < 100; ++i) mover.move(world, Vec3{1, 0, 0} - ups[k] * (mover.ground() ? 0.0f : 2.0f), kStep);
    ASSERT_TRUE(mover.ground());
    reached[k] = mover.position().x;
    EXPECT_NEAR(dot(mover.position(), toDouble(ups[k])), 0.22, 5e-3);
  }
  EXPECT_NEAR(reached[0], reached[1], 1e-3);
  EXPECT_NEAR(reached[0], reached[2], 1e-3);
}

TEST(Mover, wandersThroughClutterWithoutEnteringIt) {
  for (const float speed : {1.5f, 6.0f, 40.0f}) {
    World world;
    QueryRandom random(12);
    world.create(BodyDef{.type = BodyType::Static, .shape = Mesh{bumpyMesh(20, 1, random)}});
    for (int i = 0; i < 4; ++i)
      fixedBox(world,
               {i == 0   ? 9.0
                : i == 1 ? -9.0
                         : 0,
                2,
                i == 2   ? 9.0
                : i == 3 ? -9.0
                         : 0},
               i < 2 ? Box{0.2f, 90, 9} : Box{9, 90, 0.2f});
    for (int i = 0; i < 60; ++i) {
      const Vec3d p = random.point(8);
      world.create(BodyDef{.type = BodyType::Static,
                           .position = {p.x, random.within(0, 1), p.z},
                           .rotation = random.rotation(),
                           .shape = convexGeometry(random, i % kConvexTypes)});
    }
    Walker walker(world, {.position = {0, 4, 0}});
    walker.mover.move(world, {}, kStep);
    Vec3 wanted;
    for (int i = 0; i < 1200; ++i) {
      const Vec3d before = walker.at();
      if (i % 20 == 0) wanted = random.direction();
      wanted.y = 0;
      Vec3 velocity = wanted * speed;
      if (!walker.mover.ground()) velocity.y = walker.mover.velocity().y - 9.81f * kStep;
      walker.mover.move(world, velocity, kStep);
      const Vec3d p = walker.at();
      ASSERT_LT(std::max(std::abs(p.x), std::abs(p.z)), 8.6) << speed << " step " << i;
      ASSERT_GT(p.y, -0.01) << speed << " step " << i;
      ASSERT_LT(length(p - before), 2 * double(length(velocity)) * kStep + 0.4) << speed << " step " << i;
      const NearHit worst = world.nearestClosest(walker.mover.geometry(), walker.mover.pose(), 0);
      ASSERT_FALSE(worst.shape && worst.distance < -2e-3f) << speed << " step " << i << " " << worst.distance;
    }
  }
}

TEST(Mover, refusesBadInput) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(Mover({.radius = 0}), Error);
  EXPECT_THROW(Mover({.radius = 1, .height = 1.5f}), Error);
  EXPECT_THROW(Mover({.up = {0, 2, 0}}), Error);
  EXPECT_THROW(Mover({.maxSlope = nan}), Error);
  EXPECT_THROW(Mover({.skin = 0}), Error);
  EXPECT_THROW(Mover({.skin = 0.5f}), Error);
  EXPECT_THROW(Mover({.mass = -1}), Error);
  World world;
  Mover mover({});
  EXPECT_THROW(mover.move(world, {nan, 0, 0}, kStep), Error);
  EXPECT_THROW(mover.move(world, {}, 0), Error);
  EXPECT_THROW(mover.setPosition({0, nan, 0}), Error);
}

}  // namespace
}  // namespace avbd
