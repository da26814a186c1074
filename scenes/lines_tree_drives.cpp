// Acceptance, articulations: limits, drives, friction, armature and speed bounds of an arm's joint.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kHalf = 0.5, kThick = 0.05;  // [m] of the arm

/// An arm of half extents (.05, .5, .05) that hangs by a hinge about z at its upper end, or on a slider in z; from the
/// world, or from a base that is fixed to it.
struct Arm {
  Model model;
  JointId joint;
  BodyId body;
  World& world() { return model.world; }
  double angle() { return world().coordinate(joint).position; }
  double speed() { return world().velocity(body).angular.z; }
};

struct ArmOf {
  float mass = 0.1f;
  bool gravity = true, onBase = true;
};

template <class Joint>
Arm armOf(const Settings& settings, const Joint& joint, const ArmOf& how = {}) {
  WorldDef def;
  if (!how.gravity) def.gravity = {};
  Build build("arm", settings, def);
  build.filter(kGhost);
  BodyId base;
  if (how.onBase) {
    base = build.box("base", {0.1f, 0.1f, 0.1f}, {0, 0, 0}, 1);
    build.join(FixedJoint{}, {}, base, {});
  }
  const Box half{static_cast<float>(kThick), static_cast<float>(kHalf), static_cast<float>(kThick)};
  const BodyId body = build.box("arm", half, {0, -kHalf, 0}, how.mass);
  const JointId id = build.join(joint, base, body, {{}, along({0, 0, 1})});
  return {build.take(), id, body};
}

/// About the hinge, of 1 kg [m^2].
double inertiaOfOne() { return (4 * kHalf * kHalf + 4 * kThick * kThick) / 12 + kHalf * kHalf; }

std::vector<Figure> limitsBoth(const Settings& settings) {
  constexpr double kLower = -0.2, kUpper = 0.5;
  const HingeJoint hinge{.limit = {.lower = kLower, .upper = kUpper}};
  Arm arm = armOf(settings, hinge);
  double overshoot = -1, reached[2] = {0, 0};
  for (int i = 0; i < stepsFor(6, kDt); ++i) {
    // Two seconds beyond the upper end, the lower one and the upper one.
    const bool up = i / stepsFor(2, kDt) != 1;
    arm.world().setDrive(arm.joint, {.stiffness = 1000, .damping = 50, .position = up ? 2.0f : -2.0f});
    arm.world().step(static_cast<float>(kDt));
    overshoot = std::max({overshoot, arm.angle() - kUpper, kLower - arm.angle()});
    double& end = reached[up ? 1 : 0];
    end = up ? std::max(end, arm.angle()) : std::min(end, arm.angle());
  }
  return {{"overshoot", "k=1000 d=50 target=+-2", overshoot, -0.01, 0.01, "rad"},
          holds("reaches_both", reached[0] < kLower + 0.01 && reached[1] > kUpper - 0.01)};
}

/// Where k (1 - q) balances the weight of the hanging arm.
double statics(double k, double mass) {
  double q = 1;
  for (int i = 0; i < 50; ++i) q = 1 - mass * kGravity * kHalf * std::sin(q) / k;
  return q;
}

// One arm on the world. Position drives bear its weight; speed drives have no stiffness and no weight to bear. An
// acceleration drive's stiffness is that of an arm whose moment about the hinge is one.
std::vector<Figure> drives(const Settings& settings) {
  std::vector<Figure> figures;
  double positions[2] = {0, 0}, speeds[2] = {0, 0};
  for (const bool acceleration : {false, true})
    for (const float mass : {0.01f, 0.1f}) {
      JointDrive drive{.stiffness = 1000, .damping = 50, .position = 1, .acceleration = acceleration};
      Arm arm = armOf(settings, HingeJoint{.drive = drive}, {.mass = mass, .onBase = false});
      for (int i = 0; i < stepsFor(3, kDt); ++i) arm.world().step(static_cast<float>(kDt));
      const double k = acceleration ? 1000 * inertiaOfOne() * mass : 1000;
      const std::string params =
          std::string(acceleration ? "drive=acceleration" : "drive=force") + " mass=" + text(mass) + " k=1000 d=50";
      figures.push_back(within("position", arm.angle(), statics(k, mass), 0.02, "rad", params));
      positions[mass > 0.05f] = arm.angle();

      drive.stiffness = 0, drive.velocity = 2;
      Arm turning = armOf(settings, HingeJoint{.drive = drive}, {.mass = mass, .gravity = false, .onBase = false});
      for (int i = 0; i < stepsFor(0.5, kDt); ++i) turning.world().step(static_cast<float>(kDt));
      figures.push_back(within("speed", turning.speed(), 2, 0.01, "rad/s", params));
      speeds[mass > 0.05f] = turning.speed();
    }
  const std::string params = "drive=acceleration mass=0.01,0.1";
  figures.push_back(within("position_agrees", positions[0], positions[1], 0.01, "rad", params));
  figures.push_back(within("speed_agrees", speeds[0], speeds[1], 0.01, "rad/s", params));
  return figures;
}

