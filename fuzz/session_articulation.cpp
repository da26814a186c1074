// Articulations: trees of the session's joints, their state, efforts, drives, collisions and dynamics.
#include <algorithm>
#include <cmath>

#include "fuzz/session.h"
#include "fuzz/session_attempt.h"

namespace avbd::fuzz {
namespace {

constexpr size_t kMostJoints = 12;

void requireNumbers(std::span<const double> values, const char* what) {
  for (const double value : values) require(!std::isnan(value), what);
}

double most(std::span<const double> values) {
  double out = 0;
  for (const double value : values) out = std::max(out, std::fabs(value));
  return out;
}

/// Parents stand before their children, and numbers are dealt out without gaps.
void checkTree(const World& world, const Articulation& tree) {
  int dofs = 0;
  for (size_t i = 0; i < tree.links().size(); ++i) {
    const ArticulationLink& link = tree.links()[i];
    require(world.isAlive(link.body) && world.type(link.body) == BodyType::Dynamic, "a link that is no dynamic body");
    require(tree.linkOf(link.body) == i, "a body that is two links");
    require(link.parent < static_cast<int>(i), "a link before its parent");
    require(link.firstDof == dofs, "coordinates with gaps between them");
    require(link.joint || (i == 0 && tree.isFloating()), "a link without joint");
    dofs += link.dofCount;
  }
  require(static_cast<size_t>(dofs) == tree.dofCount(), "coordinates of no link");
  require(tree.positionCount() + (tree.isFloating() ? 6 : 0) == tree.dofCount(), "positions that are not counted");
}

}  // namespace

std::vector<double> Session::numbers(size_t count) {
  // Now and then a list of the wrong length.
  if (in_.byte() > 250) count += 1;
  std::vector<double> out(count);
  for (double& value : out) value = static_cast<double>(in_.number());
  return out;
}

JointId Session::anyJoint() {
  const uint8_t pick = in_.byte();
  if (pick > 245 && !deadJoints_.empty()) return deadJoints_[pick % deadJoints_.size()];
  return joints_.empty() ? JointId{} : joints_[pick % joints_.size()];
}

void Session::articulate() {
  if (!tree_ || in_.byte() > 230) {
    attempt([&] {
      tree_.reset();
      if (in_.flag()) {
        tree_.emplace(world_, anyBody());
      } else {
        std::vector<JointId> joints(1 + in_.below(kMostJoints));
        for (JointId& joint : joints) joint = anyJoint();
        tree_.emplace(world_, joints);
      }
      checkTree(world_, *tree_);
    });
  }
  if (!tree_) return;
  const uint32_t what = in_.below(12);
  attempt([&] {
    if (what < 6) return changeTree(what);
    if (what < 8) return changeSelfCollision();
    askTree(what == 8);
  });
}

void Session::changeTree(uint32_t what) {
  const Articulation& tree = *tree_;
  switch (what) {
    case 0: {
      const Pose base = placePose();
      const std::vector<double> positions = numbers(tree.positionCount());
      return tree.setState(world_, {base, positions, numbers(tree.dofCount())});
    }
    case 1:
      return tree.setPositions(world_, numbers(tree.positionCount()));
    case 2:
      return tree.setVelocities(world_, numbers(tree.dofCount()));
    case 3:
      return tree.setBasePose(world_, placePose());
    case 4:
      return tree.addEfforts(world_, numbers(tree.dofCount()));
    default: {
      const std::vector<double> positions = numbers(tree.positionCount());
      return tree.setDriveTargets(world_, positions, in_.flag() ? numbers(tree.dofCount()) : std::vector<double>{});
    }
  }
}

void Session::changeSelfCollision() {
  SelfCollision rule{.enabled = in_.byte() < 200};
  const auto& links = tree_->links();
  const uint32_t pairs = in_.below(5);
  for (uint32_t i = 0; i < pairs; ++i) {
    const bool strange = in_.byte() > 245;
    const BodyId a = strange ? anyBody() : links[in_.byte() % links.size()].body;
    rule.excluded.push_back({a, links[in_.byte() % links.size()].body});
  }
  tree_->setSelfCollision(world_, rule);
  const std::vector<std::array<BodyId, 2>> excluded = tree_->excludedPairs(world_);
  require(rule.enabled || excluded.size() == links.size() * (links.size() - 1) / 2, "links that still collide");
  for (std::array<BodyId, 2> pair : rule.excluded) {
    if (pair[1] < pair[0]) std::swap(pair[0], pair[1]);
    require(std::find(excluded.begin(), excluded.end(), pair) != excluded.end(), "a pair that still collides");
  }
}

/// In the world's state or in another, which leaves the world as it is.
void Session::askTree(bool elsewhere) {
  const Articulation& tree = *tree_;
  const ArticulationState now = tree.state(world_);
  require(now.positions.size() == tree.positionCount() && now.velocities.size() == tree.dofCount(),
          "a state too short");
  requireNumbers(now.positions, "a position that is not a number");
  requireNumbers(now.velocities, "a velocity that is not a number");
  if (!elsewhere) return checkDynamics(tree.dynamics(world_));
  const Pose base = placePose();
  const std::vector<double> positions = numbers(tree.positionCount());
  checkDynamics(tree.dynamics(world_, {base, positions, numbers(tree.dofCount())}));
}

void Session::checkDynamics(const ArticulationDynamics& dynamics) {
  const size_t n = dynamics.dofCount(), link = in_.byte() % (dynamics.linkCount() + 1);
  requireNumbers(std::array{dynamics.mass(), dynamics.kineticEnergy(), dynamics.potentialEnergy()},
                 "an energy that is not a number");
  const std::vector<double> mass = dynamics.massMatrix();
  require(mass.size() == n * n, "a mass matrix of another size");
  requireNumbers(mass, "a mass that is not a number");
  for (size_t i = 0; i < n; ++i) {
    require(mass[i * n + i] >= 0, "a negative mass");
    for (size_t j = 0; j < i; ++j) require(mass[i * n + j] == mass[j * n + i], "a mass matrix that is not symmetric");
  }
  const std::vector<double> bias = dynamics.biasForces(), gravity = dynamics.gravityForces();
  requireNumbers(bias, "a bias that is not a number");
  requireNumbers(gravity, "a weight that is not a number");
  require(dynamics.jacobian(link, place()).size() == 6 * n, "a Jacobian of another size");
  const std::vector<double> efforts = numbers(n);
  std::vector<LinkForce> external(in_.flag() ? dynamics.linkCount() : 0);
  for (LinkForce& force : external) force.force = toDouble(in_.vector());
  // Efforts to accelerations and back, as far as the sums that they stand in are exact.
  const std::vector<double> reached = dynamics.forwardDynamics(efforts, external);
  const std::vector<double> back = dynamics.inverseDynamics(reached, external);
  const double size = most(efforts) + most(bias) + most(gravity) + static_cast<double>(n) * most(mass) * most(reached);
  for (size_t i = 0; i < n; ++i)
    require(!std::isfinite(size) || std::fabs(back[i] - efforts[i]) <= 1e-6 * size,
            "forward and inverse dynamics differ");
}

}  // namespace avbd::fuzz
