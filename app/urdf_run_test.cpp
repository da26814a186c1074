// `avbd run` on URDF files: how they are told apart, and their options.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/invoke.h"

namespace avbd::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCrate = R"(<?xml version="1.0"?>
<!-- <mujoco> it is not -->
<robot name="crate">
  <link name="crate">
    <inertial><mass value="2"/><inertia ixx="0.3" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.3"/></inertial>
    <collision><geometry><box size="1 1 1"/></geometry></collision>
  </link>
</robot>
)";

constexpr const char* kMeshed =
    "<robot name='m'><link name='a'><collision><geometry><mesh "
    "filename='package://parts/a.obj'/></geometry></collision>"
    "</link></robot>";
constexpr const char* kWedge = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

Json reportOf(const std::vector<std::string>& args) {
  const Invoked run = invoke(args);
  EXPECT_EQ(run.status, kExitDone) << run.err;
  return run.status == kExitDone ? Json::parse(run.out) : Json();
}

TEST(RunUrdf, TheRootStandsStillUnlessFloating) {
  const TestFolder folder;
  const std::string file = folder.write("crate.urdf", kCrate);
  const Json fixed = reportOf({"run", file, "--time", "0.2", "--json"});
  EXPECT_EQ(fixed["scene"], "crate");
  EXPECT_EQ(fixed["bodies"], 0);
  EXPECT_EQ(fixed["statics"], 1);
  const Json floating = reportOf({"run", file, "--time", "1", "--json", "--floating"});
  EXPECT_EQ(floating["bodies"], 1);
  EXPECT_EQ(floating["statics"], 1) << "the ground";
  EXPECT_EQ(floating["contact_points"], 4) << "it stands there";
  EXPECT_LT(floating["kinetic_energy"], 1e-4);
}

TEST(RunUrdf, AnyFileWhoseRootIsARobot) {
  const TestFolder folder;
  EXPECT_EQ(reportOf({"run", folder.write("crate.xml", kCrate), "--time", "0.1", "--json"})["scene"], "crate");
}

TEST(RunUrdf, WritesAPage) {
  const TestFolder folder;
  const Invoked run = invoke(
      {"run", folder.write("crate.urdf", kCrate), "--floating", "--time", "0.2", "--html", folder.file("page.html")});
  ASSERT_EQ(run.status, kExitDone) << run.err;
  EXPECT_NE(folder.read("page.html").find("crate"), std::string::npos);
}

TEST(RunUrdf, PackagesByNameAndByFolder) {
  const TestFolder folder, parts;
  const std::string file = folder.write("m.urdf", kMeshed);
  parts.write("a.obj", kWedge);
  parts.write("package.xml", "<package><name>parts</name></package>");
  const std::string where = std::filesystem::path(parts.file("a.obj")).parent_path().string();
  for (const std::string& package : {"parts=" + where, where}) {
    EXPECT_EQ(reportOf({"run", file, "--time", "0.1", "--json", "--package", package})["shapes"], 1) << package;
  }
  const Invoked none = invoke({"run", file});
  EXPECT_EQ(none.status, kExitBadInput);
  EXPECT_NE(none.err.find("package://parts/a.obj"), std::string::npos) << none.err;
  EXPECT_EQ(reportOf({"run", file, "--time", "0.1", "--json", "--skip-bad-meshes"})["shapes"], 0);
}

// A rod that turns about a horizontal hinge at its end.
constexpr const char* kRod = R"(<robot name="rod"><link name="base"/><link name="rod"><inertial><origin xyz="0.5 0 0"/>
  <mass value="1"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.08" iyz="0" izz="0.08"/></inertial></link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
  <limit lower="-1" upper="1.2" effort="50" velocity="20"/></joint></robot>)";

