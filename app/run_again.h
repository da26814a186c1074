// From a run's arguments to what its recording holds of them, and back.
#pragma once

#include "app/arguments.h"
#include "io/record/run_again.h"

namespace avbd::cli {

RecordedRun runOf(const RunArguments& arguments);
/// Of the file that a scene is read from; 0 for a built-in scene, and for what cannot be read.
uint64_t sceneHash(const std::string& scene);
/// The arguments of a recorded run, without outputs. Throws BadInput for what is no run of this program, or a model's
/// file that has changed since.
RunArguments argumentsOf(const RecordedRun& run, const std::string& recording);

}  // namespace avbd::cli
