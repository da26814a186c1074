// Joints that break (break_joints.h).
#include "step/break_joints.h"

#include "world/joints.h"

namespace avbd {

void breakJoints(WorldData& world) {
  for (const uint32_t slot : world.sleep.joints) {
    JointData& joint = world.joints[slot];
    const bool beyond = joint.enabled && (length(joint.reaction.force) > joint.breaks.force ||
                                          length(joint.reaction.torque) > joint.breaks.torque);
    if (beyond && joint.strained) {
      world.events.breaks.push_back({world.jointIds.id(slot), joint.reaction});
      setEnabled(world, slot, false);
      continue;
    }
    joint.strained = beyond;
  }
}

}  // namespace avbd
