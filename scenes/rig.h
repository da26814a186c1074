// A body on one joint to the world, without gravity, its frames placed in four ways.
#pragma once

#include "scenes/build.h"

namespace avbd::scenes {

/// How the frames of a joint lie: frame A turned 45 degrees about z, body B turned, both.
struct Placing {
  static constexpr double kTurn = 3.14159265358979323846 / 4;
  const char* name;
  bool frameA, bodyB;
  Quat frame() const { return turned({0, 0, 1}, frameA ? kTurn : 0); }
  Quat body() const { return turned({0, 1, 0}, bodyB ? kTurn : 0); }
};
inline constexpr Placing kPlacings[] = {
    {"identity", false, false}, {"frame_turned", true, false}, {"body_turned", false, true}, {"both", true, true}};

/// A cube of half extent 0.5: its moment about any axis through its middle is a sixth of its mass. Vectors in frame A.
struct Cube {
  double mass = 6;
  Vec3 arm{};                ///< from the joint to the middle
  Vec3 linear{}, angular{};  ///< of the frame that moves with it [m/s, rad/s]
};

struct Rig {
  Model model;
  JointId joint;
  BodyId body;
  Quat frame;   ///< A's, in the world
  Pose atRest;  ///< the body's pose where all coordinates are zero
  World& world() { return model.world; }

  /// The coordinates, from the body's pose.
  double linear(int axis) const;
  TwistSwing angles() const;
  /// Puts the body where the joint's frame B has moved so in frame A.
  void place(const Pose& inA);
  /// For the next step, along frame A's axes at the joint.
  void push(Vec3 force, Vec3 torque);
};

/// The cube and where its joint stands, before the joint is made.
Rig rigWithout(const Settings& settings, const Placing& placing, const Cube& cube);

template <class Joint>
Rig rigOf(const Settings& settings, const Placing& placing, Joint joint, const Cube& cube = {}) {
  Rig rig = rigWithout(settings, placing, cube);
  joint.bodyB = rig.body;
  joint.frameA = {{}, rig.frame};
  joint.frameB = inverse(rig.atRest) * joint.frameA;
  rig.joint = rig.world().create(joint);
  return rig;
}

}  // namespace avbd::scenes
