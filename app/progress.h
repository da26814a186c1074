// A bar on a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <ostream>

namespace avbd::cli {

/// Shown only where `out` is the standard error stream and that is a terminal; gone when destroyed.
class Progress {
 public:
  explicit Progress(std::ostream& out);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Cheap: draws ten times a second.
  void show(int64_t step, int64_t steps, double time);

 private:
  using Clock = std::chrono::steady_clock;
  std::ostream* out_;  ///< null where nothing is shown
  Clock::time_point next_;
  bool drawn_ = false;
};

}  // namespace avbd::cli
