// Rolling and torsional friction in a running world.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;
constexpr double kGravity = 9.81;

BodyId addGround(World& world, const Material& material, Quat turn = {}) {
  return world.create(BodyDef{.type = BodyType::Static, .rotation = turn, .shape = HalfSpace{}, .material = material});
}
Quat slope(double angle) {
  return {static_cast<float>(std::cos(angle / 2)), 0, 0, -static_cast<float>(std::sin(angle / 2))};
}

class Rolling : public testing::TestWithParam<PrimalSolver> {};

// With v = w r: m v' = F, I w' = -c m g - F r, I = 2/5 m r^2, hence v' = -5/7 g c / r.
TEST_P(Rolling, ABallSlowsDownAsItsCoefficientSays) {
  for (const float radius : {0.2f, 0.5f}) {
    const float c = 0.02f, speed = 2;
    const Material material{.friction = 0.8f, .rollingFriction = c};
    World world({.primalSolver = GetParam()});
    addGround(world, material);
    const BodyId ball = world.create(BodyDef{.position = {0, radius, 0},
                                             .linearVelocity = {speed, 0, 0},
                                             .angularVelocity = {0, 0, -speed / radius},
                                             .shape = Sphere{radius},
                                             .material = material});
    const double slowing = 5.0 / 7 * kGravity * c / radius;
    for (int i = 0; i < 10; ++i) world.step(kDt);
    const double before = world.velocity(ball).linear.x;
    for (int i = 0; i < 60; ++i) world.step(kDt);
    EXPECT_NEAR(before - world.velocity(ball).linear.x, slowing, 0.02 * slowing) << radius;
    EXPECT_NEAR(world.velocity(ball).linear.x, -world.velocity(ball).angular.z * radius, 0.01);
    const int rest = static_cast<int>(world.velocity(ball).linear.x / slowing * 60) + 30;
    for (int i = 0; i < rest; ++i) world.step(kDt);
    EXPECT_LT(length(world.velocity(ball).linear), 1e-3) << radius;
    EXPECT_NEAR(world.pose(ball).position.x, speed * speed / (2 * slowing), 0.03 * speed * speed / (2 * slowing));
  }
}

TEST_P(Rolling, ABallHoldsOnASlopeUpToItsCoefficient) {
  const float radius = 0.3f, c = 0.06f;  // tan = 0.2
  for (const double tangent : {0.15, 0.19, 0.22, 0.3}) {
    const Material material{.friction = 1, .rollingFriction = c};
    const Quat turn = slope(std::atan(tangent));
    World world({.primalSolver = GetParam()});
    addGround(world, material, turn);
    const BodyId ball = world.create(
        BodyDef{.position = rotate(turn, Vec3d{0, radius, 0}), .shape = Sphere{radius}, .material = material});
    for (int i = 0; i < 30; ++i) world.step(kDt);
    const Vec3d start = world.pose(ball).position;
    for (int i = 0; i < 600; ++i) world.step(kDt);
    const double moved = length(world.pose(ball).position - start);
    if (tangent < 0.2)
      EXPECT_LT(moved, 2e-3) << tangent;
    else
      EXPECT_GT(moved, 1) << tangent;
  }
}

// Torque t m g against I = 2/5 m r^2.
TEST_P(Rolling, ASpinningBallSlowsDownAsItsTorsionalCoefficientSays) {
  const float radius = 0.3f, t = 0.01f, spin = 10;
  const Material material{.friction = 0.5f, .torsionalFriction = t};
  World world({.primalSolver = GetParam()});
  addGround(world, material);
  const BodyId ball = world.create(BodyDef{
      .position = {0, radius, 0}, .angularVelocity = {0, spin, 0}, .shape = Sphere{radius}, .material = material});
  const double slowing = t * kGravity / (0.4 * radius * radius);
  for (int i = 0; i < 10; ++i) world.step(kDt);
  const double before = world.velocity(ball).angular.y;
  for (int i = 0; i < 60; ++i) world.step(kDt);
  EXPECT_NEAR(before - world.velocity(ball).angular.y, slowing, 0.02 * slowing);
  for (int i = 0; i < 240; ++i) world.step(kDt);
  EXPECT_LT(length(world.velocity(ball).angular), 1e-3);
  EXPECT_LT(std::hypot(world.pose(ball).position.x, world.pose(ball).position.z), 1e-3);
}

// A torque below the bound turns nothing, however long it acts; one above it turns the ball.
TEST_P(Rolling, ATorqueBelowTheTorsionalBoundIsHeld) {
  const float radius = 0.3f, t = 0.02f;
  const Material material{.friction = 0.5f, .torsionalFriction = t};
  for (const float share : {0.9f, 1.1f}) {
    World world({.primalSolver = GetParam()});
    addGround(world, material);
    const BodyId ball =
        world.create(BodyDef{.position = {0, radius, 0}, .shape = Sphere{radius}, .material = material});
    const float torque = share * t * world.mass(ball) * static_cast<float>(kGravity);
    for (int i = 0; i < 300; ++i) {
      world.addTorque(ball, {0, torque, 0});
      world.step(kDt);
    }
    const Quat turn = world.pose(ball).rotation;
    if (share < 1)
      EXPECT_LT(std::fabs(turn.y), 2e-3);
    else
      EXPECT_GT(world.velocity(ball).angular.y, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, Rolling, testing::Values(PrimalSolver::Krylov, PrimalSolver::BlockSweep));

// Coefficients combine like friction: with a partner that has none, the mean is none, and so is every difference.
TEST(RollingFriction, NoneIsNone) {
  uint64_t hash[2];
  for (const bool named : {false, true}) {
    World world;
    addGround(world, {});
    for (int i = 0; i < 8; ++i) {
      Material material;
      if (named && i == 0) material.rollingFriction = material.torsionalFriction = 0.1f;
      world.create(BodyDef{.position = {0.2 * i, 0.5 + 0.9 * i, 0.1}, .shape = Sphere{0.4f}, .material = material});
    }
    for (int i = 0; i < 120; ++i) world.step(kDt);
    hash[named] = world.hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

TEST(RollingFriction, KeepsTheMomentumOfABodyPair) {
  World world({.gravity = {}});
  const Material material{.friction = 0.5f, .torsionalFriction = 0.05f, .rollingFriction = 0.05f};
  const auto ball = [&](double x, float speed, Vec3 spin) {
    return world.create(BodyDef{.position = {x, 0.1 * x, 0},
                                .linearVelocity = {speed, 0, 0},
                                .angularVelocity = spin,
                                .shape = Sphere{0.5f},
                                .material = material});
  };
  ball(-0.7, 1, {3, 2, 1});
  ball(0.7, -2, {0, 1, -4});
  const Vec3d linear = world.momentum(), angular = world.angularMomentum();
  for (int i = 0; i < 40; ++i) world.step(kDt);
  EXPECT_LT(length(world.momentum() - linear), 1e-4 * length(linear));
  EXPECT_LT(length(world.angularMomentum() - angular), 2e-3 * length(angular));
}

}  // namespace
}  // namespace avbd
