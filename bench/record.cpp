// From what a run showed to the benchmark's record.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/bench.h"

namespace avbd::bench {
namespace {

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nan("");
  const size_t k = std::min(values.size() - 1, static_cast<size_t>(q * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return values[k];
}

}  // namespace

BenchRecord toRecord(const scenes::Scene& scene, std::string engine, int workers, const scenes::Evidence& e) {
  BenchRecord r;
  r.scene = scene.name;
  r.engine = std::move(engine);
  r.workers = workers;
  r.steps = static_cast<int>(e.milliseconds.size());
  r.msMedian = quantile(e.milliseconds, 0.5);
  r.msP95 = quantile(e.milliseconds, 0.95);
  r.penetrationMax = e.penetration.max;
  r.penetrationMean = e.penetration.mean;
  r.displacementMax = scene.watch.escaped ? e.displacement.horizontal : e.displacement.total;
  r.jointGapMax = e.gapLate;
  if (scene.check) r.figures = scene.check(e);
  for (const scenes::Figure& f : r.figures) {
    if (scenes::passes(f)) continue;
    char measured[32];
    std::snprintf(measured, sizeof measured, "%.3g", f.measured);
    r.check += (r.check.empty() ? "fail: " : ", ") + f.name + " " + measured;
  }
  if (r.check.empty()) r.check = "pass";
  r.ratio = std::nan("");
  return r;
}

double costExponent(std::span<const BenchRecord> records) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const BenchRecord& r : records) {
    const double lx = std::log(static_cast<double>(r.bodies)), ly = std::log(r.msMedian);
    n += 1, x += lx, y += ly, xx += lx * lx, xy += lx * ly;
  }
  const double spread = n * xx - x * x;
  return n > 1 && spread > 1e-9 ? (n * xy - x * y) / spread : std::nan("");
}

}  // namespace avbd::bench
