// Joints: making, reading back and how well they hold.
#include <algorithm>

#include "api/world_impl.h"
#include "world/bodies.h"
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
  constexpr const char* kRange[] = {"must name a ball joint",     "must name a fixed joint", "must name a tet volume",
                                    "must name a hinge",          "must name a slider",      "must name a D6 joint",
                                    "must name a distance joint", "must name a pulley",      "must name a coupling",
                                    "must name a custom joint"};
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
          free.spring,
          free.armature,
          free.maxVelocity,
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

JointId World::create(const DistanceJoint& def) {
  const LinkPlan plan = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, plan.joint, plan.link));
}

JointId World::create(const PulleyJoint& def) {
  const LinkPlan plan = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, plan.joint, plan.link));
}

JointId World::create(const Coupling& def) {
  const LinkPlan plan = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, plan.joint, plan.link));
}

JointId World::create(const CustomJoint& def) {
  const LinkPlan plan = checkedJoint(impl_->data, def);
  return impl_->data.jointIds.id(addJoint(impl_->data, plan.joint, plan.link));
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
  def.cone = d6.cone, def.slerp = d6.slerp;
  return def;
}

TetVolume World::tetVolume(JointId id) const {
  const JointData& joint = jointOfType(impl_->data, id, JointType::TetVolume, "World::tetVolume");
  TetVolume def{.restVolume = joint.restVolume, .stiffness = joint.stiffness, .userData = joint.userData};
  for (size_t i = 0; i < 4; ++i) def.bodies[i] = bodyIdOf(impl_->data, joint.body[i]);
  return def;
}

DistanceJoint World::distanceJoint(JointId id) const {
  const JointData& joint = jointOfType(impl_->data, id, JointType::Distance, "World::distanceJoint");
  const LinkData& link = impl_->data.links[impl_->data.jointIds.slot(id)];
  return {bodyIdOf(impl_->data, joint.body[0]),
          bodyIdOf(impl_->data, joint.body[1]),
          joint.frame[0],
          joint.frame[1],
          link.min,
          link.max,
          joint.stiffness,
          link.damping,
          joint.collideConnected,
          joint.userData};
}

PulleyJoint World::pulleyJoint(JointId id) const {
  const JointData& joint = jointOfType(impl_->data, id, JointType::Pulley, "World::pulleyJoint");
  const LinkData& link = impl_->data.links[impl_->data.jointIds.slot(id)];
  return {bodyIdOf(impl_->data, joint.body[0]),
          bodyIdOf(impl_->data, joint.body[1]),
          joint.frame[0],
          joint.frame[1],
          link.wheel[0],
          link.wheel[1],
          link.ratio,
          link.max,
          link.slack,
          joint.collideConnected,
          joint.userData};
}

Coupling World::coupling(JointId id) const {
  const JointData& joint = jointOfType(impl_->data, id, JointType::Coupling, "World::coupling");
  const LinkData& link = impl_->data.links[impl_->data.jointIds.slot(id)];
  Coupling def;
  for (const LinkTerm& term : link.terms) {
    const float* factor = term.curve.factor;
    def.terms.push_back({impl_->data.jointIds.id(term.joint), term.axis, factor[0], factor[1], factor[2], factor[3]});
  }
  def.rest = link.rest, def.axis = link.axis;
  def.stiffness = joint.stiffness, def.damping = link.damping, def.userData = joint.userData;
  return def;
}

CustomJoint World::customJoint(JointId id) const {
  const JointData& joint = jointOfType(impl_->data, id, JointType::Custom, "World::customJoint");
  const LinkData& link = impl_->data.links[impl_->data.jointIds.slot(id)];
  CustomJoint def;
  def.family = link.family, def.bodyCount = link.bodies;
  for (size_t i = 0; i < static_cast<size_t>(link.bodies); ++i) def.bodies[i] = bodyIdOf(impl_->data, joint.body[i]);
  def.constants = link.constants, def.memory = link.memory;
  def.collideConnected = joint.collideConnected, def.userData = joint.userData;
  return def;
}

std::vector<BodyId> World::bodies(JointId id) const {
  std::vector<BodyId> ids;
  forEachBody(impl_->data, slotOf(impl_->data, id, Path("World::bodies") / "id"), [&](uint32_t body) {
    const BodyId named = bodyIdOf(impl_->data, body);
    if (body != kNone && std::find(ids.begin(), ids.end(), named) == ids.end()) ids.push_back(named);
  });
  return ids;
}

std::array<Pose, 2> World::worldFrames(JointId id) const {
  const JointData& joint = jointOf(impl_->data, id, "World::worldFrames");
  if (!hasFrames(joint.type)) (Path("World::worldFrames") / "id").refuse(toText(id), "must name a joint with frames");
  std::array<Pose, 2> frames;
  for (int side = 0; side < 2; ++side) {
    const Pose& local = joint.frame[side];
    frames[static_cast<size_t>(side)] =
        joint.body[side] == kNone ? local : bodyPose(impl_->data.bodies[joint.body[side]]) * local;
  }
  return frames;
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
