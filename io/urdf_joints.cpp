// The joints of a URDF file in a world.
#include "io/urdf_joints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

#include "io/urdf_carried.h"

namespace avbd::urdf {

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

Pose toPose(const Posed& p) {
  const mjcf::Quatd q = mjcf::normalized(p.rotation);
  return {p.position,
          {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)}};
}

// Turns x to the axis and, as far as it goes, y to x and z to y: a planar joint about z moves along its own x and y.
mjcf::Quatd axesOf(const Joint& joint) {
  const Vec3d n = joint.axis;
  const bool alongX = std::abs(n.x) > 0.9;
  const Vec3d wanted = alongX ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  const Vec3d u = wanted - n * dot(n, wanted);
  const Vec3d y = u * (1 / length(u));
  return mjcf::fromAxes(n, y, mjcf::cross(n, y));
}

struct Coordinate {
  std::string name;
  JointId id;
  JointAxis axis = JointAxis::Twist;
  double start = 0, offset = 0;          // of the file's value; ours is that less the offset
  double lower = -kNone, upper = kNone;  // of the file's value
  double stiffness = 0, damping = 0;     // of what holds it
  double effort = kNone;                 // [N, N m]
};

class Articulation {
 public:
  Articulation(const Placed& placed, bool limp, Model& model, Notes& notes)
      : in_(placed.in),
        placed_(placed),
        limp_(limp),
        model_(model),
        notes_(notes),
        carried_(placed.in, placed.groups, placed.poses),
        followers_(placed.in.joints.size()),
        coordinates_(placed.in.joints.size()) {}
  void add();

 private:
  void addJoint(size_t index);
  template <class Def>
  void addOneAxis(size_t index, Def def, JointAxis axis);
  void addPlanar(size_t index, D6Joint def);
  void addBall(const Joint& joint, BodyId a, BodyId b);
  D6Axis axisOf(size_t index, Coordinate& coordinate);
  double inertiaOf(size_t index, JointAxis axis) const;
  void gatherFollowers();
  void hold(size_t index, Coordinate& coordinate);
  void separateFromAbove(size_t child);
  void addMimic(size_t index);
  void addTransmission(const Transmission& transmission);
  void addActuator(const Coordinate& coordinate);
  std::string freeName(std::string name);

  Pose frameIn(size_t link, const Posed& pose) const {
    return toPose(inBody(placed_.groups, placed_.poses, link) * pose);
  }
  BodyId bodyOf(int link) const { return placed_.ids[placed_.groups.bodyOf[static_cast<size_t>(link)]]; }
  float narrow(double value, const Joint& joint) const;
  template <class F>
  auto at(const Joint& joint, const F& make) const {
    try {
      return make();
    } catch (const Error& error) {
      throw FileError(joint.where + ": " + error.what(), in_.fileName, joint.line);
    }
  }

  const Description& in_;
  const Placed& placed_;
  bool limp_;
  Model& model_;
  Notes& notes_;
  Carried carried_;
  std::vector<double> followers_;                     // by joint: the inertia of what mimics it, as it feels it
  std::vector<std::vector<Coordinate>> coordinates_;  // by joint; empty: it is none of the world's
  std::set<std::string> names_;                       // of actuators
};

float Articulation::narrow(double value, const Joint& joint) const {
  if (std::isinf(value)) return static_cast<float>(value);
  if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
    throw FileError(joint.where + ": a number that follows from it is beyond the range of float", in_.fileName,
                    joint.line);
  }
  return static_cast<float>(value);
}

// [kg, kg m^2] With the other joints as they are.
double Articulation::inertiaOf(size_t index, JointAxis axis) const {
  if (axis != JointAxis::Twist) return carried_.along(index);
  const Joint& joint = in_.joints[index];
  return carried_.about(index, rotate(placed_.poses[static_cast<size_t>(joint.child)].rotation, joint.axis));
}

void Articulation::gatherFollowers() {
  for (size_t i = 0; i < in_.joints.size(); ++i) {
    const Joint& joint = in_.joints[i];
    if (!joint.mimic || placed_.groups.welded[i]) continue;
    const JointAxis axis = joint.kind == JointKind::Prismatic ? JointAxis::LinearX : JointAxis::Twist;
    const double ratio = joint.mimic->multiplier;
    followers_[static_cast<size_t>(joint.mimic->joint)] += ratio * ratio * inertiaOf(i, axis);
  }
}

// So that all drives have the same frequency, whatever hangs on their joints.
void Articulation::hold(size_t index, Coordinate& c) {
  const double inertia = inertiaOf(index, c.axis) + followers_[index];
  const double omega = 2 * std::numbers::pi * kHoldFrequency;
  c.stiffness = omega * omega * inertia;
  c.damping = 2 * omega * inertia;
}

