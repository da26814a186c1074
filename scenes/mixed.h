// Boxes, ragdolls, cloth and soft bodies together.
#pragma once

#include "scenes/build.h"

namespace avbd::scenes {

/// Four walls and a floor, open above; inside x and z are within +-half.
void addPit(Build& build, float half, float height);

struct Mixture {
  int boxes = 0, ragdolls = 0, cloths = 0, softs = 0;
};
/// Layer over layer from a height on, each within +-half of the middle.
void addMixture(Build& build, const Mixture& mixture, float half, double from);

}  // namespace avbd::scenes
