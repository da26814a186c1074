// Impacts of soft bodies behind the solve: momentum, nobody watching, rest.
#include "step/soft_impacts.h"

#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>

namespace avbd {
namespace {

constexpr float kSpeed = 8;
constexpr float kDt = 1.0f / 60;

SoftDef clothAt(double y, float across = 0.5f) {
  return {.mesh = makeClothGrid(across, across, 10, 10),
          .pose = {{0, y, 0}, {}},
          .material = {.youngsModulus = 1e6f, .density = 400, .thickness = 0.001f, .bending = 1e-4f},
          .radius = 0.006f};
}

Vec3d centre(const World& world, const std::vector<BodyId>& bodies) {
  Vec3d sum;
  double mass = 0;
  for (const BodyId id : bodies) sum = sum + world.pose(id).position * double{world.mass(id)}, mass += world.mass(id);
  return sum * (1 / mass);
}

/// A cloth meets two others; all fly together. Too few iterations for the rows to hold them.
struct Flying {
  World world;
  std::vector<BodyId> bodies;
  double impacts = 0;

  explicit Flying(Vec3 common) : world(WorldDef{.gravity = {}, .iterations = 1}) {
    const SoftId below = world.create(clothAt(0)), middle = world.create(clothAt(0.02, 0.47f)),
                 above = world.create(clothAt(0.04, 0.43f));
    for (const SoftId id : {below, middle, above})
      for (const BodyId p : world.particles(id)) {
        bodies.push_back(p);
        world.setVelocity(p, {common + Vec3{0, id == above ? -kSpeed : 0.0f, 0}, {}});
      }
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) world.step(kDt), impacts += world.report().impacts;
  }
};

TEST(SoftImpacts, KeepMomentum) {
  Flying flying({});
  const Vec3d before = flying.world.momentum();
  flying.run(40);
  EXPECT_GT(flying.impacts, 20);
  const Vec3d off = flying.world.momentum() - before;
  EXPECT_LT(std::sqrt(dot(off, off)), 1e-3 * std::sqrt(dot(before, before)));
}

TEST(SoftImpacts, DoNotHoldBackWhatFliesTogether) {
  Flying along({8, 20, -4});
  const Vec3d start = centre(along.world, along.bodies), mean = along.world.momentum();
  double mass = 0;
  for (const BodyId id : along.bodies) mass += along.world.mass(id);
  along.run(40);
  EXPECT_GT(along.impacts, 20);
  const Vec3d lag = centre(along.world, along.bodies) - start - mean * (40 * double{kDt} / mass);
  EXPECT_LT(std::sqrt(dot(lag, lag)), 0.01);  // of 15 m
}

TEST(SoftImpacts, CrumpledClothComesToRest) {
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  const BodyId box = world.create(BodyDef{.position = {0, 0.75, 0}, .shape = Box{0.08f, 0.08f, 0.08f}, .mass = 4});
  SoftDef upright = clothAt(0.3);
  upright.pose.rotation = {0.7071068f, 0.7071068f, 0, 0};
  const SoftId cloth = world.create(upright);
  double impacts = 0;
  for (int i = 0; i < 300; ++i) world.step(kDt), impacts += world.report().impacts;
  EXPECT_GT(impacts, 20);
  EXPECT_LT(world.pose(box).position.y, 0.3);
  for (const BodyId p : world.particles(cloth)) {
    const Vec3 v = world.velocity(p).linear;
    EXPECT_LT(std::sqrt(dot(v, v)), 0.3f);
  }
}

}  // namespace
}  // namespace avbd
