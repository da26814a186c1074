// `replay`: a recorded run goes again as it went, and where it does not, it says where.
#include <gtest/gtest.h>

#include "app/invoke.h"
#include "io/record/run_again.h"

namespace avbd::cli {
namespace {

constexpr const char* kDrop = R"(<mujoco model="drop"><option timestep="0.005"/><worldbody>
  <geom type="plane" size="9 9 1"/>
  <body name="low" pos="0 0 0.3"><freejoint/><geom type="box" size="0.2 0.2 0.2"/></body>
  <body name="high" pos="0.05 0 0.8"><freejoint/><geom type="box" size="0.2 0.2 0.2"/></body>
  <body name="arm" pos="2 0 1"><joint name="swing" axis="0 1 0"/><geom size="0.1" pos="0.5 0 0"/></body></worldbody>
  <actuator><motor name="drive" joint="swing" ctrlrange="-9 9"/></actuator></mujoco>)";

TEST(Replay, ASceneGoesAgainAsItWent) {
  const TestFolder folder;
  const std::string file = folder.file("a.avbd");
  ASSERT_EQ(invoke({"run", "tower10", "--time", "0.5", "--record", file, "--substeps", "2"}).status, 0);
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{}, {"--workers", "2"}, {"--simd", "1"}}) {
    std::vector<std::string> args{"replay", file};
    args.insert(args.end(), options.begin(), options.end());
    const Invoked replay = invoke(args);
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
    EXPECT_EQ(replay.out, "30 steps, each as it was recorded\n");
  }
}

TEST(Replay, AModelWithItsControlScriptToo) {
  const TestFolder folder;
  const std::string scene = folder.write("drop.xml", kDrop), file = folder.file("a.avbd");
  const std::string control = folder.write("c.csv", "0,drive,1\n0.2,drive,-2\n");
  ASSERT_EQ(invoke({"run", scene, "--time", "0.6", "--record", file, "--control", control}).status, 0);
  folder.write("c.csv", "");  // the recording has its own
  const RunAgain recorded = readRunAgain(file);
  ASSERT_EQ(recorded.steps.size(), 121u) << "each step, though frames are fewer";
  const Invoked replay = invoke({"replay", file});
  EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
  EXPECT_EQ(replay.out, "120 steps, each as it was recorded\n");

  folder.write("drop.xml", std::string(kDrop) + "\n");
  const Invoked changed = invoke({"replay", file});
  EXPECT_EQ(changed.status, kExitBadInput);
  EXPECT_NE(changed.err.find("is not as it was"), std::string::npos) << changed.err;
}

TEST(Replay, WhereTheRunsPartItNamesStepStageAndBody) {
  const TestFolder folder;
  const std::string scene = folder.write("drop.xml", kDrop), file = folder.file("a.avbd");
  ASSERT_EQ(invoke({"run", scene, "--time", "0.6", "--record", file}).status, 0);
  const Invoked replay = invoke({"replay", file, "--iterations", "2"});
  EXPECT_EQ(replay.status, kExitCheckFailed) << replay.err;
  const std::string& out = replay.out;
  EXPECT_NE(out.find("parts at step "), std::string::npos) << out;
  EXPECT_NE(out.find("in stage "), std::string::npos) << out;
  EXPECT_NE(out.find("first body: \""), std::string::npos) << out;
  EXPECT_NE(out.find(" m/s"), std::string::npos) << out;
  EXPECT_EQ(out.find("\"world\""), std::string::npos) << out;
}

TEST(Replay, WhatHoldsNoRunIsRefused) {
  const TestFolder folder;
  const Invoked none = invoke({"replay", folder.file("none.avbd")});
  EXPECT_EQ(none.status, kExitBadInput);
  const Invoked text = invoke({"replay", folder.write("text.avbd", "no recording at all, but long enough to be one")});
  EXPECT_EQ(text.status, kExitBadInput);
  EXPECT_EQ(std::count(text.err.begin(), text.err.end(), '\n'), 1) << text.err;
}

}  // namespace
}  // namespace avbd::cli
