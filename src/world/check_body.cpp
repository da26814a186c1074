// Bodies: state, mass and what they are made of (check.h).
#include "world/check.h"
#include "world/limits.h"
#include "world/mass.h"

namespace avbd {

void checkLocks(const Path& path, uint8_t locks) {
  if (locks > 63) path.refuse(toText(locks), "must be a combination of Lock, 0 .. 63");
}

void checkVelocity(const Path& path, const Velocity& velocity, float unit) {
  check(path / "linear", velocity.linear, symmetric(kMaxSpeed * unit));
  check(path / "angular", velocity.angular, symmetric(kMaxSpin));
}

void checkMassProperties(const Path& path, const MassProperties& properties, float unit) {
  check(path / "mass", properties.mass, Range{kMinMass, kMaxMass});
  check(path / "center", properties.center, symmetric(kMaxSize * unit));
  const SymMat3& m = properties.inertia;
  const Path inertia = path / "inertia";
  check(inertia, Vec3{m.xx, m.yy, m.zz}, Range{kMinInertia, kMaxInertia});
  check(inertia, Vec3{m.xy, m.xz, m.yz}, symmetric(kMaxInertia));
  const auto moments = principalMoments(m);
  if (!(moments[0] >= kMinInertia)) inertia.refuse(toText(m), "must be positive definite");
  if (moments[0] + moments[1] < moments[2] * (1 - kInertiaTolerance)) {
    inertia.refuse(toText(m), "must be possible: no principal moment may exceed the sum of the other two");
  }
}

void checkShapesMass(const Path& path, const MassProperties& properties) {
  if (!(properties.mass >= kMinMass && properties.mass <= kMaxMass)) {
    path.refuse(toText(properties.mass), "must give a mass of " + toText(kMinMass) + " to " + toText(kMaxMass) + " kg");
  }
  const auto moments = principalMoments(properties.inertia);
  if (!(moments[0] >= kMinInertia && moments[2] <= kMaxInertia)) {
    path.refuse(toText(properties.inertia), "must give principal moments of inertia of " + toText(kMinInertia) +
                                                " to " + toText(kMaxInertia) + " kg m^2");
  }
}

namespace {

void checkMotion(const Path& path, const BodyDef& def, float unit) {
  check(path / "linearVelocity", def.linearVelocity, symmetric(kMaxSpeed * unit));
  check(path / "angularVelocity", def.angularVelocity, symmetric(kMaxSpin));
  if (def.type == BodyType::Static) {
    if (def.linearVelocity != Vec3{}) {
      (path / "linearVelocity").refuse(toText(def.linearVelocity), "must be zero on a static body");
    }
    if (def.angularVelocity != Vec3{}) {
      (path / "angularVelocity").refuse(toText(def.angularVelocity), "must be zero on a static body");
    }
  }
  check(path / "linearDamping", def.linearDamping, notNegative(kMaxRate));
  check(path / "angularDamping", def.angularDamping, notNegative(kMaxRate));
  check(path / "gravityScale", def.gravityScale, symmetric(kMaxRate));
  checkLocks(path / "locks", def.locks);
  check(path / "maxLinearSpeed", def.maxLinearSpeed, positive(kMaxSpeed * unit));
  check(path / "maxAngularSpeed", def.maxAngularSpeed, positive(kMaxSpin));
  check(path / "iterations", def.iterations, Range{0, kMaxIterations});
}

// `shape` with the fields of BodyDef that belong to it; errors name it as the user wrote it.
ShapeDef checkedSingleShape(const Path& path, const BodyDef& def, float unit) {
  const Path shape = path / "shape";
  checkGeometry(shape, *def.shape, unit);
  checkMayMove(shape, *def.shape, def.type);
  check(path / "density", def.density, notNegative(kMaxDensity));
  checkMaterial(path / "material", def.material);
  return {.geometry = *def.shape, .density = def.density, .material = def.material, .filter = def.filter};
}

MassProperties checkedBodyMass(const Path& path, const BodyDef& def, const std::vector<ShapeDef>& shapes) {
  if (shapes.empty()) {
    (path / "massProperties").refuse("nothing", "must be given for a dynamic body without shapes");
  }
  const MassProperties mass = shapesMass(shapes, def.mass);
  const char* field = def.mass > 0 ? "mass" : def.shapes.empty() ? "density" : "shapes";
  if (mass.mass == 0) {
    (path / field).refuse("0", "must give a dynamic body mass (or set mass or massProperties)");
  }
  checkShapesMass(path / field, mass);
  return mass;
}

}  // namespace

BodyPlan checkedBody(const BodyDef& def, float unit) {
  const Path path("BodyDef");
  if (def.type > BodyType::Dynamic) {
    (path / "type").refuse(toText(static_cast<int>(def.type)), "must be Static, Kinematic or Dynamic");
  }
  BodyPlan plan;
  check(path / "position", def.position, symmetric(kMaxPosition * unit));
  plan.pose = {def.position, checkedRotation(path / "rotation", def.rotation)};
  checkMotion(path, def, unit);
  check(path / "mass", def.mass, notNegative(kMaxMass));
  plan.shapes.reserve(def.shapes.size() + 1);
  if (def.shape) plan.shapes.push_back(checkedSingleShape(path, def, unit));
  const Path shapes = path / "shapes";
  for (size_t i = 0; i < def.shapes.size(); ++i) {
    plan.shapes.push_back(checkedShape(shapes[i], def.shapes[i], def.type, unit));
  }
  if (def.massProperties) checkMassProperties(path / "massProperties", *def.massProperties, unit);
  if (def.type == BodyType::Dynamic) {
    plan.mass = def.massProperties ? *def.massProperties : checkedBodyMass(path, def, plan.shapes);
  }
  return plan;
}

}  // namespace avbd
