// Broken definitions of bodies, shapes and joints, and calls with values out of range (bad_input.h).
#include <array>
#include <cmath>
#include <limits>

#include "scenes/bad_input.h"
#include "scenes/build.h"

namespace avbd::scenes {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string label(float v) { return text(v); }
std::string label(Vec3 v) { return text(v.x) + " " + text(v.y) + " " + text(v.z); }
std::string label(Vec3d v) { return text(v.x) + " " + text(v.y) + " " + text(v.z); }
std::string label(Quat q) { return text(q.w) + " " + label(Vec3{q.x, q.y, q.z}); }

BodyDef goodBody() {
  BodyDef def;
  def.position = {0, 5, 0};
  def.shape = Box{0.5f, 0.5f, 0.5f};
  return def;
}

class Corpus {
 public:
  void add(std::string definition, std::string field, std::string value, std::function<void(Victim&)> call) {
    list_.push_back({std::move(definition), std::move(field), std::move(value), std::move(call)});
  }
  /// A BodyDef that `spoil` has broken.
  void body(std::string field, std::string value, std::function<void(BodyDef&)> spoil) {
    add("BodyDef", std::move(field), std::move(value), [spoil](Victim& v) {
      BodyDef def = goodBody();
      spoil(def);
      v.world.create(def);
    });
  }
  /// One field of a BodyDef, each of these values.
  template <class T>
  void bodyValues(const char* field, T BodyDef::*member, std::initializer_list<T> values) {
    for (const T& value : values) body(field, label(value), [=](BodyDef& d) { d.*member = value; });
  }
  void shape(std::string field, std::string value, std::function<void(ShapeDef&)> spoil) {
    add("ShapeDef", std::move(field), std::move(value), [spoil](Victim& v) {
      ShapeDef def;
      spoil(def);
      v.world.create(v.box, def);
    });
  }
  void geometry(std::string field, std::string value, Geometry geometry) {
    shape("geometry." + field, std::move(value), [=](ShapeDef& d) { d.geometry = geometry; });
  }
  std::vector<BadCall> take() { return std::move(list_); }

 private:
  std::vector<BadCall> list_;
};

}  // namespace

std::vector<BadCall> badBodies() {
  Corpus c;
  c.body("type", "7", [](BodyDef& d) { d.type = static_cast<BodyType>(7); });
  c.bodyValues<Vec3d>("position", &BodyDef::position, {{kNan, 0, 0}, {0, kInfinity, 0}, {0, 0, -2e9}});
  c.bodyValues<Quat>("rotation", &BodyDef::rotation, {{0, 0, 0, 0}, {kNan, 0, 0, 0}, {2, 0, 0, 0}, {1, 0.1f, 0, 0}});
  c.bodyValues<Vec3>("linearVelocity", &BodyDef::linearVelocity, {{kNan, 0, 0}, {0, kInfinity, 0}, {0, 0, 2e9f}});
  c.bodyValues<Vec3>("angularVelocity", &BodyDef::angularVelocity, {{0, kNan, 0}, {-kInfinity, 0, 0}, {2e6f, 0, 0}});
  c.bodyValues<float>("mass", &BodyDef::mass, {kNan, kInfinity, -1, 2e18f, 1e-30f});
  c.bodyValues<float>("density", &BodyDef::density, {kNan, kInfinity, -1, 2e12f, 0});
  c.bodyValues<float>("linearDamping", &BodyDef::linearDamping, {kNan, -0.1f, kInfinity});
  c.bodyValues<float>("angularDamping", &BodyDef::angularDamping, {kNan, -0.1f, kInfinity});
  c.bodyValues<float>("gravityScale", &BodyDef::gravityScale, {kNan, kInfinity, -2e6f});
  c.bodyValues<float>("maxLinearSpeed", &BodyDef::maxLinearSpeed, {kNan, 0, -1, kInfinity});
  c.bodyValues<float>("maxAngularSpeed", &BodyDef::maxAngularSpeed, {kNan, 0, -1, kInfinity});
  c.body("locks", "64", [](BodyDef& d) { d.locks = 64; });
  c.body("linearVelocity", "static", [](BodyDef& d) {
    d.type = BodyType::Static;
    d.linearVelocity = {1, 0, 0};
  });
  c.body("massProperties", "nothing", [](BodyDef& d) { d.shape.reset(); });
  const auto mass = [&](const char* field, MassProperties m, const char* value) {
    c.body(std::string("massProperties.") + field, value, [=](BodyDef& d) { d.massProperties = m; });
  };
  mass("mass", {.mass = kNan}, "nan");
  mass("mass", {.mass = 0}, "0");
  mass("mass", {.mass = -1}, "-1");
  mass("center", {.center = {0, kNan, 0}}, "nan");
  mass("inertia", {.inertia = {0, 1, 1, 0, 0, 0}}, "zero");
  mass("inertia", {.inertia = {1, 1, 1, 2, 0, 0}}, "indefinite");
  mass("inertia", {.inertia = {1, 1, 5, 0, 0, 0}}, "impossible");
  mass("inertia", {.inertia = {kNan, 1, 1, 0, 0, 0}}, "nan");
  for (const Geometry& g : {Geometry{HalfSpace{}}, Geometry{Mesh{}}, Geometry{HeightField{}}})
    c.body(std::holds_alternative<HalfSpace>(g) ? "shape" : "shape.data", "on a dynamic body",
           [=](BodyDef& d) { d.shape = g; });
  c.body("shapes[1].density", "nan", [](BodyDef& d) {
    d.shapes.resize(2);
    d.shapes[1].density = kNan;
  });
  return c.take();
}

