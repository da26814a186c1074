// What the command line refuses: status 2, one message, nothing written.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/invoke.h"

namespace avbd::cli {
namespace {

constexpr const char* kBall =
    "<mujoco><worldbody><body name='ball' pos='0 0 9'><freejoint/><geom size='1'/></body></worldbody></mujoco>";

void expectRefused(const std::vector<std::string>& args, const std::vector<std::string>& words) {
  const Invoked run = invoke(args);
  std::string all;
  for (const std::string& a : args) all += a + " ";
  EXPECT_EQ(run.status, kExitBadInput) << all << run.out;
  EXPECT_EQ(run.out, "") << all;
  EXPECT_EQ(run.err.rfind("avbd: error: ", 0), 0u) << all << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << all << run.err;
  for (const std::string& word : words) EXPECT_NE(run.err.find(word), std::string::npos) << all << run.err;
}

TEST(BadInput, Grammar) {
  expectRefused({}, {"subcommand"});
  expectRefused({"fly"}, {"fly"});
  expectRefused({"run"}, {"scene"});
  expectRefused({"run", "chain", "more"}, {"more"});
  expectRefused({"run", "chain", "--wat"}, {"--wat"});
  expectRefused({"run", "chain", "--dt"}, {"--dt"});
  expectRefused({"run", "chain", "--dt", "fast"}, {"--dt", "fast"});
  expectRefused({"run", "chain", "--dt", "0.01", "--dt", "0.02"}, {"--dt"});
  expectRefused({"run", "chain", "--solver", "magic"}, {"--solver", "magic"});
  expectRefused({"run", "chain", "--simd", "3"}, {"--simd", "3"});
  expectRefused({"bench"}, {"scene"});
  expectRefused({"bench", "chain", "--peer", "newton"}, {"newton"});
  expectRefused({"scenes", "more"}, {"more"});
}

TEST(BadInput, Numbers) {
  for (const char* dt : {"nan", "inf", "-inf", "0", "-0.01", "1.5", "1e9", "1e-60"})
    expectRefused({"run", "chain", "--dt", dt}, {"--dt", "> 0 and at most 1 s"});
  for (const char* time : {"nan", "inf", "-1"})
    expectRefused({"run", "chain", "--time", time}, {"--time", "finite and >= 0"});
  expectRefused({"run", "chain", "--time", "1e300"}, {"--time", "at most 1e8"});
  expectRefused({"run", "chain", "--dt", "1e-9"}, {"steps", "at most 1e8"});
  for (const char* fps : {"nan", "0", "-5", "1e30"})
    expectRefused({"run", "chain", "--poses", "/dev/null", "--fps", fps}, {"--fps"});
  expectRefused({"run", "chain", "--iterations", "0"}, {"iterations", "0", "1"});
  expectRefused({"run", "chain", "--substeps", "100000"}, {"substeps", "1000"});
  expectRefused({"run", "chain", "--workers", "-3"}, {"workers", "-3"});
  expectRefused({"run", "chain", "--workers", "99999999999999"}, {"workers"});
  expectRefused({"run", "chain", "--krylov", "-1"}, {"krylov", "-1"});
  expectRefused({"verify", "rest", "--iterations", "0"}, {"iterations"});
  expectRefused({"bench", "chain", "--substeps", "0"}, {"substeps"});
}

TEST(BadInput, NamesListWhatIsNear) {
  expectRefused({"run", "pyramid3"}, {"pyramid3", "pyramid30", "avbd scenes"});
  expectRefused({"bench", "chian"}, {"chian", "chain"});
  expectRefused({"bench", "chain", "nonsense_that_is_near_nothing"}, {"nonsense"});
  expectRefused({"verify", "towr10"}, {"towr10", "tower10"});
  expectRefused({"verify", "rest", "Q"}, {"\"Q\""});
  expectRefused({"verify", ""}, {"\"\""});
  expectRefused({"run", "chain", "--keyframe", "home"}, {"keyframe", "home"});
}

TEST(BadInput, Files) {
  const TestFolder folder;
  const std::string html = folder.file("out.html"), csv = folder.file("out.csv");
  const std::string broken = folder.write("broken.xml", "<mujoco><worldbody><body>");
  const std::string ball = folder.write("ball.xml", kBall);
  const std::string negative = folder.write(
      "negative.xml", "<mujoco>\n<worldbody><body><freejoint/><geom size='-1'/></body></worldbody></mujoco>");
  const std::set<std::string> before = folder.names();
  expectRefused({"run", folder.file("none.xml"), "--html", html, "--poses", csv}, {"none.xml"});
  expectRefused({"run", broken, "--html", html, "--poses", csv}, {"broken.xml"});
  expectRefused({"run", negative, "--html", html}, {"negative.xml:2", "size"});
  expectRefused({"run", folder.file("."), "--html", html}, {});
  expectRefused({"run", ball, "--keyframe", "home", "--html", html}, {"home"});
  expectRefused({"run", ball, "--dt", "0", "--html", html, "--poses", csv}, {"--dt"});
  expectRefused({"run", std::string("line\nbreak.xml")}, {"break.xml"});
  EXPECT_EQ(folder.names(), before);
}

TEST(BadInput, OutputsThatCannotBeWritten) {
  const TestFolder folder;
  const std::string ball = folder.write("ball.xml", kBall);
  const std::string csv = folder.file("out.csv"), none = folder.file("no/such/out.html");
  expectRefused({"run", ball, "--html", none, "--poses", csv}, {"--html", "no/such/out.html", "No such file"});
  expectRefused({"run", ball, "--html", folder.file(".")}, {"--html"});
  expectRefused({"run", ball, "--poses", csv, "--html", csv}, {"same file"});
  expectRefused({"run", ball, "--poses", ball}, {"scene itself"});
  expectRefused({"run", ball, "--time", "0.1", "--poses", "/dev/full"}, {"--poses", "/dev/full"});
  expectRefused({"run", ball, "--time", "0.1", "--html", "/dev/full", "--poses", csv}, {"--html", "/dev/full"});
  EXPECT_EQ(folder.read("ball.xml"), kBall);
  EXPECT_EQ(folder.names(), std::set<std::string>{"ball.xml"});
}

TEST(BadInput, OutputStreamThatFails) {
  std::ostringstream out, err;
  out.setstate(std::ios::badbit);
  EXPECT_EQ(runCommandLine({"scenes"}, out, err), kExitBadInput);
  EXPECT_NE(err.str().find("standard output"), std::string::npos);
}

}  // namespace
}  // namespace avbd::cli
