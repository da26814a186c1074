// Distance joints, pulleys, couplings and users' joints in a running world.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;
constexpr float kG = 9.81f;

void run(World& world, int steps, float dt = kDt) {
  for (int i = 0; i < steps; ++i) world.step(dt);
}

constexpr BodyDef box(Vec3d at, float mass = 1, Box shape = {0.5f, 0.5f, 0.5f}) {
  BodyDef def;
  def.position = at;
  def.shape = shape;
  def.mass = mass;
  return def;
}

/// A one-kilogram box that turns about the world's x axis at `at`.
JointId wheel(World& world, Vec3d at, double speed = 0, JointDrive drive = {}) {
  const BodyId body = world.create(box(at));
  world.setVelocity(body, {{}, {float(speed), 0, 0}});
  return world.create(HingeJoint{.bodyB = body, .frameA = {at, {}}, .drive = drive});
}

JointId slider(World& world, Vec3d at, JointDrive drive = {}) {
  const BodyId body = world.create(box(at));
  return world.create(SliderJoint{.bodyB = body, .frameA = {at, {}}, .drive = drive});
}

TEST(Distance, ARopeHoldsWhatHangsAndIsSlackOtherwise) {
  World world;
  const BodyId ball = world.create(BodyDef{.position = {0, -0.5, 0}, .shape = Sphere{0.1f}, .mass = 2});
  const JointId rope = world.create(DistanceJoint{.bodyB = ball, .max = 1});
  run(world, 10);
  EXPECT_EQ(world.reaction(rope).force, Vec3{}) << "slack while it falls";
  double longest = 0;
  for (int i = 0; i < 300; ++i) {
    run(world, 1);
    longest = std::max(longest, world.coordinate(rope).position);
  }
  EXPECT_LT(longest, 1.0005);
  EXPECT_NEAR(world.reaction(rope).force.y, -2 * kG, 0.01 * 2 * kG);
  EXPECT_NEAR(world.gap(rope), 0, 1e-4);
}

TEST(Distance, ARodKeepsItsLengthInSwingAndItsEnergy) {
  World world;
  const BodyId ball = world.create(BodyDef{.position = {1, 0, 0}, .shape = Sphere{0.1f}, .mass = 2});
  const JointId rod = world.create(DistanceJoint{.bodyB = ball, .min = 1, .max = 1});
  const auto energy = [&] { return world.kineticEnergy() + 2 * 9.81 * world.pose(ball).position.y; };
  const double scale = 2 * 9.81;
  for (int i = 0; i < 1200; ++i) {
    run(world, 1, 1.0f / 240);
    ASSERT_LT(world.gap(rod), 1e-4) << i;
    ASSERT_NEAR(energy() / scale, 0, 0.02) << i;
  }
}

TEST(Distance, ASpringSettlesWhereStaticsSays) {
  World world;
  const BodyId ball = world.create(BodyDef{.position = {0, -1, 0}, .shape = Sphere{0.1f}, .mass = 2});
  const JointId spring =
      world.create(DistanceJoint{.bodyB = ball, .min = 1, .max = 1, .stiffness = 200, .damping = 20});
  run(world, 600);
  EXPECT_NEAR(world.coordinate(spring).position, 1 + 2 * 9.81 / 200, 1e-3);
}

TEST(Pulley, WeightsMoveByTheRatioAndTheForcesAgree) {
  World world;
  const BodyId a = world.create(box({-2, 0, 0}, 1)), b = world.create(box({2, 0, 0}, 3));
  const JointId pulley = world.create(PulleyJoint{.bodyA = a,
                                                  .bodyB = b,
                                                  .frameA = {{0, 0.5, 0}, {}},
                                                  .frameB = {{0, 0.5, 0}, {}},
                                                  .wheelA = {-2, 8, 0},
                                                  .wheelB = {2, 8, 0}});
  run(world, 30);
  // Atwood: acceleration (3 - 1) / (3 + 1) g.
  const double speed = 0.5 * 9.81 * 0.5;
  EXPECT_NEAR(world.velocity(a).linear.y, speed, 0.01 * speed);
  EXPECT_NEAR(world.velocity(b).linear.y, -speed, 0.01 * speed);
  EXPECT_NEAR(world.reaction(pulley).force.y, 1.5 * 9.81, 0.02 * 9.81);
  EXPECT_LT(world.gap(pulley), 5e-4);
}

TEST(Gear, SpeedsAreThoseOfTheMomenta) {
  // ratio wA + wB = 0 after the gear took hold of two equal wheels, of which A turns at 4.
  World world({.gravity = {}});
  const JointId a = wheel(world, {0, 0, 0}, 4), b = wheel(world, {0, 5, 0});
  world.create(gear(a, b, 0.5f));
  run(world, 3600);
  EXPECT_NEAR(world.coordinate(a).velocity, 3.2, 0.032);
  EXPECT_NEAR(world.coordinate(b).velocity, -1.6, 0.016);
  EXPECT_NEAR(0.5 * world.coordinate(a).position + world.coordinate(b).position, 0, 1e-3);
}

