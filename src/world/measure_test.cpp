// Energy, momenta, joint errors and contacts against hand calculation; the hash sees every field that a step changes.
#include "world/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "world/bodies.h"
#include "world/joints.h"
#include "world/state_hash.h"

namespace avbd {
namespace {

uint32_t make(WorldData& data, const BodyDef& def) { return addBody(data, def, checkedBody(def, 1)); }

TEST(Measure, EnergyAndMomenta) {
  WorldData data;
  const MassProperties mass{.mass = 2, .inertia = {1, 2, 2.5f, 0, 0, 0}};
  const float half = std::sqrt(0.5f);
  // The body's x axis points along the world's y.
  make(data, {.position = {0, 3, 0},
              .rotation = {half, 0, 0, half},
              .linearVelocity = {4, 0, 0},
              .angularVelocity = {0, 3, 0},
              .massProperties = mass});
  make(data, {.type = BodyType::Kinematic, .linearVelocity = {100, 0, 0}, .shape = Box{}});
  EXPECT_NEAR(totalKineticEnergy(data), 0.5 * (2 * 16 + 1 * 9), 1e-5);
  EXPECT_LT(length(totalMomentum(data) - Vec3d{8, 0, 0}), 1e-9);
  EXPECT_LT(length(totalAngularMomentum(data, {}) - Vec3d{0, 3, -24}), 1e-5);
  EXPECT_LT(length(totalAngularMomentum(data, {0, 3, 0}) - Vec3d{0, 3, 0}), 1e-5);
  EXPECT_EQ(kineticEnergyOf(data.bodies[1]), 0);
}

TEST(Measure, JointErrors) {
  WorldData data;
  const uint32_t a = make(data, {.position = {1e6, 0, 0}, .shape = Box{}});
  const BodyId idA = data.bodyIds.id(a);
  const float angle = 0.5f;
  const Quat turn{std::cos(angle / 2), 0, std::sin(angle / 2), 0};
  const FixedJoint fixed{{}, idA, {{1e6, 2, 0}, turn}, {{0, 1.5, 0}, {}}};
  const uint32_t slot = addJoint(data, checkedJoint(data, fixed));
  EXPECT_NEAR(jointGap(data, data.joints[slot]), 0.5, 1e-9);
  EXPECT_NEAR(jointAngleError(data, data.joints[slot]), 0.5, 1e-6);
  // The same rotation with the other sign is no error.
  data.joints[slot].axes[1] = {-turn.w, -turn.x, -turn.y, -turn.z};
  EXPECT_NEAR(jointAngleError(data, data.joints[slot]), 0, 1e-3);
  const BallJoint ball{{}, idA, {{1e6, 0, 3}, turn}, {}};
  const uint32_t ballSlot = addJoint(data, checkedJoint(data, ball));
  EXPECT_NEAR(jointGap(data, data.joints[ballSlot]), 3, 1e-9);
  EXPECT_EQ(jointAngleError(data, data.joints[ballSlot]), 0);
}

TEST(Measure, TetGapIsInVolume) {
  WorldData data;
  TetVolume tet{.restVolume = 0.5f};
  const Vec3d corners[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (size_t i = 0; i < 4; ++i) {
    tet.bodies[i] = data.bodyIds.id(make(data, {.position = corners[i], .shape = Sphere{0.1f}}));
  }
  const uint32_t slot = addJoint(data, checkedJoint(data, tet));
  EXPECT_NEAR(jointGap(data, data.joints[slot]), 0.5 - 1.0 / 6, 1e-9);
}

TEST(Measure, ContactPoints) {
  WorldData data;
  make(data, {.shape = Box{}});
  make(data, {.shape = Box{}});
  PairData pair;
  pair.shapeB = pair.bodyB = 1;
  pair.origin = {1e7, 0, 0};
  pair.manifold.normal = pair.normal = {0, 1, 0};
  pair.t1 = {0, 0, 1};
  pair.t2 = {1, 0, 0};
  pair.manifold.count = 2;
  pair.manifold.points[0] = {{0.25f, 1, 0}, -0.01f, 77};
  pair.pointCount = 1;
  pair.points[0].lambda = {10, 2, 3};
  const Contact contact = contactOf(data, pair, pair);
  EXPECT_EQ(contact.shapeB, (ShapeId{2, 1}));
  EXPECT_EQ(contact.bodyA, (BodyId{1, 1}));
  EXPECT_EQ(contact.pointCount, 2);
  EXPECT_EQ(contact.normal, (Vec3{0, 1, 0}));
  const ContactPoint& point = contact.points[0];
  EXPECT_EQ(point.position, (Vec3d{1e7 + 0.25, 1, 0}));
  EXPECT_EQ(point.separation, -0.01f);
  EXPECT_EQ(point.normalForce, 10);
  EXPECT_EQ(point.frictionForce, (Vec3{3, 0, 2}));
  EXPECT_EQ(point.feature, 77u);
  EXPECT_EQ(contact.points[1].normalForce, 0) << "a point without memory carries nothing";
  data.means = {{}, {Vec3{4, 5, 6}}};
  pair.mean = 1;
  EXPECT_EQ(contactOf(data, pair, pair).points[0].normalForce, 4);
  EXPECT_EQ(contactOf(data, pair, pair).points[0].frictionForce, (Vec3{6, 0, 5}));
  pair.manifold.count = pair.pointCount = 0;
  EXPECT_EQ(contactOf(data, pair, pair).pointCount, 0);
  pair.gonePoints = 1;
  EXPECT_EQ(contactOf(data, pair, pair).pointCount, 1);
  EXPECT_EQ(contactOf(data, pair, pair).points[0].normalForce, 4) << "pushed in an earlier substep";
}

TEST(StateHash, SeesEveryFieldThatAStepChanges) {
  WorldData data;
  make(data, {.shape = Box{}});
  make(data, {.position = {3, 0, 0}, .shape = Box{}});
  addJoint(data, checkedJoint(data, BallJoint{.bodyA = data.bodyIds.id(0)}));
  data.pairs.insert(std::vector<PairData>(1));
  data.pairs[0].shapeB = data.pairs[0].bodyB = 1;
  data.pairs[0].pointCount = 1;
  data.pairs[0].kept.what = KeptManifold::What::PointsOnA;
  const uint64_t before = stateHash(data);
  EXPECT_EQ(stateHash(WorldData(data)), before);
  using Change = std::function<void(WorldData&)>;
  const Change changes[] = {
      [](WorldData& d) { d.bodies[0].position.x = std::nextafter(d.bodies[0].position.x, 1.0); },
      [](WorldData& d) { d.bodies[1].rotation.y = 1e-7f; },
      [](WorldData& d) { d.bodies[1].linearVelocity.z = 1; },
      [](WorldData& d) { d.bodies[1].angularVelocity.x = 1; },
      [](WorldData& d) { d.bodies[1].force.x = 1; },
      [](WorldData& d) { d.bodies[1].torque.x = 1; },
      [](WorldData& d) { d.joints[0].lambda[5] = 1; },
      [](WorldData& d) { d.pairs[0].normal.x = 1; },
      [](WorldData& d) { d.pairs[0].pointCount = 0; },
      [](WorldData& d) { d.pairs[0].slides = true; },
      [](WorldData& d) { d.pairs[0].points[0].lambda.y = 1; },
      [](WorldData& d) { d.pairs[0].points[0].anchorA.y = 1; },
      [](WorldData& d) { d.pairs[0].points[0].anchorB.y = 1; },
      [](WorldData& d) { d.pairs[0].points[0].feature = 1; },
      [](WorldData& d) { d.pairs[0].points[0].rebound = 1; },
      [](WorldData& d) { d.pairs[0].points[0].impact = 1; },
      [](WorldData& d) { d.pairs[0].points[0].sticks = 1; },
      [](WorldData& d) { d.pairs[0].kept.what = KeptManifold::What::PointsOnB; },
      [](WorldData& d) { d.pairs[0].kept.aroundBase = true; },
      [](WorldData& d) { d.pairs[0].kept.offset.z = 1; },
      [](WorldData& d) { d.pairs[0].kept.turn.x = 1; },
      [](WorldData& d) { d.pairs[0].kept.clear = 1; },
      [](WorldData& d) { d.pairs[0].kept.reach = 1; },
      [](WorldData& d) { d.pairs[0].kept.normal.y = 1; },
      [](WorldData& d) { d.pairs[0].kept.x[0] = 1; },
      [](WorldData& d) { d.pairs[0].kept.height[0] = 1; },
      [](WorldData& d) { d.pairs.clear(); },
      [](WorldData& d) { d.bodyIds.create(), d.bodies.push_back({}); },
  };
  int index = 0;
  for (const Change& change : changes) {
    WorldData changed = data;
    change(changed);
    EXPECT_NE(stateHash(changed), before) << "change " << index;
    ++index;
  }
}

TEST(StateHash, DoesNotSeeWhatIsUnused) {
  WorldData data;
  make(data, {.shape = Box{}});
  data.pairs.insert(std::vector<PairData>(1));
  const uint64_t before = stateHash(data);
  data.pairs[0].points[3].feature = 9;
  data.pairs[0].normal.x = 1;
  data.pairs[0].kept.what = KeptManifold::What::Apart;
  data.pairs[0].kept.clear = 1;
  data.report.seconds[0] = 1;
  data.def.workers = 7;
  data.def.simdWidth = 4;
  EXPECT_EQ(stateHash(data), before);
}

}  // namespace
}  // namespace avbd
