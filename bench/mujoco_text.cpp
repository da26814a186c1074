// Writing MJCF.
#include "bench/mujoco_text.h"

#include <avbd/hull.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <unordered_map>

namespace avbd::bench {
namespace {

using scenes::Layout;

[[noreturn]] void refuse(const char* field, const char* range) { throw Error("benchMujoco", field, "another", range); }

std::string text(const char* format, ...) {
  char buffer[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

std::string placed(const Pose& p) {
  const Quat q = p.rotation;
  return text("pos=\"%.9g %.9g %.9g\" quat=\"%.9g %.9g %.9g %.9g\"", p.position.x, p.position.y, p.position.z, q.w, q.x,
              q.y, q.z);
}

/// Two anchors that are held together, as the layout's bodies; a body of the world is -1.
struct Tie {
  int a = -1, b = -1;
  Pose inA, inB;
  bool fixed = false;
};

class Writer {
 public:
  Writer(const World& world, const Layout& layout) : world_(world), layout_(layout) {}
  MujocoText write();

 private:
  void findTies();
  template <class Joint>
  void addTie(const Joint& joint, bool fixed);
  void findTrees();
  void writeBody(size_t body, const Pose& parent);
  void writeGeom(ShapeId shape);
  void writeInertia(BodyId id);
  std::string size(const Geometry& geometry, Pose& pose);
  void writeEquality(const Tie& tie);
  size_t makeRoom(size_t moving, size_t equalities);

  const World& world_;
  const Layout& layout_;
  MujocoText out_;
  std::unordered_map<uint32_t, int> slots_;
  std::vector<Tie> ties_;
  std::vector<int> up_;                     ///< by body: the tie that leads to its parent, or -1
  std::vector<std::vector<size_t>> below_;  ///< by body: its children
  std::vector<char> used_;                  ///< by tie: part of a tree
  std::string bodies_, assets_, rules_;
  size_t meshes_ = 0;
};

template <class Joint>
void Writer::addTie(const Joint& joint, bool fixed) {
  const auto slot = [&](BodyId id) { return id ? slots_.at(id.index) : -1; };
  ties_.push_back({slot(joint.bodyA), slot(joint.bodyB), joint.frameA, joint.frameB, fixed});
}

void Writer::findTies() {
  for (size_t i = 0; i < layout_.bodies.size(); ++i) slots_[layout_.bodies[i].index] = static_cast<int>(i);
  for (const JointId id : world_.joints()) {
    if (world_.type(id) == JointType::Ball)
      addTie(world_.ballJoint(id), false);
    else if (world_.type(id) == JointType::Fixed)
      addTie(world_.fixedJoint(id), true);
    else
      refuse("joint", "must be a ball or fixed joint");
  }
}

// Breadth first from what does not move, then from what floats.
void Writer::findTrees() {
  const size_t count = layout_.bodies.size();
  up_.assign(count, -1);
  below_.resize(count);
  used_.assign(ties_.size(), 0);
  std::vector<std::vector<size_t>> tiesOf(count);
  for (size_t t = 0; t < ties_.size(); ++t)
    for (const int body : {ties_[t].a, ties_[t].b})
      if (body >= 0) tiesOf[static_cast<size_t>(body)].push_back(t);
  std::vector<char> reached(count, 0);
  std::vector<size_t> queue;
  const auto reach = [&](size_t tie, int from, int to) {
    if (to < 0 || reached[static_cast<size_t>(to)] || !layout_.dynamic[static_cast<size_t>(to)]) return;
    reached[static_cast<size_t>(to)] = used_[tie] = 1;
    up_[static_cast<size_t>(to)] = static_cast<int>(tie);
    if (from >= 0) below_[static_cast<size_t>(from)].push_back(static_cast<size_t>(to));
    queue.push_back(static_cast<size_t>(to));
  };
  const auto spread = [&] {
    for (size_t n = 0; n < queue.size(); ++n) {
      const int body = static_cast<int>(queue[n]);
      for (const size_t t : tiesOf[queue[n]]) reach(t, body, ties_[t].a == body ? ties_[t].b : ties_[t].a);
    }
    queue.clear();
  };
  for (size_t t = 0; t < ties_.size(); ++t)
    if (ties_[t].a < 0 || ties_[t].b < 0) reach(t, -1, ties_[t].a < 0 ? ties_[t].b : ties_[t].a);
  for (size_t i = 0; i < count; ++i)
    if (!layout_.dynamic[i]) reached[i] = 1, queue.push_back(i);
  spread();
  out_.floating.assign(count, 0);
  for (size_t i = 0; i < count; ++i) {
    if (reached[i]) continue;
    reached[i] = out_.floating[i] = 1;
    queue.push_back(i);
    spread();
  }
}

// `pose` turns from ours (along y) to MuJoCo's (along z) where the two differ.
std::string Writer::size(const Geometry& geometry, Pose& pose) {
  constexpr float kHalf = 0.70710678f;
  const Quat toY{kHalf, -kHalf, 0, 0};  // z to y
  if (const auto* s = std::get_if<Sphere>(&geometry)) return text("type=\"sphere\" size=\"%.9g\"", s->radius);
  if (const auto* b = std::get_if<Box>(&geometry); b && b->rounding == 0)
    return text("type=\"box\" size=\"%.9g %.9g %.9g\"", b->x, b->y, b->z);
  if (const auto* e = std::get_if<Ellipsoid>(&geometry))
    return text("type=\"ellipsoid\" size=\"%.9g %.9g %.9g\"", e->x, e->y, e->z);
  if (const auto* h = std::get_if<Hull>(&geometry); h && h->rounding == 0) {
    const std::string name = "m" + std::to_string(meshes_++);
    assets_ += "<mesh name=\"" + name + "\" vertex=\"";
    for (const Vec3 v : h->data->vertices())
      assets_ += text("%.9g %.9g %.9g ", v.x * h->scale.x, v.y * h->scale.y, v.z * h->scale.z);
    assets_ += "\"/>\n";
    return "type=\"mesh\" mesh=\"" + name + "\"";
  }
  pose.rotation = pose.rotation * toY;
  if (const auto* c = std::get_if<Capsule>(&geometry))
    return text("type=\"capsule\" size=\"%.9g %.9g\"", c->radius, c->halfHeight);
  if (const auto* c = std::get_if<Cylinder>(&geometry); c && c->rounding == 0)
    return text("type=\"cylinder\" size=\"%.9g %.9g\"", c->radius, c->halfHeight);
  if (std::holds_alternative<HalfSpace>(geometry)) return "type=\"plane\" size=\"0 0 1\"";
  refuse("shape", "must be one of those that MuJoCo has without a file");
}

void Writer::writeGeom(ShapeId shape) {
  Pose pose = world_.localPose(shape);
  const std::string kind = size(world_.geometry(shape), pose);
  const Filter filter = world_.filter(shape);
  if (filter.group != 0) refuse("filter", "must have no group");
  // MuJoCo lets one direction suffice. A filter that meets nothing must not be met either.
  const bool ghost = filter.mask == 0 && !filter.anyMask;
  bodies_ += "<geom " + kind + " " + placed(pose) +
             text(" friction=\"%.9g 0 0\" contype=\"%d\" conaffinity=\"%d\"/>\n", world_.material(shape).friction,
                  ghost ? 0 : static_cast<int>(filter.category), static_cast<int>(filter.mask));
}

void Writer::writeInertia(BodyId id) {
  const Vec3 c = world_.centerOfMass(id);
  const SymMat3 i = world_.inertia(id);
  bodies_ += text("<inertial pos=\"%.9g %.9g %.9g\" mass=\"%.9g\" fullinertia=\"%.9g %.9g %.9g %.9g %.9g %.9g\"/>\n",
                  c.x, c.y, c.z, world_.mass(id), i.xx, i.yy, i.zz, i.xy, i.xz, i.yz);
}

void Writer::writeBody(size_t body, const Pose& parent) {
  const BodyId id = layout_.bodies[body];
  const Pose pose = world_.pose(id);
  bodies_ += text("<body name=\"b%zu\" ", body) + placed(inverse(parent) * pose) + ">\n";
  if (layout_.dynamic[body]) {
    if (out_.floating[body]) {
      bodies_ += "<freejoint/>\n";
      out_.freedoms += 6;
    } else if (const Tie& tie = ties_[static_cast<size_t>(up_[body])]; !tie.fixed) {
      const Vec3d at = tie.b == static_cast<int>(body) ? tie.inB.position : tie.inA.position;
      bodies_ += text("<joint type=\"ball\" pos=\"%.9g %.9g %.9g\"/>\n", at.x, at.y, at.z);
      out_.freedoms += 3;
    }
    writeInertia(id);
  }
  for (const ShapeId shape : world_.shapes(id)) writeGeom(shape);
  for (const size_t child : below_[body]) writeBody(child, pose);
  bodies_ += "</body>\n";
}

// Anchors are where the two meet at the start.
void Writer::writeEquality(const Tie& tie) {
  const int first = tie.a >= 0 ? tie.a : tie.b, second = tie.a >= 0 ? tie.b : tie.a;
  const Vec3d at = tie.a >= 0 ? tie.inA.position : tie.inB.position;
  const std::string other = second >= 0 ? text(" body2=\"b%d\"", second) : "";
  if (tie.fixed)
    rules_ += text("<weld body1=\"b%d\"", first) + other + "/>\n";
  else
    rules_ += text("<connect body1=\"b%d\" anchor=\"%.9g %.9g %.9g\"", first, at.x, at.y, at.z) + other + "/>\n";
}

// MuJoCo keeps dense matrices of all rows that there may be by each other and by the freedoms, in less than 2^31 bytes.
size_t Writer::makeRoom(size_t moving, size_t equalities) {
  constexpr size_t kContactsPerBody = 12, kRowsPerContact = 4, kRowsPerEquality = 6;
  constexpr double kBytes = 1.9e9, kByRow = 12, kByFreedom = 40;
  const double f = kByFreedom * static_cast<double>(out_.freedoms);
  const auto most = static_cast<size_t>((std::sqrt(f * f + 4 * kByRow * kBytes) - f) / (2 * kByRow));
  const size_t held = kRowsPerEquality * equalities;
  if (most < held + kRowsPerContact * moving) refuse("scene", "must fit MuJoCo's dense matrices");
  out_.contacts = std::min(kContactsPerBody * moving + 50, (most - held) / kRowsPerContact);
  return held + kRowsPerContact * out_.contacts;
}

MujocoText Writer::write() {
  if (!world_.softBodies().empty())
    throw Error("benchMujoco", "scene", "soft bodies", "must have none: MuJoCo has flexes from 3.0 on");
  findTies();
  findTrees();
  size_t moving = 0, equalities = 0;
  for (size_t i = 0; i < layout_.bodies.size(); ++i) {
    moving += layout_.dynamic[i] ? 1 : 0;
    const bool root = up_[i] < 0;
    const Tie* tie = root ? nullptr : &ties_[static_cast<size_t>(up_[i])];
    if (root || tie->a < 0 || tie->b < 0) writeBody(i, {});
  }
  for (size_t t = 0; t < ties_.size(); ++t)
    if (!used_[t]) writeEquality(ties_[t]), ++equalities;
  std::string excluded;
  for (const auto& [a, b] : world_.excludedPairs())
    excluded += text("<exclude body1=\"b%d\" body2=\"b%d\"/>\n", slots_.at(a.index), slots_.at(b.index));
  const size_t rows = makeRoom(moving, equalities);
  const Vec3 g = world_.definition().gravity;
  out_.xml = "<mujoco><compiler angle=\"radian\" inertiafromgeom=\"false\" balanceinertia=\"true\"/>\n";
  out_.xml += text("<size njmax=\"%zu\" nconmax=\"%zu\" nstack=\"%zu\"/>\n", rows, out_.contacts,
                   100 * rows + 2 * rows * out_.freedoms + 4 * out_.freedoms * out_.freedoms + 100000);
  out_.xml += text("<option timestep=\"%.9g\" gravity=\"%.9g %.9g %.9g\"%s/>\n", 1.0 / 60, g.x, g.y, g.z,
                   out_.freedoms > 300 ? " solver=\"CG\" jacobian=\"sparse\"" : "");
  out_.xml += "<asset>\n" + assets_ + "</asset>\n<worldbody>\n" + bodies_ + "</worldbody>\n<equality>\n" + rules_ +
              "</equality>\n<contact>\n" + excluded + "</contact></mujoco>\n";
  return std::move(out_);
}

}  // namespace

MujocoText mujocoText(const World& world, const Layout& layout) { return Writer(world, layout).write(); }

}  // namespace avbd::bench
