// Motion of single bodies: gravity, damping, forces, limits, locks, free rotation, kinematic bodies, teleports.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

void run(World& world, int steps, float dt = kDt) {
  for (int i = 0; i < steps; ++i) world.step(dt);
}
World weightless() { return World({.gravity = {}}); }

// ---- Gravity ---------------------------------------------------------------------------------------------------

/// v += g h, x += v h in the engine's own arithmetic.
void expectFalls(World& world, BodyId id, Vec3 acceleration, float h, int substeps) {
  Vec3 v = world.velocity(id).linear;
  Vec3d x = world.pose(id).position;
  for (int i = 0; i < 100; ++i) {
    world.step(h * static_cast<float>(substeps));
    for (int k = 0; k < substeps; ++k) {
      v = v + acceleration * h;
      x = x + v * h;
    }
    ASSERT_EQ(world.velocity(id).linear, v) << "step " << i;
    ASSERT_EQ(world.pose(id).position, x) << "step " << i;
  }
}

TEST(Motion, FreeFallIsTheDiscreteFormulaToTheBit) {
  World world;
  const BodyId id = world.create(
      BodyDef{.position = {100, 2, 3}, .linearVelocity = {1, 5, -2}, .angularVelocity = {1, 2, 3}, .shape = Box{}});
  expectFalls(world, id, {0, -9.81f, 0}, kDt, 1);
  EXPECT_NEAR(world.pose(id).position.y, 2 + 5 * 100 / 60.0 - 9.81 * 100 * 101 / 7200, 2e-4);
}

TEST(Motion, SubstepsFallLikeShorterSteps) {
  World world({.substeps = 4});
  const BodyId id = world.create(BodyDef{.shape = Box{}});
  expectFalls(world, id, {0, -9.81f, 0}, kDt / 4, 4);
}

TEST(Motion, FarFromTheOriginNothingIsLost) {
  World world;
  const BodyId id = world.create(BodyDef{.position = {1e7, 1e7, -1e7}, .shape = Sphere{}});
  run(world, 60);
  EXPECT_NEAR(world.pose(id).position.y - 1e7, -9.81 * 60 * 61 / 7200, 1e-5);
}

TEST(Motion, GravityScale) {
  for (const float scale : {0.0f, 1.0f, -2.0f, 0.5f}) {
    World world;
    const BodyId id = world.create(BodyDef{.shape = Sphere{}, .gravityScale = scale});
    run(world, 60);
    EXPECT_NEAR(world.velocity(id).linear.y, -9.81f * scale, 1e-4f);
    world.setGravityScale(id, 0);
    world.setVelocity(id, {});
    run(world, 10);
    EXPECT_EQ(world.velocity(id), Velocity{});
  }
}

// ---- Damping and limits ----------------------------------------------------------------------------------------

TEST(Motion, DampingIsExponentialAtAnyStep) {
  for (const float dt : {1.0f / 240, kDt, 0.25f})
    for (const float rate : {0.1f, 1.0f, 7.0f}) {
      World world = weightless();
      const BodyId id = world.create(BodyDef{.linearVelocity = {3, 0, 0},
                                             .angularVelocity = {0, 0, 2},
                                             .shape = Sphere{},
                                             .linearDamping = rate,
                                             .angularDamping = 2 * rate,
                                             .canSleep = false});
      run(world, static_cast<int>(std::lround(1 / dt)), dt);
      EXPECT_NEAR(world.velocity(id).linear.x / (3 * std::exp(-rate)), 1, 1e-4) << dt << " " << rate;
      EXPECT_NEAR(world.velocity(id).angular.z / (2 * std::exp(-2 * rate)), 1, 2e-4) << dt << " " << rate;
    }
}

TEST(Motion, DampingMayBeEnormous) {
  World world;
  const BodyId id = world.create(BodyDef{.linearVelocity = {3, 0, 0},
                                         .angularVelocity = {0, 9, 0},
                                         .shape = Sphere{},
                                         .linearDamping = 1e6f,
                                         .angularDamping = 1e6f});
  run(world, 10);
  EXPECT_LT(length(world.velocity(id).linear), 1e-8f);
  EXPECT_LT(length(world.velocity(id).angular), 1e-8f);
}

