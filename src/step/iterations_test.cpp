// Outer iterations of single bodies: of all that they touch or are jointed to, and of nobody else.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <vector>

namespace avbd {
namespace {

/// Two towers far apart, each of light boxes under a heavy one.
struct Towers {
  World world;
  std::vector<BodyId> near, far;
  explicit Towers(int iterations = 4) : world(WorldDef{.iterations = iterations}) {
    world.create(BodyDef{.type = BodyType::Static, .position = {0, -1, 0}, .shape = Box{200, 1, 10}});
    for (const double x : {0.0, 100.0})
      for (int i = 0; i < 6; ++i)
        (x > 0 ? far : near)
            .push_back(world.create(
                BodyDef{.position = {x, 0.5 + i, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = i < 5 ? 1.0f : 200.0f}));
  }
  void run() {
    for (int i = 0; i < 60; ++i) world.step(1.0f / 60);
  }
  std::vector<Vec3d> places(const std::vector<BodyId>& bodies) const {
    std::vector<Vec3d> out;
    for (const BodyId body : bodies) out.push_back(world.pose(body).position);
    return out;
  }
};

TEST(Iterations, OneBodyAsksForItsWholeIsland) {
  Towers asked, all(8), none;
  asked.world.setIterations(asked.near[3], 8);
  EXPECT_EQ(asked.world.iterations(asked.near[3]), 8);
  asked.run(), all.run(), none.run();
  EXPECT_EQ(asked.places(asked.near), all.places(all.near));
  EXPECT_EQ(asked.places(asked.far), none.places(none.far));
  EXPECT_NE(asked.places(asked.near), none.places(none.near));
}

TEST(Iterations, TheMostThatIsAskedForCounts) {
  Towers asked, none;
  for (const BodyId body : asked.near) asked.world.setIterations(body, 2);
  asked.world.setIterations(asked.near[0], 0);  // the world's four
  asked.run(), none.run();
  EXPECT_EQ(asked.places(asked.near), none.places(none.near));
}

TEST(Iterations, RefusedOutsideTheirRange) {
  Towers towers;
  EXPECT_THROW(towers.world.setIterations(towers.near[0], -1), Error);
  EXPECT_THROW(towers.world.setIterations(towers.near[0], 1001), Error);
  EXPECT_THROW(towers.world.create(BodyDef{.shape = Sphere{1}, .iterations = -1}), Error);
  towers.world.destroy(towers.near[0]);
  EXPECT_THROW(towers.world.setIterations(towers.near[0], 4), Error);
}

TEST(Iterations, AnArticulationSetsThemOfItsLinks) {
  Towers towers;
  const JointId joint = towers.world.create(HingeJoint{.bodyA = towers.near[0], .bodyB = towers.near[1]});
  const Articulation tree(towers.world, std::vector<JointId>{joint});
  tree.setIterations(towers.world, 6);
  EXPECT_EQ(towers.world.iterations(towers.near[0]), 6);
  EXPECT_EQ(towers.world.iterations(towers.near[1]), 6);
  EXPECT_EQ(towers.world.iterations(towers.near[2]), 0);
  EXPECT_THROW(tree.setIterations(towers.world, 2000), Error);
}

}  // namespace
}  // namespace avbd
