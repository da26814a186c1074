// Joints, tendons, actuators and equalities of MJCF as the world has them, by hand-computed figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "io/mjcf.h"
#include "io/mjcf_cases.h"

namespace avbd {
namespace {

using std::numbers::pi;

Model read(const std::string& inside, const MjcfOptions& options = {}) {
  return readMjcfText("<mujoco><compiler angle='radian'/>" + inside + "</mujoco>", "t.xml", options);
}

const NamedJoint& jointOf(const Model& model, const std::string& name) {
  for (const NamedJoint& joint : model.joints) {
    if (joint.name == name) return joint;
  }
  throw std::runtime_error("no joint " + name);
}

double coordinate(const Model& model, const std::string& name) {
  const NamedJoint& joint = jointOf(model, name);
  return joint.sign * model.world.coordinate(joint.id, joint.axis).position + joint.offset;
}

double speed(const Model& model, const std::string& name) {
  const NamedJoint& joint = jointOf(model, name);
  return joint.sign * model.world.coordinate(joint.id, joint.axis).velocity;
}

/// One body on the world, between two geoms so that every inertia counts.
std::string onWorld(const std::string& joints) {
  return "<worldbody><body name='a'>" + joints + "<geom type='box' size='.3 .2 .1' pos='.1 .2 .3'/></body></worldbody>";
}

void expectVector(Vec3d a, Vec3d b, double tolerance = 1e-6) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(MjcfJoint, AHingeTurnsItsBodyAboutItsAxis) {
  const Model model =
      read(onWorld("<joint name='h' axis='0 2 0' pos='1 0 0'/>") + "<keyframe><key qpos='.5' qvel='2'/></keyframe>");
  const NamedJoint& h = jointOf(model, "h");
  EXPECT_EQ(model.world.type(h.id), JointType::Hinge);
  EXPECT_NEAR(coordinate(model, "h"), 0.5, 1e-6);
  EXPECT_NEAR(speed(model, "h"), 2, 1e-5);
  const Pose pose = model.world.pose(bodyOf(model, "a"));
  expectVector(pose.position, {1 - std::cos(0.5), 0, std::sin(0.5)}, 1e-6);
  EXPECT_LT(model.world.gap(h.id), 1e-6);
  EXPECT_LT(model.world.angleError(h.id), 1e-3);
}

TEST(MjcfJoint, ASlideMovesItsBodyAlongItsAxis) {
  const Model model =
      read(onWorld("<joint name='s' type='slide' axis='0 3 4'/>") + "<keyframe><key qpos='2' qvel='-1'/></keyframe>");
  EXPECT_EQ(model.world.type(jointOf(model, "s").id), JointType::Slider);
  EXPECT_NEAR(coordinate(model, "s"), 2, 1e-6);
  EXPECT_NEAR(speed(model, "s"), -1, 1e-6);
  expectVector(model.world.pose(bodyOf(model, "a")).position, {0, 1.2, 1.6});
}

TEST(MjcfJoint, EveryAttributeOfAHinge) {
  const Model model =
      read(onWorld("<joint name='h' range='-1 2' ref='.5' stiffness='7' springref='.8' damping='3' "
                   "armature='.4' frictionloss='.6' solreflimit='.1 1' margin='.1'/>"));
  const NamedJoint& h = jointOf(model, "h");
  const HingeJoint hinge = model.world.hingeJoint(h.id);
  EXPECT_EQ(h.offset, 0.5);
  EXPECT_EQ(h.sign, 1);
  EXPECT_FLOAT_EQ(hinge.limit.lower, -1.5f);
  EXPECT_FLOAT_EQ(hinge.limit.upper, 1.5f);
  EXPECT_FLOAT_EQ(hinge.spring.stiffness, 7);
  EXPECT_FLOAT_EQ(hinge.spring.damping, 3);
  EXPECT_FLOAT_EQ(hinge.spring.position, 0.3f);
  EXPECT_FLOAT_EQ(hinge.armature, 0.4f);
  EXPECT_FLOAT_EQ(hinge.friction, 0.6f);
  EXPECT_TRUE(hasNote(model, "attribute solreflimit is not used"));
  EXPECT_TRUE(hasNote(model, "attribute margin is not used"));
}

TEST(MjcfJoint, AnglesAreDegreesUnlessTheCompilerSaysRadian) {
  const std::string body = onWorld("<joint name='h' range='-90 180' ref='45' springref='90' stiffness='1'/>");
  const Model model = readMjcfText("<mujoco>" + body + "</mujoco>", "t.xml");
  const NamedJoint& h = jointOf(model, "h");
  EXPECT_NEAR(h.offset, pi / 4, 1e-12);
  EXPECT_NEAR(model.world.hingeJoint(h.id).limit.lower, -0.75 * pi, 1e-6);
  EXPECT_NEAR(model.world.hingeJoint(h.id).limit.upper, 0.75 * pi, 1e-6);
  EXPECT_NEAR(model.world.hingeJoint(h.id).spring.position, pi / 4, 1e-6);
}

TEST(MjcfJoint, ARangeCountsUnlessItIsSwitchedOff) {
  const auto isLimited = [](const std::string& head, const std::string& attributes) {
    const Model model = read(head + onWorld("<joint name='h' " + attributes + "/>"));
    return std::isfinite(model.world.hingeJoint(jointOf(model, "h").id).limit.upper);
  };
  EXPECT_TRUE(isLimited("", "range='0 1'"));
  EXPECT_FALSE(isLimited("", "range='0 1' limited='false'"));
  EXPECT_FALSE(isLimited("<compiler autolimits='false'/>", "range='0 1'"));
  EXPECT_TRUE(isLimited("<compiler autolimits='false'/>", "range='0 1' limited='true'"));
  EXPECT_FALSE(isLimited("<option><flag limit='disable'/></option>", "range='0 1'"));
  EXPECT_FALSE(isLimited("<option><flag constraint='disable'/></option>", "range='0 1'"));
}

TEST(MjcfJoint, FlagsSwitchForcesOff) {
  const std::string joint = onWorld("<joint name='h' stiffness='1' damping='2' frictionloss='3'/>");
  const auto of = [&](const std::string& flag) {
    const Model model = read("<option><flag " + flag + "='disable'/></option>" + joint);
    return model.world.hingeJoint(jointOf(model, "h").id);
  };
  EXPECT_EQ(of("spring").spring.stiffness, 0);
  EXPECT_EQ(of("spring").spring.damping, 2);
  EXPECT_EQ(of("damper").spring.damping, 0);
  EXPECT_EQ(of("passive").spring.stiffness, 0);
  EXPECT_EQ(of("passive").spring.damping, 0);
  EXPECT_EQ(of("frictionloss").friction, 0);
}

TEST(MjcfJoint, ATwistFarFromItsReferenceCountsFromTheStart) {
  const Model model = read(onWorld("<joint name='h' range='-20 20' stiffness='1' springref='9'/>") +
                           "<keyframe><key qpos='10'/></keyframe>");
  EXPECT_NEAR(coordinate(model, "h"), 10, 1e-5);
  const HingeJoint hinge = model.world.hingeJoint(jointOf(model, "h").id);
  EXPECT_NEAR(hinge.limit.upper, 10, 1e-5);
  EXPECT_NEAR(hinge.spring.position, -1, 1e-5);
}

TEST(MjcfJoint, ABallIsABallJointOrOneWithACone) {
  const Model plain = read(onWorld("<joint type='ball'/>"));
  EXPECT_EQ(plain.world.type(plain.world.joints()[0]), JointType::Ball);
  const Model model = read(onWorld("<joint type='ball' range='0 .7' stiffness='5' damping='2' armature='.3'/>"));
  const D6Joint joint = model.world.d6Joint(model.world.joints()[0]);
  EXPECT_FLOAT_EQ(joint.cone.y, 0.7f);
  EXPECT_FLOAT_EQ(joint.cone.z, 0.7f);
  EXPECT_FLOAT_EQ(joint.axes[3].limit.upper, 0.7f);
  EXPECT_FLOAT_EQ(joint.slerp.stiffness, 5);
  EXPECT_FLOAT_EQ(joint.slerp.damping, 2);
  EXPECT_FLOAT_EQ(joint.axes[4].armature, 0.3f);
  EXPECT_TRUE(model.joints.empty());
  EXPECT_TRUE(hasNote(model, "the range of a ball joint bounds its swing and its twist"));
}

TEST(MjcfJoint, SlidesAndAHingeAreOneJoint) {
  const Model model = read(onWorld("<joint name='x' type='slide' axis='1 0 0'/><joint name='z' type='slide'/>"
                                   "<joint name='t' axis='0 1 0' pos='.1 0 .2'/>") +
                           "<keyframe><key qpos='1 2 .5' qvel='3 4 5'/></keyframe>");
  EXPECT_EQ(model.world.jointCount(), 1u);
  EXPECT_EQ(model.world.bodyCount(), 1u);
  const double expected[] = {1, 2, 0.5}, speeds[] = {3, 4, 5};
  const char* names[] = {"x", "z", "t"};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(coordinate(model, names[i]), expected[i], 1e-6) << names[i];
    EXPECT_NEAR(speed(model, names[i]), speeds[i], 1e-5) << names[i];
  }
  expectVector(model.world.pose(bodyOf(model, "a")).position,
               {1.1 - 0.1 * std::cos(0.5) - 0.2 * std::sin(0.5), 0, 2.2 + 0.1 * std::sin(0.5) - 0.2 * std::cos(0.5)});
}

TEST(MjcfJoint, BetweenHingesStandsALightBody) {
  const std::string joints = "<joint name='x' axis='1 0 0'/><joint name='y' axis='0 1 0'/><joint name='z'/>";
  const Model alone = read(onWorld("<joint/>"));
  const Model model = read(onWorld(joints) + "<keyframe><key qpos='.3 -.4 .5' qvel='1 2 3'/></keyframe>");
  ASSERT_EQ(model.bodies.size(), 3u);
  EXPECT_EQ(model.bodies[0].name, "a/x");
  EXPECT_EQ(model.bodies[1].name, "a/y");
  EXPECT_EQ(model.bodies[2].name, "a");
  double mass = 0;
  for (const NamedBody& body : model.bodies) mass += model.world.mass(body.id);
  EXPECT_NEAR(mass, alone.world.mass(alone.bodies[0].id), 1e-4);
  const double expected[] = {0.3, -0.4, 0.5}, speeds[] = {1, 2, 3};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(coordinate(model, model.joints[i].name), expected[i], 1e-6);
    EXPECT_NEAR(speed(model, model.joints[i].name), speeds[i], 1e-5);
    EXPECT_LT(model.world.gap(model.joints[i].id), 1e-6);
  }
}

