// Articulations against formulas: double pendulum, moving bases, singular swings.
#include <avbd/error.h>
#include <gtest/gtest.h>

#include "api/articulation_cases.h"

namespace avbd {
namespace {

constexpr double kG = 9.81;

/// A body whose mass is in its frame's origin but for a moment of inertia about all axes.
BodyId mass(World& world, float m, float inertia) {
  return world.create(
      BodyDef{.massProperties = MassProperties{.mass = m, .inertia = {inertia, inertia, inertia, 0, 0, 0}}});
}

/// Frame whose x axis, that hinges turn about, is the parent's z.
Pose aboutZ(Vec3d at) {
  const float h = std::sqrt(0.5f);
  return {at, {h, 0, -h, 0}};
}

struct DoublePendulum {
  static constexpr double m1 = 1.5, m2 = 0.7, l1 = 0.8, l2 = 0.6, c1 = 0.5, i1 = 0.03, i2 = 0.02;
  World world{{.gravity = {0, -9.81f, 0}}};
  std::vector<JointId> joints;

  /// Links hang down at zero; rods of length l1 and l2 with the mass at c1 and l2.
  DoublePendulum() {
    const BodyId a = mass(world, 1.5f, 0.03f), b = mass(world, 0.7f, 0.02f);
    joints = {world.create(HingeJoint{.bodyB = a, .frameA = aboutZ({}), .frameB = aboutZ({0, c1, 0})}),
              world.create(
                  HingeJoint{.bodyA = a, .bodyB = b, .frameA = aboutZ({0, c1 - l1, 0}), .frameB = aboutZ({0, l2, 0})})};
  }
};

// J. J. Craig, Introduction to Robotics, section 6.7, with moments of inertia; angles from hanging down.
TEST(ArticulationLaws, DoublePendulum) {
  using P = DoublePendulum;
  const P made;
  const Articulation tree(made.world, made.joints);
  const double q1 = 0.7, q2 = -1.1, v1 = 1.3, v2 = -2.1, a1 = 3, a2 = -5;
  const ArticulationDynamics dynamics = tree.dynamics(made.world, {{}, {q1, q2}, {v1, v2}});
  const double c = std::cos(q2), s = std::sin(q2), ml = P::m2 * P::l1 * P::l2;
  const double m22 = P::m2 * P::l2 * P::l2 + P::i2, m12 = m22 + ml * c;
  const double m11 = P::m1 * P::c1 * P::c1 + P::i1 + P::m2 * P::l1 * P::l1 + m22 + 2 * ml * c;
  const double g2 = P::m2 * P::l2 * kG * std::sin(q1 + q2);
  const double g1 = g2 + (P::m1 * P::c1 + P::m2 * P::l1) * kG * std::sin(q1);
  const double b1 = -ml * s * (2 * v1 * v2 + v2 * v2), b2 = ml * s * v1 * v1;
  const std::vector<double> m = dynamics.massMatrix(), bias = dynamics.biasForces(), gravity = dynamics.gravityForces();
  // The masses given are float.
  EXPECT_NEAR(m[0], m11, 1e-6);
  EXPECT_NEAR(m[1], m12, 1e-6);
  EXPECT_NEAR(m[3], m22, 1e-6);
  EXPECT_NEAR(bias[0], b1, 1e-6);
  EXPECT_NEAR(bias[1], b2, 1e-6);
  EXPECT_NEAR(gravity[0], -g1, 5e-6);
  EXPECT_NEAR(gravity[1], -g2, 5e-6);
  const std::vector<double> efforts = dynamics.inverseDynamics(std::vector<double>{a1, a2});
  EXPECT_NEAR(efforts[0], m11 * a1 + m12 * a2 + b1 + g1, 1e-5);
  EXPECT_NEAR(efforts[1], m12 * a1 + m22 * a2 + b2 + g2, 1e-5);
  const Vec3d tip{P::l1 * std::sin(q1) + P::l2 * std::sin(q1 + q2), -P::l1 * std::cos(q1) - P::l2 * std::cos(q1 + q2),
                  0};
  EXPECT_LT(length(dynamics.pose(1).position - tip), 1e-7);
}

// A mass on a radial slider of a table that turns with Omega and speeds along x: what it carries along needs efforts.
TEST(ArticulationLaws, MovingBase) {
  World world({.gravity = {0, 0, 0}});
  const BodyId table = world.create(BodyDef{.type = BodyType::Kinematic, .position = {0.5, 0, 0}, .shape = Sphere{1}});
  const BodyId bead = mass(world, 2, 0.1f);
  const std::vector<JointId> joints{world.create(SliderJoint{.bodyA = table, .bodyB = bead})};
  const float omega = 3;
  world.setVelocity(table, {{7, 0, 0}, {0, omega, 0}});
  const Articulation tree(world, joints);
  const double r = 0.75, v = 0.5;
  const ArticulationDynamics dynamics = tree.dynamics(world, {{}, {r}, {v}});
  EXPECT_NEAR(dynamics.biasForces()[0], -2.0 * omega * omega * r, 1e-12);
  EXPECT_LT(length(dynamics.velocity(0).linear - Vec3d{7 + v, 0, -omega * r}), 1e-12);
  EXPECT_LT(length(dynamics.velocity(0).angular - Vec3d{0, omega, 0}), 1e-12);
  EXPECT_NEAR(dynamics.kineticEnergy(), (7 + v) * (7 + v) + omega * r * omega * r + 0.5 * 0.1 * omega * omega, 1e-6);
  // A second link that the first carries along: its coordinate feels the same centrifugal force.
  const BodyId second = mass(world, 1, 0.1f);
  const JointId more = world.create(SliderJoint{.bodyA = bead, .bodyB = second});
  const Articulation two(world, std::vector<JointId>{joints[0], more});
  EXPECT_NEAR(two.dynamics(world, {{}, {r, 0.25}, {v, 0}}).biasForces()[1], -1.0 * omega * omega * (r + 0.25), 1e-12);
}

TEST(ArticulationLaws, ArmatureAddsToTheMass) {
  World world;
  const BodyId a = mass(world, 2, 0.1f);
  const std::vector<JointId> joints{world.create(HingeJoint{.bodyB = a, .frameB = {{0, 1, 0}, {}}, .armature = 0.5f})};
  const Articulation tree(world, joints);
  const ArticulationDynamics dynamics = tree.dynamics(world, {{}, {0.3}, {2}});
  EXPECT_NEAR(dynamics.massMatrix()[0], 2 + 0.1 + 0.5, 1e-7);
  EXPECT_NEAR(dynamics.kineticEnergy(), 0.5 * 2.6 * 4, 1e-6);
  EXPECT_NEAR(dynamics.forwardDynamics(std::vector<double>{1})[0], (1 + dynamics.gravityForces()[0]) / 2.6, 1e-7);
}

// Where the swing is half a turn the twist turns about the same line: the matrix cannot be inverted, and that is said.
TEST(ArticulationLaws, ASingularSwingIsRefused) {
  World world;
  TreeMaker make(3);
  const BodyId a = make.body(world);
  D6Joint joint{.bodyB = a};
  for (size_t i = 3; i < 6; ++i) joint.axes[i].motion = AxisMotion::Free;
  const Articulation tree(world, std::vector<JointId>{world.create(joint)});
  const std::vector<double> none(3);
  EXPECT_NO_THROW((void)tree.dynamics(world, {{}, {0.4, 3.0, 0}, none}).forwardDynamics(none));
  const ArticulationDynamics folded = tree.dynamics(world, {{}, {0.4, 3.14159265358979324, 0}, none});
  EXPECT_THROW((void)folded.forwardDynamics(none), Error);
}

// A falling tree: the accelerations that nothing but gravity gives are its own.
TEST(ArticulationLaws, FreeFall) {
  World same({.gravity = {0, -9, 0}});
  TreeMaker make(4);
  const BodyId a = make.body(same), b = make.body(same);
  same.setGravityScale(a, 1), same.setGravityScale(b, 1);
  const Articulation tree(same, std::vector<JointId>{same.create(BallJoint{.bodyA = a, .bodyB = b})});
  ArticulationState state = makeState(tree, 8);
  std::fill(state.velocities.begin(), state.velocities.end(), 0.0);
  const std::vector<double> a0 = tree.dynamics(same, state).forwardDynamics(std::vector<double>(9));
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(a0[i], i == 1 ? -9 : 0, 1e-9) << i;
}

}  // namespace
}  // namespace avbd
