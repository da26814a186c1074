// MJCF flexes: what stretches between bodies, and what all kinds of flexes have in common.
#include <algorithm>
#include <cmath>

#include "io/mjcf_parser.h"
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

namespace {

constexpr size_t kMany = size_t{1} << 28;
constexpr double kTiny = 1e-9;  // [m] a vertex this near to its body's frame is there

}  // namespace

std::vector<std::string> Parser::words(const Attributes& a, std::string_view name) const {
  constexpr std::string_view kSpace = " \t\r\n";
  std::vector<std::string> out;
  const std::string text = a.text(name);
  for (size_t at = text.find_first_not_of(kSpace); at != std::string::npos; at = text.find_first_not_of(kSpace, at)) {
    const size_t end = std::min(text.find_first_of(kSpace, at), text.size());
    out.push_back(text.substr(at, end - at));
    at = end;
  }
  return out;
}

void Parser::readDeformables(Elem elem) {
  noteChildren(elem, "deformable");
  for (const Elem child : source_.children(elem)) {
    if (child.name() == "flex") readFlex(child);
  }
}

// What <flex> and <flexcomp> say in the same way.
void Parser::readFlexBase(const Attributes& a, Flex& flex) {
  flex.where = flex.surface.where = source_.where(a.elem());
  flex.name = a.text("name");
  flex.dim = a.integer("dim", 2);
  if (flex.dim < 1 || flex.dim > 3) a.fail("dim", "must be 1, 2 or 3");
  flex.radius = a.number("radius", flex.radius);
  if (flex.radius < 0) a.fail("radius", "must be finite and >= 0");
  checkReference(a, "material");
  readColor(a, flex.surface);
}

std::vector<FlexElement> Parser::flexElements(const Attributes& a, int dim, size_t points) {
  const size_t corners = static_cast<size_t>(dim) + 1;
  const std::vector<double> v = a.numbers("element", 0, kMany);
  if (v.empty() || v.size() % corners != 0) {
    a.fail("element", "must be " + std::to_string(corners) + " numbers for each element");
  }
  charge(a, "element", v.size() / corners * sizeof(FlexElement));
  std::vector<FlexElement> out;
  for (size_t i = 0; i < v.size(); i += corners) {
    FlexElement e{};
    for (size_t k = 0; k < corners; ++k) {
      if (!(v[i + k] >= 0 && v[i + k] < static_cast<double>(points) && v[i + k] == std::floor(v[i + k]))) {
        a.fail("element", "each must be a whole number 0 .. " + std::to_string(points - 1) + ", the points there are");
      }
      e[k] = static_cast<uint32_t>(v[i + k]);
      if (std::find(e.begin(), e.begin() + static_cast<ptrdiff_t>(k), e[k]) != e.begin() + static_cast<ptrdiff_t>(k)) {
        a.fail("element", "element " + std::to_string(i / corners) + " must not name a point twice");
      }
    }
    out.push_back(e);
  }
  return out;
}

