// Mass, centre and inertia of uniform solids.
#pragma once

#include <avbd/body.h>

#include <span>

namespace avbd {

/// Exact mass, centre and inertia of one shape of uniform density, in the shape's frame. HalfSpace: all zero.
MassProperties massProperties(const Geometry& geometry, float density);
/// Sum over shapes at their poses, in the body's frame, about the common centre. All zero if no shape has mass.
MassProperties massProperties(std::span<const ShapeDef> shapes);

}  // namespace avbd
