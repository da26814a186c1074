// Poses of all bodies over time, as CSV.
#pragma once

#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "io/model.h"

namespace avbd::cli {

/// A field of a CSV file: quoted where its text needs it.
std::string csvField(const std::string& text);

class PosesCsv {
 public:
  /// Writes the header line. `out` must outlive this.
  PosesCsv(std::ostream& out, const Model& model);
  /// One row for each body of the model, in its order.
  void write(double time, std::span<const Pose> poses);

 private:
  std::ostream& out_;
  std::vector<std::string> names_;
  std::string rows_;  // of one call; kept for its memory
};

}  // namespace avbd::cli
