// Locked axes: rows and columns of the system that do not exist.
#pragma once

#include "solve/batch.h"

namespace avbd {

/// Makes the locked axes of the hessian unit axes that nothing couples to, and clears them in the gradient.
void applyLocks(const BatchView& view);
/// Clears the locked axes of an array of body rows.
void clearLocked(const BatchView& view, float* array);

}  // namespace avbd
