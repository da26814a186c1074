// Motion of a body that nothing touches, over one substep.
#pragma once

#include "world/world_data.h"

namespace avbd {

struct FreeMotion {
  Vec3 velocity;         ///< [m/s] at the end
  Vec3 displacement;     ///< [m]
  Vec3 angularMomentum;  ///< [kg m^2/s] at the end, world axes
  Vec3 turn;             ///< [rad] rotation vector
};

/// exp(-x), of x within 0 .. 20: by a (2,2) Pade approximant of exp(-x / 2^n) squared n times; own arithmetic, because
/// libm differs between platforms.
float decay(float x);

/// Of a dynamic body by gravity and the user's force [m/s^2].
Vec3 freeAcceleration(const BodyData& body, Vec3 gravity);
/// Gravity, user forces and damping; the rotation by the midpoint rule, which keeps the angular momentum.
FreeMotion freeMotion(const BodyData& body, Vec3 gravity, float h);

/// v without its locked components (bits 0 .. 2).
Vec3 unlocked(Vec3 v, int locks);
/// World-axes product of the body's inertia, or its inverse, at rotation q.
Vec3 turnedProduct(const SymMat3& local, Quat q, Vec3 v);
/// Finite rotation vector as a quaternion.
Quat quatFromVector(Vec3 v);
Quat unit(Quat q);

}  // namespace avbd
