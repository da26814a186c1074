// What users do between steps reaches the step: teleports, filters, exclusions, destruction, mass, forces.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

void run(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(kDt);
}

// A box of 1 kg resting on the ground.
struct Resting : testing::Test {
  World world;
  BodyId ground = world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  BodyId box = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}, .mass = 1});
  double height() const { return world.pose(box).position.y; }
  void expectFalls() {
    run(world, 30);
    EXPECT_LT(height(), -0.5);
  }
  void SetUp() override { run(world, 60); }
};

TEST_F(Resting, ContactsCarryTheWeight) {
  const std::vector<Contact> contacts = world.contacts();
  ASSERT_EQ(contacts.size(), 1u);
  const Contact& contact = contacts[0];
  EXPECT_EQ(contact.bodyA, ground);
  EXPECT_EQ(contact.bodyB, box);
  EXPECT_EQ(contact.shapeB, world.shapes(box)[0]);
  EXPECT_EQ(contact.pointCount, 4);
  EXPECT_NEAR(contact.normal.y, 1, 1e-5);
  float force = 0;
  for (const ContactPoint& point : contact.points) {
    force += point.normalForce;
    EXPECT_NEAR(point.position.y, 0, 0.01);
    EXPECT_NEAR(std::abs(point.position.x), 0.5, 0.01);
  }
  EXPECT_NEAR(force, 9.81, 0.05);
  EXPECT_NEAR(world.time(), 1, 1e-5);
}

TEST_F(Resting, FilterLetsItFallAndCatchesItAgain) {
  const ShapeId shape = world.shapes(box)[0];
  world.setFilter(shape, {.mask = 0});
  EXPECT_TRUE(world.contacts().empty());
  expectFalls();
  world.setPose(box, {{0, 0.6, 0}, {}});
  world.setVelocity(box, {});
  world.setFilter(shape, {});
  run(world, 60);
  EXPECT_NEAR(height(), 0.5, 0.01);
}

TEST_F(Resting, ExclusionLetsItFall) {
  world.excludeCollision(box, ground);
  expectFalls();
}

TEST_F(Resting, AllowingEndsAnExclusionHoweverOftenItWasMade) {
  world.excludeCollision(box, ground);
  world.excludeCollision(ground, box);
  world.allowCollision(box, ground);
  run(world, 60);
  EXPECT_NEAR(height(), 0.5, 0.01);
  world.allowCollision(box, ground);
  EXPECT_TRUE(world.excludedPairs().empty());
}

TEST_F(Resting, AllowingLeavesWhatAJointExcludes) {
  const JointId rope = world.create(DistanceJoint{.bodyA = ground, .bodyB = box, .max = 100});
  const std::vector<std::array<BodyId, 2>> pair{{ground, box}};
  world.allowCollision(box, ground);
  EXPECT_EQ(world.excludedPairs(), pair);
  world.excludeCollision(box, ground);
  world.destroy(rope);
  EXPECT_EQ(world.excludedPairs(), pair);
  world.allowCollision(box, ground);
  EXPECT_TRUE(world.excludedPairs().empty());
}

TEST_F(Resting, ExclusionsDieWithTheirBodies) {
  world.excludeCollision(box, ground);
  const uint32_t slot = box.index;
  world.destroy(box);
  box = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{}});
  ASSERT_EQ(box.index, slot);
  run(world, 60);
  EXPECT_NEAR(height(), 0.5, 0.01);
}

TEST_F(Resting, GroundDestroyed) {
  world.destroy(ground);
  expectFalls();
}

TEST_F(Resting, GroundsShapeDestroyed) {
  world.destroy(world.shapes(ground)[0]);
  expectFalls();
}

TEST_F(Resting, GroundMovedAway) {
  world.setPose(ground, {{0, -100, 0}, {}});
  expectFalls();
}

TEST_F(Resting, TeleportForgetsTheContactAndFindsTheNext) {
  world.setPose(box, {{50, 2, 0}, {}});
  EXPECT_TRUE(world.contacts().empty());
  run(world, 90);
  EXPECT_NEAR(height(), 0.5, 0.01);
  EXPECT_EQ(world.contacts().size(), 1u);
}

