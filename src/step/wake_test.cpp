// Waking: by every cause and by nothing else; only what is touched; and what wakes stands as it stood.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;
const Box kBox{0.5f, 0.5f, 0.5f};

/// A tower of three on a ground, with a hinge on its top, and far away another tower; all asleep.
struct Scene {
  World world;
  BodyId ground, lift, arm;
  std::vector<BodyId> tower, other;
  JointId hinge;

  explicit Scene(const WorldDef& def = {}) : world(def) {
    ground = world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    for (int i = 0; i < 3; ++i) tower.push_back(world.create(BodyDef{.position = {0, 0.5 + i, 0}, .shape = kBox}));
    for (int i = 0; i < 2; ++i) other.push_back(world.create(BodyDef{.position = {20, 0.5 + i, 0}, .shape = kBox}));
    // It hangs straight down at the tower's side.
    arm = world.create(BodyDef{.position = {0, 2.0, 1}, .shape = Box{0.1f, 0.4f, 0.1f}});
    hinge = world.create(HingeJoint{.bodyA = tower[2], .bodyB = arm, .frameA = {{0, 0, 1}}, .frameB = {{0, 0.5, 0}}});
    lift = world.create(BodyDef{.type = BodyType::Kinematic, .position = {40, 0, 0}, .shape = kBox});
    world.create(BodyDef{.type = BodyType::Kinematic, .position = {44, 0, 0}, .shape = kBox});
    run(250);
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) world.step(kDt);
  }
  bool towerAwake() const {
    return std::all_of(tower.begin(), tower.end(), [&](BodyId id) { return !world.isAlive(id) || world.isAwake(id); });
  }
  bool anyAwake() const {
    return std::any_of(tower.begin(), tower.end(), [&](BodyId id) { return world.isAlive(id) && world.isAwake(id); });
  }
  bool otherAwake() const { return world.isAwake(other[0]) || world.isAwake(other[1]); }
};

struct Cause {
  const char* name;
  std::function<void(Scene&)> call;
  bool othersToo = false;
};

std::vector<Cause> pushes() {
  return {
      {"addForce",
       [](Scene& s) {
         s.world.addForce(s.tower[1], {1, 0, 0});
       }},
      {"addForceAt",
       [](Scene& s) {
         s.world.addForceAt(s.tower[1], {1, 0, 0}, {0, 2, 0});
       }},
      {"addTorque",
       [](Scene& s) {
         s.world.addTorque(s.tower[1], {1, 0, 0});
       }},
      {"addForces",
       [](Scene& s) {
         s.world.addForces(std::vector{s.tower[1]}, std::vector{Vec3{1, 0, 0}});
       }},
      {"addImpulse",
       [](Scene& s) {
         s.world.addImpulse(s.tower[1], {1, 0, 0});
       }},
      {"addImpulseAt",
       [](Scene& s) {
         s.world.addImpulseAt(s.tower[1], {1, 0, 0}, {0, 2, 0});
       }},
      {"addAngularImpulse",
       [](Scene& s) {
         s.world.addAngularImpulse(s.tower[1], {1, 0, 0});
       }},
      {"setVelocity",
       [](Scene& s) {
         s.world.setVelocity(s.tower[0], {{0, 1, 0}, {}});
       }},
      {"setVelocities",
       [](Scene& s) {
         s.world.setVelocities(std::vector{s.tower[0]}, std::vector{Velocity{{0, 1, 0}, {}}});
       }},
      {"setPose", [](Scene& s) { s.world.setPose(s.tower[0], s.world.pose(s.tower[0])); }},
  };
}

