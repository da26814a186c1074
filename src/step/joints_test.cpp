// Joints in a running world: pendulum, cantilever, volume, reactions.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;
constexpr double kGravity = 9.81;

void run(World& world, int steps, float dt = kDt) {
  for (int i = 0; i < steps; ++i) world.step(dt);
}

// ---- Pendulum --------------------------------------------------------------------------------------------------

/// K(k) by the arithmetic-geometric mean.
double ellipticK(double k) {
  double a = 1, b = std::sqrt(1 - k * k);
  for (int i = 0; i < 30; ++i) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return M_PI / (2 * a);
}

/// A ball on a ball joint at a distance, swinging in the plane z = 0.
struct Pendulum {
  static constexpr double kLength = 1, kRadius = 0.2;
  World world;
  BodyId bob;
  Pendulum(double angle, const WorldDef& def) : world(def) {
    bob = world.create(BodyDef{.position = {kLength * std::sin(angle), -kLength * std::cos(angle), 0},
                               .shape = Sphere{static_cast<float>(kRadius)}});
    const Vec3d anchor = {-world.pose(bob).position.x, -world.pose(bob).position.y, 0};
    world.create(BallJoint{.bodyA = bob, .frameA = {anchor, {}}});
  }
  double angle() const { return std::atan2(world.pose(bob).position.x, -world.pose(bob).position.y); }
  double energy() const { return world.kineticEnergy() + world.mass(bob) * kGravity * world.pose(bob).position.y; }
  /// Mean over some periods, from the times at which it passes the lowest point.
  double period(float dt) {
    double first = 0, last = 0, before = angle();
    int passes = 0;
    for (int i = 0; i < 20000 && passes < 9; ++i) {
      world.step(dt);
      const double now = angle();
      if ((before > 0) != (now > 0)) {
        last = world.time() - dt * std::abs(now) / (std::abs(now) + std::abs(before));
        if (passes++ == 0) first = last;
      }
      before = now;
    }
    return 2 * (last - first) / (passes - 1);
  }
};

double exactPeriod(double angle) {
  constexpr double kInertia = 0.4 * Pendulum::kRadius * Pendulum::kRadius + Pendulum::kLength * Pendulum::kLength;
  return 4 * std::sqrt(kInertia / (kGravity * Pendulum::kLength)) * ellipticK(std::sin(angle / 2));
}

TEST(Pendulum, PeriodIsTheEllipticIntegrals) {
  for (const double angle : {0.1, 0.5, 1.0, 1.5, 2.2}) {
    Pendulum pendulum(angle, {});
    EXPECT_NEAR(pendulum.period(1.0f / 240) / exactPeriod(angle), 1, 0.005) << angle;
  }
}

TEST(Pendulum, SubstepsDoAsWellAsShortSteps) {
  Pendulum pendulum(1.0, {.substeps = 4});
  EXPECT_NEAR(pendulum.period(kDt) / exactPeriod(1.0), 1, 0.005);
}

TEST(Pendulum, EnergyStaysAndTheAnchorHolds) {
  Pendulum pendulum(1.5, {});
  const double swing = pendulum.world.mass(pendulum.bob) * kGravity * Pendulum::kLength, start = pendulum.energy();
  double worst = 0, gap = 0;
  for (int i = 0; i < 2400; ++i) {
    pendulum.world.step(1.0f / 240);
    worst = std::max(worst, std::abs(pendulum.energy() - start) / swing);
    gap = std::max(gap, pendulum.world.gap(pendulum.world.joints()[0]));
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_LT(gap, 1e-3);
  EXPECT_LT(std::abs(pendulum.energy() - start) / swing, 0.01) << "after ten seconds";
}

// ---- Fixed joints ----------------------------------------------------------------------------------------------

TEST(FixedJoint, CantileverStaysStraight) {
  World world;
  std::vector<JointId> joints;
  BodyId before{};
  for (int i = 0; i < 3; ++i) {
    const BodyId box = world.create(BodyDef{.position = {0.5 + i, 5, 0}, .shape = Box{0.5f, 0.1f, 0.1f}});
    const Pose frameA = before ? Pose{{0.5, 0, 0}, {}} : Pose{{0, 5, 0}, {}};
    joints.push_back(
        world.create(FixedJoint{.bodyA = before, .bodyB = box, .frameA = frameA, .frameB = {{-0.5, 0, 0}, {}}}));
    before = box;
  }
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    world.step(kDt);
    for (const JointId joint : joints) worst = std::max(worst, world.angleError(joint));
  }
  EXPECT_LT(worst * 180 / M_PI, 0.05);
  const Quat q = world.pose(before).rotation;
  EXPECT_LT(2 * std::abs(q.z) * 180 / M_PI, 0.05) << "the whole beam";
  EXPECT_NEAR(world.pose(before).position.y, 5, 2.5 * 0.05 * M_PI / 180 + 1e-4);
  // The wall carries the weight and its lever.
  const double weight = 3 * world.mass(before) * kGravity;
  const JointReaction wall = world.reaction(joints[0]);
  EXPECT_NEAR(wall.force.y, -weight, 0.005 * weight) << "on the world";
  EXPECT_NEAR(wall.torque.z, -weight * 1.5, 0.005 * weight * 1.5);
}