TEST(MjcfJoint, TwoHingesSquareToEachOtherAreOneJointSeenFromEitherSide) {
  for (const char* ranges : {"range='-2 2'|", "|range='-2 2'"}) {
    const std::string both = ranges, first = both.substr(0, both.find('|')), second = both.substr(both.find('|') + 1);
    const Model model = read(onWorld("<joint name='p' axis='0 1 0' stiffness='2' springref='.5' " + first +
                                     "/><joint name='q' axis='1 0 0' " + second + "/>") +
                             "<keyframe><key qpos='.7 2.5' qvel='1 -2'/></keyframe>");
    EXPECT_EQ(model.world.jointCount(), 1u);
    EXPECT_NEAR(coordinate(model, "p"), 0.7, 1e-5);
    // Where the limits are q's, its start is beyond them and it may not be shifted.
    EXPECT_NEAR(coordinate(model, "q"), 2.5, 1e-5);
    EXPECT_NEAR(speed(model, "p"), 1, 1e-4);
    EXPECT_NEAR(speed(model, "q"), -2, 1e-4);
    const NamedJoint& p = jointOf(model, "p");
    const JointSpring spring = model.world.d6Joint(p.id).axes[static_cast<size_t>(p.axis)].spring;
    EXPECT_NEAR(p.sign * static_cast<double>(spring.position) + p.offset, 0.5, 1e-6);
  }
}

