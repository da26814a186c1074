// MJCF contact, equality and keyframe sections.
#include <cmath>

#include "io/mjcf_parser.h"
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

// A name that nothing here has may be that of a part that was left out.
bool Parser::mayBeLeftOut(const Attributes& a, std::string_view attribute) {
  if (!coordinatesMissing_) return false;
  notes_.add(
      source_.where(a.elem()),
      "left out: " + std::string(attribute) + " " + mjcf::quoted(a.text(attribute)) + " may be among what was left out",
      a.elem().name());
  return true;
}

int Parser::bodyNamed(const Attributes& a, std::string_view attribute) {
  const auto it = bodyByName_.find(a.requiredText(attribute));
  if (it != bodyByName_.end()) return it->second;
  if (mayBeLeftOut(a, attribute)) return -1;
  a.fail(attribute, "no body has this name");
}

std::optional<GeomRef> Parser::geomNamed(const Attributes& a, std::string_view attribute) {
  const auto it = geomByName_.find(a.requiredText(attribute));
  if (it != geomByName_.end()) return it->second;
  if (mayBeLeftOut(a, attribute)) return {};
  a.fail(attribute, "no geom has this name");
}

void Parser::readContact(Elem elem) {
  noteChildren(elem, "contact");
  for (const Elem child : source_.children(elem)) {
    if (child.name() == "exclude") readExclude(child);
    if (child.name() == "pair") readPair(child);
  }
}

void Parser::readExclude(Elem elem) {
  const Attributes a = own(elem, "exclude");
  nameOnce(a, excludeNames_);
  const int bodyA = bodyNamed(a, "body1"), bodyB = bodyNamed(a, "body2");
  if (bodyA >= 0 && bodyB >= 0) out_.excludes.push_back({source_.where(elem), bodyA, bodyB});
}

void Parser::readPair(Elem elem) {
  checkAttributes(source_, elem, "pair", notes_);
  const Attributes a = defaults_.resolve(elem, "pair", Defaults::kMain);
  nameOnce(a, pairNames_);
  Pair pair;
  pair.where = source_.where(elem);
  const std::optional<GeomRef> first = geomNamed(a, "geom1"), second = geomNamed(a, "geom2");
  pair.condim = a.integer("condim", 3);
  pair.hasCondim = a.has("condim");
  if (pair.condim != 1 && pair.condim != 3 && pair.condim != 4 && pair.condim != 6) {
    a.fail("condim", "must be 1, 3, 4 or 6");
  }
  const std::vector<double> friction = a.numbers("friction", 1, 5);
  for (const double value : friction) {
    if (value < 0) a.fail("friction", "each must be finite and >= 0");
  }
  pair.hasFriction = !friction.empty();
  if (pair.hasFriction) pair.friction = friction[0];
  if (friction.size() > 2) pair.torsional = friction[2];
  if (friction.size() > 3) pair.rolling = friction[3];
  if (!first || !second) return;
  pair.a = *first;
  pair.b = *second;
  out_.pairs.push_back(pair);
}

void Parser::readEqualities(Elem elem) {
  noteChildren(elem, "equality");
  for (const Elem child : source_.children(elem)) {
    if (child.name() == "connect" || child.name() == "weld") readEquality(child, child.name() == "weld");
  }
}

void Parser::readEquality(Elem elem, bool weld) {
  checkAttributes(source_, elem, elem.name(), notes_);
  const Attributes a = defaults_.resolve(elem, "equality", Defaults::kMain);
  nameOnce(a, equalityNames_);
  if (a.has("site1") || a.has("site2")) {
    notes_.add(source_.where(elem), std::string(elem.name()) + " between sites is ignored");
    return;
  }
  Equality equality;
  equality.where = source_.where(elem);
  equality.weld = weld;
  equality.bodyA = bodyNamed(a, "body1");
  equality.bodyB = a.has("body2") ? bodyNamed(a, "body2") : 0;
  if (equality.bodyA < 0 || equality.bodyB < 0) return;
  if (equality.bodyA == equality.bodyB) a.fail(a.has("body2") ? "body2" : "body1", "must be two different bodies");
  if (!weld && !a.has("anchor")) a.fail("anchor", "must be 3 numbers");
  equality.anchor = vector(a, "anchor", {});
  if (const auto v = a.numbers("relpose", 7, 7); !v.empty()) {
    const Quatd q{v[3], v[4], v[5], v[6]};
    equality.hasRelative = q.w != 0 || q.x != 0 || q.y != 0 || q.z != 0;  // all zero asks for the file's own poses
    equality.relative = {{v[0], v[1], v[2]}, normalized(q)};
  }
  if (!a.flag("active", true)) {
    notes_.add(equality.where, "not active: left out");
  } else if (!equalitiesOff_) {
    out_.equalities.push_back(std::move(equality));
  }
}

std::vector<double> Parser::keyNumbers(const Attributes& a, std::string_view name, size_t count) {
  if (!a.has(name) || coordinatesMissing_) return {};
  std::vector<double> out = a.numbers(name, 0, size_t{1} << 28);
  if (out.size() != count) {
    source_.fail(a.elem(), std::string(name) + " holds " + std::to_string(out.size()) + " numbers: must be " +
                               std::to_string(count) + ", as many as the joints of this model have");
  }
  return out;
}

void Parser::readKeys(Elem elem) {
  noteChildren(elem, "keyframe");
  for (const Elem child : source_.children(elem)) {
    if (child.name() != "key") continue;
    const Attributes a = own(child, "key");
    Key key;
    key.where = source_.where(child);
    key.name = nameOnce(a, keyNames_);
    key.qpos = keyNumbers(a, "qpos", out_.nq);
    key.qvel = keyNumbers(a, "qvel", out_.nv);
    if (coordinatesMissing_) notes_.add(key.where, "keyframes are not used: parts of the model were left out");
    out_.keys.push_back(std::move(key));
  }
}

}  // namespace avbd::mjcf
