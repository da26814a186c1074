// From an MJCF description to a Model.
#include "io/mjcf_build.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>

#include "io/mjcf_mass.h"
#include "io/notes.h"

namespace avbd {

namespace mjcf {

namespace {

using Link = Clusters::Link;

struct Motion {
  Vec3d linear, angular;  // of the body frame's origin, world axes
};

class Builder {
 public:
  Builder(const Description& description, const MjcfOptions& options);
  Model build();

 private:
  void chooseStart(const MjcfOptions& options);
  void setVelocities(const std::vector<double>& qvel);
  void noteWelds();
  void gather();
  void stopWithoutMass();
  void addShapes(size_t body);
  void addBody(size_t root);
  std::string whereOf(size_t root, const Error& error) const;
  void addBallJoint(size_t body);
  void addEquality(const Equality& equality);
  void addWeld(const Equality& equality, BodyId a, BodyId b, const Posed& startA, const Posed& startB);
  void addExclude(const Exclude& exclude);

  Vec3 narrow(Vec3d v, const std::string& where) const;
  size_t rootOf(size_t body) const { return static_cast<size_t>(clusters_.rootOf[body]); }
  Link linkOf(size_t root) const { return clusters_.linkOf[root]; }
  bool isDynamic(size_t root) const { return linkOf(root) == Link::Free || linkOf(root) == Link::Ball; }
  /// Pose of a body in the frame of the body that it is part of.
  Posed inRoot(size_t body) const {
    return body == rootOf(body) ? Posed{} : inverse(start_[rootOf(body)]) * start_[body];
  }
  std::string nameOf(size_t body);