TEST(MjcfJoint, UnnamedJointsAreNumbered) {
  const Model model = read(onWorld("<joint type='slide'/><joint/>"));
  EXPECT_EQ(model.joints[0].name, "joint_1");
  EXPECT_EQ(model.joints[1].name, "joint_2");
}

// Parent and child of a joint do not collide; a child and what stands still do.
TEST(MjcfJoint, WhoCollides) {
  const auto touching = [](const std::string& joints, const char* flag) {
    Model model = read(std::string(flag) +
                       "<worldbody><geom size='.3'/><body name='a'><freejoint/><geom size='.3'/>"
                       "<body name='b'>" +
                       joints + "<geom size='.3'/></body></body></worldbody>");
    model.world.step(1e-4f);
    std::set<std::pair<uint32_t, uint32_t>> pairs;
    for (const Contact& c : model.world.contacts()) pairs.emplace(c.bodyA.index, c.bodyB.index);
    return pairs.size();
  };
  const char* all = "<option><flag filterparent='disable'/></option>";
  for (const char* joints : {"<joint/>", "<joint/><joint axis='1 0 0'/>"}) {
    EXPECT_EQ(touching(joints, ""), 2u) << joints;
    EXPECT_EQ(touching(joints, all), 3u) << joints;
  }
}

