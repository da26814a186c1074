// MJCF composites: particles, grids and cloth.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/mjcf_mass.h"
#include "io/mjcf_parser.h"
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

namespace {

using Kind = Composite::Kind;

const std::vector<std::string_view> kCompositeKinds = {"particle", "grid", "cable",    "rope",     "loop",
                                                       "cloth",    "box",  "cylinder", "ellipsoid"};

/// "2_0"
std::string numberOf(int x, int y) { return std::to_string(x) + "_" + std::to_string(y); }

/// A ball within it.
double inside(const Geom& geom) {
  const Vec3d s = geom.size;
  const bool round = geom.kind == GeomKind::Sphere || geom.kind == GeomKind::Capsule;
  if (round) return s.x;
  return geom.kind == GeomKind::Cylinder ? std::min(s.x, s.y) : std::min({s.x, s.y, s.z});
}

}  // namespace

void Parser::readComposite(Elem elem, const OpenElem& in) {
  const Attributes a = own(elem, "composite");
  Composite c{elem, a, source_.where(elem), a.text("prefix")};
  a.requiredText("type");
  c.kind = static_cast<Kind>(a.keyword("type", kCompositeKinds, 0));
  if (c.kind >= Kind::Box) {
    notes_.add(c.where, "left out: type " + a.text("type"), "composite");
    out_.bodies[static_cast<size_t>(in.body)].partsLeftOut = true;
    coordinatesMissing_ = true;
    return;
  }
  const bool byVertices = c.kind == Kind::Cable && a.has("vertex");
  const std::vector<double> count = a.numbers("count", 1, 3);
  if (count.empty() && !byVertices) a.fail("count", "must be 1 to 3 whole numbers 1 .. 100000");
  if (!count.empty() && byVertices) a.fail("count", "not allowed beside vertex");
  for (size_t i = 0; i < count.size(); ++i) {
    if (!(count[i] >= 1 && count[i] <= 1e5 && count[i] == std::floor(count[i])))
      a.fail("count", "each must be a whole number 1 .. 100000");
    c.count[i] = static_cast<int>(count[i]);
    if (c.count[i] == 1) continue;
    if (c.dim != i) a.fail("count", "numbers above 1 must come first");
    ++c.dim;
  }
  c.offset = vector(a, "offset", {});
  c.spacing = a.number("spacing", 0);
  if (c.kind != Kind::Cable && !(c.spacing > 0)) a.fail("spacing", "must be finite and > 0");
  readCompositeParts(c);
  if (!byVertices) chargePoints(a, "count", double{1} * c.count[0] * c.count[1] * c.count[2]);
  if (c.kind == Kind::Cable) return addCable(c, in);
  if (c.kind == Kind::Rope || c.kind == Kind::Loop) return addRope(c, in);
  if (c.kind == Kind::Cloth) return addCloth(c, in);
  addGrid(c, in);
}

void Parser::readCompositeParts(Composite& c) {
  noteChildren(c.elem, "composite");
  c.joint.where = c.where;
  c.joint.kind = c.kind == Kind::Cable ? JointKind::Ball : c.kind < Kind::Cable ? JointKind::Slide : JointKind::Hinge;
  for (const Elem child : source_.children(c.elem)) {
    if (child.name() == "joint") readCompositeJoint(child, c);
    if (child.name() == "tendon") {
      c.tendonStiffness = std::max(c.tendonStiffness, notNegative(own(child, "compositetendon"), "stiffness"));
    }
    if (child.name() != "geom") continue;
    if (c.geomAttributes) source_.fail(child, "a composite can have one geom only");
    c.geomAttributes.emplace(own(child, "compositegeom"));
    const Attributes& a = *c.geomAttributes;
    c.geom.where = source_.where(child);
    if (a.has("fromto")) a.fail("fromto", "not allowed in a composite");
    if (c.kind == Kind::Cable) continue;
    readShape(a, c.geom);
    if (c.geom.kind == GeomKind::Plane || c.geom.kind == GeomKind::HeightField || c.geom.asset >= 0 ||
        c.geom.kind == GeomKind::Sdf)
      a.fail("type", "must be sphere, capsule, ellipsoid, cylinder or box in a composite");
    c.geom.pose = {};
    // Grids and particles are balls whatever the type.
    if (c.kind < Kind::Cable) c.geom.kind = GeomKind::Sphere, c.geom.size = {c.geom.size.x, 0, 0};
    readSurface(a, c.geom);
    // MuJoCo's own default for particles.
    if (c.kind == Kind::Particle && !a.has("condim")) c.geom.condim = 1;
    if (c.kind == Kind::Particle && !a.has("priority")) c.geom.priority = 1;
    readColor(a, c.geom);
    readGeomMass(a, c.geom);
    if (!(c.geom.mass > 0)) a.fail(a.has("mass") ? "mass" : "density", "must be > 0 in a composite");
  }
  if (!c.geomAttributes) source_.fail(c.elem, "a composite must have a geom");
}

