// `run --live` and what a live page is sent: ports that are taken, files that change under the page.
#include "viewer/live.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <thread>

#include "app/invoke.h"
#include "io/record/sample.h"
#include "io/record/writer.h"
#include "viewer/live_feed.h"

namespace avbd::cli {
namespace {

using record::Folder;
using record::sampleFrame;
using record::sampleHead;

constexpr const char* kBall = R"(<mujoco model="ball"><worldbody><geom type="plane" size="9 9 1"/>
  <body pos="0 0 0.3"><freejoint/><geom size="0.2"/></body></worldbody></mujoco>)";

void writeFrames(const std::filesystem::path& path, size_t frames, size_t first = 0) {
  const Recording head = sampleHead();
  RecordWriter writer(path, head, {.framesPerChunk = 2});
  for (size_t i = 0; i < frames; ++i) writer.add(sampleFrame(head, first + i));
  writer.finish({{"hash", "12ab"}});
}

TEST(Live, APortThatIsTakenCostsNoRecording) {
  const TestFolder folder;
  const std::string scene = folder.write("ball.xml", kBall), file = folder.file("good.avbd");
  ASSERT_EQ(invoke({"run", scene, "--time", "0.1", "--record", file}).status, 0);
  const std::string good = folder.read("good.avbd");
  const std::set<std::string> before = folder.names();
  const LiveServer server(file, 0);
  const std::string port = std::to_string(server.port());
  setenv("TMPDIR", folder.file("").c_str(), 1);
  const Invoked kept = invoke({"run", scene, "--time", "0.1", "--record", file, "--live", "--port", port});
  const Invoked temporary = invoke({"run", scene, "--time", "0.1", "--live", "--port", port});
  const Invoked unwritable =
      invoke({"run", scene, "--time", "0.1", "--live", "--port", "0", "--html", folder.file("no/x.html")});
  unsetenv("TMPDIR");
  for (const Invoked& run : {kept, temporary}) {
    EXPECT_EQ(run.status, kExitBadInput);
    EXPECT_NE(run.err.find("Address already in use"), std::string::npos) << run.err;
  }
  EXPECT_EQ(unwritable.status, kExitBadInput);
  EXPECT_EQ(folder.read("good.avbd"), good);
  EXPECT_EQ(folder.names(), before);
}

TEST(Live, TheTemporaryRecordingVanishesWithTheRun) {
  const TestFolder folder;
  const std::string scene = folder.write("ball.xml", kBall);
  const std::set<std::string> before = folder.names();
  setenv("TMPDIR", folder.file("").c_str(), 1);
  std::set<std::string> during;
  std::thread stop([&] {
    for (int i = 0; i < 500 && during.size() <= before.size(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      during = folder.names();
    }
    requestStop();
  });
  const Invoked run = invoke({"run", scene, "--time", "30", "--live", "--port", "0"});
  stop.join();
  unsetenv("TMPDIR");
  EXPECT_EQ(run.status, kExitStopped) << run.err;
  EXPECT_EQ(during.size(), before.size() + 1);
  EXPECT_EQ(folder.names(), before);
}

TEST(Live, AFileThatIsBegunAnewVoidsWhatWasSent) {
  const Folder folder;
  const auto path = folder.file("a.avbd");
  writeFrames(path, 6);
  live::Feed feed(path);
  EXPECT_TRUE(feed.update());
  ASSERT_EQ(feed.known(), 6u);
  EXPECT_TRUE(feed.finished());
  ASSERT_NE(feed.head(), nullptr);
  // Longer than before, but its bodies cannot be read: nothing of the old one may be told any more.
  writeFrames(folder.file("b.avbd"), 40, 3);
  std::string bytes = Folder::read(folder.file("b.avbd"));
  const size_t body = bytes.find("BODY");
  ASSERT_NE(body, std::string::npos);
  bytes[body + 30] ^= 1;
  folder.write("a.avbd", bytes);
  EXPECT_FALSE(feed.update());
  EXPECT_EQ(feed.known(), 0u);
  EXPECT_EQ(feed.head(), nullptr);
  EXPECT_EQ(feed.figures(0)->size(), 16u);
  EXPECT_THROW(feed.update(), FileError);
  EXPECT_EQ(feed.figures(0)->size(), 16u);
  bytes[body + 30] ^= 1;
  folder.write("a.avbd", bytes);
  EXPECT_TRUE(feed.update());
  EXPECT_EQ(feed.known(), 40u);
  double first = -1;
  std::memcpy(&first, feed.figures(0)->data() + 16, sizeof first);
  EXPECT_EQ(first, 3.0 / 60);
}

TEST(Live, TheReportComesWhenTheRunHasEnded) {
  const Folder folder;
  const Recording head = sampleHead();
  RecordWriter writer(folder.file("a.avbd"), head, {.framesPerChunk = 1});
  writer.add(sampleFrame(head, 0));
  live::Feed feed(folder.file("a.avbd"));
  feed.update();
  ASSERT_NE(feed.head(), nullptr);
  EXPECT_FALSE(feed.finished());
  writer.finish({{"ha\"sh", "12ab"}});
  feed.update();
  EXPECT_TRUE(feed.finished());
  const live::Message report = feed.report();
  EXPECT_EQ(std::string(report->begin() + 4, report->end()), R"([["ha\"sh","12ab"]])");
}

}  // namespace
}  // namespace avbd::cli
