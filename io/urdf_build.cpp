// From a URDF description to a Model: bodies, shapes and the ground; joints are made by urdf_joints.h.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "io/urdf.h"
#include "io/urdf_groups.h"
#include "io/urdf_hulls.h"
#include "io/urdf_joints.h"
#include "io/urdf_touching.h"

namespace avbd {

namespace urdf {

namespace {

Quat toQuat(mjcf::Quatd q) {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
}
Pose toPose(const Posed& p) { return {p.position, toQuat(mjcf::normalized(p.rotation))}; }

class Builder {
 public:
  Builder(Description description, const UrdfOptions& options);
  Model build();

 private:
  void loadHulls();
  void addShapes(size_t link);
  std::optional<Color> colorOf(const Link& link, const Shape& shape) const;
  void addShape(size_t link, const Shape& shape, Geometry geometry);
  Geometry geometryOf(const Link& link, const Shape& shape) const;
  Material materialOf(const Link& link) const;
  void addBody(size_t root);
  void setMass(size_t root, BodyDef& def);
  void addGround();

  float narrow(double value, const Link& link) const;
  [[noreturn]] void fail(const Link& link, const std::string& message) const {
    throw FileError(link.where + ": " + message, in_.fileName, link.line);
  }
  bool moves(size_t body) const { return static_cast<int>(body) != groups_.still; }

