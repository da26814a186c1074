// Joints of URDF files in a world: kinds, frames, bounds, mimics, what holds them, actuators, what collides.
#include "io/urdf_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/urdf.h"
#include "io/urdf_math.h"

namespace avbd {
namespace {

using std::numbers::pi;

constexpr const char* kInertial =
    "<inertial><mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial>";

std::string link(const std::string& name, const std::string& inside = kInertial) {
  return "<link name='" + name + "'>" + inside + "</link>";
}
std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& inside = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child + "'/>" +
         inside + "</joint>";
}
Model read(const std::string& inside, const UrdfOptions& options = {}) {
  return readUrdfText("<robot name='r'>" + inside + "</robot>", "t.urdf", options);
}
// A base and one link that this joint moves.
Model readOne(const std::string& type, const std::string& inside, const UrdfOptions& options = {}) {
  return read(link("base") + link("arm") + joint("j", type, "base", "arm", inside), options);
}
std::string notesOf(const Model& model) {
  std::string out;
  for (const std::string& note : model.notes) out += note + "\n";
  return out;
}
double positionOf(const Model& model, size_t index) {
  const NamedJoint& joint = model.joints.at(index);
  return joint.sign * model.world.coordinate(joint.id, joint.axis).position + joint.offset;
}
void run(Model& model, double seconds) {
  for (int i = 0; i < seconds * 60; ++i) model.world.step(1.0f / 60);
}
Pose turnedBy(const mjcf::Quatd& q, Vec3d position = {}) {
  return {position,
          {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)}};
}

const std::string kOrigin = "<origin xyz='0.3 -0.2 0.5' rpy='0.4 -0.7 1.1'/>";
const Pose kOriginPose = turnedBy(urdf::fromRollPitchYaw({0.4, -0.7, 1.1}), {0.3, -0.2, 0.5});

// The child is put where the file's kinematics has it for a position, and the joint must read that position.
TEST(UrdfJoints, HingesReadTheAngleAboutTheirAxis) {
  for (const char* type : {"revolute", "continuous"}) {
    for (const Vec3d axis : {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{1, 2, -2}}) {
      const std::string xyz = std::to_string(axis.x) + " " + std::to_string(axis.y) + " " + std::to_string(axis.z);
      Model model = readOne(type, kOrigin + "<axis xyz='" + xyz + "'/><limit lower='-3' upper='2' effort='9'/>");
      ASSERT_EQ(model.joints.size(), 1u);
      EXPECT_EQ(model.joints[0].name, "j");
      EXPECT_EQ(model.world.type(model.joints[0].id), JointType::Hinge);
      EXPECT_NEAR(positionOf(model, 0), 0, 1e-6);
      for (const double angle : {0.3, -2.5}) {
        model.world.setPose(model.bodies[1].id, kOriginPose * turnedBy(mjcf::turnAbout(axis, angle)));
        EXPECT_NEAR(positionOf(model, 0), angle, 1e-5) << type << xyz;
        EXPECT_NEAR(model.world.gap(model.joints[0].id), 0, 1e-6);
        EXPECT_NEAR(model.world.angleError(model.joints[0].id), 0, 1e-5);
      }
    }
  }
}

TEST(UrdfJoints, SlidersReadTheWayAlongTheirAxis) {
  Model model = readOne("prismatic", kOrigin + "<axis xyz='1 2 -2'/><limit lower='-1' upper='1' effort='9'/>");
  EXPECT_EQ(model.world.type(model.joints.at(0).id), JointType::Slider);
  const Vec3d unit{1 / 3.0, 2 / 3.0, -2 / 3.0};
  model.world.setPose(model.bodies[1].id, kOriginPose * Pose{unit * 0.4, {}});
  EXPECT_NEAR(positionOf(model, 0), 0.4, 1e-6);
  EXPECT_NEAR(model.world.gap(model.joints[0].id), 0, 1e-6);
}

