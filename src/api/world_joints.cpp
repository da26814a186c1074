// Joints: making, reading back and how well they hold.
#include "api/world_impl.h"
#include "world/check.h"
#include "world/joint_coordinates.h"
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
  constexpr const char* kRange[] = {"must name a ball joint", "must name a fixed joint", "must name a tet volume",
                                    "must name a hinge",      "must name a slider",      "must name a D6 joint"};
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

uint32_t d6SlotOf(const WorldData& data, JointId id, const char* call) {
  const uint32_t slot = slotOf(data, id, Path(call) / "id");
  if (!isD6(data.joints[slot].type)) (Path(call) / "id").refuse(toText(id), "must name a hinge, slider or D6 joint");
  return slot;
}

void checkAxis(const Path& path, JointAxis axis) {
  if (static_cast<size_t>(axis) < 6) return;
  path.refuse(toText(static_cast<int>(axis)), "must be one of the six of JointAxis");
}

/// The coordinate that a hinge or slider leaves free.
JointAxis freeAxisOf(const WorldData& data, JointId id, const char* call) {
  const JointType type = data.joints[d6SlotOf(data, id, call)].type;
  if (type == JointType::Hinge) return JointAxis::Twist;
  if (type == JointType::Slider) return JointAxis::LinearX;
  (Path(call) / "id").refuse(toText(id), "must name a hinge or slider where no axis is given");
}

D6Axis& freeAxis(WorldData& data, JointId id, JointAxis axis, const char* call) {
  const uint32_t slot = d6SlotOf(data, id, call);
  const Path path(call);
  checkAxis(path / "axis", axis);
  D6Axis& to = data.d6[slot].axis[innerAxis(data.d6[slot], axis)];
  if (to.motion == AxisMotion::Locked) {
    (path / "axis").refuse(toText(static_cast<int>(axis)), "must be an axis that the joint leaves free");
  }
  return to;
}

/// A HingeJoint or SliderJoint as it was given, with the limit and drive of now.
template <class Def>
Def oneAxisDef(const WorldData& data, JointId id, JointType type, JointAxis axis, const char* call) {
  const JointData& joint = jointOfType(data, id, type, call);
  const D6Axis& free = data.d6[data.jointIds.slot(id)].axis[static_cast<size_t>(axis)];
  return {bodyIdOf(data, joint.body[0]),
          bodyIdOf(data, joint.body[1]),
          joint.frame[0],
          joint.frame[1],
          free.limit,
          free.drive,
          free.friction,
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

JointId World::create(const HingeJoint& def) {
  const D6Plan plan = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, plan.joint, plan.d6));
}

JointId World::create(const SliderJoint& def) {
  const D6Plan plan = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, plan.joint, plan.d6));
}

JointId World::create(const D6Joint& def) {
  const D6Plan plan = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, plan.joint, plan.d6));
}

void World::destroy(JointId id) { removeJoint(impl_->data, slotOf(impl_->data, id, Path("World::destroy") / "id")); }

JointType World::type(JointId id) const { return jointOf(impl_->data, id, "World::type").type; }

BallJoint World::ballJoint(JointId id) const {
  return pairDef<BallJoint>(impl_->data, jointOfType(impl_->data, id, JointType::Ball, "World::ballJoint"));
}

FixedJoint World::fixedJoint(JointId id) const {
  return pairDef<FixedJoint>(impl_->data, jointOfType(impl_->data, id, JointType::Fixed, "World::fixedJoint"));
}

HingeJoint World::hingeJoint(JointId id) const {
  return oneAxisDef<HingeJoint>(impl_->data, id, JointType::Hinge, JointAxis::Twist, "World::hingeJoint");
}

SliderJoint World::sliderJoint(JointId id) const {
  return oneAxisDef<SliderJoint>(impl_->data, id, JointType::Slider, JointAxis::LinearX, "World::sliderJoint");
}

D6Joint World::d6Joint(JointId id) const {
  const JointData& joint = jointOfType(impl_->data, id, JointType::D6, "World::d6Joint");
  const D6Data& d6 = impl_->data.d6[impl_->data.jointIds.slot(id)];
  D6Joint def;
  def.bodyA = bodyIdOf(impl_->data, joint.body[0]), def.bodyB = bodyIdOf(impl_->data, joint.body[1]);
  def.frameA = joint.frame[0], def.frameB = joint.frame[1];
  def.collideConnected = joint.collideConnected, def.userData = joint.userData;
  for (size_t i = 0; i < 6; ++i) def.axes[i] = d6.axis[innerAxis(d6, static_cast<JointAxis>(i))];
  return def;
}

JointCoordinate World::coordinate(JointId id, JointAxis axis) const {
  const uint32_t slot = d6SlotOf(impl_->data, id, "World::coordinate");
  checkAxis(Path("World::coordinate") / "axis", axis);
  const JointMotion motion = motionOf(impl_->data, slot);
  const size_t i = innerAxis(impl_->data.d6[slot], axis);
  return {motion.position[i], motion.velocity[i]};
}

JointCoordinate World::coordinate(JointId id) const {
  return coordinate(id, freeAxisOf(impl_->data, id, "World::coordinate"));
}

void World::setLimit(JointId id, JointAxis axis, const JointLimit& limit) {
  const Path path("World::setLimit");
  D6Axis& to = freeAxis(impl_->data, id, axis, "World::setLimit");
  const bool swing = static_cast<size_t>(axis) > 3 && impl_->data.d6[impl_->data.jointIds.slot(id)].turned == 0;
  checkLimit(path / "limit", limit, swing, axis >= JointAxis::Twist, impl_->data.def.lengthUnit);
  to.limit = limit;
}

void World::setLimit(JointId id, const JointLimit& limit) {
  setLimit(id, freeAxisOf(impl_->data, id, "World::setLimit"), limit);
}

void World::setDrive(JointId id, JointAxis axis, const JointDrive& drive) {
  const Path path("World::setDrive");
  D6Axis& to = freeAxis(impl_->data, id, axis, "World::setDrive");
  checkDrive(path / "drive", drive, axis >= JointAxis::Twist, impl_->data.def.lengthUnit);
  to.drive = drive;
}

void World::setDrive(JointId id, const JointDrive& drive) {
  setDrive(id, freeAxisOf(impl_->data, id, "World::setDrive"), drive);
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
