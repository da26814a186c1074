// Walks a URDF file: joints, and the tree that they make of the links.
#include <cmath>
#include <numbers>

#include "io/urdf_parser.h"

namespace avbd::urdf {

namespace {

constexpr const char* kKinds[] = {"fixed", "revolute", "continuous", "prismatic", "floating", "planar", "spherical"};

bool turnsOrSlides(JointKind kind) {
  return kind == JointKind::Revolute || kind == JointKind::Continuous || kind == JointKind::Prismatic;
}

}  // namespace

const char* nameOf(JointKind kind) { return kKinds[static_cast<size_t>(kind)]; }

JointKind Parser::readKind(Elem elem) {
  const std::string type = source_.requiredText(elem, "type");
  if (type == "ball") return JointKind::Spherical;
  std::string all;
  for (size_t i = 0; i < std::size(kKinds); ++i) {
    if (type == kKinds[i]) return static_cast<JointKind>(i);
    all += (i == 0 ? "" : ", ") + std::string(kKinds[i]);
  }
  source_.fail(elem, "type", type, "must be one of " + all);
}

int Parser::linkOf(Elem joint, const char* element) {
  const auto elem = source_.only(joint, element);
  if (!elem) source_.fail(joint, "<" + std::string(element) + "> is missing: must name a link");
  const std::string name = source_.requiredText(*elem, "link");
  const auto found = linksByName_.find(name);
  if (found != linksByName_.end()) return found->second;
  if (name != "world" || std::string_view(element) != "parent") {
    source_.fail(*elem, "link", name, "no link has this name");
  }
  return -1;  // Gazebo's convention: the world is there without being said; connect() sees to it
}

void Parser::readJoint(Elem elem) {
  Joint joint;
  joint.name = std::string(source_.text(elem, "name"));
  joint.where = source_.where(elem);
  joint.line = source_.line(elem);
  const int index = static_cast<int>(out_.joints.size());
  if (joint.name.empty()) {
    joint.name = "joint_" + std::to_string(index + 1);
    while (jointsByName_.contains(joint.name)) joint.name += "_";
    note(elem, "a joint without name");
  }
  if (!jointsByName_.emplace(joint.name, index).second) {
    source_.fail(elem, "name", joint.name, "another joint has this name");
  }
  joint.kind = readKind(elem);
  joint.parent = linkOf(elem, "parent");
  joint.child = linkOf(elem, "child");
  if (joint.parent == joint.child) {
    source_.fail(elem, "joins link " + mjcf::quoted(out_.links[static_cast<size_t>(joint.child)].name) + " to itself");
  }
  joint.pose = readOrigin(elem);
  readAxis(elem, joint);
  readLimit(elem, joint);
  readDynamics(elem, joint);
  for (const Elem& part : source_.children(elem)) {
    bool known = false;
    for (const char* name :
         {"parent", "child", "origin", "axis", "limit", "dynamics", "mimic", "safety_controller", "calibration"}) {
      known = known || part.name() == name;
    }
    if (!known) noteUnused(part, "not used");
  }
  out_.joints.push_back(std::move(joint));
  jointElems_.push_back(elem);
}

void Parser::readAxis(Elem elem, Joint& joint) {
  const auto axis = source_.only(elem, "axis");
  const bool needed = turnsOrSlides(joint.kind) || joint.kind == JointKind::Planar;
  if (!axis) {
    if (needed) note(elem, "no <axis>: URDF's default x is taken");
    return;
  }
  if (!axis->has("xyz")) source_.fail(*axis, "xyz is missing: must be 3 numbers");
  const Vec3d v = source_.vector(*axis, "xyz", {1, 0, 0});
  const double n = length(v);
  if (!(n > 1e-12)) {
    // Exporters write a zero axis for joints that have none.
    if (needed) source_.fail(*axis, "xyz", axis->get("xyz"), "must not be zero");
    return;
  }
  if (needed && std::abs(n - 1) > 0.01) note(*axis, "xyz is not of length 1: normalised");
  joint.axis = v * (1 / n);
}

void Parser::readLimit(Elem elem, Joint& joint) {
  const auto limit = source_.only(elem, "limit");
  const bool bounded = joint.kind == JointKind::Revolute || joint.kind == JointKind::Prismatic;
  if (!limit) {
    if (bounded) note(elem, std::string(nameOf(joint.kind)) + " joint without <limit>: taken as unlimited");
    return;
  }
  Limit out;
  out.lower = source_.number(*limit, "lower", 0);
  out.upper = source_.number(*limit, "upper", 0);
  out.effort = source_.number(*limit, "effort", 0);
  out.velocity = source_.number(*limit, "velocity", 0);
  for (const char* name : {"effort", "velocity"}) {
    if (source_.number(*limit, name, 0) < 0) source_.fail(*limit, name, limit->get(name), "must be finite and >= 0");
  }
  if (bounded && out.lower > out.upper) {
    note(*limit, "lower is greater than upper: swapped");
    std::swap(out.lower, out.upper);
  }
  const bool given = limit->has("lower") || limit->has("upper");
  if (bounded && !given) note(*limit, "neither lower nor upper: both are 0 by URDF's rule");
  if (joint.kind == JointKind::Continuous && given) note(*limit, "bounds of a continuous joint are not used");
  if (joint.kind == JointKind::Revolute && std::max(std::abs(out.lower), std::abs(out.upper)) > 10 * std::numbers::pi) {
    note(*limit, "bounds of more than five turns: taken as radians, but look like degrees");
  }
  if (bounded && (out.lower > 0 || out.upper < 0)) note(*limit, "position 0 is outside the bounds");
  joint.limit = out;
}

void Parser::readDynamics(Elem elem, Joint& joint) {
  if (const auto dynamics = source_.only(elem, "dynamics")) {
    joint.damping = source_.number(*dynamics, "damping", 0);
    joint.friction = source_.number(*dynamics, "friction", 0);
    for (const char* name : {"damping", "friction"}) {
      if (source_.number(*dynamics, name, 0) < 0) {
        source_.fail(*dynamics, name, dynamics->get(name), "must be finite and >= 0");
      }
    }
  }
  if (const auto safety = source_.only(elem, "safety_controller")) {
    joint.safety =
        Safety{source_.number(*safety, "soft_lower_limit", 0), source_.number(*safety, "soft_upper_limit", 0),
               source_.number(*safety, "k_position", 0), source_.number(*safety, "k_velocity", 0)};
  }
  if (const auto calibration = source_.only(elem, "calibration")) {
    Calibration out;
    if (calibration->has("rising")) out.rising = source_.number(*calibration, "rising", 0);
    if (calibration->has("falling")) out.falling = source_.number(*calibration, "falling", 0);
    joint.calibration = out;
  }
}

void Parser::readMimic(Elem elem, Joint& joint) {
  const auto mimic = source_.only(elem, "mimic");
  if (!mimic) return;
  const std::string name = source_.requiredText(*mimic, "joint");
  const double multiplier = source_.number(*mimic, "multiplier", 1), offset = source_.number(*mimic, "offset", 0);
  const auto found = jointsByName_.find(name);
  if (found == jointsByName_.end()) {
    note(*mimic, "no joint is named " + mjcf::quoted(name) + ": mimic left out");
    return;
  }
  joint.mimic = Mimic{found->second, multiplier, offset};
}

void Parser::dropMimicLoops() {
  const size_t count = out_.joints.size();
  std::vector<size_t> seen(count, count);  // by which walk
  for (size_t start = 0; start < count; ++start) {
    size_t at = start;
    while (seen[at] == count && out_.joints[at].mimic) {
      seen[at] = start;
      at = static_cast<size_t>(out_.joints[at].mimic->joint);
    }
    if (!out_.joints[at].mimic || seen[at] != start) continue;
    note(jointElems_[at], "mimics itself, perhaps through others: mimic left out");
    out_.joints[at].mimic.reset();
  }
}

void Parser::readTransmission(Elem elem) {
  Transmission out;
  out.name = std::string(source_.text(elem, "name"));
  out.type = std::string(source_.text(elem, "type"));
  if (const auto type = source_.only(elem, "type")) out.type = type->node.text().get();
  noteUnused(elem, "kept, but drives nothing");
  for (const Elem& part : source_.children(elem)) {
    if (part.name() != "joint") continue;
    const auto found = jointsByName_.find(source_.text(part, "name"));
    if (found == jointsByName_.end()) {
      note(part, "no joint has this name");
    } else {
      out.joints.push_back(found->second);
    }
  }
  out_.transmissions.push_back(std::move(out));
}

void Parser::refuseLoops(int root) const {
  std::vector<bool> reached(out_.links.size());
  for (const int link : out_.order) reached[static_cast<size_t>(link)] = true;
  for (size_t i = 0; i < reached.size(); ++i) {
    if (reached[i]) continue;
    // Upwards from a link that the root does not reach there is no end: the loop is met within so many steps.
    size_t at = i;
    const auto up = [&](size_t link) {
      return static_cast<size_t>(out_.joints[static_cast<size_t>(out_.links[link].joint)].parent);
    };
    for (size_t k = 0; k < out_.links.size(); ++k) at = up(at);
    std::string loop = mjcf::quoted(out_.links[at].name);
    int shown = 0;
    for (size_t link = up(at); link != at && ++shown < 5; link = up(link)) {
      loop = mjcf::quoted(out_.links[link].name) + " > " + loop;
    }
    const std::string beside =
        root < 0 ? "" : " apart from the root " + mjcf::quoted(out_.links[static_cast<size_t>(root)].name);
    source_.fail(linkElems_[at], "joints make a loop (" + loop + ")" + beside + ": links must make a tree");
  }
}

void Parser::attach(size_t index) {
  const Joint& joint = out_.joints[index];
  Link& child = out_.links[static_cast<size_t>(joint.child)];
  if (child.joint >= 0) {
    source_.fail(jointElems_[index], "link " + mjcf::quoted(child.name) + " has a parent already, by joint " +
                                         mjcf::quoted(out_.joints[static_cast<size_t>(child.joint)].name));
  }
  child.joint = static_cast<int>(index);
  out_.links[static_cast<size_t>(joint.parent)].children.push_back(static_cast<int>(index));
}

// A joint from a world that no <link> stands for: above the root it makes one, elsewhere it says where the robot
// stands.
void Parser::attachToWorld(size_t index) {
  Joint& joint = out_.joints[index];
  const Elem elem = jointElems_[index];
  const bool isRoot = out_.links[static_cast<size_t>(joint.child)].joint < 0;
  if (!isRoot && joint.kind == JointKind::Fixed && !out_.anchor) {
    note(elem, "no link is named \"world\": holds the robot there");
    out_.anchor = Anchor{joint.child, joint.pose};
    return;
  }
  const auto [found, isNew] = linksByName_.emplace("world", static_cast<int>(out_.links.size()));
  if (isNew) {
    note(elem, "no link is named \"world\": taken for an empty one");
    Link world;
    world.name = "world";
    world.where = source_.where(elem);
    world.line = source_.line(elem);
    out_.links.push_back(std::move(world));
    linkElems_.push_back(elem);
  }
  joint.parent = found->second;
  attach(index);
}

void Parser::connect(Elem robot) {
  for (size_t i = 0; i < out_.joints.size(); ++i) {
    if (out_.joints[i].parent >= 0) attach(i);
  }
  for (size_t i = 0; i < out_.joints.size(); ++i) {
    if (out_.joints[i].parent < 0) attachToWorld(i);
  }
  int root = -1, roots = 0;
  std::string names;
  for (size_t i = 0; i < out_.links.size(); ++i) {
    if (out_.links[i].joint >= 0) continue;
    if (root < 0) root = static_cast<int>(i);
    if (++roots <= 5) names += (roots == 1 ? "" : ", ") + mjcf::quoted(out_.links[i].name);
  }
  if (roots > 1) {
    source_.fail(robot, std::to_string(roots) + " links have no parent (" + names + (roots > 5 ? ", ..." : "") +
                            "): must be one, the root");
  }
  if (root >= 0) out_.order.push_back(root);
  for (size_t at = 0; at < out_.order.size(); ++at) {
    for (const int joint : out_.links[static_cast<size_t>(out_.order[at])].children) {
      out_.order.push_back(out_.joints[static_cast<size_t>(joint)].child);
    }
  }
  refuseLoops(root);
}

}  // namespace avbd::urdf
