// `avbd run`: what it prints and writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/invoke.h"

namespace avbd::cli {
namespace {

using Json = nlohmann::ordered_json;

// A ball that falls freely beside a box on the ground; z is up and the ball's frame is not its centre of mass.
constexpr const char* kFalling = R"(<mujoco model="falling">
  <option timestep="0.005" gravity="0 0 -9.81"/>
  <worldbody>
    <geom type="plane" size="10 10 1"/>
    <body name="ball, &quot;red&quot;" pos="1 2 30"><freejoint/><geom type="sphere" size="0.2" pos="0.3 0 0"/></body>
    <body name="box" pos="0 0 0.5"><freejoint/><geom type="box" size="0.5 0.5 0.5"/></body>
  </worldbody>
</mujoco>)";

std::vector<std::vector<std::string>> rowsOf(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(csv);
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '"') {
        if (quoted && i + 1 < line.size() && line[i + 1] == '"')
          fields.back() += line[++i];
        else
          quoted = !quoted;
      } else if (line[i] == ',' && !quoted) {
        fields.emplace_back();
      } else {
        fields.back() += line[i];
      }
    }
    rows.push_back(fields);
  }
  return rows;
}

size_t lineCount(const std::string& text) { return static_cast<size_t>(std::count(text.begin(), text.end(), '\n')); }

