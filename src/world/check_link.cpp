// Distance joints, pulleys, couplings and custom joints (check.h).
#include <algorithm>
#include <cmath>

#include "world/check.h"
#include "world/check_pair.h"
#include "world/joint_coordinates.h"
#include "world/joints.h"
#include "world/limits.h"

namespace avbd {
namespace {

constexpr size_t kMostTerms = 8, kMostNumbers = 64;

bool isOpen(float x) { return std::isinf(x) && x > 0; }

/// Where a point of the joint is in the world; the joint is not in any list yet.
Vec3d anchorOf(const WorldData& data, const JointData& joint, int side) {
  if (joint.body[side] == kNone) return joint.frame[side].position;
  const BodyData& body = data.bodies[joint.body[side]];
  return body.position + rotate(body.rotation, joint.frame[side].position - toDouble(body.center));
}

void checkNumbers(const Path& path, const std::vector<float>& numbers) {
  if (numbers.size() > kMostNumbers)
    path.refuse(std::to_string(numbers.size()) + " numbers", "must be at most " + std::to_string(kMostNumbers));
  for (size_t i = 0; i < numbers.size(); ++i)
    if (!std::isfinite(numbers[i])) path[i].refuse(toText(numbers[i]), "must be finite");
}

LinkTerm checkedTerm(const WorldData& data, const CouplingTerm& term, const Path& path) {
  LinkTerm out;
  out.joint = slotOf(data, term.joint, path / "joint");
  if (!isD6(data.joints[out.joint].type))
    (path / "joint").refuse(toText(term.joint), "must name a hinge, slider or D6 joint");
  out.axis = term.axis;
  if (static_cast<size_t>(term.axis) >= 6)
    (path / "axis").refuse(toText(static_cast<int>(term.axis)), "must be one of the six of JointAxis");
  const D6Data& d6 = data.d6[out.joint];
  if (d6.axis[innerAxis(d6, term.axis)].motion == AxisMotion::Locked)
    (path / "axis").refuse(toText(static_cast<int>(term.axis)), "must be an axis that the joint leaves free");
  const Range range = symmetric(kMaxRate);
  check(path / "factor", term.factor, range);
  check(path / "square", term.square, range);
  check(path / "cube", term.cube, range);
  check(path / "fourth", term.fourth, range);
  const float factor[4] = {term.factor, term.square, term.cube, term.fourth};
  if (std::all_of(factor, factor + 4, [](float f) { return f == 0; }))
    (path / "factor").refuse("0", "must not be 0 where square, cube and fourth are");
  std::copy(factor, factor + 4, out.curve.factor);
  return out;
}

void checkFamily(const Path& path, const CustomJoint& def) {
  if (!def.family) (path / "family").refuse("null", "must be a family");
  const int rows = def.family->rowCount();
  if (rows < 1 || rows > kCustomRows)
    (path / "family").refuse(toText(rows) + " rows", "must have 1 .. " + toText(kCustomRows));
  check(path / "bodyCount", def.bodyCount, Range{1, 4});
  checkNumbers(path / "constants", def.constants);
  checkNumbers(path / "memory", def.memory);
}

}  // namespace

LinkPlan checkedJoint(const WorldData& data, const DistanceJoint& def) {
  const Path path("DistanceJoint");
  const double most = kMaxSize * static_cast<double>(data.def.lengthUnit);
  LinkPlan plan;
  plan.joint = checkedPair(data, def, JointType::Distance, "DistanceJoint");
  check(path / "min", def.min, notNegative(most));
  if (!isOpen(def.max)) check(path / "max", def.max, {static_cast<double>(def.min), most});
  if (def.max == 0) (path / "max").refuse("0", "must be > 0; a BallJoint holds two points together");
  if (def.min == 0 && isOpen(def.max)) (path / "max").refuse(toText(def.max), "must be finite where min is 0");
  check(path / "stiffness", def.stiffness, notNegative(kMaxStiffness));
  check(path / "damping", def.damping, notNegative(def.stiffness > 0 ? kMaxStiffness : 0));
  plan.joint.stiffness = def.stiffness;
  plan.link.min = def.min, plan.link.max = def.max, plan.link.damping = def.damping;
  return plan;
}

LinkPlan checkedJoint(const WorldData& data, const PulleyJoint& def) {
  const Path path("PulleyJoint");
  const double unit = static_cast<double>(data.def.lengthUnit);
  LinkPlan plan;
  plan.joint = checkedPair(data, def, JointType::Pulley, "PulleyJoint");
  check(path / "wheelA", def.wheelA, symmetric(kMaxPosition * unit));
  check(path / "wheelB", def.wheelB, symmetric(kMaxPosition * unit));
  check(path / "ratio", def.ratio, {1e-6, kMaxRate});
  check(path / "length", def.length, notNegative(kMaxSize * unit));
  plan.link.wheel[0] = def.wheelA, plan.link.wheel[1] = def.wheelB;
  plan.link.ratio = def.ratio, plan.link.slack = def.slack, plan.link.max = def.length;
  if (def.length > 0) return plan;
  const double now = length(anchorOf(data, plan.joint, 0) - def.wheelA) +
                     static_cast<double>(def.ratio) * length(anchorOf(data, plan.joint, 1) - def.wheelB);
  plan.link.max = static_cast<float>(now);
  if (!(plan.link.max > 0)) (path / "length").refuse("0", "must be given where both points lie at their wheels");
  return plan;
}

LinkPlan checkedJoint(const WorldData& data, const Coupling& def) {
  const Path path("Coupling"), terms = path / "terms";
  LinkPlan plan;
  plan.joint.type = JointType::Coupling;
  plan.joint.collideConnected = true;
  plan.joint.userData = def.userData;
  if (def.terms.empty() || def.terms.size() > kMostTerms)
    terms.refuse(std::to_string(def.terms.size()) + " terms", "must be 1 .. " + std::to_string(kMostTerms));
  for (size_t i = 0; i < def.terms.size(); ++i) {
    plan.link.terms.push_back(checkedTerm(data, def.terms[i], terms[i]));
    for (size_t k = 0; k < i; ++k)
      if (def.terms[k].joint == def.terms[i].joint && def.terms[k].axis == def.terms[i].axis)
        (terms[i] / "joint").refuse(toText(def.terms[i].joint), "must not stand in two terms with one axis");
  }
  checkAxis(path / "axis", def.axis, false, true, static_cast<double>(data.def.lengthUnit));
  const bool locked = def.axis.motion == AxisMotion::Locked;
  check(path / "stiffness", def.stiffness, notNegative(locked ? kMaxStiffness : 0));
  check(path / "damping", def.damping, notNegative(def.stiffness > 0 ? kMaxStiffness : 0));
  if (def.rest) check(path / "rest", *def.rest, symmetric(kMaxForce));
  plan.joint.stiffness = def.stiffness;
  plan.link.axis = def.axis, plan.link.damping = def.damping;
  plan.link.rest = def.rest ? *def.rest : couplingMotion(data, plan.link).position;
  return plan;
}

LinkPlan checkedJoint(const WorldData& data, const CustomJoint& def) {
  const Path path("CustomJoint"), bodies = path / "bodies";
  checkFamily(path, def);
  LinkPlan plan;
  plan.joint.type = JointType::Custom;
  plan.joint.collideConnected = def.collideConnected || def.bodyCount < 2;
  plan.joint.userData = def.userData;
  bool moves = false;
  for (size_t i = 0; i < static_cast<size_t>(def.bodyCount); ++i) {
    plan.joint.body[i] = jointedSlot(data, def.bodies[i], bodies[i]);
    moves = moves || isDynamic(data, plan.joint.body[i]);
    for (size_t k = 0; k < i; ++k)
      if (def.bodies[k] == def.bodies[i]) bodies[i].refuse(toText(def.bodies[i]), "must differ from the other bodies");
  }
  if (!moves) bodies[0].refuse(toText(def.bodies[0]), "must be dynamic where the others are not");
  plan.link.family = def.family, plan.link.bodies = def.bodyCount;
  plan.link.constants = def.constants, plan.link.memory = def.memory;
  return plan;
}

void checkBreak(const Path& path, const JointBreak& limits) {
  if (!isOpen(limits.force)) check(path / "force", limits.force, positive(kMaxForce));
  if (!isOpen(limits.torque)) check(path / "torque", limits.torque, positive(kMaxForce));
}

}  // namespace avbd
