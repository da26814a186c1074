// `avbd info`: models, meshes, what it refuses.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/failure.h"
#include "app/invoke.h"

namespace avbd::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRobot = R"(<mujoco model="robot"><option timestep="0.01" gravity="0 0 -5"/>
  <asset><mesh name="tetra" vertex="0 0 0 2 0 0 0 1 0 0 0 3"/></asset><worldbody><geom type="plane" size="1 1 1"/>
  <body name="a" pos="10 0 0"><freejoint/><geom size=".5" mass="2" rgba="1 0 0 1"/><geom type="box" size="1 2 3" mass="3"/>
    <body pos="0 0 1"><joint type="ball"/><geom type="mesh" mesh="tetra" mass="1"/></body></body>
  <body mocap="true" pos="0 0 -1"/></worldbody><sensor><clock/><user objtype="body" objname="a"/>
  <framepos name="at" objtype="xbody" objname="a"/></sensor><keyframe><key name="home"/></keyframe></mujoco>)";

void expectRefused(const std::vector<std::string>& args, const std::vector<std::string>& words) {
  const Invoked run = invoke(args);
  EXPECT_EQ(run.status, kExitBadInput) << run.out;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err.rfind("avbd: error: ", 0), 0u) << run.err;
  for (const std::string& word : words) EXPECT_NE(run.err.find(word), std::string::npos) << word << ": " << run.err;
}

std::string tetra() { return "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"; }

TEST(InfoCommand, SoftBodiesOfAScene) {
  const Invoked text = invoke({"run", "soft_cubes", "--time", "0.2"});
  EXPECT_NE(text.out.find("5: 900 particles, 2500 elements, largest strain "), std::string::npos) << text.out;
  const Json json = Json::parse(invoke({"run", "soft_cubes", "--time", "0.2", "--json"}).out);
  ASSERT_EQ(json["soft_bodies"].size(), 5u);
  const Json& cube = json["soft_bodies"][4];
  EXPECT_EQ(cube["name"], "cube4");
  EXPECT_EQ(cube["cloth"], false);
  EXPECT_EQ(cube["particles"], 180);
  EXPECT_EQ(cube["elements"], 500);
  EXPECT_NEAR(cube["volume"].get<double>(), 0.125, 1e-4) << "it still falls";
  EXPECT_NEAR(cube["strain_max"].get<double>(), 0, 1e-3);
  EXPECT_GT(std::abs(json["soft_bodies"][0]["strain_max"].get<double>()), 1e-3) << "it has met the ground";
}

TEST(InfoCommand, AModel) {
  const TestFolder folder;
  const std::string file = folder.write("robot.xml", kRobot);
  const Invoked text = invoke({"info", file});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.err, "");
  for (const char* part :
       {"robot", "2 dynamic, 1 kinematic, 1 static", "4: 1 sphere, 1 box, 1 half_space, 1 hull", "1: 1 ball", "6 kg",
        "0.01 s", "0, 0, -5", "home", "2: 1 clock, 1 framepos", "user: left out"}) {
    EXPECT_NE(text.out.find(part), std::string::npos) << part << "\n" << text.out;
  }
  const Json json = Json::parse(invoke({"info", file, "--json"}).out);
  EXPECT_EQ(json["model"], "robot");
  EXPECT_EQ(json["dynamic"], 2);
  EXPECT_EQ(json["shapes"]["hull"], 1);
  EXPECT_EQ(json["hull_vertices"], 4);
  EXPECT_EQ(json["coloured_shapes"], 1);
  EXPECT_EQ(json["joints"]["ball"], 1);
  EXPECT_NEAR(json["mass"].get<double>(), 6, 1e-5);
  // The box from x = 9, y = -2, z = -3; the hull up to x = 12 and z = 4.
  const double lower[] = {9, -2, -3}, upper[] = {12, 2, 4};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(json["lower"][i].get<double>(), lower[i], 1e-5);
    EXPECT_NEAR(json["upper"][i].get<double>(), upper[i], 1e-5);
  }
  EXPECT_EQ(json["keyframes"], Json::array({"home"}));
  ASSERT_EQ(json["probes"].size(), 2u);
  EXPECT_EQ(json["probes"][0]["name"], "sensor_1");
  EXPECT_EQ(json["probes"][1], (Json{{"name", "at"}, {"kind", "framepos"}, {"dimension", 3}, {"unit", "m"}}));
  EXPECT_FALSE(json["notes"].empty());
}