TEST(MjcfJoint, WhatStandsStillHasNoCoordinates) {
  const Model model = read(
      "<worldbody><body><joint name='h'/><replicate/></body></worldbody><actuator><motor joint='h'/></actuator>"
      "<tendon><fixed range='0 1'><joint joint='h' coef='1'/></fixed></tendon><equality><joint "
      "joint1='h'/></equality>");
  EXPECT_TRUE(model.joints.empty());
  EXPECT_TRUE(model.actuators.empty());
  EXPECT_EQ(model.world.jointCount(), 0u);
  EXPECT_TRUE(hasNote(model, "joint \"h\": left out: its body stands still"));
  EXPECT_TRUE(hasNote(model, "left out: its joint stands still"));
  EXPECT_TRUE(hasNote(model, "left out: nothing in it moves"));
}

// Two hinges, a then b below it.
std::string arm(const std::string& rest) {
  return "<worldbody><body><joint name='a' ref='.1' range='-1 2' axis='0 1 0'/><geom size='.1' pos='.3 0 0'/>"
         "<site name='p' pos='.5 0 0'/><body pos='.6 0 0'><joint name='b' axis='0 1 0'/><geom size='.1' pos='.3 0 0'/>"
         "<site name='q' pos='.5 0 0'/><body><joint name='c' type='ball'/><geom size='.1'/></body></body></body>"
         "<site name='o' pos='0 0 2'/></worldbody>" +
         rest;
}

TEST(MjcfActuator, KindsBecomeGainsAndBiases) {
  const Model model =
      read(arm("<actuator><motor name='m' joint='a' gear='3' ctrlrange='-2 2' forcerange='-5 5'/>"
               "<position name='p' joint='a' kp='7' kv='2'/><velocity name='v' jointinparent='b' kv='4'/>"
               "<general name='g' joint='b' gainprm='6' biastype='affine' biasprm='1 -2 -3'/>"
               "<position name='i' joint='a' inheritrange='1'/></actuator>"));
  ASSERT_EQ(model.actuators.size(), 5u);
  const auto expectLaw = [&](size_t i, double gain, double b0, double b1, double b2) {
    EXPECT_EQ(model.actuators[i].gain, gain) << i;
    EXPECT_EQ(model.actuators[i].bias[0], b0) << i;
    EXPECT_EQ(model.actuators[i].bias[1], b1) << i;
    EXPECT_EQ(model.actuators[i].bias[2], b2) << i;
  };
  expectLaw(0, 1, 0, 0, 0);
  expectLaw(1, 7, 0, -7, -2);
  expectLaw(2, 4, 0, 0, -4);
  expectLaw(3, 6, 1, -2, -3);
  EXPECT_EQ(model.actuators[0].gear, 3);
  EXPECT_EQ(model.actuators[0].maxForce, 5);
  EXPECT_EQ((*model.actuators[0].controlRange)[0], -2);
  EXPECT_FALSE(model.actuators[1].controlRange);
  EXPECT_EQ((*model.actuators[4].controlRange)[0], -1);
  EXPECT_EQ((*model.actuators[4].controlRange)[1], 2);
  EXPECT_EQ(model.actuators[0].offset, jointOf(model, "a").offset);
}

