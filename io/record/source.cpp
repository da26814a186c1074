// What a world shows to the outside, in the recording's order.
#include "io/record/source.h"

#include <algorithm>

#include "io/record/softs.h"

namespace avbd {
namespace {

std::string nameOf(const Model& model, SoftId id, size_t number) {
  for (const NamedSoft& soft : model.softs)
    if (soft.id == id) return soft.name;
  return "soft_" + std::to_string(number);
}

}  // namespace

RecordSource::RecordSource(const Model& model) {
  const World& world = model.world;
  head_.title = model.name;
  head_.engine = "avbd";
  head_.up = model.up;
  head_.dt = model.dt;
  for (const NamedBody& body : model.bodies) {
    if (world.softBody(body.id)) continue;
    const auto slot = static_cast<uint32_t>(head_.bodies.size());
    bodies_[body.id.index] = slot;
    ids_.push_back(body.id);
    head_.bodies.push_back({body.name, world.type(body.id)});
    const std::vector<ShapeId> shapes = world.shapes(body.id);
    for (size_t i = 0; i < shapes.size(); ++i) {
      const ShapeId shape = shapes[i];
      shapes_[shape.index] = static_cast<uint32_t>(head_.shapes.size());
      head_.shapes.push_back({slot, world.geometry(shape), world.localPose(shape), world.isTrigger(shape)});
      if (i < body.colors.size()) head_.shapes.back().color = body.colors[i];
    }
  }
  addSofts(model);
  addJoints(model);
}

// Behind all bodies that are no points, in the order of their ids. Of other shapes that a point may have nothing is
// kept.
void RecordSource::addSofts(const Model& model) {
  const World& world = model.world;
  for (const SoftId id : world.softBodies()) {
    const auto mesh = world.mesh(id);
    RecordedSoft soft{nameOf(model, id, head_.softs.size()), mesh->isCloth()};
    soft.points.assign(mesh->points().begin(), mesh->points().end());
    soft.surface.assign(mesh->surface().begin(), mesh->surface().end());
    soft.elements = mesh->report().elements;
    soft.radius = world.radius(id);
    uint32_t slot = static_cast<uint32_t>(head_.bodies.size()), ball = static_cast<uint32_t>(head_.shapes.size());
    const std::vector<BodyId> particles = world.particles(id);
    for (const BodyId particle : particles) {
      bodies_[particle.index] = slot++;
      ids_.push_back(particle);
    }
    for (const uint32_t point : surfacePoints(soft)) {
      const std::vector<ShapeId> shapes = world.shapes(particles[point]);
      if (!shapes.empty()) shapes_[shapes[0].index] = ball;
      ++ball;
    }
    appendSoft(head_, std::move(soft));
  }
}

uint32_t RecordSource::slotOf(BodyId id) const {
  const auto it = bodies_.find(id.index);
  return it == bodies_.end() ? kNotRecorded : it->second;
}

uint32_t RecordSource::slotOf(ShapeId id) const {
  const auto it = shapes_.find(id.index);
  return it == shapes_.end() ? kNotRecorded : it->second;
}

RecordedFrame RecordSource::frame(const Model& model, double time, size_t contactsMost) {
  const World& world = model.world;
  RecordedFrame frame;
  frame.time = time;
  frame.poses.resize(ids_.size());
  frame.velocities.resize(ids_.size());
  world.getPoses(ids_, frame.poses);
  world.getVelocities(ids_, frame.velocities);
  frame.kineticEnergy = world.kineticEnergy();
  addJointStates(world, frame);
  addContacts(world, contactsMost, frame);
  frame.events.swap(events_);
  return frame;
}

void RecordSource::addContacts(const World& world, size_t most, RecordedFrame& frame) const {
  std::vector<RecordedContact>& found = frame.contacts;
  for (const Contact& contact : world.contacts()) {
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& p = contact.points[static_cast<size_t>(i)];
      if (!(p.normalForce > 0)) continue;
      found.push_back({p.position, contact.normal * p.normalForce + p.frictionForce, contact.normal, p.separation,
                       slotOf(contact.shapeA), slotOf(contact.shapeB)});
    }
  }
  if (found.size() <= most) return;
  frame.contactsLeftOut = static_cast<uint32_t>(found.size() - most);
  std::vector<uint32_t> order(found.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(),
                   [&](uint32_t a, uint32_t b) {
                     const float fa = dot(found[a].force, found[a].force), fb = dot(found[b].force, found[b].force);
                     return fa != fb ? fa > fb : a < b;
                   });
  order.resize(most);
  std::sort(order.begin(), order.end());  // as the world lists them
  std::vector<RecordedContact> kept;
  for (const uint32_t i : order) kept.push_back(found[i]);
  found = std::move(kept);
}

void RecordSource::watch(const World& world) {
  const Events& events = world.events();
  using Kind = RecordedEventKind;
  const auto touch = [&](Kind kind, const TouchEvent& e) {
    events_.push_back({kind, slotOf(e.shapeA), slotOf(e.shapeB), e.position, e.normal, 0, e.impulse});
  };
  for (const TouchEvent& e : events.begins) touch(Kind::TouchBegin, e);
  for (const TouchEvent& e : events.ends) touch(Kind::TouchEnd, e);
  for (const TriggerEvent& e : events.enters)
    events_.push_back({Kind::TriggerEnter, slotOf(e.trigger), slotOf(e.visitor)});
  for (const TriggerEvent& e : events.leaves)
    events_.push_back({Kind::TriggerLeave, slotOf(e.trigger), slotOf(e.visitor)});
  for (const HitEvent& e : events.hits)
    events_.push_back({Kind::Hit, slotOf(e.shapeA), slotOf(e.shapeB), e.position, e.normal, e.speed, e.impulse});
}

}  // namespace avbd