  Description in_;
  const UrdfOptions& options_;
  std::vector<Posed> poses_;      // of links, in the world
  std::vector<LinkHulls> hulls_;  // by link
  Groups groups_;
  std::vector<BodyDef> defs_;                              // by first link
  std::vector<std::vector<const Shape*>> shapes_;          // of defs_' shapes
  std::vector<std::vector<std::optional<Color>>> colors_;  // of defs_' shapes
  std::vector<BodyId> ids_;                                // by first link
  double lowest_ = std::numeric_limits<double>::infinity();
  Model model_;
};

Builder::Builder(Description description, const UrdfOptions& options)
    : in_(std::move(description)), options_(options), poses_(linkPoses(in_)) {
  if (options.ground && !(std::isfinite(*options.ground) && *options.ground >= 0)) {
    throw Error("UrdfOptions", "ground", std::to_string(*options.ground), "must be finite and >= 0");
  }
  WorldDef world = options.world;
  world.gravity = {0, 0, -9.81f};
  model_.world = World(world);
  model_.name = in_.name;
  model_.up = {0, 0, 1};
  if (!options.collideVisuals) return;
  for (Link& link : in_.links) {
    if (!link.collisions.empty() || link.visuals.empty()) continue;
    link.collisions = link.visuals;
    in_.notes.add(link.where, "no <collision>: collides as its <visual>");
  }
}

void Builder::loadHulls() {
  for (const Link& link : in_.links) {
    if (link.visuals.empty() || options_.collideVisuals) continue;
    in_.notes.add(link.visuals[0].where, "visuals are not used, but for their colour");
  }
  Hulls hulls(in_, options_, in_.notes);
  hulls_.resize(in_.links.size());
  for (size_t i = 0; i < in_.links.size(); ++i) {
    const std::vector<Shape>& shapes = in_.links[i].collisions;
    for (size_t k = 0; k < shapes.size(); ++k) {
      if (shapes[k].kind != ShapeKind::Mesh) continue;
      hulls_[i].emplace(k, hulls.get(shapes[k]));
    }
  }
}

float Builder::narrow(double value, const Link& link) const {
  if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
    fail(link, "a number that follows from it is beyond the range of float");
  }
  return static_cast<float>(value);
}

// Not of a mesh.
Geometry Builder::geometryOf(const Link& link, const Shape& shape) const {
  const auto f = [&](double v) { return narrow(v, link); };
  switch (shape.kind) {
    case ShapeKind::Box:
      return Box{f(shape.size.x), f(shape.size.y), f(shape.size.z)};
    case ShapeKind::Cylinder:
      return Cylinder{f(shape.size.x), f(shape.size.y)};
    case ShapeKind::Capsule:
      return Capsule{f(shape.size.x), f(shape.size.y)};
    default:
      return Sphere{f(shape.size.x)};
  }
}

Material Builder::materialOf(const Link& link) const {
  Material out;
  const Surface& s = link.surface;
  if (s.friction) out.friction = narrow(*s.friction, link);
  if (s.rolling) out.rollingFriction = narrow(*s.rolling, link);
  if (s.spinning) out.torsionalFriction = narrow(*s.spinning, link);
  if (s.restitution) out.restitution = narrow(*s.restitution, link);
  return out;
}

void Builder::addShapes(size_t index) {
  const Link& link = in_.links[index];
  for (size_t k = 0; k < link.collisions.size(); ++k) {
    const Shape& shape = link.collisions[k];
    if (shape.kind != ShapeKind::Mesh) {
      addShape(index, shape, geometryOf(link, shape));
      continue;
    }
    for (const auto& hull : hulls_[index].at(k)) addShape(index, shape, Hull{hull});
  }
}

// Collisions have none of their own: they take that of what is seen in their place.
std::optional<Color> Builder::colorOf(const Link& link, const Shape& shape) const {
  if (shape.color) return shape.color;
  for (const Shape& visual : link.visuals) {
    if (visual.color) return visual.color;
  }
  return {};
}

void Builder::addShape(size_t index, const Shape& shape, Geometry geometry) {
  const Hull* hull = std::get_if<Hull>(&geometry);
  lowest_ = std::min(lowest_, urdf::lowest(shape, hull ? hull->data.get() : nullptr, poses_[index] * shape.pose));
  const size_t body = groups_.bodyOf[index];
  Posed pose = inBody(groups_, poses_, index) * shape.pose;
  // Ours stand along y, URDF's along z.
  const mjcf::Quatd yToZ{std::sqrt(0.5), std::sqrt(0.5), 0, 0};
  const bool isLong = shape.kind == ShapeKind::Cylinder || shape.kind == ShapeKind::Capsule;
  if (isLong) pose.rotation = pose.rotation * yToZ;
  ShapeDef def;
  def.geometry = std::move(geometry);
  def.pose = toPose(pose);
  def.material = materialOf(in_.links[index]);
  if (!options_.selfCollision) def.filter.group = -1;
  defs_[body].shapes.push_back(std::move(def));
  shapes_[body].push_back(&shape);
  colors_[body].push_back(colorOf(in_.links[index], shape));
}

void Builder::setMass(size_t root, BodyDef& def) {
  const Link& link = in_.links[root];
  const Mass& mass = groups_.masses[root];
  if (!(mass.mass > 0)) return;
  const auto f = [&](double v) { return narrow(v, link); };
  const mjcf::Sym3d& m = mass.inertia;
  def.massProperties = MassProperties{f(mass.mass),
                                      {f(mass.center.x), f(mass.center.y), f(mass.center.z)},
                                      {f(m.xx), f(m.yy), f(m.zz), f(m.xy), f(m.xz), f(m.yz)}};
}

void Builder::addBody(size_t root) {
  const Link& link = in_.links[root];
  BodyDef& def = defs_[root];
  def.type = moves(root) ? BodyType::Dynamic : BodyType::Static;
  if (moves(root)) setMass(root, def);
  if (moves(root) && !def.massProperties) {
    if (!def.shapes.empty()) fail(link, "a body that moves needs a mass > 0: give it an <inertial>");
    in_.notes.add(link.where, "nothing but a frame: no body is made of it");
    return;
  }
  const Pose pose = toPose(poses_[root]);
  def.position = pose.position;
  def.rotation = pose.rotation;
  try {
    ids_[root] = model_.world.create(def);
  } catch (const Error& error) {
    constexpr std::string_view kShapes = "shapes[";
    const std::string& field = error.field();
    if (!field.starts_with(kShapes)) fail(link, error.what());
    const size_t index = static_cast<size_t>(std::strtoul(field.c_str() + kShapes.size(), nullptr, 10));
    const Shape& shape = *shapes_[root].at(index);
    throw FileError(shape.where + ": " + error.what(), in_.fileName, shape.line);
  }
  model_.bodies.push_back({ids_[root], link.name, std::move(colors_[root])});
}

void Builder::addGround() {
  if (!options_.ground) return;
  BodyDef def;
  def.type = BodyType::Static;
  def.position.z = (std::isfinite(lowest_) ? lowest_ : 0) - *options_.ground;
  def.rotation = toQuat({std::sqrt(0.5), std::sqrt(0.5), 0, 0});  // its y is up
  def.shape = HalfSpace{};
  std::string name = "ground";
  const auto taken = [&] {
    return std::any_of(in_.links.begin(), in_.links.end(), [&](const Link& link) { return link.name == name; });
  };
  while (taken()) name += "_";
  model_.bodies.push_back({model_.world.create(def), name});
}

Model Builder::build() {
  loadHulls();
  groups_ = groupsOf(in_, poses_, hulls_, options_.floating, in_.notes);
  defs_.resize(in_.links.size());
  shapes_.resize(in_.links.size());
  colors_.resize(in_.links.size());
  ids_.resize(in_.links.size());
  for (size_t i = 0; i < in_.links.size(); ++i) addShapes(i);
  for (size_t i = 0; i < in_.links.size(); ++i) {
    if (groups_.bodyOf[i] == i) addBody(i);
  }
  addJoints({in_, groups_, poses_, ids_}, options_.limp, model_, in_.notes);
  if (options_.selfCollision) separateTouching(model_, in_.notes);
  addGround();
  // At the 1/60 s of a model without joints a held robot does not stand still on its feet.
  if (model_.world.jointCount() > 0) model_.dt = 1.0 / 240;
  model_.notes = in_.notes.lines();
  return std::move(model_);
}

}  // namespace

}  // namespace urdf

Model readUrdf(const std::filesystem::path& file, const UrdfOptions& options) {
  return urdf::Builder(urdf::parseFile(file), options).build();
}

Model readUrdfText(std::string_view xml, std::string_view nameForMessages, const UrdfOptions& options) {
  return urdf::Builder(urdf::parseText(xml, nameForMessages), options).build();
}

}  // namespace avbd