std::vector<BadCall> badShapes() {
  Corpus c;
  for (const float bad : {kNan, kInfinity, 0.0f, -1.0f, 1e-9f, 1e9f}) {
    const std::string value = text(bad);
    c.geometry("radius", value, Sphere{bad});
    c.geometry("radius", value, Capsule{bad, 1});
    c.geometry("x", value, Box{bad, 1, 1});
    c.geometry("y", value, Box{1, bad, 1});
    c.geometry("z", value, Box{1, 1, bad});
    c.geometry("radius", value, Cylinder{bad, 1});
    c.geometry("halfHeight", value, Cylinder{1, bad});
    c.geometry("radius", value, Cone{bad, 1});
    c.geometry("halfHeight", value, Cone{1, bad});
    c.geometry("x", value, Ellipsoid{bad, 1, 1});
    c.geometry("y", value, Ellipsoid{1, bad, 1});
    c.geometry("z", value, Ellipsoid{1, 1, bad});
  }
  for (const float bad : {kNan, -0.1f, kInfinity}) {
    const std::string value = text(bad);
    c.geometry("halfHeight", value, Capsule{1, bad});
    c.geometry("rounding", value, Box{1, 1, 1, bad});
    c.geometry("rounding", value, Cylinder{1, 1, bad});
    c.geometry("rounding", value, Cone{1, 1, bad});
    c.shape("density", value, [=](ShapeDef& d) { d.density = bad; });
    c.shape("material.friction", value, [=](ShapeDef& d) { d.material.friction = bad; });
    c.shape("material.restitution", value, [=](ShapeDef& d) { d.material.restitution = bad; });
    c.shape("material.torsionalFriction", value, [=](ShapeDef& d) { d.material.torsionalFriction = bad; });
    c.shape("material.rollingFriction", value, [=](ShapeDef& d) { d.material.rollingFriction = bad; });
    c.shape("materials[0].friction", value, [=](ShapeDef& d) { d.materials.resize(1), d.materials[0].friction = bad; });
  }
  c.geometry("data", "null", Hull{});
  c.shape("material.restitution", "1.5", [](ShapeDef& d) { d.material.restitution = 1.5f; });
  c.shape("material.staticFriction", "0.1", [](ShapeDef& d) { d.material.staticFriction = 0.1f; });
  c.shape("material.frictionCombine", "9", [](ShapeDef& d) { d.material.frictionCombine = static_cast<Combine>(9); });
  c.shape("pose.position", "nan", [](ShapeDef& d) { d.pose.position.x = kNan; });
  c.shape("pose.rotation", "0", [](ShapeDef& d) { d.pose.rotation = {0, 0, 0, 0}; });
  return c.take();
}

