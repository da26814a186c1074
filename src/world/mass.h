// Mass of a body: from its shapes or given, and what follows from it.
#pragma once

#include <avbd/body.h>

#include <array>
#include <span>

namespace avbd {

/// Ascending [kg m^2].
std::array<double, 3> principalMoments(const SymMat3& inertia);
/// Of a positive definite matrix.
SymMat3 inverse(const SymMat3& matrix);

/// What the shapes give, in the body's frame. `mass` > 0 scales it to that mass; shapes that all have density 0 then
/// share it as if of one density. Mass 0 if nothing has any.
MassProperties shapesMass(std::span<const ShapeDef> shapes, float mass);

}  // namespace avbd