void Parser::readCompositeJoint(Elem elem, Composite& c) {
  const Attributes a = own(elem, "compositejoint");
  const int kind = a.keyword("kind", {"main", "twist", "stretch", "particle"}, 0);
  if (kind > 0) {
    notes_.add(source_.where(elem), "left out: joint of kind " + a.text("kind"), "composite");
    return;
  }
  readJointRange(a, c.joint);
  readJointForces(a, c.joint);
}

void Parser::needCount(const Composite& c, size_t least, size_t most, int fewest) {
  const Attributes& a = c.attributes;
  if (c.dim >= least && c.dim <= most && c.count[0] >= fewest) return;
  const std::string range =
      least == most ? std::to_string(least) : std::to_string(least) + " or " + std::to_string(most);
  a.fail("count", "type " + a.text("type") + " needs " + range + " numbers above 1, the first at least " +
                      std::to_string(fewest));
}

// The place in the grid of the body that a composite is in, by its name: B and numbers.
std::vector<int> Parser::rootElement(const Composite& c, const OpenElem& in, size_t numbers) {
  const std::string& name = out_.bodies[static_cast<size_t>(in.body)].name;
  const std::string start = c.prefix + "B";
  std::vector<int> out;
  if (in.body != 0 && name.starts_with(start)) {
    const char *at = name.data() + start.size(), *const end = name.data() + name.size();
    for (size_t i = 0; i < numbers; ++i) {
      int value = 0;
      const auto [next, error] = std::from_chars(at, end, value);
      const bool more = i + 1 < numbers;
      if (error != std::errc() || value < 0 || (more ? next == end || *next != '_' : next != end)) break;
      if (value >= c.count[i]) break;
      out.push_back(value);
      at = next + (more ? 1 : 0);
    }
  }
  if (out.size() == numbers) return out;
  source_.fail(c.elem, "the body around a composite of this type must be its element " + start +
                           (numbers == 1 ? "i" : "i_j") + " by name, the numbers below its count; it is " +
                           mjcf::quoted(name));
}

// An element of its own: a point with the mass of the geom, or what stands still where the caller gives it no joint.
int Parser::addElement(const Composite& c, const std::string& name, Vec3d at, const OpenElem& in) {
  const int body = addPoint(name, c.where, {(in.frame * Posed{at, {}}).position, {}}, in.body);
  const std::array<Mass, 1> mass{massOf(c.geom, {})};
  inertials_.back() = {c.elem, true, sum(mass), Quatd{}};
  return body;
}

