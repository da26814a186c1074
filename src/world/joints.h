// Joints between steps: adding, removing, where their anchors are.
#pragma once

#include "world/world_data.h"

namespace avbd {

uint32_t addJoint(WorldData& data, const JointData& joint);  ///< checked before; returns the slot
void removeJoint(WorldData& data, uint32_t slot);
void removeJointsOf(WorldData& data, uint32_t body);
/// After the centre of mass of `body` has changed.
void updateAnchorsOf(WorldData& data, uint32_t body);

/// Whether D6Data belongs to joints of this type.
inline bool isD6(JointType type) { return type >= JointType::Hinge && type <= JointType::D6; }
/// Whether LinkData does.
inline bool isLink(JointType type) { return type >= JointType::Distance; }
uint32_t addJoint(WorldData& data, const JointData& joint, const D6Data& d6);
uint32_t addJoint(WorldData& data, const JointData& joint, const LinkData& link);

/// Slots in JointData::body that the joint's type uses.
inline int bodyCount(const WorldData& data, uint32_t slot) {
  const JointData& joint = data.joints[slot];
  if (joint.type == JointType::TetVolume) return 4;
  if (joint.type == JointType::Coupling) return 0;
  return joint.type == JointType::Custom ? data.links[slot].bodies : 2;
}
/// Calls f(body slot or kNone) for each body that a joint acts on, of a coupling those of its terms; some more than
/// once.
template <class F>
void forEachBody(const WorldData& data, uint32_t slot, F&& f) {
  const JointData& joint = data.joints[slot];
  if (joint.type == JointType::Coupling) {
    for (const LinkTerm& term : data.links[slot].terms)
      for (int side = 0; side < 2; ++side) f(data.joints[term.joint].body[side]);
    return;
  }
  for (int i = 0; i < bodyCount(data, slot); ++i) f(joint.body[i]);
}
/// Whether f(joint slot) holds of any joint of a body.
template <class F>
bool anyJoint(const WorldData& data, uint32_t body, F&& f);
/// Forgets the forces that were given along coordinates; the lists of what is awake must be up to date.
void clearJointForces(WorldData& data);
/// Enabled, and of a coupling all its joints too.
bool acts(const WorldData& data, uint32_t slot);
void setEnabled(WorldData& data, uint32_t slot, bool enabled);
void setBreaks(WorldData& data, uint32_t slot, const JointBreak& limits);
bool isBreakable(const JointBreak& limits);                                              ///< some bound is finite
bool excludes(const JointData& joint);                                                   ///< its bodies do not collide
void setFrames(WorldData& data, uint32_t slot, const Pose& frameA, const Pose& frameB);  ///< checked before

/// What the user excludes by hand: one of the pair's exclusions (pairs.h), beside those of its joints.
void excludeByHand(WorldData& data, uint32_t bodyA, uint32_t bodyB);
void allowByHand(WorldData& data, uint32_t bodyA, uint32_t bodyB);

/// The rotation that takes inner axes to the user's (D6Data::turned).
Quat innerAxes(int turned);

/// Whether a type has two frames.
bool hasFrames(JointType type);
/// Joint frame 0 or 1 in the world.
Pose worldFrame(const WorldData& data, const JointData& joint, int side);
/// Signed volume between the centres of mass.
double tetVolume(const WorldData& data, const JointData& joint);

/// Which of the joint's bodies this is: 0 .. 3.
inline int sideOf(const JointData& joint, uint32_t body) {
  int side = 0;
  while (side < 3 && joint.body[side] != body) ++side;
  return side;
}

template <class F>
bool anyJoint(const WorldData& data, uint32_t body, F&& f) {
  for (uint32_t slot = data.bodies[body].firstJoint; slot != kNone;) {
    if (f(slot)) return true;
    slot = data.joints[slot].next[sideOf(data.joints[slot], body)];
  }
  return false;
}

}  // namespace avbd
