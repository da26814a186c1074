// Numbers of the method that follow from the world's definition and the length of a substep.
#pragma once

#include "step/step_data.h"

namespace avbd {

/// Reference at which the method's constants are stated.
inline constexpr float kReferenceStep = 1.0f / 60;
inline constexpr int kReferenceIterations = 4;

/// The same for another number of outer iterations.
SolveSettings withIterations(SolveSettings settings, int iterations);
void chooseSettings(const WorldData& world, StepData& step, float h);

}  // namespace avbd