TEST(UrdfJoints, PlanarOnesReadTwoWaysAndATurn) {
  Model model = readOne("planar", kOrigin + "<axis xyz='0 0 1'/>");
  ASSERT_EQ(model.joints.size(), 3u);
  EXPECT_EQ(model.joints[0].name, "j/x");
  EXPECT_EQ(model.joints[1].name, "j/y");
  EXPECT_EQ(model.joints[2].name, "j/theta");
  EXPECT_EQ(model.world.type(model.joints[0].id), JointType::D6);
  model.world.setPose(model.bodies[1].id, kOriginPose * turnedBy(mjcf::turnAbout({0, 0, 1}, 0.6), {0.2, -0.3, 0}));
  EXPECT_NEAR(positionOf(model, 0), 0.2, 1e-6);
  EXPECT_NEAR(positionOf(model, 1), -0.3, 1e-6);
  EXPECT_NEAR(positionOf(model, 2), 0.6, 1e-5);
  EXPECT_NEAR(model.world.gap(model.joints[0].id), 0, 1e-6);
}

TEST(UrdfJoints, FixedOnesWeldAndFloatingOnesJoinNothing) {
  EXPECT_EQ(readOne("fixed", "").bodies.size(), 1u);
  const Model model = readOne("floating", "");
  EXPECT_EQ(model.bodies.size(), 2u);
  EXPECT_EQ(model.world.jointCount(), 0u);
}

TEST(UrdfJoints, BoundsDampingFrictionVelocityAndEffortArrive) {
  const Model model = readOne("revolute",
                              "<axis xyz='0 0 1'/><limit lower='-1' upper='2' effort='30' velocity='4'/>"
                              "<dynamics damping='0.5' friction='0.2'/>");
  const HingeJoint hinge = model.world.hingeJoint(model.joints.at(0).id);
  EXPECT_EQ(hinge.limit.lower, -1);
  EXPECT_EQ(hinge.limit.upper, 2);
  EXPECT_EQ(hinge.limit.stiffness, 0);
  EXPECT_FLOAT_EQ(hinge.spring.damping, 0.5f);
  EXPECT_EQ(hinge.spring.stiffness, 0);
  EXPECT_FLOAT_EQ(hinge.friction, 0.2f);
  EXPECT_EQ(hinge.maxVelocity, 4);
  EXPECT_EQ(hinge.drive.maxForce, 30);
  EXPECT_FALSE(hinge.collideConnected);
  EXPECT_EQ(hinge.bodyA, model.bodies[0].id);
  EXPECT_EQ(hinge.bodyB, model.bodies[1].id);
}

TEST(UrdfJoints, ZeroEffortAndVelocityAreNoBounds) {
  const Model model = readOne("revolute", "<axis xyz='0 0 1'/><limit lower='-1' upper='2' effort='0' velocity='0'/>");
  const HingeJoint hinge = model.world.hingeJoint(model.joints.at(0).id);
  EXPECT_TRUE(std::isinf(hinge.maxVelocity));
  EXPECT_TRUE(std::isinf(hinge.drive.maxForce));
  EXPECT_NE(notesOf(model).find("effort of 0: taken as no bound"), std::string::npos) << notesOf(model);
  EXPECT_NE(notesOf(model).find("velocity of 0: taken as no bound"), std::string::npos) << notesOf(model);
}

TEST(UrdfJoints, StartAtTheBoundNearestToZero) {
  const auto start = [](const std::string& type, const std::string& bounds) {
    return positionOf(readOne(type, "<axis xyz='0 1 0'/><limit " + bounds + " effort='1' velocity='1'/>"), 0);
  };
  EXPECT_NEAR(start("revolute", "lower='0.2' upper='1'"), 0.2, 1e-6);
  EXPECT_NEAR(start("revolute", "lower='-1' upper='-0.3'"), -0.3, 1e-6);
  EXPECT_NEAR(start("prismatic", "lower='0.1' upper='0.5'"), 0.1, 1e-6);
  EXPECT_NEAR(start("revolute", "lower='-1' upper='1'"), 0, 1e-6);
  // Beyond half a turn: our coordinate is whole turns less, and its bounds with it.
  const Model far = readOne("revolute", "<axis xyz='0 1 0'/><limit lower='4' upper='5' effort='1' velocity='1'/>");
  EXPECT_NEAR(positionOf(far, 0), 4, 1e-5);
  EXPECT_NEAR(far.joints[0].offset, 2 * pi, 1e-12);
  EXPECT_NEAR(far.world.hingeJoint(far.joints[0].id).limit.upper, 5 - 2 * pi, 1e-5);
}

