// Hinges, sliders and D6 joints (check.h).
#include <cmath>

#include "world/check.h"
#include "world/check_pair.h"
#include "world/limits.h"

namespace avbd {
namespace {

constexpr double kMostTurns = 1e5;  ///< [rad] beyond, a float cannot tell angles apart
constexpr double kHalfTurn = 3.14159274;

bool isInfinite(float x) { return std::isinf(x); }

bool isFree(const D6Joint& def, size_t axis) { return def.axes[axis].motion == AxisMotion::Free; }

bool drives(const JointDrive& drive) { return drive.stiffness > 0 || drive.damping > 0; }

void checkCone(const Path& path, const D6Joint& def) {
  const SwingCone& cone = def.cone;
  const Range angle{0, kHalfTurn, true};
  if (!(isInfinite(cone.y) && cone.y > 0)) check(path / "y", cone.y, angle);
  if (!(isInfinite(cone.z) && cone.z > 0)) check(path / "z", cone.z, angle);
  check(path / "stiffness", cone.stiffness, notNegative(kMaxStiffness));
  check(path / "damping", cone.damping, notNegative(cone.stiffness > 0 ? kMaxStiffness : 0));
  const bool none = isInfinite(cone.y) && isInfinite(cone.z);
  if (!none && !(isFree(def, 4) && isFree(def, 5)))
    (path / "y").refuse(toText(cone.y), "must be infinite, as z, unless SwingY and SwingZ are free");
}

void checkSlerp(const Path& path, const D6Joint& def) {
  checkSlerpDrive(path, def.slerp);
  if (!(def.slerp.stiffness > 0 || def.slerp.damping > 0)) return;
  for (size_t i = 3; i < 6; ++i)
    if (!isFree(def, i) || drives(def.axes[i].drive))
      (path / "stiffness")
          .refuse(toText(def.slerp.stiffness), "must be 0, as damping, unless all angles are free and without drives");
}

/// Of a hinge or slider, whose only free coordinate is `axis`.
template <class Def>
D6Plan oneAxis(const WorldData& data, const Def& def, JointType type, const char* name, JointAxis free) {
  const Path path(name);
  const bool angular = free == JointAxis::Twist;
  D6Plan plan;
  plan.joint = checkedPair(data, def, type, name);
  const D6Axis axis{AxisMotion::Free, def.limit, def.drive, def.friction, def.spring, def.armature, def.maxVelocity};
  checkAxis(path, axis, false, angular, data.def.lengthUnit);
  plan.d6.axis[static_cast<size_t>(free)] = axis;
  return plan;
}

/// Where only one swing is free the frames are turned so that it is the twist.
uint8_t turnOf(const D6Joint& def) {
  const auto free = [&](size_t i) { return def.axes[i].motion == AxisMotion::Free; };
  if (free(3)) return 0;
  if (free(4) && !free(5)) return 1;
  return free(5) && !free(4) ? 2 : 0;
}

}  // namespace

void checkLimit(const Path& path, const JointLimit& limit, bool swing, bool angular, double unit) {
  const double most = swing ? kHalfTurn : angular ? kMostTurns : kMaxSize * unit;
  const Range range = symmetric(most);
  const bool open = isInfinite(limit.lower) && limit.lower < 0;
  if (!open) check(path / "lower", limit.lower, range);
  if (!(isInfinite(limit.upper) && limit.upper > 0)) {
    check(path / "upper", limit.upper, {open ? -most : static_cast<double>(limit.lower), most});
  }
  check(path / "stiffness", limit.stiffness, notNegative(kMaxStiffness));
  check(path / "damping", limit.damping, notNegative(limit.stiffness > 0 ? kMaxStiffness : 0));
  check(path / "restitution", limit.restitution, Range{0, limit.stiffness > 0 ? 0.0 : 1.0});
  if (swing && limit.stiffness <= 0 && limit.lower == limit.upper)
    (path / "upper").refuse(toText(limit.upper), "must be > lower for a hard stop of a swing; lock it instead");
}

void checkSpring(const Path& path, const JointSpring& spring, bool angular, double unit) {
  check(path / "stiffness", spring.stiffness, notNegative(kMaxStiffness));
  check(path / "damping", spring.damping, notNegative(kMaxStiffness));
  check(path / "position", spring.position, symmetric(angular ? kMostTurns : kMaxSize * unit));
}

void checkAxis(const Path& path, const D6Axis& axis, bool swing, bool angular, double unit) {
  if (axis.motion != AxisMotion::Locked && axis.motion != AxisMotion::Free)
    (path / "motion").refuse(toText(static_cast<int>(axis.motion)), "must be Locked or Free");
  checkLimit(path / "limit", axis.limit, swing, angular, unit);
  checkDrive(path / "drive", axis.drive, angular, unit);
  check(path / "friction", axis.friction, notNegative(kMaxForce));
  checkSpring(path / "spring", axis.spring, angular, unit);
  check(path / "armature", axis.armature, notNegative(angular ? kMaxInertia : kMaxMass));
  if (isInfinite(axis.maxVelocity) && axis.maxVelocity > 0) return;
  check(path / "maxVelocity", axis.maxVelocity, positive(angular ? kMaxSpin : kMaxSpeed * unit));
  if (axis.limit.stiffness > 0)
    (path / "maxVelocity").refuse(toText(axis.maxVelocity), "must be infinite where the limit is soft");
}

void checkSlerpDrive(const Path& path, const SlerpDrive& drive) {
  check(path / "stiffness", drive.stiffness, notNegative(kMaxStiffness));
  check(path / "damping", drive.damping, notNegative(kMaxStiffness));
  checkedRotation(path / "rotation", drive.rotation);
  check(path / "velocity", drive.velocity, symmetric(kMaxSpin));
  if (!(isInfinite(drive.maxForce) && drive.maxForce > 0))
    check(path / "maxForce", drive.maxForce, positive(kMaxForce));
}

void checkDrive(const Path& path, const JointDrive& drive, bool angular, double unit) {
  check(path / "stiffness", drive.stiffness, notNegative(kMaxStiffness));
  check(path / "damping", drive.damping, notNegative(kMaxStiffness));
  check(path / "position", drive.position, symmetric(angular ? kMostTurns : kMaxSize * unit));
  check(path / "velocity", drive.velocity, symmetric(angular ? kMaxSpin : kMaxSpeed * unit));
  if (!(isInfinite(drive.maxForce) && drive.maxForce > 0))
    check(path / "maxForce", drive.maxForce, positive(kMaxForce));
  check(path / "force", drive.force, symmetric(kMaxForce));
}

D6Plan checkedJoint(const WorldData& data, const HingeJoint& def) {
  return oneAxis(data, def, JointType::Hinge, "HingeJoint", JointAxis::Twist);
}

D6Plan checkedJoint(const WorldData& data, const SliderJoint& def) {
  return oneAxis(data, def, JointType::Slider, "SliderJoint", JointAxis::LinearX);
}

D6Plan checkedJoint(const WorldData& data, const D6Joint& def) {
  const Path path("D6Joint"), axes = path / "axes";
  D6Plan plan;
  plan.joint = checkedPair(data, def, JointType::D6, "D6Joint");
  plan.d6.turned = turnOf(def);
  for (size_t i = 0; i < 6; ++i) {
    const D6Axis& axis = def.axes[i];
    const bool angular = i >= 3;
    checkAxis(axes[i], axis, i > 3 && plan.d6.turned == 0, angular, data.def.lengthUnit);
    const size_t group = i / 3 * 3, inner = group + (i - group + 3 - plan.d6.turned) % 3;
    plan.d6.axis[inner] = axis;
  }
  checkCone(path / "cone", def);
  checkSlerp(path / "slerp", def);
  plan.d6.cone = def.cone, plan.d6.slerp = def.slerp;
  plan.d6.slerp.rotation = checkedRotation(path / "slerp" / "rotation", def.slerp.rotation);
  return plan;
}

}  // namespace avbd