void Parser::readFlex(Elem elem) {
  const Attributes a = own(elem, "flex");
  Flex flex;
  readFlexBase(a, flex);
  if (a.has("node")) {
    notes_.add(flex.where, "attribute node: flexes that are interpolated between nodes are left out", "flex");
    return;
  }
  const std::vector<std::string> names = words(a, "body");
  const std::vector<double> at = a.numbers("vertex", 0, kMany);
  if (names.empty()) a.fail("body", "must name one body, or one for each vertex");
  if (at.size() % 3 != 0) a.fail("vertex", "must be 3 numbers for each vertex");
  const size_t count = at.empty() ? names.size() : at.size() / 3;
  if (names.size() != 1 && names.size() != count) {
    a.fail("body", "names " + std::to_string(names.size()) + " bodies: must name 1, or one for each of the " +
                       std::to_string(count) + " vertices");
  }
  chargePoints(a, at.empty() ? "body" : "vertex", static_cast<double>(count));
  std::vector<int> bodies;
  for (const std::string& name : names) {
    const auto it = bodyByName_.find(name);
    if (it == bodyByName_.end() && coordinatesMissing_) {
      notes_.add(flex.where, "left out: body " + mjcf::quoted(name) + " may be among what was left out", "flex");
      return;
    }
    if (it == bodyByName_.end()) a.fail("body", "no body has the name " + mjcf::quoted(name));
    bodies.push_back(it->second);
  }
  for (size_t i = 0; i < count; ++i) {
    const Vec3d place = at.empty() ? Vec3d{} : Vec3d{at[3 * i], at[3 * i + 1], at[3 * i + 2]};
    flex.vertices.push_back({bodies[bodies.size() == 1 ? 0 : i], place});
  }
  flex.elements = flexElements(a, flex.dim, count);
  readFlexParts(elem, flex);
  addFlex(std::move(flex));
}

void Parser::readFlexParts(Elem elem, Flex& flex) {
  noteChildren(elem, "flex");
  for (const Elem child : source_.children(elem)) {
    if (child.name() == "edge") {
      const Attributes a = own(child, "flexedge");
      flex.holdsEdges = a.keyword("equality", {"false", "true", "vert", "strain"}, 0) > 0 && !off_.equalities;
      flex.edgeStiffness = notNegative(a, "stiffness");
      flex.edgeDamping = notNegative(a, "damping");
      if (flex.dim > 1) {
        for (const char* name : {"stiffness", "damping"}) {
          if (a.number(name, 0) > 0)
            notes_.add(source_.where(child), "attribute " + std::string(name) + " is not used", "flexedge");
        }
      }
    }
    if (child.name() == "elasticity") readFlexElasticity(child, flex);
    if (child.name() == "plugin") readFlexPlugin(child, flex);
    if (child.name() != "contact") continue;
    const Attributes a = own(child, "flexcontact");
    readSurface(a, flex.surface);
    flex.touchesItself = a.keyword("selfcollide", {"none", "narrow", "bvh", "sap", "auto"}, 4) > 0;
  }
}

void Parser::readFlexElasticity(Elem elem, Flex& flex) {
  const Attributes a = own(elem, "flexelasticity");
  flex.young = notNegative(a, "young");
  flex.poisson = a.number("poisson", 0);
  if (!(flex.poisson >= 0 && flex.poisson < 0.5)) a.fail("poisson", "must be >= 0 and < 0.5");
  flex.damping = notNegative(a, "damping");
  flex.thickness = std::max(a.number("thickness", 0), 0.0);
  const int kind = a.keyword("elastic2d", {"none", "bend", "stretch", "both"}, 0);
  flex.bends = kind == 1 || kind == 3;
  flex.stretches = kind >= 2;
  if (flex.dim != 2) return;
  if (kind > 0 && flex.young > 0 && !(flex.thickness > 0)) {
    a.fail("thickness", "must be finite and > 0 for elasticity of two dimensions");
  }
  if (kind == 0 && flex.young > 0) notes_.add(source_.where(elem), "elastic2d is none: young is not used");
}

