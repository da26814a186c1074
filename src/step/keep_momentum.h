// Momentum of islands that touch nothing fixed.
#pragma once

#include "step/step_data.h"

namespace avbd {

/// Truncated conjugate gradients leave a floating island a small resultant. Its rigid modes cost no row anything, so
/// they are solved exactly: shifts and turns each floating island of the batch until sum M (d - y) and its moment about
/// the island's centre are zero.
void keepMomentum(const WorldData& world, StepData& step, const BatchRange& batch);

}  // namespace avbd
