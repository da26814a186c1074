// `avbd run` on URDF files: how they are told apart, and their options.
#include <gtest/gtest.h>

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
  expectRefused({"run", folder.write("r.urdf.xacro", "<robot><xacro:a/></robot>")}, "xacro");
}

}  // namespace
}  // namespace avbd::cli