D6Axis Articulation::axisOf(size_t index, Coordinate& c) {
  const Joint& joint = in_.joints[index];
  const auto f = [&](double v) { return narrow(v, joint); };
  constexpr double kMostVelocity = 1e6;  // beyond it nothing is bounded
  D6Axis axis;
  axis.motion = AxisMotion::Free;
  axis.friction = f(joint.friction);
  axis.spring.damping = f(joint.damping);
  if (joint.limit) {
    const bool bounded = joint.kind == JointKind::Revolute || joint.kind == JointKind::Prismatic;
    if (bounded) c.lower = joint.limit->lower, c.upper = joint.limit->upper;
    if (joint.limit->effort > 0) c.effort = joint.limit->effort;
    const double velocity = joint.limit->velocity;
    if (velocity > 0 && velocity < kMostVelocity) axis.maxVelocity = f(velocity);
  }
  axis.limit.lower = f(c.lower - c.offset);
  axis.limit.upper = f(c.upper - c.offset);
  if (joint.mimic) return axis;  // what it follows is held
  hold(index, c);
  if (limp_ || !(c.stiffness > 0)) return axis;
  axis.drive.stiffness = f(c.stiffness);
  axis.drive.damping = f(c.damping);
  axis.drive.position = f(c.start - c.offset);
  axis.drive.maxForce = f(c.effort);
  return axis;
}

template <class Def>
void Articulation::addOneAxis(size_t index, Def def, JointAxis axis) {
  const Joint& joint = in_.joints[index];
  Coordinate c;
  c.name = joint.name;
  c.axis = axis;
  c.start = joint.start;
  constexpr double kTurn = 2 * std::numbers::pi;
  if (axis == JointAxis::Twist) c.offset = std::floor(joint.start / kTurn + 0.5) * kTurn;
  const D6Axis free = axisOf(index, c);
  def.limit = free.limit;
  def.drive = free.drive;
  def.friction = free.friction;
  def.spring = free.spring;
  def.maxVelocity = free.maxVelocity;
  c.id = at(joint, [&] { return model_.world.create(def); });
  coordinates_[index] = {c};
}

void Articulation::addPlanar(size_t index, D6Joint def) {
  const Joint& joint = in_.joints[index];
  constexpr std::pair<JointAxis, const char*> kAxes[] = {
      {JointAxis::LinearY, "/x"}, {JointAxis::LinearZ, "/y"}, {JointAxis::Twist, "/theta"}};
  std::vector<Coordinate> all;
  for (const auto& [axis, name] : kAxes) {
    Coordinate c;
    c.name = joint.name + name;
    c.axis = axis;
    def.axes[static_cast<size_t>(axis)] = axisOf(index, c);
    all.push_back(c);
  }
  const JointId id = at(joint, [&] { return model_.world.create(def); });
  for (Coordinate& c : all) c.id = id;
  coordinates_[index] = std::move(all);
}

void Articulation::addBall(const Joint& joint, BodyId a, BodyId b) {
  BallJoint def;
  def.bodyA = a, def.bodyB = b;
  def.frameA = frameIn(static_cast<size_t>(joint.parent), joint.pose);
  def.frameB = frameIn(static_cast<size_t>(joint.child), {});
  at(joint, [&] { return model_.world.create(def); });
  notes_.add(joint.where, "spherical joint: not part of URDF: taken for a ball joint");
}

void Articulation::addJoint(size_t index) {
  const Joint& joint = in_.joints[index];
  if (placed_.groups.welded[index] || !joins(joint)) return;
  const BodyId a = bodyOf(joint.parent), b = bodyOf(joint.child);
  if (!a || !b) {
    notes_.add(joint.where, "joins a link that is no body: left out");
    return;
  }
  const Posed axes{{}, axesOf(joint)};
  const Pose frameA = frameIn(static_cast<size_t>(joint.parent), joint.pose * axes),
             frameB = frameIn(static_cast<size_t>(joint.child), axes);
  switch (joint.kind) {
    case JointKind::Revolute:
    case JointKind::Continuous:
      addOneAxis(index, HingeJoint{.bodyA = a, .bodyB = b, .frameA = frameA, .frameB = frameB}, JointAxis::Twist);
      break;
    case JointKind::Prismatic:
      addOneAxis(index, SliderJoint{.bodyA = a, .bodyB = b, .frameA = frameA, .frameB = frameB}, JointAxis::LinearX);
      break;
    case JointKind::Planar:
      addPlanar(index, D6Joint{.bodyA = a, .bodyB = b, .frameA = frameA, .frameB = frameB});
      break;
    default:
      addBall(joint, a, b);
  }
  separateFromAbove(placed_.groups.bodyOf[static_cast<size_t>(joint.child)]);
  for (const Coordinate& c : coordinates_[index]) {
    model_.joints.push_back({.name = c.name, .id = c.id, .axis = c.axis, .offset = c.offset});
  }
}

