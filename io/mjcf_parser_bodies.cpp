// MJCF bodies: the tree, poses, sites, inertial elements.
#include <cmath>
#include <numbers>

#include "io/mjcf_parser.h"
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

Vec3d Parser::vector(const Attributes& a, std::string_view name, Vec3d otherwise) const {
  const std::vector<double> v = a.numbers(name, 3, 3);
  return v.empty() ? otherwise : Vec3d{v[0], v[1], v[2]};
}

Quatd Parser::orientation(const Attributes& a) const {
  int given = 0;
  for (const char* name : {"quat", "axisangle", "euler", "xyaxes", "zaxis"}) given += a.elem().has(name) ? 1 : 0;
  if (given > 1) source_.fail(a.elem(), "more than one of quat, axisangle, euler, xyaxes, zaxis is given");
  const double unit = compiler_.degrees ? std::numbers::pi / 180 : 1;
  constexpr double kTiny = 1e-14;
  Quatd q;
  // Where a default class gives one and the element another, the later in this order wins, as in MuJoCo.
  if (const auto v = a.numbers("quat", 4, 4); !v.empty()) {
    q = {v[0], v[1], v[2], v[3]};
    if (!(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z > kTiny)) a.fail("quat", "must not be zero");
  }
  if (const auto v = a.numbers("axisangle", 4, 4); !v.empty()) {
    const Vec3d axis{v[0], v[1], v[2]};
    if (!(length(axis) > kTiny)) a.fail("axisangle", "the axis must not be zero");
    q = turnAbout(axis, v[3] * unit);
  }
  if (const auto v = a.numbers("xyaxes", 6, 6); !v.empty()) {
    Vec3d x{v[0], v[1], v[2]}, y{v[3], v[4], v[5]};
    if (!(length(x) > kTiny)) a.fail("xyaxes", "the x axis must not be zero");
    x = x * (1 / length(x));
    const double size = length(y);
    y = y - x * dot(x, y);
    if (!(length(y) > 1e-9 * size)) a.fail("xyaxes", "the y axis must not be zero or along the x axis");
    y = y * (1 / length(y));
    q = fromAxes(x, y, cross(x, y));
  }
  if (const auto v = a.numbers("zaxis", 3, 3); !v.empty()) {
    const Vec3d z{v[0], v[1], v[2]};
    if (!(length(z) > kTiny)) a.fail("zaxis", "must not be zero");
    q = turnFromZ(z);
  }
  if (const auto v = a.numbers("euler", 3, 3); !v.empty()) {
    q = {};
    for (size_t i = 0; i < 3; ++i) {
      const char axis = compiler_.eulerOrder[i];
      const char low = static_cast<char>(axis | 0x20);
      const Quatd turn = turnAbout({low == 'x' ? 1.0 : 0, low == 'y' ? 1.0 : 0, low == 'z' ? 1.0 : 0}, v[i] * unit);
      q = axis == low ? q * turn : turn * q;  // small letters turn with the body, capitals about fixed axes
    }
  }
  return normalized(q);
}

Posed Parser::pose(const Attributes& a) const { return {vector(a, "pos", {}), orientation(a)}; }

std::string Parser::nameOnce(const Attributes& a, std::set<std::string, std::less<>>& names) {
  std::string name = a.text("name");
  if (!name.empty() && !names.insert(name).second) a.fail("name", "another element of this kind has this name");
  return name;
}

void Parser::readBodies(Elem worldbody) {
  const Attributes a = own(worldbody, "worldbody");
  OpenElem world;
  world.children = source_.children(worldbody);
  if (a.has("childclass")) world.cls = defaults_.find(worldbody, "childclass");
  // An explicit stack: the tree may be deeper than the C stack allows.
  std::vector<OpenElem> open;
  open.push_back(std::move(world));
  while (!open.empty()) {
    OpenElem& top = open.back();
    if (top.next == top.children.size()) {
      open.pop_back();
    } else {
      readBodyChild(top.children[top.next++], open);
    }
  }
}