TEST(InfoCommand, JointsAndActuators) {
  const std::string inertial =
      "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
  const TestFolder folder;
  const std::string file = folder.write(
      "arm.urdf",
      "<robot name='arm'><link name='base'/><link name='a'>" + inertial + "</link><link name='b'>" + inertial +
          "</link><joint name='lift' type='prismatic'><parent link='base'/><child link='a'/>"
          "<axis xyz='0 0 1'/><limit lower='0.2' upper='0.5' effort='90' velocity='2'/></joint>"
          "<joint name='turn' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>"
          "<transmission name='t'><joint name='turn'/><actuator name='motor'><mechanicalReduction>30"
          "</mechanicalReduction></actuator></transmission></robot>");
  const Invoked text = invoke({"info", file});
  ASSERT_EQ(text.status, 0) << text.err;
  for (const char* part : {"lift: slider, 0.2 .. 0.5 m, at most 2 m/s, at 0.2", "turn: hinge, no limits, at 0",
                           "motor of turn: force, gain 1, gear 30", "lift: position, stiffness ",
                           "at most 90, control 0.2 .. 0.5", "1 hinge, 1 slider"}) {
    EXPECT_NE(text.out.find(part), std::string::npos) << part << "\n" << text.out;
  }
  const Json json = Json::parse(invoke({"info", file, "--json"}).out);
  ASSERT_EQ(json["coordinates"].size(), 2u);
  EXPECT_EQ(json["coordinates"][0]["name"], "lift");
  EXPECT_EQ(json["coordinates"][0]["joint"], "slider");
  EXPECT_EQ(json["coordinates"][0]["unit"], "m");
  EXPECT_NEAR(json["coordinates"][0]["upper"].get<double>(), 0.5, 1e-6);
  EXPECT_TRUE(json["coordinates"][1]["upper"].is_null());
  ASSERT_EQ(json["actuators"].size(), 2u);
  EXPECT_EQ(json["actuators"][0]["coordinate"], "turn");
  EXPECT_TRUE(json["actuators"][0]["max_force"].is_null());
  EXPECT_EQ(json["actuators"][1]["name"], "lift");
  EXPECT_EQ(json["actuators"][1]["max_force"], 90);
}

TEST(InfoCommand, SoftBodies) {
  const TestFolder folder;
  const std::string file = folder.write("s.xml",
                                        "<mujoco><worldbody><flexcomp name='a' dim='3' count='2 2 3'/><flexcomp "
                                        "name='b' count='3 3 1'/></worldbody></mujoco>");
  EXPECT_NE(invoke({"info", file}).out.find("2: 21 particles, 12 tetrahedra, 8 triangles of cloth"), std::string::npos);
  const Json json = Json::parse(invoke({"info", file, "--json"}).out);
  EXPECT_EQ(json["soft_bodies"].size(), 2u);
  EXPECT_EQ(json["soft_bodies"][0]["name"], "a");
  EXPECT_EQ(json["particles"], 21);
  EXPECT_EQ(json["tetrahedra"], 12);
  EXPECT_EQ(json["cloth_triangles"], 8);
}

TEST(InfoCommand, AWorldOfNothingButAPlaneHasNoBounds) {
  const TestFolder folder;
  const std::string file =
      folder.write("p.xml", "<mujoco><worldbody><geom type='plane' size='1 1 1'/></worldbody></mujoco>");
  EXPECT_TRUE(Json::parse(invoke({"info", file, "--json"}).out)["lower"].is_null());
  EXPECT_NE(invoke({"info", file}).out.find("none"), std::string::npos);
}

TEST(InfoCommand, Scenes) { EXPECT_EQ(Json::parse(invoke({"info", "chain", "--json"}).out)["notes"].size(), 0u); }

TEST(InfoCommand, AMesh) {
  const TestFolder folder;
  const Json json = Json::parse(invoke({"info", folder.write("t.obj", tetra()), "--json"}).out);
  EXPECT_EQ(json["vertices"], 4);
  EXPECT_EQ(json["triangles"], 4);
  EXPECT_EQ(json["closed"], true);
  EXPECT_NEAR(json["volume"].get<double>(), 1, 1e-6);
  EXPECT_NEAR(json["area"].get<double>(), 1 + 3 + 1.5 + 3.5, 1e-5);
  EXPECT_EQ(json["hull_vertices"], 4);
  EXPECT_NEAR(json["hull_volume"].get<double>(), 1, 1e-5);
  EXPECT_EQ(json["upper"], Json::array({2.0, 1.0, 3.0}));
}

