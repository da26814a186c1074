// Parts of the motion of single bodies, and their rotations.
#pragma once

#include "world/world_data.h"

namespace avbd {

/// exp(-x), of x within 0 .. 20: by a (2,2) Pade approximant of exp(-x / 2^n) squared n times; own arithmetic, because
/// libm differs between platforms.
float decay(float x);

/// Of a dynamic body by gravity and the user's force [m/s^2].
Vec3 freeAcceleration(const BodyData& body, Vec3 gravity);

/// v without its locked components (bits 0 .. 2).
Vec3 unlocked(Vec3 v, int locks);
/// Finite rotation vector as a quaternion.
Quat quatFromVector(Vec3 v);
Quat unit(Quat q);

}  // namespace avbd
