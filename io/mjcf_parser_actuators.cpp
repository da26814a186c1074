// MJCF actuators: every kind becomes gain, bias and bounds.
#include <algorithm>
#include <cmath>
#include <limits>

#include "io/mjcf_parser.h"
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

namespace {

// Kinds share their defaults, but what one kind says of its own law is not another's.
bool saidBy(const Attributes& a, std::string_view name, std::string_view kind) {
  const Attr* attr = a.find(name);
  return attr && attr->from.name() == kind;
}

}  // namespace

void Parser::leaveOut(Actuation& actuation, const std::string& why) {
  if (!actuation.leftOut) notes_.add(actuation.where, "left out: " + why);
  actuation.leftOut = true;
}

void Parser::readActuators(Elem elem) {
  noteChildren(elem, "actuator");
  for (const Elem child : source_.children(elem)) {
    if (sectionOf("actuator", child.name()) == Section::Read) readActuator(child);
  }
}

void Parser::readActuator(Elem elem) {
  checkAttributes(source_, elem, "actuator", notes_);
  const Attributes a = defaults_.resolve(elem, "actuator", Defaults::kMain);
  Actuation actuation;
  actuation.where = source_.where(elem);
  actuation.name = nameOnce(a, actuatorNames_);
  if (const auto gear = a.numbers("gear", 1, 6); !gear.empty()) actuation.gear = gear[0];
  readTransmission(a, actuation);
  readLaw(a, actuation);
  readActuatorRanges(a, actuation);
  if (!actuation.leftOut && actuation.gear == 0) leaveOut(actuation, "its gear is 0");
  if (off_.actuators) leaveOut(actuation, "actuation is disabled");
  if (!actuation.name.empty()) actuatorByName_.emplace(actuation.name, static_cast<int>(out_.actuations.size()));
  out_.actuations.push_back(std::move(actuation));
}

void Parser::readTransmission(const Attributes& a, Actuation& actuation) {
  int given = 0;
  for (const char* name : {"joint", "jointinparent", "tendon", "cranksite", "site", "body"}) given += a.has(name);
  if (given != 1) {
    source_.fail(a.elem(), "must name exactly one of joint, jointinparent, tendon, cranksite, site, body");
  }
  if (a.has("joint") || a.has("jointinparent")) {
    const char* attribute = a.has("joint") ? "joint" : "jointinparent";
    const auto it = jointByName_.find(a.requiredText(attribute));
    if (it == jointByName_.end()) {
      if (!mayBeLeftOut(a, attribute)) a.fail(attribute, "no joint has this name");
      actuation.leftOut = true;
      return;
    }
    actuation.joint = it->second;
    if (jointOf(out_, it->second).kind < JointKind::Slide) leaveOut(actuation, "it moves a ball or free joint");
  } else if (a.has("tendon")) {
    actuation.tendon = tendonNamed(a, "tendon");
    actuation.leftOut = actuation.tendon < 0;
  } else if (a.has("body")) {
    actuation.leftOut = bodyNamed(a, "body") < 0;
    leaveOut(actuation, "adhesion of a body");
  } else if (a.has("cranksite")) {
    siteNamed(a, "cranksite");
    siteNamed(a, "slidersite");
    leaveOut(actuation, "it moves a slider-crank");
  } else {
    siteNamed(a, "site");
    if (a.has("refsite")) siteNamed(a, "refsite");
    leaveOut(actuation, "it moves a site");
  }
}

void Parser::readLaw(const Attributes& a, Actuation& actuation) {
  const std::string_view kind = a.elem().name();
  if (kind == "general") {
    readGeneralLaw(a, actuation);
  } else if (kind == "position" || kind == "velocity") {
    readServo(a, actuation);
  } else if (kind != "motor") {
    leaveOut(actuation, std::string(kind) + " actuators are not supported");
  }
  // A negative spring or damper would feed energy in.
  for (const size_t i : {size_t{1}, size_t{2}}) {
    if (!(actuation.bias[i] > 0)) continue;
    notes_.add(actuation.where, "a bias that grows with " + std::string(i == 1 ? "length" : "speed") + " is not used");
    actuation.bias[i] = 0;
  }
}

