// The files that a run writes.
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "app/arguments.h"
#include "app/figures.h"
#include "app/load.h"
#include "app/output_file.h"
#include "app/poses_csv.h"
#include "app/probes_csv.h"
#include "app/recorder.h"
#include "app/sampler.h"
#include "app/trace.h"
#include "io/record/run_again.h"
#include "io/record/writer.h"

namespace avbd::cli {

/// Opened before the first step, so that what cannot be written costs no run. Page and CSVs appear when all is done; a
/// recording grows under its name from the beginning. The model must stay where it is.
class Outputs {
 public:
  Outputs(const RunArguments& a, const Model& model, const Plan& plan);
  /// To be called after every step, and before the first.
  void look(const Model& model, int64_t step, const Plan& plan);
  /// To be called after every step, with when it began and what it took [s].
  void timed(double start, double seconds, const StepReport& report);
  void commit(const ReportLines& report);

 private:
  void refuseSame(const RunArguments& a) const;
  void record(const RecordedFrame& frame);
  void flushRecording();

  Sampler csvSampler_, pageSampler_, recordSampler_;
  std::vector<BodyId> ids_;
  std::vector<Pose> poses_;
  std::unique_ptr<OutputFile> csvFile_, pageFile_, probesFile_, traceFile_;
  std::unique_ptr<PosesCsv> csv_;
  std::unique_ptr<ProbesCsv> probes_;
  std::unique_ptr<Trace> trace_;
  std::unique_ptr<Recorder> pageRecorder_, recorder_;
  Recording page_;
  std::unique_ptr<RecordWriter> writer_;
  std::vector<RecordedStep> steps_;  ///< not written yet
  std::chrono::steady_clock::time_point flushed_;
  std::chrono::milliseconds flushAfter_{};
};

}  // namespace avbd::cli
