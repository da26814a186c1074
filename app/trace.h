// A run's steps and their stages over time, as a trace that Perfetto and chrome://tracing show.
#pragma once

#include <avbd/profile.h>

#include <cstddef>
#include <ostream>

namespace avbd::cli {

/// Writes Chrome's JSON trace format: each step is a slice that holds one slice for each stage, in the order in which
/// stages run; and counters of bodies, pairs, contacts, points, joints, islands and colours. With several substeps a
/// stage's slice is the sum of them.
class Trace {
 public:
  /// Names the process and its thread. `out` must outlive this.
  explicit Trace(std::ostream& out);
  /// A step that began `start` and took `seconds`, both [s] of wall time since the run began.
  void add(double start, double seconds, const StepReport& report);
  void finish();

 private:
  void slice(const char* name, double start, double seconds, const StepReport& report, bool isStep);
  void counter(const char* name, double start, double value);
  void event(const char* text);

  std::ostream& out_;
  bool first_ = true;
};

}  // namespace avbd::cli
