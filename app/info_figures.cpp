// Counting what is in a model or a mesh file.
#include "app/info_figures.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/number_text.h"

namespace avbd::cli {
namespace {

constexpr const char* kShapeNames[] = {"sphere", "capsule",   "box",  "half_space", "cylinder",
                                       "cone",   "ellipsoid", "hull", "mesh",       "height_field"};
static_assert(std::size(kShapeNames) == kShapeKinds);
constexpr const char* kJointNames[] = {"ball", "fixed",    "tet_volume", "hinge",    "slider",
                                       "d6",   "distance", "pulley",     "coupling", "custom"};
static_assert(std::size(kJointNames) == kJointKinds);

// How far a shape reaches along a direction of its own frame: the largest d . p.
struct Reach {
  Vec3d d;
  double rounded(double r) const { return r * length(d); }
  double across() const { return std::sqrt(d.x * d.x + d.z * d.z); }

  double operator()(const Sphere& s) const { return rounded(s.radius); }
  double operator()(const Capsule& s) const { return std::abs(d.y) * s.halfHeight + rounded(s.radius); }
  double operator()(const Box& s) const {
    return std::abs(d.x) * s.x + std::abs(d.y) * s.y + std::abs(d.z) * s.z + rounded(s.rounding);
  }
  double operator()(const Cylinder& s) const {
    return std::abs(d.y) * s.halfHeight + across() * s.radius + rounded(s.rounding);
  }
  double operator()(const Cone& s) const {
    return std::max(d.y * s.halfHeight, across() * s.radius - d.y * s.halfHeight) + rounded(s.rounding);
  }
  double operator()(const Ellipsoid& s) const { return length(Vec3d{d.x * s.x, d.y * s.y, d.z * s.z}); }
  double operator()(const Hull& s) const {
    double out = -1e300;
    for (const Vec3 v : s.data->vertices()) out = std::max(out, at(v, s.scale));
    return out + rounded(s.rounding);
  }
  double operator()(const Mesh& s) const { return box(s.data->lower(), s.data->upper(), s.scale); }
  double operator()(const HeightField& s) const { return box(s.data->lower(), s.data->upper(), s.scale); }
  double operator()(const HalfSpace&) const { return -1e300; }

