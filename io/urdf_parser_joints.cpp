// Walks a URDF file: joints, and the tree that they make of the links.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "io/mjcf_values.h"
#include "io/urdf_parser.h"

namespace avbd::urdf {

namespace {

constexpr const char* kKinds[] = {"fixed", "revolute", "continuous", "prismatic", "floating", "planar", "spherical"};

// Beyond these no start can be told apart from its neighbours, and bounds bound nothing.
constexpr double kMostAngle = 1e5, kMostLength = 1e6;
double mostOf(JointKind kind) { return kind == JointKind::Prismatic ? kMostLength : kMostAngle; }

}  // namespace

bool hasOneCoordinate(JointKind kind) {
  return kind == JointKind::Revolute || kind == JointKind::Continuous || kind == JointKind::Prismatic;
}

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
  const bool needed = hasOneCoordinate(joint.kind) || joint.kind == JointKind::Planar;
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
    // What could neither push nor move would be a fixed joint; exporters write 0 where nobody filled it in.
    if (limit->has(name) && source_.number(*limit, name, 0) == 0 && joint.kind != JointKind::Fixed) {
      note(*limit, std::string(name) + " of 0: taken as no bound");
    }
  }
  const bool given = limit->has("lower") || limit->has("upper");
  if (bounded && !given) note(*limit, "neither lower nor upper: both are 0 by URDF's rule");
  if (joint.kind == JointKind::Continuous && given) note(*limit, "bounds of a continuous joint are not used");
  if (joint.kind == JointKind::Planar && given) note(*limit, "bounds of a planar joint are not used");
  if (bounded) boundLimit(*limit, joint, out);
  joint.limit = out;
}

