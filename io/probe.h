// Probes: what a model measures of its world by name, as the sensors of an MJCF file ask for. Evaluated by probes.h.
#pragma once

#include <avbd/coupling.h>
#include <avbd/id.h>
#include <avbd/types.h>

#include <optional>
#include <string>
#include <vector>

namespace avbd {

/// What a probe measures. Rotations are w, x, y, z; those without a reference are told in the world's axes.
enum class ProbeKind : uint8_t {
  JointPosition,            ///< of a hinge or slide, the file's coordinate
  JointVelocity,            ///< its rate
  JointActuatorForce,       ///< of all actuators of a joint together
  TendonPosition,           ///< length
  TendonVelocity,           ///< its rate
  TendonActuatorForce,      ///< of all actuators of a tendon together
  ActuatorPosition,         ///< gear times the coordinate
  ActuatorVelocity,         ///< its rate
  ActuatorForce,            ///< before the gear
  JointLimitPosition,       ///< how far to a limit that is passed: negative; 0 between the limits
  JointLimitVelocity,       ///< its rate; 0 between the limits
  TendonLimitPosition,      ///< as of a joint
  TendonLimitVelocity,      ///< as of a joint
  BallRotation,             ///< of the child against the frame before the joint
  BallVelocity,             ///< the same turning, in the child's axes
  FramePosition,            ///< of `at`, in `reference`
  FrameRotation,            ///< as above
  FrameXAxis,               ///< as above
  FrameYAxis,               ///< as above
  FrameZAxis,               ///< as above
  FrameLinearVelocity,      ///< against `reference` as it moves and turns, in its axes
  FrameAngularVelocity,     ///< as above
  FrameLinearAcceleration,  ///< what an accelerometer there feels: at rest minus gravity; world axes
  FrameAngularAcceleration,
  Accelerometer,    ///< the same in the axes of `at`
  Velocimeter,      ///< velocity of `at` in its own axes
  Gyro,             ///< angular velocity in the axes of `at`
  Force,            ///< that the parent exerts on `body` and all below it, in the axes of `at`
  Torque,           ///< the same about `at`
  Touch,            ///< sum of normal forces of the contacts of `body` whose outward normal meets `zone`
  Rangefinder,      ///< along z of `at` to the nearest shape of another body; -1: none
  Magnetometer,     ///< the file's magnetic flux in the axes of `at`
  SubtreeCenter,    ///< centre of mass of `body` and all below it
  SubtreeVelocity,  ///< of that
  SubtreeMomentum,  ///< angular, about that
  Clock,            ///< World::time()
};

enum class ProbeBound : uint8_t {
  Real,      ///< cut off on both sides
  Positive,  ///< cut off above alone
  Unit,      ///< a rotation or axis: never cut off
};

struct ProbeKindFacts {
  const char* name;  ///< of MJCF's element
  int dimension;     ///< 1, 3 or 4 numbers
  const char* unit;  ///< empty: none, or that of what is measured (Probe::unit)
  ProbeBound bound = ProbeBound::Real;
  bool needsStep = false;  ///< without a step before it there is nothing to measure
};
const ProbeKindFacts& factsOf(ProbeKind kind);

/// A frame that moves with a body; of a null id it stands in the world.
struct ProbeFrame {
  BodyId body{};
  Pose pose{};  ///< in the body's frame, or the world
};

/// A body of the file; several may be one rigid body of the world.
struct ProbeBody {
  ProbeFrame frame;             ///< axes as the file's, origin at the centre of mass
  double mass = 0;              ///< [kg]
  SymMat3 inertia;              ///< about the centre, in the frame's axes [kg m^2]
  std::vector<ShapeId> shapes;  ///< of it alone
  std::vector<ShapeId> unseen;  ///< of those the ones that rays pass: fully transparent
  size_t subtreeEnd = 0;        ///< it and all below it are the bodies from its own index to this one
};

/// A joint that closes a loop: it acts on the tree from outside.
struct ProbeHold {
  JointId joint;
  size_t bodyA = 0, bodyB = 0;  ///< of ProbeTree::bodies
};

/// What probes know of the file's tree of bodies, parents first.
struct ProbeTree {
  std::vector<ProbeBody> bodies;
  std::vector<ProbeHold> holds;
  Vec3d magneticFlux;  ///< world axes
};

/// A length that is measured: sum of the terms' coordinates + constant, or along the path where there is one.
struct ProbeLength {
  std::vector<CouplingTerm> terms;  ///< linear ones
  double constant = 0;
  std::vector<ProbeFrame> path;  ///< straight from each to the next
};

/// A solid in a probe's frame; long ones lie along z.
struct ProbeZone {
  enum class Kind : uint8_t { Sphere, Capsule, Ellipsoid, Cylinder, Box };
  Kind kind = Kind::Sphere;
  Vec3d size;  ///< [m] radius; radius, half length; or half extents
};

/// A measurement by name. Which fields count is the kind's affair.
struct Probe {
  std::string name;  ///< the file's; "sensor_3" where it gives none
  ProbeKind kind = ProbeKind::Clock;
  std::string unit;
  double cutoff = 0;  ///< 0: none; else the largest magnitude told, as ProbeBound says
  ProbeFrame at;
  std::optional<ProbeFrame> reference{};
  size_t body = 0;       ///< of ProbeTree::bodies
  ProbeLength length{};  ///< of joint, tendon or actuator
  std::optional<std::pair<double, double>> limits{};
  std::vector<size_t> actuators{};  ///< of Model::actuators
  ProbeZone zone{};
};

}  // namespace avbd
