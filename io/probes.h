// Reads a model's probes: all their numbers at once, in a flat list.
//
// What concerns places, velocities and coordinates is that of the moment. Accelerations are means since the reading
// before: the difference of velocities over the time between, in a frame's axes as they stood in its middle. The
// world's rotations are floats: at a distance r from the joint a reading scatters by about 1e-7 r / dt^2. In the first
// step from given velocities joints keep these, so that its accelerations lack what turning asks for. Forces of
// contacts and joints are those of the last step (events.h, JointReaction), so that read() belongs after every step.
// Force and torque of a body are what Newton and Euler ask for: the accelerations of all bodies below, less gravity,
// contacts and joints that close loops. Forces that the user gives (World::addForce) count as the parent's: the world
// does not tell them. So do torques of rolling and torsional friction.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/model.h"

namespace avbd {

class Probes {
 public:
  /// The model must outlive this, stay where it is, and keep its bodies and joints. Reads once.
  explicit Probes(const Model& model);

  /// Measures all. Throws Error where a body or joint is no longer there.
  void read();

  /// As of the last read(): all probes' numbers, one probe's behind the other's. NaN where the kind needs a step
  /// (ProbeKindFacts::needsStep) and no time has passed since the reading before.
  std::span<const double> values() const { return values_; }
  std::span<const double> values(size_t probe) const;
  /// Of values(): `name`, or `name.x`, with w first of rotations.
  std::vector<std::string> columns() const;

  /// A rigid body of the world as it is at one time; velocity is that of the centre.
  struct State {
    Pose pose;
    Vec3d center;
    Vec3d linear, angular;
  };
  /// A frame as it moves: of its origin, world axes.
  struct Motion {
    Vec3d position;
    Quat rotation;
    Vec3d linear, angular;
  };

 private:
  struct Wrench {
    Vec3d force, torque;
  };
  void watch(const ProbeFrame& frame);
  void readStates();
  Motion motionOf(const ProbeFrame& frame, const std::vector<State>& states) const;
  Motion motionOf(const ProbeFrame& frame) const { return motionOf(frame, now_); }
  void measure(const Probe& probe, double* out) const;
  double scalar(const Probe& probe) const;
  void frame(const Probe& probe, double* out) const;
  void subtree(const Probe& probe, double* out) const;
  JointCoordinate lengthOf(const ProbeLength& length) const;
  double limit(const Probe& probe, bool rate) const;
  double actuatorForce(const Actuator& actuator) const;
  double actuatorForces(const Probe& probe, bool gear) const;
  double range(const Probe& probe) const;

  // probe_forces.cpp
  double touch(const Probe& probe) const;
  Vec3d acceleration(const ProbeFrame& frame) const;
  Vec3d angularAcceleration(const ProbeFrame& frame) const;
  Wrench needed(const ProbeBody& body, Vec3d about) const;
  Wrench interaction(const Probe& probe) const;
  void subtractContacts(const Probe& probe, Vec3d about, Wrench& wrench) const;
  void subtractHolds(const Probe& probe, Vec3d about, Wrench& wrench) const;
  Quat middle(const ProbeFrame& frame) const;
  size_t bodyOf(ShapeId shape) const;

  const Model& model_;
  std::vector<BodyId> ids_;  // of states, the world first
  std::map<BodyId, size_t> stateOf_;
  std::map<ShapeId, size_t> bodyOf_;  // of ProbeTree::bodies
  std::vector<State> now_, before_;
  double time_ = 0, elapsed_ = 0;
  std::vector<Contact> contacts_;
  std::vector<size_t> starts_;  // of probes in values_, and the end
  std::vector<double> values_;
};

}  // namespace avbd
