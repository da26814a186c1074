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

void checkFriction(const Path& path, float friction) { check(path, friction, notNegative(kMaxForce)); }

/// Of a hinge or slider, whose only free coordinate is `axis`.
template <class Def>
D6Plan oneAxis(const WorldData& data, const Def& def, JointType type, const char* name, JointAxis free) {
  const Path path(name);
  const bool angular = free == JointAxis::Twist;
  D6Plan plan;
  plan.joint = checkedPair(data, def, type, name);
  checkLimit(path / "limit", def.limit, false, angular, data.def.lengthUnit);
  checkDrive(path / "drive", def.drive, angular, data.def.lengthUnit);
  checkFriction(path / "friction", def.friction);
  plan.d6.axis[static_cast<size_t>(free)] = {AxisMotion::Free, def.limit, def.drive, def.friction};
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
}

void checkDrive(const Path& path, const JointDrive& drive, bool angular, double unit) {
  check(path / "stiffness", drive.stiffness, notNegative(kMaxStiffness));
  check(path / "damping", drive.damping, notNegative(kMaxStiffness));
  check(path / "position", drive.position, symmetric(angular ? kMostTurns : kMaxSize * unit));
  check(path / "velocity", drive.velocity, symmetric(angular ? kMaxSpin : kMaxSpeed * unit));
  if (!(isInfinite(drive.maxForce) && drive.maxForce > 0))
    check(path / "maxForce", drive.maxForce, positive(kMaxForce));
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
    const Path at = axes[i], limit = at / "limit", drive = at / "drive";
    checkLimit(limit, axis.limit, i > 3 && plan.d6.turned == 0, angular, data.def.lengthUnit);
    checkDrive(drive, axis.drive, angular, data.def.lengthUnit);
    checkFriction(at / "friction", axis.friction);
    const size_t group = i / 3 * 3, inner = group + (i - group + 3 - plan.d6.turned) % 3;
    plan.d6.axis[inner] = axis;
  }
  return plan;
}

}  // namespace avbd
