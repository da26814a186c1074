// `avbd verify`: the lines of acceptance, one record for each figure.
#include <algorithm>
#include <set>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/failure.h"
#include "app/json_text.h"
#include "app/near_names.h"
#include "app/number_text.h"

namespace avbd::cli {
namespace {

using scenes::Figure;
using scenes::Line;

std::vector<const Line*> chosenLines(const std::vector<std::string>& names) {
  std::set<std::string> known;
  for (const Line& line : scenes::lines()) known.insert({line.list, line.name});
  for (const std::string& name : names)
    if (!known.contains(name))
      throw BadInput("no list or line \"" + name + "\"" + nearText(name, {known.begin(), known.end()}) +
                     "; `avbd verify --help` says more");
  const auto asked = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::vector<const Line*> chosen;
  for (const Line& line : scenes::lines())
    if (names.empty() || asked(line.list) || asked(line.name)) chosen.push_back(&line);
  return chosen;
}

// A line that throws has failed; those after it still run.
std::vector<VerifyRecord> measure(const Line& line, const scenes::Settings& settings) {
  if (!line.run) return {{line.list, line.name, {}, "skipped", line.skipReason}};
  std::vector<VerifyRecord> records;
  try {
    for (Figure& f : line.run(settings)) {
      std::string status = scenes::passes(f) ? "pass" : "fail";
      records.push_back({line.list, line.name, std::move(f), std::move(status), ""});
    }
    if (records.empty()) records.push_back({line.list, line.name, scenes::holds("has_figures", false), "fail", ""});
  } catch (const std::exception& e) {
    records.push_back({line.list, line.name, scenes::holds("runs", false, e.what()), "fail", ""});
  }
  return records;
}

std::string recordLine(const VerifyRecord& r) {
  std::string line = padded(r.status, 9) + padded(r.list, 3) + padded(r.line, 16);
  if (r.status == "skipped") return line + r.reason + "\n";
  const Figure& f = r.figure;
  line += padded(f.name, 28) + paddedLeft(digits(f.measured, 5), 12) + "  in " + digits(f.lower, 5) + " .. " +
          digits(f.upper, 5);
  if (!f.unit.empty()) line += " " + f.unit;
  if (!f.params.empty()) line += "  (" + f.params + ")";
  return line + "\n";
}

struct Tally {
  size_t passed = 0, failed = 0, skipped = 0;
};

}  // namespace

int verifyCommand(const VerifyArguments& a, std::ostream& out) {
  Tally tally;
  for (const Line* line : chosenLines(a.names)) {
    throwIfStopped();
    for (const VerifyRecord& r : measure(*line, a.settings)) {
      out << (a.json ? jsonText(r) + "\n" : recordLine(r)) << std::flush;
      ++(r.status == "pass" ? tally.passed : r.status == "fail" ? tally.failed : tally.skipped);
    }
  }
  if (!a.json)
    out << tally.passed << " figures pass, " << tally.failed << " fail, " << tally.skipped << " lines skipped\n";
  return tally.failed == 0 ? kExitDone : kExitCheckFailed;
}

}  // namespace avbd::cli
