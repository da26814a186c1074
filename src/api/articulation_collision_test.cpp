// Which links of an articulation collide: all, none, all but some; what is destroyed is forgotten, and what is refused.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <cmath>

namespace avbd {
namespace {

using Pairs = std::vector<std::array<BodyId, 2>>;

/// Two boxes welded to the world, and a third that slides down from the second onto the first.
class SelfCollisions : public testing::Test {
 protected:
  BodyId box(Vec3d at, BodyType type = BodyType::Dynamic) {
    return world.create(BodyDef{.type = type, .position = at, .shape = Box{}});
  }
  double height() const { return world.pose(c).position.y; }
  void run() {
    for (int i = 0; i < 90; ++i) world.step(1.0f / 60);
  }
  void expectStops(double at = 1) {
    run();
    EXPECT_NEAR(height(), at, 0.01);
  }
  void expectFallsThrough() {
    run();
    EXPECT_LT(height(), -5);
    EXPECT_TRUE(world.events().begins.empty() && world.contacts().empty());
  }
  void lift() {
    tree.setPositions(world, std::array{0.0});
    tree.setVelocities(world, std::array{0.0});
  }
  void expectRefused(const SelfCollision& rule, const std::string& text) {
    const Pairs before = world.excludedPairs();
    try {
      tree.setSelfCollision(world, rule);
      ADD_FAILURE() << "accepted, not: " << text;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find(text), 0u) << error.what();
    }
    EXPECT_EQ(world.excludedPairs(), before);
  }

  const float half = std::sqrt(0.5f);
  const Quat up{half, 0, 0, half};  // turns x to y
  World world;
  BodyId a = box({}), b = box({3, 0, 0}), c = box({0, 2, 0});
  std::vector<JointId> joints{
      world.create(FixedJoint{.bodyB = a}), world.create(FixedJoint{.bodyA = a, .bodyB = b, .frameA = {{3, 0, 0}, {}}}),
      world.create(SliderJoint{.bodyA = b, .bodyB = c, .frameA = {{-3, 2, 0}, up}, .frameB = {{0, 0, 0}, up}})};
  Articulation tree{world, joints};
};

TEST_F(SelfCollisions, LinksCollideByThemselves) { expectStops(); }

TEST_F(SelfCollisions, NoneWhereTheRuleSaysSo) {
  tree.setSelfCollision(world, {.enabled = false});
  expectFallsThrough();
}

TEST_F(SelfCollisions, AllButThePairsExcluded) {
  tree.setSelfCollision(world, {.excluded = {{c, a}, {a, c}, {b, c}}});
  expectFallsThrough();
  lift();
  tree.setSelfCollision(world, {.excluded = {{a, b}, {b, c}}});
  expectStops();
}

TEST_F(SelfCollisions, WhatTouchesPartsAndTouchesAgain) {
  expectStops();
  tree.setSelfCollision(world, {.enabled = false});
  world.step(1.0f / 60);
  EXPECT_EQ(world.events().ends.size(), 1u);
  expectFallsThrough();
  lift();
  tree.setSelfCollision(world, {});
  expectStops();
}

TEST_F(SelfCollisions, OtherBodiesStayAsTheyWere) {
  const BodyId wall = box({0, -3.2, 0}, BodyType::Static), ghost = box({0, -1.2, 0}, BodyType::Static);
  world.excludeCollision(c, ghost);
  tree.setSelfCollision(world, {.enabled = false});
  expectStops(-2.2);
  ASSERT_EQ(world.contacts().size(), 1u);
  EXPECT_EQ(world.contacts()[0].bodyB, wall);
  tree.setSelfCollision(world, {});
  EXPECT_EQ(world.excludedPairs(), (Pairs{{a, b}, {b, c}, {c, ghost}}));
}

TEST_F(SelfCollisions, JoinedLinksFollowTheirJoint) {
  const Pairs joined{{a, b}, {b, c}}, all{{a, b}, {a, c}, {b, c}};
  EXPECT_EQ(tree.excludedPairs(world), joined);
  tree.setSelfCollision(world, {.enabled = false});
  EXPECT_EQ(tree.excludedPairs(world), all);
  tree.setSelfCollision(world, {});
  EXPECT_EQ(tree.excludedPairs(world), joined);
  SliderJoint open = world.sliderJoint(joints[2]);
  open.collideConnected = true;
  world.destroy(joints[2]);
  joints[2] = world.create(open);
  tree = Articulation(world, joints);
  EXPECT_EQ(tree.excludedPairs(world), (Pairs{{a, b}}));
  tree.setSelfCollision(world, {.enabled = false});
  EXPECT_EQ(tree.excludedPairs(world), all);
  world.setEnabled(joints[1], false);
  EXPECT_EQ(tree.excludedPairs(world), all);
  tree.setSelfCollision(world, {.excluded = {{b, c}}});
  EXPECT_EQ(tree.excludedPairs(world), (Pairs{{b, c}})) << "a joint that is disabled excludes nothing";
  world.setEnabled(joints[1], true);
  EXPECT_EQ(tree.excludedPairs(world), (Pairs{{a, b}, {b, c}}));
}

TEST_F(SelfCollisions, TheDestroyedAreForgotten) {
  tree.setSelfCollision(world, {.enabled = false});
  world.destroy(c);
  EXPECT_EQ(world.excludedPairs(), (Pairs{{a, b}}));
  const uint32_t slot = c.index;
  c = box({0, 2, 0});
  ASSERT_EQ(c.index, slot);
  expectStops();
  expectRefused({},
                "Articulation::setSelfCollision.links[2].body = 3 (generation 1): must be a living body of this world");
  EXPECT_THROW((void)tree.excludedPairs(world), Error);
}

TEST_F(SelfCollisions, BadPairsChangeNothing) {
  const BodyId other = box({9, 0, 0}), dead = box({19, 0, 0});
  world.destroy(dead);
  const std::string rule = "Articulation::setSelfCollision.rule.excluded";
  expectRefused({.excluded = {{a, c}, {a, a}}}, rule + "[1][1] = 1 (generation 1): must differ from the other link");
  expectRefused({.excluded = {{a, other}}}, rule + "[0][1] = 4 (generation 1): must name a body of the articulation");
  expectRefused({.excluded = {{dead, a}}}, rule + "[0][0] = 5 (generation 1): must name a living body of this world");
  expectRefused({.enabled = false, .excluded = {{a, {}}}}, rule + "[0][1] = null: must name a living body");
}

}  // namespace
}  // namespace avbd
