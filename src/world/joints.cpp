// Lists of joints by body, anchors and exclusions (joints.h).
#include "world/joints.h"

#include <algorithm>
#include <cmath>

#include "world/pairs.h"
#include "world/sleep.h"

namespace avbd {
namespace {

void updateAnchor(const WorldData& data, uint32_t slot, JointData& joint, int side) {
  joint.axes[side] = joint.frame[side].rotation;
  if (isD6(joint.type)) joint.axes[side] = joint.axes[side] * innerAxes(data.d6[slot].turned);
  if (joint.body[side] == kNone) return;
  joint.anchor[side] = toFloat(joint.frame[side].position - toDouble(data.bodies[joint.body[side]].center));
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

bool hasFrames(JointType type) {
  return type != JointType::TetVolume && type != JointType::Coupling && type != JointType::Custom;
}

Quat innerAxes(int turned) {
  constexpr Quat kTurns[] = {{1, 0, 0, 0}, {0.5f, 0.5f, 0.5f, 0.5f}, {0.5f, -0.5f, -0.5f, -0.5f}};
  return kTurns[turned];
}

bool excludes(const JointData& joint) {
  return joint.enabled && !joint.collideConnected && joint.body[0] != kNone && joint.body[1] != kNone;
}

bool isBreakable(const JointBreak& limits) { return std::isfinite(limits.force) || std::isfinite(limits.torque); }

namespace {

template <class T>
void place(std::vector<T>& list, uint32_t slot, const T& value) {
  if (slot >= list.size()) list.resize(slot + 1);
  list[slot] = value;
}

uint32_t link(WorldData& data, uint32_t slot, const JointData& checked) {
  if (slot >= data.joints.size()) data.joints.resize(slot + 1);
  JointData& joint = data.joints[slot];
  joint = checked;
  for (int side = 0; side < 4; ++side) {
    if (joint.body[side] == kNone) continue;
    joint.next[side] = data.bodies[joint.body[side]].firstJoint;
    data.bodies[joint.body[side]].firstJoint = slot;
  }
  if (hasFrames(joint.type)) {
    updateAnchor(data, slot, joint, 0);
    updateAnchor(data, slot, joint, 1);
  }
  data.sleep.newJoints.push_back(slot);
  wakeJoint(data, slot);
  if (excludes(joint)) exclude(data, joint.body[0], joint.body[1]);
  return slot;
}

void removeCouplingsOf(WorldData& data, uint32_t joint) {
  for (size_t i = 0; i < data.couplings.size();) {
    const std::vector<LinkTerm>& terms = data.links[data.couplings[i]].terms;
    const bool names = std::any_of(terms.begin(), terms.end(), [&](const LinkTerm& t) { return t.joint == joint; });
    names ? removeJoint(data, data.couplings[i]) : static_cast<void>(++i);
  }
}

}  // namespace

uint32_t addJoint(WorldData& data, const JointData& checked) {
  return link(data, data.jointIds.slot(data.jointIds.create()), checked);
}

uint32_t addJoint(WorldData& data, const JointData& checked, const D6Data& d6) {
  const uint32_t slot = data.jointIds.slot(data.jointIds.create());
  place(data.d6, slot, d6);
  return link(data, slot, checked);
}

uint32_t addJoint(WorldData& data, const JointData& checked, const LinkData& with) {
  const uint32_t slot = data.jointIds.slot(data.jointIds.create());
  place(data.links, slot, with);
  if (checked.type == JointType::Coupling)
    data.couplings.insert(std::lower_bound(data.couplings.begin(), data.couplings.end(), slot), slot);
  return link(data, slot, checked);
}

void clearJointForces(WorldData& data) {
  if (!data.jointForces) return;
  for (const uint32_t slot : data.sleep.joints) {
    if (slot < data.d6.size()) std::fill(std::begin(data.d6[slot].force), std::end(data.d6[slot].force), 0.0f);
    if (slot < data.links.size()) data.links[slot].force = 0;
  }
  data.jointForces = false;
}

bool acts(const WorldData& data, uint32_t slot) {
  if (!data.joints[slot].enabled) return false;
  if (data.joints[slot].type != JointType::Coupling) return true;
  const std::vector<LinkTerm>& terms = data.links[slot].terms;
  return std::all_of(terms.begin(), terms.end(), [&](const LinkTerm& t) { return data.joints[t.joint].enabled; });
}

void setEnabled(WorldData& data, uint32_t slot, bool enabled) {
  JointData& joint = data.joints[slot];
  if (joint.enabled == enabled) return;
  wakeJoint(data, slot);
  if (excludes(joint)) endExclusion(data, joint.body[0], joint.body[1]);
  joint.enabled = enabled, joint.strained = false;
  if (excludes(joint)) exclude(data, joint.body[0], joint.body[1]);
  if (enabled) return;
  joint.reaction = {};
  std::fill(std::begin(joint.lambda), std::end(joint.lambda), 0.0f);
  if (isD6(joint.type)) {
    D6Data& d6 = data.d6[slot];
    std::fill(std::begin(d6.lambda), std::end(d6.lambda), JointMultipliers{});
    d6.coneLambda = 0, d6.slerpLambda = {}, d6.twistKnown = false;
  }
  if (isLink(joint.type)) data.links[slot].lambda = {};
}

void setBreaks(WorldData& data, uint32_t slot, const JointBreak& limits) {
  JointData& joint = data.joints[slot];
  data.breakable -= isBreakable(joint.breaks);
  joint.breaks = limits, joint.strained = false;
  data.breakable += isBreakable(limits);
}

void setFrames(WorldData& data, uint32_t slot, const Pose& frameA, const Pose& frameB) {
  JointData& joint = data.joints[slot];
  wakeJoint(data, slot);
  joint.frame[0] = frameA, joint.frame[1] = frameB;
  updateAnchor(data, slot, joint, 0);
  updateAnchor(data, slot, joint, 1);
}

void removeJoint(WorldData& data, uint32_t slot) {
  if (!data.couplings.empty()) {
    std::erase(data.couplings, slot);
    removeCouplingsOf(data, slot);
  }
  wakeJoint(data, slot);
  data.sleep.stale = true;
  data.breakable -= isBreakable(data.joints[slot].breaks);
  if (isLink(data.joints[slot].type)) data.links[slot] = {};
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
    if (hasFrames(joint.type)) updateAnchor(data, slot, joint, side);
    slot = joint.next[side];
  }
}

namespace {

size_t exclusionsByJoints(const WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  size_t count = 0;
  for (uint32_t slot = data.bodies[bodyA].firstJoint; slot != kNone;) {
    const JointData& joint = data.joints[slot];
    count += excludes(joint) && (joint.body[0] == bodyB || joint.body[1] == bodyB);
    slot = joint.next[sideOf(joint, bodyA)];
  }
  return count;
}

bool isExcludedByHand(const WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  return exclusionsOf(data, bodyA, bodyB) > exclusionsByJoints(data, bodyA, bodyB);
}

}  // namespace

void excludeByHand(WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  if (!isExcludedByHand(data, bodyA, bodyB)) exclude(data, bodyA, bodyB);
}

void allowByHand(WorldData& data, uint32_t bodyA, uint32_t bodyB) {
  if (isExcludedByHand(data, bodyA, bodyB)) endExclusion(data, bodyA, bodyB);
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
