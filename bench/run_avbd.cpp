// The benchmark of this engine.
#include <algorithm>

#include "bench/bench.h"

namespace avbd::bench {

BenchRecord benchAvbd(const scenes::Scene& scene, const scenes::Settings& settings) {
  BenchRecord record = toRecord(scene, "avbd", settings.workers.value_or(1), scenes::run(scene, settings));
  record.iterations = settings.iterations.value_or(WorldDef{}.iterations);
  const scenes::Layout layout = scenes::layoutOf(scene.make(settings).world);
  record.bodies = static_cast<size_t>(std::count(layout.dynamic.begin(), layout.dynamic.end(), 1));
  return record;
}

}  // namespace avbd::bench
