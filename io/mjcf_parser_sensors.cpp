// MJCF sensors: what each measures, and of what.
#include <algorithm>
#include <iterator>

#include "io/mjcf_parser.h"

namespace avbd::mjcf {

namespace {

/// What a sensor's attributes must name.
enum class Aim { Site, ScalarJoint, LimitedJoint, Ball, Tendon, LimitedTendon, Actuator, Frame, Subtree, Nothing };

struct SensorRule {
  std::string_view element;
  Aim aim = Aim::Nothing;
  ProbeKind kind = ProbeKind::Clock;
  const char* leftOut = nullptr;  ///< why it maps to nothing here
};

constexpr const char* kLimitForce = "the force of a limit is not told apart from the other forces along its coordinate";
constexpr const char* kGeomDistance = "distances of geoms are not measured";
constexpr const char* kCamera = "cameras are not read";
constexpr const char* kNewer = "sensors of this kind are not supported";

constexpr SensorRule kSensors[] = {
    {"jointpos", Aim::ScalarJoint, ProbeKind::JointPosition},
    {"jointvel", Aim::ScalarJoint, ProbeKind::JointVelocity},
    {"jointactuatorfrc", Aim::ScalarJoint, ProbeKind::JointActuatorForce},
    {"tendonpos", Aim::Tendon, ProbeKind::TendonPosition},
    {"tendonvel", Aim::Tendon, ProbeKind::TendonVelocity},
    {"tendonactuatorfrc", Aim::Tendon, ProbeKind::TendonActuatorForce},
    {"actuatorpos", Aim::Actuator, ProbeKind::ActuatorPosition},
    {"actuatorvel", Aim::Actuator, ProbeKind::ActuatorVelocity},
    {"actuatorfrc", Aim::Actuator, ProbeKind::ActuatorForce},
    {"jointlimitpos", Aim::LimitedJoint, ProbeKind::JointLimitPosition},
    {"jointlimitvel", Aim::LimitedJoint, ProbeKind::JointLimitVelocity},
    {"jointlimitfrc", Aim::LimitedJoint, {}, kLimitForce},
    {"tendonlimitpos", Aim::LimitedTendon, ProbeKind::TendonLimitPosition},
    {"tendonlimitvel", Aim::LimitedTendon, ProbeKind::TendonLimitVelocity},
    {"tendonlimitfrc", Aim::LimitedTendon, {}, kLimitForce},
    {"ballquat", Aim::Ball, ProbeKind::BallRotation},
    {"ballangvel", Aim::Ball, ProbeKind::BallVelocity},
    {"framepos", Aim::Frame, ProbeKind::FramePosition},
    {"framequat", Aim::Frame, ProbeKind::FrameRotation},
    {"framexaxis", Aim::Frame, ProbeKind::FrameXAxis},
    {"frameyaxis", Aim::Frame, ProbeKind::FrameYAxis},
    {"framezaxis", Aim::Frame, ProbeKind::FrameZAxis},
    {"framelinvel", Aim::Frame, ProbeKind::FrameLinearVelocity},
    {"frameangvel", Aim::Frame, ProbeKind::FrameAngularVelocity},
    {"framelinacc", Aim::Frame, ProbeKind::FrameLinearAcceleration},
    {"frameangacc", Aim::Frame, ProbeKind::FrameAngularAcceleration},
    {"accelerometer", Aim::Site, ProbeKind::Accelerometer},
    {"velocimeter", Aim::Site, ProbeKind::Velocimeter},
    {"gyro", Aim::Site, ProbeKind::Gyro},
    {"force", Aim::Site, ProbeKind::Force},
    {"torque", Aim::Site, ProbeKind::Torque},
    {"touch", Aim::Site, ProbeKind::Touch},
    {"rangefinder", Aim::Site, ProbeKind::Rangefinder},
    {"magnetometer", Aim::Site, ProbeKind::Magnetometer},
    {"subtreecom", Aim::Subtree, ProbeKind::SubtreeCenter},
    {"subtreelinvel", Aim::Subtree, ProbeKind::SubtreeVelocity},
    {"subtreeangmom", Aim::Subtree, ProbeKind::SubtreeMomentum},
    {"clock", Aim::Nothing, ProbeKind::Clock},
    {"user", Aim::Nothing, {}, "its value is computed by a program of the user's"},
    {"plugin", Aim::Nothing, {}, "plugins are not run"},
    {"camprojection", Aim::Nothing, {}, kCamera},
    {"distance", Aim::Nothing, {}, kGeomDistance},
    {"normal", Aim::Nothing, {}, kGeomDistance},
    {"fromto", Aim::Nothing, {}, kGeomDistance},
    {"insidesite", Aim::Nothing, {}, kNewer},
    {"e_potential", Aim::Nothing, {}, kNewer},
    {"e_kinetic", Aim::Nothing, {}, kNewer},
    {"contact", Aim::Nothing, {}, kNewer},
    {"tactile", Aim::Nothing, {}, kNewer},
};

const SensorRule* ruleOf(std::string_view element) {
  const auto it = std::find_if(std::begin(kSensors), std::end(kSensors),
                               [&](const SensorRule& rule) { return rule.element == element; });
  return it == std::end(kSensors) ? nullptr : &*it;
}

bool isTurn(ProbeKind kind) { return factsOf(kind).bound == ProbeBound::Unit; }

bool isFrameAcceleration(ProbeKind kind) {
  return kind == ProbeKind::FrameLinearAcceleration || kind == ProbeKind::FrameAngularAcceleration;
}

}  // namespace

void Parser::leaveOut(const Attributes& a, const std::string& why) {
  notes_.add(source_.where(a.elem()), "left out: " + why, a.elem().name());
}

void Parser::readSensors(Elem elem) {
  for (const Elem child : source_.children(elem)) readSensor(child);
}

void Parser::readSensor(Elem elem) {
  const SensorRule* rule = ruleOf(elem.name());
  if (!rule) return notes_.add(source_.where(elem), "unknown element", elem.name());
  const Attributes a = own(elem, "sensor");
  Sensor sensor;
  sensor.where = source_.where(elem);
  sensor.kind = rule->kind;
  sensor.name = nameOnce(a, sensorNames_);
  ++sensorCount_;
  if (sensor.name.empty()) sensor.name = "sensor_" + std::to_string(sensorCount_);
  sensor.cutoff = a.number("cutoff", 0);
  if (sensor.cutoff < 0) a.fail("cutoff", "must be finite and >= 0");
  if (a.number("noise", 0) < 0) a.fail("noise", "must be finite and >= 0");
  const bool aimed = aimSensor(a, sensor);
  if (rule->leftOut) return leaveOut(a, rule->leftOut);
  if (sensor.cutoff > 0 && isTurn(sensor.kind)) a.fail("cutoff", "not allowed for a rotation or an axis");
  if (off_.sensors) return leaveOut(a, "sensors are disabled");
  if (aimed) out_.sensors.push_back(std::move(sensor));
}

// False where what it looks at was left out, with a note.
bool Parser::aimSensor(const Attributes& a, Sensor& sensor) {
  switch (ruleOf(a.elem().name())->aim) {
    case Aim::Site: {
      if (!a.has("site") && a.has("camera")) {
        leaveOut(a, kCamera);
        return false;
      }
      const int index = siteNamed(a, "site");
      if (index < 0) return false;
      const Site& site = out_.sites[static_cast<size_t>(index)];
      sensor.at = {site.body, site.pose};
      sensor.zone = site.zone;
      return true;
    }
    case Aim::ScalarJoint:
    case Aim::LimitedJoint:
    case Aim::Ball:
      return aimAtJoint(a, sensor);
    case Aim::Tendon:
    case Aim::LimitedTendon:
      sensor.tendon = tendonNamed(a, "tendon");
      if (sensor.tendon < 0) return false;
      return ruleOf(a.elem().name())->aim == Aim::Tendon || aimAtRange(a, sensor);
    case Aim::Actuator:
      return aimAtActuator(a, sensor);
    case Aim::Frame:
      return aimAtFrame(a, sensor);
    case Aim::Subtree:
      sensor.at.body = bodyNamed(a, "body");
      return sensor.at.body >= 0;
    case Aim::Nothing:
      break;
  }
  return true;
}

bool Parser::aimAtJoint(const Attributes& a, Sensor& sensor) {
  const Aim aim = ruleOf(a.elem().name())->aim;
  if (aim == Aim::ScalarJoint) {
    const std::optional<JointRef> joint = scalarJoint(a, "joint");
    if (joint) sensor.joint = *joint;
    return joint.has_value();
  }
  const auto it = jointByName_.find(a.requiredText("joint"));
  if (it == jointByName_.end()) {
    if (mayBeLeftOut(a, "joint")) return false;
    a.fail("joint", "no joint has this name");
  }
  sensor.joint = it->second;
  const Joint& joint = jointOf(out_, it->second);
  if (aim == Aim::Ball) {
    if (joint.kind != JointKind::Ball) a.fail("joint", "must name a ball joint");
    return true;
  }
  if (!joint.limited && !off_.limits) a.fail("joint", "must name a joint with a range");
  if (joint.kind >= JointKind::Slide) return true;
  leaveOut(a, "the range of a ball joint is not that of one angle here");
  return false;
}

bool Parser::aimAtRange(const Attributes& a, const Sensor& sensor) {
  const Tendon& tendon = out_.tendons[static_cast<size_t>(sensor.tendon)];
  if (!tendon.limited && !off_.limits) a.fail("tendon", "must name a tendon with a range");
  return true;
}

bool Parser::aimAtActuator(const Attributes& a, Sensor& sensor) {
  const auto it = actuatorByName_.find(a.requiredText("actuator"));
  if (it == actuatorByName_.end()) {
    if (mayBeLeftOut(a, "actuator")) return false;
    a.fail("actuator", "no actuator has this name");
  }
  sensor.actuation = it->second;
  return true;
}

bool Parser::aimAtFrame(const Attributes& a, Sensor& sensor) {
  if (!a.has("objtype")) a.fail("objtype", "must be one of body, xbody, geom, site, camera");
  const std::optional<SensorFrame> at = sensorFrame(a, "obj", isTurn(sensor.kind));
  if (!at) return false;
  sensor.at = *at;
  if (!a.has("reftype") && !a.has("refname")) return true;
  if (!a.has("reftype")) a.fail("reftype", "must be given beside refname");
  sensor.reference = sensorFrame(a, "ref", !isFrameAcceleration(sensor.kind));
  if (isFrameAcceleration(sensor.kind)) {
    notes_.add(sensor.where, "reference frame of an acceleration is not used: it is told in the world's axes");
    sensor.reference.reset();
    return true;
  }
  return sensor.reference.has_value();
}

// What objtype and objname, or reftype and refname, name; nothing where that is not here, with a note.
std::optional<SensorFrame> Parser::sensorFrame(const Attributes& a, const std::string& prefix, bool axes) {
  const std::string name = prefix + "name";
  switch (a.keyword(prefix + "type", {"body", "xbody", "geom", "site", "camera"}, 0)) {
    case 0: {
      const int index = bodyNamed(a, name);
      if (index < 0) return {};
      const Body& body = out_.bodies[static_cast<size_t>(index)];
      const std::optional<Quatd> turn = index == 0 ? Quatd{} : body.inertialAxes;
      if (axes && !turn) {
        leaveOut(a, prefix + "type body asks for axes of inertia that the file does not tell; xbody has others");
        return {};
      }
      return SensorFrame{index, {body.mass.center, turn.value_or(Quatd{})}};
    }
    case 1: {
      const int index = bodyNamed(a, name);
      return index < 0 ? std::nullopt : std::optional(SensorFrame{index, {}});
    }
    case 2: {
      const std::optional<GeomRef> ref = geomNamed(a, name);
      if (!ref) return {};
      const Geom& geom = out_.bodies[static_cast<size_t>(ref->body)].geoms[ref->geom];
      if (geom.kind == GeomKind::Mesh) {
        notes_.add(source_.where(a.elem()), "the frame of a mesh geom is the file's, not that of the mesh's inertia");
      }
      return SensorFrame{ref->body, geom.pose};
    }
    case 3: {
      const int index = siteNamed(a, name);
      if (index < 0) return {};
      const Site& site = out_.sites[static_cast<size_t>(index)];
      return SensorFrame{site.body, site.pose};
    }
    default:
      a.requiredText(name);
      leaveOut(a, kCamera);
      return {};
  }
}

}  // namespace avbd::mjcf
