// Joints of a world: their definitions for the head, what they did for a frame.
#include <algorithm>
#include <cmath>

#include "io/record/source.h"

namespace avbd {
namespace {

constexpr uint8_t kAngles = 0x38, kAll = 0x3f;

size_t indexOf(JointAxis axis) { return static_cast<size_t>(axis); }
uint8_t bitOf(JointAxis axis) { return static_cast<uint8_t>(1u << indexOf(axis)); }
RecordedLimit limitOf(const JointLimit& limit) { return {limit.lower, limit.upper}; }

void describe(const BallJoint&, RecordedJoint& out) { out.freeAxes = kAngles; }
void describe(const FixedJoint&, RecordedJoint&) {}
void describe(const HingeJoint& joint, RecordedJoint& out) {
  out.freeAxes = bitOf(JointAxis::Twist);
  out.limits[indexOf(JointAxis::Twist)] = limitOf(joint.limit);
}
void describe(const SliderJoint& joint, RecordedJoint& out) {
  out.freeAxes = bitOf(JointAxis::LinearX);
  out.limits[indexOf(JointAxis::LinearX)] = limitOf(joint.limit);
}
void describe(const D6Joint& joint, RecordedJoint& out) {
  for (size_t i = 0; i < joint.axes.size(); ++i) {
    if (joint.axes[i].motion == AxisMotion::Locked) continue;
    out.freeAxes = static_cast<uint8_t>(out.freeAxes | 1u << i);
    out.limits[i] = limitOf(joint.axes[i].limit);
  }
  out.coneY = joint.cone.y;
  out.coneZ = joint.cone.z;
}
void describe(const DistanceJoint& joint, RecordedJoint& out) {
  out.freeAxes = kAll;
  out.limits[0] = {joint.min, joint.max};
}
void describe(const PulleyJoint& joint, RecordedJoint& out) {
  out.freeAxes = kAll;
  out.limits[0] = {joint.slack ? 0 : joint.length, joint.length};
}

/// The names that the model gives a joint's coordinates.
std::string nameOf(const Model& model, JointId id) {
  std::string text;
  for (const NamedJoint& joint : model.joints)
    if (joint.id == id) text += (text.empty() ? "" : ", ") + joint.name;
  return text;
}

// A NaN is kept.
void raise(double& most, double value) {
  if (!(value <= most)) most = value;
}

void addLimit(const World& world, JointId id, JointAxis axis, const JointLimit& limit, LimitExcess& out) {
  const double q = world.coordinate(id, axis).position;
  const double excess = std::max(static_cast<double>(limit.lower) - q, q - static_cast<double>(limit.upper));
  raise(axis < JointAxis::Twist ? out.length : out.angle, excess);
}

// Along the ray from the cone's axis through where the swing is.
void addCone(const World& world, JointId id, const SwingCone& cone, LimitExcess& out) {
  if (!std::isfinite(cone.y) && !std::isfinite(cone.z)) return;
  const double y = world.coordinate(id, JointAxis::SwingY).position;
  const double z = world.coordinate(id, JointAxis::SwingZ).position;
  const double n = std::hypot(y / static_cast<double>(cone.y), z / static_cast<double>(cone.z));
  if (!(n <= 1)) raise(out.angle, std::hypot(y, z) * (1 - 1 / n));
}

}  // namespace

LimitExcess limitExcess(const World& world, JointId id) {
  LimitExcess out;
  switch (world.type(id)) {
    case JointType::Hinge:
      addLimit(world, id, JointAxis::Twist, world.hingeJoint(id).limit, out);
      break;
    case JointType::Slider:
      addLimit(world, id, JointAxis::LinearX, world.sliderJoint(id).limit, out);
      break;
    case JointType::D6: {
      const D6Joint joint = world.d6Joint(id);
      for (size_t i = 0; i < joint.axes.size(); ++i)
        if (joint.axes[i].motion == AxisMotion::Free)
          addLimit(world, id, static_cast<JointAxis>(i), joint.axes[i].limit, out);
      addCone(world, id, joint.cone, out);
      break;
    }
    default:
      break;
  }
  return out;
}

void RecordSource::addJoints(const Model& model) {
  const World& world = model.world;
  const auto add = [&](JointId id, const auto& joint) {
    RecordedJoint recorded{slotOf(joint.bodyA), slotOf(joint.bodyB), joint.frameA, joint.frameB, world.type(id)};
    recorded.name = nameOf(model, id);
    describe(joint, recorded);
    head_.joints.push_back(std::move(recorded));
    joints_.push_back(id);
  };
  // Joints of no frames.
  const auto addBodies = [&](JointId id, std::span<const BodyId> bodies) {
    std::array<uint32_t, 4> slots;
    for (size_t i = 0; i < slots.size(); ++i) slots[i] = i < bodies.size() ? slotOf(bodies[i]) : kNotRecorded;
    RecordedJoint recorded{slots[0], slots[1], {}, {}, world.type(id)};
    recorded.name = nameOf(model, id);
    recorded.moreBodies = {slots[2], slots[3]};
    head_.joints.push_back(std::move(recorded));
    joints_.push_back(id);
  };
  for (const JointId id : world.joints()) {
    const JointType type = world.type(id);
    if (type == JointType::TetVolume) continue;
    if (type == JointType::Ball) add(id, world.ballJoint(id));
    if (type == JointType::Fixed) add(id, world.fixedJoint(id));
    if (type == JointType::Hinge) add(id, world.hingeJoint(id));
    if (type == JointType::Slider) add(id, world.sliderJoint(id));
    if (type == JointType::D6) add(id, world.d6Joint(id));
    if (type == JointType::Distance) add(id, world.distanceJoint(id));
    if (type == JointType::Pulley) add(id, world.pulleyJoint(id));
    if (type == JointType::Coupling) addBodies(id, {});
    if (type == JointType::Custom) addBodies(id, world.customJoint(id).bodies);
    describeLink(world, id, head_.joints.back());
  }
  addTerms(world);
}

// A coupling may stand before the joints that it names.
void RecordSource::addTerms(const World& world) {
  for (size_t i = 0; i < joints_.size(); ++i)
    if (world.type(joints_[i]) == JointType::Coupling)
      head_.joints[i].terms = termsOf(world.coupling(joints_[i]), joints_);
}

void RecordSource::addJointStates(const World& world, RecordedFrame& frame) const {
  frame.limitExcessMax = frame.limitExcessAngleMax = 0;
  for (const JointId id : joints_) {
    const bool enabled = world.isAlive(id) && world.isEnabled(id);
    frame.joints.push_back({enabled ? world.reaction(id) : JointReaction{}, enabled});
    if (!enabled) {
      frame.residuals.resize(frame.residuals.size() + head_.joints[frame.joints.size() - 1].residuals);
      continue;
    }
    addResiduals(world, id, frame.residuals);
    const LimitExcess excess = limitExcess(world, id);
    raise(frame.limitExcessMax, excess.length);
    raise(frame.limitExcessAngleMax, excess.angle);
  }
}

}  // namespace avbd