TEST(FixedJoint, HoldsFramesThatAreTurned) {
  World world;
  const Quat turned{0.5f, 0.5f, 0.5f, 0.5f}, tilted{0.8f, 0, 0.6f, 0};
  const BodyId box = world.create(BodyDef{.rotation = tilted, .shape = Box{0.3f, 0.1f, 0.2f}});
  const Pose world0 = world.pose(box) * Pose{{0.2, 0, 0.1}, turned};
  const JointId joint = world.create(FixedJoint{.bodyB = box, .frameA = world0, .frameB = {{0.2, 0, 0.1}, turned}});
  world.addAngularImpulse(box, {3, -2, 5});
  run(world, 120);
  EXPECT_LT(world.angleError(joint), 1e-3);
  EXPECT_LT(world.gap(joint), 1e-3);
}

// ---- Reactions -------------------------------------------------------------------------------------------------

TEST(Reaction, BallJointCarriesTheWeightBothWays) {
  for (const bool bodyIsA : {true, false}) {
    World world;
    const BodyId box = world.create(BodyDef{.shape = Box{0.3f, 0.3f, 0.3f}, .density = 700});
    const Pose up{{0, 0.3, 0}, {}};
    const JointId joint = bodyIsA ? world.create(BallJoint{.bodyA = box, .frameA = up, .frameB = up})
                                  : world.create(BallJoint{.bodyB = box, .frameA = up, .frameB = up});
    run(world, 120);
    const double weight = world.mass(box) * kGravity;
    EXPECT_NEAR(world.reaction(joint).force.y, bodyIsA ? weight : -weight, 0.005 * weight);
    EXPECT_LT(length(world.reaction(joint).torque), 1e-3f * static_cast<float>(weight));
  }
}

TEST(Reaction, ChainCarriesWhatHangsBelow) {
  World world;
  std::vector<BodyId> links;
  std::vector<JointId> joints;
  for (int i = 0; i < 6; ++i) {
    const BodyId link = world.create(BodyDef{.position = {0, -0.5 - i, 0}, .shape = Capsule{0.1f, 0.3f}, .mass = 1});
    const BodyId above = links.empty() ? BodyId{} : links.back();
    const Pose frame = links.empty() ? Pose{} : Pose{{0, -0.5, 0}, {}};
    joints.push_back(
        world.create(BallJoint{.bodyA = above, .bodyB = link, .frameA = frame, .frameB = {{0, 0.5, 0}, {}}}));
    links.push_back(link);
  }
  world.setMassProperties(links.back(), {.mass = 500, .inertia = {10, 10, 10, 0, 0, 0}});
  run(world, 120);
  for (size_t i = 0; i < joints.size(); ++i) {
    const double below = (500 + 5.0 - static_cast<double>(i)) * kGravity;
    EXPECT_NEAR(world.reaction(joints[i]).force.y, -below, 0.005 * below) << i;
  }
}

// ---- Volume ----------------------------------------------------------------------------------------------------

