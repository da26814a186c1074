// `avbd run --trace`: the file is a trace whose stages lie within their steps and bear the names of the enum.
#include "app/trace.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "app/invoke.h"

namespace avbd::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Slices {
  std::vector<Json> steps, stages;
  std::map<std::string, std::vector<double>> counters;
};

Slices slicesOf(const std::string& text) {
  Slices found;
  const Json parsed = Json::parse(text);
  for (const Json& e : parsed["traceEvents"]) {
    if (e["ph"] == "X") (e["cat"] == "step" ? found.steps : found.stages).push_back(e);
    if (e["ph"] == "C") found.counters[e["name"]].push_back(e["args"].begin().value());
  }
  return found;
}

double begins(const Json& e) { return e["ts"]; }
double ends(const Json& e) { return begins(e) + e["dur"].get<double>(); }

void expectNested(const Slices& found) {
  ASSERT_EQ(found.stages.size(), found.steps.size() * kStageCount);
  for (size_t i = 0; i < found.stages.size(); ++i) {
    const Json &stage = found.stages[i], &step = found.steps[i / kStageCount];
    EXPECT_EQ(stage["name"], stageName(static_cast<Stage>(i % kStageCount)));
    EXPECT_EQ(stage["tid"], step["tid"]);
    // Times are written to a nanosecond.
    EXPECT_GE(begins(stage), begins(step) - 0.002);
    EXPECT_LE(ends(stage), ends(step) + 0.02);
    if (i % kStageCount != 0) {
      EXPECT_GE(begins(stage), ends(found.stages[i - 1]) - 0.002);
    }
  }
  for (size_t i = 1; i < found.steps.size(); ++i) {
    EXPECT_GE(begins(found.steps[i]), ends(found.steps[i - 1]) - 0.002);
  }
}

TEST(Trace, OfARun) {
  TestFolder folder;
  const Invoked run = invoke({"run", "stacks", "--time", "0.1", "--trace", folder.file("trace.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  const Slices found = slicesOf(folder.read("trace.json"));
  EXPECT_EQ(found.steps.size(), 6u);
  EXPECT_EQ(found.steps[2]["args"]["step"], 3);
  expectNested(found);
  for (const char* name : {"bodies", "pairs", "contacts", "points", "joints", "islands", "colors"})
    EXPECT_EQ(found.counters.at(name).size(), 6u) << name;
  EXPECT_EQ(found.counters.at("bodies")[0], 50);
}

TEST(Trace, StagesThatClaimMoreThanTheStepStayInside) {
  std::ostringstream out;
  Trace trace(out);
  StepReport report;
  report.seconds.fill(1);
  trace.add(5, 2.5, report);
  report.seconds.fill(0.01);
  trace.add(8, 2, report);
  trace.finish();
  const Slices found = slicesOf(out.str());
  expectNested(found);
  EXPECT_DOUBLE_EQ(begins(found.steps[1]), 8e6);
  EXPECT_DOUBLE_EQ(found.stages[0]["dur"], 1e6);
}

TEST(Trace, IsRefusedWhereItCannotBeWritten) {
  TestFolder folder;
  const Invoked same =
      invoke({"run", "stacks", "--time", "0.1", "--trace", folder.file("a"), "--html", folder.file("a")});
  EXPECT_EQ(same.status, kExitBadInput);
  EXPECT_NE(same.err.find("--trace"), std::string::npos) << same.err;
  EXPECT_EQ(invoke({"run", "stacks", "--trace", folder.file("none/trace.json")}).status, kExitBadInput);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace avbd::cli
