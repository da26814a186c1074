// MJCF geoms: shape, surface, mass.
#include <algorithm>
#include <cmath>

#include "io/mjcf_mass.h"
#include "io/mjcf_mesh.h"
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
  readColor(a, geom);
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
  if (geom.kind == GeomKind::Plane && a.has("fromto")) a.fail("fromto", "not allowed for a plane");
  if (geom.kind == GeomKind::HeightField ||
      (geom.kind != GeomKind::Sdf && (geom.kind == GeomKind::Mesh || a.has("mesh")))) {
    return readAssetShape(a, geom);
  }

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

void Parser::readAssetShape(const Attributes& a, Geom& geom) {
  geom.pose = pose(a);
  geom.isShell = a.flag("shellinertia", false);
  if (geom.kind == GeomKind::HeightField) {
    const auto it = heightsByName_.find(a.requiredText("hfield"));
    if (it == heightsByName_.end()) a.fail("hfield", "no hfield of this name in asset");
    geom.asset = static_cast<int>(it->second);
    return;
  }
  if (a.has("fromto")) a.fail("fromto", "not allowed for a mesh");
  geom.asset = meshNamed(a);
  const MeshAsset& mesh = out_.meshes[static_cast<size_t>(geom.asset)];
  if (geom.kind == GeomKind::Mesh) return;
  if (geom.kind == GeomKind::Plane) a.fail("mesh", "a plane cannot be fitted to a mesh");
  if (!((geom.isShell ? mesh.shell : mesh.solid).mass > 0))
    a.fail("mesh", "the mesh must have a volume to fit a shape to");
  if (compiler_.fitAabb) {
    fitAround(mesh, geom);
  } else {
    fitToInertia(mesh, geom);
  }
  const double scale = a.number("fitscale", 1);
  if (!(scale > 0)) a.fail("fitscale", "must be finite and > 0");
  geom.size = geom.size * scale;
  geom.isShell = false;
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
  if (friction.size() > 1) geom.torsional = friction[1];
  if (friction.size() > 2) geom.rolling = friction[2];
  geom.condim = a.integer("condim", 3);
  if (geom.condim != 1 && geom.condim != 3 && geom.condim != 4 && geom.condim != 6) {
    a.fail("condim", "must be 1, 3, 4 or 6");
  }
  geom.priority = a.integer("priority", 0);
  geom.contype = a.integer("contype", 1);
  geom.conaffinity = a.integer("conaffinity", 1);
  geom.group = a.integer("group", 0);
}

// MuJoCo's rule: a material gives way to any colour of the geom but this grey, which stands for none.
void Parser::readColor(const Attributes& a, Geom& geom) {
  const std::vector<double> rgba = a.numbers("rgba", 4, 4);
  const bool isSet = !rgba.empty() && rgba != std::vector<double>{0.5, 0.5, 0.5, 1};
  if (const auto material = materials_.find(a.text("material")); !isSet && material != materials_.end()) {
    geom.color = material->second;
  } else if (!rgba.empty()) {
    geom.color = colorOf(rgba[0], rgba[1], rgba[2], rgba[3]);
  }
}

void Parser::readGeomMass(const Attributes& a, Geom& geom) {
  const double density = a.number("density", 1000), mass = a.number("mass", -1);
  if (density < 0) a.fail("density", "must be finite and >= 0");
  if (a.has("mass") && mass < 0) a.fail("mass", "must be finite and >= 0");
  double space = volume(geom.kind, geom.size);
  if (geom.kind == GeomKind::Mesh) {
    const MeshAsset& mesh = out_.meshes[static_cast<size_t>(geom.asset)];
    space = (geom.isShell ? mesh.shell : mesh.solid).mass;
  } else if (a.flag("shellinertia", false)) {
    notes_.add(geom.where, "shellinertia: the inertia of the solid is used");
  }
  geom.mass = space > 0 ? (a.has("mass") ? mass : density * space) : 0;
  geom.massKnown = geom.kind != GeomKind::Sdf || (a.has("mass") ? mass == 0 : density == 0);
  if (geom.kind == GeomKind::Sdf) notes_.add(geom.where, "type sdf is left out, and its mass");
}

}  // namespace avbd::mjcf
