// Flexes of an MJCF description as soft bodies, ropes and rigid shapes.
#include <algorithm>
#include <cmath>

#include "io/mjcf_builder.h"
#include "io/mjcf_mass.h"

namespace avbd::mjcf {

namespace {

constexpr double kMostShare = 0.1;      // of a body's mass, for the points that it holds
constexpr double kLeastShare = 1e-4;    // where that would not leave it a body
constexpr double kHeld = 1e-3;          // how far edges that are held stretch under the whole weight
constexpr double kTrace = 1e6;          // the same of what resists nothing: something must keep points apart
constexpr double kUsualGravity = 9.81;  // [m/s^2] where there is none
constexpr double kThin = 0.05;          // radius for 0, by the edges' length
constexpr double kLeastRadius = 1e-3;   // [m] the same where no edge is left

}  // namespace

double radiusOfPoint(const Flex& flex) { return flex.radius > 0 ? flex.radius : kLeastRadius; }

// A point has no moment of inertia, but a body must: that of a ball, not too small beside the rod it may end.
double Builder::momentOfPoint(const Flex& flex) const {
  double radius = radiusOfPoint(flex);
  if (flex.dim == 1 && !flex.elements.empty()) {
    radius = std::max(radius, kThin * restLength(flex, flex.elements[0][0], flex.elements[0][1]));
  }
  return 0.4 * radius * radius;
}

Vec3d Builder::placeOf(const FlexVertex& vertex, const std::vector<Posed>& poses) const {
  return (poses[static_cast<size_t>(vertex.body)] * Posed{vertex.at, {}}).position;
}

// Masses of all points. Those that a body holds take theirs from it, so that all together weighs what the file says.
void Builder::planFlexes() {
  pointMass_.resize(in_.flexes.size());
  std::set<size_t> holders;
  for (size_t f = 0; f < in_.flexes.size(); ++f) {
    const std::vector<FlexVertex>& vertices = in_.flexes[f].vertices;
    const size_t first = rootOf(static_cast<size_t>(vertices[0].body));
    const bool rigid = std::all_of(vertices.begin(), vertices.end(), [&](const FlexVertex& v) {
      return !isPoint(v, f) && rootOf(static_cast<size_t>(v.body)) == first;
    });
    if (rigid) continue;
    double sum = 0, count = 0;
    for (const FlexVertex& v : vertices)
      if (isPoint(v, f)) sum += masses_[static_cast<size_t>(v.body)].mass, count += 1;
    for (const FlexVertex& v : vertices) {
      const size_t root = rootOf(static_cast<size_t>(v.body));
      const bool own = isPoint(v, f), holds = !own && isDynamic(root) && in_.flexes[f].dim > 1;
      pointMass_[f].push_back(own ? masses_[root].mass : count > 0 ? sum / count : 1);
      if (holds) holders.insert(root);
    }
  }
  for (const size_t root : holders) takePoints(root);
}

void Builder::takePoints(size_t root) {
  std::vector<double*> points;
  std::vector<Vec3d> places;
  double wanted = 0;
  for (size_t f = 0; f < in_.flexes.size(); ++f)
    for (size_t i = 0; i < pointMass_[f].size(); ++i) {
      const FlexVertex& v = in_.flexes[f].vertices[i];
      const size_t body = static_cast<size_t>(v.body);
      if (isPoint(v, f) || rootOf(body) != root) continue;
      points.push_back(&pointMass_[f][i]);
      places.push_back((inRoot(body) * Posed{v.at, {}}).position);
      wanted += pointMass_[f][i];
    }
  Mass& whole = masses_[root];
  const double scale = std::min(1.0, kMostShare * whole.mass / wanted);
  Mass left{whole.mass, {}, whole.inertia};
  Vec3d moment = whole.center * whole.mass;
  for (size_t i = 0; i < points.size(); ++i) {
    *points[i] *= scale;
    left.mass -= *points[i];
    moment = moment - places[i] * *points[i];
  }
  left.center = moment * (1 / left.mass);
  left.inertia = left.inertia + pointInertia(whole.mass, whole.center - left.center);
  for (size_t i = 0; i < points.size(); ++i)
    left.inertia = left.inertia + pointInertia(-*points[i], places[i] - left.center);
  std::array<double, 3> v = principal(left.inertia).values;
  std::sort(v.begin(), v.end());
  const std::array<double, 3> before = principal(whole.inertia).values;
  if (v[0] > 0.1 * *std::min_element(before.begin(), before.end()) && v[0] + v[1] >= v[2]) {
    whole = left;
    return;
  }
  for (double* point : points) *point = kLeastShare * whole.mass / static_cast<double>(points.size());
}

// What one body holds wholly is part of it.
void Builder::addRigidFlexes() {
  for (size_t f = 0; f < in_.flexes.size(); ++f) {
    const Flex& flex = in_.flexes[f];
    if (!pointMass_[f].empty()) continue;
    const size_t root = rootOf(static_cast<size_t>(flex.vertices[0].body));
    const auto add = [&](Geometry geometry, const Posed& pose) {
      ShapeDef shape = shapeLike(flex.surface);
      shape.geometry = std::move(geometry);
      shape.pose = toPose(pose);
      shape.density = 0;
      defs_[root].shapes.push_back(shape);
      geoms_[root].push_back(&flex.surface);
    };
    std::vector<Vec3d> at;
    for (const FlexVertex& v : flex.vertices)
      at.push_back((inRoot(static_cast<size_t>(v.body)) * Posed{v.at, {}}).position);
    if (flex.dim == 1) {
      for (const FlexElement& e : flex.elements) {
        const Vec3d a = at[e[0]], b = at[e[1]];
        if (!(length(b - a) > 0) || !(flex.radius > 0)) continue;
        const Quatd zToY{std::sqrt(0.5), std::sqrt(0.5), 0, 0};
        add(Capsule{mjcf::narrow(flex.radius, flex.where), mjcf::narrow(length(b - a) / 2, flex.where)},
            {(a + b) * 0.5, normalized(turnFromZ(b - a) * zToY)});
      }
      continue;
    }
    std::vector<Vec3> points;
    for (const Vec3d p : at) points.push_back(narrow(p, flex.where));
    mjcf::at(flex.where, [&] {
      if (isDynamic(root)) {
        notes_.add(flex.where, "a flex that is part of a body that moves collides as its convex hull", "flex");
        add(Hull{makeHull({.points = points})}, {});
        return;
      }
      std::vector<std::array<uint32_t, 3>> triangles;
      for (const FlexElement& e : flex.elements) {
        triangles.push_back({e[0], e[1], e[2]});
        if (flex.dim < 3) continue;
        triangles.push_back({e[0], e[1], e[3]}), triangles.push_back({e[0], e[2], e[3]});
        triangles.push_back({e[1], e[2], e[3]});
      }
      add(Mesh{makeMesh({.vertices = points, .triangles = triangles, .doubleSided = true})}, {});
    });
  }
}

void Builder::addFlexes() {
  for (size_t f = 0; f < in_.flexes.size(); ++f) {
    if (pointMass_[f].empty()) continue;
    if (in_.flexes[f].dim == 1) {
      addRope(f);
    } else {
      addSoft(f);
    }
  }
}

ShapeDef Builder::pointShape(size_t index, double radius) const {
  const Flex& flex = in_.flexes[index];
  ShapeDef shape = shapeLike(flex.surface);
  shape.geometry = Sphere{mjcf::narrow(radius, flex.where)};
  shape.density = 0;
  if (!flex.touchesItself) shape.filter.group = -1 - static_cast<int>(index);
  return shape;
}

// MuJoCo's forces of Saint Venant and Kirchhoff are ours for small strains.
SoftMaterial Builder::materialOf(const Flex& flex, const SoftMeshData& mesh, double mass) {
  const auto f = [&](double v) { return mjcf::narrow(v, flex.where); };
  const bool cloth = mesh.isCloth();
  const double size = cloth ? mesh.area() : mesh.volume();
  const double thickness = !cloth ? 1 : flex.thickness > 0 ? flex.thickness : flex.radius > 0 ? 2 * flex.radius : 1e-3;
  const double gravity = length(in_.gravity) > 0 ? length(in_.gravity) : kUsualGravity;
  // Of the stress that its weight makes in a cut through its middle.
  const double stress = mass * gravity / (cloth ? std::sqrt(size) * thickness : std::cbrt(size) * std::cbrt(size));
  double young = cloth && !flex.stretches ? 0 : flex.young;
  if (flex.holdsEdges) {
    young = std::max(young, stress / kHeld);
    notes_.add(flex.where, "edges that keep their lengths: it is so stiff that it stretches about 0.1 % by its weight",
               "flex");
  } else if (!(young > 0)) {
    young = stress / kTrace;
    notes_.add(flex.where, "has no elasticity against stretching: hardly anything holds its points together", "flex");
  }
  SoftMaterial out{.youngsModulus = f(young),
                   .poissonRatio = f(std::min(flex.poisson, 0.499)),
                   .density = f(mass / (size * thickness))};
  // MuJoCo's damping goes with the file's modulus: what only holds the edges damps no more than that.
  out.damping = f(flex.holdsEdges ? flex.damping * std::min(1.0, flex.young / young) : flex.damping);
  if (!cloth) return out;
  out.thickness = f(thickness);
  const double nu = std::min(flex.poisson, 0.499);
  out.bending = flex.bending >= 0 ? f(flex.bending)
                : flex.bends      ? f(flex.young * thickness * thickness * thickness / (12 * (1 - nu * nu)))
                                  : 0;
  return out;
}

void Builder::addSoft(size_t index) {
  const Flex& flex = in_.flexes[index];
  const Vec3d origin = placeOf(flex.vertices[0], rest_);
  std::vector<Vec3> points;
  for (const FlexVertex& v : flex.vertices) points.push_back(narrow(placeOf(v, rest_) - origin, flex.where));
  SoftDef def;
  def.mesh = at(flex.where, [&] {
    if (flex.dim == 3) return makeTetMesh({.points = points, .tets = flex.elements});
    std::vector<std::array<uint32_t, 3>> triangles;
    for (const FlexElement& e : flex.elements) triangles.push_back({e[0], e[1], e[2]});
    return makeClothMesh({.points = points, .triangles = triangles});
  });
  const SoftMeshReport& report = def.mesh->report();
  if (report.degenerate + report.duplicate > 0) {
    notes_.add(flex.where, "elements without size or given twice are left out: " +
                               std::to_string(report.degenerate + report.duplicate));
  }
  std::vector<bool> made(flex.vertices.size());
  double mass = 0;
  for (uint32_t k = 0; k < def.mesh->points().size(); ++k) mass += pointMass_[index][def.mesh->sourcePoint(k)];
  double radius = flex.radius;
  if (!(radius > 0)) {
    radius = kThin * static_cast<double>(def.mesh->faceSize());
    notes_.add(flex.where, "radius is 0: its points touch as balls of a twentieth of its edges", "flex");
  }
  const ShapeDef shape = pointShape(index, radius);
  def.pose.position = origin;
  def.material = materialOf(flex, *def.mesh, mass);
  def.radius = mjcf::narrow(radius, flex.where);
  def.surface = shape.material;
  def.filter = shape.filter;
  def.selfContact = flex.touchesItself;
  const SoftId soft = at(flex.where, [&] { return model_.world.create(def); });
  model_.softs.push_back({soft, flex.name});
  const std::vector<BodyId> particles = model_.world.particles(soft);
  for (uint32_t k = 0; k < particles.size(); ++k) {
    const size_t vertex = def.mesh->sourcePoint(k);
    made[vertex] = true;
    placePoint(index, vertex, particles[k]);
  }
  // Points whose elements were all left out.
  for (size_t v = 0; v < made.size(); ++v)
    if (!made[v] && isPoint(flex.vertices[v], index)) addPoint(index, v);
}

// A point that no soft body has.
void Builder::addPoint(size_t index, size_t vertex) {
  addPoint(index, vertex, pointShape(index, radiusOfPoint(in_.flexes[index])));
}

void Builder::addPoint(size_t index, size_t vertex, const ShapeDef& shape) {
  BodyDef def;
  def.position = placeOf(in_.flexes[index].vertices[vertex], start_);
  def.shapes = {shape};
  def.massProperties = MassProperties{1, {}, {1, 1, 1, 0, 0, 0}};
  // What nothing joins would roll, as no point of MuJoCo's does.
  if (in_.flexes[index].elements.empty()) def.locks = kLockAngular;
  placePoint(index, vertex, at(in_.flexes[index].where, [&] { return model_.world.create(def); }));
}

// Mass, place and what holds it.
void Builder::placePoint(size_t index, size_t vertex, BodyId point) {
  const Flex& flex = in_.flexes[index];
  const FlexVertex& v = flex.vertices[vertex];
  const size_t body = static_cast<size_t>(v.body), root = rootOf(body);
  World& world = model_.world;
  std::vector<std::optional<Color>> colors;
  for (size_t i = 0; i < world.shapes(point).size(); ++i) colors.push_back(flex.surface.color);
  const float mass = mjcf::narrow(pointMass_[index][vertex], flex.where);
  const float moment = mass * mjcf::narrow(momentOfPoint(flex), flex.where);
  at(flex.where, [&] { world.setMassProperties(point, {mass, {}, {moment, moment, moment, 0, 0, 0}}); });
  if (isPoint(v, index)) {
    ids_[body] = point;
    geoms_[body].assign(colors.size(), &flex.surface);
    setMoving(index, vertex, point);
    model_.bodies.push_back({point, nameOf(body), std::move(colors)});
    return;
  }
  at(flex.where, [&] { world.setPose(point, {placeOf(v, start_), {}}); });
  std::string name = once((flex.name.empty() ? "flex" : flex.name) + "_" + std::to_string(vertex));
  model_.bodies.push_back({point, std::move(name), std::move(colors)});
  if (!movingId(root)) return world.setLocks(point, kLockLinearX | kLockLinearY | kLockLinearZ);
  BallJoint joint{.bodyA = point, .bodyB = movingId(root)};
  joint.frameB.position = (inRoot(body) * Posed{v.at, {}}).position;
  at(flex.where, [&] { return world.create(joint); });
}

void Builder::setMoving(size_t index, size_t vertex, BodyId point) {
  const Flex& flex = in_.flexes[index];
  const size_t index0 = static_cast<size_t>(flex.vertices[vertex].body);
  const Body& body = in_.bodies[index0];
  World& world = model_.world;
  at(body.where, [&] {
    world.setPose(point, toPose(start_[index0]));
    if (key_ && !key_->qvel.empty()) world.setVelocity(point, {narrow(motion_[index0].linear, body.where), {}});
    if (body.gravcomp != 0) world.setGravityScale(point, mjcf::narrow(1 - body.gravcomp, body.where));
    const double damping = body.joints[0].kind == JointKind::Slide ? body.joints[0].damping : 0;
    if (damping > 0) world.setDamping(point, mjcf::narrow(damping / pointMass_[index][vertex], body.where), 0);
  });
}

}  // namespace avbd::mjcf
