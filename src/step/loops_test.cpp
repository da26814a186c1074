// Mechanisms with loops: solved exactly with their trees, without conjugate gradients.
#include <avbd/avbd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace avbd {
namespace {

/// A ring of bars that ball joints close, hung by its first bar, and a gear between two hinged wheels.
struct Mechanism {
  World world;
  std::vector<BodyId> bars;
  std::vector<JointId> joints;
  explicit Mechanism(int krylov) : world(WorldDef{.krylovIterations = krylov}) {
    constexpr int kBars = 7;
    const double radius = 1, turn = 2 * 3.14159265358979323846 / kBars;
    const auto corner = [&](int i) { return Vec3d{radius * std::cos(turn * i), radius * std::sin(turn * i), 0}; };
    for (int i = 0; i < kBars; ++i) {
      const Vec3d middle = (corner(i) + corner(i + 1)) * 0.5;
      bars.push_back(world.create(BodyDef{
          .position = middle, .shape = Box{0.1f, 0.1f, 0.1f}, .mass = i == 3 ? 50.0f : 1.0f, .filter = {.group = -1}}));
    }
    for (int i = 0; i < kBars; ++i)
      ball(bars[static_cast<size_t>(i)], bars[static_cast<size_t>((i + 1) % kBars)], corner(i + 1));
    ball({}, bars[0], corner(0));
  }
  void ball(BodyId a, BodyId b, Vec3d at) {
    const auto in = [&](BodyId body) { return body ? Pose{at - world.pose(body).position, {}} : Pose{at, {}}; };
    joints.push_back(world.create(BallJoint{.bodyA = a, .bodyB = b, .frameA = in(a), .frameB = in(b)}));
  }
  double gap() const {
    double most = 0;
    for (const JointId joint : joints) {
      const BallJoint def = world.ballJoint(joint);
      const auto place = [&](BodyId body, const Pose& frame) {
        if (!body) return frame.position;
        const Pose pose = world.pose(body);
        return pose.position + rotate(pose.rotation, frame.position);
      };
      most = std::max(most, length(place(def.bodyA, def.frameA) - place(def.bodyB, def.frameB)));
    }
    return most;
  }
};

TEST(Loops, NeedNoConjugateGradients) {
  Mechanism one(1), many(16);
  for (int i = 0; i < 120; ++i) {
    one.world.step(1.0f / 60), many.world.step(1.0f / 60);
    for (size_t b = 0; b < one.bars.size(); ++b)
      ASSERT_EQ(one.world.pose(one.bars[b]), many.world.pose(many.bars[b])) << "step " << i << " bar " << b;
    ASSERT_LT(one.gap(), 1e-3) << i;
  }
}

TEST(Loops, AndCouplingsNeedNone) {
  double speed[2];
  for (const int krylov : {1, 16}) {
    World world(WorldDef{.gravity = {}, .krylovIterations = krylov});
    JointId hinge[2];
    BodyId wheel[2];
    for (size_t i = 0; i < 2; ++i) {
      wheel[i] = world.create(BodyDef{.position = {2.0 * static_cast<double>(i), 0, 0},
                                      .angularVelocity = {i == 0 ? 4.0f : 0.0f, 0, 0},
                                      .shape = Box{0.5f, 0.5f, 0.5f},
                                      .mass = 1});
      hinge[i] = world.create(HingeJoint{.bodyB = wheel[i], .frameA = {{2.0 * static_cast<double>(i), 0, 0}, {}}});
    }
    world.create(gear(hinge[0], hinge[1], 0.5f));
    for (int i = 0; i < 60; ++i) world.step(1.0f / 60);
    EXPECT_NEAR(world.velocity(wheel[0]).angular.x, 3.2f, 0.01f);
    EXPECT_NEAR(world.velocity(wheel[1]).angular.x, -1.6f, 0.01f);
    speed[krylov == 1 ? 0 : 1] = static_cast<double>(world.velocity(wheel[0]).angular.x);
  }
  EXPECT_EQ(speed[0], speed[1]);
}

}  // namespace
}  // namespace avbd
