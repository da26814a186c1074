// Flexes of MJCF in the world: particles, masses, what holds them, what is noted and refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "io/mjcf.h"
#include "io/mjcf_cases.h"

namespace avbd {
namespace {

Model read(const std::string& inside, const MjcfOptions& options = {}) {
  return readMjcfText("<mujoco>" + inside + "</mujoco>", "t.xml", options);
}

Model readWorld(const std::string& inside) { return read("<worldbody>" + inside + "</worldbody>"); }

double massOf(const Model& model) {
  double sum = 0;
  for (const BodyId id : model.world.bodies()) sum += double{model.world.mass(id)};
  return sum;
}

void step(Model& model, int steps, float dt = 0.01f) {
  for (int i = 0; i < steps; ++i) model.world.step(dt);
}

SoftId onlySoft(const Model& model) {
  EXPECT_EQ(model.world.softBodies().size(), 1u);
  return model.world.softBodies().at(0);
}

TEST(MjcfFlex, AGridOfThreeDimensionsIsASoftBody) {
  const Model model = readWorld(
      "<flexcomp name='F' dim='3' count='4 3 2' spacing='.1 .1 .1' pos='1 2 3' mass='6' radius='.02' rgba='1 0 0 1'>"
      "<elasticity young='2e4' poisson='.25'/><contact selfcollide='none' friction='.3'/></flexcomp>");
  const SoftId soft = onlySoft(model);
  EXPECT_EQ(model.world.mesh(soft)->tets().size(), 36u);
  EXPECT_EQ(model.world.particles(soft).size(), 24u);
  EXPECT_EQ(model.world.material(soft).youngsModulus, 2e4f);
  EXPECT_EQ(model.world.material(soft).poissonRatio, 0.25f);
  EXPECT_NEAR(model.world.material(soft).density, 6 / 0.006, 1);
  EXPECT_EQ(model.world.radius(soft), 0.02f);
  for (const BodyId p : model.world.particles(soft)) EXPECT_NEAR(model.world.mass(p), 0.25, 1e-6);
  EXPECT_NEAR(massOf(model), 6, 1e-5);
  EXPECT_LT(length(model.world.pose(bodyOf(model, "F_0")).position - Vec3d{0.85, 1.9, 2.95}), 1e-6);
  const ShapeId shape = model.world.shapes(bodyOf(model, "F_0")).at(0);
  EXPECT_EQ(model.world.material(shape).friction, 0.3f);
  EXPECT_EQ(model.bodies[0].colors.at(0)->red, 255);
  EXPECT_TRUE(model.notes.empty()) << model.notes[0];
}

TEST(MjcfFlex, AGridOfTwoDimensionsIsCloth) {
  const Model model = readWorld(
      "<flexcomp name='F' count='4 3 1' spacing='.1 .1 .1' mass='1.2' radius='.01'>"
      "<elasticity young='1e6' poisson='.2' thickness='.004' elastic2d='both'/></flexcomp>");
  const SoftMaterial material = model.world.material(onlySoft(model));
  EXPECT_EQ(model.world.mesh(onlySoft(model))->triangles().size(), 12u);
  EXPECT_EQ(material.youngsModulus, 1e6f);
  EXPECT_EQ(material.thickness, 0.004f);
  EXPECT_NEAR(material.bending, 1e6 * 0.004 * 0.004 * 0.004 / (12 * 0.96), 1e-9);
  EXPECT_NEAR(massOf(model), 1.2, 1e-6);
}

TEST(MjcfFlex, StretchingAndBendingAreAskedForApart) {
  const std::string start = "<flexcomp name='F' count='4 3 1'><elasticity young='1e6' thickness='.004' elastic2d='";
  const Model stretch = readWorld(start + "stretch'/></flexcomp>"), bend = readWorld(start + "bend'/></flexcomp>");
  const Model none = readWorld(start + "none'/></flexcomp>");
  EXPECT_EQ(stretch.world.material(onlySoft(stretch)).bending, 0);
  EXPECT_EQ(stretch.world.material(onlySoft(stretch)).youngsModulus, 1e6f);
  EXPECT_GT(bend.world.material(onlySoft(bend)).bending, 0);
  EXPECT_LT(bend.world.material(onlySoft(bend)).youngsModulus, 1e3f);
  EXPECT_TRUE(hasNote(bend, "has no elasticity against stretching"));
  EXPECT_TRUE(hasNote(none, "elastic2d is none: young is not used"));
}

TEST(MjcfFlex, PluginsSayWhatOlderFilesAreMadeOf) {
  const std::string config = "<config key='young' value='3e4'/><config key='poisson' value='.1'/>";
  const Model solid =
      readWorld("<flexcomp name='F' dim='3' count='3 3 3'><plugin plugin='mujoco.elasticity.solid'>" + config +
                "<config key='damping' value='.01'/><config key='x' value='1'/>" + "</plugin></flexcomp>");
  EXPECT_EQ(solid.world.material(onlySoft(solid)).youngsModulus, 3e4f);
  EXPECT_EQ(solid.world.material(onlySoft(solid)).damping, 0.01f);
  EXPECT_TRUE(hasNote(solid, "config \"x\" is not used"));
  const Model shell = readWorld("<flexcomp name='F' count='3 3 1'><plugin plugin='mujoco.elasticity.shell'>" + config +
                                "<config key='thickness' value='.01'/></plugin></flexcomp>");
  EXPECT_NEAR(shell.world.material(onlySoft(shell)).bending, 3e4 * 1e-6 / (12 * 0.99), 1e-6);
}

TEST(MjcfFlex, WhatAnEqualityHoldsHardlyStretches) {
  Model model = readWorld(
      "<flexcomp name='F' count='11 11 1' spacing='.05 .05 .05' mass='1' euler='90 0 0' pos='0 0 1' radius='.002'>"
      "<edge equality='true'/><pin gridrange='0 10 10 10'/></flexcomp>");
  EXPECT_TRUE(hasNote(model, "edges that keep their lengths"));
  step(model, 200);
  double lowest = 9;
  for (const BodyId p : model.world.particles(onlySoft(model)))
    lowest = std::min(lowest, model.world.pose(p).position.z);
  EXPECT_NEAR(1.25 - lowest, 0.5, 0.005);
}

// A hung rope of 50 points: what it stretches, and that it swings and stays whole.
TEST(MjcfFlex, ARopeKeepsItsLength) {
  for (const char* turn : {"0 90 0", "0 0 0"}) {
    Model model =
        readWorld(std::string("<flexcomp name='R' dim='1' count='50 1 1' spacing='.02 .02 .02' mass='1' euler='") +
                  turn + "' radius='.005'><edge equality='true'/><pin id='0'/></flexcomp>");
    EXPECT_EQ(model.bodies.size(), 49u);
    EXPECT_NEAR(massOf(model), 0.98, 1e-6);
    const bool hangs = turn[2] == '9';
    const Vec3d top = hangs ? Vec3d{0, 0, 0.49} : Vec3d{-0.49, 0, 0};
    for (int i = 0; i < 300; ++i) {
      step(model, 1);
      Vec3d before = top;
      double whole = 0;
      for (const NamedBody& body : model.bodies) {
        const Vec3d at = model.world.pose(body.id).position;
        whole += length(at - before);
        before = at;
      }
      ASSERT_NEAR(whole, 0.98, 0.001 * 0.98) << turn << ' ' << i;
    }
    if (hangs) {
      EXPECT_NEAR(model.world.pose(bodyOf(model, "R_49")).position.z, -0.49, 0.001);
    }
  }
}

TEST(MjcfFlex, ARopeWithStiffnessIsSprings) {
  Model model = readWorld(
      "<flexcomp name='R' dim='1' count='3 1 1' spacing='.1 .1 .1' mass='3' euler='0 90 0' radius='.005'>"
      "<edge stiffness='1000' damping='10'/><pin id='0'/></flexcomp>");
  step(model, 500);
  // The upper spring carries two points of 1 kg, the lower one.
  EXPECT_NEAR(model.world.pose(bodyOf(model, "R_1")).position.z, 0 - 2 * 9.81 / 1000, 1e-3);
  EXPECT_NEAR(model.world.pose(bodyOf(model, "R_2")).position.z, -0.1 - 3 * 9.81 / 1000, 1e-3);
}

TEST(MjcfFlex, ACircleCloses) {
  Model model = read(
      "<option gravity='0 0 0'/><worldbody><flexcomp name='C' type='circle' count='21 1 1' spacing='.1 .1 .1' dim='1' "
      "radius='.01'><edge equality='true'/></flexcomp></worldbody>");
  ASSERT_EQ(model.bodies.size(), 20u);
  model.world.addImpulse(model.bodies[0].id, {0.5f, 0, 0.2f});
  step(model, 100);
  for (size_t i = 0; i < 20; ++i) {
    const Vec3d a = model.world.pose(bodyOf(model, "C_" + std::to_string(i))).position;
    const Vec3d b = model.world.pose(bodyOf(model, "C_" + std::to_string((i + 1) % 20))).position;
    EXPECT_NEAR(length(a - b), 0.1, 0.002) << i;
  }
}

TEST(MjcfFlex, WhatABodyHoldsTakesItsMassFromIt) {
  Model model = readWorld(
      "<body name='b' pos='0 0 1'><joint type='slide' axis='1 0 0'/><geom type='box' size='.1 .1 .1' mass='5'/>"
      "<flexcomp name='F' dim='3' count='3 3 3' spacing='.1 .1 .1' pos='0 0 -.2' mass='.27' radius='.005'>"
      "<elasticity young='1e5'/><contact contype='0' conaffinity='0'/><pin gridrange='0 0 2 2 2 "
      "2'/></flexcomp></body>");
  // MuJoCo's pinned points have no mass of their own: 5 kg and 18 points of 10 g.
  EXPECT_NEAR(massOf(model), 5.18, 1e-5);
  EXPECT_NEAR(model.world.mass(bodyOf(model, "F_0")), 0.01, 1e-7);
  EXPECT_NEAR(model.world.mass(bodyOf(model, "b")), 4.91, 1e-5);
  const BodyId b = bodyOf(model, "b");
  model.world.setVelocity(b, {{1, 0, 0}, {}});
  step(model, 100);
  EXPECT_GT(model.world.pose(b).position.x, 0.8);
  // It hangs below: what is pinned has kept its place in the body.
  const Vec3d pinned = model.world.pose(bodyOf(model, "F_2")).position - model.world.pose(b).position;
  EXPECT_LT(length(pinned - Vec3d{-0.1, -0.1, -0.1}), 1e-3);
}

TEST(MjcfFlex, RigidOnesArePartOfTheirBody) {
  const Model still = readWorld("<flexcomp name='F' count='4 4 1' rigid='true'/>");
  EXPECT_TRUE(still.world.softBodies().empty());
  ASSERT_EQ(still.world.bodyCount(), 1u);
  EXPECT_TRUE(std::holds_alternative<Mesh>(still.world.geometry(still.world.shapes(still.world.bodies()[0]).at(0))));
  const Model moving = readWorld(
      "<body name='b'><freejoint/><geom size='.1' mass='2'/><flexcomp name='F' dim='3' count='3 3 3' rigid='true'/>"
      "</body>");
  EXPECT_NEAR(massOf(moving), 2, 1e-6);
  EXPECT_TRUE(std::holds_alternative<Hull>(moving.world.geometry(moving.world.shapes(bodyOf(moving, "b")).at(1))));
  EXPECT_TRUE(hasNote(moving, "collides as its convex hull"));
  const Model wire = readWorld("<flexcomp name='F' dim='1' count='4 1 1'><pin range='0 3'/></flexcomp>");
  EXPECT_EQ(wire.world.shapeCount(), 3u);
}

const char* const kPoint =
    "<inertial pos='0 0 0' mass='.5' diaginertia='1e-5 1e-5 1e-5'/><joint type='slide' axis='1 0 0'/>"
    "<joint type='slide' axis='0 1 0'/><joint type='slide' axis='0 0 1'/></body>";

// As MuJoCo saves what a flexcomp made.
TEST(MjcfFlex, AFlexBetweenBodiesOfTheFile) {
  Model model =
      read("<worldbody><body name='a' pos='0 0 -.1'>" + std::string(kPoint) + "<body name='b' pos='0 0 -.2'>" + kPoint +
           "</worldbody><deformable><flex name='F' dim='1' radius='.01' body='world a b' element='0 1 1 2'/>"
           "</deformable><equality><flex flex='F'/></equality>");
  EXPECT_EQ(model.world.bodyCount(), 2u);
  EXPECT_NEAR(massOf(model), 1, 1e-6);
  step(model, 100);
  EXPECT_NEAR(model.world.pose(bodyOf(model, "b")).position.z, -0.2, 1e-3);
}

TEST(MjcfFlex, AFlexBetweenBodiesThatAreMoreThanPoints) {
  Model model = read(
      "<worldbody><body name='a' pos='0 0 -.1'><joint name='j' type='slide' axis='0 0 1'/><geom size='.02' "
      "mass='2'/></body>"
      "<body name='b' pos='.1 0 -.1'><freejoint/><geom size='.02' mass='3'/></body></worldbody>"
      "<deformable><flex name='F' radius='.01' body='world world a b' vertex='0 0 0 .1 0 0 0 0 0 0 0 0' "
      "element='0 1 2 1 3 2'/></deformable><equality><flex flex='F'/></equality>");
  EXPECT_EQ(model.world.softBodies().size(), 1u);
  step(model, 200);
  EXPECT_NEAR(model.world.pose(bodyOf(model, "a")).position.z, -0.1, 0.002);
  EXPECT_NEAR(model.world.pose(bodyOf(model, "b")).position.z, -0.1, 0.002);
}

TEST(MjcfFlex, OthersNameItsPoints) {
  Model model = read(
      "<worldbody><body name='b' pos='0 0 -1'><freejoint/><geom size='.1' mass='1'/></body>"
      "<flexcomp name='F' dim='1' count='3 1 1' spacing='.1 .1 .1' radius='.01'><edge "
      "equality='true'/></flexcomp></worldbody>"
      "<contact><exclude body1='b' body2='F_2'/></contact>"
      "<equality><connect body1='F_0' anchor='0 0 0'/></equality>"
      "<sensor><framepos name='s' objtype='body' objname='F_2'/></sensor>"
      "<keyframe><key qpos='0 0 -1 1 0 0 0  0 0 0  0 0 0  0 0 .5' qvel='0 0 0 0 0 0  0 0 0  0 0 0  0 2 "
      "0'/></keyframe>");
  EXPECT_LT(length(model.world.pose(bodyOf(model, "F_2")).position - Vec3d{0.1, 0, 0.5}), 1e-6);
  EXPECT_EQ(model.world.velocity(bodyOf(model, "F_2")).linear, (Vec3{0, 2, 0}));
  EXPECT_EQ(model.world.excludedPairs().size(), 3u);  // and the two rods
  EXPECT_EQ(model.probes.size(), 1u);
  step(model, 50);
  EXPECT_LT(length(model.world.pose(bodyOf(model, "F_0")).position - Vec3d{-0.1, 0, 0}), 1e-3);
}

TEST(MjcfFlex, DampingGoesWithTheFilesModulus) {
  const auto dampingOf = [](const std::string& parts) {
    const Model model =
        readWorld("<flexcomp name='F' dim='2' count='3 3 1' spacing='.1 .1 .1'>" + parts + "</flexcomp>");
    EXPECT_FALSE(hasNote(model, "damping"));
    return model.world.material(onlySoft(model)).damping;
  };
  const std::string elasticity = "<elasticity young='1e6' damping='.02' thickness='.01' elastic2d='both'/>";
  EXPECT_EQ(dampingOf(elasticity), 0.02f);
  EXPECT_EQ(dampingOf("<elasticity young='1e6' thickness='.01' elastic2d='both'/>"), 0);
  const float held = dampingOf(
      "<edge equality='true'/><elasticity young='1' damping='.02' thickness='.01' "
      "elastic2d='both'/>");
  EXPECT_GT(held, 0);
  EXPECT_LT(held, 0.001f);
  EXPECT_THROW(dampingOf("<elasticity young='1' damping='-1'/>"), FileError);
}

TEST(MjcfFlex, WhatIsLeftOutIsNoted) {
  const auto noted = [](const std::string& flexcomp, const char* part) {
    const Model model = readWorld("<flexcomp name='F' " + flexcomp);
    EXPECT_TRUE(hasNote(model, part)) << flexcomp << " lacks " << part;
  };
  noted("type='box' dim='1'/>", "left out: a flexcomp of type box or mesh with dim 1");
  noted("dof='trilinear' dim='3'/>", "dof trilinear: each point moves by itself");
  noted("dim='3'><edge damping='.1'/></flexcomp>", "attribute damping is not used");
  noted("dim='3'><edge stiffness='.1'/></flexcomp>", "attribute stiffness is not used");
  noted("dim='3' radius='0'/>", "radius is 0");
  noted("dim='3'/>", "has no elasticity");
  noted("dim='1'/>", "neither stiffness nor an equality");
  noted("dim='3'><contact solref='.1 1'/></flexcomp>", "attribute solref is not used");
  noted("dim='3'><plugin plugin='x'/></flexcomp>", "left out: plugin \"x\"");
  const Model nodes = read("<deformable><flex name='F' node='world' body='world' element='0 1 2'/></deformable>");
  EXPECT_TRUE(hasNote(nodes, "interpolated between nodes are left out"));
}

struct Refused {
  const char* inside;
  const char* part;
};

const Refused kFlexcomps[] = {
    {"/>", "name is missing: must be given"},
    {"name='F' type='ball'/>", "type = \"ball\": must be one of grid, box"},
    {"name='F' dim='4'/>", "dim = \"4\": must be 1, 2 or 3"},
    {"name='F' count='0 3 1'/>", "count = \"0 3 1\": number 1 must be a whole number 2 .. 100000"},
    {"name='F' count='1 3 1'/>", "number 1 must be a whole number 2"},
    {"name='F' count='3 2.5 1'/>", "number 2 must be a whole number"},
    {"name='F' count='1e9 1e9 1'/>", "number 1 must be a whole number"},
    {"name='F' count='1000 1000 1'/>", "at most 100000 points together"},
    {"name='F' type='circle' count='3 1 1'/>", "number 1 must be a whole number 4"},
    {"name='F' spacing='0 1 1'/>", "spacing = \"0 1 1\": each must be > 0 and at least twice the radius"},
    {"name='F' spacing='.001 1 1'/>", "at least twice the radius"},
    {"name='F' mass='0'/>", "mass = \"0\": must be finite and > 0"},
    {"name='F' mass='nan'/>", "mass = \"nan\""},
    {"name='F' inertiabox='-1'/>", "inertiabox = \"-1\""},
    {"name='F' radius='-1'/>", "radius = \"-1\": must be finite and >= 0"},
    {"name='F' material='m'/>", "material = \"m\": no material of this name"},
    {"name='F' dof='half'/>", "dof = \"half\": must be one of full"},
    {"name='F' type='direct' dim='1'/>", "point is missing: must be 3 numbers for each point"},
    {"name='F' type='direct' dim='1' point='0 0'/>", "point = \"0 0\": must be 3 numbers"},
    {"name='F' type='direct' dim='1' point='0 0 0 1 0 0'/>", "element is missing: must be 2 numbers"},
    {"name='F' type='direct' dim='1' point='0 0 0 1 0 0' element='0'/>", "must be 2 numbers for each element"},
    {"name='F' type='direct' dim='1' point='0 0 0 1 0 0' element='0 2'/>", "must be a whole number 0 .. 1"},
    {"name='F' type='direct' dim='1' point='0 0 0 1 0 0' element='1 1'/>", "must not name a point twice"},
    {"name='F' type='direct' dim='1' point='0 0 0 0 0 0' element='0 1'><edge equality='true'/></flexcomp>",
     "two points that an edge joins are at one place"},
    {"name='F' type='direct' dim='3' point='0 0 0 1 0 0 0 1 0 1 1 0' element='0 1 2 3'/>",
     "at least one that has volume"},
    {"name='F' type='direct' point='0 0 0 1 0 0 0 1 0 0 0 1 1 1 1' element='0 1 2 0 1 3 0 1 4'/>", "edge"},
    {"name='F' type='mesh'/>", "file is missing: must be given"},
    {"name='F' type='gmsh'/>", "file is missing: must be given"},
    {"name='F' type='mesh' file='a.obj'/>", "file = \"a.obj\": text that is not a file"},
    {"name='F'><pin id='100'/></flexcomp>", "id = \"100\": each must be a whole number 0 .. 99"},
    {"name='F'><pin id='-1'/></flexcomp>", "id = \"-1\": each must be a whole number"},
    {"name='F'><pin range='1'/></flexcomp>", "range = \"1\": must be 2 numbers for each range"},
    {"name='F'><pin grid='1 2 3'/></flexcomp>", "grid = \"1 2 3\": must be 2 numbers for each place"},
    {"name='F'><pin grid='0 10'/></flexcomp>", "grid = \"0 10\": each must be a whole number 0 .. 9"},
    {"name='F' type='disc'><pin grid='0 1'/></flexcomp>", "is only allowed for type grid"},
    {"name='F'><pin gridrange='0 1 2'/></flexcomp>", "must be 4 numbers for each place"},
    {"name='F'><elasticity young='-1'/></flexcomp>", "young = \"-1\": must be finite and >= 0"},
    {"name='F'><elasticity poisson='.5'/></flexcomp>", "poisson = \".5\": must be >= 0 and < 0.5"},
    {"name='F'><elasticity young='1' elastic2d='both'/></flexcomp>", "thickness is missing: must be finite and > 0"},
    {"name='F'><elasticity elastic2d='all'/></flexcomp>", "must be one of none, bend, stretch, both"},
    {"name='F'><edge equality='yes'/></flexcomp>", "must be one of false, true, vert, strain"},
    {"name='F'><edge stiffness='-1'/></flexcomp>", "stiffness = \"-1\""},
    {"name='F'><contact condim='2'/></flexcomp>", "condim = \"2\": must be 1, 3, 4 or 6"},
    {"name='F'><contact selfcollide='all'/></flexcomp>", "must be one of none, narrow"},
    {"name='F'><plugin plugin='mujoco.elasticity.solid'><config key='young' value='x'/></plugin></flexcomp>",
     "value = \"x\""},
    {"name='F'/><flexcomp name='F'/>", "another body has the name"},
    {"name='F'/><body name='F_3'/>", "another body has this name"},
};

std::string messageOf(const std::string& inside) {
  try {
    read(inside);
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MjcfFlex, BrokenFlexcompsAreRefusedWithTheirPlace) {
  for (const Refused& r : kFlexcomps) {
    const std::string message = messageOf("\n<worldbody><flexcomp " + std::string(r.inside) + "</worldbody>");
    EXPECT_NE(message.find(r.part), std::string::npos) << r.inside << "\n  " << message;
    EXPECT_NE(message.find("t.xml:2"), std::string::npos) << message;
  }
}

const Refused kFlexes[] = {
    {"<flex name='F' body='' element='0 1 2'/>", "body = \"\": must name one body"},
    {"<flex name='F' body='a' element='0 1 2'/>", "no body has the name \"a\""},
    {"<flex name='F' body='world world' vertex='0 0 0' element='0 1 2'/>", "names 2 bodies: must name 1"},
    {"<flex name='F' body='world' vertex='0 0' element='0 1 2'/>", "must be 3 numbers for each vertex"},
    {"<flex name='F' body='world world world' element='0 1 3'/>", "must be a whole number 0 .. 2"},
    {"<flex name='F' body='world world world'/>", "element is missing: must be 3 numbers for each element"},
};

TEST(MjcfFlex, BrokenFlexesAreRefusedWithTheirPlace) {
  for (const Refused& r : kFlexes) {
    const std::string message = messageOf("\n<deformable>" + std::string(r.inside) + "</deformable>");
    EXPECT_NE(message.find(r.part), std::string::npos) << r.inside << "\n  " << message;
    EXPECT_NE(message.find("t.xml:2: flex \"F\""), std::string::npos) << message;
  }
  EXPECT_NE(messageOf("<equality><flex flex='F'/></equality>").find("flex = \"F\": no flex has this name"),
            std::string::npos);
}

TEST(MjcfFlex, AFlexcompIsMadeOfAGmshFile) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "avbd_flex_gmsh";
  const std::filesystem::path corpus = std::filesystem::path(__FILE__).parent_path() / "corpus" / "soft";
  std::filesystem::create_directories(folder);
  for (const char* file : {"cube_22_text.msh", "cube_41_binary.msh"}) {
    std::filesystem::copy_file(corpus / file, folder / file, std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder / "m.xml") << "<mujoco><worldbody><flexcomp name='F' type='gmsh' dim='3' file='" << file
                                    << "' mass='5' scale='2 2 2'><elasticity young='1e4'/></flexcomp></worldbody>"
                                    << "</mujoco>";
    const Model model = readMjcf(folder / "m.xml");
    const SoftId soft = onlySoft(model);
    EXPECT_NEAR(model.world.volume(soft), 8, 1e-4);
    EXPECT_NEAR(massOf(model), 5, 1e-4);
    EXPECT_EQ(model.softs.at(0).name, "F");
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace avbd
