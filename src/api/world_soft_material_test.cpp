// What soft bodies are made of, in a world: damped, incompressible, limited, woven. Figures against theory are lines of
// acceptance (scenes/lines_material.cpp).
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>

#include "api/soft_cases.h"

namespace avbd {
namespace {

/// One of each kind falls on the ground, sheets with a weight on a corner.
World oneOfEach(const WorldDef& def) {
  World world(def);
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const auto cube = makeTetBox({0.2f, 0.2f, 0.2f}, 2, 2, 2);
  const SoftMaterial solids[] = {{.youngsModulus = 1e5f, .damping = 0.05f},
                                 {.youngsModulus = 1e5f, .poissonRatio = 0.4999f},
                                 {.youngsModulus = 3e5f, .poissonRatio = 0.4999f, .damping = 0.1f},
                                 {.youngsModulus = 1e5f, .model = SolidModel::Corotational},
                                 {.youngsModulus = 1e5f, .damping = 0.05f, .model = SolidModel::Corotational}};
  double x = 0;
  for (const SoftMaterial& material : solids)
    world.create(
        SoftDef{.mesh = cube, .pose = {{x += 1, 0.3, 0}, {}}, .velocity = {{1, 0, 0}, {}}, .material = material});
  const SoftMaterial sheets[] = {
      {.youngsModulus = 1e4f, .thickness = 0.001f, .damping = 0.05f, .maxStrain = 0.05f},
      {.youngsModulus = 1e5f, .thickness = 0.001f, .warp = {1, 0, 1}, .weftModulus = 1e4f, .shearModulus = 1e3f}};
  for (const SoftMaterial& material : sheets) {
    const SoftId id = world.create(
        SoftDef{.mesh = makeClothGrid(0.3f, 0.3f, 4, 4), .pose = {{x += 1, 1, 0}, {}}, .material = material});
    const std::vector<BodyId> points = world.particles(id);
    world.setLocks(points[0], kLockLinearX | kLockLinearY | kLockLinearZ);
    const BodyId weight = world.create(BodyDef{
        .position = world.pose(points.back()).position, .shape = Sphere{0.05f}, .mass = 2, .filter = {.mask = 0}});
    world.create(BallJoint{.bodyA = weight, .bodyB = points.back()});
  }
  return world;
}

TEST(SoftMaterial, IsKeptAsItWasGiven) {
  const SoftMaterial given{.poissonRatio = 0.4f,
                           .damping = 0.25f,
                           .maxStrain = 0.1f,
                           .warp = {0, 0, 2},
                           .weftModulus = 7e4f,
                           .shearModulus = 9e3f,
                           .model = SolidModel::Corotational};
  World world;
  const SoftMaterial got = world.material(world.create(SoftDef{.mesh = makeClothGrid(1, 1, 2, 2), .material = given}));
  EXPECT_EQ(got.damping, given.damping);
  EXPECT_EQ(got.maxStrain, given.maxStrain);
  EXPECT_EQ(got.warp, given.warp);
  EXPECT_EQ(got.weftModulus, given.weftModulus);
  EXPECT_EQ(got.shearModulus, given.shearModulus);
  EXPECT_EQ(got.model, given.model);
}

TEST(SoftMaterial, OfEveryKindTheSameBitsForAllWidthsAndWorkers) {
  expectSameBitsForAllWidthsAndWorkers(oneOfEach, 40);
}

TEST(SoftMaterial, ASnapshotHoldsPressuresAndTensions) { expectSnapshotGoesOn(oneOfEach); }

/// Elastic and viscous forces are inner ones, and take no energy from a body that moves and turns as a whole.
TEST(SoftMaterial, DampingDoesNotHinderFlightAndTurn) {
  World world(WorldDef{.gravity = {}});
  const SoftId id = world.create(SoftDef{.mesh = makeTetBox({0.2f, 0.2f, 0.2f}, 2, 2, 2),
                                         .velocity = {{3, 0, 0}, {0, 2, 0}},
                                         .material = {.damping = 0.5f}});
  const double momentum = world.momentum().x, turn = world.angularMomentum().y;
  run(world, 120);
  EXPECT_NEAR(world.momentum().x / momentum, 1, 1e-5);
  EXPECT_NEAR(world.angularMomentum().y / turn, 1, 0.01);
  EXPECT_NEAR(world.volume(id), 0.064, 0.001);
}

/// The larger the damping, the less of a swing is left, and no swing is wider than the one before.
TEST(SoftMaterial, DampedSwingsOnlyShrink) {
  double before = 1;
  for (const float damping : {0.0f, 0.05f, 0.1f}) {
    World world(WorldDef{.gravity = {}, .sleep = false});
    const auto mesh = makeTetBox({0.5f, 0.05f, 0.05f}, 8, 1, 1);
    const SoftId id = world.create(SoftDef{
        .mesh = mesh, .material = {.youngsModulus = 4e3f, .poissonRatio = 0, .density = 1000, .damping = damping}});
    const std::vector<BodyId> points = world.particles(id);
    for (size_t i = 0; i < points.size(); ++i) world.setVelocity(points[i], {{0.1f * mesh->points()[i].x, 0, 0}, {}});
    double last = 1;
    for (int swing = 0; swing < 4; ++swing) {
      double widest = 0;
      for (int i = 0; i < 30; ++i) {  // half a period
        world.step(kDt);
        widest = std::max(widest, std::abs(world.pose(points.back()).position.x - double{mesh->points().back().x}));
      }
      EXPECT_LT(widest, last) << damping;
      last = widest;
    }
    EXPECT_LT(last, before) << damping;
    before = last;
  }
}

TEST(SoftMaterial, AnIncompressibleCubeKeepsItsVolumeUnderAWeight) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const SoftId id = world.create(SoftDef{.mesh = makeTetBox({0.2f, 0.2f, 0.2f}, 3, 3, 3),
                                         .pose = {{0, 0.21, 0}, {}},
                                         .material = {.youngsModulus = 1e5f, .poissonRatio = 0.4999f}});
  world.create(BodyDef{.position = {0, 0.48, 0}, .shape = Box{0.3f, 0.05f, 0.3f}, .mass = 60});
  run(world, 180);
  EXPECT_NEAR(world.volume(id) / 0.064, 1, 0.001);
  double top = 0;
  for (const BodyId p : world.particles(id)) top = std::max(top, world.pose(p).position.y);
  EXPECT_LT(top, 0.4);  // it did give way
}

/// Two models meet in one island: a cube of either rests on the other, and both come to the sag of their weights.
TEST(SoftMaterial, SolidsOfBothModelsStandOnEachOther) {
  for (const SolidModel below : {SolidModel::NeoHookean, SolidModel::Corotational}) {
    World world;
    world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    double y = 0.21;
    for (const SolidModel model :
         {below, below == SolidModel::NeoHookean ? SolidModel::Corotational : SolidModel::NeoHookean}) {
      world.create(SoftDef{.mesh = makeTetBox({0.2f, 0.2f, 0.2f}, 2, 2, 2),
                           .pose = {{0, y, 0}, {}},
                           .material = {.youngsModulus = 1e5f, .model = model}});
      y += 0.42;
    }
    run(world, 240);
    for (const SoftId id : world.softBodies()) EXPECT_NEAR(world.volume(id) / 0.064, 1, 0.05);
    EXPECT_NEAR(world.pose(world.particles(world.softBodies()[1]).back()).position.y, 0.83, 0.05);
  }
}

}  // namespace
}  // namespace avbd
