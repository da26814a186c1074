// MJCF composites that are chains of bodies: ropes, loops and cables.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/mjcf_parser.h"
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

namespace {

constexpr size_t kMany = size_t{1} << 28;

// Long geoms lie along the chain.
const Quatd kZToX{std::numbers::sqrt2 / 2, 0, std::numbers::sqrt2 / 2, 0};

/// Shortest turn from one direction to another, both of length 1.
Quatd turnFromTo(Vec3d from, Vec3d to) {
  const Vec3d axis = cross(from, to);
  const double c = dot(from, to);
  if (c < -1 + 1e-12) {  // any axis across
    const Vec3d across = std::abs(from.x) < 0.7 ? cross(from, Vec3d{1, 0, 0}) : cross(from, Vec3d{0, 1, 0});
    return turnAbout(across, std::numbers::pi);
  }
  return normalized({1 + c, axis.x, axis.y, axis.z});
}

/// Frames along edges: x along each, turned from one to the next the shortest way, the first with y towards the second.
std::vector<Quatd> framesAlong(const std::vector<Vec3d>& points) {
  std::vector<Vec3d> edges;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3d e = points[i + 1] - points[i];
    edges.push_back(e * (1 / length(e)));
  }
  Quatd q = turnFromTo({1, 0, 0}, edges[0]);
  if (edges.size() > 1) {
    const Vec3d normal = cross(edges[0], edges[1]);
    if (length(normal) > 1e-9) {
      const Vec3d z = normal * (1 / length(normal));
      q = fromAxes(edges[0], cross(z, edges[0]), z);
    }
  }
  std::vector<Quatd> out{q};
  for (size_t i = 1; i < edges.size(); ++i) out.push_back(normalized(turnFromTo(edges[i - 1], edges[i]) * out.back()));
  return out;
}

}  // namespace

int Parser::addLink(const Composite& c, const std::string& number, const Posed& pose, int parent) {
  const int body = addPoint(c.prefix + "B" + number, c.where, pose, parent);
  Geom geom = c.geom;
  geom.name = c.prefix + "G" + number;
  geom.pose.rotation = kZToX;
  if (!geomByName_.emplace(geom.name, GeomRef{body, 0}).second)
    throw FileError(c.where + ": another geom has the name " + mjcf::quoted(geom.name), out_.fileName);
  out_.bodies.back().geoms.push_back(std::move(geom));
  return body;
}

