// MJCF tendons.
#include <algorithm>

#include "io/mjcf_parser.h"
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

// A joint with one coordinate; nothing where it may have been left out.
std::optional<JointRef> Parser::scalarJoint(const Attributes& a, std::string_view attribute) {
  const auto it = jointByName_.find(a.requiredText(attribute));
  if (it == jointByName_.end()) {
    if (mayBeLeftOut(a, attribute)) return {};
    a.fail(attribute, "no joint has this name");
  }
  if (jointOf(out_, it->second).kind < JointKind::Slide) a.fail(attribute, "must name a hinge or slide");
  return it->second;
}

int Parser::siteNamed(const Attributes& a, std::string_view attribute) {
  const auto it = siteByName_.find(a.requiredText(attribute));
  if (it != siteByName_.end()) return it->second;
  if (mayBeLeftOut(a, attribute)) return -1;
  a.fail(attribute, "no site has this name");
}

int Parser::tendonNamed(const Attributes& a, std::string_view attribute) {
  const auto it = tendonByName_.find(a.requiredText(attribute));
  if (it != tendonByName_.end()) return it->second;
  if (mayBeLeftOut(a, attribute)) return -1;
  a.fail(attribute, "no tendon has this name");
}

void Parser::readTendons(Elem elem) {
  noteChildren(elem, "tendon");
  for (const Elem child : source_.children(elem)) {
    if (child.name() == "fixed" || child.name() == "spatial") readTendon(child);
  }
}

void Parser::readTendon(Elem elem) {
  checkAttributes(source_, elem, "tendon", notes_);
  const Attributes a = defaults_.resolve(elem, "tendon", Defaults::kMain);
  Tendon tendon;
  tendon.where = source_.where(elem);
  tendon.name = nameOnce(a, tendonNames_);
  if (isLimited(a, "limited", "range")) {
    const std::vector<double> range = a.numbers("range", 2, 2);
    if (!(range[0] < range[1])) a.fail("range", "must be lower and upper, the first less than the second");
    tendon.limited = !off_.limits;
    tendon.lower = range[0];
    tendon.upper = range[1];
  }
  tendon.stiffness = off_.springs ? 0 : notNegative(a, "stiffness", 3);
  tendon.damping = off_.dampers ? 0 : notNegative(a, "damping", 3);
  tendon.friction = off_.frictions ? 0 : notNegative(a, "frictionloss");
  tendon.armature = notNegative(a, "armature");
  const std::vector<double> rest = a.numbers("springlength", 1, 2);
  if (rest.size() == 2 && !(rest[0] <= rest[1])) a.fail("springlength", "the first must not be above the second");
  // -1 asks for the length at the reference.
  if (!rest.empty() && rest[0] != -1) tendon.springLength = {rest.front(), rest.back()};
  noteChildren(elem, elem.name());
  if (elem.name() == "fixed") {
    readFixed(elem, tendon);
  } else {
    readSpatial(elem, tendon);
  }
  if (!tendon.name.empty()) tendonByName_.emplace(tendon.name, static_cast<int>(out_.tendons.size()));
  out_.tendons.push_back(std::move(tendon));
}

void Parser::readFixed(Elem elem, Tendon& tendon) {
  for (const Elem child : source_.children(elem)) {
    if (child.name() != "joint") continue;
    const Attributes a = own(child, "wrap");
    if (!a.has("coef")) a.fail("coef", "must be a number");
    const double factor = a.number("coef", 0);
    const std::optional<JointRef> joint = scalarJoint(a, "joint");
    if (joint) tendon.terms.push_back({*joint, factor});
  }
  if (tendon.terms.empty() && !coordinatesMissing_) source_.fail(elem, "a fixed tendon must have a joint");
}

void Parser::readSpatial(Elem elem, Tendon& tendon) {
  for (const Elem child : source_.children(elem)) {
    const Attributes a = own(child, "wrap");
    if (child.name() == "site") {
      const int site = siteNamed(a, "site");
      tendon.straight = tendon.straight && site >= 0;
      tendon.sites.push_back(site);
    } else if (child.name() == "geom") {
      geomNamed(a, "geom");
      if (a.has("sidesite")) siteNamed(a, "sidesite");
      tendon.straight = false;
    } else if (child.name() == "pulley") {
      if (!(a.number("divisor", 1) > 0)) a.fail("divisor", "must be finite and > 0");
      tendon.straight = false;
    }
  }
  if (tendon.sites.size() < 2) source_.fail(elem, "a spatial tendon must have two sites or more");
}

}  // namespace avbd::mjcf
