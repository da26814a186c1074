// Articulations in worlds that step: energies, efforts, and what drives and joints give against inverse dynamics.
#include <gtest/gtest.h>

#include <algorithm>

#include "api/articulation_cases.h"

namespace avbd {
namespace {

/// An arm of six hinges about z, y, x, z, y, z on the world, links of 0.4 m and 3 kg down to 0.5 kg, with drives.
struct Arm {
  World world;
  std::vector<BodyId> bodies;
  std::vector<JointId> joints;

  explicit Arm(const JointDrive& drive, float armature = 0) {
    const float h = std::sqrt(0.5f);
    const Quat toX, toY{h, 0, 0, h}, toZ{h, 0, -h, 0}, turns[6] = {toZ, toY, toX, toZ, toY, toZ};
    BodyId last;
    for (int i = 0; i < 6; ++i) {
      const double half = 0.2;
      const BodyId next = world.create(BodyDef{.position = {0.4 * i + half, 1, 0},
                                               .shape = Box{0.2f, 0.05f, 0.06f},
                                               .mass = 3 - 0.5f * static_cast<float>(i),
                                               .filter = {.group = -1}});
      const Pose onLast{last ? Vec3d{half, 0, 0} : Vec3d{0, 1, 0}, turns[i]};
      joints.push_back(world.create(HingeJoint{.bodyA = last,
                                               .bodyB = next,
                                               .frameA = onLast,
                                               .frameB = {{-half, 0, 0}, turns[i]},
                                               .drive = drive,
                                               .armature = armature}));
      bodies.push_back(next), last = next;
    }
  }
  Vec3 axis(size_t i) const {
    const HingeJoint def = world.hingeJoint(joints[i]);
    const Quat a = def.bodyA ? world.pose(def.bodyA).rotation : Quat{};
    return rotate(a * def.frameA.rotation, Vec3{1, 0, 0});
  }
  /// What the joint did to B about an axis, by its reaction on A.
  double effort(size_t i, Vec3 about) const { return -double{dot(world.reaction(joints[i]).torque, about)}; }
};

const std::vector<double> kPose{0.3, -0.5, 0.4, 0.7, -0.6, 0.5};

// Acceptance: inverse_dynamics, at rest.
TEST(ArticulationSteps, DrivesAtRestGiveInverseDynamics) {
  Arm arm({.stiffness = 4000, .damping = 400});
  const Articulation tree(arm.world, arm.joints);
  tree.setPositions(arm.world, kPose);
  tree.setDriveTargets(arm.world, kPose);
  for (int i = 0; i < 600; ++i) arm.world.step(1.0f / 120);
  const ArticulationDynamics dynamics = tree.dynamics(arm.world);
  const std::vector<double> q = tree.positions(arm.world), needed = dynamics.inverseDynamics(std::vector<double>(6));
  double most = 0;
  for (const double effort : needed) most = std::max(most, std::abs(effort));
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(arm.effort(i, arm.axis(i)), needed[i], 0.01 * std::max(std::abs(needed[i]), 0.05 * most)) << i;
    EXPECT_NEAR(4000 * (kPose[i] - q[i]), needed[i], 0.01 * std::max(std::abs(needed[i]), 0.05 * most)) << i;
  }
  EXPECT_GT(most, 10);
}

/// Each joint to and fro, all out of step.
void pathAt(double time, std::vector<double>& q, std::vector<double>& v) {
  for (size_t i = 0; i < 6; ++i) {
    const double rate = 3 + 0.5 * static_cast<double>(i), phase = static_cast<double>(i);
    q[i] = kPose[i] + 0.4 * std::sin(rate * time + phase), v[i] = 0.4 * rate * std::cos(rate * time + phase);
  }
}

/// Half way between two states, with the accelerations between them.
std::vector<double> neededBetween(const Arm& arm, const Articulation& tree, const ArticulationState& before,
                                  const ArticulationState& after, double dt) {
  ArticulationState middle = before;
  std::vector<double> a(6);
  for (size_t i = 0; i < 6; ++i) {
    a[i] = (after.velocities[i] - before.velocities[i]) / dt;
    middle.positions[i] = 0.5 * (before.positions[i] + after.positions[i]);
    middle.velocities[i] = 0.5 * (before.velocities[i] + after.velocities[i]);
  }
  return tree.dynamics(arm.world, middle).inverseDynamics(a);
}

// Acceptance: inverse_dynamics, on a known path. Means over a 24th of a second: floats place links to 1e-7 m, which one
// step takes for an acceleration.
TEST(ArticulationSteps, DrivesOnAPathGiveInverseDynamics) {
  Arm arm({.stiffness = 20000, .damping = 400});
  const Articulation tree(arm.world, arm.joints);
  const int perSecond = 480, window = 20;
  const float dt = 1.0f / perSecond;
  std::vector<double> q(6), v(6), most(6), worst(6), sum(6);
  pathAt(0, q, v);
  tree.setState(arm.world, {{}, q, v});
  ArticulationState before = tree.state(arm.world);
  std::vector<Vec3> axes(6);
  for (int step = 1; step <= 2 * perSecond; ++step) {
    for (size_t i = 0; i < 6; ++i) axes[i] = arm.axis(i);
    pathAt(step * static_cast<double>(dt), q, v);
    tree.setDriveTargets(arm.world, q, v);
    arm.world.step(dt);
    const ArticulationState after = tree.state(arm.world);
    const std::vector<double> needed = neededBetween(arm, tree, before, after, static_cast<double>(dt));
    for (size_t i = 0; i < 6 && step > perSecond / 2; ++i) {
      sum[i] += arm.effort(i, (axes[i] + arm.axis(i)) * 0.5f) - needed[i];
      most[i] = std::max(most[i], std::abs(needed[i]));
      if (step % window != 0) continue;
      worst[i] = std::max(worst[i], std::abs(sum[i]) / window), sum[i] = 0;
    }
    before = after;
  }
  for (size_t i = 0; i < 6; ++i) EXPECT_LT(worst[i], 0.01 * most[i]) << i << " of " << most[i];
}

// Efforts for accelerations from rest give these accelerations, of every kind of joint.
TEST(ArticulationSteps, EffortsAccelerateAsForwardDynamicsSays) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    TreeCase made = makeTree(seed, seed % 2 == 1);
    const Articulation tree(made.world, made.joints);
    TreeMaker make(seed + 31);
    ArticulationState state = makeState(tree, seed + 60);
    std::fill(state.velocities.begin(), state.velocities.end(), 0.0);
    tree.setState(made.world, state);
    const std::vector<double> efforts = make.numbers(tree.dofCount(), 5);
    const std::vector<double> a = tree.dynamics(made.world).forwardDynamics(efforts);
    double most = 0;
    for (const double x : a) most = std::max(most, std::abs(x));
    // Floats place links to 1e-7 m, which a shorter step would take for an acceleration.
    const float dt = 4e-3f;
    tree.addEfforts(made.world, efforts);
    made.world.step(dt);
    const std::vector<double> v = tree.velocities(made.world);
    for (size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(v[i] / static_cast<double>(dt), a[i], 0.01 * most) << seed << ' ' << i;
  }
}