TEST(Run, ASoftBodyOfASurfaceFalls) {
  const TestFolder folder;
  const std::string file =
      folder.write("t.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const Json json = Json::parse(invoke({"run", file, "--soft", "0.5", "--time", "0.5", "--json"}).out);
  EXPECT_TRUE(json["finite"].get<bool>());
  EXPECT_GT(json["contact_points"].get<int>(), 0);
  const Invoked refused = invoke({"run", file, "--soft", "0.5", "--floating"});
  EXPECT_NE(refused.err.find("--floating"), std::string::npos) << refused.err;
  EXPECT_EQ(json["soft_crossings"], 0);
  EXPECT_LT(json["penetration_max"].get<double>(), 0.005) << "its own points are no penetration";
  const std::vector<std::string> stiffer{"--young", "1e7", "--poisson", "0.45", "--density", "500"};
  std::vector<std::string> arguments{"run", file, "--soft", "0.5", "--time", "0.5", "--json"};
  arguments.insert(arguments.end(), stiffer.begin(), stiffer.end());
  const Json stiff = Json::parse(invoke(arguments).out);
  EXPECT_LT(std::abs(stiff["soft_bodies"][0]["strain_max"].get<double>()),
            0.5 * std::abs(json["soft_bodies"][0]["strain_max"].get<double>()));
  const auto complaint = [&](std::vector<std::string> with) { return invoke(std::move(with)).err; };
  EXPECT_NE(complaint({"run", file, "--soft", "0.5", "--poisson", "0.6"}).find("SoftDef.material.poissonRatio = 0.6"),
            std::string::npos);
  EXPECT_NE(complaint({"run", "chain", "--density", "5"}).find("--density 5: chain is not a soft mesh"),
            std::string::npos);
  arguments.insert(arguments.end(), {"--solid", "corotational"});
  const Json turning = Json::parse(invoke(arguments).out);
  EXPECT_TRUE(turning["finite"].get<bool>());
  EXPECT_NE(turning["soft_bodies"], stiff["soft_bodies"]) << "another energy";
  EXPECT_NE(complaint({"run", "chain", "--solid", "corotational"}).find("--solid corotational: chain is not a soft"),
            std::string::npos);
  EXPECT_NE(complaint({"run", file, "--soft", "0.5", "--solid", "linear"}).find("--solid"), std::string::npos);
}

TEST(Run, PrintsExactlyTheKeysOfTheReport) {
  const TestFolder folder;
  const Invoked run = invoke({"run", folder.write("falling.xml", kFalling), "--time", "0.5", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(lineCount(run.out), 1u);
  const Json report = Json::parse(run.out);
  std::vector<std::string> keys;
  for (const auto& [key, value] : report.items()) keys.push_back(key);
  const std::vector<std::string> expected{"scene",
                                          "bodies",
                                          "statics",
                                          "shapes",
                                          "joints",
                                          "probes",
                                          "contact_points",
                                          "steps",
                                          "dt",
                                          "workers",
                                          "ms_median",
                                          "ms_p95",
                                          "realtime_factor",
                                          "penetration_max",
                                          "penetration_mean",
                                          "joint_gap_max",
                                          "joint_angle_max",
                                          "limit_excess_max",
                                          "limit_excess_angle_max",
                                          "kinetic_energy",
                                          "finite",
                                          "hash"};
  EXPECT_EQ(keys, expected);
  EXPECT_EQ(report["scene"], "falling");
  EXPECT_EQ(report["bodies"], 2);
  EXPECT_EQ(report["statics"], 1);
  EXPECT_EQ(report["shapes"], 3);
  EXPECT_EQ(report["joints"], 0);
  EXPECT_EQ(report["probes"], 0);
  EXPECT_EQ(report["contact_points"], 4);
  EXPECT_EQ(report["steps"], 100);
  EXPECT_EQ(report["dt"], 0.005);
  EXPECT_EQ(report["workers"], 1);
  EXPECT_GT(report["ms_median"], 0);
  EXPECT_GE(report["ms_p95"], report["ms_median"]);
  EXPECT_GT(report["realtime_factor"], 0);
  for (const char* key : {"joint_gap_max", "joint_angle_max", "limit_excess_max", "limit_excess_angle_max"}) {
    EXPECT_EQ(report[key], 0) << key;
  }
  EXPECT_LT(report["penetration_max"], 0.005);
  // Of the ball alone: density 1000, 4.905 m/s.
  const double mass = 1000 * 4.0 / 3 * M_PI * 0.2 * 0.2 * 0.2;
  EXPECT_NEAR(report["kinetic_energy"], 0.5 * mass * 4.905 * 4.905, 1e-3 * mass);
  EXPECT_EQ(report["finite"], true);
  const std::string hash = report["hash"];
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(Run, PrintsAShortReport) {
  const Invoked run = invoke({"run", "chain", "--time", "0.1"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_LT(lineCount(run.out), 30u);
  const std::string text = std::string("\n").append(run.out);
  for (const char* label :
       {"scene", "bodies", "joints", "probes", "steps", "time per step", "realtime factor", "stages", "penetration",
        "joint gap", "beyond limits", "kinetic energy", "momentum", "finite", "hash"})
    EXPECT_NE(text.find(std::string("\n").append(label).append("  ")), std::string::npos) << label;
  EXPECT_EQ(invoke({"run", "chain", "--time", "0.1", "--no-report"}).out, "");
}

TEST(Run, ReportStaysShortUnderManyNotes) {
  const TestFolder folder;
  std::string xml = "<mujoco><worldbody>";
  for (int i = 0; i < 60; ++i) {
    const std::string n = std::to_string(i);
    xml += "<geom size=\"0.1\" pos=\"" + n + " 0 0\" wish" + n + "=\"1\"/>";
  }
  const Invoked run = invoke({"run", folder.write("notes.xml", xml + "</worldbody></mujoco>"), "--time", "0.01"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("wish0"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("further notes"), std::string::npos) << run.out;
  EXPECT_LT(lineCount(run.out), 30u);
}

TEST(Run, CsvHoldsFreeFallInTheFilesFrame) {
  const TestFolder folder;
  const std::string xml = folder.write("falling.xml", kFalling);
  const Invoked run = invoke({"run", xml, "--time", "1", "--poses", folder.file("p.csv"), "--fps", "20"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto rows = rowsOf(folder.read("p.csv"));
  ASSERT_EQ(rows.size(), 1u + 21 * 3);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"time", "body", "x", "y", "z", "qw", "qx", "qy", "qz"}));
  const double h = 0.005;
  int seen = 0;
  for (size_t r = 1; r < rows.size(); ++r) {
    ASSERT_EQ(rows[r].size(), 9u);
    const double t = std::stod(rows[r][0]);
    EXPECT_NEAR(t, 0.05 * static_cast<double>((r - 1) / 3), 1e-12);
    if (rows[r][1] != "ball, \"red\"") continue;
    ++seen;
    EXPECT_EQ(std::stod(rows[r][2]), 1) << "the body's frame, not its centre of mass";
    EXPECT_EQ(std::stod(rows[r][3]), 2);
    // Between the two Euler sums of g t^2 / 2.
    EXPECT_NEAR(std::stod(rows[r][4]), 30 - 9.81 * t * t / 2, 9.81 * t * h / 2 + 1e-5);
    EXPECT_EQ(std::stod(rows[r][5]), 1);
  }
  EXPECT_EQ(seen, 21);
  EXPECT_EQ(std::stod(rows[1][0]), 0);
}

TEST(Run, CsvHasNoMoreRowsThanSteps) {
  const TestFolder folder;
  const std::string xml = folder.write("falling.xml", kFalling);
  ASSERT_EQ(invoke({"run", xml, "--time", "0.05", "--poses", folder.file("p.csv"), "--fps", "100000"}).status, 0);
  EXPECT_EQ(rowsOf(folder.read("p.csv")).size(), 1u + 11 * 3);
  ASSERT_EQ(invoke({"run", xml, "--time", "0", "--poses", folder.file("p.csv")}).status, 0);
  EXPECT_EQ(rowsOf(folder.read("p.csv")).size(), 1u + 3);
  // 60 a second where the step does not divide a frame: each frame is the nearest step.
  ASSERT_EQ(invoke({"run", xml, "--time", "1", "--poses", folder.file("p.csv")}).status, 0);
  const auto rows = rowsOf(folder.read("p.csv"));
  ASSERT_EQ(rows.size(), 1u + 61 * 3);
  EXPECT_EQ(rows[4][0], "0.015");
  EXPECT_EQ(rows[7][0], "0.035");
}

TEST(Run, DtAndSettingsOfTheUserWin) {
  const TestFolder folder;
  const std::string xml = folder.write("falling.xml", kFalling);
  const auto report = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", xml, "--time", "0.5", "--json"});
    const Invoked run = invoke(more);
    EXPECT_EQ(run.status, 0) << run.err;
    return Json::parse(run.out);
  };
  const Json base = report({});
  EXPECT_EQ(report({"--dt", "0.01"})["steps"], 50);
  EXPECT_NE(report({"--iterations", "1"})["hash"], base["hash"]);
  EXPECT_NE(report({"--substeps", "2"})["hash"], base["hash"]);
  EXPECT_EQ(report({"--workers", "2"})["workers"], 2);
}

TEST(Run, HashIsTheSameAgainAndAtEachWidth) {
  const auto hash = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "heavy_on_light", "--time", "0.5", "--json"});
    const Invoked run = invoke(more);
    return run.status == 0 ? Json::parse(run.out)["hash"].get<std::string>() : run.err;
  };
  const std::string base = hash({});
  EXPECT_EQ(base.size(), 16u) << base;
  EXPECT_EQ(hash({}), base);
  EXPECT_EQ(hash({"--simd", "1"}), base);
  EXPECT_EQ(hash({"--simd", "4"}), base);
  EXPECT_EQ(hash({"--poses", "/dev/null"}), base) << "looking changes nothing";
  EXPECT_NE(hash({"--dt", "0.01"}), base);
  EXPECT_NE(hash({"--krylov", "1"}), base);
  EXPECT_EQ(hash({"--solver", "krylov"}), base);
}

TEST(Run, WritesAPage) {
  const TestFolder folder;
  const Invoked run = invoke({"run", "heavy_on_light", "--time", "0.2", "--html", folder.file("page.html")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(folder.names(), std::set<std::string>{"page.html"});
  const std::string page = folder.read("page.html");
  EXPECT_GT(page.size(), 10000u);
  EXPECT_NE(page.find("<html"), std::string::npos);
  EXPECT_NE(page.find("</html>"), std::string::npos);
  EXPECT_NE(page.find("time per step"), std::string::npos) << "the report is in the page";
}

TEST(Run, ReplacesOldFilesAndFollowsLinks) {
  const TestFolder folder;
  folder.write("real.csv", "old");
  std::filesystem::create_symlink(folder.file("real.csv"), folder.file("link.csv"));
  ASSERT_EQ(invoke({"run", "chain", "--time", "0.05", "--poses", folder.file("link.csv")}).status, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.csv")));
  EXPECT_EQ(folder.read("real.csv").rfind("time,body,", 0), 0u);
  EXPECT_EQ(folder.names(), (std::set<std::string>{"real.csv", "link.csv"}));
}

TEST(Run, LeavesNoFilesWhenTheNumbersEnd) {
  // 1e29 times heavier than the link that holds it, at the longest step; whether that holds is the solver's matter.
  const TestFolder folder;
  const std::string xml = folder.write("extreme.xml", R"(<mujoco><option gravity="0 0 -100000"/><worldbody>
    <body name="link"><joint type="ball"/><inertial pos="0 0 0" mass="1e-14" diaginertia="1e-14 1e-14 1e-14"/>
      <body name="load" pos="1 0 0"><joint type="ball"/><inertial pos="5 0 0" mass="1e15" diaginertia="1e15 1e15 1e15"/>
    </body></body></worldbody></mujoco>)");
  const Invoked run = invoke({"run", xml, "--dt", "1", "--time", "30", "--json", "--poses", folder.file("p.csv")});
  if (run.status == kExitDone) {
    EXPECT_EQ(Json::parse(run.out)["finite"], true);
    return;
  }
  EXPECT_EQ(run.status, kExitNonFinite) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(run.err.find("\"link\"") != std::string::npos || run.err.find("\"load\"") != std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("stage"), std::string::npos) << run.err;
  EXPECT_EQ(folder.names(), std::set<std::string>{"extreme.xml"});
}

TEST(Run, StopsOnRequestWithoutFiles) {
  const TestFolder folder;
  requestStop();
  const Invoked run = invoke({"run", "chain", "--html", folder.file("a.html"), "--poses", folder.file("a.csv")});
  EXPECT_EQ(run.status, kExitStopped);
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace avbd::cli
