// Joints: definitions. A null body id is the world; its frame is then a world pose.
#pragma once

#include <avbd/id.h>
#include <avbd/types.h>

#include <array>
#include <limits>

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

/// Coordinates of a joint: frame B's origin in frame A along A's axes, the twist of B about x, and its swing as the
/// rotation vector (0, y, z) that takes A's x axis to B's.
enum class JointAxis : uint8_t { LinearX, LinearY, LinearZ, Twist, SwingY, SwingZ };

/// Stops a coordinate. lower <= upper [m, rad]; infinite: no stop on that side. Twist: may pass full turns, which are
/// counted; swing: within +-pi.
struct JointLimit {
  float lower = -std::numeric_limits<float>::infinity();
  float upper = std::numeric_limits<float>::infinity();
  float stiffness = 0;  ///< [N/m, N m/rad] >= 0 beyond the stop; 0: hard
  float damping = 0;    ///< [N s/m, N m s/rad] >= 0 beyond the stop; only of soft ones
};

/// A spring and damper that pull a coordinate to a position and speed: force = stiffness (position - q) + damping
/// (velocity - dq/dt), within +-maxForce. With stiffness 0 a motor.
struct JointDrive {
  float stiffness = 0;                                      ///< [N/m, N m/rad] >= 0
  float damping = 0;                                        ///< [N s/m, N m s/rad] >= 0
  float position = 0;                                       ///< [m, rad]
  float velocity = 0;                                       ///< [m/s, rad/s]
  float maxForce = std::numeric_limits<float>::infinity();  ///< [N, N m] > 0
  /// Stiffness and damping are those of a unit mass [1/s^2, 1/s]: the motion is the same for light and heavy bodies.
  bool acceleration = false;
};

enum class AxisMotion : uint8_t { Locked, Free };

/// One coordinate of a D6Joint.
struct D6Axis {
  AxisMotion motion = AxisMotion::Locked;
  JointLimit limit{};  ///< this and the rest: of free coordinates
  JointDrive drive{};
  float friction = 0;  ///< [N, N m] >= 0: Coulomb friction
};

/// A hinge: B turns about frame A's x axis (JointAxis::Twist).
struct HingeJoint {
  BodyId bodyA{}, bodyB{};
  Pose frameA{}, frameB{};  ///< in each body's frame
  JointLimit limit{};
  JointDrive drive{};
  float friction = 0;  ///< [N m] >= 0
  bool collideConnected = false;
  uint64_t userData = 0;
};

/// A slider: B moves along frame A's x axis (JointAxis::LinearX).
struct SliderJoint {
  BodyId bodyA{}, bodyB{};
  Pose frameA{}, frameB{};  ///< in each body's frame
  JointLimit limit{};
  JointDrive drive{};
  float friction = 0;  ///< [N] >= 0
  bool collideConnected = false;
  uint64_t userData = 0;
};

/// The general joint: each of six coordinates locked or free, with limit, drive and friction.
struct D6Joint {
  BodyId bodyA{}, bodyB{};
  Pose frameA{}, frameB{};       ///< in each body's frame
  std::array<D6Axis, 6> axes{};  ///< by JointAxis
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

enum class JointType : uint8_t { Ball, Fixed, TetVolume, Hinge, Slider, D6 };

/// Where a coordinate of a joint is and how fast it moves.
struct JointCoordinate {
  double position = 0;  ///< [m, rad]; the twist counts full turns
  double velocity = 0;  ///< [m/s, rad/s]
};

/// What a joint did in the last step, on body A (on B the opposite), world axes, at A's anchor.
/// Of a TetVolume: force is that on bodies[0].
struct JointReaction {
  Vec3 force;   ///< [N]
  Vec3 torque;  ///< [N m]
};

}  // namespace avbd
