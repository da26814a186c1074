// Equalities and excludes of an MJCF description.
#include <cmath>

#include "io/mjcf_builder.h"

namespace avbd::mjcf {

namespace {

/// Adds factor * term; terms of one coordinate become one.
void addTerm(std::vector<CouplingTerm>& terms, CouplingTerm term, float factor) {
  term.factor *= factor;
  for (CouplingTerm& known : terms) {
    if (known.joint != term.joint || known.axis != term.axis) continue;
    known.factor += term.factor;
    return;
  }
  terms.push_back(term);
}

/// Coefficients by powers of o of a polynomial in scale * o + shift.
std::array<double, 5> shifted(const std::array<double, 5>& polynomial, double scale, double shift) {
  std::array<double, 5> out{};
  // Horner's scheme over polynomials.
  for (size_t i = 5; i-- > 0;) {
    for (size_t k = 5; k-- > 0;) out[k] = out[k] * shift + (k > 0 ? out[k - 1] * scale : 0);
    out[0] += polynomial[i];
  }
  return out;
}

double valueAt(const std::array<double, 5>& polynomial, double x) {
  double out = 0;
  for (size_t i = 5; i-- > 0;) out = out * x + polynomial[i];
  return out;
}

bool isCurved(const std::array<double, 5>& p) { return p[2] != 0 || p[3] != 0 || p[4] != 0; }

bool isNothing(const CouplingTerm& t) { return t.factor == 0 && t.square == 0 && t.cube == 0 && t.fourth == 0; }

}  // namespace

void Builder::keep(const Equality& equality, JointId joint) {
  if (!equality.active) model_.world.setEnabled(joint, false);
  if (equality.kind == EqualityKind::Connect || equality.kind == EqualityKind::Weld) {
    holds_.push_back({joint, static_cast<size_t>(equality.bodyA), static_cast<size_t>(equality.bodyB)});
  }
}

void Builder::addEquality(const Equality& equality) {
  if (equality.kind == EqualityKind::Joint || equality.kind == EqualityKind::Tendon) return addRelation(equality);
  addHold(equality);
}

void Builder::addHold(const Equality& equality) {
  const size_t a = static_cast<size_t>(equality.bodyA), b = static_cast<size_t>(equality.bodyB);
  const size_t rootA = rootOf(a), rootB = rootOf(b);
  if (rootA == rootB || (!isDynamic(rootA) && !isDynamic(rootB))) {
    notes_.add(equality.where, "joins bodies that are one rigid body here: left out");
    return;
  }
  const BodyId idA = movingId(rootA), idB = movingId(rootB);
  // Frames: of the joined body within the body of ours, or in the world.
  const Posed frameA = idA ? inRoot(a) : start_[a], frameB = idB ? inRoot(b) : start_[b];
  if (equality.kind == EqualityKind::Weld) return addWeld(equality, idA, idB, frameA, frameB);
  const Posed anchorA = equality.atSites ? equality.siteA : Posed{equality.anchor, {}};
  const Posed anchorB = equality.atSites ? equality.siteB : inverse(rest_[b]) * rest_[a] * anchorA;
  if (equality.kind == EqualityKind::Distance) {
    DistanceJoint joint{.bodyA = idA, .bodyB = idB};
    joint.frameA.position = (frameA * anchorA).position;
    joint.frameB.position = (frameB * anchorB).position;
    joint.min = joint.max = mjcf::narrow(equality.distance, equality.where);
    joint.collideConnected = true;
    return keep(equality, at(equality.where, [&] { return model_.world.create(joint); }));
  }
  BallJoint joint{.bodyA = idA, .bodyB = idB};
  joint.frameA.position = (frameA * anchorA).position;
  joint.frameB.position = (frameB * anchorB).position;
  joint.collideConnected = true;
  keep(equality, at(equality.where, [&] { return model_.world.create(joint); }));
}

void Builder::addWeld(const Equality& equality, BodyId a, BodyId b, const Posed& frameA, const Posed& frameB) {
  FixedJoint joint{.bodyA = a, .bodyB = b};
  if (equality.atSites) {
    joint.frameA = toPose(frameA * equality.siteA);
    joint.frameB = toPose(frameB * equality.siteB);
  } else {
    const Posed relative = equality.hasRelative ? equality.relative
                                                : inverse(rest_[static_cast<size_t>(equality.bodyA)]) *
                                                      rest_[static_cast<size_t>(equality.bodyB)];
    const Posed anchorB{equality.anchor, {}};
    joint.frameA = toPose(frameA * relative * anchorB);
    joint.frameB = toPose(frameB * anchorB);
  }
  joint.collideConnected = true;
  keep(equality, at(equality.where, [&] { return model_.world.create(joint); }));
}

// A - A0 = P(B - B0), A0 and B0 at the joints' references; as ours sum of A's terms - P's = rest.
void Builder::addRelation(const Equality& equality) {
  const bool joints = equality.kind == EqualityKind::Joint;
  const auto length = [&](JointRef joint, int tendon) {
    return joints ? lengthOf(joint) : lengthOf(in_.tendons[static_cast<size_t>(tendon)]);
  };
  for (const int tendon : {equality.tendonA, equality.tendonB}) {
    if (tendon < 0 || !in_.tendons[static_cast<size_t>(tendon)].terms.empty()) continue;
    notes_.add(equality.where, "left out: a relation of spatial tendons");
    return;
  }
  const Length a = length(equality.jointA, equality.tendonA);
  const Length b = equality.alone ? Length{} : length(equality.jointB, equality.tendonB);
  std::array<double, 5> polynomial = equality.polynomial;
  if (isCurved(polynomial) && b.terms.size() > 1) {
    notes_.add(equality.where, "left out: a curved relation to a tendon of several joints");
    return;
  }
  const auto f = [&](double v) { return mjcf::narrow(v, equality.where); };
  const double shift = b.constant - b.reference;
  Coupling coupling;
  for (const CouplingTerm& term : a.terms) addTerm(coupling.terms, term, 1);
  double value = valueAt(polynomial, shift);
  if (!isCurved(polynomial)) {
    for (const CouplingTerm& term : b.terms) addTerm(coupling.terms, term, f(-polynomial[1]));
  } else if (!b.terms.empty()) {
    const std::array<double, 5> c = shifted(polynomial, b.terms[0].factor, shift);
    value = c[0];
    CouplingTerm term = b.terms[0];
    term.factor = f(-c[1]), term.square = f(-c[2]), term.cube = f(-c[3]), term.fourth = f(-c[4]);
    coupling.terms.push_back(term);
  }
  std::erase_if(coupling.terms, isNothing);
  coupling.rest = value - (a.constant - a.reference);
  if (coupling.terms.empty() || coupling.terms.size() > 8) {
    notes_.add(equality.where, coupling.terms.empty() ? "left out: nothing in it moves" : "left out: over 8 joints");
    return;
  }
  keep(equality, at(equality.where, [&] { return model_.world.create(coupling); }));
}

void Builder::addExclude(const Exclude& exclude) {
  const size_t a = static_cast<size_t>(exclude.bodyA), b = static_cast<size_t>(exclude.bodyB);
  const BodyId idA = ids_[rootOf(a)], idB = ids_[rootOf(b)];
  if (!idA || !idB || idA == idB) return;  // never collide anyway
  if (rootOf(a) != a || rootOf(b) != b) {
    notes_.add(exclude.where, "applies to all bodies that are welded to these two");
  }
  at(exclude.where, [&] { return model_.world.excludeCollision(idA, idB); });
}

}  // namespace avbd::mjcf