TEST(Rack, ThePinionMovesTheRack) {
  World world({.gravity = {}});
  const JointId pinion = wheel(world, {0, 0, 0}, 0, {.damping = 100, .velocity = 2});
  const JointId rack = slider(world, {0, -3, 0});
  world.create(rackAndPinion(pinion, rack, 0.25f));
  run(world, 600);
  EXPECT_NEAR(world.coordinate(rack).position, 0.25 * world.coordinate(pinion).position, 1e-3);
  EXPECT_NEAR(world.coordinate(pinion).velocity, 2, 0.02);
}

TEST(Mimic, FollowsUnderLoad) {
  for (const float ratio : {-1.0f, 0.5f, 3.0f}) {
    World world({.sleep = false});
    const JointId a = wheel(world, {0, 0, 0}, 0, {.stiffness = 500, .damping = 50, .position = 1});
    const JointId b = wheel(world, {0, 5, 0}, 0, {.force = 2});
    world.create(mimic(a, b, ratio, 0.2f));
    run(world, 600);
    EXPECT_NEAR(world.coordinate(a).position + ratio * world.coordinate(b).position + 0.2, 0, 1e-3) << ratio;
  }
}

TEST(Coupling, AFreeOneHasLimitsAndDrives) {
  World world({.gravity = {}});
  const JointId a = wheel(world, {0, 0, 0}), b = wheel(world, {0, 5, 0});
  Coupling def;
  def.terms = {{a, JointAxis::Twist, 1}, {b, JointAxis::Twist, 1}};
  def.axis.motion = AxisMotion::Free;
  def.axis.limit = {-1, 1};
  const JointId tendon = world.create(def);
  world.setDrive(tendon, {.stiffness = 100, .damping = 20, .position = 0.5f});
  run(world, 300);
  EXPECT_NEAR(world.coordinate(tendon).position, 0.5, 1e-3);
  EXPECT_NEAR(world.coordinate(a).position, world.coordinate(b).position, 1e-3) << "alike wheels move alike";
  world.setDrive(tendon, {.stiffness = 100, .damping = 20, .position = 5});
  run(world, 600);
  EXPECT_NEAR(world.coordinate(tendon).position, 1, 2e-3);
  EXPECT_NEAR(world.reaction(tendon).torque.x, 0, 1) << "the stop carries what the drive pulls";
}

TEST(Coupling, GoesWithItsJointsAndRestsWhileOneIsOff) {
  World world({.gravity = {}});
  const JointId a = wheel(world, {0, 0, 0}, 4), b = wheel(world, {0, 5, 0});
  const JointId coupling = world.create(gear(a, b, 1));
  world.setEnabled(b, false);
  run(world, 10);
  EXPECT_NEAR(world.coordinate(a).velocity, 4, 1e-3);
  world.destroy(b);
  EXPECT_FALSE(world.isAlive(coupling));
  EXPECT_TRUE(world.isAlive(a));
}

TEST(Coupling, KeepsAngularMomentumOfFreeBodies) {
  World world({.gravity = {}});
  const BodyId base = world.create(box({0, 0, 0}, 2)), left = world.create(box({-1, 0, 0})),
               right = world.create(box({1, 0, 0}));
  const auto hinge = [&](BodyId body, double x) {
    return world.create(HingeJoint{.bodyA = base, .bodyB = body, .frameA = {{x, 0, 0}, {}}});
  };
  const JointId a = hinge(left, -1), b = hinge(right, 1);
  world.create(mimic(a, b, 3, 0));
  world.setVelocity(left, {{}, {6, 0, 0}});
  const Vec3d before = world.angularMomentum();
  run(world, 300);
  EXPECT_NEAR(length(world.angularMomentum() - before), 0, 1e-4 * length(before));
  EXPECT_NEAR(world.coordinate(a).position + 3 * world.coordinate(b).position, 0, 1e-3);
}

/// Keeps a body's centre on the line x = constant[0], as one row.
class Wall final : public CustomFamily {
 public:
  std::string name() const override { return "wall"; }
  int rowCount() const override { return 1; }
  void evaluate(std::span<const CustomBody> now, std::span<const CustomBody>, float, std::span<const float> constants,
                std::span<const float>, std::span<CustomRow> rows) const override {
    rows[0].C = now[0].center.x - static_cast<double>(constants[0]);
    rows[0].addPoint(0, now[0], now[0].center, {1, 0, 0});
  }
  void remember(std::span<const CustomBody>, std::span<const float>, std::span<float> memory) const override {
    memory[0] += 1;
  }
};

