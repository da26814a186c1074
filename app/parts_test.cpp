// The command line's small parts: output files, sampling, CSV fields, the recording.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/failure.h"
#include "app/invoke.h"
#include "app/number_text.h"
#include "app/output_file.h"
#include "app/poses_csv.h"
#include "app/recorder.h"
#include "app/sampler.h"
#include "scenes/scene.h"

namespace avbd::cli {
namespace {

TEST(OutputFile, AppearsOnlyWhenComplete) {
  const TestFolder folder;
  {
    OutputFile file("--html", folder.file("a"));
    file.stream() << "text";
    file.stream().flush();
    EXPECT_FALSE(folder.names().contains("a"));
    EXPECT_EQ(folder.names().size(), 1u);
    file.finish();
    file.commit();
    EXPECT_EQ(folder.names(), std::set<std::string>{"a"});
  }
  EXPECT_EQ(folder.read("a"), "text");
  { OutputFile dropped("--html", folder.file("a")); }
  EXPECT_EQ(folder.read("a"), "text") << "what was there stays until the new file is complete";
  EXPECT_EQ(folder.names(), std::set<std::string>{"a"});
  EXPECT_THROW(OutputFile("--html", folder.file("none/a")), BadInput);
}

std::vector<int64_t> sampled(double fps, double dt, int64_t steps) {
  Sampler sampler(fps, dt);
  std::vector<int64_t> due;
  for (int64_t i = 0; i <= steps; ++i)
    if (sampler.due(i)) due.push_back(i);
  return due;
}

TEST(Sampler, TakesTheNearestSteps) {
  EXPECT_EQ(sampled(60, 1.0 / 60, 3), (std::vector<int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(sampled(1000, 1.0 / 60, 3), (std::vector<int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(sampled(30, 1.0 / 60, 6), (std::vector<int64_t>{0, 2, 4, 6}));
  EXPECT_EQ(sampled(60, 0.002, 30), (std::vector<int64_t>{0, 8, 17, 25}));
  EXPECT_EQ(sampled(1e-9, 0.002, 30), std::vector<int64_t>{0});
}

TEST(Numbers, ReadBackAsTheyWere) {
  std::string text;
  appendExact(text, 0.1f);
  appendExact(text += ' ', 0.1);
  appendExact(text += ' ', 1.0 / 3);
  EXPECT_EQ(text, "0.1 0.1 0.3333333333333333");
  EXPECT_EQ(digits(0.1 + 0.2, 12), "0.3");
  EXPECT_EQ(digits(1234.5, 3), "1.23e+03");
}

TEST(Csv, QuotesOnlyWhatNeedsIt) {
  EXPECT_EQ(csvField("link_1"), "link_1");
  EXPECT_EQ(csvField("a,b"), "\"a,b\"");
  EXPECT_EQ(csvField("say \"a\""), "\"say \"\"a\"\"\"");
  EXPECT_EQ(csvField("two\nlines"), "\"two\nlines\"");
}

TEST(NonFinite, NamesBodyAndStage) {
  const Model model = scenes::find("chain")->make({});
  const NamedBody& body = model.bodies[3];
  const NonFiniteError error("solve_blocks", body.id.index, body.id.generation);
  EXPECT_EQ(std::string(nonFiniteRun(model, error, 7, 0.07).what()),
            "step 7 (time 0.07 s): body \"" + body.name + "\" left the finite numbers in stage solve_blocks");
}

TEST(Recorder, KeepsTheModelsOrderAndTheStrongestContacts) {
  const scenes::Scene* scene = scenes::find("pyramid30");
  ASSERT_NE(scene, nullptr);
  Model model = scene->make({});
  std::reverse(model.bodies.begin(), model.bodies.end());
  Recorder recorder(model, 1, 1);
  for (int i = 0; i < 3; ++i) {
    model.world.step(1.0f / 60);
    recorder.watch(model.world);
  }
  const RecordedFrame frame = recorder.frame(model, 0.05);
  const Recording& r = recorder.head();
  ASSERT_EQ(r.bodies.size(), model.bodies.size());
  ASSERT_EQ(r.shapes.size(), model.world.shapeCount());
  for (size_t i = 0; i < r.bodies.size(); ++i) EXPECT_EQ(r.bodies[i].name, model.bodies[i].name);
  for (const RecordedShape& s : r.shapes)
    EXPECT_EQ(std::get<Box>(s.geometry).x == 100, r.bodies[s.body].name == "ground");
  ASSERT_EQ(frame.poses.size(), r.bodies.size());
  for (size_t i = 0; i < r.bodies.size(); ++i)
    EXPECT_EQ(frame.poses[i], model.world.pose(model.bodies[i].id)) << r.bodies[i].name;
  EXPECT_EQ(frame.contacts.size(), 1000u);
  EXPECT_GT(model.world.report().points, 1500u);
  float strongest = 0;
  for (const Contact& c : model.world.contacts())
    for (int i = 0; i < c.pointCount; ++i)
      strongest = std::max(strongest, c.points[static_cast<size_t>(i)].normalForce);
  float kept = 0;
  for (const RecordedContact& c : frame.contacts) kept = std::max(kept, length(c.force));
  EXPECT_GE(kept, strongest);
  EXPECT_LT(frame.penetrationMax, 0.05) << "poses belong to their shapes";
}

}  // namespace
}  // namespace avbd::cli