std::vector<Cause> changesOfBodies() {
  return {
      {"setMassProperties", [](Scene& s) { s.world.setMassProperties(s.tower[0], {}); }},
      {"setDamping", [](Scene& s) { s.world.setDamping(s.tower[0], 1, 1); }},
      {"setGravityScale", [](Scene& s) { s.world.setGravityScale(s.tower[0], 2); }},
      {"setLocks", [](Scene& s) { s.world.setLocks(s.tower[0], kLockLinearX); }},
      {"setMaxSpeeds", [](Scene& s) { s.world.setMaxSpeeds(s.tower[0], 9, 9); }},
      {"setIterations", [](Scene& s) { s.world.setIterations(s.tower[0], 9); }},
      {"setCanSleep", [](Scene& s) { s.world.setCanSleep(s.tower[0], false); }},
      {"destroy a body", [](Scene& s) { s.world.destroy(s.tower[0]); }},
      {"destroy what hangs on it", [](Scene& s) { s.world.destroy(s.arm); }},
      {"wake", [](Scene& s) { s.world.wake(s.tower[2]); }},
      {"wakeAll", [](Scene& s) { s.world.wakeAll(); }, true},
      {"setGravity",
       [](Scene& s) {
         s.world.setGravity({0, -5, 0});
       },
       true},
      {"wake the ground", [](Scene& s) { s.world.wake(s.ground); }, true},
      {"move the ground",
       [](Scene& s) {
         s.world.setPose(s.ground, {{0, -1, 0}, {}});
       },
       true},
      {"destroy the ground", [](Scene& s) { s.world.destroy(s.ground); }, true},
      {"excludeCollision", [](Scene& s) { s.world.excludeCollision(s.tower[0], s.ground); }},
      {"allowCollision",
       [](Scene& s) {
         s.world.excludeCollision(s.tower[0], s.other[0]);
         s.world.putToSleep(s.tower[0]), s.world.putToSleep(s.other[0]);
         s.world.allowCollision(s.tower[0], s.other[0]);
       },
       true},
      {"move something there",
       [](Scene& s) {
         s.world.setPose(s.lift, {{0.8, 0.5, 0}, {}});
       }},
  };
}

std::vector<Cause> causesAtShapesAndJoints() {
  return {
      {"create a shape", [](Scene& s) { s.world.create(s.tower[0], ShapeDef{.geometry = Sphere{0.1f}}); }},
      {"destroy a shape", [](Scene& s) { s.world.destroy(s.world.shapes(s.tower[0])[0]); }},
      {"destroy the ground's shape", [](Scene& s) { s.world.destroy(s.world.shapes(s.ground)[0]); }, true},
      {"setMaterial", [](Scene& s) { s.world.setMaterial(s.world.shapes(s.tower[0])[0], {.friction = 0}); }},
      {"the ground's", [](Scene& s) { s.world.setMaterial(s.world.shapes(s.ground)[0], {.friction = 0}); }, true},
      {"setFilter", [](Scene& s) { s.world.setFilter(s.world.shapes(s.tower[0])[0], {.mask = 0}); }},
      {"the ground's filter", [](Scene& s) { s.world.setFilter(s.world.shapes(s.ground)[0], {.mask = 0}); }, true},
      {"setContactEvents", [](Scene& s) { s.world.setContactEvents(s.world.shapes(s.tower[0])[0], false); }},
      {"setContactHook", [](Scene& s) { s.world.setContactHook([](ContactPlan&) { return true; }); }, true},
      {"create a joint",
       [](Scene& s) {
         s.world.create(BallJoint{.bodyB = s.tower[1], .frameA = {{0, 1.5, 0}}});
       }},
      {"destroy the joint", [](Scene& s) { s.world.destroy(s.hinge); }},
      {"setEnabled", [](Scene& s) { s.world.setEnabled(s.hinge, false); }},
      {"setDrive", [](Scene& s) { s.world.setDrive(s.hinge, {.damping = 1, .velocity = 1}); }},
      {"setLimit",
       [](Scene& s) {
         s.world.setLimit(s.hinge, {-1, 1});
       }},
      {"setSpring", [](Scene& s) { s.world.setSpring(s.hinge, {.stiffness = 1}); }},
      {"addJointForce", [](Scene& s) { s.world.addJointForce(s.hinge, 1); }},
      {"setFrames",
       [](Scene& s) {
         s.world.setFrames(s.hinge, {{0, 0, 1.1}}, {{0, 0.5, 0}});
       }},
      {"setBreakLimits", [](Scene& s) { s.world.setBreakLimits(s.hinge, {.force = 1}); }},
      {"Coupling",
       [](Scene& s) {
         s.world.create(Coupling{.terms = {{s.hinge, JointAxis::Twist, 1}}});
       }},
  };
}

