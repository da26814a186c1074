// Thin rods that turn far in a step: free, on a hinge, about a locked axis.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;
constexpr int kSteps = 600;

double component(Vec3d v, Vec3d along) { return dot(v, along) / length(along); }
Quat aboutZ(float angle) { return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}; }

/// 2 m x 6 cm, moments 1 : 556; its axis stands `tilt` out of the plane across y, about which it spins.
BodyDef rod(float speed, float tilt) {
  return {.rotation = aboutZ(tilt),
          .angularVelocity = {0, speed, 0},
          .shape = Box{1, 0.03f, 0.03f},
          .mass = 2,
          .canSleep = false};
}
Vec3d axisOf(const World& world, BodyId id) { return toDouble(rotate(world.pose(id).rotation, Vec3{1, 0, 0})); }

/// The largest relative error of the energy, and change of the axis' component along `about`.
struct Drift {
  double energy = 0, axis = 0;
};
Drift spin(World& world, BodyId id, Vec3d about) {
  const double energy = world.kineticEnergy(), start = component(axisOf(world, id), about);
  Drift drift;
  for (int i = 0; i < kSteps; ++i) {
    world.step(kDt);
    drift.energy = std::max(drift.energy, std::abs(world.kineticEnergy() / energy - 1));
    drift.axis = std::max(drift.axis, std::abs(component(axisOf(world, id), about) - start));
  }
  return drift;
}

class Rod : public testing::TestWithParam<float> {};

// The midpoint rule keeps momentum and energy of a symmetric body, and the angle of its axis to the momentum. What is
// left is rounding: some 1e-6 of the energy in each of 600 steps.
TEST_P(Rod, FreeKeepsItsEnergyAndAxis) {
  for (const float tilt : {0.0f, 0.01f, 0.3f}) {
    World world({.gravity = {}});
    const BodyId id = world.create(rod(GetParam(), tilt));
    const Vec3d momentum = world.angularMomentum();
    const Drift drift = spin(world, id, momentum);
    EXPECT_LT(drift.energy, 1e-3) << tilt;
    EXPECT_LT(drift.axis, 2e-4) << tilt;
    EXPECT_LT(length(world.angularMomentum() - momentum) / length(momentum), 5e-4) << tilt;
  }
}

HingeJoint hinge(BodyId base, Vec3d at) {
  const Pose alongY{{}, aboutZ(static_cast<float>(M_PI / 2))};
  HingeJoint joint;
  joint.bodyA = base;
  joint.frameA = {at, alongY.rotation}, joint.frameB = alongY;
  return joint;
}

// A hinge about a principal axis only guides the rod: what it corrects is rounding, which must not grow. At 60 rad/s
// the rod turns a radian in a step, and the hinge lets it lean by a few 1e-5.
TEST_P(Rod, OnAHingeKeepsItsEnergyAndAxis) {
  for (const bool onBody : {false, true}) {
    World world({.gravity = {}});
    const BodyId id = world.create(rod(GetParam(), 0));
    const BodyId base =
        onBody ? world.create(BodyDef{.position = {0, -1, 0}, .shape = Box{}, .mass = 1000, .canSleep = false})
               : BodyId{};
    world.create([&] {
      HingeJoint joint = hinge(base, onBody ? Vec3d{0, 1, 0} : Vec3d{});
      joint.bodyB = id;
      return joint;
    }());
    const Drift drift = spin(world, id, {0, 1, 0});
    EXPECT_LT(drift.energy, 1e-4) << onBody;
    EXPECT_LT(drift.axis, 5e-4) << onBody;
    EXPECT_NEAR(world.velocity(id).angular.y / GetParam(), 1, 1e-4) << onBody;
  }
}

TEST_P(Rod, AboutALockedAxisKeepsItsSpeed) {
  for (const float tilt : {0.01f, 0.3f}) {
    World world({.gravity = {}});
    BodyDef def = rod(GetParam(), tilt);
    def.locks = kLockAngularX | kLockAngularZ;
    const BodyId id = world.create(def);
    EXPECT_LT(spin(world, id, {0, 1, 0}).energy, 1e-5) << tilt;
    EXPECT_NEAR(world.velocity(id).angular.y / GetParam(), 1, 1e-5) << tilt;
  }
}

// Bodies of any moments, at any direction of their spin: without a root of the midpoint rule, energies of a thousand
// times the first appear.
TEST_P(Rod, BodiesOfAnyShapeKeepTheirEnergy) {
  const Vec3 halves[] = {{1, 0.03f, 0.03f}, {1, 0.1f, 0.02f}, {1, 0.9f, 0.02f}, {1, 0.5f, 0.2f}};
  const Vec3 axes[] = {{1, 0, 0}, {0.6f, 0.8f, 0}, {0.01f, 1, 0.01f}, {0.57f, 0.57f, 0.59f}, {0, 0.6f, -0.8f}};
  for (const Vec3 half : halves)
    for (const Vec3 axis : axes) {
      World world({.gravity = {}});
      BodyDef def = rod(0, 0);
      def.shape = Box{half.x, half.y, half.z};
      def.angularVelocity = axis * GetParam();
      const BodyId id = world.create(def);
      EXPECT_LT(spin(world, id, {0, 1, 0}).energy, 0.2) << half.y << " " << half.z << " " << axis.x << " " << axis.y;
    }
}

INSTANTIATE_TEST_SUITE_P(Speeds, Rod, testing::Values(5.0f, 20.0f, 60.0f),
                         [](const auto& speed) { return std::to_string(static_cast<int>(speed.param)); });

}  // namespace
}  // namespace avbd