  double at(Vec3 v, Vec3 scale) const { return dot(d, Vec3d{v.x * scale.x, v.y * scale.y, v.z * scale.z}); }
  double box(Vec3 low, Vec3 high, Vec3 scale) const {
    double out = -1e300;
    for (int i = 0; i < 8; ++i) {
      out = std::max(out, at({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z}, scale));
    }
    return out;
  }
};

void include(Bounds& bounds, const Geometry& geometry, const Pose& pose) {
  if (std::holds_alternative<HalfSpace>(geometry)) return;
  constexpr double Vec3d::*kAxes[] = {&Vec3d::x, &Vec3d::y, &Vec3d::z};
  for (const auto axis : kAxes) {
    Vec3d direction;
    direction.*axis = 1;
    const Vec3d own = rotate(conjugate(pose.rotation), direction);
    const double up = pose.position.*axis + std::visit(Reach{own}, geometry);
    const double down = pose.position.*axis - std::visit(Reach{own * -1.0}, geometry);
    bounds.upper.*axis = std::max(bounds.upper.*axis, up);
    bounds.lower.*axis = std::min(bounds.lower.*axis, down);
  }
}

void countShape(ModelInfo& info, const Geometry& geometry) {
  ++info.shapes[geometry.index()];
  if (const Hull* hull = std::get_if<Hull>(&geometry)) info.hullVertices += hull->data->vertices().size();
  if (const Mesh* mesh = std::get_if<Mesh>(&geometry)) info.meshTriangles += mesh->data->triangleCount();
  if (const HeightField* field = std::get_if<HeightField>(&geometry)) {
    info.heightSamples += static_cast<size_t>(field->data->columns()) * static_cast<size_t>(field->data->rows());
  }
}

std::string vectorText(Vec3d v) { return digits(v.x, 6) + ", " + digits(v.y, 6) + ", " + digits(v.z, 6); }

std::string boundsText(const Bounds& bounds) {
  return bounds.empty() ? "none" : vectorText(bounds.lower) + " to " + vectorText(bounds.upper) + " m";
}

// "12: 3 box, 9 hull"
template <class Counts>
std::string countsText(const Counts& counts, const char* (*name)(size_t)) {
  size_t total = 0;
  std::string text;
  for (size_t i = 0; i < counts.size(); ++i) {
    total += counts[i];
    if (counts[i] > 0) text += (text.empty() ? ": " : ", ") + std::to_string(counts[i]) + " " + name(i);
  }
  return std::to_string(total) + text;
}

D6Axis axisOf(const World& world, const NamedJoint& joint) {
  const auto free = [](const auto& def) {
    D6Axis axis;
    axis.limit = def.limit;
    axis.maxVelocity = def.maxVelocity;
    return axis;
  };
  switch (world.type(joint.id)) {
    case JointType::Hinge:
      return free(world.hingeJoint(joint.id));
    case JointType::Slider:
      return free(world.sliderJoint(joint.id));
    case JointType::D6:
      return world.d6Joint(joint.id).axes[static_cast<size_t>(joint.axis)];
    default:
      return {};
  }
}

bool hasCoordinates(const World& world, JointId id) {
  const JointType type = world.type(id);
  return type == JointType::Hinge || type == JointType::Slider || type == JointType::D6;
}

CoordinateInfo infoOf(const World& world, const NamedJoint& joint) {
  CoordinateInfo info;
  info.name = joint.name;
  info.joint = jointKindName(static_cast<size_t>(world.type(joint.id)));
  info.isAngle = joint.axis >= JointAxis::Twist;
  const auto toFile = [&](double ours) { return joint.sign * ours + joint.offset; };
  const D6Axis axis = axisOf(world, joint);
  if (hasCoordinates(world, joint.id)) info.position = toFile(world.coordinate(joint.id, joint.axis).position);
  info.lower = toFile(static_cast<double>(joint.sign < 0 ? axis.limit.upper : axis.limit.lower));
  info.upper = toFile(static_cast<double>(joint.sign < 0 ? axis.limit.lower : axis.limit.upper));
  info.maxVelocity = static_cast<double>(axis.maxVelocity);
  return info;
}

std::string coordinateText(const CoordinateInfo& c) {
  const std::string unit = c.isAngle ? " rad" : " m";
  std::string text = c.name + ": " + c.joint + ", ";
  const bool bounded = std::isfinite(c.lower) || std::isfinite(c.upper);
  text += bounded ? digits(c.lower, 5) + " .. " + digits(c.upper, 5) + unit : "no limits";
  if (std::isfinite(c.maxVelocity)) text += ", at most " + digits(c.maxVelocity, 5) + unit + "/s";
  return text + ", at " + digits(c.position, 5);
}

// Of the three usual kinds the law in words, else its numbers.
std::string lawText(const Actuator& a) {
  const auto [constant, stiffness, damping] = a.bias;
  if (constant == 0 && stiffness == 0 && damping == 0) return "force, gain " + digits(a.gain, 5);
  if (constant == 0 && stiffness == -a.gain) {
    return "position, stiffness " + digits(a.gain, 5) + ", damping " + digits(-damping, 5);
  }
  if (constant == 0 && stiffness == 0 && damping == -a.gain) return "velocity, gain " + digits(a.gain, 5);
  return "gain " + digits(a.gain, 5) + ", bias " + digits(constant, 5) + " " + digits(stiffness, 5) + " " +
         digits(damping, 5);
}

std::string actuatorText(const Actuator& a, const std::string& moved) {
  std::string text = a.name + (moved.empty() || moved == a.name ? "" : " of " + moved) + ": " + lawText(a);
  if (a.gear != 1) text += ", gear " + digits(a.gear, 5);
  if (std::isfinite(a.maxForce)) text += ", at most " + digits(a.maxForce, 5);
  if (a.controlRange) {
    text += ", control " + digits((*a.controlRange)[0], 5) + " .. " + digits((*a.controlRange)[1], 5);
  }
  return text;
}

std::string movedBy(const Model& model, const Actuator& actuator) {
  for (const NamedJoint& joint : model.joints) {
    const bool coupling = model.world.type(actuator.joint) == JointType::Coupling;
    if (joint.id == actuator.joint && (coupling || joint.axis == actuator.axis)) return joint.name;
  }
  return {};
}

// "3: 2 jointpos, 1 clock", kinds in the order in which they come first
std::string probesText(const std::vector<ProbeInfo>& probes) {
  std::vector<std::pair<std::string, size_t>> counts;
  for (const ProbeInfo& probe : probes) {
    const auto known = std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.first == probe.kind; });
    if (known != counts.end()) {
      ++known->second;
    } else {
      counts.emplace_back(probe.kind, 1);
    }
  }
  std::string text = std::to_string(probes.size());
  for (size_t i = 0; i < counts.size(); ++i) {
    text += (i == 0 ? ": " : ", ") + std::to_string(counts[i].second) + " " + counts[i].first;
  }
  return text;
}

}  // namespace

