// Joints of MJCF bodies as joints of the world.
#include <cmath>
#include <numbers>

#include "io/mjcf_builder.h"

namespace avbd::mjcf {

namespace {

using std::numbers::pi;

bool isPlainBall(const Joint& joint) {
  return joint.kind == JointKind::Ball && !joint.limited && joint.stiffness == 0 && joint.damping == 0 &&
         joint.friction == 0 && joint.armature == 0;
}

/// A HingeJoint or SliderJoint that is the one free axis of a D6 joint.
template <class Def>
Def oneAxis(const D6Joint& all, JointAxis axis) {
  const D6Axis& free = all.axes[static_cast<size_t>(axis)];
  Def def;
  def.bodyA = all.bodyA, def.bodyB = all.bodyB;
  def.frameA = all.frameA, def.frameB = all.frameB;
  def.limit = free.limit, def.friction = free.friction, def.spring = free.spring, def.armature = free.armature;
  def.collideConnected = all.collideConnected;
  return def;
}

}  // namespace

std::string Builder::nameOf(JointRef joint) const {
  const std::string& name = jointOf(in_, joint).name;
  if (!name.empty()) return name;
  size_t before = joint.joint;
  for (int i = 0; i < joint.body; ++i) before += in_.bodies[static_cast<size_t>(i)].joints.size();
  return "joint_" + std::to_string(before + 1);
}

// What side A of a body's first stage, and side B of the stage before `stage`, is.
BodyId Builder::sideOf(size_t index, size_t stage) const {
  if (stage > 0) return stage < stages_[index].size() ? between_[index][stage - 1] : ids_[index];
  return movingId(rootOf(static_cast<size_t>(in_.bodies[index].parent)));
}

// The file's coordinate of each of a body's joints, of a ball the first of four.
std::vector<double> Builder::startsOf(size_t index) const {
  const Body& body = in_.bodies[index];
  const double* q = qposOf(body);
  std::vector<double> starts;
  for (const Joint& joint : body.joints) {
    starts.push_back(q ? *q : joint.ref);
    if (q) q += joint.kind == JointKind::Free ? 7 : joint.kind == JointKind::Ball ? 4 : 1;
  }
  return starts;
}

void Builder::addJoints(size_t index) {
  const Body& body = in_.bodies[index];
  coordinates_[index].resize(body.joints.size());
  if (body.joints.size() == 1 && isPlainBall(body.joints[0])) return addBallJoint(index);
  const std::vector<double> starts = startsOf(index);
  for (size_t k = 0; k < stages_[index].size(); ++k) addStage(index, k, starts);
  // Bodies between have no shapes, so only this pair may touch. A child and a parent that stands still do in MJCF.
  const size_t parent = rootOf(static_cast<size_t>(body.parent));
  if (stages_[index].size() > 1 && in_.filterParent && isDynamic(parent)) {
    at(body.where, [&] { model_.world.excludeCollision(ids_[parent], ids_[index]); });
  }
}

void Builder::addBallJoint(size_t index) {
  const Body& body = in_.bodies[index];
  const size_t parent = rootOf(static_cast<size_t>(body.parent));
  const Vec3d anchor = body.joints[0].pos;
  const Vec3d inWorld = start_[index].position + rotate(start_[index].rotation, anchor);
  BallJoint joint;
  joint.bodyA = sideOf(index, 0);
  joint.bodyB = ids_[index];
  joint.frameA.position = joint.bodyA ? (inverse(start_[parent]) * Posed{inWorld, {}}).position : inWorld;
  joint.frameB.position = anchor;
  joint.collideConnected = !in_.filterParent || !isDynamic(parent);
  at(body.joints[0].where, [&] { return model_.world.create(joint); });
}

void Builder::addStage(size_t index, size_t which, const std::vector<double>& starts) {
  const Body& body = in_.bodies[index];
  const Stage& stage = stages_[index][which];
  const size_t parent = static_cast<size_t>(body.parent);
  D6Joint joint;
  joint.bodyA = sideOf(index, which);
  joint.bodyB = sideOf(index, which + 1);
  Posed above = stage.frame, below = stage.frame;
  if (which == 0) above = (joint.bodyA ? inRoot(parent) : start_[parent]) * body.pose * above;
  Posed& sideB = stage.turned ? above : below;
  for (size_t k = 0; k < stage.count; ++k) {
    const Joint& of = body.joints[stage.first + k];
    if (of.kind == JointKind::Ball) {
      setBall(of, joint);
      continue;
    }
    Coordinate& at = coordinates_[index][stage.first + k];
    at.axis = stage.axes[k];
    at.sign = stage.signs[k];
    at.offset = of.ref;
    at.start = starts[stage.first + k];
    const double turn = at.start - of.ref;
    // A twist is known within half a turn at the start: one that is far off counts from where it starts.
    if (at.axis == JointAxis::Twist && std::abs(turn) > pi / 2) {
      at.offset = at.start;
      sideB.rotation = sideB.rotation * turnAbout({1, 0, 0}, -at.sign * turn);
    }
    joint.axes[static_cast<size_t>(at.axis)] = axisOf(of, at);
  }
  joint.frameA = toPose(above);
  joint.frameB = toPose(below);
  if (stage.turned) std::swap(joint.bodyA, joint.bodyB), std::swap(joint.frameA, joint.frameB);
  joint.collideConnected = stages_[index].size() > 1 || !in_.filterParent || !isDynamic(rootOf(parent));
  const JointId id = addStage(body, stage, joint);
  for (size_t k = 0; k < stage.count; ++k) coordinates_[index][stage.first + k].id = id;
}

JointId Builder::addStage(const Body& body, const Stage& stage, D6Joint joint) {
  const Joint& first = body.joints[stage.first];
  return at(first.where, [&] {
    World& world = model_.world;
    if (stage.count > 1) return world.create(joint);
    if (first.kind == JointKind::Hinge) return world.create(oneAxis<HingeJoint>(joint, JointAxis::Twist));
    if (first.kind == JointKind::Slide) return world.create(oneAxis<SliderJoint>(joint, JointAxis::LinearX));
    if (!isPlainBall(first)) return world.create(joint);
    return world.create(BallJoint{.bodyA = joint.bodyA,
                                  .bodyB = joint.bodyB,
                                  .frameA = joint.frameA,
                                  .frameB = joint.frameB,
                                  .collideConnected = joint.collideConnected});
  });
}

D6Axis Builder::axisOf(const Joint& joint, const Coordinate& at) const {
  const auto f = [&](double v) { return mjcf::narrow(v, joint.where); };
  const auto ours = [&](double file) { return f(at.sign * (file - at.offset)); };
  D6Axis axis;
  axis.motion = AxisMotion::Free;
  if (joint.limited) {
    axis.limit.lower = ours(at.sign < 0 ? joint.upper : joint.lower);
    axis.limit.upper = ours(at.sign < 0 ? joint.lower : joint.upper);
  }
  axis.spring = {.stiffness = f(joint.stiffness), .damping = f(joint.damping), .position = 0};
  if (joint.stiffness > 0) axis.spring.position = ours(joint.springRef);
  axis.friction = f(joint.friction);
  axis.armature = f(joint.armature);
  return axis;
}

// MuJoCo bounds the angle of the whole turn; ours are the swing's and the twist's.
void Builder::setBall(const Joint& joint, D6Joint& out) {
  const auto f = [&](double v) { return mjcf::narrow(v, joint.where); };
  for (size_t i = 3; i < 6; ++i) {
    out.axes[i].motion = AxisMotion::Free;
    out.axes[i].friction = f(joint.friction);
    out.axes[i].armature = f(joint.armature);
  }
  out.slerp.stiffness = f(joint.stiffness);
  out.slerp.damping = f(joint.damping);
  if (!joint.limited || joint.upper >= pi) return;
  out.cone.y = out.cone.z = f(joint.upper);
  out.axes[3].limit = {.lower = -f(joint.upper), .upper = f(joint.upper)};
  notes_.add(joint.where, "the range of a ball joint bounds its swing and its twist, each by itself");
}

void Builder::nameJoints() {
  size_t count = 0;
  for (size_t i = 1; i < in_.bodies.size(); ++i) {
    const std::vector<Joint>& joints = in_.bodies[i].joints;
    for (size_t k = 0; k < joints.size(); ++k) {
      ++count;
      if (joints[k].kind < JointKind::Slide || k >= coordinates_[i].size()) continue;
      const Coordinate& at = coordinates_[i][k];
      if (!at.id) continue;
      const std::string name = joints[k].name.empty() ? "joint_" + std::to_string(count) : joints[k].name;
      model_.joints.push_back({name, at.id, at.axis, at.sign, at.offset});
    }
  }
}

}  // namespace avbd::mjcf
