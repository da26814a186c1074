// Rows of the poses' file.
#include "app/poses_csv.h"

#include "app/number_text.h"

namespace avbd::cli {

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

PosesCsv::PosesCsv(std::ostream& out, const Model& model) : out_(out) {
  for (const NamedBody& body : model.bodies) names_.push_back(csvField(body.name));
  out_ << "time,body,x,y,z,qw,qx,qy,qz\n";
}

void PosesCsv::write(double time, std::span<const Pose> poses) {
  rows_.clear();
  // 12 digits: a multiple of the step, without the dust of the multiplication.
  const std::string timeText = digits(time, 12);
  for (size_t i = 0; i < names_.size(); ++i) {
    rows_ += timeText + "," + names_[i];
    const Pose& p = poses[i];
    for (const double v : {p.position.x, p.position.y, p.position.z}) appendExact(rows_ += ',', v);
    for (const float v : {p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z}) appendExact(rows_ += ',', v);
    rows_ += '\n';
  }
  out_ << rows_;
}

}  // namespace avbd::cli
