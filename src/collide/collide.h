// Two shapes -> manifold. The table in collide.cpp says which function serves which pair.
#pragma once

#include "geom/manifold.h"
#include "geom/shape.h"

namespace avbd {

/// Points at which a and b touch or are closer than `margin` [m]. Sets out.count = 0 where they are farther apart.
/// collide(b, a) gives the same points with the opposite normal (features may be named differently).
void collide(const ShapeGeom& a, const NearPose& poseA, const ShapeGeom& b, const NearPose& poseB, float margin,
             Manifold& out);

}  // namespace avbd
