// A body on one joint to the world (rig.h).
#include "scenes/rig.h"

namespace avbd::scenes {

Rig rigWithout(const Settings& settings, const Placing& placing, const Cube& cube) {
  WorldDef def;
  def.gravity = {};
  Build build("rig", settings, def);
  build.filter(kGhost);
  const Quat frame = placing.frame();
  const Velocity velocity{rotate(frame, cube.linear + cross(cube.angular, cube.arm)), rotate(frame, cube.angular)};
  const Pose atRest{toDouble(rotate(frame, cube.arm)), placing.body()};
  const BodyId body =
      build.box("body", {0.5f, 0.5f, 0.5f}, atRest.position, static_cast<float>(cube.mass), velocity, atRest.rotation);
  return {build.take(), {}, body, frame, atRest};
}

void Rig::place(const Pose& inA) {
  const Pose a{{}, frame};
  world().setPose(body, a * inA * inverse(a) * atRest);
}

double Rig::linear(int axis) const {
  const Pose b = model.world.pose(body) * inverse(atRest);
  const Vec3d q = rotate(conjugate(frame), b.position);
  return axis == 0 ? q.x : axis == 1 ? q.y : q.z;
}

TwistSwing Rig::angles() const {
  const Pose b = model.world.pose(body) * inverse(atRest);
  return twistSwing(conjugate(frame) * b.rotation * frame);
}

void Rig::push(Vec3 force, Vec3 torque) {
  world().addForceAt(body, rotate(frame, force), (model.world.pose(body) * inverse(atRest)).position);
  world().addTorque(body, rotate(frame, torque));
}

}  // namespace avbd::scenes
