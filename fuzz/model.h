// What is done with a model that a reader made of the fuzzer's bytes.
#pragma once

#include <cmath>
#include <utility>

#include "fuzz/check.h"
#include "io/file_error.h"
#include "io/model.h"
#include "io/probes.h"

namespace avbd::fuzz {

/// FileError is an answer; so is a step that names a body which became infinite. Nothing else is.
template <class Read>
void readAndStep(Read&& read) {
  constexpr size_t kMostBodies = 100;  // beyond that steps take longer than a fuzzer should wait
  try {
    Model model = read();
    require(std::isfinite(model.dt) && model.dt > 0, "a time step that is not positive");
    if (model.bodies.size() > kMostBodies || model.world.shapeCount() > 4 * kMostBodies) return;
    Probes probes(model);
    const bool fewProbes = model.probes.size() <= kMostBodies;
    for (int i = 0; i < 3; ++i) {
      model.world.step(1.0f / 60);
      if (fewProbes) probes.read();
    }
    for (const NamedBody& body : model.bodies)
      require(std::isfinite(length(model.world.pose(body.id).position)), "a body that is not finite");
  } catch (const FileError&) {
  } catch (const NonFiniteError&) {
  }
}

}  // namespace avbd::fuzz
