// Composites of MJCF: what they become, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/mjcf.h"
#include "io/mjcf_build.h"
#include "io/mjcf_cases.h"

namespace avbd {
namespace {

Model readWorld(const std::string& inside) {
  return readMjcfText("<mujoco><worldbody>" + inside + "</worldbody></mujoco>", "t.xml");
}

Vec3d placeOf(const Model& model, const std::string& name) { return model.world.pose(bodyOf(model, name)).position; }

void step(Model& model, int steps) {
  for (int i = 0; i < steps; ++i) model.world.step(0.01f);
}

const std::string kBall = "<geom size='.02' mass='.1'/></composite>";

TEST(MjcfComposite, AGridIsClothThatPinsHold) {
  Model model = readWorld(
      "<composite type='grid' count='5 4 1' spacing='.1' offset='0 0 1' prefix='P'>"
      "<pin coord='0 0'/><pin coord='4 0'/><joint kind='main' damping='.5'/>" +
      kBall);
  ASSERT_EQ(model.world.softBodies().size(), 1u);
  const SoftId soft = model.world.softBodies()[0];
  EXPECT_EQ(model.world.particles(soft).size(), 20u);
  EXPECT_EQ(model.world.radius(soft), 0.02f);
  for (const BodyId p : model.world.particles(soft)) EXPECT_NEAR(model.world.mass(p), 0.1, 1e-7);
  EXPECT_LT(length(placeOf(model, "PB1_0") - Vec3d{-0.15, -0.2, 1}), 1e-6);
  EXPECT_NEAR(model.world.linearDamping(bodyOf(model, "PB1_0")), 5, 1e-5);
  EXPECT_TRUE(hasNote(model, "a cloth, that resists shearing too"));
  step(model, 300);
  EXPECT_NEAR(placeOf(model, "PB2_3").z, 1 - 0.3, 0.08);  // it sags between the pins
}

TEST(MjcfComposite, WithoutEqualitiesTendonsAreSprings) {
  const Model model = readMjcfText(
      "<mujoco><option><flag equality='disable'/></option><worldbody><composite type='grid' count='3 3' spacing='.1'>"
      "<tendon kind='main' stiffness='50'/><geom size='.02'/></composite></worldbody></mujoco>",
      "t.xml");
  const SoftMaterial material = model.world.material(model.world.softBodies().at(0));
  EXPECT_NEAR(material.youngsModulus * material.thickness, 50, 1e-3);
}

TEST(MjcfComposite, AGridOfOneDimensionIsARope) {
  Model model = readWorld("<composite type='grid' count='6 1 1' spacing='.1'><pin coord='0'/>" + kBall);
  EXPECT_TRUE(model.world.softBodies().empty());
  EXPECT_EQ(model.world.jointCount(), 5u);
  step(model, 100);
  EXPECT_NEAR(length(placeOf(model, "B2_0") - placeOf(model, "B1_0")), 0.1, 1e-4);
}

TEST(MjcfComposite, ParticlesAreFreeAndDoNotRoll) {
  Model model = readWorld(
      "<geom type='plane' size='9 9 1'/><composite type='particle' count='3 2 2' spacing='.1' "
      "offset='0 0 .5'>" +
      kBall);
  EXPECT_EQ(model.world.bodyCount(), 13u);
  EXPECT_EQ(model.world.jointCount(), 0u);
  step(model, 200);
  for (const NamedBody& body : model.bodies) {
    if (model.world.type(body.id) != BodyType::Dynamic) continue;
    EXPECT_GT(model.world.pose(body.id).position.z, 0.015);
    EXPECT_EQ(model.world.velocity(body.id).angular, (Vec3{}));
    EXPECT_EQ(model.world.material(model.world.shapes(body.id).at(0)).friction, 0);  // condim 1, as in MuJoCo
  }
}

TEST(MjcfComposite, AClothHasTheBodyAroundItForAnElement) {
  Model model = readWorld(
      "<body name='B1_1' pos='0 0 1'><freejoint/><composite type='cloth' count='4 3 1' spacing='.1'>"
      "<joint kind='main' stiffness='.01' damping='.1'/><geom type='ellipsoid' size='.03 .01 .03' "
      "mass='.2'/></composite></body>");
  ASSERT_EQ(model.world.softBodies().size(), 1u);
  const SoftId soft = model.world.softBodies()[0];
  EXPECT_EQ(model.world.bodyCount(), 12u);
  EXPECT_EQ(model.world.radius(soft), 0.01f);
  EXPECT_EQ(model.world.material(soft).bending, 0.01f);
  EXPECT_LT(length(placeOf(model, "B0_2") - Vec3d{-0.1, 0.1, 1}), 1e-6);
  for (const BodyId p : model.world.particles(soft)) EXPECT_NEAR(model.world.mass(p), 0.2, 1e-6);
  step(model, 50);
  EXPECT_NEAR(placeOf(model, "B1_1").z, 1 - 0.5 * 9.81 * 0.25, 0.05);
  const Model still =
      readWorld("<body name='B0_0'><composite type='cloth' count='4 3 1' spacing='.1'>" + kBall + "</body>");
  EXPECT_EQ(still.world.particles(still.world.softBodies().at(0)).size(), 12u);
}

TEST(MjcfComposite, ARopeHangsOnTheBodyAroundIt) {
  Model model = readWorld(
      "<body name='PB1'><composite type='rope' prefix='P' count='4 1 1' spacing='.1'>"
      "<joint kind='main' damping='.01'/><geom type='capsule' size='.01 .03'/></composite></body>");
  EXPECT_LT(length(placeOf(model, "PB3") - Vec3d{0.2, 0, 0}), 1e-6);
  EXPECT_LT(length(placeOf(model, "PB0") - Vec3d{-0.1, 0, 0}), 1e-6);
  EXPECT_EQ(model.joints.size(), 6u);
  step(model, 500);
  EXPECT_NEAR(placeOf(model, "PB3").z, -0.15, 0.01);
  EXPECT_NEAR(placeOf(model, "PB0").z, -0.05, 0.01);
}

TEST(MjcfComposite, ALoopCloses) {
  Model model = readWorld(
      "<body name='B0' pos='0 0 1'><freejoint/><composite type='loop' count='12 1 1' spacing='.1'>"
      "<geom type='capsule' size='.01 .03'/></composite></body>");
  EXPECT_EQ(model.world.bodyCount(), 12u + 11u);  // and one between the hinges of each
  step(model, 50);
  double gap = 0;
  for (const JointId joint : model.world.joints()) gap = std::max(gap, model.world.gap(joint));
  EXPECT_LT(gap, 1e-3);
}

TEST(MjcfComposite, ACableFollowsItsCurve) {
  Model model = readWorld(
      "<composite type='cable' prefix='C' curve='s' count='5 1 1' size='1' offset='-.3 0 .6' "
      "initial='none'><plugin plugin='mujoco.elasticity.cable'/><joint kind='main' damping='.01'/>"
      "<geom type='capsule' size='.005'/></composite>");
  EXPECT_LT(length(placeOf(model, "CB_last") - Vec3d{0.45, 0, 0.6}), 1e-6);
  EXPECT_EQ(model.world.jointCount(), 3u);
  EXPECT_TRUE(hasNote(model, "ignored"));  // the plugin
  step(model, 100);
  EXPECT_LT(placeOf(model, "CB_last").z, 0.5);
  const Model helix = readWorld(
      "<composite type='cable' prefix='C' curve='cos(s) sin(s) s' count='4 1 1' "
      "size='1 .5 2' initial='free'><geom type='box' size='.005 .01 .02'/></composite>");
  EXPECT_LT(length(placeOf(helix, "CB_first") - Vec3d{0.5, 0, 0}), 1e-6);
  EXPECT_LT(length(placeOf(helix, "CB_1") - Vec3d{-0.25, -0.4330127, 1.0 / 3}), 1e-6);
  const Model bent = readWorld(
      "<composite type='cable' vertex='0 0 0 1 0 0 1 1 0 1 1 1' initial='ball' "
      "quat='0 0 0 1'><geom type='cylinder' size='.01'/></composite>");
  EXPECT_LT(length(placeOf(bent, "B_last") - Vec3d{-1, -1, 0}), 1e-6);
}

TEST(MjcfComposite, OthersNameItsParts) {
  const Model model = readMjcfText(
      "<mujoco><worldbody><composite type='cable' curve='s' count='5 1 1' initial='none'><geom type='capsule' "
      "size='.005'/></composite><body name='b' pos='1 0 0'><freejoint/><geom size='.1'/></body></worldbody>"
      "<equality><connect body1='B_last' body2='b' anchor='.25 0 0'/></equality>"
      "<sensor><framepos objtype='site' objname='S_last'/></sensor></mujoco>",
      "t.xml");
  EXPECT_EQ(model.world.jointCount(), 4u);
  EXPECT_EQ(model.probes.size(), 1u);
}

struct Refused {
  const char* inside;
  const char* part;
};

const Refused kRefused[] = {
    {"<composite count='2 2'/>", "type is missing"},
    {"<composite type='net' count='2 2'/>", "type = \"net\": must be one of particle, grid"},
    {"<composite type='grid' spacing='1'/>", "count is missing"},
    {"<composite type='grid' count='0 2' spacing='1'/>", "count = \"0 2\": each must be a whole number 1 .. 100000"},
    {"<composite type='grid' count='1 2' spacing='1'/>", "numbers above 1 must come first"},
    {"<composite type='grid' count='2 2'/>", "spacing is missing: must be finite and > 0"},
    {"<composite type='grid' count='2 2' spacing='1'/>", "must have a geom"},
    {"<composite type='grid' count='2 2 2' spacing='1'><geom size='1'/></composite>", "needs 1 or 2 numbers above 1"},
    {"<composite type='grid' count='2 2' spacing='1'><geom/></composite>", "size is missing"},
    {"<composite type='grid' count='2 2' spacing='1'><geom size='1'/><geom size='1'/></composite>", "one geom only"},
    {"<composite type='grid' count='2 2' spacing='1'><geom type='plane' size='1 1 1'/></composite>", "must be sphere"},
    {"<composite type='grid' count='2 2' spacing='1'><geom size='1' mass='0'/></composite>", "must be > 0"},
    {"<composite type='grid' count='2 2' spacing='1'><pin coord='2 0'/><geom size='1'/></composite>",
     "coord = \"2 0\": each must be a place in the grid"},
    {"<composite type='particle' count='1000 1000' spacing='1'><geom size='1'/></composite>", "at most 100000 points"},
    {"<composite type='cloth' count='3 3' spacing='1'><geom size='1'/></composite>",
     "must be its element Bi_j by name"},
    {"<body name='B3_0'><composite type='cloth' count='3 3' spacing='1'><geom size='1'/></composite></body>",
     "must be its element Bi_j by name"},
    {"<body name='B1'><composite type='cloth' count='3 3' spacing='1'><geom size='1'/></composite></body>",
     "must be its element Bi_j by name"},
    {"<body name='B9'><composite type='rope' count='3' spacing='1'><geom size='1'/></composite></body>",
     "must be its element Bi by name"},
    {"<body name='B1'><composite type='loop' count='3' spacing='1'><geom size='1'/></composite></body>",
     "must be its first element, B0"},
    {"<body name='B0'><composite type='rope' count='3 3' spacing='1'><geom size='1'/></composite></body>",
     "needs 1 numbers above 1"},
    {"<composite type='cable' count='3' vertex='0 0 0 1 1 1'><geom type='capsule' size='1'/></composite>",
     "not allowed beside vertex"},
    {"<composite type='cable' vertex='0 0 0'><geom type='capsule' size='1'/></composite>", "2 or more vertices"},
    {"<composite type='cable' vertex='0 0 0 0 0 0'><geom type='capsule' size='1'/></composite>", "at one place"},
    {"<composite type='cable' count='3' curve='2*s'><geom type='capsule' size='1'/></composite>",
     "each must be s, cos(s), sin(s) or 0"},
    {"<composite type='cable' count='3'><geom type='capsule' size='1'/></composite>", "curve is missing"},
    {"<composite type='cable' count='3' curve='s'><geom size='1'/></composite>", "must be capsule, cylinder or box"},
    {"<composite type='cable' count='3' curve='s'><geom type='box' size='1'/></composite>", "must be 3 numbers"},
    {"<composite type='cable' count='3' curve='s' initial='held'><geom type='capsule' size='1'/></composite>",
     "must be one of free, ball, none"},
    {"<composite type='particle' count='2' spacing='1'><joint kind='side'/><geom size='1'/></composite>",
     "must be one of main, twist"},
};

TEST(MjcfComposite, BrokenOnesAreRefusedWithTheirPlace) {
  for (const Refused& r : kRefused) {
    std::string message = "accepted";
    try {
      readWorld("\n" + std::string(r.inside));
    } catch (const FileError& error) {
      message = error.what();
    }
    EXPECT_NE(message.find(r.part), std::string::npos) << r.inside << "\n  " << message;
    EXPECT_NE(message.find("t.xml:2"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace avbd
