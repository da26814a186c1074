// One joint of each kind, as the acceptance lines build them.
#include "scenes/joint_kinds.h"

namespace avbd::scenes {
namespace {

// A swing of half a turn has no twist to lock; free chains whip their last links that far.
constexpr float kSwingMost = 2;
constexpr double kWheelHeight = 3;

template <class Joint>
JointId span(Build& build, Joint def, BodyId a, BodyId b, const Spot& at) {
  def.bodyA = a;
  def.bodyB = b;
  def.frameA = build.inBody(a, {at.a, at.frame});
  def.frameB = build.inBody(b, {at.b, at.frame});
  return build.world().create(def);
}

D6Joint swingAboutY() {
  D6Joint def;
  D6Axis& swing = def.axes[static_cast<size_t>(JointAxis::SwingY)];
  swing.motion = AxisMotion::Free;
  swing.limit.lower = -kSwingMost;
  swing.limit.upper = kSwingMost;
  return def;
}

D6Joint withCone(D6Joint def, float angle) {
  def.cone.y = def.cone.z = angle;
  return def;
}

}  // namespace

const char* nameOf(JointKind kind) {
  switch (kind) {
    case JointKind::Fixed:
      return "fixed";
    case JointKind::Spherical:
      return "spherical";
    case JointKind::Revolute:
      return "revolute";
    case JointKind::Prismatic:
      return "prismatic";
    case JointKind::D6:
      return "d6";
    case JointKind::Distance:
      return "distance";
    case JointKind::Rope:
      return "rope";
    case JointKind::Cone:
      return "cone";
    case JointKind::Pulley:
      return "pulley";
    case JointKind::Universal:
      return "universal";
  }
  return "";
}

bool spans(JointKind kind) {
  return kind == JointKind::Distance || kind == JointKind::Rope || kind == JointKind::Pulley;
}

JointId connect(Build& build, JointKind kind, BodyId a, BodyId b, const Spot& at) {
  const float distance = static_cast<float>(length(at.b - at.a));
  const Vec3d up{0, kWheelHeight, 0};
  switch (kind) {
    case JointKind::Fixed:
      return span(build, FixedJoint{}, a, b, at);
    case JointKind::Spherical:
      return span(build, BallJoint{}, a, b, at);
    case JointKind::Revolute:
      return span(build, HingeJoint{}, a, b, at);
    case JointKind::Prismatic:
      return span(build, SliderJoint{}, a, b, at);
    case JointKind::D6:
      return span(build, swingAboutY(), a, b, at);
    case JointKind::Distance:
      return span(build, DistanceJoint{.min = distance, .max = distance}, a, b, at);
    case JointKind::Rope:
      return span(build, DistanceJoint{.max = distance}, a, b, at);
    case JointKind::Cone:
      return span(build, withCone(coneJoint({}, {}, {}, {}, {}), static_cast<float>(kConeAngle)), a, b, at);
    case JointKind::Pulley:
      return span(build, PulleyJoint{.wheelA = at.a + up, .wheelB = at.b + up}, a, b, at);
    case JointKind::Universal:
      return span(build, withCone(universalJoint({}, {}, {}, {}), kSwingMost), a, b, at);
  }
  return {};
}

std::span<const Holding> holdings() {
  static const Quat kAlongZ = along({0, 0, 1}), kDown = along({0, -1, 0});
  static const Holding kHoldings[] = {{JointKind::Fixed},
                                      {JointKind::Spherical},
                                      {JointKind::Revolute, false, kAlongZ},
                                      {JointKind::Prismatic},
                                      {JointKind::D6},
                                      {JointKind::Distance},
                                      {JointKind::Rope},
                                      {JointKind::Cone, false, kDown},
                                      {JointKind::Pulley},
                                      {JointKind::Universal, false, kDown},
                                      {JointKind::Fixed, true},
                                      {JointKind::Revolute, true},
                                      {JointKind::Prismatic, true},
                                      {JointKind::D6, true},
                                      {JointKind::Cone, true},
                                      {JointKind::Universal, true, kAlongZ}};
  return kHoldings;
}

}  // namespace avbd::scenes