TEST(Custom, ARowOfTheUsersHoldsAndRemembers) {
  World world;
  const BodyId body = world.create(box({0, 0, 0}));
  world.setVelocity(body, {{3, 0, 0}, {}});
  const JointId joint = world.create(CustomJoint{
      .family = std::make_shared<Wall>(), .bodies = {body}, .bodyCount = 1, .constants = {0}, .memory = {0}});
  run(world, 60);
  EXPECT_NEAR(world.pose(body).position.x, 0, 1e-4);
  EXPECT_NEAR(world.pose(body).position.y, -9.81 / 2, 0.1);
  EXPECT_EQ(world.customJoint(joint).memory[0], 60);
  EXPECT_LT(world.gap(joint), 1e-4);
}

TEST(Custom, LawTestsFindWhatIsWrong) {
  class Wrong final : public CustomFamily {
   public:
    std::string name() const override { return "wrong"; }
    int rowCount() const override { return 1; }
    void evaluate(std::span<const CustomBody> now, std::span<const CustomBody>, float, std::span<const float>,
                  std::span<const float>, std::span<CustomRow> rows) const override {
      rows[0].C = now[0].center.x - now[1].center.x;
      rows[0].addPoint(0, now[0], now[0].center, {1, 0, 0});
      rows[0].addPoint(1, now[1], now[1].center, {-2, 0, 0});
    }
  };
  const CustomBody bodies[2] = {{{{1, 0, 0}, {}}, {1, 0, 0}}, {{{4, 0, 0}, {}}, {4, 0, 0}}};
  EXPECT_NEAR(jacobianError(Wrong(), bodies, {}, {}), 1, 1e-6);
  EXPECT_NEAR(reactionError(Wrong(), bodies, {}, {}), 1, 1e-6);
  const float constants[1] = {0};
  EXPECT_NEAR(jacobianError(Wall(), {bodies, 1}, constants, {}), 0, 1e-6);
}

TEST(Break, LetsGoBeyondItsForceAndTellsSo) {
  World world;
  const BodyId body = world.create(box({0, -1, 0}, 1));
  const JointId joint = world.create(BallJoint{.bodyB = body, .frameB = {{0, 1, 0}, {}}});
  world.setBreakLimits(joint, {.force = 50});
  float force = 0;
  while (world.isEnabled(joint) && force < 100) {
    force += 0.05f;
    world.addForce(body, {0, -force, 0});
    world.step(kDt);
  }
  EXPECT_NEAR(force + 9.81, 50, 1.5);
  ASSERT_EQ(world.events().breaks.size(), 1u);
  EXPECT_EQ(world.events().breaks[0].joint, joint);
  run(world, 1);
  EXPECT_TRUE(world.events().breaks.empty());
  EXPECT_TRUE(world.isAlive(joint));
  EXPECT_LT(world.velocity(body).linear.y, -0.1);
}

TEST(Break, OnePeakBreaksNothing) {
  World world({.gravity = {}});
  const BodyId body = world.create(box({0, -1, 0}, 1));
  const JointId joint = world.create(FixedJoint{.bodyB = body, .frameB = {{0, 1, 0}, {}}});
  world.setBreakLimits(joint, {.force = 50});
  world.addForce(body, {0, -500, 0});
  run(world, 5);
  EXPECT_TRUE(world.isEnabled(joint));
}

TEST(Armature, AddsItsInertiaExactly) {
  for (const float armature : {0.0f, 0.5f}) {
    World world({.gravity = {}});
    const BodyId body = world.create(box({0, 0, 0}));
    const JointId hinge = world.create(HingeJoint{.bodyB = body, .armature = armature});
    for (int i = 0; i < 60; ++i) {
      world.addJointForce(hinge, 1);
      world.step(kDt);
    }
    const double inertia = world.inertia(body).xx + double(armature);
    EXPECT_NEAR(world.coordinate(hinge).velocity, 1 / inertia, 1e-3 / inertia) << armature;
  }
}

TEST(MaxVelocity, HoldsUnderATorque) {
  World world({.gravity = {}});
  const BodyId body = world.create(box({0, 0, 0}));
  const JointId hinge = world.create(HingeJoint{.bodyB = body, .maxVelocity = 1});
  for (int i = 0; i < 60; ++i) {
    world.addJointForce(hinge, 10);
    world.step(kDt);
    ASSERT_LT(world.coordinate(hinge).velocity, 1.001);
  }
  EXPECT_NEAR(world.coordinate(hinge).velocity, 1, 1e-3);
}

TEST(Limit, ReboundsByItsRestitution) {
  World world({.gravity = {}});
  const BodyId body = world.create(box({0, 0, 0}));
  const JointId joint =
      world.create(SliderJoint{.bodyB = body, .limit = {.lower = -1, .upper = 1, .restitution = 0.5f}});
  world.setVelocity(body, {{4, 0, 0}, {}});
  run(world, 25);
  EXPECT_NEAR(world.coordinate(joint).velocity, -2, 1e-3);
}