TEST(InfoCommand, AMeshWithAHole) {
  const TestFolder folder;
  const std::string open = tetra().substr(0, tetra().size() - 8), file = folder.write("open.OBJ", open);
  const Json json = Json::parse(invoke({"info", file, "--json"}).out);
  EXPECT_EQ(json["closed"], false);
  EXPECT_EQ(json["boundary_edges"], 3);
  EXPECT_TRUE(json["volume"].is_null());
  EXPECT_NE(invoke({"info", file}).out.find("3 edges of one triangle"), std::string::npos);
}

TEST(InfoCommand, AFlatMeshHasNoHull) {
  const TestFolder folder;
  const std::string file = folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\nf 2 4 3\n");
  const Json json = Json::parse(invoke({"info", file, "--json"}).out);
  EXPECT_TRUE(json["hull_vertices"].is_null());
  EXPECT_NE(json["hull_refused"], "");
  EXPECT_EQ(json["duplicate"], 1);
}

TEST(InfoCommand, Refuses) {
  const TestFolder folder;
  expectRefused({"info"}, {"file"});
  expectRefused({"info", folder.file("none.xml")}, {"none.xml", "no such file"});
  expectRefused({"info", folder.file("none.stl")}, {"none.stl", "no such file"});
  expectRefused({"info", folder.write("bad.obj", "v 0 0 nan\n")}, {"bad.obj:1", "v.z", "nan"});
  expectRefused({"info", folder.write("far.obj", "v 0 0 9e9\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}, {"far.obj"});
  expectRefused({"info", folder.write("zero.obj", "v 0 0 0\nf 1 1 1\n")}, {"zero.obj"});
  expectRefused({"info", folder.write("bad.xml", "<mujoco><body>")}, {"bad.xml:1"});
  expectRefused({"info", folder.write("t.obj", tetra()), "--keyframe", "home"}, {"--keyframe", "home"});
  expectRefused({"info", folder.write("m.xml", kRobot), "--floating"}, {"--floating"});
  expectRefused({"info", "pyramid3"}, {"pyramid30"});
}

TEST(InfoCommand, ASoftMesh) {
  const TestFolder folder;
  const std::string file = folder.write("one.msh",
                                        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 2 0 0\n3 0 1 0\n"
                                        "4 0 0 3\n$EndNodes\n$Elements\n2\n1 4 0 1 3 2 4\n2 15 0 1\n$EndElements\n");
  const Invoked text = invoke({"info", file});
  EXPECT_EQ(text.status, 0) << text.err;
  for (const char* part : {"soft mesh", "1, outside of 4 triangles", "1 inverted were turned", "0, 0, 0 to 2, 1, 3 m",
                           "1 m^3", "1 points are left out"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << "\n" << text.out;
  const Json json = Json::parse(invoke({"info", file, "--json"}).out);
  EXPECT_EQ(json["tetrahedra"], 1);
  EXPECT_EQ(json["inverted"], 1);
  EXPECT_NEAR(json["volume"].get<double>(), 1, 1e-6);
  EXPECT_TRUE(json["surface_volume"].is_null());
  EXPECT_EQ(json["notes"].size(), 1u);
  expectRefused({"info", file, "--soft", "0.1"}, {"--soft 0.1", "already"});
  expectRefused({"info", file, "--keyframe", "home"}, {"--keyframe home"});
}

TEST(InfoCommand, ASurfaceAsALattice) {
  const TestFolder folder;
  const std::string file = folder.write("t.obj", tetra());
  const Invoked text = invoke({"info", file, "--soft", "0.25"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("% of its volume"), std::string::npos) << text.out;
  const Json json = Json::parse(invoke({"info", file, "--soft", "0.25", "--json"}).out);
  EXPECT_NEAR(json["surface_volume"].get<double>(), 1, 1e-6);
  EXPECT_NEAR(json["volume"].get<double>(), 1, 0.2);
  EXPECT_GT(json["least_angle"].get<double>(), 0.2);
  expectRefused({"info", file, "--soft", "-1"}, {"SoftLatticeDef.cellSize = -1"});
  expectRefused({"info", "chain", "--soft", "1"}, {"--soft 1", "scene"});
}

}  // namespace
}  // namespace avbd::cli
