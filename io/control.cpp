// Controls of actuators as drives of what they move.
#include <algorithm>
#include <cmath>
#include <string>

#include "io/file_error.h"
#include "io/model.h"

namespace avbd {

namespace {

/// What the actuators of one coordinate do together: force = pull - stiffness q - damping dq/dt, within most, along the
/// file's coordinate.
struct Pull {
  double pull = 0, stiffness = 0, damping = 0, most = 0;
};

void add(Pull& sum, const Actuator& a) {
  if (a.gear == 0) return;
  sum.pull += a.gear * (a.gain * a.control + a.bias[0]);
  sum.stiffness -= a.gear * a.gear * a.bias[1];
  sum.damping -= a.gear * a.gear * a.bias[2];
  sum.most += a.maxForce * std::abs(a.gear);
}

JointDrive driveOf(const Pull& all, const Actuator& of) {
  constexpr double kFarthest = 1e4;  // [m, rad] a target beyond is better told as a force
  JointDrive drive;
  if (!(all.most > 0)) return drive;
  drive.maxForce = static_cast<float>(all.most);
  drive.stiffness = static_cast<float>(std::max(all.stiffness, 0.0));
  drive.damping = static_cast<float>(std::max(all.damping, 0.0));
  double force = all.pull;
  if (drive.stiffness > 0) {
    const double target = all.pull / all.stiffness;
    const bool near = std::abs(target) < kFarthest;
    drive.position = static_cast<float>(of.sign * ((near ? target : 0) - of.offset));
    if (near) force = 0;
  }
  drive.force = static_cast<float>(of.sign * force);
  return drive;
}

}  // namespace

void setControl(Model& model, size_t index, double control) {
  if (index >= model.actuators.size()) {
    throw FileError("actuator = " + std::to_string(index) + ": must be below " +
                    std::to_string(model.actuators.size()));
  }
  Actuator& actuator = model.actuators[index];
  if (!std::isfinite(control)) {
    throw FileError("actuator \"" + actuator.name + "\": control = " + std::to_string(control) + ": must be finite");
  }
  if (actuator.controlRange) {
    control = std::min(std::max(control, (*actuator.controlRange)[0]), (*actuator.controlRange)[1]);
  }
  actuator.control = control;
  const bool coupled = model.world.type(actuator.joint) == JointType::Coupling;
  Pull all;
  for (const Actuator& other : model.actuators) {
    if (other.joint == actuator.joint && (coupled || other.axis == actuator.axis)) add(all, other);
  }
  const JointDrive drive = driveOf(all, actuator);
  if (coupled) {
    model.world.setDrive(actuator.joint, drive);
  } else {
    model.world.setDrive(actuator.joint, actuator.axis, drive);
  }
}

}  // namespace avbd
