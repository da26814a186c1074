// Whether a point lies in a shape.
#pragma once

#include "geom/shape.h"

namespace avbd {

/// Inside or on the surface; `point` in the shape's frame. A HeightField holds what is below its surface by no more
/// than its thickness; a Mesh holds nothing.
bool containsPoint(const ShapeGeom& geom, Vec3d point);

}  // namespace avbd
