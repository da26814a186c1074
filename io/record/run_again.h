// What a recording holds so that its run can be made again and checked, step by step.
#pragma once

#include <avbd/profile.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/record/fields.h"

namespace avbd {

/// How a run was asked for.
struct RecordedRun {
  std::vector<std::string> arguments;  ///< of `avbd`, the first is "run"
  std::string control;                 ///< text of the control script; empty: none
  uint64_t sceneHash = 0;              ///< of the model's file; 0: a built-in scene
};

/// A world after a step.
struct RecordedStep {
  uint64_t step = 0;
  uint64_t hash = 0;                           ///< World::hash()
  std::array<uint64_t, kStageCount> stages{};  ///< World::stageHashes()
};

/// What readRunAgain finds; a recording by another program, or an older one, may have neither.
struct RunAgain {
  std::optional<RecordedRun> run;
  std::vector<RecordedStep> steps;  ///< ascending
};
/// Throws FileError for what is no recording, or is damaged there.
RunAgain readRunAgain(const std::filesystem::path& path);

namespace record {

Bytes runContent(const RecordedRun& run);
Bytes stepsContent(const std::vector<RecordedStep>& steps);

}  // namespace record

}  // namespace avbd
