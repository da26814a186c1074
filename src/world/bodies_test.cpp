// Bodies, shapes and joints as data: places, lists, memories, and that nothing dangles under churn.
#include "world/bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "world/joints.h"
#include "world/mass.h"
#include "world/pairs.h"

namespace avbd {
namespace {

const float kHalf = std::sqrt(0.5f);
const Quat kQuarterZ{kHalf, 0, 0, kHalf};

uint32_t make(WorldData& data, const BodyDef& def) { return addBody(data, def, checkedBody(def, 1)); }

PairData pairOf(const WorldData& data, uint32_t shapeA, uint32_t shapeB) {
  PairData pair;
  pair.shapeA = shapeA;
  pair.shapeB = shapeB;
  pair.bodyA = data.shapes[shapeA].body;
  pair.bodyB = data.shapes[shapeB].body;
  return pair;
}

TEST(Bodies, FrameAndCentre) {
  WorldData data;
  const MassProperties mass{.mass = 2, .center = {1, 0, 0}};
  const uint32_t slot = make(data, {.position = {10, 0, 0}, .rotation = kQuarterZ, .massProperties = mass});
  const BodyData& body = data.bodies[slot];
  EXPECT_LT(length(body.position - Vec3d{10, 1, 0}), 1e-6);
  EXPECT_LT(length(bodyPose(body).position - Vec3d{10, 0, 0}), 1e-6);
  moveBody(data, slot, {{0, 5, 0}, {}});
  EXPECT_EQ(body.position, (Vec3d{1, 5, 0}));
}

TEST(Bodies, RadiusAndMinExtent) {
  WorldData data;
  const auto radius = [&](const ShapeDef& shape) {
    const uint32_t slot = make(data, {.type = BodyType::Kinematic, .shapes = {shape}});
    return data.bodies[slot].radius;
  };
  EXPECT_FLOAT_EQ(radius({.geometry = Sphere{2}, .pose = {{0, 3, 0}, {}}}), 5);
  EXPECT_FLOAT_EQ(radius({.geometry = Capsule{0.5f, 2}}), 2.5f);
  EXPECT_FLOAT_EQ(radius({.geometry = Capsule{0.5f, 2}, .pose = {{4, 0, 0}, kQuarterZ}}), 6.5f);
  EXPECT_FLOAT_EQ(radius({.geometry = Box{1, 2, 2}}), 3);
  EXPECT_FLOAT_EQ(radius({.geometry = Box{1, 2, 2}, .pose = {{-1, 0, 0}, {}}}), std::sqrt(4.0f + 4 + 4));
  EXPECT_FLOAT_EQ(radius({.geometry = Box{1, 2, 2}, .pose = {{0, -1, 0}, kQuarterZ}}), std::sqrt(4.0f + 4 + 4));
  EXPECT_EQ(radius({.geometry = HalfSpace{}}), 0);
  const uint32_t both =
      make(data, {.type = BodyType::Static, .shapes = {{.geometry = Box{3, 0.2f, 4}}, {.geometry = Sphere{0.5f}}}});
  EXPECT_FLOAT_EQ(data.bodies[both].minExtent, 0.2f);
  // A corner of a turned box is inside the ball, and touches it.
  const ShapeDef turned{.geometry = Box{1, 2, 3}, .pose = {{0.5, -0.25, 2}, {0.5f, 0.5f, -0.5f, 0.5f}}};
  double farthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{corner & 1 ? 1.0f : -1.0f, corner & 2 ? 2.0f : -2.0f, corner & 4 ? 3.0f : -3.0f};
    farthest = std::max(farthest, length(turned.pose.position + toDouble(rotate(turned.pose.rotation, p))));
  }
  EXPECT_NEAR(radius(turned), farthest, 1e-5);
}

TEST(Bodies, ShapesAreInTheTreeWithAMargin) {
  WorldData data;
  const uint32_t slot = make(data, {.position = {10, 0, 0}, .shape = Box{1, 2, 3}});
  const ShapeData& shape = data.shapes[data.bodies[slot].firstShape];
  EXPECT_EQ(data.tree.size(), 1u);
  EXPECT_EQ(data.tree.userData(shape.proxy), data.bodies[slot].firstShape);
  EXPECT_NEAR(data.tree.box(shape.proxy).lower.x, 9 - 0.05, 1e-4);
  EXPECT_NEAR(data.tree.box(shape.proxy).upper.z, 3 + 0.05, 1e-4);
  moveBody(data, slot, {{-20, 0, 0}, {}});
  EXPECT_NEAR(data.tree.box(shape.proxy).lower.x, -21 - 0.05, 1e-4);
  removeBody(data, slot);
  EXPECT_EQ(data.tree.size(), 0u);
}

TEST(Bodies, MoveErasesPairsAndMarks) {
  WorldData data;
  const uint32_t a = make(data, {.shape = Box{}});
  for (int i = 0; i < 2; ++i) make(data, {.shape = Box{}});
  data.pairs.insert(std::vector{pairOf(data, 0, 1), pairOf(data, 1, 2)});
  data.unpaired.clear();
  moveBody(data, a, {});
  dropForgottenPairs(data);
  ASSERT_EQ(data.pairs.size(), 1u);
  EXPECT_EQ(data.pairs[0].shapeB, 2u);
  EXPECT_EQ(data.unpaired, std::vector<uint32_t>{0});
}

TEST(Bodies, NewCentreKeepsEveryPointWhereItWasAndAsFast) {
  WorldData data;
  const uint32_t slot = make(data, {.position = {1, 2, 3},
                                    .rotation = kQuarterZ,
                                    .linearVelocity = {1, 0, 0},
                                    .angularVelocity = {0, 0, 2},
                                    .shape = Box{}});
  const uint32_t other = make(data, {.shape = Box{}});
  const BallJoint ball{data.bodyIds.id(slot), data.bodyIds.id(other), {{0, 1, 0}, {}}, {{0, -1, 0}, {}}};
  const uint32_t joint = addJoint(data, checkedJoint(data, ball));
  data.pairs.insert(std::vector{pairOf(data, 0, 1)});
  data.pairs[0].pointCount = 1;
  data.pairs[0].points[0].anchorA = {0.5f, 0, 0};
  data.pairs[0].points[0].anchorB = {0, 0.5f, 0};
  data.pairs[0].kept.what = KeptManifold::What::PointsOnA;
  const BodyData& body = data.bodies[slot];
  const Pose before = bodyPose(body);
  setMass(data, slot, {.mass = 2, .center = {0.25f, 0, 0}});
  EXPECT_EQ(body.mass, 2);
  EXPECT_LT(length(bodyPose(body).position - before.position), 1e-6);
  EXPECT_LT(length(body.position - Vec3d{1, 2.25, 3}), 1e-6);
  EXPECT_LT(length(body.linearVelocity - Vec3{0.5f, 0, 0}), 1e-6f) << "v + w x shift";
  EXPECT_EQ(data.joints[joint].anchor[0], (Vec3{-0.25f, 1, 0}));
  EXPECT_EQ(data.joints[joint].anchor[1], (Vec3{0, -1, 0}));
  EXPECT_EQ(data.pairs[0].points[0].anchorA, (Vec3{0.25f, 0, 0}));
  EXPECT_EQ(data.pairs[0].points[0].anchorB, (Vec3{0, 0.5f, 0}));
  EXPECT_EQ(data.pairs[0].kept.what, KeptManifold::What::Nothing) << "it is about the old centre";
  EXPECT_EQ(data.shapes[0].toMass.p, (Vec3{-0.25f, 0, 0}));
}

TEST(Bodies, LockedAxesDoNotMove) {
  WorldData data;
  const uint32_t slot = make(data, {.linearVelocity = {1, 2, 3},
                                    .angularVelocity = {4, 5, 6},
                                    .shape = Box{},
                                    .locks = kLockLinearY | kLockAngularX | kLockAngularZ});
  EXPECT_EQ(data.bodies[slot].linearVelocity, (Vec3{1, 0, 3}));
  EXPECT_EQ(data.bodies[slot].angularVelocity, (Vec3{0, 5, 0}));
}

// Every link, count and slot in the data, against the tables themselves.
void expectConsistent(const WorldData& data) {
  size_t shapes = 0, jointEnds = 0, listedEnds = 0;
  data.bodyIds.forEach([&](uint32_t b) {
    for (uint32_t s = data.bodies[b].firstShape; s != kNone; s = data.shapes[s].next, ++shapes) {
      ASSERT_TRUE(data.shapeIds.isAliveSlot(s));
      ASSERT_EQ(data.shapes[s].body, b);
      ASSERT_EQ(data.tree.userData(data.shapes[s].proxy), s);
    }
    for (uint32_t j = data.bodies[b].firstJoint; j != kNone; ++listedEnds) {
      ASSERT_TRUE(data.jointIds.isAliveSlot(j));
      const int side = sideOf(data.joints[j], b);
      ASSERT_EQ(data.joints[j].body[side], b);
      j = data.joints[j].next[side];
    }
  });
  std::vector<uint64_t> excluded;
  data.jointIds.forEach([&](uint32_t j) {
    const JointData& joint = data.joints[j];
    for (const uint32_t body : joint.body) {
      if (body == kNone) continue;
      ++jointEnds;
      ASSERT_TRUE(data.bodyIds.isAliveSlot(body));
    }
    if (joint.collideConnected || joint.body[0] == kNone || joint.body[1] == kNone) return;
    excluded.push_back(uint64_t{std::min(joint.body[0], joint.body[1])} << 32 | std::max(joint.body[0], joint.body[1]));
  });
  std::sort(excluded.begin(), excluded.end());
  ASSERT_EQ(data.excludedPairs, excluded);
  ASSERT_EQ(shapes, data.shapeIds.count());
  ASSERT_EQ(data.tree.size(), data.shapeIds.count());
  ASSERT_EQ(listedEnds, jointEnds);
  for (const uint32_t s : data.unpaired) ASSERT_TRUE(data.shapeIds.isAliveSlot(s));
  ASSERT_TRUE(std::is_sorted(data.unpaired.begin(), data.unpaired.end()));
  uint64_t lastKey = 0;
  forEachPair(data, [&](const PairData& pair) {
    ASSERT_TRUE(data.shapeIds.isAliveSlot(pair.shapeA) && data.shapeIds.isAliveSlot(pair.shapeB));
    ASSERT_EQ(data.shapes[pair.shapeA].body, pair.bodyA);
    ASSERT_EQ(data.shapes[pair.shapeB].body, pair.bodyB);
    ASSERT_FALSE(isExcluded(data, pair.bodyA, pair.bodyB));
    ASSERT_LT(lastKey, pair.key());
    lastKey = pair.key();
  });
}

class Churn {
 public:
  void run(int count) {
    for (int i = 0; i < count; ++i) {
      act();
      if (i % 8 == 0) {
        expectConsistent(data_);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
    while (data_.bodyIds.count() > 0) removeBody(data_, pick(data_.bodyIds));
    dropForgottenPairs(data_);
    expectConsistent(data_);
    EXPECT_EQ(data_.jointIds.count(), 0u);
    EXPECT_TRUE(data_.pairs.empty() && data_.unpaired.empty() && data_.excludedPairs.empty());
  }

 private:
  template <class Tag>
  uint32_t pick(const HandlePool<Tag>& pool) {
    std::vector<uint32_t> slots;
    pool.forEach([&](uint32_t slot) { slots.push_back(slot); });
    return slots[random_() % slots.size()];
  }
  Pose place() { return {{double(random_() % 20), double(random_() % 20), double(random_() % 20)}, {}}; }

  void act() {
    const uint32_t choice = random_() % 16;
    const size_t count = data_.bodyIds.count();
    if ((choice < 4 && count < 24) || count < 8) {
      const BodyType type = random_() % 4 ? BodyType::Dynamic : BodyType::Static;
      std::vector<ShapeDef> shapes(1 + random_() % 3);
      make(data_, {.type = type, .position = place().position, .shapes = shapes});
    } else if (choice < 7) {
      removeBody(data_, pick(data_.bodyIds));
    } else if (choice < 10) {
      tryJoint();
    } else if (choice == 10 && data_.jointIds.count() > 0) {
      removeJoint(data_, pick(data_.jointIds));
    } else if (choice == 11) {
      addShape(data_, pick(data_.bodyIds), {.geometry = Sphere{}, .pose = place()});
    } else if (choice == 12 && data_.shapeIds.count() > 0) {
      const uint32_t shape = pick(data_.shapeIds);
      forgetPairsOfShape(data_, shape);
      removeShape(data_, shape);
    } else if (choice == 13) {
      moveBody(data_, pick(data_.bodyIds), place());
    } else {
      pairUp();
    }
  }

  void tryJoint() {
    const auto body = [&] { return random_() % 8 ? data_.bodyIds.id(pick(data_.bodyIds)) : BodyId{}; };
    try {
      if (random_() % 3 == 0) {
        addJoint(data_, checkedJoint(data_, TetVolume{.bodies = {body(), body(), body(), body()}, .restVolume = 1}));
      } else {
        addJoint(data_, checkedJoint(data_, BallJoint{body(), body(), {}, {}, random_() % 2 == 0}));
      }
    } catch (const Error&) {
    }
  }

  // Stands in for the step's broad phase.
  void pairUp() {
    dropForgottenPairs(data_);
    data_.unpaired.clear();
    data_.shapeIds.forEach([&](uint32_t a) {
      data_.shapeIds.forEach([&](uint32_t b) {
        if (a >= b || random_() % 8 || !mayTouch(data_, a, b)) return;
        const PairData pair = pairOf(data_, a, b);
        if (findPair(data_, pair.key()) == data_.pairs.size()) data_.pairs.insert({&pair, 1});
      });
    });
  }

  WorldData data_;
  std::mt19937 random_{7};
};

TEST(Bodies, NothingDanglesUnderChurn) { Churn().run(10000); }

TEST(Bodies, ACopyOfTheDataIsASnapshot) {
  WorldData data;
  for (int i = 0; i < 20; ++i) make(data, {.position = {double(i), 0, 0}, .shape = Box{}});
  const WorldData copy = data;
  removeBody(data, 3);
  make(data, {.shape = Sphere{}});
  expectConsistent(copy);
  EXPECT_EQ(copy.bodies[3].position, (Vec3d{3, 0, 0}));
}

}  // namespace
}  // namespace avbd