TEST(Limit, StopsThatMeetHoldLikeALock) {
  World world;
  const BodyId body = world.create(box({0, 0, 0}));
  const JointId joint = world.create(HingeJoint{.bodyB = body, .limit = {0.5f, 0.5f}});
  run(world, 300);
  EXPECT_NEAR(world.coordinate(joint).position, 0.5, 1e-3);
  world.setVelocity(body, {{}, {5, 0, 0}});
  run(world, 60);
  EXPECT_NEAR(world.coordinate(joint).position, 0.5, 1e-3);
}

TEST(Cone, HoldsTheSwingWithin) {
  World world;
  // Frame x along the world's -y: hangs, and is thrown aside.
  const Quat down{float(std::numbers::sqrt2 / 2), 0, 0, -float(std::numbers::sqrt2 / 2)};
  const BodyId body = world.create(box({0, -1, 0}, 1, {0.1f, 0.5f, 0.1f}));
  const JointId joint = world.create(coneJoint({}, body, {{}, down}, {{0, 1, 0}, down}, {.y = 0.5f, .z = 0.5f}));
  world.setVelocity(body, {{6, 0, 2}, {-2, 0, 6}});
  double most = 0;
  for (int i = 0; i < 600; ++i) {
    run(world, 1);
    most = std::max(most, std::hypot(world.coordinate(joint, JointAxis::SwingY).position,
                                     world.coordinate(joint, JointAxis::SwingZ).position));
  }
  EXPECT_LT(most, 0.51);
  EXPECT_GT(most, 0.49);
}

TEST(Slerp, TurnsToItsRotation) {
  World world({.gravity = {}});
  const BodyId body = world.create(box({0, 0, 0}));
  D6Joint def{.bodyB = body};
  for (size_t i = 3; i < 6; ++i) def.axes[i].motion = AxisMotion::Free;
  const double s = std::sin(0.6) / std::sqrt(3.0);
  def.slerp = {.stiffness = 200, .damping = 20, .rotation = {float(std::cos(0.6)), float(s), float(s), float(s)}};
  world.create(def);
  run(world, 600);
  const Quat q = world.pose(body).rotation, t = def.slerp.rotation;
  EXPECT_NEAR(std::fabs(q.w * t.w + q.x * t.x + q.y * t.y + q.z * t.z), 1, 1e-5);
}

TEST(Frames, MoveWhileRunningWithoutAJump) {
  World world;
  const BodyId body = world.create(box({0, -1, 0}));
  const JointId joint = world.create(BallJoint{.bodyB = body, .frameB = {{0, 1, 0}, {}}});
  run(world, 60);
  // The same mechanism by other numbers.
  world.setFrames(joint, {{0, -0.5, 0}, {}}, {{0, 0.5, 0}, {}});
  run(world, 1);
  EXPECT_LT(length(world.velocity(body).linear), 1e-3);
  EXPECT_NEAR(world.reaction(joint).force.y, -9.81, 0.01);
}

TEST(Enabled, AJointThatIsOffDoesNothingAndComesBack) {
  World world({.sleep = false});
  const BodyId body = world.create(box({0, -1, 0}));
  const JointId joint = world.create(FixedJoint{.bodyB = body, .frameB = {{0, 1, 0}, {}}});
  world.setEnabled(joint, false);
  run(world, 6);
  EXPECT_NEAR(world.velocity(body).linear.y, -0.981, 1e-3);
  EXPECT_EQ(world.reaction(joint).force, Vec3{});
  world.setEnabled(joint, true);
  run(world, 300);
  EXPECT_NEAR(world.pose(body).position.y, -1, 1e-3);
}

TEST(Refused, ABadHookLeavesJointsAsTheyWere) {
  World world({.substeps = 3});
  world.create(BodyDef{.type = BodyType::Static, .shapes = {{.geometry = HalfSpace{}, .contactHook = true}}});
  const BodyId a = world.create(box({0, 0.49, 0})), b = world.create(box({1.2, 0.49, 0}));
  world.create(HingeJoint{.bodyA = a, .bodyB = b, .frameA = {{0.6, 0, 0}, {}}, .frameB = {{-0.6, 0, 0}, {}}});
  int calls = 0;
  world.setContactHook([&](ContactPlan& plan) {
    if (++calls > 20) plan.friction = -1;
    return true;
  });
  run(world, 2);
  for (int i = 0; i < 4; ++i) {
    const uint64_t before = world.hash();
    calls = 18;
    EXPECT_THROW(world.step(kDt), Error);
    EXPECT_EQ(world.hash(), before);
  }
}

}  // namespace
}  // namespace avbd
