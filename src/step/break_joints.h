// Joints that break (JointBreak).
#pragma once

#include "world/world_data.h"

namespace avbd {

/// At the end of a step: lets go what was beyond its bounds in this step and the one before, and tells of it.
void breakJoints(WorldData& world);

}  // namespace avbd
