// Where rays enter round bodies.
#pragma once

#include "query/ray_shape.h"

namespace avbd {

/// Distance at which the ray enters a ball: 0 where it starts inside, -1 where it does not within its length.
double sphereEntry(const LocalRay& ray, Vec3d center, double radius);
/// The same for a capsule from a to b.
double capsuleEntry(const LocalRay& ray, Vec3d a, Vec3d b, double radius);
/// Along y about the origin.
LocalHit rayCylinder(const LocalRay& ray, double radius, double halfHeight);
/// Along y: base at -halfHeight, tip at halfHeight.
LocalHit rayCone(const LocalRay& ray, double radius, double halfHeight);

}  // namespace avbd