TEST(MjcfActuator, ClassesShareDefaultsAcrossKinds) {
  const Model model = read(
      "<default><position kp='30' ctrlrange='-.1 .1'/><default class='g'><general gear='5' "
      "gainprm='9'/></default></default>" +
      arm("<actuator><position joint='a'/><motor joint='a'/><general joint='b' class='g' "
          "biastype='none'/></actuator>"));
  EXPECT_EQ(model.actuators[0].gain, 30);
  EXPECT_EQ(model.actuators[0].bias[1], -30);
  EXPECT_EQ(model.actuators[1].gain, 1);
  EXPECT_EQ((*model.actuators[1].controlRange)[1], 0.1);
  EXPECT_EQ(model.actuators[2].gain, 9);
  EXPECT_EQ(model.actuators[2].gear, 5);
  EXPECT_EQ(model.actuators[2].name, "actuator_3");
}

TEST(MjcfActuator, WhatCannotBeIsNoted) {
  const Model model = read(arm(
      "<actuator><muscle joint='a'/><cylinder joint='a'/><damper joint='a' kv='1' ctrlrange='0 1'/>"
      "<intvelocity joint='a'/><motor joint='c'/><motor site='p'/><motor cranksite='p' slidersite='q' cranklength='1'/>"
      "<general joint='a' dyntype='integrator'/><general joint='a' gaintype='affine' gainprm='1 2'/>"
      "<motor joint='a' gear='0'/><general joint='a' biastype='affine' biasprm='0 1 2'/>"
      "<motor joint='a' forcerange='-1 4'/><general joint='a' dyntype='filter'/></actuator>"));
  for (const char* note :
       {"muscle actuators are not supported", "cylinder actuators are not", "damper actuators are not",
        "intvelocity actuators are not", "moves a ball or free joint", "moves a site", "moves a slider-crank",
        "dyntype integrator is not", "gaintype affine is not", "its gear is 0", "a bias that grows with length",
        "a bias that grows with speed", "forcerange is not symmetric: the larger", "the filter of its control"}) {
    EXPECT_TRUE(hasNote(model, note)) << note;
  }
  ASSERT_EQ(model.actuators.size(), 3u);
  EXPECT_EQ(model.actuators[0].bias[1], 0);
  EXPECT_EQ(model.actuators[1].maxForce, 4);
  EXPECT_TRUE(
      hasNote(read("<option><flag actuation='disable'/></option>" + arm("<actuator><motor joint='a'/></actuator>")),
              "actuation is disabled"));
}

TEST(MjcfActuator, AJointBoundsItsActuators) {
  const Model model = read(
      "<worldbody><body><joint name='a' actuatorfrcrange='-6 6'/><geom size='.1'/></body>"
      "</worldbody><actuator><motor joint='a' gear='2'/></actuator>");
  EXPECT_EQ(model.actuators[0].maxForce, 3);
}

TEST(MjcfActuator, ControlsAreTheKeyframesOrHoldIt) {
  const std::string model =
      arm("<actuator><muscle joint='a'/><position name='p' joint='a' kp='50' gear='2'/><motor joint='b'/></actuator>");
  const Model given = read(model + "<keyframe><key qpos='.4 .5 1 0 0 0' ctrl='9 .3 .2'/></keyframe>");
  EXPECT_EQ(given.actuators[0].control, 0.3);
  EXPECT_EQ(given.actuators[1].control, 0.2);
  const Model held = read(model + "<keyframe><key qpos='.4 .5 1 0 0 0'/></keyframe>");
  EXPECT_NEAR(held.actuators[0].control, 0.8, 1e-12);
  EXPECT_EQ(held.actuators[1].control, 0);
  EXPECT_TRUE(hasNote(held, "gives no ctrl: position actuators hold"));
  const JointDrive drive = held.world.hingeJoint(held.actuators[0].joint).drive;
  EXPECT_FLOAT_EQ(drive.stiffness, 200);
  EXPECT_NEAR(drive.position, 0.4 - 0.1, 1e-6);
  EXPECT_EQ(read(model).actuators[0].control, 0);
}

