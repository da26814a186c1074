// Soft bodies in a world: made, refused, carried, attached, asleep, saved, the same bits.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "api/soft_cases.h"

namespace avbd {
namespace {

std::shared_ptr<const SoftMeshData> cube() { return makeTetBox({0.25f, 0.25f, 0.25f}, 3, 3, 3); }

struct OnTheGround : testing::Test {
  World world;
  BodyId ground = world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  SoftId soft = world.create(SoftDef{.mesh = cube(), .pose = {{0, 0.3, 0}, {}}, .userData = 7});
};

TEST_F(OnTheGround, SaysWhatItIs) {
  EXPECT_EQ(world.softBodies(), std::vector<SoftId>{soft});
  EXPECT_EQ(world.userData(soft), 7u);
  const std::vector<BodyId> particles = world.particles(soft);
  ASSERT_EQ(particles.size(), 64u);
  EXPECT_EQ(world.bodyCount(), 65u);
  EXPECT_EQ(world.softBody(particles[5]), soft);
  EXPECT_FALSE(world.softBody(ground));
  double mass = 0;
  for (const BodyId p : particles) mass += double{world.mass(p)};
  EXPECT_NEAR(mass, 125, 1e-3);
  EXPECT_NEAR(world.volume(soft), 0.125, 1e-6);
  std::vector<Vec3d> points(64);
  world.getPoints(soft, points);
  for (size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i], world.pose(particles[i]).position);
  std::vector<Vec3d> few(3);
  EXPECT_THROW(world.getPoints(soft, few), Error);
}

TEST_F(OnTheGround, TheGroundCarriesItsWeight) {
  run(world, 60);
  float force = 0;
  for (const Contact& contact : world.contacts())
    for (int i = 0; i < contact.pointCount; ++i) force += contact.points[static_cast<size_t>(i)].normalForce;
  EXPECT_NEAR(force, 125 * 9.81, 0.01 * 125 * 9.81);
  for (const BodyId p : world.particles(soft)) EXPECT_GT(world.pose(p).position.y, 0.01 - 0.002);
}

TEST_F(OnTheGround, CarriesABoxByItsPointsAndFaces) {
  const BodyId box = world.create(BodyDef{.position = {0, 0.72, 0}, .shape = Box{0.2f, 0.1f, 0.2f}, .mass = 20});
  run(world, 240);
  float byPoints = 0, byFaces = 0;
  for (const Contact& contact : world.contacts()) {
    if (contact.bodyA != box && contact.bodyB != box) continue;
    const bool above = contact.bodyB == box;
    EXPECT_EQ(above ? contact.softA : contact.softB, soft);
    EXPECT_EQ(above ? contact.softB : contact.softA, SoftId{});
    EXPECT_EQ(above ? contact.shapeB : contact.shapeA, world.shapes(box)[0]);
    EXPECT_GT(contact.normal.y * (above ? 1.0f : -1.0f), 0.5f);
    EXPECT_NEAR(contact.points[0].position.y, world.pose(box).position.y - 0.11, 0.03);
    float& force = (above ? contact.elementA : contact.elementB) == kNoElement ? byPoints : byFaces;
    for (int i = 0; i < contact.pointCount; ++i) force += contact.points[static_cast<size_t>(i)].normalForce;
  }
  EXPECT_GT(byFaces, 10);
  EXPECT_NEAR(byPoints + byFaces, 20 * 9.81, 0.01 * 20 * 9.81);
}

TEST_F(OnTheGround, CarriesAnotherByItsFaces) {
  const auto small = makeTetBox({0.15f, 0.1f, 0.15f}, 3, 2, 3);
  const SoftId upper =
      world.create(SoftDef{.mesh = small, .pose = {{0, 0.68, 0}, {}}, .material = {.youngsModulus = 1e6f}});
  run(world, 180);
  float force = 0;
  for (const Contact& contact : world.contacts()) {
    if (!contact.softA || !contact.softB || contact.softA == contact.softB) continue;
    const float sign = contact.softB == upper ? 1.0f : -1.0f;
    for (int i = 0; i < contact.pointCount; ++i)
      force += contact.points[static_cast<size_t>(i)].normalForce * contact.normal.y * sign;
  }
  EXPECT_NEAR(force, 18 * 9.81, 0.02 * 18 * 9.81);
}

TEST_F(OnTheGround, FallsAsleepAndWakesAsAWhole) {
  run(world, 240);
  const std::vector<BodyId> particles = world.particles(soft);
  for (const BodyId p : particles) EXPECT_FALSE(world.isAwake(p));
  world.addImpulse(particles[30], {0, 5, 0});
  for (const BodyId p : particles) EXPECT_TRUE(world.isAwake(p));
  run(world, 1);
  EXPECT_EQ(world.report().bodies, 64u);
}

TEST_F(OnTheGround, IsGoneWithItsParticles) {
  const std::vector<BodyId> particles = world.particles(soft);
  run(world, 30);
  world.destroy(soft);
  EXPECT_FALSE(world.isAlive(soft));
  EXPECT_EQ(world.bodyCount(), 1u);
  for (const BodyId p : particles) EXPECT_FALSE(world.isAlive(p));
  EXPECT_THROW(world.volume(soft), Error);
  run(world, 3);
  EXPECT_EQ(world.report().bodies, 0u);
  const SoftId next = world.create(SoftDef{.mesh = cube(), .pose = {{0, 1, 0}, {}}});
  EXPECT_NE(next, soft);
  run(world, 3);
}

TEST_F(OnTheGround, AParticleCannotGoAlone) {
  const BodyId particle = world.particles(soft)[0];
  try {
    world.destroy(particle);
    FAIL() << "destroyed";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("particle of a soft body"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(world.isAlive(particle));
}

TEST(Soft, AttachedToABodyBothFeelIt) {
  World world(WorldDef{.gravity = {}});
  const SoftId soft = world.create(SoftDef{.mesh = cube()});
  const BodyId corner = world.particles(soft)[0];
  const Vec3d at = world.pose(corner).position;
  const BodyId ball = world.create(
      BodyDef{.position = at, .linearVelocity = {0, 0, 3}, .shape = Sphere{0.05f}, .mass = 10, .filter = {.mask = 0}});
  const JointId joint = world.create(BallJoint{.bodyA = corner, .bodyB = ball});
  for (int i = 0; i < 120; ++i) {
    world.step(kDt);
    EXPECT_LT(world.gap(joint), 1e-3);
  }
  EXPECT_NEAR(world.momentum().z, 30, 0.03);
  EXPECT_LT(world.velocity(ball).linear.z, 2.5f);
}

/// Floats cannot tell where features of such size are nearest.
TEST(Soft, WhatIsBlownApartTouchesNothingOrFails) {
  World world;
  const SoftId cloth = world.create(SoftDef{.mesh = makeClothGrid(1, 0.7f, 4, 2), .material = {.youngsModulus = 5e5f}});
  const std::vector<BodyId> particles = world.particles(cloth);
  for (size_t i = 0; i < particles.size(); i += 2)
    world.setPose(particles[i], {{(i % 4 ? -1 : 1) * 9e8, 5e7 * static_cast<double>(i), i % 3 ? 7e8 : -8e8}, {}});
  try {
    for (int i = 0; i < 3; ++i) {
      world.step(kDt);
      for (const Contact& c : world.contacts()) EXPECT_NEAR(length(c.normal), 1, 1e-3);
    }
  } catch (const NonFiniteError&) {
  }
}

TEST(Soft, AnAttachmentBreaks) {
  World world;
  const SoftId soft = world.create(SoftDef{.mesh = cube(), .pose = {{0, 5, 0}, {}}});
  const BodyId corner = world.particles(soft)[0];
  const JointId joint = world.create(BallJoint{.bodyA = corner, .frameB = {world.pose(corner).position, {}}});
  world.setBreakLimits(joint, {.force = 500});
  run(world, 120);
  EXPECT_FALSE(world.isEnabled(joint));
  EXPECT_LT(world.pose(corner).position.y, 0);
}

std::string complaint(SoftDef def) {
  World world;
  if (!def.mesh) def.mesh = cube();
  try {
    world.create(def);
  } catch (const Error& error) {
    EXPECT_EQ(world.bodyCount(), 0u);
    EXPECT_TRUE(world.softBodies().empty());
    return error.what();
  }
  return "accepted";
}

void expectRefused(const SoftDef& def, const char* part) {
  const std::string said = complaint(def);
  EXPECT_NE(said.find(part), std::string::npos) << said;
}

TEST(Soft, WhatIsNoneIsRefusedByName) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(World().create(SoftDef{}), Error);
  for (const float bad : {0.0f, -1.0f, nan}) {
    expectRefused({.material = {.youngsModulus = bad}}, "youngsModulus");
    expectRefused({.material = {.density = bad}}, "density");
    expectRefused({.radius = bad}, "radius");
  }
  for (const float bad : {0.5f, 0.7f, -1.0f, nan}) expectRefused({.material = {.poissonRatio = bad}}, "poissonRatio");
  expectRefused({.pose = {{0, double{nan}, 0}, {}}}, "pose");
  expectRefused({.pose = {{}, {0, 0, 0, 0}}}, "pose");
  expectRefused({.velocity = {{nan, 0, 0}, {}}}, "velocity");
  expectRefused({.surface = {.friction = -1}}, "surface");
  expectRefused({.material = {.thickness = 0}}, "thickness");
  expectRefused({.material = {.bending = nan}}, "bending");
  expectRefused({.material = {.poissonRatio = 0.5f}},
                "poissonRatio = 0.5: must be finite and >= -0.9 and at most 0.4999");
  expectRefused({.material = {.poissonRatio = 0.49f, .model = SolidModel::Corotational}},
                "poissonRatio = 0.49: must be at most 0.48 where model is Corotational");
  EXPECT_EQ(complaint({.material = {.poissonRatio = 0.48f, .model = SolidModel::Corotational}}), "accepted");
  expectRefused({.material = {.model = static_cast<SolidModel>(2)}}, "model = 2: must be NeoHookean or Corotational");
  for (const float bad : {-1.0f, nan, 1e7f}) expectRefused({.material = {.damping = bad}}, "damping");
  for (const float bad : {0.0f, nan, 1e7f}) expectRefused({.material = {.maxStrain = bad}}, "maxStrain");
  for (const float bad : {0.0f, nan, 1e14f}) {
    expectRefused({.material = {.warp = {1, 0, 0}, .weftModulus = bad}}, "weftModulus");
    expectRefused({.material = {.warp = {1, 0, 0}, .shearModulus = bad}}, "shearModulus");
  }
  expectRefused({.material = {.warp = {nan, 0, 0}}}, "warp");
  expectRefused({.material = {.weftModulus = 1e5f}}, "warp = (0, 0, 0): must be longer than");
  // Of some particle alone.
  expectRefused({.pose = {{1e9, 0, 0}, {}}}, "pose");
  expectRefused({.velocity = {{1e9f, 0, 0}, {0, 1e6f, 0}}}, "velocity");
  expectRefused({.material = {.density = 1e-20f}, .radius = 1e-6f}, "radius");
}

/// How far the end of a strip of 0.2 m sinks that is clamped at the other, of what a plate does.
TEST(Cloth, BendsAsAPlateDoes) {
  World world;
  const auto mesh = makeClothGrid(0.11f, 0.02f, 22, 4);        // 0.2 m, and a clamp of two columns
  constexpr float kMass = 0.4f, kLength = 0.2f, kSag = 0.01f;  // [kg/m^2], [m], [m]
  const SoftId id =
      world.create(SoftDef{.mesh = mesh,
                           .material = {.youngsModulus = 1e6f,
                                        .poissonRatio = 0,
                                        .density = kMass / 0.001f,
                                        .thickness = 0.001f,
                                        .bending = kMass * 9.81f * kLength * kLength * kLength * kLength / (8 * kSag)},
                           .radius = 0.001f});
  const std::vector<BodyId> particles = world.particles(id);
  double end = 0;
  int count = 0;
  for (size_t i = 0; i < particles.size(); ++i)
    if (mesh->points()[i].x < -0.0899f) world.setLocks(particles[i], kLockLinearX | kLockLinearY | kLockLinearZ);
  run(world, 240);
  for (size_t i = 0; i < particles.size(); ++i)
    if (mesh->points()[i].x > 0.1099f) end -= world.pose(particles[i]).position.y, ++count;
  // A grid of right triangles is softer than a plate (rows/cloth_bend.h).
  EXPECT_GT(end / count, 1.1 * double{kSag});
  EXPECT_LT(end / count, 1.5 * double{kSag});
}

TEST(Cloth, HangsWithLittleStrainAndKeepsItsWeight) {
  World world;
  const auto mesh = makeClothGrid(0.5f, 0.5f, 10, 10);
  const SoftId id =
      world.create(SoftDef{.mesh = mesh,
                           .pose = {{}, {0.70710678f, 0.70710678f, 0, 0}},
                           .material = {.youngsModulus = 1e6f, .density = 500, .thickness = 0.001f, .bending = 1e-5f}});
  const std::vector<BodyId> particles = world.particles(id);
  std::vector<JointId> hooks;
  float mass = 0;
  for (size_t i = 0; i < particles.size(); ++i) {
    mass += world.mass(particles[i]);
    if (mesh->points()[i].z < -0.499f)
      hooks.push_back(
          world.create(BallJoint{.bodyA = particles[i], .frameB = {world.pose(particles[i]).position, {}}}));
  }
  EXPECT_NEAR(mass, 0.5, 1e-4);
  run(world, 240);
  float force = 0;
  for (const JointId hook : hooks) force += world.reaction(hook).force.y;
  EXPECT_NEAR(std::abs(force), 0.5 * 9.81, 0.02 * 0.5 * 9.81);
  double lowest = 0;
  for (const BodyId p : particles) lowest = std::min(lowest, world.pose(p).position.y);
  EXPECT_NEAR(lowest, -0.5, 0.01);
}

TEST(Cloth, FallsOnABallAndStaysThere) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  world.create(BodyDef{.type = BodyType::Static, .position = {0, 0.5, 0}, .shape = Sphere{0.5f}});
  const SoftId id = world.create(SoftDef{.mesh = makeClothGrid(0.6f, 0.6f, 16, 16),
                                         .pose = {{0, 1.1, 0}, {}},
                                         .material = {.youngsModulus = 2e5f, .density = 300, .thickness = 0.001f}});
  run(world, 180);
  double highest = 0;
  for (const BodyId p : world.particles(id)) {
    const Vec3d at = world.pose(p).position, off = at - Vec3d{0, 0.5, 0};
    EXPECT_GT(std::sqrt(dot(off, off)), 0.5 + 0.01 - 0.003);
    highest = std::max(highest, at.y);
  }
  EXPECT_GT(highest, 1);
}

/// Two cubes, one of them tied to a box, on the ground.
World twoCubes(const WorldDef& def) {
  World world(def);
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const BodyId box = world.create(BodyDef{.position = {0, 0.9, 0}, .shape = Box{0.2f, 0.2f, 0.2f}, .mass = 20});
  for (const double x : {0.0, 1.0}) {
    const SoftId soft = world.create(SoftDef{.mesh = cube(), .pose = {{x, 0.3, 0}, {}}, .velocity = {{1, 0, 0}, {}}});
    const BodyId top = world.particles(soft).back();
    if (x == 0)
      world.create(
          BallJoint{.bodyA = top, .bodyB = box, .frameB = {world.pose(top).position - world.pose(box).position, {}}});
  }
  return world;
}

TEST(Soft, TheSameBitsForAllWidthsAndWorkers) { expectSameBitsForAllWidthsAndWorkers(twoCubes, 60); }

TEST(Soft, ASnapshotGoesOnAsIfNothingHadBeen) { expectSnapshotGoesOn(twoCubes); }

TEST(Soft, BlockSweepsOfOthersDoNotMind) {
  World world = twoCubes({.primalSolver = PrimalSolver::BlockSweep});
  run(world, 120);
  for (const SoftId soft : world.softBodies()) EXPECT_NEAR(world.volume(soft), 0.125, 0.01);
}

}  // namespace
}  // namespace avbd
