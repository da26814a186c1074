// Joints made of others: presets of the D6 joint and of couplings.
#include <avbd/coupling.h>

namespace avbd {
namespace {

D6Joint joining(BodyId bodyA, BodyId bodyB, const Pose& frameA, const Pose& frameB) {
  D6Joint def;
  def.bodyA = bodyA, def.bodyB = bodyB;
  def.frameA = frameA, def.frameB = frameB;
  return def;
}

D6Axis& axisOf(D6Joint& def, JointAxis axis) { return def.axes[static_cast<size_t>(axis)]; }

Coupling held(JointId a, JointAxis axisA, JointId b, JointAxis axisB, float factorA, float factorB) {
  Coupling coupling;
  coupling.terms = {{a, axisA, factorA}, {b, axisB, factorB}};
  return coupling;
}

}  // namespace

D6Joint coneJoint(BodyId bodyA, BodyId bodyB, const Pose& frameA, const Pose& frameB, const SwingCone& cone,
                  const JointLimit& twist) {
  D6Joint def = joining(bodyA, bodyB, frameA, frameB);
  for (const JointAxis axis : {JointAxis::Twist, JointAxis::SwingY, JointAxis::SwingZ})
    axisOf(def, axis).motion = AxisMotion::Free;
  axisOf(def, JointAxis::Twist).limit = twist;
  def.cone = cone;
  return def;
}

D6Joint universalJoint(BodyId bodyA, BodyId bodyB, const Pose& frameA, const Pose& frameB) {
  D6Joint def = joining(bodyA, bodyB, frameA, frameB);
  axisOf(def, JointAxis::SwingY).motion = axisOf(def, JointAxis::SwingZ).motion = AxisMotion::Free;
  return def;
}

D6Joint wheelJoint(BodyId bodyA, BodyId bodyB, const Pose& frameA, const Pose& frameB, const JointSpring& suspension,
                   const JointLimit& travel) {
  D6Joint def = joining(bodyA, bodyB, frameA, frameB);
  D6Axis& up = axisOf(def, JointAxis::LinearZ);
  up.motion = AxisMotion::Free, up.spring = suspension, up.limit = travel;
  axisOf(def, JointAxis::SwingY).motion = AxisMotion::Free;
  return def;
}

Coupling gear(JointId hingeA, JointId hingeB, float ratio) {
  return held(hingeA, JointAxis::Twist, hingeB, JointAxis::Twist, ratio, 1);
}

Coupling rackAndPinion(JointId hinge, JointId slider, float radius) {
  return held(hinge, JointAxis::Twist, slider, JointAxis::LinearX, -radius, 1);
}

Coupling mimic(JointId joint0, JointId joint1, float ratio, float offset, JointAxis axis0, JointAxis axis1) {
  Coupling coupling = held(joint0, axis0, joint1, axis1, 1, ratio);
  coupling.rest = -static_cast<double>(offset);
  return coupling;
}

}  // namespace avbd
