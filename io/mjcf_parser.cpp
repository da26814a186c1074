// MJCF sections: root, compiler, option, assets' names.
#include "io/mjcf_parser.h"

#include <cmath>

#include "io/mjcf_schema.h"

namespace avbd::mjcf {

Description parseFile(const std::filesystem::path& file) { return Parser(XmlSource::fromFile(file)).run(); }

Description parseText(std::string_view xml, std::string_view nameForMessages) {
  return Parser(XmlSource::fromText(xml, nameForMessages)).run();
}

Attributes Parser::own(Elem elem, std::string_view element) {
  checkAttributes(source_, elem, element, notes_);
  std::vector<Attr> attrs;
  for (const pugi::xml_attribute a : elem.node.attributes()) {
    if (findRule(element, a.name())) attrs.push_back({a.name(), a.value(), elem});
  }
  return Attributes(source_, elem, std::move(attrs));
}

Description Parser::run() {
  readRoot();
  // MuJoCo's order, whatever the order in the file: settings, then classes, then what uses them, then what refers to
  // it.
  forSection("compiler", [&](Elem e) { readCompiler(e); });
  forSection("option", [&](Elem e) { readOption(e); });
  forSection("default", [&](Elem e) { defaults_.read(e, notes_); });
  forSection("asset", [&](Elem e) { readAssets(e); });
  Body world;
  world.name = "world";
  world.where = source_.fileName(source_.root()) + ": worldbody";
  out_.bodies.push_back(std::move(world));
  inertials_.emplace_back();
  bodyElems_.push_back(source_.root());
  forSection("worldbody", [&](Elem e) { readBodies(e); });
  forSection("deformable", [&](Elem e) { readDeformables(e); });
  finishTree();
  finishFlexes();
  finishMasses();
  forSection("contact", [&](Elem e) { readContact(e); });
  forSection("tendon", [&](Elem e) { readTendons(e); });
  forSection("actuator", [&](Elem e) { readActuators(e); });
  forSection("sensor", [&](Elem e) { readSensors(e); });
  forSection("equality", [&](Elem e) { readEqualities(e); });
  forSection("keyframe", [&](Elem e) { readKeys(e); });
  out_.notes = notes_.lines();
  return std::move(out_);
}

void Parser::forSection(std::string_view name, const std::function<void(Elem)>& read) {
  for (const Elem elem : source_.children(source_.root())) {
    if (elem.name() == name) read(elem);
  }
}

void Parser::noteChildren(Elem section, std::string_view sectionName) {
  for (const Elem child : source_.children(section)) {
    const Section use = sectionOf(sectionName, child.name());
    if (use == Section::Noted) {
      const bool drawing = sectionName == "asset";
      notes_.add(source_.where(child), drawing ? "not used: only for drawing" : "ignored", child.name());
    } else if (use == Section::Unknown) {
      notes_.add(source_.where(child), "unknown element", child.name());
    }
  }
}

void Parser::readRoot() {
  const Elem root = source_.root();
  out_.fileName = source_.fileName(root);
  if (root.name() != "mujoco") {
    const bool urdf = root.name() == "robot";
    source_.fail(root,
                 "not an MJCF file: its root element must be <mujoco>" + std::string(urdf ? " (this is URDF)" : ""));
  }
  out_.name = own(root, "mujoco").text("model");
  noteChildren(root, "mujoco");
}

void Parser::readCompiler(Elem elem) {
  const Attributes a = own(elem, "compiler");
  noteChildren(elem, "compiler");
  compiler_.degrees = a.keyword("angle", {"radian", "degree"}, compiler_.degrees ? 1 : 0) == 1;
  if (a.keyword("coordinate", {"local", "global"}, 0) == 1) {
    a.fail("coordinate", "only local is supported; coordinates of bodies must be relative to their parents");
  }
  if (a.has("eulerseq")) {
    const std::string order = a.text("eulerseq");
    if (order.size() != 3 || order.find_first_not_of("xyzXYZ") != std::string::npos) {
      a.fail("eulerseq", "must be three letters out of x, y, z, X, Y, Z");
    }
    compiler_.eulerOrder = order;
  }
  compiler_.inertiaFromGeom = static_cast<FromGeoms>(
      a.keyword("inertiafromgeom", {"false", "true", "auto"}, static_cast<int>(compiler_.inertiaFromGeom)));
  if (const auto range = a.numbers("inertiagrouprange", 2, 2); !range.empty()) {
    compiler_.groupFirst = range[0];
    compiler_.groupLast = range[1];
  }
  compiler_.boundMass = a.number("boundmass", compiler_.boundMass);
  if (compiler_.boundMass < 0) a.fail("boundmass", "must be finite and >= 0");
  compiler_.boundInertia = a.number("boundinertia", compiler_.boundInertia);
  if (compiler_.boundInertia < 0) a.fail("boundinertia", "must be finite and >= 0");
  compiler_.balanceInertia = a.flag("balanceinertia", compiler_.balanceInertia);
  if (a.has("assetdir")) compiler_.meshFolder = a.text("assetdir");
  if (a.has("meshdir")) compiler_.meshFolder = a.text("meshdir");
  compiler_.autoLimits = a.flag("autolimits", compiler_.autoLimits);
  compiler_.stripPath = a.flag("strippath", compiler_.stripPath);
  compiler_.fitAabb = a.flag("fitaabb", compiler_.fitAabb);
  compiler_.exactMeshInertia = a.flag("exactmeshinertia", compiler_.exactMeshInertia);
  compiler_.setTotalMass = a.number("settotalmass", compiler_.setTotalMass);
}

void Parser::readOption(Elem elem) {
  const Attributes a = own(elem, "option");
  noteChildren(elem, "option");
  out_.dt = a.number("timestep", out_.dt);
  if (!(out_.dt > 0 && out_.dt <= 1)) a.fail("timestep", "must be > 0 and <= 1 (seconds)");
  out_.gravity = vector(a, "gravity", out_.gravity);
  if (length(out_.gravity) > 1e6) a.fail("gravity", "must be at most 1e6 m/s^2");
  out_.magneticFlux = vector(a, "magnetic", out_.magneticFlux);
  const int collision = a.keyword("collision", {"all", "predefined", "dynamic"}, 0);
  if (collision == 1) {
    out_.contactsOff = true;
    notes_.add(source_.where(elem), "collision is predefined: only contact pairs collide");
  }
  if (collision == 2) out_.pairsOff = true;
  for (const Elem child : source_.children(elem)) {
    if (child.name() == "flag") readFlag(child);
  }
}

void Parser::readFlag(Elem elem) {
  const Attributes a = own(elem, "flag");
  const bool constraints = a.enabled("constraint");
  if (!constraints || !a.enabled("contact")) {
    out_.contactsOff = out_.pairsOff = true;
    notes_.add(source_.where(elem), "contacts are disabled: nothing collides");
  }
  if (!constraints || !a.enabled("equality")) {
    off_.equalities = true;
    notes_.add(source_.where(elem), "equality constraints are disabled");
  }
  const bool passive = a.enabled("passive");  // of versions that have no flags for springs and dampers
  off_.limits = off_.limits || !constraints || !a.enabled("limit");
  off_.frictions = off_.frictions || !constraints || !a.enabled("frictionloss");
  off_.springs = off_.springs || !passive || !a.enabled("spring");
  off_.dampers = off_.dampers || !passive || !a.enabled("damper");
  off_.controlRanges = off_.controlRanges || !a.enabled("clampctrl");
  off_.actuators = off_.actuators || !a.enabled("actuation");
  off_.sensors = off_.sensors || !a.enabled("sensor");
  if (!a.enabled("gravity")) out_.gravity = {};
  if (!a.enabled("filterparent")) out_.filterParent = false;
}

void Parser::readAssets(Elem elem) {
  noteChildren(elem, "asset");
  for (const Elem child : source_.children(elem)) {
    std::string name(child.get("name"));
    if (name.empty()) name = std::filesystem::path(std::string(child.get("file"))).stem().string();
    const std::string kind(child.name());
    if (!name.empty() && !assets_[kind].insert(name).second) {
      source_.fail(child, "name", name, "another " + kind + " has this name");
    }
    if (kind == "mesh") readMesh(child);
    if (kind == "hfield") readHeights(child);
    if (kind == "material") readMaterial(child);
  }
}

}  // namespace avbd::mjcf
