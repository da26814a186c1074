// From a world's getters to the page's recording.
#include "app/recorder.h"

#include <algorithm>

namespace avbd::cli {
namespace {

constexpr size_t kFewestContacts = 1000;

std::vector<RecordedContact> contactsOf(const World& world, size_t most) {
  std::vector<RecordedContact> found;
  for (const Contact& contact : world.contacts()) {
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& p = contact.points[static_cast<size_t>(i)];
      if (p.normalForce > 0) found.push_back({p.position, contact.normal * p.normalForce + p.frictionForce});
    }
  }
  if (found.size() > most) {
    std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(most), found.end(),
                     [](const auto& a, const auto& b) { return dot(a.force, a.force) > dot(b.force, b.force); });
    found.resize(most);
  }
  return found;
}

}  // namespace

Recorder::Recorder(const Model& model, size_t frames, size_t contactsMax)
    : layout_(scenes::layoutOf(model.world)),
      contactsPerFrame_(std::max(kFewestContacts, contactsMax / std::max<size_t>(1, frames))) {
  const World& world = model.world;
  recording_.title = model.name;
  recording_.up = model.up;
  for (const NamedBody& body : model.bodies) {
    const uint32_t slot = static_cast<uint32_t>(recording_.bodies.size());
    slots_[body.id.index] = slot;
    recording_.bodies.push_back({body.name, world.type(body.id)});
    for (const ShapeId shape : world.shapes(body.id))
      recording_.shapes.push_back({slot, world.geometry(shape), world.localPose(shape)});
  }
  for (const BodyId id : layout_.bodies) order_.push_back(slotOf(id));
  addJoints(world);
}

uint32_t Recorder::slotOf(BodyId id) const {
  const auto it = slots_.find(id.index);
  return it == slots_.end() ? scenes::kWorldBody : it->second;
}

void Recorder::addJoints(const World& world) {
  const auto add = [&](const auto& joint) {
    recording_.joints.push_back(
        {slotOf(joint.bodyA), slotOf(joint.bodyB), joint.frameA.position, joint.frameB.position});
  };
  for (const JointId id : world.joints()) {
    if (world.type(id) == JointType::Ball) add(world.ballJoint(id));
    if (world.type(id) == JointType::Fixed) add(world.fixedJoint(id));
  }
}

void Recorder::add(const Model& model, double time, std::span<const Pose> poses) {
  RecordedFrame frame;
  frame.time = time;
  frame.poses.assign(poses.begin(), poses.end());
  frame.contacts = contactsOf(model.world, contactsPerFrame_);
  frame.kineticEnergy = model.world.kineticEnergy();
  std::vector<Pose> ordered;
  for (const uint32_t slot : order_) ordered.push_back(poses[slot]);
  frame.penetrationMax = scenes::penetrationOf(layout_, ordered).max;
  frame.jointGapMax = scenes::jointGapMax(layout_, ordered);
  recording_.frames.push_back(std::move(frame));
}

}  // namespace avbd::cli
