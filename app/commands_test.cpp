// `avbd scenes`, `bench`, `verify`, help and version.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/invoke.h"
#include "app/json_text.h"
#include "app/near_names.h"
#include "bench/bench.h"

namespace avbd::cli {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Json> objects(const std::string& text) {
  std::vector<Json> found;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) found.push_back(Json::parse(line));
  return found;
}

std::vector<std::string> keysOf(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

TEST(Commands, HelpAndVersion) {
  for (const std::vector<std::string>& args :
       {std::vector<std::string>{"--help"}, {"run", "--help"}, {"bench", "-h"}, {"verify", "--help"}}) {
    const Invoked help = invoke(args);
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.err, "");
    EXPECT_NE(help.out.find("Usage: avbd"), std::string::npos) << help.out;
  }
  EXPECT_NE(invoke({"run", "--help"}).out.find("--substeps"), std::string::npos);
  const Invoked version = invoke({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out.rfind("avbd 0.", 0), 0u) << version.out;
}

TEST(Commands, ScenesAreListedWithTheirLetters) {
  const Invoked list = invoke({"scenes"});
  EXPECT_EQ(list.status, 0);
  for (const scenes::Scene& s : scenes::all()) {
    EXPECT_NE(list.out.find(s.name), std::string::npos) << s.name;
    EXPECT_NE(list.out.find(s.description), std::string::npos) << s.name;
  }
}

TEST(Commands, BenchGivesARecordForEachEngine) {
  std::vector<std::string> args{"bench", "chain", "--json"};
  std::string peers;
  size_t count = 1;
  for (const bench::Peer& peer : bench::peers()) {
    if (peer.built) peers += (count++ == 1 ? "" : ",") + std::string(peer.name);
  }
  if (count > 1) args.insert(args.end(), {"--peer", peers});
  const Invoked run = invoke(args);
  const std::vector<Json> records = objects(run.out);
  ASSERT_EQ(records.size(), count) << run.err;
  const std::vector<std::string> expected{
      "scene",         "engine",    "workers", "ratio",           "bodies",           "iterations",
      "steps",         "ms_median", "ms_p95",  "penetration_max", "penetration_mean", "displacement_max",
      "joint_gap_max", "check"};
  for (const Json& r : records) EXPECT_EQ(keysOf(r), expected);
  EXPECT_EQ(records[0]["scene"], "chain");
  EXPECT_EQ(records[0]["engine"], "avbd");
  EXPECT_GT(records[0]["ms_median"], 0);
  EXPECT_EQ(run.status, records[0]["check"] == "pass" ? 0 : 1);
  for (size_t i = 1; i < records.size(); ++i) {
    EXPECT_NE(records[i]["engine"], "avbd");
    EXPECT_EQ(records[i]["bodies"], 51);
    EXPECT_GT(records[i]["ratio"], 0);
  }
}

TEST(Commands, BenchFailsWithTheSceneCheck) {
  // One iteration of one conjugate-gradient step cannot hold 1000 kg on boxes of 1 kg.
  const Invoked run = invoke({"bench", "e", "--json", "--solver", "sweep", "--iterations", "1", "--krylov", "1"});
  ASSERT_EQ(objects(run.out).size(), 1u) << run.err;
  EXPECT_NE(objects(run.out)[0]["check"], "pass");
  EXPECT_EQ(run.status, kExitCheckFailed);
}

TEST(Commands, BenchComparesWorkersAndTellsWhatAPeerCannotBuild) {
  std::vector<std::string> args{"bench", "hanging", "--workers", "1,2", "--json"};
  const std::vector<Json> records = objects(invoke(args).out);
  ASSERT_EQ(records.size(), 2u);
  EXPECT_TRUE(records[0]["ratio"].is_null());
  EXPECT_EQ(records[1]["workers"], 2);
  EXPECT_GT(records[1]["ratio"], 0);
  EXPECT_EQ(invoke({"bench", "hanging", "--workers", "1,0"}).status, kExitBadInput);
  EXPECT_EQ(invoke({"bench", "hanging", "--peer", "nobody"}).status, kExitBadInput);
}

TEST(Commands, VerifyGivesARecordForEachFigure) {
  const Invoked run = invoke({"verify", "rest", "spin_free", "--json"});
  const std::vector<Json> records = objects(run.out);
  ASSERT_GE(records.size(), 2u) << run.err;
  bool failed = false;
  for (const Json& r : records) {
    EXPECT_EQ(keysOf(r), (std::vector<std::string>{"list", "line", "figure", "params", "measured", "lower", "upper",
                                                   "unit", "status"}));
    EXPECT_EQ(r["list"], "R");
    failed = failed || r["status"] == "fail";
    if (!r["measured"].is_null() && !r["lower"].is_null() && !r["upper"].is_null()) {
      const bool inside = r["lower"] <= r["measured"] && r["measured"] <= r["upper"];
      EXPECT_EQ(r["status"], inside ? "pass" : "fail");
    }
  }
  EXPECT_EQ(run.status, failed ? 1 : 0);
}

TEST(Commands, VerifySkipsWithAReason) {
  const Invoked run = invoke({"verify", "soak", "robots", "--json"});
  const std::vector<Json> records = objects(run.out);
  ASSERT_EQ(records.size(), 2u) << run.err;
  for (const Json& r : records) {
    EXPECT_EQ(r["status"], "skipped");
    EXPECT_TRUE(r["measured"].is_null());
    EXPECT_NE(r["reason"], "");
  }
}

TEST(Commands, VerifyFailsWithTheSettingsOfAnExperiment) {
  const Invoked run = invoke({"verify", "tower10", "--iterations", "1", "--krylov", "1", "--json"});
  EXPECT_EQ(run.status, kExitCheckFailed) << run.out;
}

TEST(JsonText, NumbersThatAreNotFiniteAreNull) {
  VerifyRecord record{"R", "line", scenes::atMost("figure", std::nan(""), 1, "m"), "fail", ""};
  EXPECT_TRUE(Json::parse(jsonText(record))["measured"].is_null());
  RunFigures figures;
  figures.scene = "bad \xff byte \"quoted\"";
  figures.kineticEnergy = INFINITY;
  const Json json = Json::parse(jsonText(figures));
  EXPECT_TRUE(json["kinetic_energy"].is_null());
  EXPECT_EQ(json["hash"], "0000000000000000");
}

TEST(NearNames, NearestFirst) {
  const std::vector<std::string> names{"rest", "tower10", "pyramid10", "pyramid30", "pile"};
  EXPECT_EQ(nearNames("towr10", names), std::vector<std::string>{"tower10"});
  EXPECT_EQ(nearNames("pyramid", names), (std::vector<std::string>{"pyramid10", "pyramid30"}));
  EXPECT_TRUE(nearNames("zzzz", names).empty());
  EXPECT_TRUE(nearNames("", names).empty());
  EXPECT_TRUE(nearNames(std::string(100000, 'a'), names).empty());
}

}  // namespace
}  // namespace avbd::cli