void Parser::readBodyChild(Elem elem, std::vector<OpenElem>& open) {
  const std::string_view name = elem.name();
  if (name == "body") return openBody(elem, open);
  if (name == "frame") return openFrame(elem, open);
  const OpenElem& in = open.back();
  if (name == "geom") return readGeom(elem, in);
  if (name == "joint" || name == "freejoint") return readJoint(elem, in, name == "freejoint");
  if (name == "inertial") return readInertial(elem, in);
  if (name == "site") return readSite(elem, in);
  if (name == "flexcomp") return readFlexcomp(elem, in);
  if (name == "composite") return readComposite(elem, in);
  switch (sectionOf("body", name)) {
    case Section::Noted:
      notes_.add(source_.where(elem), "left out", name);
      out_.bodies[static_cast<size_t>(in.body)].partsLeftOut = true;
      coordinatesMissing_ = true;
      break;
    case Section::Unknown:
      notes_.add(source_.where(elem), "unknown element", name);
      break;
    default:
      break;
  }
}

void Parser::openBody(Elem elem, std::vector<OpenElem>& open) {
  const Attributes a = own(elem, "body");
  const OpenElem& in = open.back();
  Body body;
  body.name = a.text("name");
  body.where = source_.where(elem);
  body.parent = in.body;
  body.pose = in.frame * pose(a);
  body.mocap = a.flag("mocap", false);
  if (body.mocap && in.body != 0) a.fail("mocap", "only children of worldbody can be mocap bodies");
  body.gravcomp = a.number("gravcomp", 0);
  const int index = static_cast<int>(out_.bodies.size());
  if (!body.name.empty() && !bodyByName_.emplace(body.name, index).second) {
    a.fail("name", "another body has this name");
  }
  OpenElem next;
  next.children = source_.children(elem);
  next.body = index;
  next.cls = elem.has("childclass") ? defaults_.find(elem, "childclass") : in.cls;
  out_.bodies.push_back(std::move(body));
  inertials_.emplace_back();
  bodyElems_.push_back(elem);
  open.push_back(std::move(next));
}

void Parser::openFrame(Elem elem, std::vector<OpenElem>& open) {
  const Attributes a = own(elem, "frame");
  const OpenElem& in = open.back();
  OpenElem next;
  next.children = source_.children(elem);
  next.body = in.body;
  next.cls = elem.has("childclass") ? defaults_.find(elem, "childclass") : in.cls;
  next.frame = in.frame * pose(a);
  open.push_back(std::move(next));
}

void Parser::readSite(Elem elem, const OpenElem& in) {
  checkAttributes(source_, elem, "site", notes_);
  const Attributes a = defaults_.resolve(elem, "site", in.cls);
  Site site;
  site.where = source_.where(elem);
  site.body = in.body;
  Posed at = pose(a);
  // A site between two points is at their middle, its z from the second to the first, as for geoms.
  if (const auto v = a.numbers("fromto", 6, 6); !v.empty()) {
    const Vec3d from{v[0], v[1], v[2]}, to{v[3], v[4], v[5]};
    if (!(length(from - to) > 1e-14)) a.fail("fromto", "the two points must not be equal");
    at = {(from + to) * 0.5, turnFromZ(from - to)};
  }
  site.pose = in.frame * at;
  site.zone = siteZone(a);
  if (const std::string name = nameOnce(a, siteNames_); !name.empty()) {
    siteByName_.emplace(name, static_cast<int>(out_.sites.size()));
  }
  out_.sites.push_back(std::move(site));
}

