// Both primal solvers in a running world: same bits at every width, and one answer where they are given time.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include "solve/backend.h"

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

WorldDef sweep(int iterations, int width = 0) {
  return {.iterations = iterations, .primalSolver = PrimalSolver::BlockSweep, .sleep = false, .simdWidth = width};
}

void addGround(World& world) { world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}}); }

void addStacks(World& world) {
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 6; ++i) world.create(BodyDef{.position = {5.0 * k, 0.5 + i, 0}, .shape = Box{}});
}

void addPyramid(World& world) {
  for (int row = 0; row < 8; ++row)
    for (int i = 0; i < 8 - row; ++i)
      world.create(BodyDef{.position = {(i - (7 - row) / 2.0) * 1.1, 0.5 + row, 0}, .shape = Box{}});
}

/// Everything that has rows of its own: ball joints, a fixed joint, a tetrahedron, a mover, locked axes, and a
/// plate under many boxes.
void addMixture(World& world) {
  const BodyId plate = world.create(BodyDef{.position = {0, 0.25, 10}, .shape = Box{4, 0.25f, 4}, .density = 300});
  for (int i = 0; i < 16; ++i)
    world.create(BodyDef{.position = {1.5 * (i % 4) - 2.25, 1.0, 10 + 1.5 * (i / 4) - 2.25}, .shape = Box{}});
  world.create(
      BodyDef{.type = BodyType::Kinematic, .position = {-6, 0.5, 10}, .linearVelocity = {0.5f, 0, 0}, .shape = Box{}});
  world.create(BodyDef{.position = {0, 3, 20}, .shape = Sphere{}, .locks = 1 | 32});
  BodyId link[4];
  for (int i = 0; i < 4; ++i)
    link[i] = world.create(BodyDef{.position = {0, 6.0 - i, -5}, .shape = Capsule{0.1f, 0.2f}});
  world.create(BallJoint{.bodyA = link[0], .frameA = {{0, 0.5, 0}, {}}, .frameB = {{0, 6.5, -5}, {}}});
  for (int i = 1; i < 4; ++i)
    world.create(
        BallJoint{.bodyA = link[i - 1], .bodyB = link[i], .frameA = {{0, -0.5, 0}, {}}, .frameB = {{0, 0.5, 0}, {}}});
  const BodyId tip = world.create(BodyDef{.position = {0, 2.4, -5}, .shape = Box{0.1f, 0.1f, 0.1f}});
  world.create(FixedJoint{.bodyA = link[3], .bodyB = tip, .frameA = {{0, -0.5, 0}, {}}, .frameB = {{0, 0.1, 0}, {}}});
  BodyId corner[4];
  const Vec3d at[4] = {{-5, 2, -5}, {-4, 2, -5}, {-5, 3, -5}, {-5, 2, -4}};
  for (int i = 0; i < 4; ++i) corner[i] = world.create(BodyDef{.position = at[i], .shape = Sphere{0.2f}});
  world.create(TetVolume{.bodies = {corner[0], corner[1], corner[2], corner[3]}});
  world.addForce(plate, {0, 0, 100});
}

uint64_t hashAfter(int width, void (*add)(World&)) {
  World world(sweep(4, width));
  addGround(world);
  add(world);
  for (int i = 0; i < 60; ++i) world.step(kDt);
  EXPECT_GT(world.report().colors, 1u);
  return world.hash();
}

TEST(BlockSweep, SameBitsAtEveryWidth) {
  for (const auto add : {addStacks, addPyramid, addMixture}) {
    const uint64_t one = hashAfter(1, add);
    EXPECT_EQ(hashAfter(1, add), one);
    for (const int width : {4, 8, 16}) {
      if (!laneWidthRuns(width)) continue;
      EXPECT_EQ(hashAfter(width, add), one) << width;
    }
  }
}

TEST(BlockSweep, AgreesWithKrylovInTheEnd) {
  WorldDef krylov = sweep(200);
  krylov.primalSolver = PrimalSolver::Krylov, krylov.krylovIterations = 60;
  World a(sweep(200)), b(krylov);
  for (World* world : {&a, &b}) {
    addGround(*world);
    addMixture(*world);
    for (int i = 0; i < 20; ++i) world->step(kDt);
  }
  EXPECT_EQ(b.report().colors, 0u);
  const std::vector<BodyId> bodies = a.bodies();
  for (size_t i = 0; i < bodies.size(); ++i)
    EXPECT_LT(length(toFloat(a.pose(bodies[i]).position - b.pose(bodies[i]).position)), 1e-5f) << "body " << i;
}

TEST(BlockSweep, StacksStand) {
  World world(sweep(200));
  addGround(world);
  addStacks(world);
  for (int i = 0; i < 300; ++i) world.step(kDt);
  const std::vector<BodyId> bodies = world.bodies();
  for (size_t i = 1; i < bodies.size(); ++i) {
    const Vec3d p = world.pose(bodies[i]).position;
    EXPECT_NEAR(p.x, 5.0 * double((i - 1) / 6), 1e-3) << i;
    EXPECT_NEAR(p.y, 0.5 + double((i - 1) % 6), 0.015) << i;
    EXPECT_LT(length(world.velocity(bodies[i]).linear), 1e-3f) << i;
  }
}

}  // namespace
}  // namespace avbd