// A swinging arm without drives: its energies are the world's, and their sum stays. The velocities after a step are
// means over it: energies agree to first order in dt.
TEST(ArticulationSteps, EnergyIsTheWorldsAndStays) {
  for (const float dt : {4e-3f, 1e-3f}) {
    Arm arm({});
    const Articulation tree(arm.world, arm.joints);
    tree.setState(arm.world, {{}, kPose, {1, -2, 1, 0.5, -1, 1}});
    const ArticulationDynamics first = tree.dynamics(arm.world);
    const double start = first.kineticEnergy() + first.potentialEnergy();
    double most = 0, worst = 0, drift = 0;
    for (double time = 0; time < 1; time += static_cast<double>(dt)) {
      arm.world.step(dt);
      const ArticulationDynamics now = tree.dynamics(arm.world);
      most = std::max(most, now.kineticEnergy());
      worst = std::max(worst, std::abs(now.kineticEnergy() - arm.world.kineticEnergy()));
      drift = std::max(drift, std::abs(now.kineticEnergy() + now.potentialEnergy() - start));
    }
    EXPECT_GT(most, 100);
    EXPECT_LT(worst, 15 * static_cast<double>(dt) * most);
    EXPECT_LT(drift, 15 * static_cast<double>(dt) * most);
  }
}

}  // namespace
}  // namespace avbd