// As wheels are written that may turn for ever.
TEST(UrdfJoints, BoundsTooFarToBoundAreNone) {
  const Model model = readOne("revolute", "<axis xyz='0 1 0'/><limit lower='-1e9' upper='1e9' effort='1'/>");
  EXPECT_TRUE(std::isinf(model.world.hingeJoint(model.joints.at(0).id).limit.upper));
}

// A rod of 1 kg whose centre is half a metre from its horizontal hinge.
std::string rod(const std::string& limit, const std::string& more = "") {
  return link("base") +
         link("arm",
              "<inertial><origin xyz='0.5 0 0'/><mass value='1'/><inertia ixx='0.001' ixy='0' ixz='0' iyy='0.08' "
              "iyz='0' izz='0.08'/></inertial>") +
         joint("j", "revolute", "base", "arm", "<axis xyz='0 1 0'/><limit " + limit + "/>" + more);
}

TEST(UrdfJoints, AreHeldByDrivesOfOneFrequency) {
  Model model = read(rod("lower='-2' upper='2' effort='100' velocity='10'"));
  const double omega = 2 * pi * urdf::kHoldFrequency, inertia = 0.08 + 0.25;
  const JointDrive drive = model.world.hingeJoint(model.joints.at(0).id).drive;
  EXPECT_NEAR(drive.stiffness, omega * omega * inertia, 1e-5 * omega * omega);
  EXPECT_NEAR(drive.damping, 2 * omega * inertia, 1e-5 * omega);
  run(model, 2);
  const double sag = 9.81 * 0.5 / (omega * omega * inertia);
  EXPECT_NEAR(positionOf(model, 0), sag, 0.05 * sag);
}

TEST(UrdfJoints, FallWhereTheEffortIsTooSmallOrTheyAreLimp) {
  Model weak = read(rod("lower='-2' upper='1.2' effort='1' velocity='100'"));
  Model limp = read(rod("lower='-2' upper='1.2' effort='100' velocity='100'"), {.limp = true});
  for (Model* model : {&weak, &limp}) {
    run(*model, 3);
    EXPECT_NEAR(positionOf(*model, 0), 1.2, 0.01) << "at its bound";
  }
}

// Whichever side is lighter may stand on the ground.
TEST(UrdfJoints, HoldCountsTheHeavierSideWhereBothMove) {
  std::string heavy = kInertial;
  heavy.replace(heavy.find("value='1'"), 9, "value='3'");
  const std::string type = "<axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='9'/>";
  const double omega = 2 * pi * urdf::kHoldFrequency;
  for (const char* parent : {"base", "arm"}) {
    const std::string child = parent == std::string("arm") ? "base" : "arm";
    const Model model =
        read(link("base", heavy) + link("arm") + joint("j", "prismatic", parent, child, type), {.floating = true});
    EXPECT_NEAR(model.world.sliderJoint(model.joints.at(0).id).drive.stiffness, omega * omega * 3, 1) << parent;
  }
}

const std::string kLimit = "<axis xyz='0 0 1'/><limit lower='-2' upper='2' effort='50' velocity='9'/>";