TEST(Wake, ByEveryCauseAndNoMoreThanItConcerns) {
  std::vector<Cause> causes = pushes();
  for (const auto& more : {changesOfBodies(), causesAtShapesAndJoints()})
    causes.insert(causes.end(), more.begin(), more.end());
  for (const Cause& cause : causes) {
    SCOPED_TRACE(cause.name);
    Scene s;
    ASSERT_FALSE(s.anyAwake() || s.otherAwake());
    cause.call(s);
    EXPECT_TRUE(s.towerAwake());
    EXPECT_EQ(s.otherAwake(), cause.othersToo);
    s.run(2);
    EXPECT_TRUE(s.towerAwake());
  }
}

TEST(Wake, NotByWhatChangesNothing) {
  Scene s;
  World& w = s.world;
  w.setDrive(s.hinge, {.damping = 3}), w.setLimit(s.hinge, {-2, 2});
  s.run(100);
  const uint64_t hash = w.hash();
  w.setDrive(s.hinge, {.damping = 3}), w.setLimit(s.hinge, {-2, 2});
  w.addForce(s.tower[0], {}), w.addTorque(s.tower[0], {}), w.addJointForce(s.hinge, 0);
  w.setVelocity(s.tower[0], {}), w.setVelocity(s.lift, {});
  w.setUserData(s.tower[0], 3), w.setUserData(w.shapes(s.tower[0])[0], 3);
  w.addForce(w.create(BodyDef{.position = {60, 9, 0}, .shape = kBox}), {1, 0, 0});
  w.create(BodyDef{.type = BodyType::Static, .position = {3, 0, 0}, .shape = kBox});
  w.setVelocity(s.lift, {{1, 0, 0}, {}});
  w.clearForces();
  (void)w.contacts();
  s.run(3);
  EXPECT_FALSE(s.anyAwake() || s.otherAwake());
  EXPECT_NE(w.hash(), hash);
}

TEST(Wake, ATowerWhoseLowestBoxGoesFalls) {
  for (const bool moved : {false, true}) {
    Scene s;
    const double top = s.world.pose(s.tower[2]).position.y;
    moved ? s.world.setPose(s.tower[0], {{7, 3, 0}, {}}) : s.world.destroy(s.tower[0]);
    s.run(1);
    EXPECT_GE(s.world.events().ends.size(), 2u) << "with the ground and with the box above";
    s.run(90);
    EXPECT_LT(s.world.pose(s.tower[2]).position.y, top - 0.9);
    EXPECT_FALSE(s.otherAwake());
  }
}

double largestForce(const World& world) {
  double most = 0;
  for (const Contact& c : world.contacts())
    for (int i = 0; i < c.pointCount; ++i)
      most = std::max(most, static_cast<double>(c.points[static_cast<size_t>(i)].normalForce));
  return most;
}

TEST(Wake, WhatWakesStandsAsItStoodOnTheForcesThatItHad) {
  for (const int substeps : {1, 4}) {
    World world({.substeps = substeps});
    world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    std::vector<BodyId> ids;
    for (int i = 0; i < 10; ++i) ids.push_back(world.create(BodyDef{.position = {0, 0.5 + i, 0}, .shape = kBox}));
    for (int i = 0; i < 400; ++i) world.step(kDt);
    ASSERT_FALSE(world.isAwake(ids[0]));
    const double force = largestForce(world);
    const Pose top = world.pose(ids[9]);
    EXPECT_GT(force, 10 * 1000 * 9.81 / 4 * 0.9);
    world.wake(ids[5]);
    for (int i = 0; i < 20; ++i) {
      world.step(kDt);
      EXPECT_TRUE(world.events().begins.empty() && world.events().ends.empty());
      EXPECT_NEAR(largestForce(world), force, 0.05 * force) << i;
      EXPECT_LT(length(world.pose(ids[9]).position - top.position), 3e-4) << i;
      EXPECT_LT(length(world.velocity(ids[9]).linear), 0.01f) << i;
    }
  }
}

TEST(Wake, ABallWakesOnlyTheIslandThatItTouches) {
  Scene s;
  const BodyId ball = s.world.create(BodyDef{
      .position = {17, 0.5, 0}, .linearVelocity = {5, 0, 0}, .angularVelocity = {0, 0, -10}, .shape = Sphere{0.5f}});
  std::vector<BodyId> woken;
  for (int i = 0; i < 60; ++i) {
    s.world.step(kDt);
    woken.insert(woken.end(), s.world.events().wakes.begin(), s.world.events().wakes.end());
  }
  EXPECT_EQ(woken, s.other);
  EXPECT_FALSE(s.anyAwake());
  EXPECT_LT(s.world.velocity(ball).linear.x, 4);
  EXPECT_GT(s.world.pose(s.other[0]).position.x, 20.02);
}

