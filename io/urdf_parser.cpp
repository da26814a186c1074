// Walks a URDF file: the robot, its links and their masses.
#include "io/urdf_parser.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "io/mjcf_values.h"
#include "io/urdf_math.h"

namespace avbd::urdf {

namespace {

const std::set<std::string_view> kPartsOfLink = {"inertial", "collision", "visual", "contact"};

// As the file has it (Source hides its includes).
std::string tagOf(Elem elem) {
  if (elem.name() == "Include") return "<include>";
  std::string tag(elem.name().substr(0, 60));
  tag.insert(tag.begin(), '<');
  return tag + '>';
}

}  // namespace

void Parser::noteUnused(Elem elem, const std::string& what) {
  out_.notes.add(source_.where(elem), tagOf(elem) + ": " + what);
}

void Parser::parse() {
  const Elem robot = source_.root();
  out_.name = std::string(source_.text(robot, "name"));
  if (out_.name.empty()) {
    out_.name = std::filesystem::path(out_.fileName).stem().string();
    note(robot, "the robot has no name: that of the file is taken");
  }
  const std::vector<Elem> parts = source_.children(robot);
  readMaterials(parts);
  for (const Elem& part : parts) {
    if (part.name() == "link") readLink(part);
  }
  if (out_.links.empty()) source_.fail(robot, "a robot needs at least one link");
  for (const Elem& part : parts) {
    if (part.name() == "joint") readJoint(part);
  }
  for (size_t i = 0; i < out_.joints.size(); ++i) readMimic(jointElems_[i], out_.joints[i]);
  dropMimicLoops();
  resolveMimics();
  setStarts();
  for (const Elem& part : parts) {
    const std::string_view name = part.name();
    if (name == "link" || name == "joint" || name == "material") continue;
    if (name == "transmission") {
      readTransmission(part);
    } else if (name == "gazebo") {
      readGazebo(part);
    } else if (name == "Include") {
      note(part, "<include> is not part of URDF: left out");
    } else {
      noteUnused(part, "not used");
    }
  }
  connect(robot);
}

void Parser::readLink(Elem elem) {
  Link link;
  link.name = source_.requiredText(elem, "name");
  link.where = source_.where(elem);
  link.line = source_.line(elem);
  const int index = static_cast<int>(out_.links.size());
  if (!linksByName_.emplace(link.name, index).second) {
    source_.fail(elem, "name", link.name, "another link has this name");
  }
  if (const auto inertial = source_.only(elem, "inertial")) readInertial(*inertial, link);
  link.collisions = readShapes(elem, "collision");
  link.visuals = readShapes(elem, "visual");
  if (const auto contact = source_.only(elem, "contact")) readContact(*contact, link);
  for (const Elem& part : source_.children(elem)) {
    if (!kPartsOfLink.contains(part.name())) noteUnused(part, "not used");
  }
  out_.links.push_back(std::move(link));
  linkElems_.push_back(elem);
}

Posed Parser::readOrigin(Elem parent) {
  const auto origin = source_.only(parent, "origin");
  if (!origin) return {};
  constexpr double kMostTurn = 2 * std::numbers::pi * 1.01, kMostAngle = 1e9;
  const Vec3d rpy = source_.vector(*origin, "rpy", {});
  const double most = std::max({std::abs(rpy.x), std::abs(rpy.y), std::abs(rpy.z)});
  if (most > kMostAngle) source_.fail(*origin, "rpy", origin->get("rpy"), "each must be at most 1e9 in magnitude");
  if (most > kMostTurn) note(*origin, "rpy turns by more than a full turn: taken as radians, but looks like degrees");
  for (const char* other : {"quat_xyzw", "quat", "wxyz"}) {
    if (origin->has(other)) source_.fail(*origin, other, origin->get(other), "not part of URDF: give rpy instead");
  }
  return {source_.vector(*origin, "xyz", {}), fromRollPitchYaw(rpy)};
}

void Parser::readInertial(Elem elem, Link& link) {
  const Posed pose = readOrigin(elem);
  const auto massElem = source_.only(elem, "mass");
  const auto inertiaElem = source_.only(elem, "inertia");
  for (const Elem& part : source_.children(elem)) {
    const std::string_view name = part.name();
    if (name != "mass" && name != "inertia" && name != "origin") noteUnused(part, "not used");
  }
  if (!massElem) {
    note(elem, "no <mass>: the link counts as one without <inertial>");
    return;
  }
  const double mass = source_.requiredNumber(*massElem, "value");
  if (mass < 0) source_.fail(*massElem, "value", massElem->get("value"), "must be finite and >= 0");
  if (mass == 0) {
    note(elem, "a mass of 0: the link counts as one without <inertial>");
    return;
  }
  link.mass = Mass{mass, pose.position, {}};
  if (inertiaElem) {
    link.mass->inertia = readInertia(*inertiaElem, elem, pose, link);
  } else {
    note(elem, "no <inertia>: taken from the link's collisions");
  }
}

mjcf::Sym3d Parser::readInertia(Elem elem, Elem inertial, const Posed& pose, Link& link) {
  mjcf::Sym3d m;
  const auto diagonal = [&](const char* name) {
    const double value = source_.requiredNumber(elem, name);
    if (value < 0) source_.fail(elem, name, elem.get(name), "must be finite and >= 0");
    return value;
  };
  m.xx = diagonal("ixx");
  m.yy = diagonal("iyy");
  m.zz = diagonal("izz");
  m.xy = source_.number(elem, "ixy", 0);
  m.xz = source_.number(elem, "ixz", 0);
  m.yz = source_.number(elem, "iyz", 0);
  switch (repair(m)) {
    case InertiaFault::None:
      break;
    case InertiaFault::Unset:
      note(inertial, "an inertia of 0: taken from the link's collisions");
      return {};
    case InertiaFault::Repaired:
      note(inertial,
           "no body can have this inertia (no principal moment may be negative or exceed the sum of the "
           "other two): the nearest possible one is taken");
      break;
    case InertiaFault::Hopeless:
      source_.fail(elem, "no body can have this inertia: nothing of it is positive");
  }
  link.inertiaKnown = true;
  return mjcf::rotated(m, pose.rotation);
}

void Parser::readContact(Elem elem, Link& link) {
  const std::pair<const char*, std::optional<double> Surface::*> known[] = {{"lateral_friction", &Surface::friction},
                                                                            {"rolling_friction", &Surface::rolling},
                                                                            {"spinning_friction", &Surface::spinning},
                                                                            {"restitution", &Surface::restitution}};
  for (const Elem& part : source_.children(elem)) {
    bool used = false;
    for (const auto& [name, field] : known) {
      if (part.name() != name) continue;
      const double value = source_.requiredNumber(part, "value");
      const bool bounce = field == &Surface::restitution;
      if (value < 0 || (bounce && value > 1)) {
        source_.fail(part, "value", part.get("value"), bounce ? "must be 0 .. 1" : "must be finite and >= 0");
      }
      link.surface.*field = value;
      used = true;
    }
    if (!used) noteUnused(part, "not used");
  }
}

// Gazebo keeps friction in a block of its own that names the link.
void Parser::readGazebo(Elem elem) {
  const std::string_view reference = source_.text(elem, "reference");
  const auto link = linksByName_.find(reference);
  if (!reference.empty() && link == linksByName_.end() && !jointsByName_.contains(reference)) {
    note(elem, "refers to nothing in this file: left out");
    return;
  }
  for (const Elem& part : source_.children(elem)) {
    const std::string_view name = part.name();
    if (link == linksByName_.end() || (name != "mu1" && name != "mu2")) {
      out_.notes.add(source_.where(elem), tagOf(part) + ": not used", "gazebo");
      continue;
    }
    std::vector<double> value;
    mjcf::NumberFault fault;
    // Some write <mu1 value="0.2"/>, which Gazebo itself does not read.
    const std::string_view text = part.has("value") ? source_.text(part, "value") : part.node.text().get();
    if (!mjcf::readNumbers(text, 1, value, fault) || value.size() != 1 || value[0] < 0) {
      source_.fail(part, "text", text, "must be a finite number >= 0");
    }
    std::optional<double>& friction = out_.links[static_cast<size_t>(link->second)].surface.friction;
    if (!friction) {
      friction = value[0];
    } else if (*friction != value[0]) {
      friction = std::min(*friction, value[0]);
      out_.notes.add(source_.where(elem), "several friction coefficients for one link: the smallest is taken");
    }
  }
}

Description parseText(std::string_view xml, std::string_view nameForMessages) {
  Description out;
  out.fileName = std::string(nameForMessages);
  const Source source = Source::fromText(std::string(xml), out.fileName, out.notes);
  Parser(source, out).parse();
  return out;
}

Description parseFile(const std::filesystem::path& file) {
  Description out;
  out.fileName = file.string();
  out.folder = file.parent_path();
  const Source source = Source::fromFile(file, out.notes);
  Parser(source, out).parse();
  return out;
}

namespace {

// Of the child in the joint's frame at the start.
Posed motionOf(const Joint& joint) {
  if (joint.kind == JointKind::Prismatic) return {joint.axis * joint.start, {}};
  const SinCosd half = sinCos(joint.start / 2);
  const Vec3d v = joint.axis * half.sin;
  return {{}, {half.cos, v.x, v.y, v.z}};
}

}  // namespace

std::vector<Posed> linkPoses(const Description& description) {
  std::vector<Posed> out(description.links.size());
  for (const int index : description.order) {
    const Link& link = description.links[static_cast<size_t>(index)];
    if (link.joint < 0) continue;
    const Joint& joint = description.joints[static_cast<size_t>(link.joint)];
    Posed& pose = out[static_cast<size_t>(index)];
    pose = out[static_cast<size_t>(joint.parent)] * joint.pose;
    if (joint.start != 0) pose = pose * motionOf(joint);
    pose.rotation = mjcf::normalized(pose.rotation);
  }
  if (!description.anchor) return out;
  const Anchor& anchor = *description.anchor;
  const Posed root = anchor.pose * mjcf::inverse(out[static_cast<size_t>(anchor.link)]);
  for (Posed& pose : out) pose = root * pose;
  return out;
}

}  // namespace avbd::urdf