// How flexes of MuJoCo 3.0 to 3.2 say what they are made of.
void Parser::readFlexPlugin(Elem elem, Flex& flex) {
  const Attributes a = own(elem, "flexplugin");
  const std::string kind = a.text("plugin");
  const bool solid = kind == "mujoco.elasticity.solid", membrane = kind == "mujoco.elasticity.membrane",
             shell = kind == "mujoco.elasticity.shell";
  if (!solid && !membrane && !shell) {
    notes_.add(source_.where(elem), "left out: plugin " + mjcf::quoted(kind), "plugin");
    return;
  }
  flex.stretches = !shell;
  flex.bends = shell;
  for (const Elem config : source_.children(elem)) {
    const Attributes c = own(config, "flexconfig");
    const std::string key = c.text("key");
    double* to = key == "young"       ? &flex.young
                 : key == "poisson"   ? &flex.poisson
                 : key == "damping"   ? &flex.damping
                 : key == "thickness" ? &flex.thickness
                                      : nullptr;
    if (!to) {
      notes_.add(source_.where(config), "config " + mjcf::quoted(key) + " is not used", "config");
      continue;
    }
    const std::vector<double> v = c.numbers("value", 1, 1);
    if (v.empty() || v[0] < 0) c.fail("value", "must be finite and >= 0");
    if (key == "poisson" && v[0] >= 0.5) c.fail("value", "must be >= 0 and < 0.5");
    *to = v[0];
  }
}

void Parser::addFlex(Flex flex) {
  if (!flex.name.empty() && !flexByName_.emplace(flex.name, out_.flexes.size()).second) {
    throw FileError(flex.where + ": name: another flex has this name", out_.fileName);
  }
  out_.flexes.push_back(std::move(flex));
}

void Parser::readFlexEquality(Elem elem) {
  const Attributes a = own(elem, "flexequality");
  nameOnce(a, equalityNames_);
  const bool active = a.flag("active", true);
  const auto it = flexByName_.find(a.requiredText("flex"));
  if (it == flexByName_.end()) {
    if (mayBeLeftOut(a, "flex")) return;
    a.fail("flex", "no flex has this name");
  }
  if (!active) {
    notes_.add(source_.where(elem), "left out: it is not active, and edges cannot be held later", "flexequality");
    return;
  }
  if (!off_.equalities) out_.flexes[it->second].holdsEdges = true;
}

// A body that is a point of mass, free to move: three slides without forces or a free joint, and nothing but a vertex.
bool Parser::isParticle(const FlexVertex& vertex, const std::vector<int>& uses) const {
  const Body& body = out_.bodies[static_cast<size_t>(vertex.body)];
  if (vertex.body == 0 || uses[static_cast<size_t>(vertex.body)] != 1 || body.mocap || !body.geoms.empty())
    return false;
  if (length(vertex.at) > kTiny) return false;
  const Inertial& inertial = inertials_[static_cast<size_t>(vertex.body)];
  if (!inertial.given || length(inertial.mass.center) > kTiny || !(inertial.mass.mass > 0)) return false;
  // What has a name may be asked for.
  if (std::any_of(body.joints.begin(), body.joints.end(), [](const Joint& joint) { return !joint.name.empty(); }))
    return false;
  if (body.joints.size() == 1 && body.joints[0].kind == JointKind::Free) return true;
  if (body.joints.size() != 3) return false;
  for (const Joint& joint : body.joints) {
    if (joint.kind != JointKind::Slide || joint.limited || joint.stiffness != 0 || joint.friction != 0 ||
        joint.armature != 0 || joint.damping != body.joints[0].damping)
      return false;
  }
  return std::abs(dot(body.joints[0].axis, cross(body.joints[1].axis, body.joints[2].axis))) > 0.99;
}

void Parser::finishFlexes() {
  std::vector<int> uses(out_.bodies.size());
  for (const Flex& flex : out_.flexes)
    for (const FlexVertex& vertex : flex.vertices) ++uses[static_cast<size_t>(vertex.body)];
  for (size_t f = 0; f < out_.flexes.size(); ++f)
    for (const FlexVertex& vertex : out_.flexes[f].vertices)
      if (isParticle(vertex, uses)) out_.bodies[static_cast<size_t>(vertex.body)].flex = static_cast<int>(f);
  // What a point carries must move by itself.
  for (size_t i = out_.bodies.size(); i-- > 1;) {
    const Body& body = out_.bodies[i];
    if (body.flex < 0) out_.bodies[static_cast<size_t>(body.parent)].flex = -1;
  }
}

}  // namespace avbd::mjcf
