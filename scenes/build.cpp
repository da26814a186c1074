// The words in which the scenes are written.
#include "scenes/build.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "scenes/trig.h"

namespace avbd::scenes {

WorldDef apply(const Settings& settings, WorldDef def) {
  def.iterations = settings.iterations.value_or(def.iterations);
  def.substeps = settings.substeps.value_or(def.substeps);
  def.krylovIterations = settings.krylovIterations.value_or(def.krylovIterations);
  def.simdWidth = settings.simdWidth.value_or(def.simdWidth);
  def.sleep = settings.sleep.value_or(false);
  def.workers = settings.workers.value_or(def.workers);
  def.primalSolver = settings.primalSolver.value_or(def.primalSolver);
  return def;
}

bool passes(const Figure& f) { return std::isfinite(f.measured) && f.lower <= f.measured && f.measured <= f.upper; }

Figure atMost(std::string name, double measured, double upper, std::string unit, std::string params) {
  return {std::move(name), std::move(params), measured, 0, upper, std::move(unit)};
}

Figure within(std::string name, double measured, double target, double tolerance, std::string unit,
              std::string params) {
  const double slack = std::abs(target) * tolerance;
  return {std::move(name), std::move(params), measured, target - slack, target + slack, std::move(unit)};
}

Figure holds(std::string name, bool yes, std::string params) {
  return {std::move(name), std::move(params), yes ? 1.0 : 0.0, 1, 1, "yes/no"};
}

Quat turned(Vec3 axis, double angle) {
  const float s = static_cast<float>(sine(angle / 2));
  return {static_cast<float>(cosine(angle / 2)), axis.x * s, axis.y * s, axis.z * s};
}

Quat along(Vec3 axis) {
  const Vec3 turn = cross(Vec3{1, 0, 0}, axis);
  if (dot(turn, turn) < 1e-12f) return axis.x > 0 ? Quat{} : Quat{0, 0, 1, 0};
  const double cosineOfTurn = static_cast<double>(axis.x) / length(toDouble(axis));
  const float s = static_cast<float>(std::sqrt((1 - cosineOfTurn) / 2));
  const Vec3 about = turn * (s / length(turn));
  return {static_cast<float>(std::sqrt((1 + cosineOfTurn) / 2)), about.x, about.y, about.z};
}

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

Build::Build(std::string name, const Settings& settings, WorldDef def) {
  model_.name = std::move(name);
  model_.world = World(apply(settings, def));
  friction(kFriction);
}

Build& Build::friction(float mu) {
  material_ = {};
  material_.friction = mu;
  return *this;
}

Build& Build::surface(const Material& material) {
  material_ = material;
  return *this;
}

Build& Build::filter(const Filter& value) {
  filter_ = value;
  return *this;
}

BodyId Build::add(std::string name, BodyDef def) {
  def.material = material_;
  def.filter = filter_;
  const BodyId id = model_.world.create(def);
  model_.bodies.push_back({id, std::move(name)});
  return id;
}

BodyId Build::fixedBox(std::string name, Box half, Vec3d at, Quat rotation) {
  BodyDef def;
  def.type = BodyType::Static;
  def.position = at;
  def.rotation = rotation;
  def.shape = half;
  return add(std::move(name), def);
}

BodyId Build::ground() { return fixedBox("ground", {100, 1, 100}, {0, -1, 0}); }

BodyId Build::box(std::string name, Box half, Vec3d at, float mass, Velocity velocity, Quat rotation) {
  BodyDef def;
  def.position = at;
  def.rotation = rotation;
  def.linearVelocity = velocity.linear;
  def.angularVelocity = velocity.angular;
  def.shape = half;
  def.mass = mass;
  return add(std::move(name), def);
}

BodyId Build::ball(std::string name, float radius, Vec3d at, float mass, Velocity velocity) {
  BodyDef def;
  def.position = at;
  def.linearVelocity = velocity.linear;
  def.angularVelocity = velocity.angular;
  def.shape = Sphere{radius};
  def.mass = mass;
  return add(std::move(name), def);
}

Pose Build::inBody(BodyId id, const Pose& at) const {
  if (!id) return at;
  const Pose p = model_.world.pose(id);
  const Quat back = conjugate(p.rotation);
  return {rotate(back, at.position - p.position), back * at.rotation};
}

SoftId Build::soft(const std::string& name, const SoftDef& def) {
  const SoftId id = model_.world.create(def);
  model_.softs.push_back({id, name});
  const std::vector<BodyId> particles = model_.world.particles(id);
  for (size_t i = 0; i < particles.size(); ++i) model_.bodies.push_back({particles[i], name + "_" + std::to_string(i)});
  return id;
}

JointId Build::joint(BodyId a, BodyId b, Vec3d at) {
  BallJoint def;
  def.bodyA = a;
  def.bodyB = b;
  def.frameA.position = inBody(a, {at, {}}).position;
  def.frameB.position = inBody(b, {at, {}}).position;
  return model_.world.create(def);
}

}  // namespace avbd::scenes
