// Joints: making, reading back and how well they hold.
#include "api/world_impl.h"
#include "world/check.h"
#include "world/joints.h"
#include "world/measure.h"

namespace avbd {
namespace {

const JointData& jointOf(const WorldData& data, JointId id, const char* call) {
  return data.joints[slotOf(data, id, Path(call) / "id")];
}

const JointData& jointOfType(const WorldData& data, JointId id, JointType type, const char* call) {
  const JointData& joint = jointOf(data, id, call);
  if (joint.type == type) return joint;
  constexpr const char* kRange[] = {"must name a ball joint", "must name a fixed joint", "must name a tet volume"};
  (Path(call) / "id").refuse(toText(id), kRange[static_cast<size_t>(type)]);
}

BodyId bodyIdOf(const WorldData& data, uint32_t slot) { return slot == kNone ? BodyId{} : data.bodyIds.id(slot); }

// BallJoint and FixedJoint have the same fields.
template <class Def>
Def pairDef(const WorldData& data, const JointData& joint) {
  return {bodyIdOf(data, joint.body[0]),
          bodyIdOf(data, joint.body[1]),
          joint.frame[0],
          joint.frame[1],
          joint.collideConnected,
          joint.userData};
}

}  // namespace

JointId World::create(const BallJoint& def) {
  const JointData joint = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, joint));
}

JointId World::create(const FixedJoint& def) {
  const JointData joint = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, joint));
}

JointId World::create(const TetVolume& def) {
  const JointData joint = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, joint));
}

void World::destroy(JointId id) { removeJoint(impl_->data, slotOf(impl_->data, id, Path("World::destroy") / "id")); }

JointType World::type(JointId id) const { return jointOf(impl_->data, id, "World::type").type; }

BallJoint World::ballJoint(JointId id) const {
  return pairDef<BallJoint>(impl_->data, jointOfType(impl_->data, id, JointType::Ball, "World::ballJoint"));
}

FixedJoint World::fixedJoint(JointId id) const {
  return pairDef<FixedJoint>(impl_->data, jointOfType(impl_->data, id, JointType::Fixed, "World::fixedJoint"));
}

TetVolume World::tetVolume(JointId id) const {
  const JointData& joint = jointOfType(impl_->data, id, JointType::TetVolume, "World::tetVolume");
  TetVolume def{.restVolume = joint.restVolume, .stiffness = joint.stiffness, .userData = joint.userData};
  for (size_t i = 0; i < 4; ++i) def.bodies[i] = bodyIdOf(impl_->data, joint.body[i]);
  return def;
}

JointReaction World::reaction(JointId id) const { return jointOf(impl_->data, id, "World::reaction").reaction; }
double World::gap(JointId id) const { return jointGap(impl_->data, jointOf(impl_->data, id, "World::gap")); }
double World::angleError(JointId id) const {
  return jointAngleError(impl_->data, jointOf(impl_->data, id, "World::angleError"));
}

uint64_t World::userData(JointId id) const { return jointOf(impl_->data, id, "World::userData").userData; }
void World::setUserData(JointId id, uint64_t data) {
  const uint32_t slot = slotOf(impl_->data, id, Path("World::setUserData") / "id");
  impl_->data.joints[slot].userData = data;
}

}  // namespace avbd
