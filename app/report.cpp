// The report as text.
#include <algorithm>
#include <cstdio>

#include "app/figures.h"
#include "app/number_text.h"

namespace avbd::cli {
namespace {

constexpr size_t kNotesShown = 6;
constexpr size_t kNoteLength = 160;

std::string number(double value) { return digits(value, 4); }

std::string vectorText(Vec3d v) { return number(v.x) + ", " + number(v.y) + ", " + number(v.z); }

std::string millimetres(double metres) { return number(metres * 1e3) + " mm"; }

std::string milliradians(double radians) { return number(radians * 1e3) + " mrad"; }

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", share * 100);
  return text;
}

// Stages that cost something, the dearest first.
std::string stagesText(const std::array<double, kStageCount>& share) {
  std::vector<size_t> order;
  for (size_t i = 0; i < kStageCount; ++i)
    if (share[i] >= 0.0005) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return share[a] > share[b]; });
  std::string text;
  for (const size_t i : order)
    text += (text.empty() ? "" : ", ") + std::string(stageName(static_cast<Stage>(i))) + " " + percent(share[i]);
  return text.empty() ? "-" : text;
}

// What more workers do not make shorter.
std::string aloneText(const RunFigures& f) {
  double all = 0;
  for (const double share : f.aloneShare) all += share;
  return percent(all) + ": " + stagesText(f.aloneShare) + "; " + number(f.sharedRuns) + " shared runs a step";
}

void addNotes(ReportLines& lines, const std::vector<std::string>& notes) {
  const size_t shown = notes.size() > kNotesShown ? kNotesShown - 1 : notes.size();
  for (size_t i = 0; i < shown; ++i) {
    const bool cut = notes[i].size() > kNoteLength;
    lines.emplace_back("note", cut ? notes[i].substr(0, kNoteLength) + " ..." : notes[i]);
  }
  if (shown < notes.size()) lines.emplace_back("note", std::to_string(notes.size() - shown) + " further notes");
}

}  // namespace

std::string hashText(uint64_t hash) {
  char text[24];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

ReportLines reportLines(const RunFigures& f) {
  ReportLines lines{
      {"scene", f.scene},
      {"bodies", std::to_string(f.bodies) + ", and " + std::to_string(f.statics) + " static"},
      {"shapes", std::to_string(f.shapes)},
      {"joints", std::to_string(f.joints)},
      {"probes", std::to_string(f.probes)},
      {"contact points", std::to_string(f.contactPoints)},
      {"steps", std::to_string(f.steps) + " of " + digits(f.dt, 6) +
                    " s: " + digits(static_cast<double>(f.steps) * f.dt, 6) + " s"},
      {"workers", std::to_string(f.workers) + ", " + std::to_string(f.simdWidth) + " lanes"},
      {"time per step", number(f.msMedian) + " ms median, " + number(f.msP95) + " ms 95th percentile"},
      {"realtime factor", number(f.realtimeFactor)},
      {"stages", stagesText(f.stageShare)},
      {"not shared", aloneText(f)},
      {"penetration", millimetres(f.penetrationMax) + " max, " + millimetres(f.penetrationMean) + " mean"},
      {"joint gap", millimetres(f.jointGapMax) + ", " + milliradians(f.jointAngleMax) + " max"},
      {"beyond limits", millimetres(f.limitExcessMax) + ", " + milliradians(f.limitExcessAngleMax) + " max"},
      {"kinetic energy", number(f.kineticEnergy) + " J"},
      {"momentum", vectorText(f.momentum) + " kg m/s"},
      {"angular momentum", vectorText(f.angularMomentum) + " kg m^2/s"},
      {"finite", f.finite ? "yes" : "no"},
      {"hash", hashText(f.hash)},
  };
  constexpr std::ptrdiff_t kBehindBodies = 2;
  if (!f.softs.empty())
    lines.insert(lines.begin() + kBehindBodies,
                 {{"soft bodies", softsText(f.softs)}, {"soft surfaces", softContactsText(f.softContacts)}});
  addNotes(lines, f.notes);
  return lines;
}

std::string reportText(const ReportLines& lines) {
  size_t width = 0;
  for (const auto& [label, value] : lines) width = std::max(width, label.size());
  std::string text;
  for (const auto& [label, value] : lines) text += padded(label, width + 2) + value + "\n";
  return text;
}

}  // namespace avbd::cli
