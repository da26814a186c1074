// Sensors of an MJCF description as probes of the model.
#include <algorithm>
#include <map>
#include <set>

#include "io/mjcf_builder.h"

namespace avbd::mjcf {

namespace {

bool isOfTendon(ProbeKind kind) {
  return kind == ProbeKind::TendonPosition || kind == ProbeKind::TendonVelocity ||
         kind == ProbeKind::TendonActuatorForce || kind == ProbeKind::TendonLimitPosition ||
         kind == ProbeKind::TendonLimitVelocity;
}

bool isOfActuator(ProbeKind kind) {
  return kind == ProbeKind::ActuatorPosition || kind == ProbeKind::ActuatorVelocity || kind == ProbeKind::ActuatorForce;
}

bool isOfScalarJoint(ProbeKind kind) {
  return kind == ProbeKind::JointPosition || kind == ProbeKind::JointVelocity ||
         kind == ProbeKind::JointActuatorForce || kind == ProbeKind::JointLimitPosition ||
         kind == ProbeKind::JointLimitVelocity;
}

bool isOfBall(ProbeKind kind) { return kind == ProbeKind::BallRotation || kind == ProbeKind::BallVelocity; }

bool isForce(ProbeKind kind) {
  return kind == ProbeKind::JointActuatorForce || kind == ProbeKind::TendonActuatorForce ||
         kind == ProbeKind::ActuatorForce;
}

bool isRate(ProbeKind kind) {
  return kind == ProbeKind::JointVelocity || kind == ProbeKind::TendonVelocity || kind == ProbeKind::ActuatorVelocity ||
         kind == ProbeKind::JointLimitVelocity || kind == ProbeKind::TendonLimitVelocity;
}

/// Of a sum of coordinates; empty where angles and lengths are mixed, or nothing moves.
std::string unitOf(const ProbeLength& length, ProbeKind kind) {
  bool angles = false, lengths = !length.path.empty();
  for (const CouplingTerm& term : length.terms) (term.axis >= JointAxis::Twist ? angles : lengths) = true;
  if (angles == lengths) return {};
  if (isForce(kind)) return angles ? "N m" : "N";
  return std::string(angles ? "rad" : "m") + (isRate(kind) ? "/s" : "");
}

}  // namespace

// In the body of ours that it is part of, or in the world.
ProbeFrame Builder::frameOf(size_t body, const Posed& pose) const {
  const BodyId id = movingId(rootOf(body));
  Posed at = (id ? inRoot(body) : start_[body]) * pose;
  at.rotation = normalized(at.rotation);
  return {id, toPose(at)};
}

// The body's frame as it stands before its ball turns it: the parent carries it, or what stands between.
ProbeFrame Builder::beforeBall(JointRef ball) const {
  const size_t index = static_cast<size_t>(ball.body);
  const std::vector<Stage>& stages = stages_[index];
  size_t stage = 0;
  while (stage + 1 < stages.size() && stages[stage + 1].first <= ball.joint) ++stage;
  if (stage > 0) return {between_[index][stage - 1], {}};
  return frameOf(static_cast<size_t>(in_.bodies[index].parent), in_.bodies[index].pose);
}

std::vector<ProbeFrame> Builder::pathOf(const Tendon& tendon) const {
  std::vector<ProbeFrame> path;
  for (const int index : tendon.sites) {
    const Site& site = in_.sites[static_cast<size_t>(index)];
    path.push_back(frameOf(static_cast<size_t>(site.body), site.pose));
  }
  return path;
}

// Bodies stand in the order of the walk through the file, so that what is below one stands together.
void Builder::addProbeTree() {
  ProbeTree& tree = model_.probeTree;
  tree.magneticFlux = in_.magneticFlux;
  tree.holds = holds_;
  tree.bodies.resize(in_.bodies.size());
  std::map<const Geom*, size_t> bodyOf;
  for (size_t i = in_.bodies.size(); i-- > 0;) {
    const Body& body = in_.bodies[i];
    ProbeBody& out = tree.bodies[i];
    const Sym3d& m = body.mass.inertia;
    const auto f = [&](double v) { return mjcf::narrow(v, body.where); };
    out.frame = frameOf(i, {body.mass.center, {}});
    out.mass = body.mass.mass;
    out.inertia = {f(m.xx), f(m.yy), f(m.zz), f(m.xy), f(m.xz), f(m.yz)};
    out.subtreeEnd = std::max(out.subtreeEnd, i + 1);
    size_t& above = tree.bodies[static_cast<size_t>(body.parent)].subtreeEnd;
    above = std::max(above, out.subtreeEnd);
    for (const Geom& geom : body.geoms) bodyOf.emplace(&geom, i);
  }
  for (size_t root = 0; root < ids_.size(); ++root) {
    if (!ids_[root]) continue;
    const std::vector<ShapeId> shapes = model_.world.shapes(ids_[root]);
    for (size_t k = 0; k < shapes.size(); ++k) {
      const Geom* geom = geoms_[root][k];
      const auto found = bodyOf.find(geom);  // none where a flex has it
      ProbeBody& of = tree.bodies[found == bodyOf.end() ? root : found->second];
      of.shapes.push_back(shapes[k]);
      if (geom->color && geom->color->alpha == 0) of.unseen.push_back(shapes[k]);
    }
  }
}

std::vector<size_t> Builder::actuatorsOf(const Sensor& sensor) const {
  std::vector<size_t> out;
  for (size_t i = 0; i < model_.actuators.size(); ++i) {
    const size_t index = actuatorControls_[i];
    const Actuation& from = in_.actuations[index];
    const bool found = isOfActuator(sensor.kind) ? static_cast<int>(index) == sensor.actuation
                       : isOfTendon(sensor.kind) ? from.tendon == sensor.tendon
                                                 : from.tendon < 0 && from.joint.body == sensor.joint.body &&
                                                       from.joint.joint == sensor.joint.joint;
    if (found) out.push_back(i);
  }
  return out;
}

void Builder::measureLength(const Sensor& sensor, Probe& probe) const {
  int tendon = isOfTendon(sensor.kind) ? sensor.tendon : -1;
  JointRef joint = sensor.joint;
  if (isOfActuator(sensor.kind)) {
    const Actuation& actuation = in_.actuations[static_cast<size_t>(sensor.actuation)];
    tendon = actuation.tendon;
    joint = actuation.joint;
  }
  if (tendon >= 0) {
    const Tendon& of = in_.tendons[static_cast<size_t>(tendon)];
    if (of.sites.empty()) {
      const Length length = lengthOf(of);
      probe.length = {length.terms, length.constant, {}};
    } else {
      probe.length.path = pathOf(of);
    }
    if (of.limited) probe.limits = {of.lower, of.upper};
  } else {
    const Length length = lengthOf(joint);
    probe.length = {length.terms, length.constant, {}};
    if (const Joint& of = jointOf(in_, joint); of.limited) probe.limits = {of.lower, of.upper};
  }
  if (probe.unit.empty()) probe.unit = unitOf(probe.length, sensor.kind);
}

// False where there is nothing to measure here, with a note.
bool Builder::aimProbe(const Sensor& sensor, Probe& probe) {
  const auto leaveOut = [&](const std::string& why) {
    notes_.add(sensor.where, "left out: " + why, factsOf(sensor.kind).name);
    return false;
  };
  if (isOfTendon(sensor.kind)) {
    const Tendon& tendon = in_.tendons[static_cast<size_t>(sensor.tendon)];
    if (!tendon.straight) return leaveOut("the length of a tendon around geoms or over pulleys is not measured");
  }
  if (isOfTendon(sensor.kind) || isOfScalarJoint(sensor.kind) || isOfActuator(sensor.kind)) {
    probe.actuators = actuatorsOf(sensor);
    if (isOfActuator(sensor.kind) && probe.actuators.empty()) return leaveOut("its actuator is left out");
    measureLength(sensor, probe);
    return true;
  }
  if (isOfBall(sensor.kind)) {
    probe.at = frameOf(static_cast<size_t>(sensor.joint.body), {});
    probe.reference = beforeBall(sensor.joint);
    return true;
  }
  probe.body = static_cast<size_t>(sensor.at.body);
  probe.at = frameOf(probe.body, sensor.at.pose);
  if (sensor.reference) {
    probe.reference = frameOf(static_cast<size_t>(sensor.reference->body), sensor.reference->pose);
  }
  probe.zone = sensor.zone;
  if (sensor.kind == ProbeKind::Rangefinder) {
    const auto hidden = [&](const Geom& g) { return in_.contactsOff || (g.contype == 0 && g.conaffinity == 0); };
    for (const Body& body : in_.bodies) {
      if (std::none_of(body.geoms.begin(), body.geoms.end(), hidden)) continue;
      notes_.add(sensor.where, "does not see geoms that collide with nothing", factsOf(sensor.kind).name);
      break;
    }
  }
  return true;
}

void Builder::addProbes() {
  if (in_.sensors.empty()) return;
  std::set<std::string> names;
  for (const Sensor& sensor : in_.sensors) {
    Probe probe;
    probe.name = sensor.name;
    probe.kind = sensor.kind;
    probe.unit = factsOf(sensor.kind).unit;
    probe.cutoff = sensor.cutoff;
    if (!aimProbe(sensor, probe)) continue;
    while (!names.insert(probe.name).second) probe.name += "_";
    model_.probes.push_back(std::move(probe));
  }
  if (!model_.probes.empty()) addProbeTree();
}

}  // namespace avbd::mjcf