TEST(MjcfTendon, AFixedTendonIsACouplingWhereSomethingNeedsIt) {
  const std::string parts = "<joint joint='a' coef='2'/><joint joint='b' coef='-1'/></fixed></tendon>";
  EXPECT_EQ(read(arm("<tendon><fixed>" + parts)).world.jointCount(), 3u);
  const Model model =
      read(arm("<tendon><fixed name='t' range='-1 3' stiffness='4' springlength='.7' damping='5' "
               "frictionloss='6' armature='.5'>" +
               parts + "<actuator><motor name='m' tendon='t'/></actuator>"));
  ASSERT_EQ(model.world.jointCount(), 4u);
  const Coupling coupling = model.world.coupling(model.actuators[0].joint);
  ASSERT_EQ(coupling.terms.size(), 2u);
  EXPECT_EQ(coupling.terms[0].factor, 2);
  EXPECT_EQ(coupling.terms[1].factor, -1);
  // Ours is 0 at the reference, where the file's is 2 * 0.1.
  EXPECT_NEAR(model.actuators[0].offset, 0.2, 1e-12);
  EXPECT_FLOAT_EQ(coupling.axis.limit.lower, -1.2f);
  EXPECT_FLOAT_EQ(coupling.axis.limit.upper, 2.8f);
  EXPECT_FLOAT_EQ(coupling.axis.spring.stiffness, 4);
  EXPECT_FLOAT_EQ(coupling.axis.spring.damping, 5);
  EXPECT_FLOAT_EQ(coupling.axis.spring.position, 0.5f);
  EXPECT_FLOAT_EQ(coupling.axis.friction, 6);
  EXPECT_FLOAT_EQ(coupling.axis.armature, 0.5f);
}

TEST(MjcfTendon, ASlackSpringIsASoftStop) {
  const Model model =
      read(arm("<tendon><fixed stiffness='4' springlength='.3 .7'><joint joint='b' coef='1'/></fixed></tendon>"));
  const Coupling coupling = model.world.coupling(model.world.joints().back());
  EXPECT_FLOAT_EQ(coupling.axis.limit.lower, 0.3f);
  EXPECT_FLOAT_EQ(coupling.axis.limit.upper, 0.7f);
  EXPECT_FLOAT_EQ(coupling.axis.limit.stiffness, 4);
}

TEST(MjcfTendon, TwoSitesAreARope) {
  const std::string sites = "<site site='o'/><site site='q'/></spatial></tendon>";
  const Model rope = read(arm("<tendon><spatial range='.5 3'>" + sites));
  const DistanceJoint joint = rope.world.distanceJoint(rope.world.joints().back());
  EXPECT_FLOAT_EQ(joint.min, 0.5f);
  EXPECT_FLOAT_EQ(joint.max, 3);
  EXPECT_EQ(joint.stiffness, 0);
  const Model spring = read(arm("<tendon><spatial stiffness='9' damping='2'>" + sites));
  const DistanceJoint soft = spring.world.distanceJoint(spring.world.joints().back());
  EXPECT_NEAR(soft.min, std::hypot(1.1, 2), 1e-6);
  EXPECT_EQ(soft.min, soft.max);
  EXPECT_FLOAT_EQ(soft.stiffness, 9);
  EXPECT_FLOAT_EQ(soft.damping, 2);
  EXPECT_TRUE(hasNote(read(arm("<tendon><spatial name='w' range='0 1'><site site='o'/><site site='p'/>" + sites)),
                      "spatial tendon w is left out"));
}

double restOf(const Model& model) { return *model.world.coupling(model.world.joints().back()).rest; }

TEST(MjcfEquality, JointsAreCoupledByAPolynomial) {
  const Model model = read(arm("<equality><joint joint1='b' joint2='a' polycoef='.1 2 3 4 5'/></equality>"));
  const Coupling coupling = model.world.coupling(model.world.joints().back());
  ASSERT_EQ(coupling.terms.size(), 2u);
  EXPECT_EQ(coupling.terms[0].joint, jointOf(model, "b").id);
  EXPECT_EQ(coupling.terms[0].factor, 1);
  EXPECT_EQ(coupling.terms[1].factor, -2);
  EXPECT_EQ(coupling.terms[1].square, -3);
  EXPECT_EQ(coupling.terms[1].cube, -4);
  EXPECT_EQ(coupling.terms[1].fourth, -5);
  EXPECT_NEAR(restOf(model), 0.1, 1e-12);
  EXPECT_NEAR(restOf(read(arm("<equality><joint joint1='a' polycoef='.3'/></equality>"))), 0.3, 1e-12);
}

