// Tendons of an MJCF description: couplings of joints, and ropes between two bodies.
#include <algorithm>

#include "io/mjcf_builder.h"

namespace avbd::mjcf {

// A joint that stands still adds a constant.
Length Builder::lengthOf(JointRef ref) const {
  const Joint& joint = jointOf(in_, ref);
  const std::vector<Coordinate>& known = coordinates_[static_cast<size_t>(ref.body)];
  Length out;
  out.reference = joint.ref;
  out.start = startsOf(static_cast<size_t>(ref.body))[ref.joint];
  if (ref.joint >= known.size() || !known[ref.joint].id) {
    out.constant = out.start;
    return out;
  }
  const Coordinate& at = known[ref.joint];
  out.terms.push_back({.joint = at.id, .axis = at.axis, .factor = static_cast<float>(at.sign)});
  out.constant = at.offset;
  return out;
}

Length Builder::lengthOf(const Tendon& tendon) const {
  Length out;
  for (const TendonTerm& part : tendon.terms) {
    const Length joint = lengthOf(part.joint);
    out.constant += part.factor * joint.constant;
    out.reference += part.factor * joint.reference;
    out.start += part.factor * joint.start;
    for (CouplingTerm term : joint.terms) {
      const auto same = [&](const CouplingTerm& t) { return t.joint == term.joint && t.axis == term.axis; };
      const auto known = std::find_if(out.terms.begin(), out.terms.end(), same);
      term.factor = mjcf::narrow(term.factor * part.factor, tendon.where);
      if (known != out.terms.end()) {
        known->factor += term.factor;
      } else {
        out.terms.push_back(term);
      }
    }
  }
  std::erase_if(out.terms, [](const CouplingTerm& term) { return term.factor == 0; });
  return out;
}

void Builder::addTendon(size_t index, bool driven) {
  const Tendon& tendon = in_.tendons[index];
  if (!tendon.terms.empty()) return addFixed(index, driven);
  if (tendon.sites.empty()) return;  // all its joints were left out, with notes
  if (!tendon.straight || tendon.sites.size() != 2) {
    const std::string name = tendon.name.empty() ? "" : " " + tendon.name;
    notes_.add(tendon.where, "spatial tendon" + name + " is left out: only those between two sites are read");
    return;
  }
  if (tendon.limited || tendon.stiffness > 0 || tendon.damping > 0 || tendon.friction > 0) addStraight(tendon);
}

void Builder::addFixed(size_t index, bool driven) {
  const Tendon& tendon = in_.tendons[index];
  if (!driven && !tendon.limited && tendon.stiffness == 0 && tendon.damping == 0 && tendon.friction == 0 &&
      tendon.armature == 0) {
    return;
  }
  const Length length = lengthOf(tendon);
  if (length.terms.empty() || length.terms.size() > 8) {
    notes_.add(tendon.where, length.terms.empty() ? "left out: nothing in it moves" : "left out: over 8 joints");
    return;
  }
  const auto f = [&](double v) { return mjcf::narrow(v, tendon.where); };
  Coupling coupling{.terms = length.terms};
  D6Axis& axis = coupling.axis;
  axis.motion = AxisMotion::Free;
  axis.friction = f(tendon.friction);
  axis.armature = f(tendon.armature);
  axis.spring.damping = f(tendon.damping);
  if (tendon.limited) {
    axis.limit.lower = f(tendon.lower - length.constant);
    axis.limit.upper = f(tendon.upper - length.constant);
  }
  const std::array<double, 2> rest = tendon.springLength.value_or(std::array{length.reference, length.reference});
  const bool slack = rest[0] < rest[1];
  if (tendon.stiffness > 0 && slack && !tendon.limited) {
    axis.limit = {
        .lower = f(rest[0] - length.constant), .upper = f(rest[1] - length.constant), .stiffness = f(tendon.stiffness)};
  } else if (tendon.stiffness > 0) {
    if (slack) notes_.add(tendon.where, "springlength: beside a range the middle of its two numbers is used");
    axis.spring.stiffness = f(tendon.stiffness);
    axis.spring.position = f((rest[0] + rest[1]) / 2 - length.constant);
  }
  couplings_[index] = at(tendon.where, [&] { return model_.world.create(coupling); });
}

void Builder::addStraight(const Tendon& tendon) {
  const Site &a = in_.sites[static_cast<size_t>(tendon.sites[0])], &b = in_.sites[static_cast<size_t>(tendon.sites[1])];
  const size_t bodyA = static_cast<size_t>(a.body), bodyB = static_cast<size_t>(b.body);
  const size_t rootA = rootOf(bodyA), rootB = rootOf(bodyB);
  if (rootA == rootB || (!isDynamic(rootA) && !isDynamic(rootB))) {
    notes_.add(tendon.where, "left out: its sites do not move against each other");
    return;
  }
  DistanceJoint joint;
  joint.bodyA = movingId(rootA);
  joint.bodyB = movingId(rootB);
  joint.frameA.position = ((joint.bodyA ? inRoot(bodyA) : start_[bodyA]) * a.pose).position;
  joint.frameB.position = ((joint.bodyB ? inRoot(bodyB) : start_[bodyB]) * b.pose).position;
  joint.collideConnected = true;
  if (tendon.limited) addRope(tendon, joint, {std::max(tendon.lower, 0.0), tendon.upper});
  if (tendon.friction > 0) notes_.add(tendon.where, "attribute frictionloss of a spatial tendon is not used");
  if (tendon.damping > 0 && tendon.stiffness == 0) {
    notes_.add(tendon.where, "attribute damping of a spatial tendon without stiffness is not used");
  }
  if (tendon.stiffness == 0) return;
  const double reference = length((rest_[bodyA] * a.pose).position - (rest_[bodyB] * b.pose).position);
  joint.stiffness = mjcf::narrow(tendon.stiffness, tendon.where);
  joint.damping = mjcf::narrow(tendon.damping, tendon.where);
  addRope(tendon, joint, tendon.springLength.value_or(std::array{reference, reference}));
}

void Builder::addRope(const Tendon& tendon, DistanceJoint joint, const std::array<double, 2>& range) {
  constexpr double kShortest = 1e-5;  // the world takes no rope of length 0
  joint.min = mjcf::narrow(std::max(range[0], 0.0), tendon.where);
  joint.max = mjcf::narrow(std::max(range[1], kShortest), tendon.where);
  at(tendon.where, [&] { return model_.world.create(joint); });
}

}  // namespace avbd::mjcf
