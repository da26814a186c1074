// `avbd bench`: scenes timed and measured, this engine and a peer in one run.
#include <algorithm>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/failure.h"
#include "app/json_text.h"
#include "app/number_text.h"
#include "bench/bench.h"

namespace avbd::cli {
namespace {

constexpr size_t kEngine = 8, kNumber = 10;

std::string headLine(size_t nameWidth) {
  std::string line = padded("scene", nameWidth) + padded("engine", kEngine);
  for (const char* column : {"workers", "steps", "ms median", "ms p95", "pen max", "pen mean", "displ", "gap"})
    line += paddedLeft(column, kNumber);
  return line + "  check   (lengths in mm)\n";
}

std::string recordLine(const bench::BenchRecord& r, size_t nameWidth) {
  std::string line = padded(r.scene, nameWidth) + padded(r.engine, kEngine);
  line += paddedLeft(std::to_string(r.workers), kNumber) + paddedLeft(std::to_string(r.steps), kNumber);
  for (const double v : {r.msMedian, r.msP95}) line += paddedLeft(digits(v, 4), kNumber);
  for (const double metres : {r.penetrationMax, r.penetrationMean, r.displacementMax, r.jointGapMax})
    line += paddedLeft(digits(metres * 1e3, 4), kNumber);
  return line + "  " + r.check + "\n";
}

}  // namespace

int benchCommand(const BenchArguments& a, std::ostream& out) {
  std::vector<const scenes::Scene*> list;
  for (const std::string& name : a.scenes) list.push_back(&sceneNamed(name));
  if (a.bullet && !bench::hasBullet()) throw BadInput("--peer bullet: this program was built without Bullet");
  size_t nameWidth = 8;
  for (const scenes::Scene* scene : list) nameWidth = std::max(nameWidth, scene->name.size() + 2);
  const auto show = [&](const bench::BenchRecord& r) {
    out << (a.json ? jsonText(r) + "\n" : recordLine(r, nameWidth)) << std::flush;
  };
  bool passed = true;
  if (!a.json) out << headLine(nameWidth) << std::flush;
  for (const scenes::Scene* scene : list) {
    throwIfStopped();
    const bench::BenchRecord ours = bench::benchAvbd(*scene, a.settings);
    passed = passed && ours.check == "pass";
    show(ours);
    if (a.bullet) show(bench::benchBullet(*scene));
  }
  return passed ? kExitDone : kExitCheckFailed;
}

}  // namespace avbd::cli
