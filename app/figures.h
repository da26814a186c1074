// The figures of a run, and how they read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "app/soft_figures.h"
#include "io/model.h"

namespace avbd::cli {

/// SI units; times per step in milliseconds; figures after the last step.
struct RunFigures {
  std::string scene;
  size_t bodies = 0;  ///< that can move; static ones are counted apart
  size_t statics = 0, shapes = 0, joints = 0, contactPoints = 0;
  size_t probes = 0;  ///< of the model
  std::vector<SoftFigures> softs;
  SoftContactFigures softContacts;
  int64_t steps = 0;
  double dt = 0;
  int workers = 1;
  double msMedian = 0, msP95 = 0;
  double realtimeFactor = 0;  ///< simulated time over the time of the steps
  double penetrationMax = 0, penetrationMean = 0;
  double jointGapMax = 0;                              ///< [m]
  double jointAngleMax = 0;                            ///< [rad] about locked axes
  double limitExcessMax = 0, limitExcessAngleMax = 0;  ///< [m], [rad] of coordinates beyond their limits
  double kineticEnergy = 0;
  bool finite = true;
  uint64_t hash = 0;

  // Not in the JSON object.
  uint32_t simdWidth = 0;
  Vec3d momentum, angularMomentum;
  std::array<double, kStageCount> stageShare{};  ///< of the time of all stages
  std::array<double, kStageCount> aloneShare{};  ///< the same, in work that is not cut for several threads
  double sharedRuns = 0;                         ///< a step
  std::vector<std::string> notes;                ///< of the file's reader
};

/// Collects the times of steps.
class Clockwork {
 public:
  void add(double seconds, const StepReport& report);
  void put(RunFigures& figures) const;

 private:
  std::vector<double> milliseconds_;
  double seconds_ = 0;
  uint64_t sharedRuns_ = 0;
  std::array<double, kStageCount> stages_{}, shared_{};
};

/// All figures but those of the clock.
RunFigures measureRun(const Model& model, int64_t steps, double dt);

/// The report's lines: label and value.
using ReportLines = std::vector<std::pair<std::string, std::string>>;
ReportLines reportLines(const RunFigures& figures);
/// Aligned, under thirty lines.
std::string reportText(const ReportLines& lines);

std::string hashText(uint64_t hash);

}  // namespace avbd::cli