  const Description& in_;
  Clusters clusters_;
  std::vector<Posed> start_;                     // world poses at the start
  std::vector<Posed> rest_;                      // world poses as in the file
  std::vector<Mass> masses_;                     // of dynamic roots, in their frame
  std::vector<Motion> motion_;                   // at the start
  std::vector<BodyDef> defs_;                    // of roots
  std::vector<std::vector<const Geom*>> geoms_;  // of defs_' shapes
  std::vector<BodyId> ids_;                      // of roots
  std::set<std::string> names_;                  // used so far
  Notes notes_;
  GeomShapes shapes_{in_, notes_};
  std::map<std::pair<int, size_t>, PairGroup> pairGroups_;  // by body and geom
  Model model_;
};

Quat toQuat(Quatd q) {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
}
Pose toPose(const Posed& p) { return {p.position, toQuat(p.rotation)}; }

// What the world refuses is still a fault of the file.
template <class Make>
auto at(const std::string& where, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw FileError(where + ": " + error.what());
  }
}

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

void Builder::chooseStart(const MjcfOptions& options) {
  motion_.resize(in_.bodies.size());
  for (size_t i = 0; i < in_.keys.size(); ++i) model_.keyframes.push_back(keyName(in_, i));
  const int key = chosenKey(in_, options);
  start_ = key < 0 ? rest_ : worldPoses(in_, in_.keys[static_cast<size_t>(key)].qpos);
  if (key < 0) return;
  const Key& chosen = in_.keys[static_cast<size_t>(key)];
  if (chosen.qpos.empty() && chosen.qvel.empty()) return;
  notes_.add(chosen.where, "the bodies start at keyframe " + keyName(in_, static_cast<size_t>(key)));
  if (!chosen.qvel.empty()) setVelocities(chosen.qvel);
}

void Builder::setVelocities(const std::vector<double>& qvel) {
  for (size_t i = 1; i < in_.bodies.size(); ++i) {
    const Body& body = in_.bodies[i];
    const size_t parent = static_cast<size_t>(body.parent);
    Motion m = motion_[parent];
    m.linear = m.linear + cross(m.angular, start_[i].position - start_[parent].position);
    const double* v = qvel.data() + body.qvelAt;
    if (linkOf(i) == Link::Free) {
      m = {{v[0], v[1], v[2]}, rotate(start_[i].rotation, Vec3d{v[3], v[4], v[5]})};
    } else if (linkOf(i) == Link::Ball) {
      const Vec3d turn = rotate(start_[i].rotation, Vec3d{v[0], v[1], v[2]});
      const Vec3d arm = rotate(start_[i].rotation, body.joints[0].pos) * -1.0;
      m = {m.linear + cross(turn, arm), m.angular + turn};
    } else if (!body.joints.empty()) {
      notes_.add(body.where, "velocities of the keyframe are not used for welded joints");
    }
    motion_[i] = m;
  }
}

std::string Builder::nameOf(size_t body) {
  if (!in_.bodies[body].name.empty()) return in_.bodies[body].name;
  std::string name = "body_" + std::to_string(body);
  while (!names_.insert(name).second) name += "_";
  return name;
}

Vec3 Builder::narrow(Vec3d v, const std::string& where) const {
  return {mjcf::narrow(v.x, where), mjcf::narrow(v.y, where), mjcf::narrow(v.z, where)};
}

void Builder::noteWelds() {
  constexpr const char* kKinds[] = {"free", "ball", "slide", "hinge"};
  for (size_t i = 1; i < in_.bodies.size(); ++i) {
    const Body& body = in_.bodies[i];
    if (linkOf(i) != Link::Static) {
      if (body.mocap) notes_.add(body.where, "mocap body: kinematic, stays where it is");
      continue;
    }
    for (const Joint& joint : body.joints) {
      notes_.add(joint.where, std::string(kKinds[static_cast<size_t>(joint.kind)]) + " joint: welded");
    }
    if (rootOf(i) != i) {
      const std::string& root = in_.bodies[rootOf(i)].name;
      notes_.add(body.where, "part of body " + (root.empty() ? "body_" + std::to_string(rootOf(i)) : root));
    }
  }
}

void Builder::addShapes(size_t index) {
  const Body& body = in_.bodies[index];
  for (const Geom& geom : body.geoms) {
    const auto f = [&](double v) { return mjcf::narrow(v, geom.where); };
    const std::optional<GeomShape> made = shapes_.shape(geom);
    if (!made) continue;
    ShapeDef shape;
    shape.geometry = made->geometry;
    Posed pose = inRoot(index) * geom.pose;
    pose.rotation = normalized(pose.rotation * made->turn);
    shape.pose = toPose(pose);
    shape.material.friction = geom.condim == 1 ? 0 : f(geom.friction);
    if (geom.condim >= 4) shape.material.torsionalFriction = f(geom.torsional);
    if (geom.condim == 6) shape.material.rollingFriction = f(geom.rolling);
    shape.material.frictionCombine = Combine::Maximum;
    shape.material.frictionPriority = geom.priority;
    shape.filter.category = in_.contactsOff ? 0 : static_cast<uint32_t>(geom.contype);
    shape.filter.mask = in_.contactsOff ? 0 : static_cast<uint32_t>(geom.conaffinity);
    shape.filter.anyMask = true;
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
  for (size_t root = 1; root < in_.bodies.size(); ++root) {
    if (rootOf(root) != root || !isDynamic(root)) continue;
    bool known = true;
    std::vector<Mass> parts;
    for (size_t i = root; i < in_.bodies.size(); ++i) {
      if (rootOf(i) != root) continue;
      known = known && in_.bodies[i].massKnown && !in_.bodies[i].partsLeftOut;
      parts.push_back(moved(in_.bodies[i].mass, inRoot(i)));
    }
    masses_[root] = sum(parts);
    const auto p = principal(masses_[root].inertia).values;
    if (masses_[root].mass > 0 && *std::min_element(p.begin(), p.end()) > 0) continue;
    const std::string& where = in_.bodies[root].where;
    if (known) throw FileError(where + ": a body that moves needs mass and inertia > 0 (geoms with mass, or inertial)");
    clusters_.linkOf[root] = Link::Static;
    notes_.add(where, "has no mass without the parts that are left out: stands still");
  }
}

void Builder::gather() {
  defs_.resize(in_.bodies.size());
  geoms_.resize(in_.bodies.size());
  pairGroups_ = pairGroups(in_, notes_);
  for (size_t i = 0; i < in_.bodies.size(); ++i) addShapes(i);
  for (size_t i = 1; i < in_.bodies.size(); ++i) {
    if (rootOf(i) != i) {
      if (isDynamic(rootOf(i)) && in_.bodies[i].gravcomp != in_.bodies[rootOf(i)].gravcomp) {
        notes_.add(in_.bodies[i].where, "gravcomp: that of the body it is part of is used");
      }
      continue;
    }
    if (!isDynamic(i)) continue;
    const Mass& mass = masses_[i];
    const std::string& where = in_.bodies[i].where;
    const auto f = [&](double v) { return mjcf::narrow(v, where); };
    const Sym3d& m = mass.inertia;
    defs_[i].massProperties = MassProperties{
        f(mass.mass), narrow(mass.center, where), {f(m.xx), f(m.yy), f(m.zz), f(m.xy), f(m.xz), f(m.yz)}};
    const Vec3d arm = rotate(start_[i].rotation, mass.center);
    defs_[i].linearVelocity = narrow(motion_[i].linear + cross(motion_[i].angular, arm), where);
    defs_[i].angularVelocity = narrow(motion_[i].angular, where);
    defs_[i].gravityScale = f(1 - in_.bodies[i].gravcomp);
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

void Builder::addBallJoint(size_t index) {
  const Body& body = in_.bodies[index];
  const size_t parent = rootOf(static_cast<size_t>(body.parent));
  const Vec3d anchor = body.joints[0].pos;
  const Vec3d inWorld = start_[index].position + rotate(start_[index].rotation, anchor);
  BallJoint joint;
  joint.bodyA = isDynamic(parent) || linkOf(parent) == Link::Mocap ? ids_[parent] : BodyId{};
  joint.bodyB = ids_[index];
  joint.frameA.position = joint.bodyA ? (inverse(start_[parent]) * Posed{inWorld, {}}).position : inWorld;
  joint.frameB.position = anchor;
  // A child and a parent that stands still do collide in MJCF.
  joint.collideConnected = !in_.filterParent || !isDynamic(parent);
  at(body.joints[0].where, [&] { return model_.world.create(joint); });
}

void Builder::addEquality(const Equality& equality) {
  const size_t a = static_cast<size_t>(equality.bodyA), b = static_cast<size_t>(equality.bodyB);
  const size_t rootA = rootOf(a), rootB = rootOf(b);
  if (rootA == rootB || (!isDynamic(rootA) && !isDynamic(rootB))) {
    notes_.add(equality.where, "joins bodies that are one rigid body here: left out");
    return;
  }
  const BodyId idA = isDynamic(rootA) ? ids_[rootA] : BodyId{}, idB = isDynamic(rootB) ? ids_[rootB] : BodyId{};
  // Frames: of the joined body within the body of ours, or in the world.
  const Posed frameA = idA ? inRoot(a) : start_[a], frameB = idB ? inRoot(b) : start_[b];
  if (equality.weld) return addWeld(equality, idA, idB, frameA, frameB);
  const Posed anchorA{equality.anchor, {}};
  const Posed anchorB = inverse(rest_[b]) * rest_[a] * anchorA;
  BallJoint joint{.bodyA = idA, .bodyB = idB};
  joint.frameA.position = (frameA * anchorA).position;
  joint.frameB.position = (frameB * anchorB).position;
  joint.collideConnected = true;
  at(equality.where, [&] { return model_.world.create(joint); });
}

void Builder::addWeld(const Equality& equality, BodyId a, BodyId b, const Posed& frameA, const Posed& frameB) {
  const Posed relative = equality.hasRelative ? equality.relative
                                              : inverse(rest_[static_cast<size_t>(equality.bodyA)]) *
                                                    rest_[static_cast<size_t>(equality.bodyB)];
  const Posed anchorB{equality.anchor, {}};
  FixedJoint joint{.bodyA = a, .bodyB = b};
  joint.frameA = toPose(frameA * relative * anchorB);
  joint.frameB = toPose(frameB * anchorB);
  joint.collideConnected = true;
  at(equality.where, [&] { return model_.world.create(joint); });
}

void Builder::addExclude(const Exclude& exclude) {
  const size_t a = static_cast<size_t>(exclude.bodyA), b = static_cast<size_t>(exclude.bodyB);
  const BodyId idA = ids_[rootOf(a)], idB = ids_[rootOf(b)];
  if (!idA || !idB || idA == idB) return;  // never collide anyway
  if (rootOf(a) != a || rootOf(b) != b) {
    notes_.add(exclude.where, "applies to all bodies that are welded to these two");
  }
  at(exclude.where, [&] { return model_.world.excludeCollision(idA, idB); });
}

Model Builder::build() {
  masses_.resize(in_.bodies.size());
  stopWithoutMass();
  noteWelds();
  gather();
  ids_.resize(in_.bodies.size());
  for (size_t i = 0; i < in_.bodies.size(); ++i) {
    if (rootOf(i) == i) addBody(i);
  }
  for (size_t i = 1; i < in_.bodies.size(); ++i) {
    if (linkOf(i) == Link::Ball) addBallJoint(i);
  }
  for (const Equality& equality : in_.equalities) addEquality(equality);
  for (const Exclude& exclude : in_.excludes) addExclude(exclude);
  model_.notes = in_.notes;
  for (std::string& line : notes_.lines()) model_.notes.push_back(std::move(line));
  return std::move(model_);
}

}  // namespace

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
