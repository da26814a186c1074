// What all joints of two bodies have to keep: living bodies, two different ones, one that can move, sound frames.
#pragma once

#include "world/check.h"
#include "world/limits.h"

namespace avbd {

inline uint32_t jointedSlot(const WorldData& data, BodyId id, const Path& path) {
  if (!id && id.generation == 0) return kNone;
  if (data.bodyIds.isAlive(id)) return data.bodyIds.slot(id);
  path.refuse(toText(id), "must name a living body of this world, or be null for the world");
}

inline Pose checkedFrame(const WorldData& data, uint32_t body, const Path& path, const Pose& frame) {
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

}  // namespace avbd
