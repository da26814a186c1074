// Acceptance, joints: hard limits met at speed, and soft ones against the equation they stand for.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "scenes/catalogue.h"
#include "scenes/rig.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kLowerAngle = -0.2f, kUpperAngle = 0.5f, kTravel = 2;
constexpr float kHitSpeed = 20;  // [m/s, rad/s]
constexpr float kCone = static_cast<float>(kPi / 6), kEllipseY = 0.3f, kEllipseZ = 0.8f;

using Make = std::function<Rig(const Placing&, const Cube&)>;
/// How far beyond its stops a rig's body is [m, rad]; negative within.
using Excess = std::function<double(const Rig&)>;

/// A joint with stops, ways to run into them, and what is measured.
struct Stopped {
  const char* name;
  Make make;
  std::vector<Cube> hits;
  Excess excess;
  double most;
  const char* unit;
};

double angleOf(const Rig& rig, int axis) {
  const TwistSwing q = rig.angles();
  return axis == 0 ? q.twist : axis == 1 ? q.y : q.z;
}

double beyond(double q, double lower, double upper) { return std::max(q - upper, lower - q); }

/// Along the swing: what the angle is more than the ellipse allows in its direction.
double beyondCone(const Rig& rig, double limitY, double limitZ) {
  const TwistSwing q = rig.angles();
  const double angle = std::hypot(q.y, q.z), n = std::hypot(q.y / limitY, q.z / limitZ);
  return n > 0 ? angle - angle / n : -std::min(limitY, limitZ);
}

Vec3 unit(int axis) { return {axis == 0 ? 1.0f : 0, axis == 1 ? 1.0f : 0, axis == 2 ? 1.0f : 0}; }

std::vector<Cube> slidesAlong(int axis) {
  return {{.linear = unit(axis) * kHitSpeed}, {.linear = unit(axis) * -kHitSpeed}};
}

// The cube's middle is a metre off the axis, so that the joint has to turn its path as well.
std::vector<Cube> turnsAbout(int axis) {
  const Vec3 arm = axis == 0 ? unit(1) : unit(0);
  return {{.arm = arm, .angular = unit(axis) * kHitSpeed}, {.arm = arm, .angular = unit(axis) * -kHitSpeed}};
}

std::vector<Cube> turnsAllAround() {
  std::vector<Cube> hits;
  for (int i = 0; i < 8; ++i) {
    const float angle = static_cast<float>(i * kPi / 4 + 0.1);
    hits.push_back({.arm = unit(0), .angular = {0, kHitSpeed * std::cos(angle), kHitSpeed * std::sin(angle)}});
  }
  return hits;
}

JointLimit angleLimit() { return {.lower = kLowerAngle, .upper = kUpperAngle}; }
JointLimit travelLimit() { return {.lower = -kTravel, .upper = kTravel}; }

D6Joint oneFree(int axis, const JointLimit& limit) {
  D6Joint def;
  def.axes[static_cast<size_t>(axis)].motion = AxisMotion::Free;
  def.axes[static_cast<size_t>(axis)].limit = limit;
  return def;
}

template <class Joint>
Make making(const Settings& settings, const Joint& joint) {
  return [&settings, joint](const Placing& placing, const Cube& cube) { return rigOf(settings, placing, joint, cube); };
}

Excess excessOf(int axis) {
  if (axis < 3) return [axis](const Rig& rig) { return beyond(rig.linear(axis), -kTravel, kTravel); };
  return [axis](const Rig& rig) { return beyond(angleOf(rig, axis - 3), kLowerAngle, kUpperAngle); };
}

std::vector<Stopped> hardStops(const Settings& settings) {
  const auto cone = [&](float y, float z, const JointLimit& twist) {
    return making(settings, coneJoint({}, {}, {}, {}, {.y = y, .z = z}, twist));
  };
  const float none = std::numeric_limits<float>::infinity();
  std::vector<Stopped> list{
      {"revolute", making(settings, HingeJoint{.limit = angleLimit()}), turnsAbout(0), excessOf(3), 0.01, "rad"},
      {"prismatic", making(settings, SliderJoint{.limit = travelLimit()}), slidesAlong(0), excessOf(0), 0.005, "m"},
      {"cone", cone(kCone, kCone, {}), turnsAllAround(), [](const Rig& r) { return beyondCone(r, kCone, kCone); }, 0.01,
       "rad"},
      {"twist", cone(none, none, angleLimit()), turnsAbout(0), excessOf(3), 0.01, "rad"},
      {"elliptic_cone", cone(kEllipseY, kEllipseZ, {}), turnsAllAround(),
       [](const Rig& r) { return beyondCone(r, kEllipseY, kEllipseZ); }, 0.01, "rad"}};
  static constexpr const char* kNames[6] = {"d6_x", "d6_y", "d6_z", "d6_twist", "d6_swing_y", "d6_swing_z"};
  for (int axis = 0; axis < 6; ++axis) {
    const bool angle = axis >= 3;
    list.push_back({kNames[axis], making(settings, oneFree(axis, angle ? angleLimit() : travelLimit())),
                    angle ? turnsAbout(axis - 3) : slidesAlong(axis), excessOf(axis), angle ? 0.01 : 0.005,
                    angle ? "rad" : "m"});
  }
  return list;
}

