// Readings of probes that need a step: accelerations, contacts, what a body's parent exerts on it.
#include "io/probe_math.h"
#include "io/probe_zone.h"
#include "io/probes.h"

namespace avbd {

using namespace probe_math;

namespace {

constexpr size_t kNone = static_cast<size_t>(-1);

bool isBelow(const ProbeTree& tree, size_t body, size_t root) {
  return body != kNone && body >= root && body < tree.bodies[root].subtreeEnd;
}

}  // namespace

size_t Probes::bodyOf(ShapeId shape) const {
  const auto it = bodyOf_.find(shape);
  return it == bodyOf_.end() ? kNone : it->second;
}

// What an accelerometer feels; of a frame at rest minus gravity.
Vec3d Probes::acceleration(const ProbeFrame& frame) const {
  const Vec3d change = motionOf(frame, now_).linear - motionOf(frame, before_).linear;
  return change * (1 / elapsed_) - toDouble(model_.world.definition().gravity);
}

// As it stood halfway between the two readings.
Quat Probes::middle(const ProbeFrame& frame) const {
  const Quat a = motionOf(frame, before_).rotation, b = motionOf(frame, now_).rotation;
  const float sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0 ? -1.0f : 1.0f;
  return unit({a.w * sign + b.w, a.x * sign + b.x, a.y * sign + b.y, a.z * sign + b.z});
}

Vec3d Probes::angularAcceleration(const ProbeFrame& frame) const {
  return (motionOf(frame, now_).angular - motionOf(frame, before_).angular) * (1 / elapsed_);
}

// All that must act on a body, gravity aside, for it to move as it does.
Probes::Wrench Probes::needed(const ProbeBody& body, Vec3d about) const {
  const Motion now = motionOf(body.frame, now_), before = motionOf(body.frame, before_);
  const Vec3d force = acceleration(body.frame) * body.mass;
  const Vec3d change =
      spin(body.inertia, now.rotation, now.angular) - spin(body.inertia, before.rotation, before.angular);
  return {force, cross(now.position - about, force) + change * (1 / elapsed_)};
}

// Forces between two bodies that are both below cancel.
void Probes::subtractContacts(const Probe& probe, Vec3d about, Wrench& wrench) const {
  const ProbeTree& tree = model_.probeTree;
  for (const Contact& contact : contacts_) {
    const bool a = isBelow(tree, bodyOf(contact.shapeA), probe.body);
    const bool b = isBelow(tree, bodyOf(contact.shapeB), probe.body);
    if (a == b) continue;
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& point = contact.points[static_cast<size_t>(i)];
      const Vec3d onB = toDouble(contact.normal * point.normalForce + point.frictionForce);
      const Vec3d force = b ? onB : onB * -1.0;
      wrench.force = wrench.force - force;
      wrench.torque = wrench.torque - cross(point.position - about, force);
    }
  }
}

void Probes::subtractHolds(const Probe& probe, Vec3d about, Wrench& wrench) const {
  const ProbeTree& tree = model_.probeTree;
  for (const ProbeHold& hold : tree.holds) {
    const bool a = isBelow(tree, hold.bodyA, probe.body), b = isBelow(tree, hold.bodyB, probe.body);
    if (a == b) continue;
    const JointReaction onA = model_.world.reaction(hold.joint);
    const Vec3d anchor = model_.world.worldFrames(hold.joint)[0].position;
    const double sign = a ? 1 : -1;
    const Vec3d force = toDouble(onA.force) * sign;
    wrench.force = wrench.force - force;
    wrench.torque = wrench.torque - cross(anchor - about, force) - toDouble(onA.torque) * sign;
  }
}

Probes::Wrench Probes::interaction(const Probe& probe) const {
  const ProbeTree& tree = model_.probeTree;
  const Vec3d about = motionOf(probe.at).position;
  Wrench out;
  for (size_t i = probe.body; i < tree.bodies[probe.body].subtreeEnd; ++i) {
    const Wrench each = needed(tree.bodies[i], about);
    out.force = out.force + each.force;
    out.torque = out.torque + each.torque;
  }
  subtractContacts(probe, about, out);
  subtractHolds(probe, about, out);
  return out;
}

double Probes::touch(const Probe& probe) const {
  const Motion at = motionOf(probe.at);
  const Quat back = conjugate(at.rotation);
  double sum = 0;
  for (const Contact& contact : contacts_) {
    const bool a = bodyOf(contact.shapeA) == probe.body, b = bodyOf(contact.shapeB) == probe.body;
    if (a == b) continue;
    const Vec3d outward = rotate(back, toDouble(a ? contact.normal : -contact.normal));
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& point = contact.points[static_cast<size_t>(i)];
      const Vec3d place = rotate(back, point.position - at.position);
      if (point.normalForce > 0 && meets(probe.zone, place, outward)) sum += static_cast<double>(point.normalForce);
    }
  }
  return sum;
}

}  // namespace avbd
