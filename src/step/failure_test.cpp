// What a step does with a state that overflows: it stops and leaves everything as it was.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

struct State {
  std::vector<Pose> poses;
  std::vector<Velocity> velocities;
  std::vector<JointReaction> reactions;
  double time;
  uint64_t steps;
  friend bool operator==(const State& a, const State& b) {
    if (a.poses != b.poses || a.velocities != b.velocities || a.time != b.time || a.steps != b.steps) return false;
    for (size_t i = 0; i < a.reactions.size(); ++i)
      if (a.reactions[i].force != b.reactions[i].force) return false;
    return a.reactions.size() == b.reactions.size();
  }
};
State stateOf(const World& world) {
  State state;
  for (const BodyId id : world.bodies()) {
    state.poses.push_back(world.pose(id));
    state.velocities.push_back(world.type(id) == BodyType::Static ? Velocity{} : world.velocity(id));
  }
  for (const JointId id : world.joints()) state.reactions.push_back(world.reaction(id));
  state.time = world.time();
  state.steps = world.report().step;
  return state;
}

// A running scene, and a body so light that a force which may be given overflows its acceleration.
struct Overflow : testing::Test {
  World world;
  BodyId feather, box;
  void SetUp() override { fill(world); }
  void fill(World& w) {
    w.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    w.create(BodyDef{.type = BodyType::Kinematic,
                     .position = {5, 0.5, 0},
                     .linearVelocity = {1, 0, 0},
                     .angularVelocity = {0, 1, 0},
                     .shape = Box{}});
    box = w.create(BodyDef{.position = {0, 0.6, 0}, .linearVelocity = {1, 0, 0}, .shape = Box{}});
    const BodyId hung = w.create(BodyDef{.position = {0.7, 3, 0}, .shape = Sphere{0.3f}});
    w.create(BallJoint{.bodyB = hung, .frameA = {{0, 3, 0}, {}}, .frameB = {{-0.7, 0, 0}, {}}});
    feather = w.create(
        BodyDef{.position = {9, 9, 9},
                .massProperties = MassProperties{.mass = 1e-24f, .inertia = {1e-30f, 1e-30f, 1e-30f, 0, 0, 0}}});
    for (int i = 0; i < 10; ++i) w.step(kDt);
  }
};

TEST_F(Overflow, ForcesThatNoFloatCanCarryAreRefused) {
  const State before = stateOf(world);
  EXPECT_THROW(world.addForce(box, {3e38f, 0, 0}), Error);
  EXPECT_THROW(world.addForce(box, {std::nanf(""), 0, 0}), Error);
  EXPECT_THROW(world.addTorque(box, {0, INFINITY, 0}), Error);
  EXPECT_TRUE(stateOf(world) == before);
  world.step(kDt);
  EXPECT_TRUE(std::isfinite(world.pose(box).position.x));
}

TEST_F(Overflow, StepStopsNamesTheBodyAndChangesNothing) {
  const State before = stateOf(world);
  world.addForce(feather, {1e18f, 0, 0});
  try {
    world.step(kDt);
    FAIL() << "an infinite velocity went through";
  } catch (const NonFiniteError& error) {
    EXPECT_EQ(error.bodyIndex(), feather.index);
    EXPECT_EQ(error.bodyGeneration(), feather.generation);
    EXPECT_EQ(error.stage(), "predict");
  }
  EXPECT_TRUE(stateOf(world) == before);
}

TEST_F(Overflow, GivenForcesAreKeptUntilTheyAreCleared) {
  World calm;
  fill(calm);
  world.addForce(feather, {1e18f, 0, 0});
  world.addForce(box, {100, 0, 0});
  EXPECT_THROW(world.step(kDt), NonFiniteError);
  EXPECT_THROW(world.step(kDt), NonFiniteError);
  world.clearForces();
  world.addForce(box, {100, 0, 0});
  calm.addForce(box, {100, 0, 0});
  for (int i = 0; i < 10; ++i) world.step(kDt), calm.step(kDt);
  EXPECT_EQ(world.pose(box), calm.pose(box));
}

TEST_F(Overflow, TheWorldGoesOnWithoutTheBody) {
  World calm;
  fill(calm);
  calm.destroy(feather);
  world.addForce(feather, {1e18f, 0, 0});
  EXPECT_THROW(world.step(kDt), NonFiniteError);
  world.destroy(feather);
  for (int i = 0; i < 60; ++i) {
    world.step(kDt);
    calm.step(kDt);
  }
  EXPECT_EQ(world.pose(box), calm.pose(box));
}

// The failure may come in a later substep: nothing of the earlier ones may be seen.
TEST(Failure, InALaterSubstepLeavesNothingOfTheEarlierOnes) {
  World world({.gravity = {}, .substeps = 4, .lengthUnit = 1e6f});
  std::vector<BodyId> ids;
  for (const double side : {-1.0, 1.0})
    ids.push_back(
        world.create(BodyDef{.position = {side * 9.4833e12, 0, 0},
                             .linearVelocity = {static_cast<float>(side) * -1e15f, 0, 0},
                             .shape = Sphere{9e11f},
                             .massProperties = MassProperties{.mass = 1e18f, .inertia = {1e30f, 1e30f, 1e30f, 0, 0, 0}},
                             .maxLinearSpeed = 1e15f}));
  bool failed = false;
  for (int i = 0; i < 10 && !failed; ++i) {
    const State before = stateOf(world);
    try {
      world.step(kDt);
    } catch (const NonFiniteError&) {
      failed = true;
      EXPECT_TRUE(stateOf(world) == before);
    }
  }
  if (!failed) GTEST_SKIP() << "no overflow could be provoked in a later substep";
}

TEST(Failure, BadStepsAreRefused) {
  World world;
  world.create(BodyDef{.shape = Box{}});
  const uint64_t hash = world.hash();
  for (const float dt : {0.0f, -1.0f, 1.5f, std::nanf(""), INFINITY}) EXPECT_THROW(world.step(dt), Error) << dt;
  EXPECT_EQ(world.hash(), hash);
  EXPECT_EQ(world.report().step, 0u);
  world.step(1);
  world.step(1e-6f);
}

}  // namespace
}  // namespace avbd
