// Hinges, sliders and D6 joints in a running world.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

void run(World& world, int steps, float dt = kDt) {
  for (int i = 0; i < steps; ++i) world.step(dt);
}

Quat turned(Vec3 axis, double angle) {
  const double s = std::sin(angle / 2);
  return {float(std::cos(angle / 2)), float(axis.x * s), float(axis.y * s), float(axis.z * s)};
}

constexpr BodyDef box(Vec3d at, Box shape = {0.5f, 0.1f, 0.1f}) {
  BodyDef def;
  def.position = at;
  def.shape = shape;
  return def;
}

TEST(Hinge, ADoorTurnsAboutItsAxisAlone) {
  World world({.gravity = {0, -9.81f, 0}});
  // Along y: gravity does nothing to it.
  const Quat upright = turned({0, 0, 1}, M_PI / 2);
  const BodyId leaf = world.create(box({0.5, 0, 0}, {0.5f, 1, 0.05f}));
  const JointId hinge =
      world.create(HingeJoint{.bodyB = leaf, .frameA = {{}, upright}, .frameB = {{-0.5, 0, 0}, upright}});
  world.setVelocity(leaf, {{0, 0, -1}, {0, 2, 0}});
  const double energy = world.kineticEnergy();
  for (int i = 0; i < 300; ++i) {
    run(world, 1);
    ASSERT_LT(world.gap(hinge), 1e-4);
    ASSERT_LT(world.angleError(hinge), 1e-3);
  }
  EXPECT_NEAR(world.coordinate(hinge).velocity, 2, 0.02);
  EXPECT_NEAR(world.coordinate(hinge).position, 10, 0.1) << "full turns are counted";
  EXPECT_NEAR(world.kineticEnergy() / energy, 1, 0.01);
  EXPECT_NEAR(world.pose(leaf).position.y, 0, 1e-3);
}

TEST(Hinge, StopsAtItsLimits) {
  World world({.gravity = {0, -9.81f, 0}});
  // A bar that falls about z, its stop half a radian below.
  const Quat across = turned({0, 1, 0}, -M_PI / 2);
  const BodyId bar = world.create(box({0.5, 0, 0}));
  const JointId hinge = world.create(
      HingeJoint{.bodyB = bar, .frameA = {{}, across}, .frameB = {{-0.5, 0, 0}, across}, .limit = {-0.5f, 0.5f}});
  double least = 0;
  for (int i = 0; i < 300; ++i) {
    run(world, 1);
    least = std::min(least, world.coordinate(hinge).position);
  }
  EXPECT_GT(least, -0.51);
  EXPECT_NEAR(world.coordinate(hinge).position, -0.5, 2e-3);
  EXPECT_NEAR(world.coordinate(hinge).velocity, 0, 1e-3);
}

TEST(Hinge, ASpringHoldsAsStaticsSays) {
  World world({.gravity = {0, -9.81f, 0}});
  const Quat across = turned({0, 1, 0}, -M_PI / 2);
  const BodyId bar = world.create(box({0.5, 0, 0}));
  const double mass = world.mass(bar);
  const JointId hinge = world.create(HingeJoint{.bodyB = bar,
                                                .frameA = {{}, across},
                                                .frameB = {{-0.5, 0, 0}, across},
                                                .drive = {.stiffness = 1000, .damping = 200}});
  run(world, 600);
  const double q = world.coordinate(hinge).position;
  EXPECT_NEAR(1000 * -q, mass * 9.81 * 0.5 * std::cos(q), 0.01 * mass * 9.81 * 0.5);
}

TEST(Hinge, AMotorTurnsAtItsSpeedUpToItsTorque) {
  for (const float most : {1e4f, 0.5f}) {
    World world({.gravity = {0, 0, 0}});
    const BodyId wheel = world.create(BodyDef{.shape = Cylinder{0.5f, 0.1f}, .mass = 1});
    const JointId hinge = world.create(
        HingeJoint{.bodyB = wheel, .drive = {.damping = 1e5f, .velocity = 1, .maxForce = most}, .friction = 0});
    run(world, 30);
    const double inertia = world.inertia(wheel).xx;
    EXPECT_NEAR(world.coordinate(hinge).velocity, std::min(1.0, 0.5 * 0.5 / inertia), 0.01);
  }
}

TEST(Slider, CarriesItsBodyAlongTheAxis) {
  World world({.gravity = {0, -9.81f, 0}});
  const Quat up = turned({0, 0, 1}, M_PI / 2);
  const BodyId cabin = world.create(box({0, 3, 0}));
  const JointId slider = world.create(
      SliderJoint{.bodyB = cabin, .frameA = {{}, up}, .frameB = {{}, up}, .limit = {1, 4}, .drive = {}, .friction = 0});
  run(world, 20);
  EXPECT_LT(world.coordinate(slider).velocity, -3);
  run(world, 200);
  EXPECT_NEAR(world.coordinate(slider).position, 1, 2e-3);
  EXPECT_LT(world.gap(slider), 1e-4);
  EXPECT_LT(world.angleError(slider), 1e-4);
}

