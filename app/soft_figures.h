// Figures of a model's soft bodies, for `run` and `info`.
#pragma once

#include <string>
#include <vector>

#include "io/model.h"

namespace avbd::cli {

struct SoftFigures {
  std::string name;
  bool cloth = false;
  size_t particles = 0, elements = 0;
  double strainMax = 0;  ///< the largest change of an element's edge, of its length at rest; signed
  double volume = 0;     ///< [m^3] of a solid's tetrahedra
};

/// How their surfaces lie against each other and themselves, points and faces of each.
struct SoftContactFigures {
  double overlapMax = 0;  ///< [m] nearer than their thicknesses allow, as contacts tell
  int crossings = 0;      ///< edges that pass through faces, counted apart from the engine's own search
};

std::vector<SoftFigures> softFiguresOf(const Model& model);
SoftContactFigures softContactsOf(const World& world);
/// "0.12 mm of overlap, 0 crossings".
std::string softContactsText(const SoftContactFigures& figures);
/// "2: 1080 particles, 3000 elements, largest strain -18.7 %".
std::string softsText(const std::vector<SoftFigures>& softs);
/// "cube: solid, 180 particles, 500 tetrahedra, 0.125 m^3".
std::string softText(const SoftFigures& soft);

}  // namespace avbd::cli