void Parser::addGrid(Composite& c, const OpenElem& in) {
  const bool particles = c.kind == Kind::Particle;
  if (!particles) needCount(c, 1, 2, 2);
  std::set<std::pair<int, int>> pins;
  for (const Elem child : source_.children(c.elem)) {
    if (child.name() != "pin") continue;
    const Attributes a = own(child, "compositepin");
    const std::vector<double> v = a.numbers("coord", 1, 2);
    for (size_t i = 0; i < v.size(); ++i) {
      if (!(v[i] >= 0 && v[i] < c.count[i] && v[i] == std::floor(v[i])))
        a.fail("coord", "each must be a place in the grid");
    }
    if (!v.empty()) pins.emplace(static_cast<int>(v[0]), v.size() > 1 ? static_cast<int>(v[1]) : 0);
  }
  Flex flex;
  flex.dim = particles ? 1 : static_cast<int>(c.dim);
  const double s = c.spacing;
  const auto [nx, ny, nz] = c.count;
  for (int x = 0; x < nx; ++x)
    for (int y = 0; y < ny; ++y)
      for (int z = 0; z < nz; ++z) {
        // About half the count, not about the middle: so it is in MuJoCo.
        const Vec3d at = c.offset + Vec3d{s * (x - 0.5 * nx), s * (y - 0.5 * ny), particles ? s * (z - 0.5 * nz) : 0};
        const int body = addElement(c, particles ? "" : c.prefix + "B" + numberOf(x, y), at, in);
        flex.vertices.push_back({body, {}});
        if (pins.contains({x, y})) continue;
        for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) slide(body, axis, c.joint);
      }
  if (!particles) return joinGrid(c, std::move(flex));
  flex.where = c.where;
  flex.radius = inside(c.geom);
  flex.surface = c.geom;
  out_.flexes.push_back(std::move(flex));
}

// The body around it is one of its elements; MuJoCo hangs the others on it with hinges.
void Parser::addCloth(Composite& c, const OpenElem& in) {
  needCount(c, 2, 2, 2);
  const std::vector<int> root = rootElement(c, in, 2);
  coordinatesMissing_ = true;
  Flex flex;
  flex.dim = 2;
  flex.bending = c.joint.stiffness;
  if (c.joint.damping > 0) notes_.add(c.where, "damping of its joints is not used", "composite");
  Joint free;
  free.where = c.where;
  for (int x = 0; x < c.count[0]; ++x)
    for (int y = 0; y < c.count[1]; ++y) {
      if (x == root[0] && y == root[1]) {
        flex.vertices.push_back({in.body, {}});
        continue;
      }
      const Vec3d at{c.spacing * (x - root[0]), c.spacing * (y - root[1]), 0};
      const int body = addElement(c, c.prefix + "B" + numberOf(x, y), at, in);
      for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) slide(body, axis, free);
      flex.vertices.push_back({body, {}});
    }
  Inertial& own = inertials_[static_cast<size_t>(in.body)];
  if (!own.given) {
    const std::array<Mass, 1> mass{massOf(c.geom, {})};
    own = {c.elem, true, sum(mass), Quatd{}};
  }
  joinGrid(c, std::move(flex));
}

// Of what a grid of elements is made of: a rope, or a cloth that does not stretch.
void Parser::joinGrid(const Composite& c, Flex flex) {
  flex.where = c.where;
  flex.radius = inside(c.geom);
  // A cloth's joints hold it together, a grid's tendons by equalities. Edges of stiffness k are a sheet of E h = k.
  flex.holdsEdges = !off_.equalities || c.kind == Kind::Cloth;
  if (!flex.holdsEdges) {
    flex.edgeStiffness = c.tendonStiffness;
    flex.young = c.tendonStiffness / (2 * flex.radius);
  }
  flex.surface = c.geom;
  if (c.geom.kind != GeomKind::Sphere)
    notes_.add(c.geom.where, "its points touch as balls within the geom", "composite");
  const FlexShape shape = flexShape({FlexKind::Grid, flex.dim, c.count, {1, 1, 1}});
  flex.elements = shape.elements;
  if (flex.dim == 2) notes_.add(c.where, "a cloth, that resists shearing too, stands for it", "composite");
  out_.flexes.push_back(std::move(flex));
}

}  // namespace avbd::mjcf
