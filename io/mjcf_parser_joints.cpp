// MJCF joints.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/mjcf_parser.h"
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

void Parser::readJoint(Elem elem, const OpenElem& in, bool isFree) {
  Body& body = out_.bodies[static_cast<size_t>(in.body)];
  checkAttributes(source_, elem, elem.name(), notes_);
  const Attributes a = isFree ? own(elem, "freejoint") : defaults_.resolve(elem, "joint", in.cls);
  if (in.body == 0) source_.fail(elem, "the world cannot have a joint");
  if (body.mocap) source_.fail(elem, "a mocap body cannot have joints");
  Joint joint;
  joint.where = source_.where(elem);
  joint.name = nameOnce(a, jointNames_);
  joint.kind =
      isFree ? JointKind::Free : static_cast<JointKind>(a.keyword("type", {"free", "ball", "slide", "hinge"}, 3));
  if (!isFree) {
    joint.pos = in.frame.position + rotate(in.frame.rotation, vector(a, "pos", {}));
    joint.axis = vector(a, "axis", {0, 0, 1});
    if (joint.kind >= JointKind::Slide && !(length(joint.axis) > 1e-14)) a.fail("axis", "must not be zero");
    if (joint.kind >= JointKind::Slide) joint.axis = rotate(in.frame.rotation, joint.axis * (1 / length(joint.axis)));
    joint.ref = a.number("ref", 0) * angleUnit(joint.kind);
    readJointRange(a, joint);
    readJointForces(a, joint);
  }
  checkAmong(elem, body, joint);
  if (joint.kind == JointKind::Free) joint.pos = {};
  if (!joint.name.empty()) jointByName_.emplace(joint.name, JointRef{in.body, body.joints.size()});
  body.joints.push_back(std::move(joint));
}

void Parser::checkAmong(Elem elem, const Body& body, const Joint& joint) {
  if (joint.kind == JointKind::Hinge || joint.kind == JointKind::Ball) {
    for (const Joint& before : body.joints) {
      if (before.kind == JointKind::Ball) source_.fail(elem, "no joint that turns may follow a ball joint");
    }
  }
  const bool freeAmong =
      joint.kind == JointKind::Free || (!body.joints.empty() && body.joints[0].kind == JointKind::Free);
  if (freeAmong && !body.joints.empty()) source_.fail(elem, "a free joint must be the only joint of its body");
  if (freeAmong && body.parent != 0) source_.fail(elem, "a free joint is only allowed in a child of worldbody");
}

double Parser::angleUnit(JointKind kind) const {
  const bool turns = kind == JointKind::Hinge || kind == JointKind::Ball;
  return turns && compiler_.degrees ? std::numbers::pi / 180 : 1;
}

// By its flag, or where that is auto by whether a range is given.
bool Parser::isLimited(const Attributes& a, std::string_view flag, std::string_view range) {
  const int limited = a.keyword(flag, {"false", "true", "auto"}, 2);
  if (limited == 1 && !a.has(range)) a.fail(range, "must be 2 numbers where " + std::string(flag) + " is true");
  if (limited < 2) return limited == 1;
  if (a.has(range) && !compiler_.autoLimits) {
    notes_.add(source_.where(a.elem()), "attribute " + std::string(range) + " is not used without " +
                                            std::string(flag) + ", as autolimits is false");
    return false;
  }
  return a.has(range);
}

void Parser::readJointRange(const Attributes& a, Joint& joint) {
  if (joint.kind == JointKind::Free || !isLimited(a, "limited", "range")) return;
  const std::vector<double> range = a.numbers("range", 2, 2);
  const double unit = angleUnit(joint.kind);
  joint.limited = !off_.limits;
  joint.lower = range[0] * unit;
  joint.upper = range[1] * unit;
  if (joint.kind == JointKind::Ball) {
    if (range[0] != 0 || !(range[1] > 0)) a.fail("range", "must be 0 and the largest turn > 0 for a ball joint");
  } else if (!(range[0] < range[1])) {
    a.fail("range", "must be lower and upper, the first less than the second");
  }
}

double Parser::firstOf(const Attributes& a, std::string_view name) {
  const std::vector<double> values = a.numbers(name, 1, 3);
  if (std::any_of(values.begin() + (values.empty() ? 0 : 1), values.end(), [](double v) { return v != 0; })) {
    notes_.add(source_.where(a.elem()), "attribute " + std::string(name) + ": only its first number is used");
  }
  return values.empty() ? 0 : values[0];
}

double Parser::notNegative(const Attributes& a, std::string_view name, size_t most) {
  const double value = most > 1 ? firstOf(a, name) : a.number(name, 0);
  if (value < 0) a.fail(name, "must be finite and >= 0");
  return value;
}

// Ours are bounded alike both ways.
double Parser::largerOf(const Attributes& a, std::string_view range) {
  const std::vector<double> v = a.numbers(range, 2, 2);
  if (!(v[0] < v[1])) a.fail(range, "must be lower and upper, the first less than the second");
  if (v[0] != -v[1]) {
    notes_.add(source_.where(a.elem()),
               "attribute " + std::string(range) + " is not symmetric: the larger bound is used both ways");
  }
  return std::max(std::abs(v[0]), std::abs(v[1]));
}

void Parser::readJointForces(const Attributes& a, Joint& joint) {
  joint.stiffness = off_.springs ? 0 : notNegative(a, "stiffness", 3);
  joint.damping = off_.dampers ? 0 : notNegative(a, "damping", 3);
  joint.friction = off_.frictions ? 0 : notNegative(a, "frictionloss");
  joint.armature = notNegative(a, "armature");
  joint.springRef = a.number("springref", 0) * angleUnit(joint.kind);
  if (const auto v = a.numbers("springdamper", 2, 2); !v.empty() && v[0] > 0 && v[1] > 0) {
    notes_.add(joint.where, "attribute springdamper is not used");
  }
  const bool scalar = joint.kind >= JointKind::Slide;
  if (scalar && isLimited(a, "actuatorfrclimited", "actuatorfrcrange")) {
    joint.maxForce = largerOf(a, "actuatorfrcrange");
  }
  if (joint.kind != JointKind::Free) return;
  for (const auto& [name, value] : {std::pair{"stiffness", joint.stiffness},
                                    {"damping", joint.damping},
                                    {"frictionloss", joint.friction},
                                    {"armature", joint.armature}}) {
    if (value != 0) notes_.add(joint.where, "attribute " + std::string(name) + " of a free joint is not used");
  }
}

}  // namespace avbd::mjcf