// Their bounds overlap while both rest, and no pair of them is kept.
TEST(Wake, AKinematicThatSetsOutMeetsASleeperBesideIt) {
  World world({.gravity = {}});
  const BodyId box = world.create(BodyDef{.shape = kBox});
  const BodyId door = world.create(BodyDef{.type = BodyType::Kinematic, .position = {-1.02, 0, 0}, .shape = kBox});
  for (int i = 0; i < 60; ++i) world.step(kDt);
  ASSERT_FALSE(world.isAwake(box));
  world.setVelocity(door, {{0.12f, 0, 0}, {}});
  for (int i = 0; i < 60; ++i) {
    world.step(kDt);
    EXPECT_GT(world.pose(box).position.x - world.pose(door).position.x, 0.995) << i;
  }
  EXPECT_TRUE(world.isAwake(box));
}

// What pushes is felt in the very step in which it touches, as if the pile had been awake.
TEST(Wake, AnImpactIsTheSameAsOnAnAwakeBox) {
  const auto hit = [](bool sleeps) {
    World world({.gravity = {}, .sleep = sleeps});
    const BodyId box = world.create(BodyDef{.shape = kBox});
    for (int i = 0; i < 60; ++i) world.step(kDt);
    EXPECT_EQ(world.isAwake(box), !sleeps);
    const BodyId ball =
        world.create(BodyDef{.position = {-2, 0, 0}, .linearVelocity = {20, 0, 0}, .shape = Sphere{0.3f}});
    for (int i = 0; i < 10; ++i) world.step(kDt);
    return std::make_pair(world.velocity(box), world.pose(ball));
  };
  EXPECT_EQ(hit(true), hit(false));
}

TEST(Wake, MovedSleepersAreToldOnceTheyMove) {
  World world({.gravity = {}, .moveEvents = true});
  const BodyId box = world.create(BodyDef{.shape = kBox});
  for (int i = 0; i < 60; ++i) world.step(kDt);
  const BodyId ball =
      world.create(BodyDef{.position = {-2, 0, 0}, .linearVelocity = {20, 0, 0}, .shape = Sphere{0.3f}});
  std::vector<BodyId> moved;
  for (int i = 0; i < 10; ++i) {
    world.step(kDt);
    for (const MoveEvent& e : world.events().moves)
      if (e.body != ball) moved.push_back(e.body);
    if (!moved.empty()) break;
  }
  EXPECT_EQ(moved, std::vector<BodyId>{box});
}

// ---- Steps that fail ---------------------------------------------------------------------------------------------

/// A ball that is about to wake the tower, in a world in which the step may fail.
struct Failing : Scene {
  BodyId ball, feather;
  std::shared_ptr<bool> bad = std::make_shared<bool>(false);  ///< what the hook answers
  explicit Failing(int substeps) : Scene({.substeps = substeps}) {
    world.setContactHook([answer = bad](ContactPlan& plan) {
      if (*answer) plan.friction = -1;
      return true;
    });
    run(150);
    ball = world.create(BodyDef{.position = {-0.82, 0.5, 0},
                                .linearVelocity = {4, 0, 0},
                                .shapes = {{.geometry = Sphere{0.3f}, .contactHook = true}}});
    feather = world.create(
        BodyDef{.position = {9, 9, 9},
                .massProperties = MassProperties{.mass = 1e-24f, .inertia = {1e-30f, 1e-30f, 1e-30f, 0, 0, 0}}});
  }
};

void expectUndone(int substeps, const std::function<void(Failing&)>& spoil, const std::function<void(Failing&)>& mend) {
  Failing s(substeps), calm(substeps);
  const Pose pose = s.world.pose(s.tower[0]);
  ASSERT_FALSE(s.anyAwake());
  spoil(s);
  bool failed = false;
  try {
    s.world.step(kDt);
  } catch (const std::exception&) {
    failed = true;
  }
  ASSERT_TRUE(failed);
  EXPECT_FALSE(s.anyAwake());
  EXPECT_EQ(s.world.pose(s.tower[0]), pose);
  mend(s);
  for (int i = 0; i < 20; ++i) {
    s.world.step(kDt), calm.world.step(kDt);
    ASSERT_EQ(s.world.events().wakes, calm.world.events().wakes) << i;
  }
  EXPECT_TRUE(s.towerAwake());
  EXPECT_EQ(s.world.pose(s.tower[0]), calm.world.pose(calm.tower[0]));
  EXPECT_EQ(s.world.hash(), calm.world.hash());
}

