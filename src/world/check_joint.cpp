// Joints (check.h).
#include <algorithm>
#include <cmath>

#include "world/check.h"
#include "world/check_pair.h"
#include "world/joints.h"
#include "world/limits.h"

namespace avbd {
namespace {

double longestEdge(const WorldData& data, const JointData& joint) {
  double longest = 0;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < i; ++k) {
      longest = std::max(longest, length(data.bodies[joint.body[i]].position - data.bodies[joint.body[k]].position));
    }
  }
  return longest;
}

}  // namespace

JointData checkedJoint(const WorldData& data, const BallJoint& def) {
  return checkedPair(data, def, JointType::Ball, "BallJoint");
}

JointData checkedJoint(const WorldData& data, const FixedJoint& def) {
  return checkedPair(data, def, JointType::Fixed, "FixedJoint");
}

JointData checkedJoint(const WorldData& data, const TetVolume& def) {
  const Path path("TetVolume");
  const Path bodies = path / "bodies";
  JointData joint;
  joint.type = JointType::TetVolume;
  joint.collideConnected = true;
  joint.userData = def.userData;
  joint.stiffness = def.stiffness;
  for (size_t i = 0; i < 4; ++i) {
    joint.body[i] = slotOf(data, def.bodies[i], bodies[i]);
    for (size_t k = 0; k < i; ++k) {
      if (joint.body[k] == joint.body[i]) bodies[i].refuse(toText(def.bodies[i]), "must differ from the other bodies");
    }
  }
  if (!std::any_of(joint.body, joint.body + 4, [&](uint32_t body) { return isDynamic(data, body); })) {
    bodies[0].refuse(toText(def.bodies[0]), "must be dynamic where the other three are not");
  }
  check(path / "restVolume", def.restVolume, symmetric(kMaxVolume));
  check(path / "stiffness", def.stiffness, notNegative(kMaxStiffness));
  joint.restVolume = def.restVolume;
  if (def.restVolume == 0) {
    const double volume = tetVolume(data, joint), edge = longestEdge(data, joint);
    joint.restVolume = static_cast<float>(volume);
    // Below this the sign of the volume is rounding.
    if (!(std::abs(volume) > 1e-9 * edge * edge * edge) || joint.restVolume == 0) {
      (path / "restVolume").refuse("0", "must be given where the bodies lie in one plane");
    }
    check(path / "restVolume", joint.restVolume, symmetric(kMaxVolume));
  }
  return joint;
}

}  // namespace avbd
