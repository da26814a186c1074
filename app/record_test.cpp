// `run --record`, `convert`, `play`: files, texts and refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/invoke.h"
#include "io/record/reader.h"
#include "io/record/softs.h"
#include "viewer/live.h"

namespace avbd::cli {
namespace {

constexpr const char* kBalls = R"(<mujoco model="balls"><worldbody><geom type="plane" size="9 9 1"/>
  <body name="ball, a" pos="0 0 0.3"><freejoint/><geom size="0.2"/></body>
  <body name="b" pos="0 1 4"><freejoint/><geom type="box" size="0.2 0.3 0.4"/></body></worldbody></mujoco>)";

void expectRefused(const std::vector<std::string>& args, const std::string& word) {
  const Invoked run = invoke(args);
  EXPECT_EQ(run.status, kExitBadInput) << run.out;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
}

TEST(RecordCommand, RunWritesARecordingThatEndsAsTheRunDid) {
  const TestFolder folder;
  const std::string scene = folder.write("balls.xml", kBalls), file = folder.file("a.avbd"), csv = folder.file("a.csv");
  const Invoked run = invoke({"run", scene, "--time", "1", "--record", file, "--poses", csv, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  RecordReader reader(file);
  EXPECT_TRUE(reader.info().finished);
  EXPECT_TRUE(reader.verify().empty());
  EXPECT_EQ(reader.head().title, "balls");
  EXPECT_EQ(reader.frameCount(), 61u);
  EXPECT_EQ(reader.times().back(), 1);
  const auto last = reader.frame(60);
  EXPECT_EQ(last.velocities.size(), reader.head().bodies.size());
  EXPECT_FALSE(last.contacts.empty()) << "the ball lies on the ground";
  const std::string hash = nlohmann::json::parse(run.out)["hash"];
  const auto& report = reader.head().report;
  EXPECT_TRUE(std::any_of(report.begin(), report.end(), [&](const auto& line) { return line.second == hash; }));
  bool began = false;
  for (uint64_t i = 0; i < 61; ++i)
    for (const RecordedEvent& e : reader.frame(i).events) began = began || e.kind == RecordedEventKind::TouchBegin;
  EXPECT_TRUE(began) << "the touch on the ground is an event";
}

TEST(RecordCommand, ConvertsToEverythingAtOnce) {
  const TestFolder folder;
  const std::string scene = folder.write("balls.xml", kBalls), file = folder.file("a.avbd");
  const std::string poses = folder.file("poses.csv");
  ASSERT_EQ(invoke({"run", scene, "--time", "0.5", "--record", file, "--poses", poses}).status, 0);
  const Invoked run = invoke({"convert", file, "--csv", folder.file("a.csv"), "--json", folder.file("a.json"), "--mcap",
                              folder.file("a.mcap"), "--html", folder.file("a.html")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_NE(run.out.find("31 frames of 3 bodies"), std::string::npos) << run.out;
  EXPECT_EQ(nlohmann::json::parse(folder.read("a.json"))["frames"].size(), 31u);
  EXPECT_EQ(folder.read("a.mcap").compare(0, 5, "\x89MCAP"), 0);
  EXPECT_NE(folder.read("a.html").find("</html>"), std::string::npos);
  // The same bits as --poses, but for the time's digits and the velocities behind.
  std::istringstream ours(folder.read("a.csv")), theirs(folder.read("poses.csv"));
  std::string a, b;
  std::getline(ours, a);
  std::getline(theirs, b);
  EXPECT_TRUE(a.starts_with(b));
  while (std::getline(theirs, b)) {
    ASSERT_TRUE(std::getline(ours, a));
    const std::string pose = b.substr(b.find(',')), here = a.substr(a.find(','));
    ASSERT_EQ(here.substr(0, pose.size()), pose);
  }
}

TEST(RecordCommand, SoftBodiesGoAlong) {
  const TestFolder folder;
  for (const auto& [scene, softs, points, time] :
       {std::tuple{"soft_cubes", 5u, 900u, "0.5"}, {"cloth_on_ball", 1u, 10'000u, "0.1"}}) {
    const std::string file = folder.file("a.avbd");
    const Invoked run = invoke({"run", scene, "--time", time, "--record", file});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find(" particles, "), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("largest strain "), std::string::npos) << run.out;
    RecordReader reader(file);
    EXPECT_TRUE(reader.verify().empty());
    ASSERT_EQ(reader.head().softs.size(), softs);
    EXPECT_EQ(pointCount(reader.head()), points);
    EXPECT_EQ(reader.head().softs[0].name, softs == 5 ? "cube0" : "cloth");
    EXPECT_EQ(reader.frame(0).poses.size(), reader.head().bodies.size());
    const Invoked replay = invoke({"replay", file, "--workers", "2"});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
    EXPECT_NE(invoke({"info", file}).out.find(std::to_string(softs) + ": "), std::string::npos);
  }
}

TEST(RecordCommand, WhereRunsOfSoftBodiesPartAPointIsNamed) {
  const TestFolder folder;
  const std::string file = folder.file("a.avbd");
  ASSERT_EQ(invoke({"run", "soft_cubes", "--time", "0.5", "--record", file}).status, 0);
  const Invoked replay = invoke({"replay", file, "--iterations", "2"});
  EXPECT_EQ(replay.status, kExitCheckFailed) << replay.err;
  EXPECT_NE(replay.out.find("first body: \"cube0_"), std::string::npos) << replay.out;
}

TEST(RecordCommand, DamageIsSaidAndTheRestConverted) {
  const TestFolder folder;
  const std::string scene = folder.write("balls.xml", kBalls), file = folder.file("a.avbd");
  ASSERT_EQ(invoke({"run", scene, "--time", "3", "--record", file}).status, 0);
  const std::string whole = folder.read("a.avbd");
  const std::string cut = folder.write("cut.avbd", whole.substr(0, whole.size() - 100));
  const Invoked run = invoke({"convert", cut, "--csv", folder.file("a.csv")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("the end is missing"), std::string::npos) << run.err;
  const auto lines = describeRecording(file);
  EXPECT_EQ(lines[0].second, "balls");
  EXPECT_NE(std::find(lines.begin(), lines.end(), std::pair<std::string, std::string>("run: scene", "balls")),
            lines.end());
  EXPECT_TRUE(isRecording(file));
  EXPECT_FALSE(isRecording(scene));
}

TEST(RecordCommand, Refusals) {
  const TestFolder folder;
  const std::string scene = folder.write("balls.xml", kBalls), file = folder.file("a.avbd");
  ASSERT_EQ(invoke({"run", scene, "--time", "0.1", "--record", file}).status, 0);
  const std::set<std::string> before = folder.names();
  expectRefused({"convert", file}, "nothing to write");
  expectRefused({"convert", scene, "--csv", folder.file("x.csv")}, "is no AVBD recording");
  expectRefused({"convert", folder.file("none.avbd"), "--csv", folder.file("x.csv")}, "No such file");
  expectRefused({"convert", file, "--csv", folder.file("no/x.csv")}, "--csv");
  expectRefused({"convert", file, "--csv", file}, "is the recording itself");
  expectRefused({"convert", file, "--csv", folder.file("x"), "--json", folder.file("x")}, "is named twice");
  expectRefused({"play", scene}, "is no AVBD recording");
  expectRefused({"play", file, "--port", "70000"}, "70000");
  expectRefused({"run", scene, "--record", folder.file("no/x.avbd")}, "--record");
  expectRefused({"run", scene, "--record", scene}, "scene itself");
  expectRefused({"run", scene, "--record", folder.file("x"), "--html", folder.file("x")}, "same file");
  expectRefused({"run", scene, "--time", "0.1", "--record", "/dev/full"}, "--record /dev/full");
  const LiveServer server(file, 0);
  expectRefused({"play", file, "--port", std::to_string(server.port())}, "Address already in use");
  EXPECT_EQ(folder.names(), before);
}

TEST(RecordCommand, PlayEndsInOrder) {
  const TestFolder folder;
  const std::string scene = folder.write("balls.xml", kBalls), file = folder.file("a.avbd");
  ASSERT_EQ(invoke({"run", scene, "--time", "0.1", "--record", file}).status, 0);
  std::thread stop([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    requestStop();
  });
  const Invoked run = invoke({"play", file, "--port", "0"});
  stop.join();
  EXPECT_EQ(run.status, kExitDone) << run.err;
  EXPECT_NE(run.out.find("http://127.0.0.1:"), std::string::npos);
}

}  // namespace
}  // namespace avbd::cli