TEST(UrdfMimic, ChainsFollowTheirEnd) {
  // c = 0.5 b - 0.05 and b = -2 a + 0.1, so c = -a.
  const std::string xml =
      link("base") + link("a") + link("b") + link("c") + joint("ja", "revolute", "base", "a", kLimit) +
      joint("jb", "revolute", "a", "b", kLimit + "<mimic joint='ja' multiplier='-2' offset='0.1'/>") +
      joint("jc", "prismatic", "b", "c", kLimit + "<mimic joint='jb' multiplier='0.5' offset='-0.05'/>");
  Model model = read(xml);
  ASSERT_EQ(model.joints.size(), 3u);
  EXPECT_EQ(model.world.jointCount(), 5u) << "three joints and two couplings";
  EXPECT_NEAR(positionOf(model, 1), 0.1, 1e-6) << "starts where its mimic wants it";
  EXPECT_NEAR(positionOf(model, 2), 0, 1e-6);
  JointDrive drive = model.world.hingeJoint(model.joints[0].id).drive;
  drive.position = 0.4f;
  model.world.setDrive(model.joints[0].id, drive);
  run(model, 1);
  const double a = positionOf(model, 0);
  EXPECT_NEAR(a, 0.4, 0.01);
  EXPECT_NEAR(positionOf(model, 1), -2 * a + 0.1, 1e-3);
  EXPECT_NEAR(positionOf(model, 2), -a, 1e-3);
}

TEST(UrdfMimic, WhatCannotBeMimickedIsNoted) {
  const auto notes = [](const std::string& a, const std::string& b, const std::string& typeOfA = "continuous") {
    const Model model =
        read(link("base") + link("a") + link("b") + joint("ja", typeOfA, "base", "a", "<axis xyz='0 0 1'/>" + a) +
             joint("jb", "continuous", "a", "b", "<axis xyz='0 0 1'/>" + b));
    return notesOf(model) + std::to_string(model.world.jointCount()) + " joints";
  };
  const auto expect = [](const std::string& got, const std::string& part, int joints) {
    EXPECT_NE(got.find(part), std::string::npos) << got;
    EXPECT_TRUE(got.ends_with(std::to_string(joints) + " joints")) << got;
  };
  expect(notes("", "<mimic joint='jb'/>"), "mimics itself", 2);
  expect(notes("<mimic joint='jb'/>", "<mimic joint='ja'/>"), "mimics itself, perhaps through others", 3);
  expect(notes("", "<mimic joint='nobody'/>"), "no joint is named \"nobody\"", 2);
  expect(notes("", "<mimic joint='ja'/>", "fixed"), "between a continuous and a fixed joint", 1);
  expect(notes("", "<mimic joint='ja' multiplier='0' offset='0.5'/>"), "welded at its offset", 1);
}

TEST(UrdfMimic, BoundsThatItsStartBreaksAreLeftOut) {
  const Model model = read(link("base") + link("a") + link("b") + joint("ja", "revolute", "base", "a", kLimit) +
                           joint("jb", "revolute", "base", "b", kLimit + "<mimic joint='ja' offset='2.5'/>"));
  EXPECT_NE(notesOf(model).find("outside of its bounds"), std::string::npos) << notesOf(model);
  EXPECT_TRUE(std::isinf(model.world.hingeJoint(model.joints.at(1).id).limit.upper));
  EXPECT_NEAR(positionOf(model, 1), 2.5, 1e-5);
}

const std::string kTwo = link("base") + link("a") + link("b") + joint("ja", "revolute", "base", "a", kLimit) +
                         joint("jb", "revolute", "a", "b", kLimit);

TEST(UrdfActuators, TransmissionsAreForcesAndTheRestTakesPositions) {
  const std::string transmission =
      "<transmission name='t'><type>x/SimpleTransmission</type><joint name='jb'/><actuator name='motor'>"
      "<mechanicalReduction>20</mechanicalReduction></actuator></transmission>";
  const Model model = read(kTwo + transmission);
  ASSERT_EQ(model.actuators.size(), 2u);
  const Actuator &motor = model.actuators[0], &servo = model.actuators[1];
  EXPECT_EQ(motor.name, "motor");
  EXPECT_EQ(motor.joint, model.joints[1].id);
  EXPECT_EQ(motor.gear, 20);
  EXPECT_EQ(motor.gain, 1);
  EXPECT_EQ(motor.bias[1], 0);
  EXPECT_EQ(motor.maxForce, 50 / 20.0);
  EXPECT_EQ(motor.control, 0);
  EXPECT_EQ(servo.name, "ja");
  EXPECT_EQ(servo.gain, -servo.bias[1]);
  EXPECT_GT(servo.gain, 0);
  EXPECT_LT(servo.bias[2], 0);
  EXPECT_EQ(servo.maxForce, 50);
  EXPECT_EQ((*servo.controlRange)[1], 2);
  // Held is also what a transmission drives.
  EXPECT_GT(model.world.hingeJoint(model.joints[1].id).drive.stiffness, 0);
}

