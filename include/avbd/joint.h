// Joints: definitions. A null body id is the world; its frame is then a world pose.
#pragma once

#include <avbd/id.h>
#include <avbd/types.h>

#include <array>

namespace avbd {

/// Holds two points together; rotation is free.
struct BallJoint {
  BodyId bodyA{}, bodyB{};
  Pose frameA{}, frameB{};  ///< in each body's frame; only the positions matter
  bool collideConnected = false;
  uint64_t userData = 0;
};

/// Holds two frames together.
struct FixedJoint {
  BodyId bodyA{}, bodyB{};
  Pose frameA{}, frameB{};  ///< in each body's frame
  bool collideConnected = false;
  uint64_t userData = 0;
};

/// Keeps the volume of the tetrahedron between the centres of mass of four bodies. C = V - restVolume with
/// V = (b - a) . ((c - a) x (d - a)) / 6 [m^3].
struct TetVolume {
  std::array<BodyId, 4> bodies{};
  float restVolume = 0;  ///< [m^3]; 0 takes the volume at creation, which must not be zero
  float stiffness = 0;   ///< [J/m^6] >= 0: energy = stiffness C^2 / 2; 0 means hard
  uint64_t userData = 0;
};

enum class JointType : uint8_t { Ball, Fixed, TetVolume };

/// What a joint did in the last step, on body A (on B the opposite), world axes, at A's anchor.
/// Of a TetVolume: force is that on bodies[0].
struct JointReaction {
  Vec3 force;   ///< [N]
  Vec3 torque;  ///< [N m]
};

}  // namespace avbd