void Parser::boundLimit(Elem elem, const Joint& joint, Limit& limit) {
  if (limit.lower > limit.upper) {
    note(elem, "lower is greater than upper: swapped");
    std::swap(limit.lower, limit.upper);
  }
  const double most = std::max(std::abs(limit.lower), std::abs(limit.upper));
  if (joint.kind == JointKind::Revolute && most > 10 * std::numbers::pi) {
    note(elem, "bounds of more than five turns: taken as radians, but look like degrees");
  }
  if (limit.lower > mostOf(joint.kind) || limit.upper < -mostOf(joint.kind)) {
    source_.fail(elem, "lower or upper", elem.get(limit.lower > 0 ? "lower" : "upper"),
                 "must leave a position of at most 1e5 rad or 1e6 m in magnitude");
  }
  if (most > mostOf(joint.kind)) note(elem, "a bound of more than 1e5 rad or 1e6 m: taken as none");
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (limit.lower < -mostOf(joint.kind)) limit.lower = -kNone;
  if (limit.upper > mostOf(joint.kind)) limit.upper = kNone;
  if (limit.lower > 0 || limit.upper < 0) note(elem, "position 0 is outside the bounds: starts at the nearest one");
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
    noteUnused(*safety, "not used");
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
  const JointKind theirs = out_.joints[static_cast<size_t>(found->second)].kind;
  if (!hasOneCoordinate(joint.kind) || !hasOneCoordinate(theirs)) {
    note(*mimic, std::string("between a ") + nameOf(joint.kind) + " and a " + nameOf(theirs) +
                     " joint, where both must have one coordinate: mimic left out");
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

// Chains are followed to the joint at their end, each joint once.
void Parser::resolveMimics() {
  std::vector<bool> done(out_.joints.size());
  std::vector<size_t> chain;
  for (size_t start = 0; start < out_.joints.size(); ++start) {
    for (size_t at = start; out_.joints[at].mimic && !done[at];
         at = static_cast<size_t>(out_.joints[at].mimic->joint)) {
      chain.push_back(at);
    }
    for (; !chain.empty(); chain.pop_back()) {
      Mimic& mimic = *out_.joints[chain.back()].mimic;
      done[chain.back()] = true;
      const auto& next = out_.joints[static_cast<size_t>(mimic.joint)].mimic;
      if (next) {
        mimic = {next->joint, mimic.multiplier * next->multiplier, mimic.multiplier * next->offset + mimic.offset};
      }
      constexpr double kMost = 1e9;
      if (std::abs(mimic.multiplier) > kMost || std::abs(mimic.offset) > kMost) {
        source_.fail(jointElems_[chain.back()],
                     "mimic: multiplier and offset, of a whole chain too, must be at most 1e9");
      }
    }
  }
}

// Zero, or the bound nearest to it; what mimics follows.
void Parser::setStarts() {
  for (Joint& joint : out_.joints) {
    const bool bounded = joint.kind == JointKind::Revolute || joint.kind == JointKind::Prismatic;
    if (bounded && joint.limit) joint.start = std::clamp(0.0, joint.limit->lower, joint.limit->upper);
  }
  for (size_t i = 0; i < out_.joints.size(); ++i) {
    if (out_.joints[i].mimic) setMimicStart(i);
  }
}

void Parser::setMimicStart(size_t index) {
  Joint& joint = out_.joints[index];
  const Mimic& mimic = *joint.mimic;
  joint.start = mimic.multiplier * out_.joints[static_cast<size_t>(mimic.joint)].start + mimic.offset;
  if (std::abs(joint.start) > mostOf(joint.kind)) {
    source_.fail(jointElems_[index], "its mimic starts it beyond 1e5 rad or 1e6 m");
  }
  const bool bounded = joint.kind == JointKind::Revolute || joint.kind == JointKind::Prismatic;
  if (!bounded || !joint.limit) return;
  constexpr double kRounding = 1e-6;
  Limit& limit = *joint.limit;
  if (joint.start >= limit.lower - kRounding && joint.start <= limit.upper + kRounding) return;
  note(jointElems_[index], "its mimic starts it outside of its bounds: they are left out");
  limit.lower = -std::numeric_limits<double>::infinity();
  limit.upper = -limit.lower;
}

// Where drivers of different ages write it.
double Parser::readReduction(Elem elem, double otherwise) {
  const auto reduction = source_.only(elem, "mechanicalReduction");
  if (!reduction) return otherwise;
  std::vector<double> value;
  mjcf::NumberFault fault;
  const std::string_view text = reduction->node.text().get();
  if (!mjcf::readNumbers(text, 1, value, fault) || value.size() != 1 || value[0] == 0) {
    source_.fail(*reduction, "text", text, "must be a finite number that is not 0");
  }
  return value[0];
}

void Parser::readTransmission(Elem elem) {
  Transmission out;
  out.name = std::string(source_.text(elem, "name"));
  out.type = std::string(source_.text(elem, "type"));
  out.where = source_.where(elem);
  if (const auto type = source_.only(elem, "type")) out.type = type->node.text().get();
  const double common = readReduction(elem, 1);
  std::vector<Elem> joints, actuators;
  for (const Elem& part : source_.children(elem)) {
    if (part.name() == "joint") joints.push_back(part);
    if (part.name() == "actuator") actuators.push_back(part);
  }
  if (joints.size() > 1) note(elem, "a transmission of several joints: taken as one of each");
  if (actuators.size() > joints.size()) note(elem, "more actuators than joints: the last are left out");
  for (size_t i = 0; i < joints.size(); ++i) {
    const auto found = jointsByName_.find(source_.text(joints[i], "name"));
    if (found == jointsByName_.end()) {
      note(joints[i], "no joint has this name");
      continue;
    }
    Driven driven{found->second, std::string(found->first), readReduction(joints[i], common)};
    if (i < actuators.size()) {
      driven.reduction = readReduction(actuators[i], driven.reduction);
      if (const auto name = source_.text(actuators[i], "name"); !name.empty()) driven.actuator = name;
    }
    out.driven.push_back(std::move(driven));
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
