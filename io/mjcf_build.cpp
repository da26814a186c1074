// From an MJCF description to a Model.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "io/mjcf_builder.h"
#include "io/mjcf_mass.h"

namespace avbd {

namespace mjcf {

Builder::Builder(const Description& description, const MjcfOptions& options)
    : in_(description), clusters_(clustersOf(description)), rest_(worldPoses(description, {})) {
  WorldDef world = options.world;
  world.gravity = avbd::toFloat(in_.gravity);
  model_.world = World(world);
  model_.name = in_.name.empty() ? std::filesystem::path(in_.fileName).stem().string() : in_.name;
  model_.dt = in_.dt;
  const double g = length(in_.gravity);
  model_.up = g > 0 ? avbd::toFloat(in_.gravity * (-1 / g) + Vec3d{}) : Vec3{0, 0, 1};
  for (const Body& body : in_.bodies) names_.insert(body.name);
  chooseStart(options);
}

std::string Builder::nameOf(size_t body) {
  if (!in_.bodies[body].name.empty()) return in_.bodies[body].name;
  std::string name = "body_" + std::to_string(body);
  return once(std::move(name));
}

std::string Builder::once(std::string name) {
  while (!names_.insert(name).second) name += "_";
  return name;
}

Vec3 Builder::narrow(Vec3d v, const std::string& where) const {
  return {mjcf::narrow(v.x, where), mjcf::narrow(v.y, where), mjcf::narrow(v.z, where)};
}

void Builder::noteWelds() {
  for (size_t i = 1; i < in_.bodies.size(); ++i) {
    const Body& body = in_.bodies[i];
    if (linkOf(i) != Link::Static) {
      if (body.mocap) notes_.add(body.where, "mocap body: kinematic, stays where it is");
      continue;
    }
    for (const Joint& joint : body.joints) notes_.add(joint.where, "left out: its body stands still");
    if (rootOf(i) != i) {
      const std::string& root = in_.bodies[rootOf(i)].name;
      notes_.add(body.where, "part of body " + (root.empty() ? "body_" + std::to_string(rootOf(i)) : root));
    }
  }
}

// Surface and filter of a geom.
ShapeDef Builder::shapeLike(const Geom& geom) const {
  const auto f = [&](double v) { return mjcf::narrow(v, geom.where); };
  ShapeDef shape;
  shape.material.friction = geom.condim == 1 ? 0 : f(geom.friction);
  if (geom.condim >= 4) shape.material.torsionalFriction = f(geom.torsional);
  if (geom.condim == 6) shape.material.rollingFriction = f(geom.rolling);
  shape.material.frictionCombine = Combine::Maximum;
  shape.material.frictionPriority = geom.priority;
  shape.filter.category = in_.contactsOff ? 0 : static_cast<uint32_t>(geom.contype);
  shape.filter.mask = in_.contactsOff ? 0 : static_cast<uint32_t>(geom.conaffinity);
  shape.filter.anyMask = true;
  return shape;
}

void Builder::addShapes(size_t index) {
  const Body& body = in_.bodies[index];
  for (const Geom& geom : body.geoms) {
    const auto f = [&](double v) { return mjcf::narrow(v, geom.where); };
    const std::optional<GeomShape> made = shapes_.shape(geom);
    if (!made) continue;
    ShapeDef shape = shapeLike(geom);
    shape.geometry = made->geometry;
    Posed pose = inRoot(index) * geom.pose;
    pose.rotation = normalized(pose.rotation * made->turn);
    shape.pose = toPose(pose);
    if (const auto it = pairGroups_.find({static_cast<int>(index), static_cast<size_t>(&geom - body.geoms.data())});
        it != pairGroups_.end()) {
      shape.filter.group = it->second.group;
      if (it->second.friction >= 0) {
        shape.material.friction = f(it->second.friction);
        shape.material.torsionalFriction = f(it->second.torsional);
        shape.material.rollingFriction = f(it->second.rolling);
      }
    }
    defs_[rootOf(index)].shapes.push_back(shape);
    geoms_[rootOf(index)].push_back(&geom);
  }
}

// A body that moves and has no mass but that of parts which were left out stands still instead.
void Builder::stopWithoutMass() {
  std::vector<std::vector<Mass>> parts(in_.bodies.size());
  std::vector<bool> known(in_.bodies.size(), true);
  for (size_t i = 1; i < in_.bodies.size(); ++i) {
    const size_t root = rootOf(i);
    known[root] = known[root] && in_.bodies[i].massKnown && !in_.bodies[i].partsLeftOut;
    parts[root].push_back(moved(in_.bodies[i].mass, inRoot(i)));
  }
  for (size_t root = 1; root < in_.bodies.size(); ++root) {
    if (rootOf(root) != root || !isDynamic(root)) continue;
    masses_[root] = sum(parts[root]);
    const auto p = principal(masses_[root].inertia).values;
    if (masses_[root].mass > 0 && *std::min_element(p.begin(), p.end()) > 0) continue;
    const std::string& where = in_.bodies[root].where;
    if (known[root])
      throw FileError(where + ": a body that moves needs mass and inertia > 0 (geoms with mass, or inertial)");
    clusters_.linkOf[root] = Link::Static;
    notes_.add(where, "has no mass without the parts that are left out: stands still");
  }
}

void Builder::gather() {
  defs_.resize(in_.bodies.size());
  geoms_.resize(in_.bodies.size());
  stages_.resize(in_.bodies.size());
  betweenMass_.resize(in_.bodies.size());
  between_.resize(in_.bodies.size());
  pairGroups_ = pairGroups(in_, notes_);
  for (size_t i = 0; i < in_.bodies.size(); ++i) addShapes(i);
  addRigidFlexes();
  for (size_t i = 1; i < in_.bodies.size(); ++i) {
    if (rootOf(i) != i) {
      if (isDynamic(rootOf(i)) && in_.bodies[i].gravcomp != in_.bodies[rootOf(i)].gravcomp) {
        notes_.add(in_.bodies[i].where, "gravcomp: that of the body it is part of is used");
      }
      continue;
    }
    if (!isDynamic(i)) continue;
    if (linkOf(i) == Link::Jointed) splitMasses(i);
    setMoving(defs_[i], i, masses_[i], {start_[i], motion_[i]});
  }
}

// Mass, velocity and pose of a body whose frame is at `placed`.
void Builder::setMoving(BodyDef& def, size_t root, const Mass& mass, const Placed& placed) const {
  const std::string& where = in_.bodies[root].where;
  const auto f = [&](double v) { return mjcf::narrow(v, where); };
  const Sym3d& m = mass.inertia;
  def.massProperties =
      MassProperties{f(mass.mass), narrow(mass.center, where), {f(m.xx), f(m.yy), f(m.zz), f(m.xy), f(m.xz), f(m.yz)}};
  const Vec3d arm = rotate(placed.pose.rotation, mass.center);
  def.linearVelocity = narrow(placed.motion.linear + cross(placed.motion.angular, arm), where);
  def.angularVelocity = narrow(placed.motion.angular, where);
  def.gravityScale = f(1 - in_.bodies[root].gravcomp);
}

// Bodies between the stages of a body's joints take their mass from it.
void Builder::splitMasses(size_t root) {
  stages_[root] = stagesOf(in_.bodies[root]);
  for (size_t k = 1; k < stages_[root].size(); ++k) {
    betweenMass_[root].push_back(splitOff(masses_[root], stages_[root][k].frame.position));
  }
}

// The geom that an error of the world is about, else the body.
std::string Builder::whereOf(size_t root, const Error& error) const {
  constexpr std::string_view kShapes = "shapes[";
  const std::string& field = error.field();
  if (field.starts_with(kShapes)) {
    const size_t index = static_cast<size_t>(std::strtoul(field.c_str() + kShapes.size(), nullptr, 10));
    if (index < geoms_[root].size()) return geoms_[root][index]->where;
  }
  return in_.bodies[root].where;
}

void Builder::addBody(size_t root) {
  BodyDef& def = defs_[root];
  if (root == 0 && def.shapes.empty()) return;
  addBetween(root);
  def.type = isDynamic(root) ? BodyType::Dynamic : linkOf(root) == Link::Mocap ? BodyType::Kinematic : BodyType::Static;
  const Pose pose = toPose(start_[root]);
  def.position = pose.position;
  def.rotation = pose.rotation;
  try {
    ids_[root] = model_.world.create(def);
  } catch (const Error& error) {
    throw FileError(whereOf(root, error) + ": " + error.what());
  }
  std::vector<std::optional<Color>> colors;
  for (const Geom* geom : geoms_[root]) colors.push_back(geom->color);
  model_.bodies.push_back({ids_[root], nameOf(root), std::move(colors)});
}

// Named after the body and the last joint of the stage that it ends.
void Builder::addBetween(size_t root) {
  const std::vector<Stage>& stages = stages_[root];
  if (stages.size() < 2) return;
  const std::vector<Posed> poses = posesAlong(root);
  const std::vector<Motion> motions = motionsAlong(root);
  for (size_t k = 0; k + 1 < stages.size(); ++k) {
    const size_t after = stages[k + 1].first;
    BodyDef def;
    setMoving(def, root, betweenMass_[root][k], {poses[after], motions[after]});
    const Pose pose = toPose(poses[after]);
    def.position = pose.position;
    def.rotation = pose.rotation;
    const JointRef last{static_cast<int>(root), after - 1};
    between_[root].push_back(at(in_.bodies[root].where, [&] { return model_.world.create(def); }));
    const std::string name = in_.bodies[root].name.empty() ? "body_" + std::to_string(root) : in_.bodies[root].name;
    model_.bodies.push_back({between_[root].back(), once(name + "/" + nameOf(last))});
  }
}

Model Builder::build() {
  masses_.resize(in_.bodies.size());
  stopWithoutMass();
  planFlexes();
  noteWelds();
  gather();
  ids_.resize(in_.bodies.size());
  for (size_t i = 0; i < in_.bodies.size(); ++i) {
    if (rootOf(i) == i && !isParticle(i)) addBody(i);
  }
  addFlexes();
  coordinates_.resize(in_.bodies.size());
  for (size_t i = 1; i < in_.bodies.size(); ++i) {
    if (linkOf(i) == Link::Jointed) addJoints(i);
  }
  nameJoints();
  addActuators();
  for (const Equality& equality : in_.equalities) addEquality(equality);
  for (const Exclude& exclude : in_.excludes) addExclude(exclude);
  addProbes();
  model_.notes = in_.notes;
  for (std::string& line : notes_.lines()) model_.notes.push_back(std::move(line));
  return std::move(model_);
}

Model buildModel(const Description& description, const MjcfOptions& options) {
  return Builder(description, options).build();
}

}  // namespace mjcf

Model readMjcf(const std::filesystem::path& file, const MjcfOptions& options) {
  return mjcf::buildModel(mjcf::parseFile(file), options);
}

Model readMjcfText(std::string_view xml, std::string_view nameForMessages, const MjcfOptions& options) {
  return mjcf::buildModel(mjcf::parseText(xml, nameForMessages), options);
}

}  // namespace avbd
