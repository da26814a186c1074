// MJCF flexcomp: a flex with a body for each of its points.
#include <algorithm>
#include <cmath>
#include <fstream>

#include "io/mesh_file_parts.h"
#include "io/mjcf_parser.h"
#include "io/mjcf_schema.h"
#include "io/soft_mesh_file.h"

namespace avbd::mjcf {

namespace {

constexpr size_t kMany = size_t{1} << 28;
constexpr double kMostPoints = 100000;  // of a model; each is a body

const std::vector<std::string_view> kKinds = {"grid", "box",    "cylinder", "ellipsoid", "square",
                                              "disc", "circle", "mesh",     "gmsh",      "direct"};
enum class Dof { Full, Radial, Trilinear, Quadratic, Plane };

size_t wholeBelow(const Attributes& a, std::string_view name, double v, size_t end) {
  if (!(v >= 0 && v < static_cast<double>(end) && v == std::floor(v))) {
    std::string range = "each must be a whole number 0 .. ";
    a.fail(name, range.append(std::to_string(end - 1)));
  }
  return static_cast<size_t>(v);
}

bool isBox(FlexKind kind) { return kind == FlexKind::Box || kind == FlexKind::Cylinder || kind == FlexKind::Ellipsoid; }

}  // namespace

void Parser::chargePoints(const Attributes& a, std::string_view attribute, double count) {
  if (!(count <= kMostPoints - static_cast<double>(points_))) {
    a.fail(attribute, "flexes and composites of a model must have at most 100000 points together");
  }
  points_ += static_cast<size_t>(count);
}

FlexPattern Parser::flexPattern(const Attributes& a, FlexKind kind, int dim, double radius) {
  FlexPattern out{kind, dim};
  if (kind >= FlexKind::Mesh) return out;
  std::array<bool, 3> used{true, kind != FlexKind::Circle && (kind != FlexKind::Grid || dim > 1),
                           isBox(kind) || (kind == FlexKind::Grid && dim > 2)};
  const std::vector<double> count = a.numbers("count", 1, 3), spacing = a.numbers("spacing", 1, 3);
  double* const space[] = {&out.spacing.x, &out.spacing.y, &out.spacing.z};
  for (size_t i = 0; i < 3; ++i) {
    const double least = !used[i] ? 1 : kind == FlexKind::Circle ? 4 : 2;
    if (i < count.size()) {
      if (!(count[i] >= least && count[i] <= 1e5 && count[i] == std::floor(count[i]))) {
        a.fail("count", "number " + std::to_string(i + 1) + " must be a whole number " +
                            std::to_string(static_cast<int>(least)) + " .. 100000");
      }
      out.count[i] = static_cast<int>(count[i]);
    }
    if (i < spacing.size()) *space[i] = spacing[i];
    if (used[i] && !(*space[i] > 0 && *space[i] >= 2 * radius)) {
      a.fail("spacing", "each must be > 0 and at least twice the radius");
    }
  }
  return out;
}

FlexShape Parser::directShape(const Attributes& a, int dim) {
  FlexShape out{dim, {}, {}};
  const std::vector<double> v = a.numbers("point", 0, kMany);
  if (v.empty() || v.size() % 3 != 0) a.fail("point", "must be 3 numbers for each point");
  chargePoints(a, "point", static_cast<double>(v.size() / 3));
  for (size_t i = 0; i < v.size(); i += 3) out.points.push_back({v[i], v[i + 1], v[i + 2]});
  out.elements = flexElements(a, dim, out.points.size());
  return out;
}

FlexShape Parser::meshShape(const Attributes& a, int dim) {
  a.requiredText("file");
  const std::filesystem::path path = assetPath(a);
  FlexShape out{2, {}, {}};
  try {
    const MeshFile file = mesh_file::readFile(path);
    for (const std::string& note : file.notes) notes_.add(source_.where(a.elem()), note);
    chargePoints(a, "file", static_cast<double>(file.vertices.size()));
    // Equal vertices are one point, numbered as the first.
    std::map<std::array<float, 3>, uint32_t> known;
    std::vector<uint32_t> ids;
    for (const Vec3 v : file.vertices) {
      const auto [it, isNew] =
          known.try_emplace({v.x + 0.0f, v.y + 0.0f, v.z + 0.0f}, static_cast<uint32_t>(out.points.size()));
      if (isNew) out.points.push_back(toDouble(v));
      ids.push_back(it->second);
    }
    for (const auto& t : file.triangles) {
      const FlexElement e{ids[t[0]], ids[t[1]], ids[t[2]], 0};
      if (e[0] != e[1] && e[1] != e[2] && e[2] != e[0]) out.elements.push_back(e);
    }
  } catch (const FileError& error) {
    throw FileError(source_.where(a.elem()) + ": " + error.what(), error.file(), error.line());
  }
  if (out.elements.empty()) a.fail("file", "has no triangle with three different corners");
  dropUnused(out);
  if (dim < 3) return out;
  if (!a.has("origin")) a.fail("origin", "must be 3 numbers for a solid of a mesh: dim is 3");
  return solidAbout(vector(a, "origin", {}), out);
}

FlexShape Parser::gmshShape(const Attributes& a) {
  a.requiredText("file");
  const std::filesystem::path path = assetPath(a);
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const std::string where = source_.where(a.elem());
  try {
    const SoftMeshFile file = readSoftMeshBytes(std::as_bytes(std::span<const char>(bytes)), "msh", path.string());
    for (const std::string& note : file.notes) notes_.add(where, note, "flexcomp");
    chargePoints(a, "file", static_cast<double>(file.points.size()));
    FlexShape out{file.tets.empty() ? 2 : 3, {}, file.tets};
    if (file.tets.empty())
      for (const auto& t : file.triangles) out.elements.push_back({t[0], t[1], t[2], 0});
    for (const Vec3 p : file.points) out.points.push_back(toDouble(p));
    return out;
  } catch (const FileError& error) {
    throw FileError(where + ": " + error.what(), error.file(), error.line());
  }
}

std::optional<FlexShape> Parser::flexcompShape(const Attributes& a, const FlexPattern& pattern) {
  const bool wire = pattern.dim == 1 && (isBox(pattern.kind) || pattern.kind == FlexKind::Mesh);
  if (wire) {
    notes_.add(source_.where(a.elem()), "left out: a flexcomp of type box or mesh with dim 1", "flexcomp");
    return {};
  }
  if (pattern.kind < FlexKind::Mesh) {
    chargePoints(a, "count", pointCount(pattern));
    return flexShape(pattern);
  }
  std::optional<FlexShape> out = pattern.kind == FlexKind::Direct ? directShape(a, pattern.dim)
                                 : pattern.kind == FlexKind::Gmsh ? gmshShape(a)
                                                                  : meshShape(a, pattern.dim);
  if (!out) return out;
  const Vec3d scale = vector(a, "scale", {1, 1, 1});
  for (Vec3d& p : out->points) {
    p = {p.x * scale.x, p.y * scale.y, p.z * scale.z};
    if (!(length(p) <= 1e6)) a.fail("scale", "must keep all points within 1e6");
  }
  return out;
}

// By point, as they are numbered before any is dropped.
std::vector<bool> Parser::flexPins(Elem elem, const FlexPattern& pattern, size_t points) {
  std::vector<bool> pinned(points);
  for (const Elem child : source_.children(elem)) {
    if (child.name() != "pin") continue;
    const Attributes a = own(child, "flexpin");
    for (const double v : a.numbers("id", 0, kMany)) pinned[wholeBelow(a, "id", v, points)] = true;
    const std::vector<double> range = a.numbers("range", 0, kMany);
    if (range.size() % 2 != 0) a.fail("range", "must be 2 numbers for each range");
    for (size_t i = 0; i < range.size(); i += 2) {
      const size_t first = wholeBelow(a, "range", range[i], points);
      const size_t last = wholeBelow(a, "range", range[i + 1], points);
      for (size_t k = first; k <= last; ++k) pinned[k] = true;
    }
    for (const bool ranges : {false, true}) pinGrid(a, ranges, pattern, pinned);
  }
  return pinned;
}

void Parser::pinGrid(const Attributes& a, bool ranges, const FlexPattern& pattern, std::vector<bool>& pinned) {
  const std::string_view name = ranges ? "gridrange" : "grid";
  const std::vector<double> v = a.numbers(name, 0, kMany);
  if (v.empty()) return;
  if (pattern.kind != FlexKind::Grid) a.fail(name, "is only allowed for type grid: use id or range");
  const size_t dim = static_cast<size_t>(pattern.dim), each = ranges ? 2 * dim : dim;
  if (v.size() % each != 0) a.fail(name, "must be " + std::to_string(each) + " numbers for each place");
  const size_t ny = dim > 1 ? static_cast<size_t>(pattern.count[1]) : 1;
  const size_t nz = dim > 2 ? static_cast<size_t>(pattern.count[2]) : 1;
  for (size_t i = 0; i < v.size(); i += each) {
    std::array<size_t, 3> low{}, high{};
    for (size_t k = 0; k < dim; ++k) {
      const size_t count = static_cast<size_t>(pattern.count[k]);
      low[k] = wholeBelow(a, name, v[i + k], count);
      high[k] = ranges ? wholeBelow(a, name, v[i + dim + k], count) : low[k];
    }
    for (size_t x = low[0]; x <= high[0]; ++x)
      for (size_t y = low[1]; y <= high[1]; ++y)
        for (size_t z = low[2]; z <= high[2]; ++z) pinned[(x * ny + y) * nz + z] = true;
  }
}

int Parser::addPoint(const std::string& name, const std::string& where, Posed pose, int parent) {
  Body body;
  body.name = name;
  body.where = where;
  body.parent = parent;
  body.pose = pose;
  const int index = static_cast<int>(out_.bodies.size());
  if (!name.empty() && !bodyByName_.emplace(name, index).second) {
    throw FileError(where + ": another body has the name " + mjcf::quoted(name) + " of one of its points",
                    out_.fileName);
  }
  out_.bodies.push_back(std::move(body));
  inertials_.emplace_back();
  bodyElems_.push_back(bodyElems_[static_cast<size_t>(parent)]);
  return index;
}

void Parser::slide(int body, Vec3d axis, const Joint& like) {
  Joint joint = like;
  joint.kind = JointKind::Slide;
  joint.axis = axis;
  out_.bodies[static_cast<size_t>(body)].joints.push_back(std::move(joint));
}

void Parser::readFlexcomp(Elem elem, const OpenElem& in) {
  const Attributes a = own(elem, "flexcomp");
  Flex flex;
  readFlexBase(a, flex);
  if (flex.name.empty()) a.fail("name", "must be given");
  const FlexKind kind = static_cast<FlexKind>(a.keyword("type", kKinds, 0));
  const Dof dof = static_cast<Dof>(a.keyword("dof", {"full", "radial", "trilinear", "quadratic", "2d"}, 0));
  if (kind == FlexKind::Disc || kind == FlexKind::Square) flex.dim = 2;
  if (kind == FlexKind::Circle) flex.dim = 1;
  const double mass = a.number("mass", 1), side = a.number("inertiabox", 0.005);
  if (!(mass > 0)) a.fail("mass", "must be finite and > 0");
  if (!(side > 0)) a.fail("inertiabox", "must be finite and > 0");
  const FlexPattern pattern = flexPattern(a, kind, flex.dim, flex.radius);
  std::optional<FlexShape> made = flexcompShape(a, pattern);
  if (!made) {
    out_.bodies[static_cast<size_t>(in.body)].partsLeftOut = true;
    coordinatesMissing_ = true;
    return;
  }
  FlexShape& shape = *made;
  flex.dim = shape.dim;
  std::vector<bool> pinned = flexPins(elem, pattern, shape.points.size());
  if (a.flag("rigid", false)) pinned.assign(pinned.size(), true);
  const std::vector<uint32_t> kept = dropUnused(shape);
  flex.elements = std::move(shape.elements);
  readFlexParts(elem, flex);
  if (dof == Dof::Trilinear || dof == Dof::Quadratic) {
    notes_.add(flex.where, "dof " + a.text("dof") + ": each point moves by itself", "flexcomp");
    coordinatesMissing_ = true;  // MuJoCo's are those of the nodes
  }
  const Posed place = in.frame * pose(a);
  const double each = mass / static_cast<double>(kept.size()), inertia = each * side * side / 6;
  for (size_t i = 0; i < kept.size(); ++i) {
    const Vec3d at = place.position + rotate(place.rotation, shape.points[i]);
    const bool inCentre = dof == Dof::Radial && length(at) < 1e-12;
    if (pinned[kept[i]] || inCentre) {
      flex.vertices.push_back({in.body, at});
      continue;
    }
    const int body = addPoint(flex.name + "_" + std::to_string(i), flex.where, {at, {}}, in.body);
    inertials_.back() = {elem, true, {each, {}, {inertia, inertia, inertia}}, Quatd{}};
    Joint joint;
    joint.where = flex.where;
    if (dof == Dof::Radial) {
      slide(body, at * (1 / length(at)), joint);
    } else {
      slide(body, {1, 0, 0}, joint);
      slide(body, {0, 1, 0}, joint);
      if (dof != Dof::Plane) slide(body, {0, 0, 1}, joint);
    }
    flex.vertices.push_back({body, {}});
  }
  addFlex(std::move(flex));
}

}  // namespace avbd::mjcf