const char* shapeKindName(size_t kind) { return kShapeNames[kind]; }
const char* jointKindName(size_t kind) { return kJointNames[kind]; }

ModelInfo infoOf(const Model& model) {
  ModelInfo info;
  const World& world = model.world;
  info.name = model.name;
  info.dt = model.dt;
  info.up = model.up;
  info.gravity = world.definition().gravity;
  info.keyframes = model.keyframes;
  info.notes = model.notes;
  for (const NamedBody& body : model.bodies) {
    info.coloredShapes += static_cast<size_t>(
        std::count_if(body.colors.begin(), body.colors.end(), [](const auto& color) { return color.has_value(); }));
  }
  for (const BodyId body : world.bodies()) {
    const BodyType type = world.type(body);
    ++(type == BodyType::Dynamic ? info.dynamic : type == BodyType::Kinematic ? info.kinematic : info.fixed);
    info.mass += static_cast<double>(world.mass(body));
    for (const ShapeId shape : world.shapes(body)) {
      const Geometry geometry = world.geometry(shape);
      countShape(info, geometry);
      include(info.bounds, geometry, world.pose(body) * world.localPose(shape));
    }
  }
  for (const SoftId soft : world.softBodies()) {
    ++info.softBodies;
    info.particles += world.mesh(soft)->points().size();
    info.tetrahedra += world.mesh(soft)->tets().size();
    info.triangles += world.mesh(soft)->triangles().size();
  }
  for (const JointId joint : world.joints()) ++info.joints[static_cast<size_t>(world.type(joint))];
  for (const NamedJoint& joint : model.joints) info.coordinates.push_back(infoOf(world, joint));
  info.softs = softFiguresOf(model);
  info.actuators = model.actuators;
  for (const Probe& probe : model.probes) {
    const ProbeKindFacts& facts = factsOf(probe.kind);
    info.probes.push_back({probe.name, facts.name, probe.unit, facts.dimension});
  }
  for (const Actuator& actuator : model.actuators) info.moved.push_back(movedBy(model, actuator));
  return info;
}

