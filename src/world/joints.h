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
inline bool isD6(JointType type) { return type >= JointType::Hinge; }
uint32_t addJoint(WorldData& data, const JointData& joint, const D6Data& d6);

/// The rotation that takes inner axes to the user's (D6Data::turned).
Quat innerAxes(int turned);

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

}  // namespace avbd