// A joint that counts from its start has another polynomial: with u = o + 4 of the file's, 1 + 2u + 3u^2 + u^3.
TEST(MjcfEquality, AShiftedCoordinateShiftsThePolynomial) {
  const Model model = read(
      "<worldbody><body><joint name='a'/><geom size='.1'/></body><body><joint name='b'/>"
      "<geom size='.1'/></body></worldbody><equality><joint joint1='a' joint2='b' "
      "polycoef='1 2 3 1 0'/></equality><keyframe><key qpos='0 4'/></keyframe>");
  const Coupling coupling = model.world.coupling(model.world.joints().back());
  EXPECT_FLOAT_EQ(coupling.terms[1].factor, -(2 + 24 + 48));
  EXPECT_FLOAT_EQ(coupling.terms[1].square, -(3 + 12));
  EXPECT_FLOAT_EQ(coupling.terms[1].cube, -1);
  EXPECT_EQ(coupling.terms[1].fourth, 0);
  EXPECT_NEAR(*coupling.rest, 1 + 8 + 48 + 64, 1e-9);
}

TEST(MjcfEquality, TendonsAreCoupled) {
  const std::string tendons =
      "<tendon><fixed name='s'><joint joint='a' coef='2'/></fixed><fixed name='t'><joint joint='a' coef='1'/>"
      "<joint joint='b' coef='3'/></fixed></tendon>";
  const Model model =
      read(arm(tendons + "<equality><tendon tendon1='s' tendon2='t' polycoef='.5 -1 0 0 0'/></equality>"));
  const Coupling coupling = model.world.coupling(model.world.joints().back());
  ASSERT_EQ(coupling.terms.size(), 2u);
  EXPECT_EQ(coupling.terms[0].factor, 3);
  EXPECT_EQ(coupling.terms[1].factor, 3);
  EXPECT_NEAR(*coupling.rest, 0.5, 1e-12);
  EXPECT_TRUE(
      hasNote(read(arm(tendons + "<equality><tendon tendon1='s' tendon2='t' polycoef='0 0 1 0 0'/></equality>")),
              "a curved relation"));
}

TEST(MjcfEquality, InactiveOnesAreMadeAndOff) {
  const Model model =
      read(arm("<equality><joint active='false' joint1='b' joint2='a'/><connect site1='p' site2='o' "
               "active='false'/><weld site1='q' site2='o'/></equality>"));
  const std::vector<JointId> joints = model.world.joints();
  ASSERT_EQ(joints.size(), 6u);
  EXPECT_FALSE(model.world.isEnabled(joints[3]));
  EXPECT_FALSE(model.world.isEnabled(joints[4]));
  EXPECT_TRUE(model.world.isEnabled(joints[5]));
  EXPECT_EQ(model.world.type(joints[4]), JointType::Ball);
  EXPECT_EQ(model.world.type(joints[5]), JointType::Fixed);
  EXPECT_NEAR(model.world.gap(joints[5]), std::hypot(1.1, 2), 1e-5);
}

TEST(MjcfEquality, ADistanceOfSpheres) {
  const Model model = read(
      "<worldbody><geom name='a' size='.2'/><geom name='c' type='box' size='1 1 1'/><body pos='0 0 3'><freejoint/>"
      "<geom name='b' size='.3'/></body></worldbody><equality><distance geom1='a' geom2='b' distance='1'/>"
      "<distance geom1='c' geom2='b'/></equality>");
  const DistanceJoint joint = model.world.distanceJoint(model.world.joints().at(0));
  EXPECT_FLOAT_EQ(joint.max, 1.5f);
  EXPECT_EQ(joint.min, joint.max);
  EXPECT_TRUE(hasNote(model, "only kept between spheres"));
}

}  // namespace
}  // namespace avbd
