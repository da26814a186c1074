// Articulations: placing, moving and driving them (articulation.h).
#include <avbd/articulation.h>
#include <avbd/world.h>

#include <optional>

#include "api/articulation_check.h"
#include "api/articulation_joint.h"
#include "api/articulation_placed.h"
#include "world/limits.h"

namespace avbd {

using namespace articulation;

namespace {

/// What the links get, in the order of links().
struct LinkStates {
  std::vector<Pose> poses;
  std::vector<Velocity> velocities;
};

/// Refuses what World::setPose and setVelocity would, before anything has changed.
LinkStates checkedLinks(const Path& call, const World& world, const Articulation& tree,
                        const ArticulationState& state) {
  LinkStates out;
  const float unit = world.definition().lengthUnit;
  const Placed placed = place(world, tree, state);
  const Path path = call / "links";
  for (size_t i = 0; i < placed.links.size(); ++i) {
    const PlacedLink& link = placed.links[i];
    const Path at = path[i];
    out.poses.push_back(checkedPose(at / "pose", articulation::toFloat(link.frame), kMaxPosition * unit));
    out.velocities.push_back({avbd::toFloat(link.velocity.linear), avbd::toFloat(link.velocity.angular)});
    checkVelocity(at / "velocity", out.velocities.back(), unit);
  }
  return out;
}

void moveLinks(World& world, const Articulation& tree, const LinkStates& to) {
  for (size_t i = 0; i < to.velocities.size(); ++i) world.setVelocity(tree.links()[i].body, to.velocities[i]);
}

void placeLinks(World& world, const Articulation& tree, const LinkStates& to) {
  for (size_t i = 0; i < to.poses.size(); ++i) world.setPose(tree.links()[i].body, to.poses[i]);
  moveLinks(world, tree, to);
}

}  // namespace

void Articulation::setState(World& world, const ArticulationState& state) const {
  const Path path("Articulation::setState");
  placeLinks(world, *this, checkedLinks(path, world, *this, checkedState(path, world, *this, state)));
}

void Articulation::setPositions(World& world, std::span<const double> positions) const {
  const Path path("Articulation::setPositions");
  checkNumbers(path / "positions", positions, *this, Kind::Positions, world.definition().lengthUnit);
  ArticulationState to = state(world);
  to.positions.assign(positions.begin(), positions.end());
  placeLinks(world, *this, checkedLinks(path, world, *this, to));
}

void Articulation::setVelocities(World& world, std::span<const double> velocities) const {
  const Path path("Articulation::setVelocities");
  checkNumbers(path / "velocities", velocities, *this, Kind::Velocities, world.definition().lengthUnit);
  ArticulationState to = state(world);
  to.velocities.assign(velocities.begin(), velocities.end());
  moveLinks(world, *this, checkedLinks(path, world, *this, to));
}

void Articulation::setBasePose(World& world, const Pose& pose) const {
  const Path path("Articulation::setBasePose");
  if (!floating_) (path / "base").refuse("fixed", "must be floating");
  ArticulationState to = state(world);
  to.base = checkedPose(path / "pose", pose, kMaxPosition * static_cast<double>(world.definition().lengthUnit));
  placeLinks(world, *this, checkedLinks(path, world, *this, to));
}

namespace {

Vec3d threeOf(std::span<const double> values) { return {values[0], values[1], values[2]}; }

bool isBall(const World& world, const ArticulationLink& link) {
  return link.joint && world.type(link.joint) == JointType::Ball;
}

/// Of a ball, along A's axes: what it is in the world.
Vec3 torqueOnB(const World& world, const JointModel& joint, Vec3d effort) {
  const BodyId a = joint.ends.a;
  const Quatd body = a ? toDouble(world.pose(a)).rotation : Quatd{};
  return avbd::toFloat(rotate(body * joint.frameA.rotation, effort));
}

/// Of a ball: on both its bodies.
void addTorques(World& world, JointId id, Vec3d onB) {
  const JointModel joint = readJoint(world, id);
  const BodyId a = joint.ends.a, b = joint.ends.b;
  const Vec3 torque = torqueOnB(world, joint, onB);
  if (b && world.type(b) == BodyType::Dynamic) world.addTorque(b, torque);
  if (a && world.type(a) == BodyType::Dynamic) world.addTorque(a, -torque);
}

}  // namespace

void Articulation::addEfforts(World& world, std::span<const double> efforts) const {
  const Path call("Articulation::addEfforts"), path = call / "efforts";
  checkForces(path, efforts, dofCount());
  checkLinks(call, world, *this);
  const auto ownOf = [&](const ArticulationLink& link) {
    return efforts.subspan(static_cast<size_t>(link.firstDof), static_cast<size_t>(link.dofCount));
  };
  for (const ArticulationLink& link : links_)
    if (isBall(world, link))
      check(path[static_cast<size_t>(link.firstDof)],
            torqueOnB(world, readJoint(world, link.joint), threeOf(ownOf(link))), symmetric(kMaxForce));
  for (const ArticulationLink& link : links_) {
    if (link.dofCount == 0) continue;
    const auto own = ownOf(link);
    if (!link.joint) {
      world.addForce(link.body, avbd::toFloat(threeOf(own)));
      world.addTorque(link.body, avbd::toFloat(threeOf(own.subspan(3))));
    } else if (isBall(world, link)) {
      addTorques(world, link.joint, threeOf(own));
    } else {
      for (size_t i = 0; i < own.size(); ++i) {
        const JointAxis axis = dofs_[static_cast<size_t>(link.firstDof) + i].axis;
        world.addJointForce(link.joint, axis, static_cast<float>(own[i]));
      }
    }
  }
}

namespace {

JointDrive driveOf(const World& world, JointId id, JointAxis axis) {
  switch (world.type(id)) {
    case JointType::Hinge:
      return world.hingeJoint(id).drive;
    case JointType::Slider:
      return world.sliderJoint(id).drive;
    default:
      return world.d6Joint(id).axes[static_cast<size_t>(axis)].drive;
  }
}

/// Numbers of one joint.
struct Target {
  std::span<const double> positions, velocities;  ///< velocities may be none
};

/// Where a D6 joint turns by its slerp drive.
std::optional<SlerpDrive> slerpTarget(const World& world, JointId id, const Target& to) {
  if (world.type(id) != JointType::D6) return {};
  SlerpDrive slerp = world.d6Joint(id).slerp;
  if (!(slerp.stiffness > 0 || slerp.damping > 0)) return {};
  const JointModel joint = readJoint(world, id);
  slerp.rotation = articulation::toFloat(relativePose(joint, to.positions)).rotation;
  if (!to.velocities.empty())
    slerp.velocity = avbd::toFloat(subspace(joint, to.positions, to.velocities).velocity.angular);
  return slerp;
}

void setTarget(World& world, JointId id, std::span<const ArticulationDof> dofs, const Target& to) {
  const std::optional<SlerpDrive> slerp = slerpTarget(world, id, to);
  if (slerp) world.setSlerp(id, *slerp);
  for (size_t i = 0; i < dofs.size(); ++i) {
    if (slerp && dofs[i].axis >= JointAxis::Twist) continue;
    JointDrive drive = driveOf(world, id, dofs[i].axis);
    drive.position = static_cast<float>(to.positions[i]);
    if (!to.velocities.empty()) drive.velocity = static_cast<float>(to.velocities[i]);
    world.setDrive(id, dofs[i].axis, drive);
  }
}

}  // namespace

void Articulation::setDriveTargets(World& world, std::span<const double> positions,
                                   std::span<const double> velocities) const {
  const Path path("Articulation::setDriveTargets");
  const float unit = world.definition().lengthUnit;
  checkNumbers(path / "positions", positions, *this, Kind::Positions, unit);
  if (!velocities.empty()) checkNumbers(path / "velocities", velocities, *this, Kind::Velocities, unit);
  checkLinks(path, world, *this);
  const auto targetOf = [&](const ArticulationLink& link) {
    const size_t first = static_cast<size_t>(link.firstDof), count = static_cast<size_t>(link.dofCount);
    Target to{positions.subspan(first - (floating_ ? 6 : 0), count), {}};
    if (!velocities.empty()) to.velocities = velocities.subspan(first, count);
    return to;
  };
  const auto isDriven = [&](const ArticulationLink& link) {
    return link.joint && link.dofCount > 0 && !isBall(world, link);
  };
  for (const ArticulationLink& link : links_)
    if (const auto slerp = isDriven(link) ? slerpTarget(world, link.joint, targetOf(link)) : std::nullopt)
      checkSlerpDrive(path / "slerp", *slerp);
  for (const ArticulationLink& link : links_)
    if (isDriven(link)) {
      const size_t first = static_cast<size_t>(link.firstDof), count = static_cast<size_t>(link.dofCount);
      setTarget(world, link.joint, std::span(dofs_).subspan(first, count), targetOf(link));
    }
}

}  // namespace avbd