TEST(Motion, SpeedsStayWithinTheirLimits) {
  World world;
  const BodyId id = world.create(
      BodyDef{.angularVelocity = {0, 30, 40}, .shape = Sphere{}, .maxLinearSpeed = 3, .maxAngularSpeed = 5});
  for (int i = 0; i < 60; ++i) {
    world.step(kDt);
    ASSERT_LE(length(world.velocity(id).linear), 3 * (1 + 1e-6f));
    ASSERT_LE(length(world.velocity(id).angular), 5 * (1 + 1e-6f));
  }
  EXPECT_NEAR(world.velocity(id).linear.y, -3, 1e-5);
  EXPECT_LT(length(world.velocity(id).angular - Vec3{0, 3, 4}), 1e-4f) << "scaled, not cut";
  world.setMaxSpeeds(id, 1e4f, 1e3f);
  run(world, 1);
  EXPECT_NEAR(world.velocity(id).linear.y, -3 - 9.81 / 60, 1e-4);
}

// ---- Forces ----------------------------------------------------------------------------------------------------

TEST(Motion, ForcesTorquesAndImpulses) {
  World world = weightless();
  const MassProperties mass{.mass = 4, .inertia = {2, 4, 5, 0, 0, 0}};
  const BodyId id = world.create(BodyDef{.massProperties = mass});
  world.addForce(id, {8, 0, 0});
  world.addForce(id, {0, 4, 0});
  world.step(0.5f);
  EXPECT_EQ(world.velocity(id).linear, (Vec3{1, 0.5f, 0}));
  EXPECT_EQ(world.pose(id).position, (Vec3d{0.5, 0.25, 0}));
  world.step(0.5f);
  EXPECT_EQ(world.velocity(id).linear, (Vec3{1, 0.5f, 0})) << "forces act once";
  world.addImpulse(id, {-4, -2, 0});
  EXPECT_EQ(world.velocity(id), Velocity{});
  world.addTorque(id, {0, 0, 10});
  world.step(0.25f);
  EXPECT_EQ(world.velocity(id).angular, (Vec3{0, 0, 0.5f}));
  world.addAngularImpulse(id, {0, 0, -2.5f});
  EXPECT_LT(length(world.velocity(id).angular), 1e-7f);
  world.setPose(id, {{1, 2, 3}, {}});
  world.addForceAt(id, {0, 8, 0}, {2, 2, 3});
  world.step(0.25f);
  EXPECT_EQ(world.velocity(id).linear, (Vec3{0, 0.5f, 0}));
  EXPECT_LT(length(world.velocity(id).angular - Vec3{0, 0, 0.4f}), 1e-6f);
}

TEST(Motion, ForcesActInEverySubstep) {
  World world({.gravity = {}, .substeps = 4});
  const BodyId id = world.create(BodyDef{.massProperties = MassProperties{.mass = 2}});
  world.addForce(id, {0, 0, 12});
  world.addTorque(id, {3, 0, 0});
  world.step(0.5f);
  EXPECT_NEAR(world.velocity(id).linear.z, 3, 1e-6);
  EXPECT_NEAR(world.velocity(id).angular.x, 1.5, 1e-6);
}

// ---- Free rotation ---------------------------------------------------------------------------------------------

struct Spin {
  const char* name;
  Vec3 velocity;
};
void PrintTo(const Spin& spin, std::ostream* out) { *out << spin.name; }
class FreeRotation : public testing::TestWithParam<Spin> {};

