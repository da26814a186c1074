// What actuators are given over time, from a CSV file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/model.h"

namespace avbd::cli {

struct ControlRow {
  double time = 0;  ///< [s] >= 0, never less than that of the row before
  size_t actuator = 0;
  double value = 0;
  int line = 0;  ///< of the file
};

class ControlScript {
 public:
  ControlScript() = default;
  ControlScript(std::string file, std::vector<ControlRow> rows) : file_(std::move(file)), rows_(std::move(rows)) {}

  /// To be called before every step with the time at its start: gives what is due since the last call. A value whose
  /// time falls within a step is due at the next one. Throws FileError for a value that the world refuses.
  void apply(Model& model, double time, double dt);
  const std::vector<ControlRow>& rows() const { return rows_; }

 private:
  std::string file_;
  std::vector<ControlRow> rows_;
  size_t next_ = 0;
};

/// Lines of `time,actuator,value`, the first of which may say just that; # begins a line of comment. An actuator is
/// named, or numbered from 0. Fields that hold commas stand in double quotes. Throws FileError, with line and column.
ControlScript readControlScript(const std::string& file, const std::vector<Actuator>& actuators);
/// The same from text.
ControlScript parseControlScript(std::string_view text, const std::string& name,
                                 const std::vector<Actuator>& actuators);

}  // namespace avbd::cli
