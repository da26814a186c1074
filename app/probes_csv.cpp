// Rows of the probes' file.
#include "app/probes_csv.h"

#include <cmath>

#include "app/number_text.h"
#include "app/poses_csv.h"

namespace avbd::cli {

ProbesCsv::ProbesCsv(std::ostream& out, const Model& model) : out_(out), probes_(model) {
  out_ << "time";
  for (const std::string& column : probes_.columns()) out_ << ',' << csvField(column);
  out_ << '\n';
}

void ProbesCsv::write(double time) {
  probes_.read();
  row_ = digits(time, 12);  // as in the poses' file
  for (const double value : probes_.values()) {
    row_ += ',';
    if (std::isfinite(value)) appendExact(row_, value);
  }
  out_ << row_ << '\n';
}

}  // namespace avbd::cli
