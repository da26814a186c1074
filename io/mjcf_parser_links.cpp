// MJCF contact, equality and keyframe sections.
#include <algorithm>
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
    if (sectionOf("equality", child.name()) != Section::Read) continue;
    if (child.name().starts_with("flex")) {
      readFlexEquality(child);
    } else {
      readEquality(child);
    }
  }
}

void Parser::readEquality(Elem elem) {
  checkAttributes(source_, elem, "equality", notes_);
  const Attributes a = defaults_.resolve(elem, "equality", Defaults::kMain);
  nameOnce(a, equalityNames_);
  Equality equality;
  equality.where = source_.where(elem);
  equality.active = a.flag("active", true);
  const std::string_view kind = elem.name();
  equality.kind = kind == "connect"  ? EqualityKind::Connect
                  : kind == "weld"   ? EqualityKind::Weld
                  : kind == "joint"  ? EqualityKind::Joint
                  : kind == "tendon" ? EqualityKind::Tendon
                                     : EqualityKind::Distance;
  bool whole = false;
  switch (equality.kind) {
    case EqualityKind::Connect:
    case EqualityKind::Weld:
      whole = readHold(a, equality);
      break;
    case EqualityKind::Joint:
    case EqualityKind::Tendon:
      whole = readRelation(a, equality);
      break;
    case EqualityKind::Distance:
      whole = readDistance(a, equality);
      break;
  }
  if (whole && !off_.equalities) out_.equalities.push_back(std::move(equality));
}

// False where something that it needs was left out, with a note.
bool Parser::readHold(const Attributes& a, Equality& equality) {
  const bool weld = equality.kind == EqualityKind::Weld;
  if (a.has("site1") || a.has("site2")) return holdAtSites(a, equality);
  equality.bodyA = bodyNamed(a, "body1");
  equality.bodyB = a.has("body2") ? bodyNamed(a, "body2") : 0;
  if (equality.bodyA < 0 || equality.bodyB < 0) return false;
  if (equality.bodyA == equality.bodyB) a.fail(a.has("body2") ? "body2" : "body1", "must be two different bodies");
  if (!weld && !a.has("anchor")) a.fail("anchor", "must be 3 numbers");
  equality.anchor = vector(a, "anchor", {});
  if (const auto v = a.numbers("relpose", 7, 7); !v.empty()) {
    const Quatd q{v[3], v[4], v[5], v[6]};
    equality.hasRelative = q.w != 0 || q.x != 0 || q.y != 0 || q.z != 0;  // all zero asks for the file's own poses
    equality.relative = {{v[0], v[1], v[2]}, normalized(q)};
  }
  return true;
}

bool Parser::holdAtSites(const Attributes& a, Equality& equality) {
  const int first = siteNamed(a, "site1"), second = siteNamed(a, "site2");
  if (first < 0 || second < 0) return false;
  const Site &siteA = out_.sites[static_cast<size_t>(first)], &siteB = out_.sites[static_cast<size_t>(second)];
  if (siteA.body == siteB.body) a.fail("site2", "must be in another body than site1");
  equality.atSites = true;
  equality.bodyA = siteA.body;
  equality.bodyB = siteB.body;
  equality.siteA = siteA.pose;
  equality.siteB = siteB.pose;
  return true;
}

bool Parser::readRelation(const Attributes& a, Equality& equality) {
  const bool joints = equality.kind == EqualityKind::Joint;
  const std::string first = joints ? "joint1" : "tendon1", second = joints ? "joint2" : "tendon2";
  equality.alone = !a.has(second);
  const std::vector<double> given = a.numbers("polycoef", 1, 5);
  std::copy(given.begin(), given.end(), equality.polynomial.begin());
  if (!a.has(first)) a.fail(first, "must be given");
  if (!equality.alone && a.text(first) == a.text(second)) a.fail(second, "must be another one than " + first);
  if (joints) {
    const std::optional<JointRef> jointA = scalarJoint(a, first);
    const std::optional<JointRef> jointB = equality.alone ? JointRef{} : scalarJoint(a, second);
    if (jointA) equality.jointA = *jointA;
    if (jointB) equality.jointB = *jointB;
    return jointA && jointB;
  }
  equality.tendonA = tendonNamed(a, first);
  if (!equality.alone) equality.tendonB = tendonNamed(a, second);
  return equality.tendonA >= 0 && (equality.alone || equality.tendonB >= 0);
}

// Of two balls the surfaces' distance is that of the centres less the radii.
bool Parser::readDistance(const Attributes& a, Equality& equality) {
  const std::optional<GeomRef> first = geomNamed(a, "geom1"), second = geomNamed(a, "geom2");
  const double apart = a.number("distance", 0);
  if (apart < 0) a.fail("distance", "must be finite and >= 0");
  if (!first || !second) return false;
  const Geom& geomA = out_.bodies[static_cast<size_t>(first->body)].geoms[first->geom];
  const Geom& geomB = out_.bodies[static_cast<size_t>(second->body)].geoms[second->geom];
  if (geomA.kind != GeomKind::Sphere || geomB.kind != GeomKind::Sphere) {
    notes_.add(equality.where, "left out: a distance is only kept between spheres");
    return false;
  }
  if (first->body == second->body) a.fail("geom2", "must be in another body than geom1");
  equality.bodyA = first->body;
  equality.bodyB = second->body;
  equality.atSites = true;
  equality.siteA = geomA.pose;
  equality.siteB = geomB.pose;
  equality.distance = apart + geomA.size.x + geomB.size.x;
  return true;
}

std::vector<double> Parser::keyNumbers(const Attributes& a, std::string_view name, size_t count) {
  if (!a.has(name) || coordinatesMissing_) return {};
  std::vector<double> out = a.numbers(name, 0, size_t{1} << 28);
  if (out.size() != count) {
    source_.fail(a.elem(), std::string(name) + " holds " + std::to_string(out.size()) + " numbers: must be " +
                               std::to_string(count) + ", as many as the " + (name == "ctrl" ? "actuators" : "joints") +
                               " of this model have");
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
    key.ctrl = keyNumbers(a, "ctrl", out_.actuations.size());
    if (coordinatesMissing_) notes_.add(key.where, "keyframes are not used: parts of the model were left out");
    out_.keys.push_back(std::move(key));
  }
}

}  // namespace avbd::mjcf
