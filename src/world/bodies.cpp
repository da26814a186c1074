// Bodies between steps (bodies.h).
#include "world/bodies.h"

#include "world/joints.h"
#include "world/mass.h"
#include "world/pairs.h"
#include "world/rotation.h"
#include "world/sleep.h"

namespace avbd {
namespace {

// What the solver knows of a body's mass, without moving anything.
void storeMass(BodyData& body, const MassProperties& properties) {
  body.mass = properties.mass;
  body.inertia = properties.inertia;
  body.invInertia = inverse(properties.inertia);
}

// Contact points stick to the material, not to the centre.
void shiftMemories(WorldData& data, uint32_t slot, Vec3 shift) {
  for (PairData& pair : data.pairs) {
    if (pair.bodyA != slot && pair.bodyB != slot) continue;
    pair.kept.what = KeptManifold::What::Nothing;
    for (PointMemory& point : pair.points) {
      Vec3& anchor = pair.bodyA == slot ? point.anchorA : point.anchorB;
      anchor = anchor - shift;
    }
  }
}

}  // namespace

Pose bodyPose(const BodyData& body) {
  return {body.position - rotate(body.rotation, toDouble(body.center)), body.rotation};
}

void stopLockedAxes(BodyData& body) {
  if (body.type != BodyType::Dynamic) return;
  if (body.locks & kLockLinearX) body.linearVelocity.x = 0;
  if (body.locks & kLockLinearY) body.linearVelocity.y = 0;
  if (body.locks & kLockLinearZ) body.linearVelocity.z = 0;
  if (body.locks & kLockAngularX) body.angularVelocity.x = 0;
  if (body.locks & kLockAngularY) body.angularVelocity.y = 0;
  if (body.locks & kLockAngularZ) body.angularVelocity.z = 0;
}

void setVelocityOf(BodyData& body, const Velocity& velocity) {
  body.linearVelocity = velocity.linear;
  body.angularVelocity = velocity.angular;
  stopLockedAxes(body);
}

uint32_t addBody(WorldData& data, const BodyDef& def, const BodyPlan& plan) {
  const uint32_t slot = data.bodyIds.slot(data.bodyIds.create());
  if (slot >= data.bodies.size()) data.bodies.resize(slot + 1);
  BodyData& body = data.bodies[slot];
  body = {};
  body.type = def.type;
  body.rotation = plan.pose.rotation;
  body.linearDamping = def.linearDamping;
  body.angularDamping = def.angularDamping;
  body.gravityScale = def.gravityScale;
  body.iterations = def.iterations;
  body.continuous = def.continuous;
  body.maxLinearSpeed = def.maxLinearSpeed;
  body.maxAngularSpeed = def.maxAngularSpeed;
  body.locks = def.locks;
  setVelocityOf(body, {def.linearVelocity, def.angularVelocity});
  body.massScale = def.mass;
  body.massGiven = def.massProperties.has_value();
  body.canSleep = def.canSleep;
  body.userData = def.userData;
  if (body.type == BodyType::Dynamic) {
    storeMass(body, plan.mass);
    body.center = plan.mass.center;
  }
  body.position = plan.pose.position + rotate(body.rotation, toDouble(body.center));
  body.last = {body.position, body.rotation};
  for (const ShapeDef& shape : plan.shapes) addShape(data, slot, shape);
  enlist(data, slot);
  return slot;
}

void changeVelocity(WorldData& data, uint32_t slot, const Velocity& velocity) {
  BodyData& body = data.bodies[slot];
  if (body.asleep && velocity == Velocity{}) return;
  if (body.type == BodyType::Dynamic) wakeBody(data, slot);
  setVelocityOf(body, velocity);
  if (body.type == BodyType::Kinematic) wakeKinematic(data, slot);
}

void removeBody(WorldData& data, uint32_t slot) {
  wakeBody(data, slot);
  removeJointsOf(data, slot);
  endExclusionsOf(data, slot);
  forgetPairsOfBody(data, slot);
  while (data.bodies[slot].firstShape != kNone) removeShape(data, data.bodies[slot].firstShape);
  data.bodies[slot] = {};
  data.sleep.stale = true;
  data.bodyIds.destroy(data.bodyIds.id(slot));
}

void setMass(WorldData& data, uint32_t slot, const MassProperties& properties) {
  wakeBody(data, slot);
  BodyData& body = data.bodies[slot];
  storeMass(body, properties);
  const Vec3 shift = properties.center - body.center;
  if (shift == Vec3{}) return;
  const Vec3 worldShift = rotate(body.rotation, shift);
  body.linearVelocity = body.linearVelocity + cross(body.angularVelocity, worldShift);
  body.position = body.position + rotate(body.rotation, toDouble(properties.center) - toDouble(body.center));
  body.center = properties.center;
  stopLockedAxes(body);
  returnWoken(data, false);
  shiftMemories(data, slot, shift);
  updateAnchorsOf(data, slot);
  placeShapes(data, slot);
}

void moveBody(WorldData& data, uint32_t slot, const Pose& pose) {
  wakeBody(data, slot);
  BodyData& body = data.bodies[slot];
  body.rotation = pose.rotation;
  body.position = pose.position + rotate(pose.rotation, toDouble(body.center));
  body.last = {body.position, body.rotation};
  forgetPairsOfBody(data, slot);
  for (uint32_t s = body.firstShape; s != kNone; s = data.shapes[s].next) {
    data.tree.move(data.shapes[s].proxy, fatBounds(data, data.shapes[s]));
    markUnpaired(data, s);
  }
  if (!isDynamic(data, slot)) wakeAround(data, slot);
}

Vec3 spinFromImpulse(const BodyData& body, Vec3 impulse) {
  return solveUnlocked(worldInertia(body.rotation, body.inertia), body.locks, toDouble(impulse));
}

Vec3d angularMomentumOf(const BodyData& body) {
  return worldInertia(body.rotation, body.inertia) * toDouble(body.angularVelocity);
}

}  // namespace avbd
