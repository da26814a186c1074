// Readings of probes: coordinates, frames, subtrees.
#include "io/probes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "io/probe_math.h"

namespace avbd {

using namespace probe_math;

Probes::Probes(const Model& model) : model_(model) {
  watch({});
  for (const Probe& probe : model.probes) {
    watch(probe.at);
    if (probe.reference) watch(*probe.reference);
    for (const ProbeFrame& frame : probe.length.path) watch(frame);
    starts_.push_back(values_.size());
    values_.resize(values_.size() + static_cast<size_t>(factsOf(probe.kind).dimension));
  }
  starts_.push_back(values_.size());
  const std::vector<ProbeBody>& bodies = model.probeTree.bodies;
  for (size_t i = 0; i < bodies.size(); ++i) {
    watch(bodies[i].frame);
    for (const ShapeId shape : bodies[i].shapes) bodyOf_.emplace(shape, i);
  }
  now_.resize(ids_.size());
  readStates();
  read();
}

void Probes::watch(const ProbeFrame& frame) {
  if (stateOf_.try_emplace(frame.body, ids_.size()).second) ids_.push_back(frame.body);
}

void Probes::readStates() {
  const World& world = model_.world;
  before_ = now_;
  for (size_t i = 1; i < ids_.size(); ++i) {
    const Velocity velocity = world.velocity(ids_[i]);
    now_[i] = {world.pose(ids_[i]), world.worldCenterOfMass(ids_[i]), toDouble(velocity.linear),
               toDouble(velocity.angular)};
  }
  elapsed_ = world.time() - time_;
  time_ = world.time();
}

void Probes::read() {
  readStates();
  model_.world.getContacts(contacts_);
  for (size_t i = 0; i < model_.probes.size(); ++i) {
    const Probe& probe = model_.probes[i];
    const ProbeKindFacts& facts = factsOf(probe.kind);
    double* out = values_.data() + starts_[i];
    if (facts.needsStep && !(elapsed_ > 0)) {
      std::fill_n(out, facts.dimension, std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    measure(probe, out);
    if (probe.cutoff == 0) continue;
    for (int k = 0; k < facts.dimension; ++k) {
      out[k] = std::min(out[k], probe.cutoff);
      if (facts.bound == ProbeBound::Real) out[k] = std::max(out[k], -probe.cutoff);
    }
  }
}

std::span<const double> Probes::values(size_t probe) const {
  return std::span<const double>(values_).subspan(starts_[probe], starts_[probe + 1] - starts_[probe]);
}

std::vector<std::string> Probes::columns() const {
  std::vector<std::string> out;
  for (const Probe& probe : model_.probes) {
    const int dimension = factsOf(probe.kind).dimension;
    if (dimension == 1) out.push_back(probe.name);
    for (const char axis : std::string(dimension == 1 ? "" : dimension == 3 ? "xyz" : "wxyz")) {
      out.push_back(probe.name + "." + axis);
    }
  }
  return out;
}

Probes::Motion Probes::motionOf(const ProbeFrame& frame, const std::vector<State>& states) const {
  const State& body = states[stateOf_.at(frame.body)];
  Motion out;
  out.position = body.pose.position + rotate(body.pose.rotation, frame.pose.position);
  out.rotation = unit(body.pose.rotation * frame.pose.rotation);
  out.angular = body.angular;
  out.linear = body.linear + cross(body.angular, out.position - body.center);
  return out;
}

void Probes::measure(const Probe& probe, double* out) const {
  const auto in = [&](Quat axes, Vec3d v) { put(rotate(conjugate(axes), v), out); };
  const auto local = [&](Vec3d v) { in(motionOf(probe.at).rotation, v); };
  switch (probe.kind) {
    case ProbeKind::FrameLinearAcceleration:
      return put(acceleration(probe.at), out);
    case ProbeKind::FrameAngularAcceleration:
      return put(angularAcceleration(probe.at), out);
    case ProbeKind::Accelerometer:
      return in(middle(probe.at), acceleration(probe.at));
    case ProbeKind::Velocimeter:
      return local(motionOf(probe.at).linear);
    case ProbeKind::Gyro:
      return local(motionOf(probe.at).angular);
    case ProbeKind::Force:
      return in(middle(probe.at), interaction(probe).force);
    case ProbeKind::Torque:
      return in(middle(probe.at), interaction(probe).torque);
    case ProbeKind::Magnetometer:
      return local(model_.probeTree.magneticFlux);
    case ProbeKind::SubtreeCenter:
    case ProbeKind::SubtreeVelocity:
    case ProbeKind::SubtreeMomentum:
      return subtree(probe, out);
    default:
      break;
  }
  if (factsOf(probe.kind).dimension == 1) {
    *out = scalar(probe);
  } else {
    frame(probe, out);
  }
}

double Probes::scalar(const Probe& probe) const {
  const auto gear = [&] { return probe.actuators.empty() ? 1 : model_.actuators[probe.actuators[0]].gear; };
  switch (probe.kind) {
    case ProbeKind::JointPosition:
    case ProbeKind::TendonPosition:
      return lengthOf(probe.length).position;
    case ProbeKind::JointVelocity:
    case ProbeKind::TendonVelocity:
      return lengthOf(probe.length).velocity;
    case ProbeKind::ActuatorPosition:
      return gear() * lengthOf(probe.length).position;
    case ProbeKind::ActuatorVelocity:
      return gear() * lengthOf(probe.length).velocity;
    case ProbeKind::ActuatorForce:
      return actuatorForces(probe, false);
    case ProbeKind::JointActuatorForce:
    case ProbeKind::TendonActuatorForce:
      return actuatorForces(probe, true);
    case ProbeKind::JointLimitPosition:
    case ProbeKind::TendonLimitPosition:
      return limit(probe, false);
    case ProbeKind::JointLimitVelocity:
    case ProbeKind::TendonLimitVelocity:
      return limit(probe, true);
    case ProbeKind::Touch:
      return touch(probe);
    case ProbeKind::Rangefinder:
      return range(probe);
    default:
      return time_;
  }
}

void Probes::frame(const Probe& probe, double* out) const {
  const Motion at = motionOf(probe.at), in = motionOf(probe.reference.value_or(ProbeFrame{}));
  const Quat back = conjugate(in.rotation);
  const auto told = [&](Vec3d v) { put(rotate(back, v), out); };
  const Quat turn = unit(back * at.rotation);
  switch (probe.kind) {
    case ProbeKind::BallVelocity:
      return put(rotate(conjugate(at.rotation), at.angular - in.angular), out);
    case ProbeKind::FramePosition:
      return told(at.position - in.position);
    case ProbeKind::FrameXAxis:
      return put(rotate(turn, Vec3d{1, 0, 0}), out);
    case ProbeKind::FrameYAxis:
      return put(rotate(turn, Vec3d{0, 1, 0}), out);
    case ProbeKind::FrameZAxis:
      return put(rotate(turn, Vec3d{0, 0, 1}), out);
    case ProbeKind::FrameLinearVelocity:
      return told(at.linear - in.linear - cross(in.angular, at.position - in.position));
    case ProbeKind::FrameAngularVelocity:
      return told(at.angular - in.angular);
    default: {  // rotations
      const float parts[] = {turn.w, turn.x, turn.y, turn.z};
      std::copy_n(parts, 4, out);
    }
  }
}

void Probes::subtree(const Probe& probe, double* out) const {
  const std::vector<ProbeBody>& bodies = model_.probeTree.bodies;
  const size_t end = bodies[probe.body].subtreeEnd;
  double mass = 0;
  Vec3d moment, momentum;
  for (size_t i = probe.body; i < end; ++i) {
    const Motion motion = motionOf(bodies[i].frame);
    mass += bodies[i].mass;
    moment = moment + motion.position * bodies[i].mass;
    momentum = momentum + motion.linear * bodies[i].mass;
  }
  // Of a subtree without mass, where its first body is.
  const Motion first = motionOf(bodies[probe.body].frame);
  const Vec3d center = mass > 0 ? moment * (1 / mass) : first.position;
  const Vec3d velocity = mass > 0 ? momentum * (1 / mass) : first.linear;
  if (probe.kind == ProbeKind::SubtreeCenter) return put(center, out);
  if (probe.kind == ProbeKind::SubtreeVelocity) return put(velocity, out);
  Vec3d angular;
  for (size_t i = probe.body; i < end; ++i) {
    const Motion motion = motionOf(bodies[i].frame);
    angular = angular + spin(bodies[i].inertia, motion.rotation, motion.angular) +
              cross(motion.position - center, (motion.linear - velocity) * bodies[i].mass);
  }
  put(angular, out);
}

JointCoordinate Probes::lengthOf(const ProbeLength& length) const {
  JointCoordinate out{length.constant, 0};
  for (const CouplingTerm& term : length.terms) {
    const JointCoordinate now = model_.world.coordinate(term.joint, term.axis);
    out.position += static_cast<double>(term.factor) * now.position;
    out.velocity += static_cast<double>(term.factor) * now.velocity;
  }
  for (size_t i = 1; i < length.path.size(); ++i) {
    const Motion a = motionOf(length.path[i - 1]), b = motionOf(length.path[i]);
    const Vec3d way = b.position - a.position;
    const double far = avbd::length(way);
    out.position += far;
    if (far > 0) out.velocity += dot(way, b.linear - a.linear) / far;
  }
  return out;
}

double Probes::limit(const Probe& probe, bool rate) const {
  if (!probe.limits) return 0;
  const JointCoordinate now = lengthOf(probe.length);
  const double above = now.position - probe.limits->first, below = probe.limits->second - now.position;
  if (above < 0) return rate ? now.velocity : above;
  if (below < 0) return rate ? -now.velocity : below;
  return 0;
}

// As the drive gave it: at the end of the step.
double Probes::actuatorForce(const Actuator& a) const {
  const World& world = model_.world;
  const bool coupled = world.type(a.joint) == JointType::Coupling;
  const JointCoordinate now = coupled ? world.coordinate(a.joint) : world.coordinate(a.joint, a.axis);
  const double length = a.gear * (a.sign * now.position + a.offset), speed = a.gear * a.sign * now.velocity;
  const double force = a.gain * a.control + a.bias[0] + a.bias[1] * length + a.bias[2] * speed;
  return std::min(std::max(force, -a.maxForce), a.maxForce);
}

double Probes::actuatorForces(const Probe& probe, bool gear) const {
  double sum = 0;
  for (const size_t i : probe.actuators) {
    const Actuator& actuator = model_.actuators[i];
    sum += (gear ? actuator.gear : 1) * actuatorForce(actuator);
  }
  return sum;
}

double Probes::range(const Probe& probe) const {
  const Motion at = motionOf(probe.at);
  const ProbeTree& tree = model_.probeTree;
  QueryFilter filter;
  filter.filter = {.category = 0xffffffffu, .mask = 0xffffffffu, .group = 0, .anyMask = true};
  filter.accept = [&](ShapeId shape) {
    const auto known = bodyOf_.find(shape);
    if (known == bodyOf_.end()) return true;
    const std::vector<ShapeId>& unseen = tree.bodies[known->second].unseen;
    return known->second != probe.body && std::find(unseen.begin(), unseen.end(), shape) == unseen.end();
  };
  const Vec3 ahead = rotate(at.rotation, Vec3{0, 0, 1});
  const CastHit hit = model_.world.rayClosest({.origin = at.position, .direction = ahead}, filter);
  return hit ? static_cast<double>(hit.distance) : -1;
}

}  // namespace avbd
