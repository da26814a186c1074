// Walks a URDF file: the colours of visuals.
#include <algorithm>

#include "io/mjcf_values.h"
#include "io/urdf_parser.h"

namespace avbd::urdf {

// Drawing alone: what is wrong here is noted and never refuses a robot.
std::optional<Color> Parser::readColor(Elem material) {
  if (source_.only(material, "texture")) out_.notes.add(source_.where(material), "textures are not used");
  const auto color = source_.only(material, "color");
  if (!color) return {};
  std::vector<double> rgba;
  mjcf::NumberFault fault;
  const bool numbers = mjcf::readNumbers(source_.text(*color, "rgba"), 4, rgba, fault);
  if (!numbers || rgba.size() < 3) {
    out_.notes.add(source_.where(*color), "rgba must be 4 numbers: no colour is taken");
    return {};
  }
  if (rgba.size() == 3) rgba.push_back(1);
  const double most = *std::max_element(rgba.begin(), rgba.begin() + 3);
  if (most > 1 && most <= 255) {
    out_.notes.add(source_.where(*color), "rgba beyond 1: taken for 0 .. 255");
    for (size_t i = 0; i < 3; ++i) rgba[i] /= 255;
    if (rgba[3] > 1) rgba[3] /= 255;
  }
  return colorOf(rgba[0], rgba[1], rgba[2], rgba[3]);
}

void Parser::readMaterials(const std::vector<Elem>& parts) {
  for (const Elem& part : parts) {
    if (part.name() != "material") continue;
    const std::string name(source_.text(part, "name"));
    const std::optional<Color> color = readColor(part);
    if (!materials_.emplace(name, color).second) {
      out_.notes.add(source_.where(part), "another material has this name: the first is taken");
    }
  }
}

// As in urdfdom: one of the robot's own goes before what a link says under its name, and what a link says holds for the
// links below it in the file, too.
std::optional<Color> Parser::readMaterial(Elem elem) {
  const std::string name(source_.text(elem, "name"));
  const std::optional<Color> own = readColor(elem);
  if (name.empty()) return own;
  if (const auto known = materials_.find(name); known != materials_.end()) return known->second;
  if (source_.children(elem).empty()) {
    out_.notes.add(source_.where(elem), "no material has this name: no colour");
  } else {
    materials_.emplace(name, own);
  }
  return own;
}

}  // namespace avbd::urdf