void Parser::readServo(const Attributes& a, Actuation& actuation) {
  const bool position = a.elem().name() == "position";
  const auto ownGain = [&](std::string_view name, double otherwise) {
    if (!saidBy(a, name, a.elem().name())) return otherwise;
    const double gain = a.number(name, otherwise);
    if (gain < 0) a.fail(name, "must be finite and >= 0");
    return gain;
  };
  const double common = saidBy(a, "gainprm", "general") ? a.numbers("gainprm", 1, 10)[0] : 1;
  if (position) {
    actuation.gain = ownGain("kp", common);
    actuation.bias = {0, -actuation.gain, -ownGain("kv", 0)};
    if (saidBy(a, "dampratio", "position") && a.number("dampratio", 0) != 0) {
      notes_.add(actuation.where, "attribute dampratio is not used");
    }
    if (saidBy(a, "timeconst", "position") && a.numbers("timeconst", 1, 2)[0] != 0) {
      notes_.add(actuation.where, "attribute timeconst is not used: the control acts at once");
    }
  } else {
    actuation.gain = ownGain("kv", common);
    actuation.bias = {0, 0, -actuation.gain};
  }
}

void Parser::readGeneralLaw(const Attributes& a, Actuation& actuation) {
  const int dynamics =
      a.keyword("dyntype", {"none", "integrator", "filter", "filterexact", "muscle", "user", "plugin"}, 0);
  const int gainKind = a.keyword("gaintype", {"fixed", "affine", "muscle", "user", "plugin"}, 0);
  // A default that a servo's element sets is that of all kinds.
  const bool asPosition = saidBy(a, "kp", "position"), asVelocity = !asPosition && saidBy(a, "kv", "velocity");
  const int biasKind = a.keyword("biastype", {"none", "affine", "muscle", "user", "plugin"}, asPosition || asVelocity);
  if (asPosition) actuation.gain = a.number("kp", 1);
  if (asVelocity) actuation.gain = a.number("kv", 1);
  if (biasKind == 1) actuation.bias[1] = asPosition ? -actuation.gain : 0;
  if (biasKind == 1) actuation.bias[2] = asVelocity ? -actuation.gain : 0;
  const std::vector<double> gain = a.numbers("gainprm", 1, 10), bias = a.numbers("biasprm", 1, 10);
  if (!gain.empty()) actuation.gain = gain[0];
  if (biasKind == 1) std::copy_n(bias.begin(), std::min<size_t>(bias.size(), 3), actuation.bias.begin());
  if (dynamics == 2 || dynamics == 3) {
    notes_.add(actuation.where, "the filter of its control is not used: it acts at once");
  } else if (dynamics != 0) {
    leaveOut(actuation, "dyntype " + a.text("dyntype") + " is not supported");
  }
  const bool affine = gain.size() > 1 && (gain[1] != 0 || (gain.size() > 2 && gain[2] != 0));
  if (gainKind > 1 || (gainKind == 1 && affine)) {
    leaveOut(actuation, "gaintype " + a.text("gaintype") + " is not supported");
  }
  if (biasKind > 1) leaveOut(actuation, "biastype " + a.text("biastype") + " is not supported");
}

void Parser::readActuatorRanges(const Attributes& a, Actuation& actuation) {
  if (isLimited(a, "ctrllimited", "ctrlrange") && !off_.controlRanges) {
    const std::vector<double> range = a.numbers("ctrlrange", 2, 2);
    if (!(range[0] < range[1])) a.fail("ctrlrange", "must be lower and upper, the first less than the second");
    actuation.range = {range[0], range[1]};
  }
  if (isLimited(a, "forcelimited", "forcerange")) actuation.maxForce = largerOf(a, "forcerange");
  if (actuation.leftOut || actuation.tendon >= 0) return;
  const Joint& joint = jointOf(out_, actuation.joint);
  if (const double share = a.number("inheritrange", 0); share > 0 && !actuation.range) {
    if (!joint.limited) a.fail("inheritrange", "needs a joint with a range");
    const double middle = (joint.lower + joint.upper) / 2, half = (joint.upper - joint.lower) / 2 * share;
    actuation.range = {middle - half, middle + half};
  }
  if (actuation.gear != 0) actuation.maxForce = std::min(actuation.maxForce, joint.maxForce / std::abs(actuation.gear));
}

}  // namespace avbd::mjcf