namespace {

void addIds(Corpus& c) {
  c.add("World::pose", "id", "null", [](Victim& v) { (void)v.world.pose(BodyId{}); });
  c.add("World::pose", "id", "dead", [](Victim& v) { (void)v.world.pose(v.deadBody); });
  c.add("World::pose", "id", "foreign", [](Victim& v) { (void)v.world.pose({999, 1}); });
  c.add("World::setPose", "id", "dead", [](Victim& v) { v.world.setPose(v.deadBody, {}); });
  c.add("World::destroy", "id", "dead body", [](Victim& v) { v.world.destroy(v.deadBody); });
  c.add("World::destroy", "id", "dead shape", [](Victim& v) { v.world.destroy(v.deadShape); });
  c.add("World::destroy", "id", "dead joint", [](Victim& v) { v.world.destroy(v.deadJoint); });
  c.add("World::create", "body", "dead", [](Victim& v) { v.world.create(v.deadBody, ShapeDef{}); });
  c.add("World::material", "id", "dead", [](Victim& v) { (void)v.world.material(v.deadShape); });
  c.add("World::reaction", "id", "dead", [](Victim& v) { (void)v.world.reaction(v.deadJoint); });
  c.add("World::excludeCollision", "b", "the same", [](Victim& v) { v.world.excludeCollision(v.box, v.box); });
  c.add("World::excludeCollision", "a", "dead", [](Victim& v) { v.world.excludeCollision(v.deadBody, v.box); });
  c.add("World::setVelocity", "id", "static", [](Victim& v) { v.world.setVelocity(v.floor, {}); });
  c.add("World::addForce", "id", "static", [](Victim& v) { v.world.addForce(v.floor, {1, 0, 0}); });
  c.add("World::setMassProperties", "id", "static", [](Victim& v) { v.world.setMassProperties(v.floor, {}); });
  c.add("BallJoint", "bodyA", "dead", [](Victim& v) { v.world.create(BallJoint{v.deadBody, v.box}); });
  c.add("BallJoint", "bodyB", "the same", [](Victim& v) { v.world.create(BallJoint{v.box, v.box}); });
}

void addValues(Corpus& c) {
  for (const float bad : {kNan, kInfinity, 1e30f}) {
    const std::string value = text(bad);
    const Vec3 vector{0, bad, 0};
    const Vec3d point{0, 0, bad};
    c.add("World::addForce", "force", value, [=](Victim& v) { v.world.addForce(v.box, vector); });
    c.add("World::addForceAt", "point", value, [=](Victim& v) { v.world.addForceAt(v.box, {1, 0, 0}, point); });
    c.add("World::addTorque", "torque", value, [=](Victim& v) { v.world.addTorque(v.box, vector); });
    c.add("World::addImpulse", "impulse", value, [=](Victim& v) { v.world.addImpulse(v.box, vector); });
    c.add("World::setVelocity", "velocity.linear", value, [=](Victim& v) { v.world.setVelocity(v.box, {vector, {}}); });
    c.add("World::setPose", "pose.position", value, [=](Victim& v) { v.world.setPose(v.box, {point, {}}); });
    c.add("World::setGravity", "gravity", value, [=](Victim& v) { v.world.setGravity(vector); });
    c.add("BallJoint", "frameA.position", value, [=](Victim& v) {
      v.world.create(BallJoint{v.box, v.floor, {point, {}}});
    });
  }
  for (const float dt : {kNan, 0.0f, -0.1f, 1.5f, 1e-12f, kInfinity})
    c.add("World::step", "dt", text(dt), [=](Victim& v) { v.world.step(dt); });
  for (const int n : {0, -1, 100000}) {
    c.add("World::setIterations", "iterations", text(n), [=](Victim& v) { v.world.setIterations(n); });
    c.add("World::setSubsteps", "substeps", text(n), [=](Victim& v) { v.world.setSubsteps(n); });
    c.add("WorldDef", "iterations", text(n), [=](Victim&) { World({.iterations = n}); });
    c.add("WorldDef", "workers", text(n), [=](Victim&) { World({.workers = n}); });
  }
  c.add("WorldDef", "gravity", "nan", [](Victim&) { World({.gravity = {kNan, 0, 0}}); });
  c.add("WorldDef", "lengthUnit", "0", [](Victim&) { World({.lengthUnit = 0}); });
  c.add("WorldDef", "hitSpeed", "0", [](Victim&) { World({.hitSpeed = 0}); });
  c.add("WorldDef", "simdWidth", "3", [](Victim&) { World({.simdWidth = 3}); });
  c.add("WorldDef", "jointArmBlend", "2", [](Victim&) { World({.jointArmBlend = 2}); });
}

template <class T>
std::span<const T> view(const std::vector<T>& v) {
  return {v.data(), v.size()};
}

void addHulls(Corpus& c) {
  const auto hull = [&](const char* field, const char* value, std::vector<Vec3> points, float tolerance = 0,
                        int most = 64) {
    c.add("HullDef", field, value, [=](Victim&) { makeHull({view(points), tolerance, most}); });
  };
  const std::vector<Vec3> good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  hull("points", "none", {});
  hull("points", "three", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  hull("points", "one point", {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}});
  hull("points", "collinear", {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {7, 7, 7}});
  hull("points", "coplanar", {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0.5f, 0, 0.2f}});
  hull("points", "almost coplanar", {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 1e-6f, 1}, {0.5f, 0, 0.2f}});
  hull("points[2]", "nan", {{0, 0, 0}, {1, 0, 0}, {0, kNan, 0}, {0, 0, 1}});
  hull("points[0]", "inf", {{kInfinity, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  hull("points[3]", "1e9", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e9f}});
  hull("tolerance", "nan", good, kNan);
  hull("tolerance", "-1", good, -1);
  hull("maxVertices", "3", good, 0, 3);
  hull("maxVertices", "256", good, 0, 256);
}

