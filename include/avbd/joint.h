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
  /// 0 .. 1: share of its speed with which a coordinate leaves a hard stop that it met faster than
  /// WorldDef::restitutionThreshold.
  float restitution = 0;
  friend bool operator==(const JointLimit&, const JointLimit&) = default;
};

/// What a coordinate resists with by itself: force = stiffness (position - q) - damping dq/dt, without bound.
struct JointSpring {
  float stiffness = 0;  ///< [N/m, N m/rad] >= 0
  float damping = 0;    ///< [N s/m, N m s/rad] >= 0
  float position = 0;   ///< [m, rad] at rest
  friend bool operator==(const JointSpring&, const JointSpring&) = default;
};

/// A spring and damper that pull a coordinate to a position and speed: force = stiffness (position - q) + damping
/// (velocity - dq/dt) + force, within +-maxForce. With stiffness 0 a motor.
struct JointDrive {
  float stiffness = 0;                                      ///< [N/m, N m/rad] >= 0
  float damping = 0;                                        ///< [N s/m, N m s/rad] >= 0
  float position = 0;                                       ///< [m, rad]
  float velocity = 0;                                       ///< [m/s, rad/s]
  float maxForce = std::numeric_limits<float>::infinity();  ///< [N, N m] > 0
  /// Stiffness and damping are those of a unit mass [1/s^2, 1/s]: the motion is the same for light and heavy bodies.
  bool acceleration = false;
  float force = 0;  ///< [N, N m] added; also of acceleration drives a force
  friend bool operator==(const JointDrive&, const JointDrive&) = default;
};

enum class AxisMotion : uint8_t { Locked, Free };

/// One coordinate of a D6Joint.
struct D6Axis {
  AxisMotion motion = AxisMotion::Locked;
  JointLimit limit{};  ///< this and the rest: of free coordinates
  JointDrive drive{};
  float friction = 0;  ///< [N, N m] >= 0: Coulomb friction
  JointSpring spring{};
  float armature = 0;                                          ///< [kg, kg m^2] >= 0: inertia of what turns with it
  float maxVelocity = std::numeric_limits<float>::infinity();  ///< [m/s, rad/s] > 0; needs a hard limit or none
};

/// A hinge: B turns about frame A's x axis (JointAxis::Twist).
struct HingeJoint {
  BodyId bodyA{}, bodyB{};
  Pose frameA{}, frameB{};  ///< in each body's frame
  JointLimit limit{};
  JointDrive drive{};
  float friction = 0;  ///< [N m] >= 0
  JointSpring spring{};
  float armature = 0;                                          ///< as in D6Axis
  float maxVelocity = std::numeric_limits<float>::infinity();  ///< as in D6Axis
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
  JointSpring spring{};
  float armature = 0;                                          ///< as in D6Axis
  float maxVelocity = std::numeric_limits<float>::infinity();  ///< as in D6Axis
  bool collideConnected = false;
  uint64_t userData = 0;
};

/// Keeps the swing within an elliptic cone: (y / limitY)^2 + (z / limitZ)^2 <= 1 of the swing's coordinates.
struct SwingCone {
  float y = std::numeric_limits<float>::infinity();  ///< [rad] > 0, < pi; both infinite: no cone
  float z = std::numeric_limits<float>::infinity();  ///< [rad] likewise
  float stiffness = 0;                               ///< [N m/rad] >= 0 beyond the cone; 0: hard
  float damping = 0;                                 ///< [N m s/rad] >= 0 beyond it; only of soft ones
};

/// Turns B against A to a rotation the shortest way: a torque as a JointDrive gives, about the axis of what is missing.
struct SlerpDrive {
  float stiffness = 0;                                      ///< [N m/rad] >= 0
  float damping = 0;                                        ///< [N m s/rad] >= 0
  Quat rotation{};                                          ///< of frame B in frame A
  Vec3 velocity{};                                          ///< [rad/s] of B against A, in frame A
  float maxForce = std::numeric_limits<float>::infinity();  ///< [N m] > 0 about each axis of frame A
  bool acceleration = false;                                ///< as in JointDrive
  friend bool operator==(const SlerpDrive&, const SlerpDrive&) = default;
};

