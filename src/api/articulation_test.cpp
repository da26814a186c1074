// Articulations: which joints make the tree, what was set is what is read, and what is refused.
#include <avbd/error.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "api/articulation_cases.h"

namespace avbd {
namespace {

BodyId ball(World& world, Vec3d at = {}, BodyType type = BodyType::Dynamic) {
  return world.create(BodyDef{.type = type, .position = at, .shape = Sphere{0.1f}});
}

JointId hinge(World& world, BodyId a, BodyId b) { return world.create(HingeJoint{.bodyA = a, .bodyB = b}); }

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

void expectRefused(const std::string& text, const std::function<void()>& call) {
  EXPECT_NE(refusal(call).find(text), std::string::npos) << refusal(call);
}

TEST(Articulation, FixedBaseParentsFirst) {
  World world;
  const BodyId floor = ball(world, {}, BodyType::Static), a = ball(world), b = ball(world), c = ball(world);
  const JointId bc = hinge(world, b, c), ba = hinge(world, b, a), fb = hinge(world, b, floor);
  const std::vector<JointId> joints{bc, ba, fb};
  const Articulation tree(world, joints);
  EXPECT_FALSE(tree.isFloating());
  EXPECT_EQ(tree.dofCount(), 3u);
  EXPECT_EQ(tree.positionCount(), 3u);
  EXPECT_TRUE(tree.loopJoints().empty());
  ASSERT_EQ(tree.links().size(), 3u);
  EXPECT_EQ(tree.links()[0].body, b);
  EXPECT_EQ(tree.links()[0].parent, -1);
  EXPECT_EQ(tree.links()[0].base, floor);
  EXPECT_TRUE(tree.links()[0].reversed);
  EXPECT_EQ(tree.links()[1].body, c);
  EXPECT_EQ(tree.links()[1].joint, bc);
  EXPECT_EQ(tree.links()[1].parent, 0);
  EXPECT_FALSE(tree.links()[1].base);
  EXPECT_FALSE(tree.links()[1].reversed);
  EXPECT_EQ(tree.links()[2].body, a);
  EXPECT_EQ(tree.linkOf(a), 2u);
}

TEST(Articulation, FloatingBaseHasSixFirst) {
  World world;
  const BodyId a = ball(world), b = ball(world);
  const std::vector<JointId> joints{hinge(world, a, b)};
  const Articulation tree(world, joints);
  EXPECT_TRUE(tree.isFloating());
  EXPECT_EQ(tree.dofCount(), 7u);
  EXPECT_EQ(tree.positionCount(), 1u);
  EXPECT_EQ(tree.links()[0].body, a);
  EXPECT_EQ(tree.links()[0].dofCount, 6);
  EXPECT_FALSE(tree.links()[0].joint);
  EXPECT_EQ(tree.dofs()[5].axis, JointAxis::SwingZ);
  EXPECT_EQ(tree.dofs()[6].axis, JointAxis::Twist);
  EXPECT_EQ(tree.dofs()[6].link, 1);
}

TEST(Articulation, DofsOfEachJoint) {
  const TreeCase fixed = makeTree(1, false), floating = makeTree(1, true);
  const Articulation tree(fixed.world, fixed.joints), loose(floating.world, floating.joints);
  ASSERT_EQ(tree.links().size(), 11u);
  ASSERT_EQ(loose.links().size(), 11u);
  const std::vector<int> expected = {1, 1, 3, 2, 3, 0, 3, 4, 6, 1, 2};
  int first = 0;
  for (const ArticulationLink& link : tree.links()) {
    EXPECT_EQ(link.firstDof, first);
    first += link.dofCount;
    const auto at = std::find(fixed.bodies.begin(), fixed.bodies.end(), link.body) - fixed.bodies.begin();
    EXPECT_EQ(link.dofCount, expected[static_cast<size_t>(at)]);
  }
  EXPECT_EQ(tree.dofCount(), 26u);
  EXPECT_EQ(loose.dofCount(), 31u);
  EXPECT_EQ(loose.positionCount(), 25u);
}

TEST(Articulation, LoopsAreCutAtTheirFarEnd) {
  World world;
  const BodyId a = ball(world), b = ball(world), c = ball(world), d = ball(world);
  const std::vector<JointId> joints{hinge(world, BodyId{}, a), hinge(world, a, b), hinge(world, b, c),
                                    hinge(world, c, d), hinge(world, d, BodyId{})};
  const Articulation tree(world, joints);
  EXPECT_EQ(tree.loopJoints(), (std::vector<JointId>{joints[2]}));
  EXPECT_EQ(tree.links().size(), 4u);
  EXPECT_EQ(tree.dofCount(), 4u);
  // A second joint of the same two bodies is one too.
  const JointId second = hinge(world, b, a);
  const Articulation two(world, std::vector<JointId>{joints[0], joints[1], second});
  EXPECT_EQ(two.loopJoints(), (std::vector<JointId>{second}));
}

TEST(Articulation, FromABodyAllThatItReaches) {
  World world;
  const BodyId floor = ball(world, {}, BodyType::Static), lift = ball(world, {}, BodyType::Kinematic);
  const BodyId a = ball(world), b = ball(world), c = ball(world), d = ball(world), e = ball(world), f = ball(world);
  const JointId first = hinge(world, floor, a), second = hinge(world, a, b);
  const JointId other = hinge(world, floor, c);  // on the same floor, but of another tree
  const JointId third = hinge(world, d, lift), off = hinge(world, b, e);
  world.setEnabled(off, false);
  world.create(DistanceJoint{.bodyA = b, .bodyB = e, .max = 1});
  const Articulation tree(world, b);
  ASSERT_EQ(tree.links().size(), 2u);
  EXPECT_EQ(tree.links()[0].joint, first);
  EXPECT_EQ(tree.links()[1].joint, second);
  const Articulation both(world, floor), moved(world, d);
  EXPECT_EQ(both.links().size(), 3u);
  EXPECT_EQ(both.linkOf(c), 1u);
  EXPECT_EQ(moved.links()[0].base, lift);
  EXPECT_EQ(moved.links()[0].joint, third);
  const JointId loose = hinge(world, e, f);
  const Articulation floating(world, f);
  EXPECT_TRUE(floating.isFloating());
  EXPECT_EQ(floating.links()[0].body, f);
  EXPECT_EQ(floating.links()[1].joint, loose);
  EXPECT_TRUE(floating.links()[1].reversed);
  (void)other;
}

TEST(Articulation, RefusesWhatIsNoTree) {
  World world;
  const BodyId a = ball(world), b = ball(world), c = ball(world), d = ball(world), alone = ball(world);
  const BodyId wall = ball(world, {}, BodyType::Static), locked = ball(world);
  const JointId ab = hinge(world, a, b), cd = hinge(world, c, d), dead = hinge(world, a, b);
  const JointId rope = world.create(DistanceJoint{.bodyA = b, .bodyB = c, .max = 1}),
                onLocked = hinge(world, b, locked);
  world.destroy(dead);
  world.setLocks(locked, kLockLinearZ);
  const auto make = [&](std::vector<JointId> joints) {
    return [&world, joints] { Articulation(world, std::span<const JointId>(joints)); };
  };
  expectRefused("Articulation.joints = none: must name at least one", make({}));
  expectRefused("Articulation.joints[1] = ", make({ab, dead}));
  expectRefused("must name a living joint of this world", make({ab, dead}));
  expectRefused("must name a living joint of this world", make({JointId{}}));
  expectRefused("must name a hinge, slider, ball, D6 or fixed joint", make({ab, rope}));
  expectRefused("must be named once", make({ab, ab}));
  expectRefused("Articulation.joints[1] = ", make({ab, cd}));
  expectRefused("must be connected with the other joints", make({ab, cd}));
  expectRefused("must join bodies without locked axes", make({ab, onLocked}));
  world.setEnabled(ab, false);
  expectRefused("must name a joint that is enabled", make({ab}));
  expectRefused("Articulation.root = null: must name a living body", [&] { Articulation(world, BodyId{}); });
  expectRefused("must have a hinge, slider", [&] { Articulation(world, alone); });
  expectRefused("must have a hinge, slider", [&] { Articulation(world, wall); });
  expectRefused("must join bodies without locked axes", [&] { Articulation(world, b); });
}

class State : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Trees, State, testing::Range(1u, 5u));

void expectNear(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

TEST_P(State, WhatWasSetIsRead) {
  TreeCase made = makeTree(GetParam(), GetParam() % 2 == 1);
  const Articulation tree(made.world, made.joints);
  const ArticulationState state = makeState(tree, GetParam() + 50);
  tree.setState(made.world, state);
  expectNear(tree.positions(made.world), state.positions, 2e-6);
  expectNear(tree.velocities(made.world), state.velocities, 2e-5);
  for (const JointId joint : made.joints) {
    EXPECT_LT(made.world.gap(joint), 2e-6);
    EXPECT_LT(made.world.angleError(joint), 2e-6);
  }
  const ArticulationDynamics dynamics = tree.dynamics(made.world);
  for (size_t i = 0; i < dynamics.linkCount(); ++i) {
    const BodyId body = tree.links()[i].body;
    EXPECT_LT(length(dynamics.pose(i).position - made.world.pose(body).position), 5e-6);
    EXPECT_LT(length(dynamics.velocity(i).linear - toDouble(made.world.velocity(body).linear)), 5e-5);
    EXPECT_LT(length(dynamics.velocity(i).angular - toDouble(made.world.velocity(body).angular)), 5e-5);
  }
  if (tree.isFloating()) {
    EXPECT_EQ(tree.basePose(made.world), dynamics.pose(0));
  }
}

TEST_P(State, PositionsAloneLeaveBaseAndVelocities) {
  TreeCase made = makeTree(GetParam(), GetParam() % 2 == 1);
  const Articulation tree(made.world, made.joints);
  tree.setState(made.world, makeState(tree, GetParam() + 50));
  const ArticulationState before = tree.state(made.world), other = makeState(tree, GetParam() + 90);
  tree.setPositions(made.world, other.positions);
  ArticulationState after = tree.state(made.world);
  EXPECT_EQ(after.base, before.base);
  expectNear(after.positions, other.positions, 2e-6);
  expectNear(after.velocities, before.velocities, 2e-5);
  tree.setVelocities(made.world, other.velocities);
  expectNear(tree.velocities(made.world), other.velocities, 2e-5);
  EXPECT_EQ(tree.positions(made.world), after.positions);
  if (!tree.isFloating()) return;
  tree.setBasePose(made.world, other.base);
  EXPECT_LT(length(tree.basePose(made.world).position - other.base.position), 1e-12);
  expectNear(tree.positions(made.world), other.positions, 4e-6);
  expectNear(tree.velocities(made.world), other.velocities, 4e-5);
}

TEST(Articulation, DriveTargets) {
  using enum JointAxis;
  World world;
  TreeMaker make(5);
  const BodyId a = make.body(world), b = make.body(world), c = make.body(world), d = make.body(world);
  const JointDrive drive{.stiffness = 10, .damping = 2, .maxForce = 7};
  const JointId arm = world.create(HingeJoint{.bodyB = a, .drive = drive});
  D6Joint six{.bodyA = a, .bodyB = b};
  six.axes[1] = {.motion = AxisMotion::Free, .drive = drive};
  const JointId d6 = world.create(six);
  D6Joint turning{.bodyA = b, .bodyB = c};
  for (size_t i = 3; i < 6; ++i) turning.axes[i].motion = AxisMotion::Free;
  turning.slerp.stiffness = 5;
  const JointId slerps = world.create(turning);
  const JointId slider = world.create(SliderJoint{.bodyA = d, .bodyB = c, .drive = drive});
  const Articulation tree(world, arm ? a : b);
  const std::vector<double> positions{0.5, 0.25, 0.3, -0.2, 0.4, -0.125}, velocities{1, 2, 0, 0, 3, 4};
  tree.setDriveTargets(world, positions);
  EXPECT_EQ(world.hingeJoint(arm).drive.position, 0.5f);
  EXPECT_EQ(world.hingeJoint(arm).drive.velocity, 0);
  EXPECT_EQ(world.hingeJoint(arm).drive.stiffness, 10);
  EXPECT_EQ(world.hingeJoint(arm).drive.maxForce, 7);
  EXPECT_EQ(world.d6Joint(d6).axes[1].drive.position, 0.25f);
  EXPECT_EQ(world.sliderJoint(slider).drive.position, -0.125f);
  tree.setDriveTargets(world, positions, velocities);
  EXPECT_EQ(world.d6Joint(d6).axes[1].drive.velocity, 2);
  EXPECT_EQ(world.sliderJoint(slider).drive.velocity, 4);
  // The slerp drive goes where the coordinates would be.
  tree.setPositions(world, positions);
  const Quat turn = conjugate(world.pose(b).rotation) * world.pose(c).rotation,
             to = world.d6Joint(slerps).slerp.rotation;
  EXPECT_NEAR(std::abs(turn.w * to.w + turn.x * to.x + turn.y * to.y + turn.z * to.z), 1, 1e-6);
  EXPECT_GT(length(world.d6Joint(slerps).slerp.velocity), 2);
}

TEST(Articulation, RefusesBadNumbers) {
  TreeCase made = makeTree(1, true), fixed = makeTree(1, false);
  World& world = made.world;
  const Articulation tree(world, made.joints), still(fixed.world, fixed.joints);
  const uint64_t hash = world.hash();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> few(3), q(tree.positionCount()), v(tree.dofCount());
  expectRefused("Articulation::setPositions.positions = 3 numbers: must have 25",
                [&] { tree.setPositions(world, few); });
  expectRefused("Articulation::setVelocities.velocities = 3 numbers: must have 31",
                [&] { tree.setVelocities(world, few); });
  expectRefused("Articulation::addEfforts.efforts = 3 numbers", [&] { tree.addEfforts(world, few); });
  expectRefused("Articulation::setDriveTargets.positions = 3", [&] { tree.setDriveTargets(world, few); });
  expectRefused("Articulation::setDriveTargets.velocities = 3", [&] { tree.setDriveTargets(world, q, few); });
  q[4] = nan, v[30] = nan;
  expectRefused("Articulation::setPositions.positions[4] = nan", [&] { tree.setPositions(world, q); });
  expectRefused("Articulation::setVelocities.velocities[30] = nan", [&] { tree.setVelocities(world, v); });
  expectRefused("Articulation::addEfforts.efforts[30] = nan", [&] { tree.addEfforts(world, v); });
  expectRefused("Articulation::setState.state.positions[4] = nan", [&] { tree.setState(world, {{}, q, v}); });
  q[4] = 0, v[30] = 0;
  expectRefused("Articulation::dynamics.state.base.rotation", [&] {
    (void)tree.dynamics(world, {{{}, {2, 0, 0, 0}}, q, v});
  });
  expectRefused("Articulation::setBasePose.base = fixed: must be floating",
                [&] { still.setBasePose(fixed.world, {}); });
  expectRefused("Articulation::basePose.base = fixed", [&] { (void)still.basePose(fixed.world); });
  expectRefused("Articulation::linkOf.body", [&] { (void)tree.linkOf(BodyId{}); });
  // What a link would come to counts too: nothing has moved when that is refused.
  v[0] = 1e9, v[4] = v[5] = 1e6;
  expectRefused("Articulation::setVelocities.links[", [&] { tree.setVelocities(world, v); });
  EXPECT_EQ(world.hash(), hash);
}

TEST(ArticulationDynamics, RefusesBadNumbers) {
  const TreeCase made = makeTree(1, true);
  const Articulation tree(made.world, made.joints);
  const ArticulationDynamics dynamics = tree.dynamics(made.world, makeState(tree, 1));
  std::vector<double> few(3), many(tree.dofCount());
  std::vector<LinkForce> two(2), all(dynamics.linkCount());
  expectRefused("ArticulationDynamics::pose.link = 11: must be less than 11", [&] { (void)dynamics.pose(11); });
  expectRefused("ArticulationDynamics::jacobian.link = 11", [&] { (void)dynamics.jacobian(11, {}); });
  expectRefused("ArticulationDynamics::inverseDynamics.accelerations = 3 numbers",
                [&] { (void)dynamics.inverseDynamics(few); });
  expectRefused("ArticulationDynamics::forwardDynamics.efforts = 3 numbers",
                [&] { (void)dynamics.forwardDynamics(few); });
  expectRefused("external = 2 links: must have none or 11", [&] { (void)dynamics.inverseDynamics(many, two); });
  all[4].torque.y = std::numeric_limits<double>::infinity();
  expectRefused("external[4].torque = ", [&] { (void)dynamics.forwardDynamics(many, all); });
}

TEST(Articulation, DeadJointsAreRefused) {
  TreeCase made = makeTree(1, false);
  const Articulation tree(made.world, made.joints);
  made.world.destroy(made.joints.back());
  EXPECT_THROW((void)tree.positions(made.world), Error);
  EXPECT_THROW((void)tree.dynamics(made.world), Error);
  EXPECT_THROW(tree.setPositions(made.world, std::vector<double>(tree.positionCount())), Error);
  // Nothing of it: not for the links before the dead one either.
  const uint64_t hash = made.world.hash();
  expectRefused("must be a living joint of this world",
                [&] { tree.addEfforts(made.world, std::vector<double>(tree.dofCount(), 1)); });
  expectRefused("must be a living joint of this world",
                [&] { tree.setDriveTargets(made.world, std::vector<double>(tree.positionCount(), 1)); });
  EXPECT_EQ(made.world.hash(), hash);
  EXPECT_EQ(made.world.hingeJoint(made.joints.front()).drive.position, 0);
}

TEST(Articulation, EffortsOfABallArePushedOnlyIfTheWorldTakesThem) {
  World world;
  const BodyId a = ball(world), b = ball(world), c = ball(world);
  const Pose turned{{}, {std::cos(0.4f), 0, 0, std::sin(0.4f)}};
  const std::vector<JointId> joints{hinge(world, a, b),
                                    world.create(BallJoint{.bodyA = b, .bodyB = c, .frameA = turned})};
  const Articulation tree(world, joints);
  std::vector<double> efforts(tree.dofCount(), 1);
  const uint64_t hash = world.hash();
  efforts[efforts.size() - 1] = efforts[efforts.size() - 2] = efforts[efforts.size() - 3] = 1e18;
  expectRefused("Articulation::addEfforts.efforts[7] = (", [&] { tree.addEfforts(world, efforts); });
  EXPECT_EQ(world.hash(), hash);
}

}  // namespace
}  // namespace avbd