TEST(UrdfActuators, OfALimpRobotAreForces) {
  const Model model = read(kTwo, {.limp = true});
  ASSERT_EQ(model.actuators.size(), 2u);
  for (const Actuator& actuator : model.actuators) {
    EXPECT_EQ(actuator.gain, 1);
    EXPECT_EQ(actuator.bias[1], 0);
    EXPECT_EQ(actuator.control, 0);
    EXPECT_EQ(actuator.maxForce, 50);
  }
  EXPECT_EQ(model.world.hingeJoint(model.joints[0].id).drive.stiffness, 0);
}

TEST(UrdfActuators, ReductionsStandInThreePlaces) {
  const auto gear = [](const std::string& inside) {
    const Model model = read(kTwo + "<transmission name='t' type='SimpleTransmission'>" + inside + "</transmission>");
    return model.actuators.at(0).gear;
  };
  EXPECT_EQ(gear("<actuator name='m'/><joint name='ja'/><mechanicalReduction>-3</mechanicalReduction>"), -3);
  EXPECT_EQ(gear("<joint name='ja'><mechanicalReduction>4</mechanicalReduction></joint><actuator name='m'/>"), 4);
  EXPECT_EQ(gear("<joint name='ja'/>"), 1);
}

TEST(UrdfActuators, TwoOfOneNameAreToldApart) {
  const std::string transmission = "<transmission name='t'><joint name='JOINT'/><actuator name='m'/></transmission>";
  std::string xml = kTwo;
  for (const char* name : {"ja", "jb"}) {
    xml += std::string(transmission).replace(transmission.find("JOINT"), 5, name);
  }
  const Model model = read(xml);
  EXPECT_EQ(model.actuators.at(0).name, "m");
  EXPECT_EQ(model.actuators.at(1).name, "m_");
}

TEST(UrdfJoints, AFrameBetweenTwoHingesGetsALittleMass) {
  const std::string xml = link("base") + link("cross", "") + link("hand") +
                          joint("jx", "continuous", "base", "cross", "<axis xyz='1 0 0'/>") +
                          joint("jy", "continuous", "cross", "hand", "<axis xyz='0 1 0'/>");
  Model model = read(xml);
  ASSERT_EQ(model.bodies.size(), 3u);
  EXPECT_FLOAT_EQ(model.world.mass(model.bodies[1].id), 1e-3f);
  EXPECT_NE(notesOf(model).find("no mass between joints"), std::string::npos) << notesOf(model);
  run(model, 1);
  EXPECT_LT(model.world.gap(model.joints[0].id), 1e-3);
  EXPECT_LT(model.world.gap(model.joints[1].id), 1e-3);
}

TEST(UrdfJoints, AFrameThatEndsTheTreeIsWelded) {
  const Model model =
      read(link("base") + link("tip", "") + joint("j", "continuous", "base", "tip", "<axis xyz='1 0 0'/>"));
  EXPECT_EQ(model.bodies.size(), 1u);
  EXPECT_TRUE(model.joints.empty());
  EXPECT_NE(notesOf(model).find("moves neither mass nor shape: welded"), std::string::npos) << notesOf(model);
}