TEST(Slider, FrictionHoldsUpToItsForce) {
  for (const float share : {1.1f, 0.5f}) {
    World world({.gravity = {0, -9.81f, 0}});
    const Quat up = turned({0, 0, 1}, M_PI / 2);
    const BodyId cabin = world.create(box({0, 3, 0}));
    const double weight = world.mass(cabin) * 9.81;
    const JointId slider = world.create(
        SliderJoint{.bodyB = cabin, .frameA = {{}, up}, .frameB = {{}, up}, .friction = float(share * weight)});
    run(world, 60);
    EXPECT_NEAR(world.coordinate(slider).velocity, share > 1 ? 0 : -9.81 * 0.5, 0.02) << share;
    EXPECT_NEAR(world.coordinate(slider).position, share > 1 ? 3 : 3 - 0.5 * 9.81 * 0.5, 0.05) << share;
  }
}

TEST(D6, EverySingleFreeAngleIsAHinge) {
  for (int free = 0; free < 3; ++free) {
    World world({.gravity = {0, 0, 0}});
    const BodyId body = world.create(box({0, 0, 0}, {0.5f, 0.3f, 0.2f}));
    D6Joint def{.bodyB = body};
    def.axes[static_cast<size_t>(3 + free)].motion = AxisMotion::Free;
    const JointId joint = world.create(def);
    Vec3 spin{};
    (free == 0 ? spin.x : free == 1 ? spin.y : spin.z) = 3;
    world.setVelocity(body, {{}, spin});
    run(world, 120);
    const JointCoordinate q = world.coordinate(joint, static_cast<JointAxis>(3 + free));
    EXPECT_NEAR(q.position, 6, 0.05) << free;
    EXPECT_NEAR(q.velocity, 3, 0.03) << free;
    EXPECT_LT(world.angleError(joint), 1e-3) << free;
  }
}

// Its normal turns far within a step: it takes the derivative of the cone's J to settle.
TEST(D6, ANarrowEllipseIsNotLeftAtSpeed) {
  for (int i = 0; i < 16; ++i) {
    World world({.gravity = {}});
    const BodyId body = world.create(box({1, 0, 0}, {0.5f, 0.5f, 0.5f}));
    const double way = i * M_PI / 8 + 0.1;
    const Vec3 spin{0, float(20 * std::cos(way)), float(20 * std::sin(way))};
    world.setVelocity(body, {{0, spin.z, -spin.y}, spin});
    const JointId joint = world.create(coneJoint({}, body, {}, {{-1, 0, 0}, {}}, {.y = 0.3f, .z = 0.8f}));
    double most = 0;
    for (int k = 0; k < 60; ++k) {
      run(world, 1);
      const double y = world.coordinate(joint, JointAxis::SwingY).position;
      const double z = world.coordinate(joint, JointAxis::SwingZ).position;
      most = std::max(most, std::hypot(y / 0.3, z / 0.8));
    }
    EXPECT_NEAR(most, 1, 1e-3) << "way " << i;
  }
}

TEST(D6, ALoopOfHingesHolds) {
  World world({.gravity = {0, -9.81f, 0}});
  // Four bars of a square, the lower one static.
  const Quat z = turned({0, 1, 0}, -M_PI / 2);
  const BodyId left = world.create(box({0, 0.5, 0}, {0.05f, 0.5f, 0.05f}));
  const BodyId top = world.create(box({0.5, 1, 0}, {0.5f, 0.05f, 0.05f}));
  const BodyId right = world.create(box({1, 0.5, 0}, {0.05f, 0.5f, 0.05f}));
  const JointId joints[] = {
      world.create(HingeJoint{.bodyB = left, .frameA = {{0, 0, 0}, z}, .frameB = {{0, -0.5, 0}, z}}),
      world.create(HingeJoint{.bodyA = left, .bodyB = top, .frameA = {{0, 0.5, 0}, z}, .frameB = {{-0.5, 0, 0}, z}}),
      world.create(HingeJoint{.bodyA = top, .bodyB = right, .frameA = {{0.5, 0, 0}, z}, .frameB = {{0, 0.5, 0}, z}}),
      world.create(HingeJoint{.bodyB = right, .frameA = {{1, 0, 0}, z}, .frameB = {{0, -0.5, 0}, z}})};
  world.setVelocity(top, {{1, 0, 0}, {}});
  double gap = 0, angle = 0;
  for (int i = 0; i < 300; ++i) {
    run(world, 1);
    for (const JointId joint : joints) {
      gap = std::max(gap, world.gap(joint));
      angle = std::max(angle, world.angleError(joint));
    }
  }
  EXPECT_LT(gap, 2e-3);
  EXPECT_LT(angle, 2e-3);
}

}  // namespace
}  // namespace avbd
