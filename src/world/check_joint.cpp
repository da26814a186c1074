// Joints (check.h).
#include <algorithm>
#include <cmath>

#include "world/check.h"
#include "world/joints.h"
#include "world/limits.h"

namespace avbd {
namespace {

uint32_t jointedSlot(const WorldData& data, BodyId id, const Path& path) {
  if (!id && id.generation == 0) return kNone;
  if (data.bodyIds.isAlive(id)) return data.bodyIds.slot(id);
  path.refuse(toText(id), "must name a living body of this world, or be null for the world");
}

bool isDynamic(const WorldData& data, uint32_t body) {
  return body != kNone && data.bodies[body].type == BodyType::Dynamic;
}

Pose checkedFrame(const WorldData& data, uint32_t body, const Path& path, const Pose& frame) {
  const double unit = data.def.lengthUnit;
  return checkedPose(path, frame, (body == kNone ? kMaxPosition : kMaxSize) * unit);
}

template <class Def>
JointData checkedPair(const WorldData& data, const Def& def, JointType type, const char* name) {
  const Path path(name);
  JointData joint;
  joint.type = type;
  joint.collideConnected = def.collideConnected;
  joint.userData = def.userData;
  joint.body[0] = jointedSlot(data, def.bodyA, path / "bodyA");
  joint.body[1] = jointedSlot(data, def.bodyB, path / "bodyB");
  if (def.bodyA == def.bodyB) (path / "bodyB").refuse(toText(def.bodyB), "must differ from bodyA");
  if (!isDynamic(data, joint.body[0]) && !isDynamic(data, joint.body[1])) {
    (path / "bodyB").refuse(toText(def.bodyB), "must be dynamic where bodyA is not");
  }
  joint.frame[0] = checkedFrame(data, joint.body[0], path / "frameA", def.frameA);
  joint.frame[1] = checkedFrame(data, joint.body[1], path / "frameB", def.frameB);
  return joint;
}

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
