// Articulations: making, and reading their state (articulation.h).
#include <avbd/articulation.h>
#include <avbd/world.h>

#include "api/articulation_check.h"
#include "api/articulation_joint.h"
#include "api/articulation_placed.h"
#include "api/articulation_tree.h"

namespace avbd {

using namespace articulation;

Articulation::Articulation(const World& world, std::span<const JointId> joints) {
  layOut(world, treeOf(world, joints));
}

Articulation::Articulation(const World& world, BodyId root) { layOut(world, treeOf(world, root)); }

void Articulation::layOut(const World& world, Tree tree) {
  links_ = std::move(tree.links), loopJoints_ = std::move(tree.loopJoints), floating_ = tree.floating;
  for (size_t i = 0; i < links_.size(); ++i) {
    ArticulationLink& link = links_[i];
    link.firstDof = static_cast<int>(dofs_.size());
    const int at = static_cast<int>(i);
    if (!link.joint) {
      for (int k = 0; k < 6; ++k) dofs_.push_back({at, static_cast<JointAxis>(k)});
    } else {
      const JointModel joint = readJoint(world, link.joint);
      for (int k = 0; k < joint.count; ++k) dofs_.push_back({at, joint.axes[static_cast<size_t>(k)]});
    }
    link.dofCount = static_cast<int>(dofs_.size()) - link.firstDof;
  }
}

size_t Articulation::linkOf(BodyId body) const {
  for (size_t i = 0; i < links_.size(); ++i)
    if (links_[i].body == body) return i;
  (Path("Articulation::linkOf") / "body").refuse(toText(body), "must name a body of the articulation");
}

namespace {

/// Frame A and B of a joint as they stand.
Posed standing(const World& world, BodyId body, const Posed& frame) {
  return body ? toDouble(world.pose(body)) * frame : frame;
}

Vec3d spinOf(const World& world, BodyId body) { return body ? avbd::toDouble(world.velocity(body).angular) : Vec3d{}; }

void append(std::vector<double>& out, Vec3d v) { out.insert(out.end(), {v.x, v.y, v.z}); }

Vec3d ballPosition(const World& world, const JointModel& joint) {
  const Quatd a = standing(world, joint.ends.a, joint.frameA).rotation;
  return rotationVectorOf(conjugate(a) * standing(world, joint.ends.b, joint.frameB).rotation);
}

Vec3d ballVelocity(const World& world, const JointModel& joint) {
  const Quatd a = standing(world, joint.ends.a, joint.frameA).rotation;
  return rotate(conjugate(a), spinOf(world, joint.ends.b) - spinOf(world, joint.ends.a));
}

bool isBall(const World& world, const ArticulationLink& link) {
  return link.joint && world.type(link.joint) == JointType::Ball;
}

}  // namespace

std::vector<double> Articulation::positions(const World& world) const {
  std::vector<double> out;
  for (const ArticulationLink& link : links_) {
    if (!link.joint) continue;
    if (isBall(world, link)) {
      append(out, ballPosition(world, readJoint(world, link.joint)));
      continue;
    }
    for (int i = 0; i < link.dofCount; ++i)
      out.push_back(world.coordinate(link.joint, dofs_[static_cast<size_t>(link.firstDof + i)].axis).position);
  }
  return out;
}

std::vector<double> Articulation::velocities(const World& world) const {
  std::vector<double> out;
  for (const ArticulationLink& link : links_) {
    if (!link.joint) {
      const Velocity velocity = world.velocity(link.body);
      append(out, avbd::toDouble(velocity.linear)), append(out, avbd::toDouble(velocity.angular));
      continue;
    }
    if (isBall(world, link)) {
      append(out, ballVelocity(world, readJoint(world, link.joint)));
      continue;
    }
    for (int i = 0; i < link.dofCount; ++i)
      out.push_back(world.coordinate(link.joint, dofs_[static_cast<size_t>(link.firstDof + i)].axis).velocity);
  }
  return out;
}

ArticulationState Articulation::state(const World& world) const {
  return {floating_ ? basePose(world) : Pose{}, positions(world), velocities(world)};
}

Pose Articulation::basePose(const World& world) const {
  if (!floating_) (Path("Articulation::basePose") / "base").refuse("fixed", "must be floating");
  return world.pose(links_.front().body);
}

ArticulationDynamics Articulation::dynamics(const World& world) const {
  return ArticulationDynamics(std::make_shared<const Placed>(place(world, *this, state(world))));
}

ArticulationDynamics Articulation::dynamics(const World& world, const ArticulationState& state) const {
  const ArticulationState checked = checkedState(Path("Articulation::dynamics"), world, *this, state);
  return ArticulationDynamics(std::make_shared<const Placed>(place(world, *this, checked)));
}

}  // namespace avbd
