// Readings of a model's probes over time, as CSV.
#pragma once

#include <ostream>
#include <string>

#include "io/probes.h"

namespace avbd::cli {

class ProbesCsv {
 public:
  /// Writes the header line: time, then a column for each number. `out` and `model` must outlive this.
  ProbesCsv(std::ostream& out, const Model& model);
  /// One row; to be called after every step, and before the first. What needs a step and has none is an empty field.
  void write(double time);

 private:
  std::ostream& out_;
  Probes probes_;
  std::string row_;  // kept for its memory
};

}  // namespace avbd::cli