// MuJoCo's rule: sizes that are not given keep their default.
ProbeZone Parser::siteZone(const Attributes& a) const {
  constexpr double kUsual = 0.005;
  constexpr size_t kNeeded[] = {1, 2, 3, 2, 3};
  ProbeZone zone;
  zone.kind = static_cast<ProbeZone::Kind>(
      a.keyword("type", {"sphere", "capsule", "ellipsoid", "cylinder", "box"}, static_cast<int>(zone.kind)));
  std::vector<double> size = a.numbers("size", 1, 3);
  size.resize(3, kUsual);
  if (const auto v = a.numbers("fromto", 6, 6); !v.empty()) {
    const double half = length(Vec3d{v[3] - v[0], v[4] - v[1], v[5] - v[2]}) / 2;
    const bool round = zone.kind == ProbeZone::Kind::Capsule || zone.kind == ProbeZone::Kind::Cylinder;
    size = {size[0], round ? half : size[0], half};
  }
  for (size_t i = 0; i < kNeeded[static_cast<size_t>(zone.kind)]; ++i) {
    if (!(size[i] > 0)) a.fail("size", "each must be finite and > 0");
  }
  zone.size = {size[0], size[1], size[2]};
  return zone;
}

void Parser::readInertial(Elem elem, const OpenElem& in) {
  const Attributes a = own(elem, "inertial");
  Inertial& inertial = inertials_[static_cast<size_t>(in.body)];
  if (in.body == 0) source_.fail(elem, "the world cannot have an inertial");
  if (inertial.given) source_.fail(elem, "a body can have one inertial only");
  if (!a.has("pos")) a.fail("pos", "must be 3 numbers");
  if (!a.has("mass")) a.fail("mass", "must be finite and >= 0");
  const double mass = a.number("mass", 0);
  if (mass < 0) a.fail("mass", "must be finite and >= 0");
  const Posed at = in.frame * pose(a);
  Sym3d inertia;
  const auto diagonal = a.numbers("diaginertia", 3, 3), full = a.numbers("fullinertia", 6, 6);
  if (!diagonal.empty() && !full.empty()) source_.fail(elem, "both diaginertia and fullinertia are given");
  if (!diagonal.empty()) inertia = {diagonal[0], diagonal[1], diagonal[2]};
  for (const double d : diagonal) {
    if (d < 0) a.fail("diaginertia", "each must be finite and >= 0");
  }
  if (!full.empty()) {
    for (const char* name : {"quat", "axisangle", "euler", "xyaxes", "zaxis"}) {
      if (a.has(name)) a.fail(name, "an orientation is not allowed beside fullinertia");
    }
    inertia = {full[0], full[1], full[2], full[3], full[4], full[5]};
    for (const double value : principal(inertia).values) {
      if (!(value > 0)) a.fail("fullinertia", "must be a positive definite matrix: xx yy zz xy xz yz");
    }
  }
  inertial = {elem, true, {mass, at.position, rotated(inertia, at.rotation)}};
  if (full.empty()) inertial.axes = at.rotation;
}

void Parser::finishTree() {
  constexpr size_t kPositions[] = {7, 4, 1, 1}, kVelocities[] = {6, 3, 1, 1};
  // Coordinates are numbered by bodies, wherever among its children a body's joints stand.
  for (size_t i = 1; i < out_.bodies.size(); ++i) {
    Body& body = out_.bodies[i];
    body.moves = !body.joints.empty() || out_.bodies[static_cast<size_t>(body.parent)].moves;
    body.qposAt = out_.nq;
    body.qvelAt = out_.nv;
    for (const Joint& joint : body.joints) {
      out_.nq += kPositions[static_cast<size_t>(joint.kind)];
      out_.nv += kVelocities[static_cast<size_t>(joint.kind)];
    }
    for (const Geom& geom : body.geoms) {
      if (body.moves && (geom.kind == GeomKind::Plane || geom.kind == GeomKind::HeightField)) {
        const std::string kind = geom.kind == GeomKind::Plane ? "planes" : "height fields";
        throw FileError(geom.where + ": " + kind + " are only allowed in bodies that do not move", out_.fileName);
      }
    }
  }
}

}  // namespace avbd::mjcf
