// What records of the benchmark say, and that peers build what a scene holds.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/bench.h"
#include "scenes/build.h"

namespace avbd::bench {
namespace {

BenchRecord sized(size_t bodies, double ms) {
  BenchRecord r;
  r.bodies = bodies;
  r.msMedian = ms;
  return r;
}

TEST(BenchRecord, CostExponentIsTheSlope) {
  const BenchRecord records[] = {sized(100, 3), sized(1000, 3 * std::pow(10, 1.2)),
                                 sized(10000, 3 * std::pow(10, 2.4))};
  EXPECT_NEAR(costExponent(records), 1.2, 1e-9);
  EXPECT_TRUE(std::isnan(costExponent({})));
  const BenchRecord same[] = {sized(100, 3), sized(100, 4)};
  EXPECT_TRUE(std::isnan(costExponent(same)));
}

// A box and a capsule at rest on the ground, a ball that hangs from a box fixed to the world, and one that flies.
Model assorted(const scenes::Settings& settings) {
  scenes::Build build("assorted", settings);
  build.ground();
  build.box("box", {0.5f, 0.3f, 0.4f}, {0, 0.3, 0}, 5);
  BodyDef lying;
  lying.position = {3, 0.2, 0};
  lying.rotation = scenes::turned({0, 0, 1}, 1.5707963267948966);
  lying.shape = Capsule{0.2f, 0.5f};
  lying.mass = 2;
  build.add("capsule", lying);
  const BodyId hook = build.box("hook", {0.1f, 0.1f, 0.1f}, {-3, 4, 0}, 1);
  build.join(FixedJoint{}, {}, hook, {{-3, 4, 0}, {}});
  build.joint(hook, build.ball("ball", 0.2f, {-3, 3, 0}, 1), {-3, 4, 0});
  build.ball("flies", 0.2f, {6, 20, 0}, 1, {{2, 0, 1}, {0, 3, 0}});
  return build.take();
}

TEST(Peers, HoldTheSameScene) {
  scenes::Scene scene{"assorted",
                      "",
                      "",
                      assorted,
                      0,
                      60,
                      {},
                      [](const scenes::Evidence& e) {
                        return std::vector<scenes::Figure>{scenes::holds("finite", e.finite)}; }};
  std::vector<Pose> last;
  scene.watch.gap = true;
  scene.watch.observe = [&](scenes::Evidence&, const scenes::Layout&, std::span<const Pose> poses, int) {
    last.assign(poses.begin(), poses.end());
  };
  for (const Peer& peer : peers()) {
    if (!peer.built) continue;
    SCOPED_TRACE(peer.name);
    const BenchRecord r = peer.run(scene);
    EXPECT_EQ(r.check, "pass");
    EXPECT_EQ(r.bodies, 5u);
    EXPECT_LT(r.jointGapMax, 0.01);
    ASSERT_EQ(last.size(), 6u);
    EXPECT_NEAR(last[1].position.y, 0.3, 0.05);
    EXPECT_NEAR(last[2].position.y, 0.2, 0.05);
    EXPECT_NEAR(last[4].position.y, 3, 0.02);
    // A second of free flight.
    EXPECT_NEAR(last[5].position.x, 8, 0.05);
    EXPECT_NEAR(last[5].position.y, 20 - 4.905, 0.2);
    EXPECT_NEAR(last[5].position.z, 1, 0.05);
  }
}

// Bullet alone builds soft bodies; with four steps a frame its own settings hold one on the ground.
TEST(Peers, SoftBodiesAreBuiltOrRefused) {
  scenes::Scene scene{
      "soft",
      "",
      "",
      [](const scenes::Settings& settings) {
        scenes::Build build("soft", settings);
        build.ground();
        build.box("far", {0.2f, 0.2f, 0.2f}, {2, 0.2, 0}, 5);
        build.soft("cube", {.mesh = makeTetBox({0.2f, 0.2f, 0.2f}, 2, 2, 2), .pose = {{0, 0.5, 0}, {}}});
        return build.take();
      },
      0,
      120,
      {},
      [](const scenes::Evidence& e) {
        return std::vector<scenes::Figure>{scenes::holds("finite", e.finite), {"top", "", e.top, 0.35, 0.45, "m"}};
      }};
  for (const Peer& peer : peers()) {
    if (!peer.built) continue;
    SCOPED_TRACE(peer.name);
    const std::string name = peer.name;
    if (!name.starts_with("bullet")) {
      EXPECT_THROW(peer.run(scene), Error);
      continue;
    }
    const BenchRecord r = peer.run(scene);
    EXPECT_EQ(r.bodies, 28u);
    EXPECT_GT(r.displacementMax, 0.05);
    if (name == "bullet4") EXPECT_EQ(r.check, "pass");
  }
}

TEST(Peers, RefuseWhatTheyCannotBuild) {
  const scenes::Scene scene{"cones",
                            "",
                            "",
                            [](const scenes::Settings& settings) {
                              scenes::Build build("cones", settings);
                              BodyDef def;
                              def.shape = Cone{};
                              build.add("cone", def);
                              return build.take();
                            },
                            0,
                            1,
                            {},
                            {}};
  for (const Peer& peer : peers()) EXPECT_THROW(peer.run(scene), Error) << peer.name;
}

}  // namespace
}  // namespace avbd::bench