ReportLines reportLines(const ModelInfo& info) {
  ReportLines lines{
      {"model", info.name},
      {"bodies", std::to_string(info.dynamic) + " dynamic, " + std::to_string(info.kinematic) + " kinematic, " +
                     std::to_string(info.fixed) + " static"},
      {"shapes", countsText(info.shapes, shapeKindName)},
  };
  if (info.coloredShapes > 0) lines.emplace_back("coloured", std::to_string(info.coloredShapes) + " shapes");
  if (info.hullVertices > 0) lines.emplace_back("hull vertices", std::to_string(info.hullVertices));
  if (info.meshTriangles > 0) lines.emplace_back("mesh triangles", std::to_string(info.meshTriangles));
  if (info.heightSamples > 0) lines.emplace_back("heights", std::to_string(info.heightSamples));
  if (info.softBodies > 0) {
    lines.emplace_back("soft bodies", std::to_string(info.softBodies) + ": " + std::to_string(info.particles) +
                                          " particles, " + std::to_string(info.tetrahedra) + " tetrahedra, " +
                                          std::to_string(info.triangles) + " triangles of cloth");
  }
  for (const SoftFigures& soft : info.softs) lines.emplace_back("soft body", softText(soft));
  lines.emplace_back("joints", countsText(info.joints, jointKindName));
  lines.emplace_back("mass", digits(info.mass, 6) + " kg (of the dynamic bodies)");
  lines.emplace_back("bounds", boundsText(info.bounds));
  lines.emplace_back("step", digits(info.dt, 6) + " s");
  lines.emplace_back("gravity", vectorText(toDouble(info.gravity)) + " m/s^2");
  lines.emplace_back("up", vectorText(toDouble(info.up)));
  std::string keys;
  for (const std::string& key : info.keyframes) keys += (keys.empty() ? "" : ", ") + key;
  lines.emplace_back("keyframes", keys.empty() ? "none" : keys);
  for (const CoordinateInfo& coordinate : info.coordinates) lines.emplace_back("joint", coordinateText(coordinate));
  for (size_t i = 0; i < info.actuators.size(); ++i) {
    lines.emplace_back("actuator", actuatorText(info.actuators[i], info.moved[i]));
  }
  lines.emplace_back("probes", probesText(info.probes));
  for (const std::string& note : info.notes) lines.emplace_back("note", note);
  return lines;
}

MeshInfo infoOf(const MeshFile& mesh, const std::string& name) {
  MeshInfo info;
  info.name = name;
  info.vertices = mesh.vertices.size();
  info.triangles = mesh.triangles.size();
  info.notes = mesh.notes;
  const auto data = makeMesh({.vertices = mesh.vertices, .triangles = mesh.triangles});
  info.report = data->report();
  info.bounds = {toDouble(data->lower()), toDouble(data->upper())};
  info.closed = info.report.boundaryEdges == 0 && info.report.nonManifoldEdges == 0;
  const Vec3d from = (info.bounds.lower + info.bounds.upper) * 0.5;
  for (uint32_t t = 0; t < data->triangleCount(); ++t) {
    const auto corners = data->triangle(t);
    const Vec3d a = toDouble(corners[0]) - from, b = toDouble(corners[1]) - from, c = toDouble(corners[2]) - from;
    const auto cross = [](Vec3d u, Vec3d v) {
      return Vec3d{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    };
    info.volume += dot(a, cross(b, c)) / 6;
    info.area += length(cross(b - a, c - a)) / 2;
  }
  try {
    const auto hull = makeHull({.points = mesh.vertices});
    info.hullVertices = hull->vertices().size();
    info.hullVolume = static_cast<double>(hull->massProperties(1).mass);
    info.hullError = static_cast<double>(hull->error());
  } catch (const Error& error) {
    info.hullRefused = error.what();
  }
  return info;
}

ReportLines reportLines(const MeshInfo& info) {
  const MeshReport& r = info.report;
  ReportLines lines{
      {"mesh", info.name},
      {"vertices", std::to_string(info.vertices)},
      {"triangles", std::to_string(info.triangles) + ", of which " + std::to_string(r.degenerate) +
                        " without area and " + std::to_string(r.duplicate) + " twice"},
      {"bounds", boundsText(info.bounds)},
      {"closed", info.closed ? "yes"
                             : "no: " + std::to_string(r.boundaryEdges) + " edges of one triangle, " +
                                   std::to_string(r.nonManifoldEdges) + " of more than two or of two that disagree"},
      {"area", digits(info.area, 6) + " m^2"},
      {"volume", info.closed ? digits(info.volume, 6) + " m^3" : "not defined: the mesh is not closed"},
  };
  if (info.closed && info.volume < 0) lines.emplace_back("note", "its triangles face inwards");
  if (info.hullVertices) {
    lines.emplace_back("hull", std::to_string(*info.hullVertices) + " vertices, " + digits(info.hullVolume, 6) +
                                   " m^3, points at most " + digits(info.hullError, 3) + " m outside");
  } else {
    lines.emplace_back("hull", "none: " + info.hullRefused);
  }
  lines.emplace_back("memory", std::to_string(r.bytes) + " bytes as a mesh");
  for (const std::string& note : info.notes) lines.emplace_back("note", note);
  return lines;
}

}  // namespace avbd::cli
