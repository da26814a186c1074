// `avbd bench`: scenes timed and measured, this engine and its peers in one run.
#include <algorithm>
#include <cmath>

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
  for (const char* column :
       {"ratio", "workers", "bodies", "steps", "ms median", "ms p95", "pen max", "pen mean", "displ", "gap"})
    line += paddedLeft(column, kNumber);
  return line + "  check   (lengths in mm)\n";
}

std::string number(double value) { return paddedLeft(std::isnan(value) ? "-" : digits(value, 4), kNumber); }

// A time counts for nothing where the result is wrong: ours is not told, a peer's stands in brackets.
std::string recordLine(const bench::BenchRecord& r, size_t nameWidth) {
  const bool ours = r.engine == "avbd";
  const auto time = [&](double ms) {
    if (r.passed()) return number(ms);
    return paddedLeft(ours ? "failed" : "(" + digits(ms, 4) + ")", kNumber);
  };
  std::string line = padded(r.scene, nameWidth) + padded(r.engine, kEngine) + number(r.ratio);
  line += paddedLeft(std::to_string(r.workers), kNumber) + paddedLeft(std::to_string(r.bodies), kNumber) +
          paddedLeft(std::to_string(r.steps), kNumber) + time(r.msMedian) + time(r.msP95);
  for (const double metres : {r.penetrationMax, r.penetrationMean, r.displacementMax, r.jointGapMax})
    line += number(metres * 1e3);
  return line + "  " + r.check + "\n";
}

std::vector<const bench::Peer*> peersOf(const BenchArguments& a) {
  std::vector<const bench::Peer*> list;
  for (const std::string& name : a.peers) {
    const bench::Peer* peer = bench::findPeer(name);
    if (!peer || !peer->built) throw BadInput("--peer " + name + ": this program was built without it");
    list.push_back(peer);
  }
  return list;
}

// What a peer cannot build is said in its line; it ends nothing.
bench::BenchRecord peerRecord(const bench::Peer& peer, const scenes::Scene& scene) {
  try {
    return peer.run(scene);
  } catch (const Error& e) {
    bench::BenchRecord none;
    none.scene = scene.name;
    none.engine = peer.name;
    none.ratio = none.msMedian = none.msP95 = none.penetrationMax = none.penetrationMean = std::nan("");
    none.displacementMax = none.jointGapMax = std::nan("");
    none.check = std::string("not run: ") + e.what();
    return none;
  }
}

/// Scenes of one kind and many sizes.
struct Family {
  std::string prefix, of;
  std::vector<bench::BenchRecord> records;

  void add(const bench::BenchRecord& r) {
    if (r.scene.starts_with(prefix) && r.workers == 1 && r.passed()) records.push_back(r);
  }
  std::string line() const {
    const double exponent = bench::costExponent(records);
    return std::isnan(exponent) ? ""
                                : "cost grows as the number of " + of + " to the power " + digits(exponent, 3) + "\n";
  }
};

}  // namespace

int benchCommand(const BenchArguments& a, std::ostream& out) {
  std::vector<const scenes::Scene*> list;
  for (const std::string& name : a.scenes) list.push_back(&sceneNamed(name));
  const std::vector<const bench::Peer*> peers = peersOf(a);
  const std::vector<int> workers = a.workers.empty() ? std::vector<int>{1} : a.workers;
  size_t nameWidth = 8;
  for (const scenes::Scene* scene : list) nameWidth = std::max(nameWidth, scene->name.size() + 2);
  const auto show = [&](const bench::BenchRecord& r) {
    out << (a.json ? jsonText(r) + "\n" : recordLine(r, nameWidth)) << std::flush;
  };
  bool passed = true;
  Family families[] = {{"boxes_", "boxes", {}}, {"slab_", "a slab's points", {}}};
  if (!a.json) out << headLine(nameWidth) << std::flush;
  for (const scenes::Scene* scene : list) {
    bench::BenchRecord first;
    for (const int count : workers) {
      throwIfStopped();
      scenes::Settings settings = a.settings;
      settings.workers = count;
      bench::BenchRecord ours = bench::benchAvbd(*scene, settings);
      if (first.scene.empty())
        first = ours;
      else if (ours.passed() && first.passed())
        ours.ratio = first.msMedian / ours.msMedian;
      passed = passed && ours.passed();
      for (Family& family : families) family.add(ours);
      show(ours);
    }
    for (const bench::Peer* peer : peers) {
      throwIfStopped();
      bench::BenchRecord theirs = peerRecord(*peer, *scene);
      if (first.passed()) theirs.ratio = first.msMedian / theirs.msMedian;
      show(theirs);
    }
  }
  for (const Family& family : families)
    if (!a.json) out << family.line();
  return passed ? kExitDone : kExitCheckFailed;
}

}  // namespace avbd::cli