/// The general joint: each of six coordinates locked or free, with limit, drive and friction.
struct D6Joint {
  BodyId bodyA{}, bodyB{};
  Pose frameA{}, frameB{};       ///< in each body's frame
  std::array<D6Axis, 6> axes{};  ///< by JointAxis
  SwingCone cone{};              ///< needs both swings free
  SlerpDrive slerp{};            ///< needs all three angles free and without drives of their own
  bool collideConnected = false;
  uint64_t userData = 0;
};

/// A ball joint whose swing keeps within a cone and whose twist within limits.
D6Joint coneJoint(BodyId bodyA, BodyId bodyB, const Pose& frameA, const Pose& frameB, const SwingCone& cone,
                  const JointLimit& twist = {});
/// Both swings are free, the twist is locked.
D6Joint universalJoint(BodyId bodyA, BodyId bodyB, const Pose& frameA, const Pose& frameB);
/// A sprung wheel: B's origin moves along frame A's z axis (the suspension), B steers about it (SwingZ, locked) and
/// rolls about y (SwingY).
D6Joint wheelJoint(BodyId bodyA, BodyId bodyB, const Pose& frameA, const Pose& frameB, const JointSpring& suspension,
                   const JointLimit& travel = {});

/// Keeps the distance of two points within a range. A rope has min 0; a rod min = max.
struct DistanceJoint {
  BodyId bodyA{}, bodyB{};
  Pose frameA{}, frameB{};                             ///< in each body's frame; only the positions matter
  float min = 0;                                       ///< [m] >= 0
  float max = std::numeric_limits<float>::infinity();  ///< [m] >= min
  float stiffness = 0;                                 ///< [N/m] >= 0 outside the range; 0: hard
  float damping = 0;                                   ///< [N s/m] >= 0 outside the range; only of soft ones
  bool collideConnected = false;
  uint64_t userData = 0;
};

/// A rope from a point of A over two fixed wheels to a point of B: |a - wheelA| + ratio |b - wheelB| <= length.
struct PulleyJoint {
  BodyId bodyA{}, bodyB{};
  Pose frameA{}, frameB{};   ///< in each body's frame; only the positions matter
  Vec3d wheelA{}, wheelB{};  ///< world [m]
  float ratio = 1;           ///< > 0
  float length = 0;          ///< [m] >= 0; 0 takes what it is at creation
  bool slack = true;         ///< a rope may be shorter; without slack it also pushes
  bool collideConnected = true;
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

enum class JointType : uint8_t { Ball, Fixed, TetVolume, Hinge, Slider, D6, Distance, Pulley, Coupling, Custom };

/// Beyond which a joint breaks: it lets go for good (World::setEnabled joins it anew) and is in Events::breaks. Force
/// and torque are those of its reaction. It must be beyond in two steps that follow each other, so that one step's peak
/// breaks nothing.
struct JointBreak {
  float force = std::numeric_limits<float>::infinity();   ///< [N] > 0
  float torque = std::numeric_limits<float>::infinity();  ///< [N m] > 0
};

/// Where a coordinate of a joint is and how fast it moves.
struct JointCoordinate {
  double position = 0;  ///< [m, rad]; the twist counts full turns
  double velocity = 0;  ///< [m/s, rad/s]
};

/// What a joint did in the last step, on body A (on B the opposite), world axes, at A's anchor.
/// Of a TetVolume and a CustomJoint: that on bodies[0], at its centre of mass. Of a Coupling: torque.x is the force
/// along its coordinate. Zero of a joint that is not enabled.
struct JointReaction {
  Vec3 force;   ///< [N]
  Vec3 torque;  ///< [N m]
};

}  // namespace avbd