// The body around it is one of its elements, the others hang on that to both sides.
void Parser::addRope(Composite& c, const OpenElem& in) {
  const bool loop = c.kind == Composite::Kind::Loop;
  needCount(c, 1, 1, loop ? 3 : 2);
  const int root = rootElement(c, in, 1)[0], count = c.count[0];
  if (loop && root != 0) source_.fail(c.elem, "the body around a loop must be its first element, " + c.prefix + "B0");
  const double half = c.spacing / 2, angle = loop ? 2 * std::numbers::pi / count : 0;
  Geom first = c.geom;
  first.name = c.prefix + "G" + std::to_string(root);
  first.pose.rotation = kZToX;
  std::vector<Geom>& geoms = out_.bodies[static_cast<size_t>(in.body)].geoms;
  geomByName_.emplace(first.name, GeomRef{in.body, geoms.size()});
  geoms.push_back(std::move(first));
  int last = in.body;
  for (const int side : {1, -1}) {
    int parent = in.body;
    for (int i = root + side; i >= 0 && i < count; i += side) {
      const Posed pose{{side * (half + half * std::cos(angle)), side * half * std::sin(angle), 0},
                       turnAbout({0, 0, 1}, angle)};
      const std::string number = std::to_string(i);
      parent = addLink(c, number, pose, parent);
      for (const Vec3d axis : {Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
        Joint joint = c.joint;
        joint.pos = {-side * half, 0, 0};
        joint.axis = axis;
        joint.name = c.prefix + (axis.y > 0 ? "J0_" : "J1_") + number;
        JointRef ref{parent, out_.bodies.back().joints.size()};
        if (jointNames_.insert(joint.name).second) jointByName_.emplace(joint.name, ref);
        out_.bodies.back().joints.push_back(std::move(joint));
      }
      if (side > 0) last = parent;
    }
  }
  if (!loop) return;
  out_.excludes.push_back({c.where, in.body, last});
  if (off_.equalities) return;
  Equality close;
  close.where = c.where;
  close.bodyA = in.body;
  close.bodyB = last;
  close.anchor = {-half, 0, 0};
  out_.equalities.push_back(std::move(close));
}

// Three functions of s from 0 to 1: s, cos(s), sin(s), or 0.
std::vector<Vec3d> Parser::curvePoints(Composite& c) {
  const Attributes& a = c.attributes;
  needCount(c, 1, 1, 2);
  const std::vector<double> size = a.numbers("size", 1, 3);
  const double along = size.empty() ? 1 : size[0], radius = size.size() > 1 ? size[1] : along,
               turns = size.size() > 2 ? size[2] : 0;
  std::vector<std::string> curve = words(a, "curve");
  if (curve.empty() || curve.size() > 3) a.fail("curve", "must be 1 to 3 of s, cos(s), sin(s), 0");
  curve.resize(3, "0");
  std::vector<Vec3d> out;
  for (int i = 0; i < c.count[0]; ++i) {
    const double s = double{1} * i / (c.count[0] - 1), angle = 2 * std::numbers::pi * turns * s;
    std::array<double, 3> v{};
    for (size_t k = 0; k < 3; ++k) {
      const std::string& f = curve[k];
      if (f != "s" && f != "cos(s)" && f != "sin(s)" && f != "0")
        a.fail("curve", "each must be s, cos(s), sin(s) or 0");
      v[k] = f == "s"        ? along * s
             : f == "cos(s)" ? radius * std::cos(angle)
             : f == "sin(s)" ? radius * std::sin(angle)
                             : 0;
    }
    out.push_back({v[0], v[1], v[2]});
  }
  return out;
}

std::vector<Vec3d> Parser::cablePoints(Composite& c) {
  const Attributes& a = c.attributes;
  std::vector<Vec3d> out;
  if (a.has("vertex")) {
    const std::vector<double> v = a.numbers("vertex", 0, kMany);
    if (v.size() < 6 || v.size() % 3 != 0) a.fail("vertex", "must be 3 numbers for each of 2 or more vertices");
    chargePoints(a, "vertex", static_cast<double>(v.size() / 3));
    for (size_t i = 0; i < v.size(); i += 3) out.push_back({v[i], v[i + 1], v[i + 2]});
  } else {
    out = curvePoints(c);
  }
  for (size_t i = 0; i + 1 < out.size(); ++i) {
    if (!(length(out[i + 1] - out[i]) > 1e-9))
      a.fail(a.has("vertex") ? "vertex" : "curve", "points that follow each other must not be at one place");
  }
  return out;
}

Geom Parser::cableGeom(const Composite& c, double size) {
  const Attributes& a = *c.geomAttributes;
  Geom geom;
  geom.where = c.geom.where;
  const int kind = a.keyword("type", {"sphere", "capsule", "cylinder", "box"}, 0);
  const std::vector<double> sizes = a.numbers("size", 1, 3);
  const size_t needed = kind == 3 ? 3 : 1;
  if (kind == 0) a.fail("type", "must be capsule, cylinder or box in a cable");
  if (sizes.size() < needed) a.fail("size", "must be " + std::to_string(needed) + " numbers, each finite and > 0");
  for (const double s : sizes)
    if (!(s > 0)) a.fail("size", "each must be finite and > 0");
  geom.kind = kind == 1 ? GeomKind::Capsule : kind == 2 ? GeomKind::Cylinder : GeomKind::Box;
  geom.size = kind == 3 ? Vec3d{size / 2, sizes[1], sizes[2]} : Vec3d{sizes[0], size / 2, 0};
  geom.pose = {{size / 2, 0, 0}, kind == 3 ? Quatd{} : kZToX};
  readSurface(a, geom);
  readColor(a, geom);
  readGeomMass(a, geom);
  return geom;
}

void Parser::addCableSite(const Composite& c, const char* name, int body, Vec3d at) {
  Site site;
  site.where = c.where;
  site.body = body;
  site.pose.position = at;
  site.zone.size = {0.005, 0.005, 0.005};
  const std::string full = c.prefix + "S_" + name;
  if (siteNames_.insert(full).second) siteByName_.emplace(full, static_cast<int>(out_.sites.size()));
  out_.sites.push_back(std::move(site));
}

void Parser::addCable(Composite& c, const OpenElem& in) {
  const Attributes& a = c.attributes;
  const int initial = a.keyword("initial", {"free", "ball", "none"}, 1);
  if (initial == 0 && in.body != 0) a.fail("initial", "free is only allowed in worldbody");
  const std::vector<Vec3d> points = cablePoints(c);
  const std::vector<Quatd> frames = framesAlong(points);
  Quatd turn;
  if (const auto v = a.numbers("quat", 4, 4); !v.empty()) turn = normalized({v[0], v[1], v[2], v[3]});
  int parent = in.body;
  const size_t links = frames.size();
  for (size_t i = 0; i < links; ++i) {
    std::string number = i == 0 ? "_first" : "_last";
    if (i > 0 && i + 1 < links) number = std::to_string(i).insert(0, 1, '_');
    Posed pose{{length(points[i] - points[i > 0 ? i - 1 : 0]), 0, 0}, frames[i]};
    if (i == 0) pose = in.frame * Posed{c.offset + rotate(turn, points[0]), normalized(turn * frames[0])};
    if (i > 0) pose.rotation = normalized(conjugate(frames[i - 1]) * frames[i]);
    const int body = addPoint(c.prefix + "B" + number, c.where, pose, parent);
    Geom geom = cableGeom(c, length(points[i + 1] - points[i]));
    geom.name = c.prefix + "G" + std::to_string(i);
    geomByName_.emplace(geom.name, GeomRef{body, 0});
    out_.bodies.back().geoms.push_back(std::move(geom));
    if (i > 0 || initial < 2) {
      Joint joint = c.joint;
      joint.name = c.prefix + "J" + number;
      if (i == 0 && initial == 0) {
        joint = {};
        joint.kind = JointKind::Free;
        joint.where = c.where;
      }
      out_.bodies.back().joints.push_back(std::move(joint));
    }
    if (i > 0) out_.excludes.push_back({c.where, parent, body});
    if (i == 0) addCableSite(c, "first", body, {});
    parent = body;
  }
  addCableSite(c, "last", parent, {length(points[links] - points[links - 1]), 0, 0});
}

}  // namespace avbd::mjcf
