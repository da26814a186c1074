// What a World holds.
#pragma once

#include <avbd/world.h>

#include "step/step.h"
#include "world/world_data.h"

namespace avbd {

struct World::Impl {
  WorldData data;
  Stepper stepper;
};

}  // namespace avbd