// Of the rod's quaternion at the end, which turns about y.
double angleAtEnd(const TestFolder& folder, std::vector<std::string> args) {
  args.insert(args.begin(), {"run", folder.write("rod.urdf", kRod)});
  for (const char* more : {"--no-report", "--fps", "1", "--poses"}) args.emplace_back(more);
  args.push_back(folder.file("poses.csv"));
  const Invoked run = invoke(args);
  EXPECT_EQ(run.status, kExitDone) << run.err;
  const std::string csv = folder.read("poses.csv");
  const size_t line = csv.rfind(",rod,");
  if (run.status != kExitDone || line == std::string::npos) return -9;
  std::istringstream in(csv.substr(line + 5));
  std::vector<double> numbers;
  for (std::string field; std::getline(in, field, ',');) numbers.push_back(std::stod(field));
  return 2 * std::atan2(numbers.at(5), numbers.at(3));
}

TEST(RunUrdf, HoldsItsJointsUnlessLimp) {
  const TestFolder folder;
  EXPECT_NEAR(angleAtEnd(folder, {"--time", "2"}), 0, 0.01);
  EXPECT_NEAR(angleAtEnd(folder, {"--time", "2", "--limp"}), 1.2, 0.02);
}

TEST(RunUrdf, ActuatorsFollowAScript) {
  const TestFolder folder;
  const std::string script =
      folder.write("c.csv", "# positions\ntime,actuator,value\n0.5, hinge, 0.7\r\n\n1.5,0,-0.4\n");
  EXPECT_NEAR(angleAtEnd(folder, {"--time", "1", "--control", script}), 0.7, 0.01);
  EXPECT_NEAR(angleAtEnd(folder, {"--time", "3", "--control", script}), -0.4, 0.01);
  // A limp one takes torques: 0.5 m x 9.81 N holds it up, and the least more lifts it to its stop.
  const std::string torque = folder.write("t.csv", "0,hinge,-8\n");
  EXPECT_NEAR(angleAtEnd(folder, {"--time", "3", "--limp", "--control", torque}), -1, 0.02);
}

TEST(RunUrdf, ReportsHowJointsHold) {
  const TestFolder folder;
  const Json report = reportOf({"run", folder.write("rod.urdf", kRod), "--time", "3", "--limp", "--json"});
  EXPECT_LT(report["joint_gap_max"], 1e-3);
  EXPECT_LT(report["joint_angle_max"], 1e-3);
  EXPECT_EQ(report["limit_excess_max"], 0);
  EXPECT_LT(report["limit_excess_angle_max"], 0.01);
}

void expectRefused(const std::vector<std::string>& args, const std::string& words) {
  const Invoked run = invoke(args);
  EXPECT_EQ(run.status, kExitBadInput) << run.out;
  EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
}

TEST(RunUrdf, RefusesWhatDoesNotFit) {
  const TestFolder folder;
  const std::string file = folder.write("crate.urdf", kCrate);
  expectRefused({"run", "chain", "--floating"}, "--floating: scene chain is not a URDF file");
  expectRefused({"run", folder.write("b.xml", "<mujoco/>"), "--package", "."}, "--package");
  expectRefused({"run", file, "--keyframe", "home"}, "--keyframe home");
  expectRefused({"run", file, "--package", "x=/no/such/folder"}, "--package x=/no/such/folder");
  expectRefused({"run", file, "--package", "=."}, "--package =.");
  expectRefused({"run", folder.file("none.urdf")}, "no such file");
  expectRefused({"run", "chain", "--limp"}, "--limp: scene chain is not a URDF file");
  expectRefused({"run", "chain", "--no-self-collision"}, "--no-self-collision: scene chain is not a URDF file");
  expectRefused({"run", file, "--control", folder.file("none.csv")}, "--control " + folder.file("none.csv"));
  const std::string script = folder.write("c.csv", "0,hinge,1\n");
  expectRefused({"run", file, "--control", script}, "there are no actuators to control");
  const std::string rod = folder.write("rod.urdf", kRod);
  expectRefused({"run", rod, "--control", folder.write("d.csv", "0,hnge,1\n")},
                "d.csv:1: column 2 (actuator) = \"hnge\"");
  expectRefused({"run", rod, "--control", script, "--poses", script}, "is the file of --control");
  expectRefused({"run", folder.write("r.urdf.xacro", "<robot><xacro:a/></robot>")}, "xacro");
}

}  // namespace
}  // namespace avbd::cli
