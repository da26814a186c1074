// Lists of joints by body, anchors and exclusions (joints.h).
#include "world/joints.h"

#include "world/pairs.h"

namespace avbd {
namespace {

void updateAnchor(const WorldData& data, uint32_t slot, JointData& joint, int side) {
  joint.axes[side] = joint.frame[side].rotation;
  if (isD6(joint.type)) joint.axes[side] = joint.axes[side] * innerAxes(data.d6[slot].turned);
  if (joint.body[side] == kNone) return;
  joint.anchor[side] = toFloat(joint.frame[side].position - toDouble(data.bodies[joint.body[side]].center));
}

bool excludes(const JointData& joint) {
  return !joint.collideConnected && joint.body[0] != kNone && joint.body[1] != kNone;
}

void unlink(WorldData& data, uint32_t slot, int side) {
  const uint32_t body = data.joints[slot].body[side];
  uint32_t* link = &data.bodies[body].firstJoint;
  while (*link != slot) {
    JointData& joint = data.joints[*link];
    link = &joint.next[sideOf(joint, body)];
  }
  *link = data.joints[slot].next[side];
}

}  // namespace

Quat innerAxes(int turned) {
  constexpr Quat kTurns[] = {{1, 0, 0, 0}, {0.5f, 0.5f, 0.5f, 0.5f}, {0.5f, -0.5f, -0.5f, -0.5f}};
  return kTurns[turned];
}

uint32_t addJoint(WorldData& data, const JointData& checked) { return addJoint(data, checked, {}); }

uint32_t addJoint(WorldData& data, const JointData& checked, const D6Data& d6) {
  const uint32_t slot = data.jointIds.slot(data.jointIds.create());
  if (isD6(checked.type)) {
    if (slot >= data.d6.size()) data.d6.resize(slot + 1);
    data.d6[slot] = d6;
  }
  if (slot >= data.joints.size()) data.joints.resize(slot + 1);
  JointData& joint = data.joints[slot];
  joint = checked;
  for (int side = 0; side < 4; ++side) {
    if (joint.body[side] == kNone) continue;
    joint.next[side] = data.bodies[joint.body[side]].firstJoint;
    data.bodies[joint.body[side]].firstJoint = slot;
  }
  if (joint.type != JointType::TetVolume) {
    updateAnchor(data, slot, joint, 0);
    updateAnchor(data, slot, joint, 1);
  }
  if (excludes(joint)) exclude(data, joint.body[0], joint.body[1]);
  return slot;
}

void removeJoint(WorldData& data, uint32_t slot) {
  const JointData joint = data.joints[slot];
  for (int side = 0; side < 4; ++side) {
    if (joint.body[side] != kNone) unlink(data, slot, side);
  }
  if (excludes(joint)) endExclusion(data, joint.body[0], joint.body[1]);
  data.joints[slot] = {};
  data.jointIds.destroy(data.jointIds.id(slot));
}

void removeJointsOf(WorldData& data, uint32_t body) {
  while (data.bodies[body].firstJoint != kNone) removeJoint(data, data.bodies[body].firstJoint);
}

void updateAnchorsOf(WorldData& data, uint32_t body) {
  uint32_t slot = data.bodies[body].firstJoint;
  while (slot != kNone) {
    JointData& joint = data.joints[slot];
    const int side = sideOf(joint, body);
    if (joint.type != JointType::TetVolume) updateAnchor(data, slot, joint, side);
    slot = joint.next[side];
  }
}

Pose worldFrame(const WorldData& data, const JointData& joint, int side) {
  if (joint.body[side] == kNone) return joint.frame[side];
  const BodyData& body = data.bodies[joint.body[side]];
  return Pose{body.position, body.rotation} * Pose{toDouble(joint.anchor[side]), joint.axes[side]};
}

double tetVolume(const WorldData& data, const JointData& joint) {
  const Vec3d a = data.bodies[joint.body[0]].position;
  const Vec3d b = data.bodies[joint.body[1]].position - a, c = data.bodies[joint.body[2]].position - a,
              d = data.bodies[joint.body[3]].position - a;
  const Vec3d normal{c.y * d.z - c.z * d.y, c.z * d.x - c.x * d.z, c.x * d.y - c.y * d.x};
  return dot(b, normal) / 6;
}

}  // namespace avbd
