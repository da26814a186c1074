// Which links of a robot overlap from the start.
#pragma once

#include "io/model.h"
#include "io/notes.h"

namespace avbd::urdf {

/// Excludes the pairs of bodies that overlap or touch: collision shapes are made with room around their links, and what
/// overlaps where the robot stands in peace is no collision. To be called while the world holds the robot alone.
void separateTouching(Model& model, Notes& notes);

}  // namespace avbd::urdf
