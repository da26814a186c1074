// Sums over bodies, joint errors, contacts (measure.h).
#include "world/measure.h"

#include <cmath>

#include "world/bodies.h"
#include "world/joint_coordinates.h"
#include "world/joints.h"
#include "world/soft_contacts.h"

namespace avbd {
namespace {

Vec3d crossd(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

template <class F>
void forEachDynamic(const WorldData& data, F&& f) {
  data.bodyIds.forEach([&](uint32_t slot) {
    if (data.bodies[slot].type == BodyType::Dynamic) f(data.bodies[slot]);
  });
}

uint32_t slotOf(const WorldData& data, const JointData& joint) {
  return static_cast<uint32_t>(&joint - data.joints.data());
}

}  // namespace

double kineticEnergyOf(const BodyData& body) {
  const Vec3d v = toDouble(body.linearVelocity), w = toDouble(body.angularVelocity);
  return 0.5 * (body.mass * dot(v, v) + dot(w, angularMomentumOf(body)));
}

double totalKineticEnergy(const WorldData& data) {
  double sum = 0;
  forEachDynamic(data, [&](const BodyData& body) { sum += kineticEnergyOf(body); });
  return sum;
}

Vec3d totalMomentum(const WorldData& data) {
  Vec3d sum;
  forEachDynamic(data, [&](const BodyData& body) { sum = sum + toDouble(body.linearVelocity) * body.mass; });
  return sum;
}

Vec3d totalAngularMomentum(const WorldData& data, Vec3d about) {
  Vec3d sum;
  forEachDynamic(data, [&](const BodyData& body) {
    const Vec3d momentum = toDouble(body.linearVelocity) * body.mass;
    sum = sum + crossd(body.position - about, momentum) + angularMomentumOf(body);
  });
  return sum;
}

double jointGap(const WorldData& data, const JointData& joint) {
  if (joint.type == JointType::TetVolume) return std::abs(tetVolume(data, joint) - joint.restVolume);
  if (isD6(joint.type)) return lockedGap(data, slotOf(data, joint));
  if (joint.type == JointType::Custom) return customGap(data, slotOf(data, joint));
  if (isLink(joint.type)) return linkGap(data, slotOf(data, joint));
  return length(worldFrame(data, joint, 0).position - worldFrame(data, joint, 1).position);
}

double jointAngleError(const WorldData& data, const JointData& joint) {
  if (isD6(joint.type)) return lockedAngle(data, slotOf(data, joint));
  if (joint.type != JointType::Fixed) return 0;
  const Quat a = worldFrame(data, joint, 0).rotation, b = worldFrame(data, joint, 1).rotation;
  const Quat turn = conjugate(a) * b;
  const Vec3d axis{turn.x, turn.y, turn.z};
  return 2 * std::atan2(length(axis), std::abs(static_cast<double>(turn.w)));
}

Contact contactOf(const WorldData& data, const PairData& pair, const PairData& head) {
  Contact contact;
  contact.shapeA = data.shapeIds.id(pair.shapeA);
  contact.shapeB = data.shapeIds.id(pair.shapeB);
  contact.bodyA = data.bodyIds.id(pair.bodyA);
  contact.bodyB = data.bodyIds.id(pair.bodyB);
  if (pair.hasSurface) {
    (isSurface(data.shapes[pair.shapeA].geom.type) ? contact.elementA : contact.elementB) = pair.element;
  }
  contact.softA = softOfBody(data, pair.bodyA), contact.softB = softOfBody(data, pair.bodyB);
  if (contact.softA || contact.softB)
    contact.touch = softPhase(data, pair.shapeA, pair.shapeB);
  else if (head.touching)
    contact.touch = head.touchBegins ? TouchPhase::Begins : TouchPhase::Persists;
  contact.normal = pair.normal;
  contact.pointCount = contactPoints(pair);
  for (int i = 0; i < contact.pointCount; ++i) {
    const ManifoldPoint& from = pair.manifold.points[i];
    ContactPoint& point = contact.points[static_cast<size_t>(i)];
    point = {};
    point.position = pair.origin + from.position;
    point.separation = from.separation;
    point.feature = from.feature;
    if (i >= pair.pointCount + pair.gonePoints) continue;
    const Vec3 force = pair.mean != kNone ? data.means[pair.mean][static_cast<size_t>(i)] : pair.points[i].lambda;
    point.normalForce = force.x;
    point.frictionForce = force.y * pair.t1 + force.z * pair.t2;
  }
  return contact;
}

}  // namespace avbd