/// Four particles at the corners of a regular tetrahedron, damped, without weight.
struct Tetrahedron {
  World world{{.gravity = {}}};
  std::array<BodyId, 4> node;
  JointId joint;
  explicit Tetrahedron(float stiffness) {
    const Vec3d corner[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (size_t i = 0; i < 4; ++i)
      node[i] = world.create(BodyDef{.position = corner[i],
                                     .massProperties = MassProperties{.mass = 2},
                                     .linearDamping = 3,
                                     .locks = kLockAngular});
    joint = world.create(TetVolume{.bodies = node, .stiffness = stiffness});
  }
  Vec3d at(size_t i) const { return world.pose(node[i]).position; }
  Vec3d center() const { return (at(0) + at(1) + at(2) + at(3)) * 0.25; }
  /// Squeezes until nothing moves. Damping, which also takes its share of the pushes, is let go bit by bit.
  void settle(float force) {
    for (const float damping : {3.0f, 1.0f, 0.3f, 0.1f, 0.03f}) {
      for (const BodyId id : node) world.setDamping(id, damping, 0);
      squeeze(force, 400);
    }
  }
  /// Pushes each particle towards the middle with `force` for some steps.
  void squeeze(float force, int steps) {
    for (int i = 0; i < steps; ++i) {
      for (size_t k = 0; k < 4; ++k) world.addForce(node[k], towardsCenter(k) * force);
      world.step(kDt);
    }
  }
  Vec3 towardsCenter(size_t k) const {
    const Vec3d d = center() - at(k);
    return toFloat(d * (1 / length(d)));
  }
  double volume() const {
    const Vec3 b = toFloat(at(1) - at(0)), c = toFloat(at(2) - at(0)), d = toFloat(at(3) - at(0));
    return dot(b, cross(c, d)) / 6;
  }
  /// Derivative of the volume by the place of particle 0.
  Vec3 gradient0() const {
    const Vec3 b = toFloat(at(1) - at(0)), c = toFloat(at(2) - at(0)), d = toFloat(at(3) - at(0));
    return (cross(c, d) + cross(d, b) + cross(b, c)) * (-1.0f / 6);
  }
};

TEST(TetVolume, HardOnesKeepTheirVolume) {
  Tetrahedron tet(0);
  const double rest = tet.volume();
  EXPECT_NEAR(tet.world.tetVolume(tet.joint).restVolume, rest, 1e-6);
  for (int i = 0; i < 30; ++i) {
    tet.squeeze(100, 10);
    EXPECT_NEAR(tet.volume() / rest, 1, 1e-3);
  }
  EXPECT_LT(tet.world.gap(tet.joint), 1e-3 * std::abs(rest));
  // Statics: what the volume pushes out with is what squeezes.
  tet.settle(100);
  EXPECT_NEAR(tet.volume() / rest, 1, 1e-3);
  EXPECT_LT(length(tet.world.reaction(tet.joint).force + 100 * tet.towardsCenter(0)), 1.0f);
}

TEST(TetVolume, SoftOnesGiveWayAsTheirStiffnessSays) {
  for (const float stiffness : {300.0f, 3000.0f, 3e5f}) {
    Tetrahedron tet(stiffness);
    const double rest = tet.volume();
    tet.settle(60);
    const double C = tet.volume() - rest;
    EXPECT_LT(C * rest, 0) << "squeezed";
    const Vec3 push = tet.gradient0() * static_cast<float>(-stiffness * C);
    EXPECT_LT(length(push + 60 * tet.towardsCenter(0)), 0.6f) << "-K C grad V balances the force, K = " << stiffness;
    EXPECT_LT(length(tet.world.reaction(tet.joint).force - push), 0.6f) << stiffness;
    EXPECT_NEAR(tet.world.gap(tet.joint), std::abs(C), 1e-4);
    EXPECT_LT(tet.world.kineticEnergy(), 1e-4);
  }
}

TEST(TetVolume, OfStaticAndMovingNodes) {
  World world;
  std::array<BodyId, 4> node;
  const Vec3d corner[4] = {{0, 1, 0}, {1, 0, 0}, {-1, 0, 1}, {-1, 0, -1}};
  for (size_t i = 0; i < 4; ++i)
    node[i] = world.create(BodyDef{.type = i == 0 ? BodyType::Dynamic : BodyType::Static,
                                   .position = corner[i],
                                   .massProperties = MassProperties{.mass = 2},
                                   .locks = kLockAngular});
  const JointId joint = world.create(TetVolume{.bodies = node});
  run(world, 300);
  EXPECT_NEAR(world.pose(node[0]).position.y, 1, 1e-3) << "the apex cannot sink";
  double mean = 0;
  for (int i = 0; i < 100; ++i) {
    world.step(kDt);
    mean += world.reaction(joint).force.y / 100;
  }
  EXPECT_NEAR(mean, 2 * kGravity, 0.01 * 2 * kGravity);
}

}  // namespace
}  // namespace avbd