TEST(Wake, AStepThatFailsLetsThemSleepOn) {
  for (const int substeps : {1, 3})
    expectUndone(
        substeps,
        [](Failing& s) {
          s.world.addForce(s.feather, {1e18f, 0, 0});
        },
        [](Failing& s) { s.world.clearForces(); });
}

TEST(Wake, AHookThatFailsLetsThemSleepOn) {
  for (const int substeps : {1, 3}) {
    Failing s(substeps);
    const uint64_t hash = s.world.hash();
    *s.bad = true;
    EXPECT_THROW(s.world.step(kDt), Error);
    EXPECT_EQ(s.world.hash(), hash);
    expectUndone(
        substeps, [](Failing& f) { *f.bad = true; }, [](Failing& f) { *f.bad = false; });
  }
}

// ---- Long runs ---------------------------------------------------------------------------------------------------

class Churn {
 public:
  explicit Churn(const WorldDef& def) : world_(def) {
    world_.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    for (int i = 0; i < 24; ++i) ids_.push_back(drop(i));
  }
  uint64_t run(int steps) {
    for (int i = 0; i < steps && !testing::Test::HasFailure(); ++i) {
      act(i);
      world_.step(kDt);
      check(i);
    }
    return world_.hash();
  }
  int slept = 0, woke = 0;

 private:
  BodyId drop(int i) {
    return world_.create(BodyDef{.position = {1.2 * (i % 6), 0.5 + 1.02 * (i / 6 % 3), 1.5 * (i % 2)}, .shape = kBox});
  }
  void act(int i) {
    BodyId& id = ids_[static_cast<size_t>(i * 7 % 24)];
    if (i % 31 == 30) world_.destroy(id), id = drop(i * 5);
    if (i % 43 == 42) world_.addImpulse(id, {300, 0, 100});
    if (i % 67 == 66) world_.putToSleep(id);
    if (i % 71 == 70) world_.setPose(id, {{1.2 * (i % 5), 3.5, 0}, {}});
    if (i % 89 == 88)
      joints_.push_back(world_.create(BallJoint{.bodyA = id, .frameB = {world_.pose(id).position, {}}}));
    if (i % 97 == 96 && !joints_.empty()) {
      if (world_.isAlive(joints_.back())) world_.destroy(joints_.back());
      joints_.pop_back();
    }
  }
  void check(int i) {
    uint32_t awake = 0, asleep = 0;
    for (const BodyId id : ids_) {
      ++(world_.isAwake(id) ? awake : asleep);
      EXPECT_TRUE(world_.isAwake(id) || world_.velocity(id) == Velocity{}) << i;
    }
    EXPECT_EQ(world_.report().asleep, asleep) << i;
    slept += static_cast<int>(world_.events().sleeps.size()), woke += static_cast<int>(world_.events().wakes.size());
    const std::vector<Contact> contacts = world_.contacts();
    for (size_t k = 1; k < contacts.size(); ++k)
      EXPECT_LT(std::make_pair(contacts[k - 1].shapeA, contacts[k - 1].shapeB),
                std::make_pair(contacts[k].shapeA, contacts[k].shapeB));
  }

  World world_;
  std::vector<BodyId> ids_;
  std::vector<JointId> joints_;
};

TEST(Wake, ComingAndGoingKeepsTheBooksAndTheBits) {
  for (const int substeps : {1, 2}) {
    Churn narrow({.substeps = substeps, .sleepTime = 0.2f, .simdWidth = 1}),
        wide({.substeps = substeps, .sleepTime = 0.2f});
    EXPECT_EQ(narrow.run(600), wide.run(600));
    EXPECT_GT(wide.slept, 20);
    EXPECT_GT(wide.woke, 10);
  }
}

}  // namespace
}  // namespace avbd
