// From a URDF description to a Model: which links become one body, then bodies, shapes, joints and the ground.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include "io/mjcf_mass.h"
#include "io/urdf.h"
#include "io/urdf_hulls.h"
#include "io/urdf_mass.h"
#include "io/urdf_parse.h"
#include "io/xml_source.h"

namespace avbd {

namespace urdf {

namespace {

// Joints that this reader does not weld.
bool parts(JointKind kind) { return kind == JointKind::Floating || kind == JointKind::Spherical; }

Quat toQuat(mjcf::Quatd q) {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
}
Pose toPose(const Posed& p) { return {p.position, toQuat(mjcf::normalized(p.rotation))}; }

class Builder {
 public:
  Builder(Description description, const UrdfOptions& options);
  Model build();

 private:
  void group();
  void noteJoints();
  void loadHulls();
  void addShapes(size_t link);
  std::optional<Color> colorOf(const Link& link, const Shape& shape) const;
  void addShape(size_t link, const Shape& shape, Geometry geometry);
  Geometry geometryOf(const Link& link, const Shape& shape) const;
  Material materialOf(const Link& link) const;
  void gatherMass(size_t head, std::vector<Mass>& parts);
  void addBody(size_t root);
  void noteLargeInertia(size_t link, const Mass& mass);
  void setMass(size_t root, BodyDef& def);
  void addJoint(const Joint& joint);
  void addGround();

  float narrow(double value, const Link& link) const;
  [[noreturn]] void fail(const Link& link, const std::string& message) const {
    throw FileError(link.where + ": " + message, in_.fileName, link.line);
  }
  Posed inBody(size_t link) const { return mjcf::inverse(poses_[bodyOf_[link]]) * poses_[link]; }
  bool moves(size_t body) const { return options_.floating || body != static_cast<size_t>(in_.order[0]); }

