// Forces that are no numbers (90_publish).
#pragma once

#include "step/step_data.h"

namespace avbd {

/// Before anything is written to the world: throws NonFiniteError if a multiplier, or a force made of one, is not
/// finite. Bodies may be finite all the same, where the step ended before they felt it. Leaves the rows of linked
/// joints and the reactions of scalar ones as publication wants them.
void checkForces(const WorldData& world, StepData& step);

}  // namespace avbd