using Triangles = std::vector<std::array<uint32_t, 3>>;

void addSurfaces(Corpus& c) {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
  const Triangles two{{0, 2, 1}, {0, 3, 2}};
  const auto mesh = [&](const char* field, const char* value, std::vector<Vec3> vertices, Triangles triangles,
                        std::vector<uint16_t> materials = {}, float weld = 0) {
    c.add("MeshDef", field, value, [=](Victim&) {
      makeMesh({view(vertices), view(triangles), view(materials), false, weld});
    });
  };
  mesh("vertices", "none", {}, two);
  mesh("triangles", "none", square, {});
  mesh("triangles[1]", "index 4", square, {{0, 2, 1}, {0, 4, 2}});
  mesh("vertices[1]", "nan", {{0, 0, 0}, {kNan, 0, 0}, {1, 0, 1}, {0, 0, 1}}, two);
  mesh("vertices[2]", "inf", {{0, 0, 0}, {1, 0, 0}, {1, 0, kInfinity}, {0, 0, 1}}, two);
  mesh("triangles", "all without area", square, {{0, 0, 1}, {1, 2, 2}});
  mesh("materials", "one for two", square, two, {1});
  mesh("weldDistance", "-1", square, two, {}, -1);
  mesh("weldDistance", "nan", square, two, {}, kNan);
  const auto field = [&](const char* name, const char* value, auto spoil) {
    c.add("HeightFieldDef", name, value, [=](Victim&) {
      std::vector<float> heights(9, 0.0f);
      std::vector<uint16_t> materials;
      HeightFieldDef def;
      def.columns = def.rows = 3;
      spoil(def, heights, materials);
      def.heights = view(heights);
      def.materials = view(materials);
      makeHeightField(def);
    });
  };
  using Def = HeightFieldDef;
  using Heights = std::vector<float>;
  using Ids = std::vector<uint16_t>;
  field("rows", "1", [](Def& d, Heights& h, Ids&) { d.rows = 1, h.resize(3); });
  field("columns", "0", [](Def& d, Heights& h, Ids&) { d.columns = 0, h.clear(); });
  field("columns", "-3", [](Def& d, Heights&, Ids&) { d.columns = -3; });
  field("rows", "1000000", [](Def& d, Heights&, Ids&) { d.rows = 1000000; });
  field("heights", "eight of nine", [](Def&, Heights& h, Ids&) { h.pop_back(); });
  field("heights[4]", "nan", [](Def&, Heights& h, Ids&) { h[4] = kNan; });
  field("heights[0]", "1e30", [](Def&, Heights& h, Ids&) { h[0] = 1e30f; });
  field("spacingX", "0", [](Def& d, Heights&, Ids&) { d.spacingX = 0; });
  field("spacingZ", "nan", [](Def& d, Heights&, Ids&) { d.spacingZ = kNan; });
  field("materials", "three of four", [](Def&, Heights&, Ids& m) { m.resize(3); });
  field("thickness", "-1", [](Def& d, Heights&, Ids&) { d.thickness = -1; });
}

}  // namespace

std::vector<BadCall> badCalls() {
  Corpus c;
  addIds(c);
  addValues(c);
  addHulls(c);
  addSurfaces(c);
  return c.take();
}

}  // namespace avbd::scenes
