// Joints while they run: coordinates, limits, drives, forces, frames, enabling and breaking.
#include "api/world_impl.h"
#include "world/check.h"
#include "world/check_pair.h"
#include "world/joint_coordinates.h"
#include "world/joints.h"
#include "world/sleep.h"

namespace avbd {
namespace {

uint32_t d6SlotOf(const WorldData& data, JointId id, const char* call) {
  const uint32_t slot = slotOf(data, id, Path(call) / "id");
  if (!isD6(data.joints[slot].type)) (Path(call) / "id").refuse(toText(id), "must name a hinge, slider or D6 joint");
  return slot;
}

void checkAxisName(const Path& path, JointAxis axis) {
  if (static_cast<size_t>(axis) < 6) return;
  path.refuse(toText(static_cast<int>(axis)), "must be one of the six of JointAxis");
}

/// A hinge, slider or D6 joint, or kNone: then it is a coupling.
uint32_t drivenSlotOf(const WorldData& data, JointId id, const char* call) {
  const uint32_t slot = slotOf(data, id, Path(call) / "id");
  return data.joints[slot].type == JointType::Coupling ? kNone : d6SlotOf(data, id, call);
}

/// The coordinate that a hinge or slider leaves free.
JointAxis freeAxisOf(const WorldData& data, JointId id, const char* call) {
  const JointType type = data.joints[d6SlotOf(data, id, call)].type;
  if (type == JointType::Hinge) return JointAxis::Twist;
  if (type == JointType::Slider) return JointAxis::LinearX;
  (Path(call) / "id").refuse(toText(id), "must name a hinge or slider where no axis is given");
}

D6Axis& freeCoupling(WorldData& data, JointId id, const char* call) {
  D6Axis& axis = data.links[data.jointIds.slot(id)].axis;
  if (axis.motion == AxisMotion::Locked) (Path(call) / "id").refuse(toText(id), "must name a coupling that is free");
  return axis;
}

D6Axis& freeAxis(WorldData& data, JointId id, JointAxis axis, const char* call) {
  const uint32_t slot = d6SlotOf(data, id, call);
  const Path path(call);
  checkAxisName(path / "axis", axis);
  D6Axis& to = data.d6[slot].axis[innerAxis(data.d6[slot], axis)];
  if (to.motion == AxisMotion::Locked) {
    (path / "axis").refuse(toText(static_cast<int>(axis)), "must be an axis that the joint leaves free");
  }
  return to;
}

}  // namespace

namespace {

bool isCoupling(const WorldData& data, JointId id, const char* call) { return drivenSlotOf(data, id, call) == kNone; }

bool isSwing(const WorldData& data, JointId id, JointAxis axis) {
  return static_cast<size_t>(axis) > 3 && data.d6[data.jointIds.slot(id)].turned == 0;
}

/// What the bounds of an axis depend on.
struct AxisKind {
  bool swing, angular;
};
constexpr AxisKind kOfCoupling{false, true};

AxisKind kindOf(const WorldData& data, JointId id, JointAxis axis) {
  return {isSwing(data, id, axis), axis >= JointAxis::Twist};
}

/// `axis` with its `part` replaced must be sound as a whole. A joint that is told what it knows sleeps on.
template <class Part>
bool setPart(const WorldData& data, D6Axis& axis, Part D6Axis::*part, const Part& value, const Path& path,
             AxisKind kind) {
  D6Axis changed = axis;
  changed.*part = value;
  checkAxis(path, changed, kind.swing, kind.angular, static_cast<double>(data.def.lengthUnit));
  const bool changes = !(axis.*part == value);
  axis = changed;
  return changes;
}

template <class Part>
void setCouplingPart(WorldData& data, JointId id, Part D6Axis::*part, const Part& value, const char* call) {
  if (setPart(data, freeCoupling(data, id, call), part, value, Path(call), kOfCoupling))
    wakeJoint(data, data.jointIds.slot(id));
}

}  // namespace

JointCoordinate World::coordinate(JointId id, JointAxis axis) const {
  const uint32_t slot = d6SlotOf(impl_->data, id, "World::coordinate");
  checkAxisName(Path("World::coordinate") / "axis", axis);
  const JointMotion motion = motionOf(impl_->data, slot);
  const size_t i = innerAxis(impl_->data.d6[slot], axis);
  return {motion.position[i], motion.velocity[i]};
}

JointCoordinate World::coordinate(JointId id) const {
  const uint32_t slot = slotOf(impl_->data, id, Path("World::coordinate") / "id");
  const JointType type = impl_->data.joints[slot].type;
  if (type == JointType::Distance || type == JointType::Pulley || type == JointType::Coupling) {
    const LinkMotion motion = linkMotionOf(impl_->data, slot);
    return {motion.position, motion.velocity};
  }
  return coordinate(id, freeAxisOf(impl_->data, id, "World::coordinate"));
}

void World::setLimit(JointId id, JointAxis axis, const JointLimit& limit) {
  D6Axis& to = freeAxis(impl_->data, id, axis, "World::setLimit");
  if (setPart(impl_->data, to, &D6Axis::limit, limit, Path("World::setLimit"), kindOf(impl_->data, id, axis)))
    wakeJoint(impl_->data, impl_->data.jointIds.slot(id));
}

void World::setLimit(JointId id, const JointLimit& limit) {
  constexpr const char* kCall = "World::setLimit";
  if (!isCoupling(impl_->data, id, kCall)) return setLimit(id, freeAxisOf(impl_->data, id, kCall), limit);
  setCouplingPart(impl_->data, id, &D6Axis::limit, limit, kCall);
}

void World::setDrive(JointId id, JointAxis axis, const JointDrive& drive) {
  const Path path("World::setDrive");
  D6Axis& to = freeAxis(impl_->data, id, axis, "World::setDrive");
  const D6Data& d6 = impl_->data.d6[impl_->data.jointIds.slot(id)];
  const bool slerps = axis >= JointAxis::Twist && (d6.slerp.stiffness > 0 || d6.slerp.damping > 0);
  if (slerps && (drive.stiffness > 0 || drive.damping > 0))
    (path / "drive").refuse("a drive", "must have neither stiffness nor damping beside a slerp drive");
  if (setPart(impl_->data, to, &D6Axis::drive, drive, path, kindOf(impl_->data, id, axis)))
    wakeJoint(impl_->data, impl_->data.jointIds.slot(id));
}

void World::setDrive(JointId id, const JointDrive& drive) {
  constexpr const char* kCall = "World::setDrive";
  if (!isCoupling(impl_->data, id, kCall)) return setDrive(id, freeAxisOf(impl_->data, id, kCall), drive);
  setCouplingPart(impl_->data, id, &D6Axis::drive, drive, kCall);
}

void World::setSpring(JointId id, JointAxis axis, const JointSpring& spring) {
  D6Axis& to = freeAxis(impl_->data, id, axis, "World::setSpring");
  if (setPart(impl_->data, to, &D6Axis::spring, spring, Path("World::setSpring"), kindOf(impl_->data, id, axis)))
    wakeJoint(impl_->data, impl_->data.jointIds.slot(id));
}

void World::setSpring(JointId id, const JointSpring& spring) {
  constexpr const char* kCall = "World::setSpring";
  if (!isCoupling(impl_->data, id, kCall)) return setSpring(id, freeAxisOf(impl_->data, id, kCall), spring);
  setCouplingPart(impl_->data, id, &D6Axis::spring, spring, kCall);
}

void World::setSlerp(JointId id, const SlerpDrive& drive) {
  const Path path("World::setSlerp");
  const uint32_t slot = d6SlotOf(impl_->data, id, "World::setSlerp");
  D6Data& d6 = impl_->data.d6[slot];
  checkSlerpDrive(path / "drive", drive);
  if (drive.stiffness > 0 || drive.damping > 0)
    for (size_t i = 3; i < 6; ++i)
      if (d6.axis[i].motion == AxisMotion::Locked || d6.axis[i].drive.stiffness > 0 || d6.axis[i].drive.damping > 0)
        (path / "id").refuse(toText(id), "must name a joint whose angles are all free and without drives");
  SlerpDrive wanted = drive;
  wanted.rotation = checkedRotation(path / "drive" / "rotation", drive.rotation);
  if (!(d6.slerp == wanted)) wakeJoint(impl_->data, slot);
  d6.slerp = wanted;
}

void World::addJointForce(JointId id, JointAxis axis, float force) {
  const Path path("World::addJointForce");
  freeAxis(impl_->data, id, axis, "World::addJointForce");
  check(path / "force", force, symmetric(kMaxForce));
  D6Data& d6 = impl_->data.d6[impl_->data.jointIds.slot(id)];
  if (force != 0) wakeJoint(impl_->data, impl_->data.jointIds.slot(id));
  d6.force[innerAxis(d6, axis)] += force;
  impl_->data.jointForces = true;
}

void World::addJointForce(JointId id, float force) {
  const Path path("World::addJointForce");
  if (!isCoupling(impl_->data, id, "World::addJointForce"))
    return addJointForce(id, freeAxisOf(impl_->data, id, "World::addJointForce"), force);
  freeCoupling(impl_->data, id, "World::addJointForce");
  check(path / "force", force, symmetric(kMaxForce));
  const uint32_t slot = impl_->data.jointIds.slot(id);
  if (force != 0) wakeJoint(impl_->data, slot);
  impl_->data.links[slot].force += force;
  impl_->data.jointForces = true;
}

void World::setFrames(JointId id, const Pose& frameA, const Pose& frameB) {
  const Path path("World::setFrames");
  WorldData& data = impl_->data;
  const uint32_t slot = slotOf(data, id, path / "id");
  const JointData& joint = data.joints[slot];
  if (!avbd::hasFrames(joint.type)) (path / "id").refuse(toText(id), "must name a joint with frames");
  const Pose a = checkedFrame(data, joint.body[0], path / "frameA", frameA);
  const Pose b = checkedFrame(data, joint.body[1], path / "frameB", frameB);
  avbd::setFrames(data, slot, a, b);
}

bool World::isEnabled(JointId id) const {
  return impl_->data.joints[slotOf(impl_->data, id, Path("World::isEnabled") / "id")].enabled;
}

void World::setEnabled(JointId id, bool enabled) {
  avbd::setEnabled(impl_->data, slotOf(impl_->data, id, Path("World::setEnabled") / "id"), enabled);
}

JointBreak World::breakLimits(JointId id) const {
  return impl_->data.joints[slotOf(impl_->data, id, Path("World::breakLimits") / "id")].breaks;
}

void World::setBreakLimits(JointId id, const JointBreak& limits) {
  const Path path("World::setBreakLimits");
  const uint32_t slot = slotOf(impl_->data, id, path / "id");
  checkBreak(path / "limits", limits);
  wakeJoint(impl_->data, slot);
  setBreaks(impl_->data, slot, limits);
}

}  // namespace avbd