TEST_P(FreeRotation, KeepsAngularMomentumAndEnergy) {
  World world = weightless();
  const BodyId id = world.create(
      BodyDef{.rotation = {0.8f, 0.6f, 0, 0}, .angularVelocity = GetParam().velocity, .shape = Box{0.2f, 0.5f, 1}});
  const Vec3d before = world.angularMomentum();
  const double energy = world.kineticEnergy();
  double worst = 0, worstEnergy = 0;
  for (int i = 0; i < 600; ++i) {
    world.step(kDt);
    worst = std::max(worst, length(world.angularMomentum() - before) / length(before));
    worstEnergy = std::max(worstEnergy, std::abs(world.kineticEnergy() / energy - 1));
  }
  EXPECT_LT(worst, 5e-4);
  EXPECT_LT(worstEnergy, 0.03);
  EXPECT_LT(length(world.pose(id).position), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Spins, FreeRotation,
                         testing::Values(Spin{"Precession", {2, 1, 3}}, Spin{"Intermediate", {0, 5, 0.01f}},
                                         Spin{"Fast", {10, 3, 8}}),
                         [](const auto& spin) { return spin.param.name; });

/// A symmetric top: its axis goes round the momentum at |L| / I1.
TEST(Motion, SymmetricTopPrecessesAtItsRate) {
  World world = weightless();
  const MassProperties mass{.mass = 1, .inertia = {1, 1.8f, 1, 0, 0, 0}};
  const BodyId id = world.create(BodyDef{.angularVelocity = {0.6f, 4, 0}, .massProperties = mass});
  const Vec3d momentum = world.angularMomentum();
  const double rate = length(momentum) / 1.0, time = 6;
  run(world, static_cast<int>(time * 240), 1.0f / 240);
  // Angle of the axis about the momentum, against where it began.
  const Vec3 n = toFloat(momentum * (1 / length(momentum)));
  const Vec3 axis = rotate(world.pose(id).rotation, Vec3{0, 1, 0}), start{0, 1, 0};
  const Vec3 across = axis - dot(axis, n) * n, first = start - dot(start, n) * n;
  const double turned = std::atan2(dot(n, cross(first, across)), dot(first, across));
  EXPECT_NEAR(std::remainder(turned - rate * time, 2 * M_PI), 0, 0.02);
  EXPECT_NEAR(dot(axis, n), dot(start, n), 1e-3) << "the angle to the momentum stays";
}

// ---- Locks, kinematic bodies, teleports ------------------------------------------------------------------------

TEST(Motion, LockedAxesStayExactly) {
  for (const int locks : {1, 2, 4, 8, 16, 32, 7, 56, 63, 42, 21}) {
    World world;
    world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    const BodyId id = world.create(BodyDef{.position = {0, 0.6, 0},
                                           .linearVelocity = {1, -1, 2},
                                           .angularVelocity = {1, 2, 3},
                                           .shape = Box{0.5f, 0.4f, 0.3f},
                                           .locks = static_cast<uint8_t>(locks)});
    const BodyId ball = world.create(BodyDef{.position = {0.2, 2, 0.1}, .shape = Sphere{0.2f}, .density = 5000});
    const Vec3d start = world.pose(id).position;
    for (int i = 0; i < 120; ++i) {
      world.addForceAt(id, {300, 0, 200}, {0.3, 0.7, -0.2});
      world.step(kDt);
      const Vec3d p = world.pose(id).position;
      const Velocity v = world.velocity(id);
      const double moved[3] = {p.x - start.x, p.y - start.y, p.z - start.z};
      const float rate[6] = {v.linear.x, v.linear.y, v.linear.z, v.angular.x, v.angular.y, v.angular.z};
      for (int axis = 0; axis < 6; ++axis) {
        if (!(locks >> axis & 1)) continue;
        ASSERT_EQ(rate[axis], 0) << "axis " << axis << " of " << locks;
        ASSERT_EQ(axis < 3 ? moved[axis] : 0.0, 0) << "axis " << axis << " of " << locks;
      }
      ASSERT_TRUE((locks & 56) != 56 || world.pose(id).rotation == Quat{});
    }
    EXPECT_TRUE(std::isfinite(world.pose(ball).position.y));
  }
}

TEST(Motion, OneFreeAxisOfRotationIsTurnedAbout) {
  World world = weightless();
  const BodyId id = world.create(BodyDef{.angularVelocity = {0, 2, 0}, .shape = Box{0.2f, 0.5f, 1}, .locks = 8 | 32});
  run(world, 60);
  EXPECT_NEAR(world.velocity(id).angular.y, 2, 1e-4);
  const Quat q = world.pose(id).rotation;
  EXPECT_NEAR(2 * std::atan2(q.y, q.w), 2, 1e-3);
  EXPECT_EQ(std::abs(q.x) + std::abs(q.z), 0);
}

// Held joints must not depend on which of two bodies was made first.
TEST(Motion, LockedBodyHoldsWhatHangsOnIt) {
  for (const bool lockedFirst : {true, false}) {
    World world;
    const BodyDef held{
        .position = {0, 2, 0}, .shape = Box{0.2f, 0.2f, 0.2f}, .locks = kLockLinearX | kLockLinearY | kLockLinearZ};
    const BodyDef hanging{.position = {0, 1, 0}, .shape = Box{0.2f, 0.2f, 0.2f}};
    const BodyId first = world.create(lockedFirst ? held : hanging),
                 second = world.create(lockedFirst ? hanging : held);
    const BodyId top = lockedFirst ? first : second, bottom = lockedFirst ? second : first;
    const JointId joint = world.create(
        BallJoint{.bodyA = top, .bodyB = bottom, .frameA = {{0, -0.5, 0}, {}}, .frameB = {{0, 0.5, 0}, {}}});
    run(world, 120);
    EXPECT_LT(world.gap(joint), 1e-3) << lockedFirst;
    EXPECT_NEAR(world.reaction(joint).force.y, -9.81f * world.mass(bottom), 5) << lockedFirst;
  }
}

TEST(Motion, KinematicBodiesMoveAtTheirVelocity) {
  World world;
  const BodyId lift = world.create(BodyDef{
      .type = BodyType::Kinematic, .linearVelocity = {0, 0.5f, 0}, .angularVelocity = {0, 1, 0}, .shape = Box{}});
  world.create(BodyDef{.position = {0, 1, 0}, .shape = Box{0.4f, 0.4f, 0.4f}, .density = 1e5f});
  run(world, 120);
  EXPECT_NEAR(world.pose(lift).position.y, 1, 1e-5) << "nothing pushes it";
  const Quat q = world.pose(lift).rotation;
  EXPECT_NEAR(2 * std::atan2(q.y, q.w), 2, 1e-4);
  EXPECT_EQ(world.velocity(lift).linear, (Vec3{0, 0.5f, 0}));
}

TEST(Motion, KinematicPlateDragsAndWallPushes) {
  World world;
  const BodyId plate = world.create(BodyDef{
      .type = BodyType::Kinematic, .position = {0, -0.5, 0}, .linearVelocity = {1, 0, 0}, .shape = Box{20, 0.5f, 20}});
  const BodyId box = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}});
  run(world, 15);
  // mu g t until it keeps up.
  EXPECT_NEAR(world.velocity(box).linear.x, std::min(1.0, 0.5 * 9.81 * 0.25), 0.08);
  run(world, 165);
  EXPECT_NEAR(world.velocity(box).linear.x, 1, 2e-3);
  EXPECT_NEAR(world.pose(box).position.x - world.pose(plate).position.x, -0.5 / (0.5 * 9.81), 0.02);
  world.setVelocity(plate, {});
  run(world, 120);
  EXPECT_LT(length(world.velocity(box).linear), 2e-3f);
  const double before = world.pose(box).position.x;
  world.create(BodyDef{.type = BodyType::Kinematic,
                       .position = {before - 1.6, 0.5, 0},
                       .linearVelocity = {0.5f, 0, 0},
                       .shape = Box{0.1f, 0.4f, 3}});
  run(world, 240);
  EXPECT_NEAR(world.pose(box).position.x, before - 1.6 + 2 + 0.6, 0.01) << "pushed along";
  EXPECT_NEAR(world.velocity(box).linear.x, 0.5, 5e-3);
}

TEST(Motion, TeleportKeepsTheVelocity) {
  World world;
  const BodyId id = world.create(BodyDef{.linearVelocity = {1, 2, 3}, .angularVelocity = {0, 0, 4}, .shape = Sphere{}});
  run(world, 10);
  const Velocity before = world.velocity(id);
  world.setPose(id, {{500, 600, 700}, {0, 1, 0, 0}});
  EXPECT_EQ(world.velocity(id), before);
  world.step(kDt);
  EXPECT_NEAR(world.pose(id).position.x, 500 + 1 / 60.0, 1e-5);
}

}  // namespace
}  // namespace avbd
