// MJCF geoms: shape, surface, mass.
#include <cmath>

#include "io/mjcf_mass.h"
#include "io/mjcf_parser.h"

namespace avbd::mjcf {

namespace {

const std::vector<std::string_view> kGeomTypes = {"plane",    "hfield", "sphere", "capsule", "ellipsoid",
                                                  "cylinder", "box",    "mesh",   "sdf"};

// How many sizes a shape needs; with fromto its length is known.
size_t sizesNeeded(GeomKind kind, bool fromTo) {
  switch (kind) {
    case GeomKind::Sphere:
      return 1;
    case GeomKind::Capsule:
    case GeomKind::Cylinder:
      return fromTo ? 1 : 2;
    case GeomKind::Ellipsoid:
    case GeomKind::Box:
      return fromTo ? 1 : 3;
    default:
      return 0;
  }
}

}  // namespace

void Parser::readGeom(Elem elem, const OpenElem& in) {
  checkAttributes(source_, elem, "geom", notes_);
  const Attributes a = defaults_.resolve(elem, "geom", in.cls);
  Geom geom;
  geom.where = source_.where(elem);
  geom.name = a.text("name");
  const size_t index = out_.bodies[static_cast<size_t>(in.body)].geoms.size();
  if (!geom.name.empty() && !geomByName_.emplace(geom.name, GeomRef{in.body, index}).second) {
    a.fail("name", "another geom has this name");
  }
  readShape(a, geom);
  geom.pose = in.frame * geom.pose;
  readSurface(a, geom);
  readGeomMass(a, geom);
  out_.bodies[static_cast<size_t>(in.body)].geoms.push_back(std::move(geom));
}

void Parser::checkReference(const Attributes& a, std::string_view attribute) {
  const std::string name = a.text(attribute);
  if (name.empty()) return;
  const auto it = assets_.find(attribute);
  if (it == assets_.end() || !it->second.contains(name)) {
    a.fail(attribute, "no " + std::string(attribute) + " of this name in asset");
  }
}

void Parser::readShape(const Attributes& a, Geom& geom) {
  geom.kind = static_cast<GeomKind>(a.keyword("type", kGeomTypes, static_cast<int>(GeomKind::Sphere)));
  for (const char* attribute : {"material", "mesh", "hfield"}) checkReference(a, attribute);
  if (geom.kind == GeomKind::Mesh) a.requiredText("mesh");
  if (geom.kind == GeomKind::HeightField) a.requiredText("hfield");
  // A primitive with a mesh is fitted to it, so its size is not known here either.
  if (geom.kind != GeomKind::Mesh && geom.kind != GeomKind::Sdf && a.has("mesh")) geom.kind = GeomKind::Mesh;
  if (geom.kind == GeomKind::Plane && a.has("fromto")) a.fail("fromto", "not allowed for a plane");

  const bool fromTo = a.has("fromto");
  const size_t needed = sizesNeeded(geom.kind, fromTo);
  const std::vector<double> sizes = a.numbers("size", 1, 3);
  const std::string range = needed == 1 ? "must be finite and > 0"
                            : sizes.size() >= needed
                                ? "each must be finite and > 0"
                                : "must be " + std::to_string(needed) + " numbers, each finite and > 0";
  if (sizes.size() < needed) a.fail("size", range);
  double* const target[] = {&geom.size.x, &geom.size.y, &geom.size.z};
  for (size_t i = 0; i < needed; ++i) {
    *target[i] = sizes[i];
    if (!(sizes[i] > 0)) a.fail("size", range);
  }
  if (fromTo) {
    applyFromTo(a, geom);
  } else {
    geom.pose = pose(a);
  }
}

void Parser::applyFromTo(const Attributes& a, Geom& geom) {
  const std::vector<double> v = a.numbers("fromto", 6, 6);
  const bool isLong = geom.kind == GeomKind::Capsule || geom.kind == GeomKind::Cylinder ||
                      geom.kind == GeomKind::Ellipsoid || geom.kind == GeomKind::Box;
  if (!isLong) {
    if (geom.kind != GeomKind::Sphere) return;  // left out anyway
    a.fail("fromto", "only allowed for a capsule, cylinder, ellipsoid or box");
  }
  const Vec3d from{v[0], v[1], v[2]}, to{v[3], v[4], v[5]};
  const double size = length(to - from);
  if (!(size > 1e-14)) a.fail("fromto", "the two points must not be equal");
  if (geom.kind == GeomKind::Capsule || geom.kind == GeomKind::Cylinder) {
    geom.size.y = size / 2;
  } else {
    geom.size.y = geom.size.x;
    geom.size.z = size / 2;
  }
  geom.pose = {(from + to) * 0.5, turnFromZ(from - to)};
}

void Parser::readSurface(const Attributes& a, Geom& geom) {
  const std::vector<double> friction = a.numbers("friction", 1, 3);
  for (const double value : friction) {
    if (value < 0) a.fail("friction", "each must be finite and >= 0");
  }
  if (!friction.empty()) geom.friction = friction[0];
  geom.condim = a.integer("condim", 3);
  if (geom.condim != 1 && geom.condim != 3 && geom.condim != 4 && geom.condim != 6) {
    a.fail("condim", "must be 1, 3, 4 or 6");
  }
  if (geom.condim > 3) {
    notes_.add(geom.where,
               "condim " + std::to_string(geom.condim) + ": no torsional or rolling friction, only sliding");
  }
  geom.priority = a.integer("priority", 0);
  geom.contype = a.integer("contype", 1);
  geom.conaffinity = a.integer("conaffinity", 1);
  geom.group = a.integer("group", 0);
}

void Parser::readGeomMass(const Attributes& a, Geom& geom) {
  const double density = a.number("density", 1000), mass = a.number("mass", -1);
  if (density < 0) a.fail("density", "must be finite and >= 0");
  if (a.has("mass") && mass < 0) a.fail("mass", "must be finite and >= 0");
  const double space = volume(geom.kind, geom.size);
  geom.mass = space > 0 ? (a.has("mass") ? mass : density * space) : 0;
  const bool isSolid = geom.kind == GeomKind::Mesh || geom.kind == GeomKind::Sdf;
  geom.massKnown = !isSolid || (a.has("mass") ? mass == 0 : density == 0);
  if (a.flag("shellinertia", false)) {
    notes_.add(geom.where, "shellinertia: the inertia of the solid is used");
  }
  const bool canCollide = geom.kind == GeomKind::Plane || geom.kind == GeomKind::Sphere ||
                          geom.kind == GeomKind::Capsule || geom.kind == GeomKind::Box;
  if (canCollide) return;
  const std::string type(kGeomTypes[static_cast<size_t>(geom.kind)]);
  notes_.add(geom.where, "type " + type + " is left out" +
                             (isSolid         ? ", and its mass"
                              : geom.mass > 0 ? "; its mass counts"
                                              : ""));
}

}  // namespace avbd::mjcf
