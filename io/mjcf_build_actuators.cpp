// Actuators of an MJCF description and what they start with.
#include <algorithm>

#include "io/mjcf_builder.h"

namespace avbd::mjcf {

void Builder::addActuators() {
  couplings_.resize(in_.tendons.size());
  std::vector<bool> driven(in_.tendons.size());
  for (const Actuation& actuation : in_.actuations) {
    if (!actuation.leftOut && actuation.tendon >= 0) driven[static_cast<size_t>(actuation.tendon)] = true;
  }
  for (size_t i = 0; i < in_.tendons.size(); ++i) addTendon(i, driven[i]);
  for (size_t i = 0; i < in_.actuations.size(); ++i) {
    if (!in_.actuations[i].leftOut) addActuator(in_.actuations[i], i);
  }
  startControls();
}

void Builder::addActuator(const Actuation& from, size_t index) {
  Actuator actuator;
  Length length;
  if (from.tendon >= 0) {
    const size_t tendon = static_cast<size_t>(from.tendon);
    if (!couplings_[tendon]) {
      notes_.add(from.where, "left out: it pulls a tendon that is left out, or a spatial one");
      return;
    }
    length = lengthOf(in_.tendons[tendon]);
    actuator.joint = couplings_[tendon];
    actuator.offset = length.constant;
  } else {
    length = lengthOf(from.joint);
    if (length.terms.empty()) {
      notes_.add(from.where, "left out: its joint stands still");
      return;
    }
    const Coordinate& at = coordinates_[static_cast<size_t>(from.joint.body)][from.joint.joint];
    actuator.joint = at.id;
    actuator.axis = at.axis;
    actuator.sign = at.sign;
    actuator.offset = at.offset;
  }
  actuator.name = from.name.empty() ? "actuator_" + std::to_string(index + 1) : from.name;
  actuator.gear = from.gear;
  actuator.gain = from.gain;
  std::copy(from.bias.begin(), from.bias.end(), actuator.bias);
  actuator.controlRange = from.range;
  actuator.maxForce = from.maxForce;
  model_.actuators.push_back(std::move(actuator));
  actuatorStarts_.push_back(length.start);
  actuatorControls_.push_back(index);
}

// The control at which a servo rests at `position`.
double Builder::held(const Actuator& actuator, double position) const {
  if (!(actuator.bias[1] < 0) || actuator.gain == 0) return 0;
  return -(actuator.bias[0] + actuator.bias[1] * actuator.gear * position) / actuator.gain;
}

void Builder::startControls() {
  const bool given = key_ && !key_->ctrl.empty(), hold = key_ && !key_->qpos.empty() && !given;
  for (size_t i = 0; i < model_.actuators.size(); ++i) {
    Actuator& actuator = model_.actuators[i];
    actuator.control = given ? key_->ctrl[actuatorControls_[i]] : hold ? held(actuator, actuatorStarts_[i]) : 0;
    if (!hold || actuator.control == 0) continue;
    notes_.add(key_->where, "gives no ctrl: position actuators hold the joints where they start");
  }
  // All of a coordinate's actuators act together, so its last one brings in all.
  for (size_t i = 0; i < model_.actuators.size(); ++i) {
    at(in_.actuations[actuatorControls_[i]].where, [&] { setControl(model_, i, model_.actuators[i].control); });
  }
}

}  // namespace avbd::mjcf
