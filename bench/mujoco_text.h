// A world as an MJCF file for MuJoCo, to run the same scene there.
#pragma once

#include <string>
#include <vector>

#include "scenes/measure.h"

namespace avbd::bench {

struct MujocoText {
  std::string xml;
  std::vector<char> floating;  ///< by the layout's bodies: has six freedoms of its own
  size_t freedoms = 0;
  size_t contacts = 0;  ///< room for so many
};

/// Bodies are named b0, b1, ... in the layout's order. Ball and fixed joints make trees, and loops close by equalities.
/// Throws Error for what MuJoCo has no element for.
MujocoText mujocoText(const World& world, const scenes::Layout& layout);

}  // namespace avbd::bench