/// Every way to run into the stops, for a second: the farthest beyond them of all, and of the one that got least far.
void tryHits(std::vector<Figure>& figures, const Stopped& stopped, const Placing& placing) {
  double most = -1e9, least = 1e9;
  for (const Cube& hit : stopped.hits) {
    Rig rig = stopped.make(placing, hit);
    double peak = -1e9;
    for (int i = 0; i < stepsFor(1, kDt); ++i) {
      rig.world().step(static_cast<float>(kDt));
      const double excess = stopped.excess(rig);
      if (!(excess <= peak)) peak = excess;
    }
    most = std::max(most, peak);
    least = std::min(least, peak);
  }
  const std::string params = std::string(stopped.name) + "," + placing.name + ",hits=" + text(kHitSpeed);
  figures.push_back({"overshoot", params, most, -stopped.most, stopped.most, stopped.unit});
  figures.push_back(holds("all_reach_the_stop", least >= -stopped.most, params));
}

// Soft stops: a body a little beyond one, loaded so that it stays there, is a mass on a spring.
constexpr double kStep = 1.0 / 240, kStiffness = 100, kDamping = 4, kLoad = 10, kReleased = 0.15, kStop = 0.5;

struct Soft {
  const char* name;
  Make make;
  int axis;  // JointAxis
};

JointLimit softLimit() {
  JointLimit limit;
  limit.upper = kStop;
  limit.stiffness = kStiffness;
  limit.damping = kDamping;
  return limit;
}

std::vector<Soft> softStops(const Settings& settings) {
  SwingCone cone{.y = kStop, .z = kStop, .stiffness = kStiffness, .damping = kDamping}, ellipse = cone;
  ellipse.z = 2 * ellipse.y;
  const auto coned = [&](const SwingCone& c) { return making(settings, coneJoint({}, {}, {}, {}, c)); };
  std::vector<Soft> list{{"revolute", making(settings, HingeJoint{.limit = softLimit()}), 3},
                         {"prismatic", making(settings, SliderJoint{.limit = softLimit()}), 0},
                         {"cone", coned(cone), 4},
                         {"elliptic_cone", coned(ellipse), 4}};
  static constexpr const char* kNames[6] = {"d6_x", "d6_y", "d6_z", "d6_twist", "d6_swing_y", "d6_swing_z"};
  for (int axis = 0; axis < 6; ++axis)
    list.push_back({kNames[axis], making(settings, oneFree(axis, softLimit())), axis});
  return list;
}

/// Over five seconds: the largest difference from implicit Euler's solution of x'' = load - k x - d x', x beyond the
/// stop, and where it ends.
void trySoft(std::vector<Figure>& figures, const Soft& soft, const Placing& placing) {
  const bool angle = soft.axis >= 3;
  const Vec3 axis = unit(soft.axis % 3);
  Rig rig = soft.make(placing, {.mass = angle ? 6.0 : 1.0});
  const double begin = kStop + kReleased;
  rig.place(angle ? Pose{{}, turned(axis, begin)} : Pose{toDouble(axis) * begin, {}});
  double x = kReleased, v = 0, apart = 0, now = 0;
  for (int i = 0; i < stepsFor(5, kStep); ++i) {
    const Vec3 load = axis * static_cast<float>(kLoad);
    rig.push(angle ? Vec3{} : load, angle ? load : Vec3{});
    rig.world().step(static_cast<float>(kStep));
    v = (v + kStep * (kLoad - kStiffness * x)) / (1 + kStep * kDamping + kStep * kStep * kStiffness);
    x += kStep * v;
    now = (angle ? angleOf(rig, soft.axis - 3) : rig.linear(soft.axis)) - kStop;
    apart = std::max(apart, std::abs(now - x));
  }
  const std::string params = std::string(soft.name) + "," + placing.name + ",soft";
  figures.push_back(atMost("from_spring", apart / (kLoad / kStiffness), 0.02, "of its depth", params));
  figures.push_back(within("rests_beyond_stop", now, kLoad / kStiffness, 0.02, angle ? "rad" : "m", params));
}

std::vector<Figure> limits(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Stopped& stopped : hardStops(settings))
    for (const Placing& placing : kPlacings) tryHits(figures, stopped, placing);
  for (const Soft& soft : softStops(settings))
    for (const Placing& placing : kPlacings) trySoft(figures, soft, placing);
  return figures;
}

}  // namespace

std::vector<Line> limitLines() { return {{"J", "limits", limits, ""}}; }

}  // namespace avbd::scenes