TEST_F(Resting, MassChangesInPlaceWithoutAJump) {
  const double before = height();
  world.setMassProperties(box, {.mass = 3, .center = {0.1f, -0.2f, 0}, .inertia = {0.5f, 0.5f, 0.5f, 0, 0, 0}});
  EXPECT_NEAR(height(), before, 1e-6);
  run(world, 60);
  EXPECT_NEAR(height(), before, 0.005);
  float force = 0;
  const Contact contact = world.contacts().at(0);
  for (const ContactPoint& point : contact.points) force += point.normalForce;
  EXPECT_NEAR(force, 3 * 9.81, 0.15);
}

TEST_F(Resting, ForcesActOnce) {
  world.setGravity({});
  world.setPose(box, {{0, 10, 0}, {}});
  world.setVelocity(box, {});
  world.addForce(box, {60, 0, 0});
  run(world, 1);
  EXPECT_NEAR(world.velocity(box).linear.x, 1, 1e-4);
  run(world, 5);
  EXPECT_NEAR(world.velocity(box).linear.x, 1, 1e-4);
}

TEST_F(Resting, JointExcludesItsPairOnlyWhileItLives) {
  const JointId pin = world.create(BallJoint{.bodyA = ground, .bodyB = box, .frameA = {{0, 0.2, 0}, {}}});
  run(world, 180);
  EXPECT_TRUE(world.contacts().empty());
  EXPECT_NEAR(height(), 0.2, 0.01) << "held inside the ground by the joint";
  world.setPose(box, {{0, 0.5, 0}, {}});
  world.setVelocity(box, {});
  world.destroy(pin);
  run(world, 60);
  EXPECT_NEAR(height(), 0.5, 0.01);
  EXPECT_EQ(world.contacts().size(), 1u);
}

// Destroys, makes and moves in the middle of a run.
class Churn {
 public:
  explicit Churn(uint32_t seed) : random_(seed) {
    world_.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    for (int i = 0; i < 40; ++i) bodies_.push_back(world_.create(BodyDef{.position = freePlace(), .shape = kCube}));
  }

  uint64_t run(int steps) {
    for (int i = 0; i < steps; ++i) {
      act();
      world_.step(kDt);
    }
    for (const BodyId id : world_.bodies()) EXPECT_TRUE(std::isfinite(world_.pose(id).position.y));
    return world_.hash();
  }

 private:
  static constexpr Box kCube{0.4f, 0.4f, 0.4f};

  // Above the pile; whatever was put there before has fallen away.
  Vec3d freePlace() {
    const int i = placed_++;
    return {1.5 * (i % 4), 12 + 1.5 * (i / 16 % 4), 1.5 * (i / 4 % 4)};
  }

  void act() {
    const size_t at = random_() % bodies_.size(), other = random_() % bodies_.size();
    switch (random_() % 5) {
      case 0:
        world_.destroy(bodies_[at]);
        bodies_[at] = world_.create(BodyDef{.position = freePlace(), .shape = kCube});
        break;
      case 1:
        world_.setPose(bodies_[at], {freePlace(), {}});
        break;
      case 2:
        join(bodies_[at], bodies_[other]);
        break;
      case 3:
        if (world_.jointCount() > 0) world_.destroy(world_.joints()[random_() % world_.jointCount()]);
        break;
      case 4:
        if (world_.shapes(bodies_[at]).size() > 1) break;
        world_.create(bodies_[at], {.geometry = Sphere{0.2f}, .pose = {{0.4, 0, 0}, {}}});
        break;
    }
  }

  // At the middle between the two, so that nothing is torn.
  void join(BodyId a, BodyId b) {
    if (a == b || world_.jointCount() > 5) return;
    const Vec3d middle = (world_.pose(a).position + world_.pose(b).position) * 0.5;
    const Pose frameA = inverse(world_.pose(a)) * Pose{middle, {}};
    const Pose frameB = inverse(world_.pose(b)) * Pose{middle, {}};
    world_.create(BallJoint{.bodyA = a, .bodyB = b, .frameA = {frameA.position, {}}, .frameB = {frameB.position, {}}});
  }

  World world_;
  std::mt19937 random_;
  std::vector<BodyId> bodies_;
  int placed_ = 0;
};

TEST(Step, ChurnInTheMiddleOfARunReplays) {
  for (uint32_t seed = 0; seed < 4; ++seed) EXPECT_EQ(Churn(seed).run(300), Churn(seed).run(300));
}

}  // namespace
}  // namespace avbd
