// `avbd run --probes`: columns, rows, what needs a step, what is refused.
#include "app/probes_csv.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/failure.h"
#include "app/invoke.h"

namespace avbd::cli {
namespace {

constexpr const char* kPendulum = R"(<mujoco><option timestep="0.005"/><worldbody><body name="a" pos="0 0 1">
  <joint name="h" axis="0 1 0"/><geom size=".1" pos=".5 0 0"/><site name="s" pos=".5 0 0"/></body></worldbody><sensor>
  <jointpos name="angle, &quot;h&quot;" joint="h"/><accelerometer name="imu" site="s"/>
  <framequat name="turn" objtype="xbody" objname="a"/>
  <clock/></sensor></mujoco>)";

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

std::vector<double> fieldsOf(const std::string& line) {
  std::vector<double> out;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) out.push_back(field.empty() ? NAN : std::stod(field));
  return out;
}

TEST(ProbesCsv, ARowAStep) {
  const TestFolder folder;
  const Invoked run =
      invoke({"run", folder.write("p.xml", kPendulum), "--time", "0.1", "--probes", folder.file("p.csv")});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::vector<std::string> lines = linesOf(folder.read("p.csv"));
  ASSERT_EQ(lines.size(), 1u + 21);
  EXPECT_EQ(lines[0], "time,\"angle, \"\"h\"\"\",imu.x,imu.y,imu.z,turn.w,turn.x,turn.y,turn.z,sensor_4");
  EXPECT_EQ(lines[1], "0,0,,,,1,0,0,0,0") << "an acceleration needs a step";
  const std::vector<double> first = fieldsOf(lines[2]), last = fieldsOf(lines[21]);
  ASSERT_EQ(first.size(), 10u);
  EXPECT_EQ(first[0], 0.005);
  // It falls: what it feels is what the joint holds of its weight, 1 - r^2 / (r^2 + 2/5 0.1^2).
  EXPECT_NEAR(first[4], 9.81 * (1 - 0.25 / 0.254), 0.01);
  EXPECT_EQ(last[0], 0.1);
  EXPECT_GT(last[1], 0.05);
  EXPECT_NEAR(last[5], std::cos(last[1] / 2), 1e-6);
  EXPECT_NEAR(last[7], std::sin(last[1] / 2), 1e-6);
  EXPECT_NEAR(last[9], 0.1, 1e-6);
}

TEST(ProbesCsv, LookingChangesNothing) {
  const TestFolder folder;
  const std::string file = folder.write("p.xml", kPendulum);
  const auto hash = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", file, "--time", "0.1", "--json"});
    const std::string out = invoke(more).out;
    return out.substr(out.find("\"hash\""));
  };
  EXPECT_EQ(hash({}), hash({"--probes", "/dev/null"}));
}

void expectRefused(std::vector<std::string> args, const std::vector<std::string>& words) {
  args.insert(args.begin(), "run");
  const Invoked run = invoke(args);
  EXPECT_EQ(run.status, kExitBadInput) << run.out;
  for (const std::string& word : words) EXPECT_NE(run.err.find(word), std::string::npos) << word << ": " << run.err;
}

TEST(ProbesCsv, Refuses) {
  const TestFolder folder;
  const std::string file = folder.write("p.xml", kPendulum), csv = folder.file("out.csv");
  const std::string none = folder.write("none.xml", "<mujoco><sensor><user objtype='body'/></sensor></mujoco>");
  expectRefused({"chain", "--probes", csv}, {"--probes", "chain has no sensors"});
  expectRefused({none, "--probes", csv}, {"--probes", "none.xml has no sensors"});
  expectRefused({file, "--probes", csv, "--poses", csv}, {"--probes is the same file", "out.csv"});
  expectRefused({file, "--probes", csv, "--html", csv}, {"--probes is the same file"});
  expectRefused({file, "--probes", csv, "--record", csv}, {"--record is the same file"});
  expectRefused({file, "--probes", file}, {"is the scene itself"});
  expectRefused({file, "--probes", folder.file("no/such/folder.csv")}, {"--probes", "folder.csv"});
  EXPECT_EQ(folder.names(), (std::set<std::string>{"p.xml", "none.xml"}));
}

TEST(ProbesCsv, TheReportCountsThem) {
  const TestFolder folder;
  const std::string file = folder.write("p.xml", kPendulum);
  EXPECT_NE(invoke({"run", file, "--time", "0.01"}).out.find("\nprobes            4\n"), std::string::npos);
  EXPECT_NE(invoke({"run", file, "--time", "0.01", "--json"}).out.find("\"probes\":4"), std::string::npos);
  EXPECT_NE(invoke({"info", "chain"}).out.find("\nprobes     0\n"), std::string::npos) << invoke({"info", "chain"}).out;
}

}  // namespace
}  // namespace avbd::cli
