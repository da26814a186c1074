// Bodies: making, state and forces.
#include "api/world_impl.h"
#include "world/bodies.h"
#include "world/check.h"
#include "world/joints.h"
#include "world/limits.h"
#include "world/measure.h"
#include "world/pairs.h"
#include "world/sleep.h"

namespace avbd {
namespace {

BodyData& bodyOf(WorldData& data, BodyId id, const char* call) {
  return data.bodies[slotOf(data, id, Path(call) / "id")];
}

BodyData& dynamicBodyOf(WorldData& data, BodyId id, const char* call) {
  return data.bodies[dynamicSlotOf(data, id, Path(call) / "id")];
}

uint32_t slotIn(const WorldData& data, const BodyData& body) {
  return static_cast<uint32_t>(&body - data.bodies.data());
}

void wakeDynamic(WorldData& data, const BodyData& body) {
  if (body.type == BodyType::Dynamic) wakeBody(data, slotIn(data, body));
}

// Of nothing a sleeper sleeps on.
void give(WorldData& data, BodyData& body, Vec3 force, Vec3 torque) {
  if (force == Vec3{} && torque == Vec3{}) return;
  wakeBody(data, slotIn(data, body));
  body.force = body.force + force;
  body.torque = body.torque + torque;
}

// What an impulse would make of a velocity, refused where it is beyond all bounds.
void checkReached(const Path& impulse, Vec3 given, Vec3 reached, double limit) {
  const auto isIn = [&](float v) { return v >= -limit && v <= limit; };
  if (isIn(reached.x) && isIn(reached.y) && isIn(reached.z)) return;
  impulse.refuse(toText(given), "must not take the body's velocity beyond " + toText(limit));
}

std::array<uint32_t, 2> twoSlots(const WorldData& data, BodyId a, BodyId b, const Path& call) {
  const std::array<uint32_t, 2> slots{slotOf(data, a, call / "a"), slotOf(data, b, call / "b")};
  if (slots[0] == slots[1]) (call / "b").refuse(toText(b), "must differ from a");
  return slots;
}

void checkPoint(const Path& path, Vec3d point, float unit) { check(path, point, symmetric(kMaxPosition * unit)); }

}  // namespace

BodyId World::create(const BodyDef& def) {
  const BodyPlan plan = checkedBody(def, impl_->data.def.lengthUnit);
  return impl_->data.bodyIds.id(addBody(impl_->data, def, plan));
}

void World::destroy(BodyId id) {
  const Path path("World::destroy");
  const uint32_t slot = slotOf(impl_->data, id, path / "id");
  if (impl_->data.bodies[slot].soft != kNone)
    (path / "id").refuse(toText(id), "must not name a particle of a soft body");
  removeBody(impl_->data, slot);
}

void World::excludeCollision(BodyId a, BodyId b) {
  const auto [slotA, slotB] = twoSlots(impl_->data, a, b, Path("World::excludeCollision"));
  excludeByHand(impl_->data, slotA, slotB);
}

void World::allowCollision(BodyId a, BodyId b) {
  const auto [slotA, slotB] = twoSlots(impl_->data, a, b, Path("World::allowCollision"));
  allowByHand(impl_->data, slotA, slotB);
}

std::vector<std::array<BodyId, 2>> World::excludedPairs() const {
  const WorldData& data = impl_->data;
  std::vector<std::array<BodyId, 2>> pairs;
  uint64_t last = ~uint64_t{0};
  for (const uint64_t key : data.excludedPairs) {
    if (key != last) {
      pairs.push_back({data.bodyIds.id(static_cast<uint32_t>(key >> 32)), data.bodyIds.id(static_cast<uint32_t>(key))});
    }
    last = key;
  }
  return pairs;
}

BodyType World::type(BodyId id) const { return bodyOf(impl_->data, id, "World::type").type; }
Pose World::pose(BodyId id) const { return bodyPose(bodyOf(impl_->data, id, "World::pose")); }

void World::setPose(BodyId id, const Pose& pose) {
  const Path path("World::setPose");
  const uint32_t slot = slotOf(impl_->data, id, path / "id");
  moveBody(impl_->data, slot, checkedPose(path / "pose", pose, kMaxPosition * impl_->data.def.lengthUnit));
}

Velocity World::velocity(BodyId id) const {
  const BodyData& body = bodyOf(impl_->data, id, "World::velocity");
  return {body.linearVelocity, body.angularVelocity};
}

void World::setVelocity(BodyId id, const Velocity& velocity) {
  const Path path("World::setVelocity");
  const uint32_t slot = movableSlotOf(impl_->data, id, path / "id");
  checkVelocity(path / "velocity", velocity, impl_->data.def.lengthUnit);
  changeVelocity(impl_->data, slot, velocity);
}

float World::mass(BodyId id) const { return bodyOf(impl_->data, id, "World::mass").mass; }
SymMat3 World::inertia(BodyId id) const { return bodyOf(impl_->data, id, "World::inertia").inertia; }
Vec3 World::centerOfMass(BodyId id) const { return bodyOf(impl_->data, id, "World::centerOfMass").center; }
Vec3d World::worldCenterOfMass(BodyId id) const { return bodyOf(impl_->data, id, "World::worldCenterOfMass").position; }

void World::setMassProperties(BodyId id, const MassProperties& properties) {
  const Path path("World::setMassProperties");
  const uint32_t slot = dynamicSlotOf(impl_->data, id, path / "id");
  checkMassProperties(path / "properties", properties, impl_->data.def.lengthUnit);
  impl_->data.bodies[slot].massGiven = true;
  setMass(impl_->data, slot, properties);
}

void World::addForce(BodyId id, Vec3 force) {
  BodyData& body = dynamicBodyOf(impl_->data, id, "World::addForce");
  check(Path("World::addForce") / "force", force, symmetric(kMaxForce));
  give(impl_->data, body, force, {});
}

void World::clearForces() {
  WorldData& data = impl_->data;
  updateAwake(data);
  for (const uint32_t slot : data.sleep.awake) data.bodies[slot].force = data.bodies[slot].torque = {};
  clearJointForces(data);
}

void World::addForceAt(BodyId id, Vec3 force, Vec3d point) {
  const Path path("World::addForceAt");
  BodyData& body = dynamicBodyOf(impl_->data, id, "World::addForceAt");
  check(path / "force", force, symmetric(kMaxForce));
  checkPoint(path / "point", point, impl_->data.def.lengthUnit);
  give(impl_->data, body, force, cross(toFloat(point - body.position), force));
}

void World::addTorque(BodyId id, Vec3 torque) {
  BodyData& body = dynamicBodyOf(impl_->data, id, "World::addTorque");
  check(Path("World::addTorque") / "torque", torque, symmetric(kMaxForce));
  give(impl_->data, body, {}, torque);
}

void World::addImpulse(BodyId id, Vec3 impulse) {
  const Path path("World::addImpulse");
  BodyData& body = dynamicBodyOf(impl_->data, id, "World::addImpulse");
  check(path / "impulse", impulse, symmetric(kMaxForce));
  const Vec3 reached = body.linearVelocity + impulse * (1 / body.mass);
  checkReached(path / "impulse", impulse, reached, kMaxSpeed * impl_->data.def.lengthUnit);
  changeVelocity(impl_->data, slotIn(impl_->data, body), {reached, body.angularVelocity});
}

void World::addImpulseAt(BodyId id, Vec3 impulse, Vec3d point) {
  const Path path("World::addImpulseAt");
  BodyData& body = dynamicBodyOf(impl_->data, id, "World::addImpulseAt");
  check(path / "impulse", impulse, symmetric(kMaxForce));
  checkPoint(path / "point", point, impl_->data.def.lengthUnit);
  const Vec3 linear = body.linearVelocity + impulse * (1 / body.mass);
  const Vec3 turn = cross(toFloat(point - body.position), impulse);
  const Vec3 angular = body.angularVelocity + spinFromImpulse(body, turn);
  checkReached(path / "impulse", impulse, linear, kMaxSpeed * impl_->data.def.lengthUnit);
  checkReached(path / "impulse", impulse, angular, kMaxSpin);
  changeVelocity(impl_->data, slotIn(impl_->data, body), {linear, angular});
}

void World::addAngularImpulse(BodyId id, Vec3 impulse) {
  const Path path("World::addAngularImpulse");
  BodyData& body = dynamicBodyOf(impl_->data, id, "World::addAngularImpulse");
  check(path / "impulse", impulse, symmetric(kMaxForce));
  const Vec3 reached = body.angularVelocity + spinFromImpulse(body, impulse);
  checkReached(path / "impulse", impulse, reached, kMaxSpin);
  changeVelocity(impl_->data, slotIn(impl_->data, body), {body.linearVelocity, reached});
}

void World::setDamping(BodyId id, float linear, float angular) {
  const Path path("World::setDamping");
  BodyData& body = bodyOf(impl_->data, id, "World::setDamping");
  check(path / "linear", linear, notNegative(kMaxRate));
  check(path / "angular", angular, notNegative(kMaxRate));
  wakeDynamic(impl_->data, body);
  body.linearDamping = linear;
  body.angularDamping = angular;
}

void World::setGravityScale(BodyId id, float scale) {
  BodyData& body = bodyOf(impl_->data, id, "World::setGravityScale");
  check(Path("World::setGravityScale") / "scale", scale, symmetric(kMaxRate));
  wakeDynamic(impl_->data, body);
  body.gravityScale = scale;
}

void World::setLocks(BodyId id, uint8_t locks) {
  BodyData& body = bodyOf(impl_->data, id, "World::setLocks");
  checkLocks(Path("World::setLocks") / "locks", locks);
  wakeDynamic(impl_->data, body);
  body.locks = locks;
  stopLockedAxes(body);
}

void World::setIterations(BodyId id, int iterations) {
  BodyData& body = bodyOf(impl_->data, id, "World::setIterations");
  check(Path("World::setIterations") / "iterations", iterations, Range{0, kMaxIterations});
  wakeDynamic(impl_->data, body);
  body.iterations = iterations;
}

void World::setContinuous(BodyId id, bool continuous) {
  bodyOf(impl_->data, id, "World::setContinuous").continuous = continuous;
}

void World::setMaxSpeeds(BodyId id, float linear, float angular) {
  const Path path("World::setMaxSpeeds");
  BodyData& body = bodyOf(impl_->data, id, "World::setMaxSpeeds");
  check(path / "linear", linear, positive(kMaxSpeed * impl_->data.def.lengthUnit));
  check(path / "angular", angular, positive(kMaxSpin));
  wakeDynamic(impl_->data, body);
  body.maxLinearSpeed = linear;
  body.maxAngularSpeed = angular;
}

float World::linearDamping(BodyId id) const { return bodyOf(impl_->data, id, "World::linearDamping").linearDamping; }
float World::angularDamping(BodyId id) const { return bodyOf(impl_->data, id, "World::angularDamping").angularDamping; }
float World::gravityScale(BodyId id) const { return bodyOf(impl_->data, id, "World::gravityScale").gravityScale; }
int World::iterations(BodyId id) const { return bodyOf(impl_->data, id, "World::iterations").iterations; }
bool World::isContinuous(BodyId id) const { return bodyOf(impl_->data, id, "World::isContinuous").continuous; }
uint8_t World::locks(BodyId id) const { return bodyOf(impl_->data, id, "World::locks").locks; }
float World::maxLinearSpeed(BodyId id) const { return bodyOf(impl_->data, id, "World::maxLinearSpeed").maxLinearSpeed; }
float World::maxAngularSpeed(BodyId id) const {
  return bodyOf(impl_->data, id, "World::maxAngularSpeed").maxAngularSpeed;
}

uint64_t World::userData(BodyId id) const { return bodyOf(impl_->data, id, "World::userData").userData; }
void World::setUserData(BodyId id, uint64_t data) { bodyOf(impl_->data, id, "World::setUserData").userData = data; }

std::vector<ShapeId> World::shapes(BodyId id) const {
  const uint32_t body = slotOf(impl_->data, id, Path("World::shapes") / "id");
  std::vector<ShapeId> ids;
  for (const uint32_t slot : shapeSlots(impl_->data, body)) ids.push_back(impl_->data.shapeIds.id(slot));
  return ids;
}

double World::kineticEnergy(BodyId id) const {
  return kineticEnergyOf(bodyOf(impl_->data, id, "World::kineticEnergy"));
}

}  // namespace avbd
