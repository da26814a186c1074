// The benchmark of this engine.
#include "bench/bench.h"

namespace avbd::bench {

BenchRecord benchAvbd(const scenes::Scene& scene, const scenes::Settings& settings) {
  return toRecord(scene, "avbd", settings.workers.value_or(1), scenes::run(scene, settings));
}

}  // namespace avbd::bench