  Description in_;
  const UrdfOptions& options_;
  std::vector<Posed> poses_;    // of links, in the world
  std::vector<size_t> bodyOf_;  // by link: the link whose body it is part of
  std::vector<size_t> headOf_;  // by link: the first link that fixed joints alone join it to
  std::vector<std::vector<size_t>> linksOfHead_, headsOfBody_;  // the same the other way round
  std::vector<LinkHulls> hulls_;                                // by link
  std::vector<BodyDef> defs_;                                   // of links that are bodies
  std::vector<std::vector<const Shape*>> shapes_;               // of defs_' shapes
  std::vector<std::vector<std::optional<Color>>> colors_;       // of defs_' shapes
  std::vector<BodyId> ids_;
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

void Builder::group() {
  bodyOf_.resize(in_.links.size());
  headOf_.resize(in_.links.size());
  for (const int index : in_.order) {
    const size_t i = static_cast<size_t>(index);
    bodyOf_[i] = headOf_[i] = i;
    if (in_.links[i].joint < 0) continue;
    const Joint& joint = in_.joints[static_cast<size_t>(in_.links[i].joint)];
    const size_t parent = static_cast<size_t>(joint.parent);
    if (!parts(joint.kind)) bodyOf_[i] = bodyOf_[parent];
    if (joint.kind == JointKind::Fixed) headOf_[i] = headOf_[parent];
  }
  linksOfHead_.resize(in_.links.size());
  headsOfBody_.resize(in_.links.size());
  for (size_t i = 0; i < in_.links.size(); ++i) {
    linksOfHead_[headOf_[i]].push_back(i);
    if (headOf_[i] == i) headsOfBody_[bodyOf_[i]].push_back(i);
  }
}

void Builder::noteJoints() {
  for (const Joint& joint : in_.joints) {
    const std::string kind = nameOf(joint.kind);
    if (joint.kind != JointKind::Fixed && !parts(joint.kind)) {
      in_.notes.add(joint.where, kind + " joint: welded at position 0");
    }
    if (joint.kind == JointKind::Spherical) in_.notes.add(joint.where, "not part of URDF: taken for a ball joint");
    if (joint.mimic) in_.notes.add(joint.where, "mimic: kept, but the joint is welded");
  }
  if (options_.collideVisuals) return;
  for (const Link& link : in_.links) {
    if (!link.visuals.empty()) in_.notes.add(link.visuals[0].where, "visuals are not used, but for their colour");
  }
}

void Builder::loadHulls() {
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
  Posed pose = inBody(index) * shape.pose;
  // Ours stand along y, URDF's along z.
  const mjcf::Quatd yToZ{std::sqrt(0.5), std::sqrt(0.5), 0, 0};
  const bool isLong = shape.kind == ShapeKind::Cylinder || shape.kind == ShapeKind::Capsule;
  if (isLong) pose.rotation = pose.rotation * yToZ;
  ShapeDef def;
  def.geometry = std::move(geometry);
  def.pose = toPose(pose);
  def.material = materialOf(in_.links[index]);
  defs_[bodyOf_[index]].shapes.push_back(std::move(def));
  shapes_[bodyOf_[index]].push_back(&shape);
  colors_[bodyOf_[index]].push_back(colorOf(in_.links[index], shape));
}

// Of all links that fixed joints join to `head`, in the frame of its body. If none of them has a mass, they get one.
void Builder::gatherMass(size_t head, std::vector<Mass>& out) {
  const std::vector<size_t>& links = linksOfHead_[head];
  const bool any = std::any_of(links.begin(), links.end(), [&](size_t i) { return in_.links[i].mass.has_value(); });
  bool solid = false;
  for (const size_t i : links) {
    const Link& link = in_.links[i];
    if (any && !link.mass) {
      if (link.collisions.empty()) continue;  // a mere frame
      in_.notes.add(link.where, "no mass of its own: the link that it is fixed to has one");
      continue;
    }
    const Mass mass = any ? withInertia(link, hulls_[i]) : massOfCollisions(link, hulls_[i]);
    noteLargeInertia(i, mass);
    solid = solid || mass.mass > 0;
    out.push_back(mjcf::moved(mass, inBody(i)));
  }
  const bool alone = headsOfBody_[bodyOf_[head]].size() == 1;
  if (any || (alone && !solid)) return;  // the latter is no body, or refused
  in_.notes.add(in_.links[head].where, solid ? "moves but has no mass: that of its collisions at 1000 kg/m^3 is taken"
                                             : "moves but has neither mass nor collisions: adds nothing");
}

// Mass within the collisions cannot have a radius of gyration beyond their reach; four times that is no matter of
// covers.
void Builder::noteLargeInertia(size_t index, const Mass& mass) {
  const Link& link = in_.links[index];
  if (!link.mass) return;
  constexpr double kMost = 4;
  const double radius = reach(link, hulls_[index]), most = kMost * kMost * radius * radius * mass.mass;
  const auto p = mjcf::principal(mass.inertia).values;
  if (radius > 0 && *std::max_element(p.begin(), p.end()) > most) {
    in_.notes.add(link.where,
                  "its inertia is larger than its mass can have within its collisions (wrong unit or frame?)");
  }
}

void Builder::setMass(size_t root, BodyDef& def) {
  const Link& link = in_.links[root];
  std::vector<Mass> all;
  for (const size_t head : headsOfBody_[root]) gatherMass(head, all);
  const Mass mass = mjcf::sum(all);
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

void Builder::addJoint(const Joint& joint) {
  if (joint.kind != JointKind::Spherical) return;
  const size_t child = static_cast<size_t>(joint.child), parent = static_cast<size_t>(joint.parent);
  const size_t above = bodyOf_[parent];
  BallJoint def;
  def.bodyB = ids_[child];
  if (!def.bodyB) return;
  if (moves(above)) def.bodyA = ids_[above];
  if (moves(above) && !def.bodyA) return;
  def.frameA.position = def.bodyA ? inBody(parent).position + rotate(inBody(parent).rotation, joint.pose.position)
                                  : poses_[child].position;
  try {
    model_.world.create(def);
    if (ids_[above]) model_.world.excludeCollision(ids_[above], ids_[child]);
  } catch (const Error& error) {
    throw FileError(joint.where + ": " + error.what(), in_.fileName, joint.line);
  }
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
  group();
  noteJoints();
  loadHulls();
  defs_.resize(in_.links.size());
  shapes_.resize(in_.links.size());
  colors_.resize(in_.links.size());
  ids_.resize(in_.links.size());
  for (size_t i = 0; i < in_.links.size(); ++i) addShapes(i);
  for (size_t i = 0; i < in_.links.size(); ++i) {
    if (bodyOf_[i] == i) addBody(i);
  }
  for (const Joint& joint : in_.joints) addJoint(joint);
  addGround();
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
