// Models from MJCF: what becomes a body, a joint, a filter, a note.
#include "io/mjcf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/mjcf_cases.h"

namespace avbd {
namespace {

Model read(const std::string& inside, const MjcfOptions& options = {}) {
  return readMjcfText("<mujoco>" + inside + "</mujoco>", "t.xml", options);
}

std::string messageOf(const std::string& inside, const MjcfOptions& options = {}) {
  try {
    read(inside, options);
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

void expectRefused(const std::string& inside, const std::string& part) {
  const std::string message = messageOf(inside);
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

void expectVector(Vec3d a, Vec3d b, double tolerance = 1e-6) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Mjcf, AnEmptyModelIsAnEmptyWorld) {
  const Model model = read("");
  EXPECT_EQ(model.world.bodyCount(), 0u);
  EXPECT_EQ(model.dt, 0.002);
  EXPECT_EQ(model.up, (Vec3{0, 0, 1}));
  EXPECT_EQ(model.name, "t");
  EXPECT_EQ(model.world.definition().gravity, (Vec3{0, 0, -9.81f}));
}

TEST(Mjcf, UpIsAgainstGravity) {
  EXPECT_EQ(read("<option gravity='0 -5 0'/>").up, (Vec3{0, 1, 0}));
  EXPECT_EQ(read("<option gravity='0 0 0'/>").up, (Vec3{0, 0, 1}));
  EXPECT_EQ(read("<option><flag gravity='disable'/></option>").world.definition().gravity, Vec3{});
}

TEST(Mjcf, SettingsOfTheWorldAreKept) {
  MjcfOptions options;
  options.world.iterations = 7;
  options.world.gravity = {1, 2, 3};
  EXPECT_EQ(read("", options).world.definition().iterations, 7);
  EXPECT_EQ(read("", options).world.definition().gravity, (Vec3{0, 0, -9.81f}));
}

TEST(Mjcf, NamesAndTypesInTheOrderOfTheFile) {
  const Model model = read(
      "<worldbody><geom type='plane' size='1 1 1'/><body name='b'><freejoint/><geom size='1'/></body>"
      "<body><freejoint/><geom size='1'/></body><body name='m' mocap='true'/><body name='body_2'><freejoint/><geom "
      "size='1'/></body>"
      "</worldbody>");
  ASSERT_EQ(model.bodies.size(), 5u);
  const char* names[] = {"world", "b", "body_2_", "m", "body_2"};
  const BodyType types[] = {BodyType::Static, BodyType::Dynamic, BodyType::Dynamic, BodyType::Kinematic,
                            BodyType::Dynamic};
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(model.bodies[i].name, names[i]);
    EXPECT_EQ(model.world.type(model.bodies[i].id), types[i]);
  }
}

TEST(Mjcf, APlaneIsSolidBelowItsZ) {
  const Model model = read("<worldbody><geom type='plane' size='0 0 1' pos='0 0 3' zaxis='1 0 1'/></worldbody>");
  const ShapeId plane = model.world.shapes(model.bodies[0].id)[0];
  EXPECT_TRUE(std::holds_alternative<HalfSpace>(model.world.geometry(plane)));
  const Vec3 normal = rotate(model.world.localPose(plane).rotation, Vec3{0, 1, 0});
  expectVector(toDouble(normal), {std::sqrt(0.5), 0, std::sqrt(0.5)});
  expectVector(model.world.localPose(plane).position, {0, 0, 3});
}

TEST(Mjcf, ACapsuleLiesAlongItsZ) {
  const Model model = read("<worldbody><geom type='capsule' size='.1' fromto='1 0 0 3 0 0'/></worldbody>");
  const ShapeId shape = model.world.shapes(model.bodies[0].id)[0];
  const Capsule capsule = std::get<Capsule>(model.world.geometry(shape));
  EXPECT_FLOAT_EQ(capsule.halfHeight, 1);
  EXPECT_FLOAT_EQ(capsule.radius, 0.1f);
  const Pose pose = model.world.localPose(shape);
  expectVector(pose.position, {2, 0, 0});
  EXPECT_NEAR(std::abs(rotate(pose.rotation, Vec3{0, 1, 0}).x), 1, 1e-6);
}

TEST(Mjcf, SurfacesAndFilters) {
  const Model model = read(
      "<worldbody><geom size='1' friction='.3 1 1' priority='2' contype='6' conaffinity='4294967295'/>"
      "<geom size='1' condim='1'/><geom size='1' friction='1 .2 .3' condim='4'/>"
      "<geom size='1' friction='1 .2 .3' condim='6'/><geom size='1' condim='6'/></worldbody>");
  const auto shapes = model.world.shapes(model.bodies[0].id);
  const Material material = model.world.material(shapes[0]);
  EXPECT_FLOAT_EQ(material.friction, 0.3f);
  EXPECT_EQ(material.frictionPriority, 2);
  EXPECT_EQ(material.frictionCombine, Combine::Maximum);
  EXPECT_EQ(material.restitution, 0);
  const Filter filter = model.world.filter(shapes[0]);
  EXPECT_EQ(filter.category, 6u);
  EXPECT_EQ(filter.mask, 0xffffffffu);
  EXPECT_TRUE(filter.anyMask);
  EXPECT_EQ(model.world.material(shapes[1]).friction, 0);
  const float torsional[] = {0, 0, 0.2f, 0.2f, 0.005f}, rolling[] = {0, 0, 0, 0.3f, 0.0001f};
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(model.world.material(shapes[i]).torsionalFriction, torsional[i]) << i;
    EXPECT_EQ(model.world.material(shapes[i]).rollingFriction, rolling[i]) << i;
  }
}

TEST(Mjcf, BodiesWithoutJointsArePartOfTheirParent) {
  const Model model = read(
      "<worldbody><body name='s' pos='1 0 0'><geom size='1' pos='1 0 0'/></body>"
      "<body name='a' pos='0 0 5'><freejoint/><geom size='.5' mass='1'/>"
      "<body name='b' pos='2 0 0'><geom size='.5' mass='3'/></body></body></worldbody>");
  ASSERT_EQ(model.bodies.size(), 2u);
  EXPECT_EQ(model.bodies[0].name, "world");
  expectVector(model.world.localPose(model.world.shapes(model.bodies[0].id)[0]).position, {2, 0, 0});
  const BodyId a = model.bodies[1].id;
  EXPECT_FLOAT_EQ(model.world.mass(a), 4);
  expectVector(toDouble(model.world.centerOfMass(a)), {1.5, 0, 0});
  EXPECT_NEAR(model.world.inertia(a).zz, 4 * 0.4 * 0.25 + 2.25 + 3 * 0.25, 1e-5);
  EXPECT_EQ(model.world.shapes(a).size(), 2u);
  EXPECT_TRUE(hasNote(model, "body \"b\": part of body a"));
  EXPECT_TRUE(hasNote(model, "body \"s\": part of body world"));
}

TEST(Mjcf, ABallJointHoldsTheSamePoint) {
  const Model model = read(
      "<worldbody><body name='a' pos='0 0 5' euler='0 0 90'><joint type='ball' pos='.5 0 0'/><geom size='.1'/>"
      "<body name='b' pos='1 0 0' euler='90 0 0'><joint type='ball' pos='-.5 .25 0'/><geom "
      "size='.1'/></body></body></worldbody>");
  ASSERT_EQ(model.world.jointCount(), 2u);
  for (const JointId joint : model.world.joints()) {
    EXPECT_EQ(model.world.type(joint), JointType::Ball);
    EXPECT_LT(model.world.gap(joint), 1e-6);
  }
}

TEST(Mjcf, AnOffsetBallJointHangsStillUnderItsAnchor) {
  Model model = read(
      "<worldbody><body name='a' pos='3 2 1'><joint type='ball' pos='0 0 .5'/><geom size='.1' pos='0 0 "
      "-.5'/></body></worldbody>");
  for (int i = 0; i < 60; ++i) model.world.step(1.0f / 60);
  expectVector(model.world.pose(model.bodies[0].id).position, {3, 2, 1}, 1e-3);
}

TEST(Mjcf, ConnectAndWeld) {
  const Model model = read(
      "<worldbody><body name='a' pos='0 0 5'><freejoint/><geom size='.1'/></body>"
      "<body name='b' pos='1 0 5' euler='0 0 90'><freejoint/><geom size='.1'/></body><body name='s'/></worldbody>"
      "<equality><connect body1='a' body2='b' anchor='.5 0 0'/><weld body1='a' body2='b'/><weld body1='b'/>"
      "<connect body1='b' body2='s' anchor='0 0 0'/><weld body1='s'/><weld body1='a' body2='b' relpose='2 0 0 1 0 0 "
      "0'/></equality>");
  ASSERT_EQ(model.world.jointCount(), 5u);
  const auto joints = model.world.joints();
  const JointType types[] = {JointType::Ball, JointType::Fixed, JointType::Fixed, JointType::Ball, JointType::Fixed};
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(model.world.type(joints[i]), types[i]);
    if (i == 4) break;
    EXPECT_LT(model.world.gap(joints[i]), 1e-6);
    EXPECT_LT(model.world.angleError(joints[i]), 1e-3);
  }
  EXPECT_NEAR(model.world.gap(joints[4]), 1, 1e-6);
  EXPECT_NEAR(model.world.angleError(joints[4]), 1.5707963, 1e-3);
  EXPECT_TRUE(hasNote(model, "weld: joins bodies that are one rigid body here"));
}

const char* kFalling =
    "<worldbody><body name='a'><freejoint/><geom size='.1' mass='1'/></body><body name='p' pos='0 0 3'>"
    "<joint type='ball'/><geom size='.1' mass='1' pos='1 0 0'/></body></worldbody>"
    "<keyframe><key name='up' qpos='0 0 9 1 0 0 0 1 0 0 1' qvel='1 2 3 0 0 4 0 0 5'/>"
    "<key qpos='0 0 7 2 0 0 0 1 0 0 0'/></keyframe>";

TEST(Mjcf, TheFirstKeyframeAppliesUnlessAnotherIsNamed) {
  const Model first = read(kFalling);
  EXPECT_EQ(first.keyframes, (std::vector<std::string>{"up", "key_2"}));
  expectVector(first.world.pose(bodyOf(first, "a")).position, {0, 0, 9});
  EXPECT_TRUE(hasNote(first, "start at keyframe up"));
  const Velocity a = first.world.velocity(bodyOf(first, "a")), p = first.world.velocity(bodyOf(first, "p"));
  EXPECT_EQ(a.linear, (Vec3{1, 2, 3}));
  EXPECT_EQ(a.angular, (Vec3{0, 0, 4}));
  // A quarter turn about z: the arm points along y, so it moves along -x.
  expectVector(toDouble(p.linear), {-5, 0, 0}, 1e-5);
  const Model second = read(kFalling, {.keyframe = "key_2"});
  expectVector(second.world.pose(bodyOf(second, "a")).position, {0, 0, 7});
  const Model none = read(kFalling, {.useKeyframe = false});
  expectVector(none.world.pose(bodyOf(none, "a")).position, {0, 0, 0});
  EXPECT_NE(messageOf(kFalling, {.keyframe = "down"}).find("keyframe \"down\": no key has this name"),
            std::string::npos);
}

TEST(Mjcf, AnExcludeDoesNotReachTheRestOfTheWorld) {
  const std::string world =
      "<worldbody><geom type='plane' size='1 1 1'/><body name='table'><geom type='box' size='1 1 .5' pos='0 0 "
      ".5'/></body>"
      "<body name='a' pos='0 0 1.05'><freejoint/><geom size='.1'/></body></worldbody>";
  EXPECT_EQ(read(world).bodies.size(), 2u);
  Model model = read(world + "<contact><exclude body1='a' body2='table'/></contact>");
  EXPECT_EQ(model.bodies.size(), 3u);
  for (int i = 0; i < 120; ++i) model.world.step(1.0f / 60);
  EXPECT_NEAR(model.world.pose(bodyOf(model, "a")).position.z, 0.1, 0.01);  // through the table, onto the plane
}

TEST(Mjcf, PairsCollideWhereFiltersDoNot) {
  const std::string world =
      "<worldbody><geom name='floor' type='plane' size='1 1 1' contype='0' conaffinity='0'/>"
      "<body name='a' pos='0 0 .2'><freejoint/><geom name='a' size='.1' contype='0' conaffinity='0'/></body>"
      "<body name='b' pos='1 0 .2'><freejoint/><geom name='b' size='.1' contype='0' "
      "conaffinity='0'/></body></worldbody>";
  Model model =
      read(world + "<contact><pair geom1='floor' geom2='a' friction='.7'/><pair geom1='floor' geom2='b'/></contact>");
  EXPECT_FLOAT_EQ(model.world.material(model.world.shapes(bodyOf(model, "a"))[0]).friction, 0.7f);
  EXPECT_TRUE(hasNote(model, "one of its geoms is in a pair already"));
  for (int i = 0; i < 60; ++i) model.world.step(1.0f / 60);
  EXPECT_NEAR(model.world.pose(bodyOf(model, "a")).position.z, 0.1, 0.01);
  EXPECT_LT(model.world.pose(bodyOf(model, "b")).position.z, -1);
}

TEST(Mjcf, GravityCompensation) {
  Model model = read("<worldbody><body gravcomp='1'><freejoint/><geom size='.1'/></body></worldbody>");
  model.world.step(0.1f);
  EXPECT_EQ(model.world.velocity(model.bodies[0].id).linear, Vec3{});
}

TEST(Mjcf, RefusedByTheWorldWithThePlaceInTheFile) {
  const auto body = [](const std::string& inside) {
    return "\n<worldbody>\n<body name='b'><freejoint/>\n" + inside + "</body></worldbody>";
  };
  expectRefused(body(""), "t.xml:3: body \"b\": a body that moves needs mass");
  expectRefused(body("<geom size='1' mass='0'/>"), "needs mass and inertia > 0");
  expectRefused(body("<inertial pos='0 0 0' mass='1'/>"), "needs mass and inertia > 0");
  expectRefused(body("<inertial pos='0 0 0' mass='0' diaginertia='1 1 1'/>"), "needs mass and inertia > 0");
  expectRefused(body("<geom size='1'/><geom size='1e-9'/>"), "t.xml:4: body \"b\" > geom: BodyDef.shapes[1]");
  expectRefused(body("<geom size='1e14'/>"), "t.xml:3: body \"b\"");
  expectRefused(body("<geom size='1' pos='1e12 0 0'/>"), "t.xml:");
  expectRefused(
      body("<inertial pos='0 0 0' mass='1e15' diaginertia='1e-15 1e-15 1e-15'/><geom size='1' friction='1e9'/>"),
      "t.xml:4: body \"b\" > geom: BodyDef.shapes[0]");
  expectRefused("<worldbody><body name='b' pos='1e14 0 0'><freejoint/><geom size='1'/></body></worldbody>",
                "t.xml:1: body \"b\": BodyDef.position");
}

TEST(Mjcf, ABodyWithoutMassButThatOfPartsLeftOutStandsStill) {
  Model model = read(
      "<worldbody><body name='a' pos='0 0 3'><freejoint/><replicate/><body name='c' pos='1 0 0'>"
      "<joint type='ball'/><geom size='.1'/></body></body><body name='b'><freejoint/><replicate/><geom "
      "size='.1'/></body>"
      "</worldbody><contact><exclude body1='a' body2='B0_0'/></contact>"
      "<equality><connect body1='B0_0' body2='b' anchor='0 0 0'/></equality>");
  EXPECT_EQ(model.world.type(bodyOf(model, "a")), BodyType::Static);
  EXPECT_EQ(model.world.type(bodyOf(model, "b")), BodyType::Dynamic);
  EXPECT_TRUE(hasNote(model, "body \"a\": has no mass without the parts that are left out: stands still"));
  EXPECT_TRUE(hasNote(model, "body2 \"B0_0\" may be among what was left out"));
  EXPECT_TRUE(hasNote(model, "body1 \"B0_0\" may be among what was left out"));
  EXPECT_EQ(model.world.jointCount(), 1u);
  for (int i = 0; i < 10; ++i) model.world.step(1.0f / 60);
  expectVector(model.world.pose(bodyOf(model, "a")).position, {0, 0, 3});
  expectVector(model.world.pose(bodyOf(model, "c")).position, {1, 0, 3}, 1e-3);
}

TEST(Mjcf, TheShowcase) {
  Model model = readMjcf(std::filesystem::path(__FILE__).parent_path() / "../scenes/showcase.xml");
  EXPECT_EQ(model.name, "showcase");
  EXPECT_EQ(model.world.bodyCount(), 80u);  // 55 bricks, 11 in the stack, 12 links and the ball, the world
  EXPECT_EQ(model.world.jointCount(), 13u);
  EXPECT_NEAR(model.dt, 1.0 / 60, 1e-8);
  EXPECT_TRUE(model.notes.empty()) << model.notes[0];
  EXPECT_FLOAT_EQ(model.world.mass(bodyOf(model, "heavy")), 1000);
  EXPECT_FLOAT_EQ(model.world.mass(bodyOf(model, "ball")), 1000);
  EXPECT_FLOAT_EQ(model.world.mass(bodyOf(model, "link_3")), 1);
  // Nothing touches the chain on its way, and the heavy box stays up.
  for (int i = 0; i < 300; ++i) model.world.step(static_cast<float>(model.dt));
  EXPECT_NEAR(model.world.pose(bodyOf(model, "heavy")).position.z, 10.5, 0.05);
  const BodyId ball = bodyOf(model, "ball");
  for (const Contact& contact : model.world.contacts()) {
    EXPECT_NE(contact.bodyA, ball);
    EXPECT_NE(contact.bodyB, ball);
  }
}

TEST(Mjcf, AFileThatIsNotThere) {
  try {
    readMjcf("/no/such/file.xml");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_STREQ(error.what(), "/no/such/file.xml: no such file");
  }
}

}  // namespace
}  // namespace avbd
