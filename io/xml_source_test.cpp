// Files that include files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "io/mjcf_parse.h"

namespace avbd::mjcf {
namespace {

namespace fs = std::filesystem;

class Includes : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("avbd_includes_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "sub");
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  std::string messageOf(const fs::path& file) {
    try {
      parseFile(file);
    } catch (const FileError& error) {
      return error.what();
    }
    return "accepted";
  }
  void expectRefused(const fs::path& file, const std::string& part) {
    const std::string message = messageOf(file);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }

  fs::path folder_;
};

TEST_F(Includes, StandForTheChildrenOfTheirRoot) {
  write("sub/body.xml", "<mujocoinclude>\n<geom size='1' name='in'/>\n<body name='b'/></mujocoinclude>");
  write("option.xml", "<mujoco><option timestep='.5'/><include file='sub/world.xml'/></mujoco>");
  write("sub/world.xml", "<mujoco><worldbody><geom size='2' name='w'/></worldbody></mujoco>");
  const Description d = parseFile(
      write("main.xml",
            "<mujoco><include file='option.xml'/><worldbody><geom name='first' size='1'/><include file='sub/body.xml'/>"
            "<geom name='last' size='1'/></worldbody></mujoco>"));
  EXPECT_EQ(d.dt, 0.5);
  ASSERT_EQ(d.bodies.size(), 2u);
  ASSERT_EQ(d.bodies[0].geoms.size(), 4u);
  EXPECT_EQ(d.bodies[0].geoms[0].name, "w");
  EXPECT_EQ(d.bodies[0].geoms[1].name, "first");
  EXPECT_EQ(d.bodies[0].geoms[2].name, "in");
  EXPECT_EQ(d.bodies[0].geoms[3].name, "last");
}

TEST_F(Includes, MessagesNameTheIncludedFile) {
  write("part.xml", "<mujoco>\n\n<option timestep='-1'/></mujoco>");
  expectRefused(write("main.xml", "<mujoco><include file='part.xml'/></mujoco>"),
                (folder_ / "part.xml").string() + ":3: option: timestep = \"-1\"");
}

TEST_F(Includes, BrokenXmlIsNamedWithItsLine) {
  write("part.xml", "<mujoco>\n<a></mujoco>");
  expectRefused(write("main.xml", "<mujoco><include file='part.xml'/></mujoco>"),
                (folder_ / "part.xml").string() + ":2: ");
}

TEST_F(Includes, Refused) {
  const auto including = [&](const std::string& file) {
    return write("main.xml", "<mujoco>\n<include file='" + file + "'/></mujoco>");
  };
  expectRefused(including("main.xml"), "main.xml:2: include: file = \"main.xml\": the file includes itself");
  expectRefused(including("./sub/../main.xml"), "includes itself");
  expectRefused(including("none.xml"), "file = \"none.xml\": no such file");
  expectRefused(including("sub"), "not a regular file");
  expectRefused(including("/dev/zero"), "not a regular file");
  expectRefused(including(""), "file is missing");
  expectRefused(including(std::string(100000, 'a')), "no such file");
  write("empty.xml", "");
  expectRefused(including("empty.xml"), "No document element");
  write("back.xml", "<mujoco><include file='main.xml'/></mujoco>");
  expectRefused(including("back.xml"), "the main file cannot be included");
  write("ping.xml", "<mujoco><include file='pong.xml'/></mujoco>");
  write("pong.xml", "<mujoco><include file='ping.xml'/></mujoco>");
  expectRefused(including("ping.xml"), "included more than once");
  write("one.xml", "<mujoco/>");
  expectRefused(write("main.xml", "<mujoco><include file='one.xml'/><include file='one.xml'/></mujoco>"),
                "included more than once");
}

TEST_F(Includes, FromAFolderAbove) {
  write("one.xml", "<mujoco><option timestep='.25'/></mujoco>");
  write("sub/main.xml", "<mujoco><include file='../one.xml'/></mujoco>");
  EXPECT_EQ(parseFile(folder_ / "sub/main.xml").dt, 0.25);
}

TEST_F(Includes, MainFilesThatAreNone) {
  expectRefused(folder_ / "none.xml", "none.xml: no such file");
  expectRefused(folder_, "not a regular file");
  expectRefused("/dev/zero", "/dev/zero: not a regular file");
  expectRefused("", ": no such file");
  const fs::path large = write("large.xml", "<mujoco/>");
  fs::resize_file(large, (64u << 20) + 1);
  expectRefused(large, "large.xml: larger than 64 MiB");
  // All files together count.
  const fs::path half = write("half.xml", "<mujoco/>");
  fs::resize_file(half, 64u << 20);
  expectRefused(write("main.xml", "<mujoco><include file='half.xml'/></mujoco>"), "larger than 64 MiB");
}

}  // namespace
}  // namespace avbd::mjcf
