// A world's joints and touches as they come into a recording.
#include "io/record/source.h"

#include <gtest/gtest.h>

#include <cmath>

namespace avbd::record {
namespace {

constexpr float kPi = 3.14159265f;

BodyId addBall(Model& model, const std::string& name, Vec3d at) {
  const BodyId id = model.world.create(BodyDef{.position = at, .shape = Sphere{0.1f}, .mass = 2});
  model.bodies.push_back({id, name});
  return id;
}

/// A ball on an arm of 1 m to the side of a hinge about z, which lets it fall by 0.5 rad.
Model swingingArm(const JointLimit& limit) {
  Model model;
  const BodyId ball = addBall(model, "ball", {1, 0, 0});
  const Quat xToZ{std::cos(kPi / 4), 0, -std::sin(kPi / 4), 0};
  const JointId hinge =
      model.world.create(HingeJoint{.bodyB = ball, .frameA = {{}, xToZ}, .frameB = {{-1, 0, 0}, xToZ}, .limit = limit});
  model.joints.push_back({"elbow", hinge});
  return model;
}

RecordedFrame run(Model& model, RecordSource& source, int steps) {
  for (int i = 0; i < steps; ++i) {
    model.world.step(1.0f / 120);
    source.watch(model.world);
  }
  return source.frame(model, model.world.time());
}

TEST(RecordSource, AHingeCarriesWhatHangsOnIt) {
  Model model = swingingArm({.lower = -0.5f});
  RecordSource source(model);
  ASSERT_EQ(source.head().joints.size(), 1u);
  const RecordedJoint& joint = source.head().joints[0];
  EXPECT_EQ(joint.type, JointType::Hinge);
  EXPECT_EQ(joint.name, "elbow");
  EXPECT_EQ(joint.bodyA, kNotRecorded);
  EXPECT_EQ(joint.bodyB, 0u);
  EXPECT_EQ(joint.freeAxes, 1u << 3);
  EXPECT_EQ(joint.limits[3], (RecordedLimit{-0.5f, INFINITY}));
  EXPECT_EQ(joint.frameB.position, (Vec3d{-1, 0, 0}));
  EXPECT_NE(joint.frameA.rotation, Quat{});
  const RecordedFrame frame = run(model, source, 600);
  ASSERT_EQ(frame.joints.size(), 1u);
  EXPECT_TRUE(frame.joints[0].enabled);
  // On A, the world: the weight, and that it pulls down on the arm.
  EXPECT_NEAR(frame.joints[0].reaction.force.y, -2 * 9.81, 0.1);
  EXPECT_NEAR(frame.joints[0].reaction.torque.z, -2 * 9.81 * std::cos(0.5), 0.3);
  EXPECT_EQ(frame.limitExcessMax, 0);
  EXPECT_LT(frame.limitExcessAngleMax, 1e-3);
  EXPECT_LT(frame.joints[0].reaction.torque.z, 0);
}

TEST(RecordSource, ASoftLimitIsPassedByWhatItsSpringNeeds) {
  Model model = swingingArm({.lower = 0, .stiffness = 200, .damping = 40});
  RecordSource source(model);
  const RecordedFrame frame = run(model, source, 1200);
  EXPECT_NEAR(frame.limitExcessAngleMax, 2 * 9.81 / 200, 2e-3);
  EXPECT_EQ(frame.limitExcessMax, 0);
  model.world.setEnabled(model.joints[0].id, false);
  const RecordedFrame off = run(model, source, 1);
  EXPECT_FALSE(off.joints[0].enabled);
  EXPECT_EQ(off.limitExcessAngleMax, 0);
  model.world.destroy(model.joints[0].id);
  EXPECT_FALSE(run(model, source, 1).joints[0].enabled);
}

TEST(RecordSource, EveryTypeSaysWhatItLeavesFree) {
  Model model;
  const BodyId a = addBall(model, "a", {}), b = addBall(model, "b", {0, -1, 0});
  model.world.create(BallJoint{.bodyA = a, .bodyB = b, .frameA = {{0, -1, 0}, {}}});
  model.world.create(FixedJoint{.bodyB = a});
  model.world.create(SliderJoint{.bodyB = b, .limit = {.lower = -1, .upper = 2}});
  model.world.create(DistanceJoint{.bodyA = a, .bodyB = b, .min = 0.5f, .max = 1.5f});
  model.world.create(coneJoint(a, b, {}, {{0, 1, 0}, {}}, {.y = 0.5f, .z = 1}, {.lower = -1, .upper = 1}));
  const RecordSource source(model);
  const std::vector<RecordedJoint>& joints = source.head().joints;
  ASSERT_EQ(joints.size(), 5u);
  EXPECT_EQ(joints[0].freeAxes, 0x38);
  EXPECT_EQ(joints[1].freeAxes, 0);
  EXPECT_EQ(joints[2].freeAxes, 1);
  EXPECT_EQ(joints[2].limits[0], (RecordedLimit{-1, 2}));
  EXPECT_EQ(joints[3].limits[0], (RecordedLimit{0.5f, 1.5f}));
  EXPECT_EQ(joints[4].type, JointType::D6);
  EXPECT_EQ(joints[4].freeAxes, 0x38);
  EXPECT_EQ(joints[4].limits[3], (RecordedLimit{-1, 1}));
  EXPECT_EQ(joints[4].coneY, 0.5f);
  EXPECT_EQ(joints[4].coneZ, 1);
}

/// Holds body 0's height at constants[0], and its x at zero by a spring.
class Rail final : public CustomFamily {
 public:
  std::string name() const override { return "rail"; }
  int rowCount() const override { return 2; }
  void evaluate(std::span<const CustomBody> now, std::span<const CustomBody>, float, std::span<const float> constants,
                std::span<const float>, std::span<CustomRow> rows) const override {
    rows[0].C = now[0].center.y - static_cast<double>(constants[0]);
    rows[0].linear[0] = {0, 1, 0};
    rows[1].C = now[0].center.x;
    rows[1].linear[0] = {1, 0, 0};
    rows[1].stiffness = 50;
  }
};

TEST(RecordSource, PulleysHaveWheelsAndWhatTheirRopeMisses) {
  Model model;
  const BodyId a = addBall(model, "a", {-1, 0, 0}), b = addBall(model, "b", {1, 0, 0});
  const JointId rope = model.world.create(PulleyJoint{
      .bodyA = a, .bodyB = b, .frameA = {{0, 0.1, 0}, {}}, .wheelA = {-1, 3, 0}, .wheelB = {1, 2, 0}, .ratio = 2});
  model.joints.push_back({"hoist", rope});
  RecordSource source(model);
  const RecordedJoint& joint = source.head().joints.at(0);
  EXPECT_EQ(joint.type, JointType::Pulley);
  EXPECT_EQ(joint.name, "hoist");
  EXPECT_EQ(joint.frameA.position, (Vec3d{0, 0.1, 0}));
  EXPECT_EQ(joint.wheels, (std::array<Vec3d, 2>{{{-1, 3, 0}, {1, 2, 0}}}));
  EXPECT_EQ(joint.ratio, 2);
  EXPECT_FLOAT_EQ(joint.limits[0].upper, 2.9f + 2 * 2);
  EXPECT_EQ(joint.limits[0].lower, 0);
  RecordedFrame frame = run(model, source, 30);
  ASSERT_EQ(frame.residuals.size(), 1u);
  EXPECT_NEAR(frame.residuals[0], 0, 1e-3);
  EXPECT_GT(frame.joints[0].reaction.force.y, 5);
  model.world.setPose(a, {{-1, -1, 0}, {}});
  EXPECT_NEAR(source.frame(model, 1).residuals[0], model.world.gap(rope), 1e-6);
  model.world.setPose(a, {{-1, 2, 0}, {}});
  EXPECT_EQ(source.frame(model, 1).residuals[0], 0) << "a rope may be slack";
}

TEST(RecordSource, CouplingsNameTheirJointsWhereverTheyStand) {
  Model model;
  World& world = model.world;
  const BodyId a = addBall(model, "a", {}), b = addBall(model, "b", {2, 0, 0});
  const JointId first = world.create(HingeJoint{.bodyB = a}), second = world.create(SliderJoint{.bodyB = b});
  // Takes a slot before the joint that it names.
  world.destroy(first);
  const JointId spare = world.create(HingeJoint{.bodyB = a, .frameA = {{9, 0, 0}, {}}});
  const JointId third = world.create(HingeJoint{.bodyB = a, .frameA = {}, .frameB = {}});
  world.destroy(spare);
  Coupling rack{.terms = {{third, JointAxis::Twist, 2, 0.5f}, {second, JointAxis::LinearX, -1}}};
  rack.rest = 0.25;
  const JointId coupling = world.create(rack);
  ASSERT_LT(coupling.index, third.index);
  Coupling tendon = rack;
  tendon.axis.motion = AxisMotion::Free;
  tendon.axis.limit = {.lower = -1, .upper = -0.5f};
  world.create(tendon);
  RecordSource source(model);
  const std::vector<RecordedJoint>& joints = source.head().joints;
  ASSERT_EQ(joints.size(), 4u);
  EXPECT_EQ(joints[0].type, JointType::Coupling);
  EXPECT_EQ(joints[0].bodyA, kNotRecorded);
  EXPECT_EQ(joints[0].terms, (std::vector<RecordedTerm>{{2, JointAxis::Twist, {2, 0.5f, 0, 0}},
                                                        {1, JointAxis::LinearX, {-1, 0, 0, 0}}}));
  EXPECT_EQ(joints[0].rest, 0.25);
  EXPECT_EQ(joints[0].freeAxes, 0);
  EXPECT_EQ(joints[3].freeAxes, 1);
  EXPECT_EQ(joints[3].limits[0], (RecordedLimit{-1, -0.5f}));
  const RecordedFrame frame = source.frame(model, 0);
  ASSERT_EQ(frame.residuals.size(), 2u);
  EXPECT_NEAR(frame.residuals[0], 2 * 0 - 2 - 0.25, 1e-6) << "the slider stands at 2";
  EXPECT_NEAR(frame.residuals[1], -2 + 1, 1e-6);
}

TEST(RecordSource, CustomJointsHaveARowsResidualEach) {
  Model model;
  const BodyId a = addBall(model, "a", {0.5, 2, 0});
  const JointId rail = model.world.create(
      CustomJoint{.family = std::make_shared<Rail>(), .bodies = {a}, .bodyCount = 1, .constants = {2.5f}});
  model.world.create(HingeJoint{.bodyB = addBall(model, "b", {9, 0, 0})});
  RecordSource source(model);
  const RecordedJoint& joint = source.head().joints.at(0);
  EXPECT_EQ(joint.type, JointType::Custom);
  EXPECT_EQ(joint.family, "rail");
  EXPECT_EQ(joint.bodyA, 0u);
  EXPECT_EQ(joint.bodyB, kNotRecorded);
  EXPECT_EQ(joint.residuals, 2);
  EXPECT_EQ(source.frame(model, 0).residuals, (std::vector<float>{-0.5f, 0.5f}));
  model.world.setEnabled(rail, false);
  EXPECT_EQ(source.frame(model, 0).residuals, (std::vector<float>{0, 0}));
  model.world.destroy(rail);
  EXPECT_EQ(source.frame(model, 0).residuals, (std::vector<float>{0, 0}));
}

TEST(RecordSource, ACoordinateBeyondItsLimitsIsMeasured) {
  Model model;
  const BodyId a = addBall(model, "a", {0.75, 0, 0});
  const float half = 0.5f;  // b is turned by 1 rad about y: twice its cone
  const BodyId b = model.world.create(
      BodyDef{.position = {5, 0, 0}, .rotation = {std::cos(half), 0, std::sin(half), 0}, .shape = Sphere{0.1f}});
  const JointId slider = model.world.create(SliderJoint{.bodyB = a, .limit = {.lower = -1, .upper = 0.5f}});
  const JointId cone = model.world.create(coneJoint({}, b, {{5, 0, 0}, {}}, {}, {.y = 0.5f, .z = 0.25f}));
  EXPECT_NEAR(limitExcess(model.world, slider).length, 0.25, 1e-6);
  EXPECT_EQ(limitExcess(model.world, slider).angle, 0);
  EXPECT_NEAR(limitExcess(model.world, cone).angle, 0.5, 1e-5);
  EXPECT_EQ(limitExcess(model.world, cone).length, 0);
}

TEST(RecordSource, ATouchHasPlaceNormalAndImpulse) {
  Model model;
  const BodyId ground = model.world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  model.bodies.push_back({ground, "ground"});
  addBall(model, "ball", {3, 0.2, 0});
  RecordSource source(model);
  const RecordedFrame frame = run(model, source, 60);
  bool found = false;
  for (const RecordedEvent& e : frame.events) {
    if (e.kind != RecordedEventKind::TouchBegin) continue;
    found = true;
    EXPECT_NEAR(e.position.x, 3, 1e-3);
    EXPECT_NEAR(std::abs(e.normal.y), 1, 1e-6);
    EXPECT_GT(e.impulse, 0);
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace avbd::record