// A frame without shapes between two bodies does not make them strangers.
void Articulation::separateFromAbove(size_t child) {
  const Groups& groups = placed_.groups;
  const auto bodyAbove = [&](size_t body) -> std::optional<size_t> {
    const int joint = in_.links[body].joint;
    if (joint < 0 || !joins(in_.joints[static_cast<size_t>(joint)])) return {};
    return groups.bodyOf[static_cast<size_t>(in_.joints[static_cast<size_t>(joint)].parent)];
  };
  std::optional<size_t> above = bodyAbove(child);
  if (above && groups.hasShapes[*above]) return;  // the joint sees to it
  while (above && !groups.hasShapes[*above]) above = bodyAbove(*above);
  if (above && placed_.ids[*above]) model_.world.excludeCollision(placed_.ids[*above], placed_.ids[child]);
}

void Articulation::addMimic(size_t index) {
  const Joint& joint = in_.joints[index];
  if (!joint.mimic || coordinates_[index].empty()) return;
  const std::vector<Coordinate>& theirs = coordinates_[static_cast<size_t>(joint.mimic->joint)];
  if (theirs.empty()) {
    notes_.add(joint.where, "mimics a joint that is left out: mimic left out");
    return;
  }
  const Coordinate &c = coordinates_[index][0], &from = theirs[0];
  const double multiplier = joint.mimic->multiplier, offset = joint.mimic->offset + multiplier * from.offset - c.offset;
  const Coupling def = mimic(c.id, from.id, narrow(-multiplier, joint), narrow(-offset, joint), c.axis, from.axis);
  at(joint, [&] { return model_.world.create(def); });
}

std::string Articulation::freeName(std::string name) {
  while (!names_.insert(name).second) name += "_";
  return name;
}

void Articulation::addTransmission(const Transmission& transmission) {
  for (const Driven& driven : transmission.driven) {
    const Joint& joint = in_.joints[static_cast<size_t>(driven.joint)];
    const std::vector<Coordinate>& moved = coordinates_[static_cast<size_t>(driven.joint)];
    if (moved.size() != 1) {
      notes_.add(transmission.where,
                 std::string("its joint is ") +
                     (moved.empty() && hasOneCoordinate(joint.kind) ? "welded" : nameOf(joint.kind)) +
                     ": no actuator is made");
      continue;
    }
    const Coordinate& c = moved[0];
    Actuator actuator;
    actuator.name = freeName(driven.actuator);
    actuator.joint = c.id, actuator.axis = c.axis, actuator.offset = c.offset;
    actuator.gear = driven.reduction;
    actuator.maxForce = c.effort / std::abs(driven.reduction);
    model_.actuators.push_back(std::move(actuator));
  }
}

// What holds the coordinate, with the place to hold it as control; of a limp robot a force.
void Articulation::addActuator(const Coordinate& c) {
  Actuator actuator;
  actuator.name = freeName(c.name);
  actuator.joint = c.id, actuator.axis = c.axis, actuator.offset = c.offset;
  actuator.maxForce = c.effort;
  if (!limp_) {
    actuator.gain = c.stiffness;
    actuator.bias[1] = -c.stiffness;
    actuator.bias[2] = -c.damping;
    actuator.control = c.start;
    if (std::isfinite(c.lower) || std::isfinite(c.upper)) actuator.controlRange = {c.lower, c.upper};
  }
  model_.actuators.push_back(std::move(actuator));
}

void Articulation::add() {
  gatherFollowers();
  for (size_t i = 0; i < in_.joints.size(); ++i) addJoint(i);
  for (size_t i = 0; i < in_.joints.size(); ++i) addMimic(i);
  std::set<int> driven;
  for (const Transmission& transmission : in_.transmissions) {
    addTransmission(transmission);
    for (const Driven& d : transmission.driven) driven.insert(d.joint);
  }
  for (size_t i = 0; i < in_.joints.size(); ++i) {
    if (in_.joints[i].mimic || driven.contains(static_cast<int>(i))) continue;
    for (const Coordinate& c : coordinates_[i]) addActuator(c);
  }
}

}  // namespace

void addJoints(const Placed& placed, bool limp, Model& model, Notes& notes) {
  Articulation(placed, limp, model, notes).add();
}

}  // namespace avbd::urdf