std::string ball(const std::string& name, const std::string& radius) {
  return link(name,
              std::string(kInertial) + "<collision><geometry><sphere radius='" + radius + "'/></geometry></collision>");
}
// Three balls in a row of which the outer two overlap, or do not.
std::string row(const std::string& radius) {
  return ball("a", radius) + ball("b", "0.01") + ball("c", radius) +
         joint("j", "continuous", "a", "b", "<origin xyz='0 0.5 0'/><axis xyz='0 1 0'/>") +
         joint("k", "continuous", "b", "c", "<origin xyz='0 0.5 0'/><axis xyz='0 1 0'/>");
}

TEST(UrdfCollisions, WhatOverlapsAtTheStartNeverCollides) {
  const Model apart = read(row("0.3")), over = read(row("0.6"));
  EXPECT_EQ(apart.world.excludedPairs().size(), 2u) << "joined ones alone";
  EXPECT_EQ(over.world.excludedPairs().size(), 3u);
  EXPECT_NE(notesOf(over).find("\"a\" and \"c\": overlap at the start"), std::string::npos) << notesOf(over);
  Model free = read(row("0.6"), {.floating = true});
  run(free, 0.5);
  EXPECT_EQ(free.world.report().points, 0u);
}

TEST(UrdfCollisions, ButWhereItIsNotWantedNoLinksCollide) {
  for (const bool wanted : {true, false}) {
    const Model model = read(row("0.3"), {.selfCollision = wanted});
    EXPECT_EQ(model.world.filter(model.world.shapes(model.bodies[0].id).at(0)).group, wanted ? 0 : -1);
  }
}

struct Bad {
  std::string inside;  // of a revolute joint
  std::vector<std::string> parts;
};

TEST(UrdfJoints, RefuseWhatHasNoMeaning) {
  const std::string limit = "<limit lower='-1' upper='1' effort='1' velocity='1'/>";
  const Bad all[] = {
      {"<axis xyz='0 0 0'/>" + limit, {"axis: xyz = \"0 0 0\": must not be zero"}},
      {"<axis xyz='nan 0 0'/>" + limit, {"axis: xyz = \"nan 0 0\"", "finite"}},
      {"<limit lower='-1' upper='1' effort='nan'/>", {"limit: effort = \"nan\"", "finite"}},
      {"<limit lower='-1' upper='1' effort='-2'/>", {"limit: effort = \"-2\": must be finite and >= 0"}},
      {"<limit lower='-1' upper='1' velocity='inf'/>", {"limit: velocity = \"inf\"", "finite"}},
      {"<limit lower='1e7' upper='1e8'/>", {"limit: lower or upper = \"1e7\"", "at most 1e5 rad"}},
      {limit + "<dynamics damping='-1'/>", {"dynamics: damping = \"-1\": must be finite and >= 0"}},
      {limit + "<dynamics friction='x'/>", {"dynamics: friction = \"x\"", "number"}},
      {limit + "<mimic/>", {"mimic: joint is missing"}},
      {limit + "<mimic joint='k' multiplier='x'/>", {"mimic: multiplier = \"x\"", "number"}},
      {limit + "<mimic joint='k' offset='1e8'/>", {"mimic starts it beyond"}},
      {limit + "<mimic joint='k' offset='1e12'/>", {"must be at most 1e9"}},
  };
  for (const Bad& bad : all) {
    try {
      read(link("base") + link("a") + link("b") + joint("j", "revolute", "base", "a", bad.inside) +
           joint("k", "continuous", "a", "b"));
      ADD_FAILURE() << bad.inside;
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.rfind("t.urdf:1: joint \"j\"", 0), 0u) << what;
      for (const std::string& part : bad.parts) EXPECT_NE(what.find(part), std::string::npos) << what;
    }
  }
  try {
    read(kTwo +
         "<transmission name='t'><joint name='ja'/><actuator name='m'>"
         "<mechanicalReduction>0</mechanicalReduction></actuator></transmission>");
    ADD_FAILURE();
  } catch (const FileError& error) {
    EXPECT_NE(
        std::string(error.what()).find("mechanicalReduction: text = \"0\": must be a finite number that is not 0"),
        std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace avbd