std::vector<Figure> jointFriction(const Settings& settings) {
  constexpr float kFrictionTorque = 0.05f, kStart = 5;
  const double inertia = 0.1 * inertiaOfOne(), slowing = kFrictionTorque / inertia;
  Arm arm = armOf(settings, HingeJoint{.friction = kFrictionTorque}, {.gravity = false});
  arm.world().setVelocity(arm.body, {{static_cast<float>(kHalf) * kStart, 0, 0}, {0, 0, kStart}});
  std::vector<Figure> figures;
  const std::string params = "friction=0.05 N m";
  const double stops = kStart / slowing;
  int step = 0;
  for (const double share : {0.25, 0.5, 0.75}) {
    const int until = stepsFor(share * stops, kDt);
    for (; step < until; ++step) arm.world().step(static_cast<float>(kDt));
    figures.push_back(within("speed", arm.speed(), kStart - slowing * until * kDt, 0.02, "rad/s",
                             params + " t=" + text(until * kDt)));
  }
  for (; step < stepsFor(stops + 1, kDt); ++step) arm.world().step(static_cast<float>(kDt));
  figures.push_back(atMost("rests", std::abs(arm.speed()), 1e-4, "rad/s", params));
  return figures;
}

// Two seconds of a steady push: the speed tells the inertia that it moved.
std::vector<Figure> armature(const Settings& settings) {
  std::vector<Figure> figures;
  for (const bool slider : {false, true})
    for (const float added : {0.02f, 1.0f}) {
      Arm arm = slider ? armOf(settings, SliderJoint{.armature = added}, {.gravity = false})
                       : armOf(settings, HingeJoint{.armature = added}, {.gravity = false});
      const float push = 0.1f;
      for (int i = 0; i < stepsFor(2, kDt); ++i) {
        if (slider)
          arm.world().addForce(arm.body, {0, 0, push});
        else
          arm.world().addTorque(arm.body, {0, 0, push});
        arm.world().step(static_cast<float>(kDt));
      }
      const double speed = slider ? arm.world().velocity(arm.body).linear.z : arm.speed();
      const double own = slider ? 0.1 : 0.1 * inertiaOfOne();
      figures.push_back(within("inertia", push * 2 / speed, own + added, 1e-3, slider ? "kg" : "kg m^2",
                               std::string(slider ? "slider" : "hinge") + " armature=" + text(added)));
    }
  return figures;
}

std::vector<Figure> maxVelocity(const Settings& settings) {
  std::vector<Figure> figures;
  for (const float torque : {0.1f, 5.0f}) {
    Arm arm = armOf(settings, HingeJoint{.maxVelocity = 1}, {.gravity = false});
    double peak = 0;
    for (int i = 0; i < stepsFor(3, kDt); ++i) {
      arm.world().addTorque(arm.body, {0, 0, torque});
      arm.world().step(static_cast<float>(kDt));
      peak = std::max(peak, arm.speed());
    }
    const std::string params = "torque=" + text(torque) + " N m";
    figures.push_back(atMost("speed_peak", peak, 1.01, "rad/s", params));
    figures.push_back(within("speed_held", arm.speed(), 1, 0.01, "rad/s", params));
  }
  return figures;
}

}  // namespace

std::vector<Line> treeDriveLines() {
  return {{"A", "limits_both", limitsBoth, ""},
          {"A", "drives", drives, ""},
          {"A", "joint_friction", jointFriction, ""},
          {"A", "armature", armature, ""},
          {"A", "max_velocity", maxVelocity, ""}};
}

}  // namespace avbd::scenes
