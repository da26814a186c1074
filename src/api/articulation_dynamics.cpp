// Dynamics of an articulation in one state (articulation.h): Newton-Euler from the base out and back, and composite
// bodies.
#include <cmath>

#include "api/articulation_check.h"
#include "api/articulation_placed.h"
#include "world/check.h"
#include "world/limits.h"

namespace avbd {

using namespace articulation;

namespace {

const PlacedLink& linkAt(const Placed& placed, size_t link, const char* call) {
  if (link < placed.links.size()) return placed.links[link];
  (Path(call) / "link").refuse(toText(link), "must be less than " + toText(placed.links.size()));
}

void checkExternal(const Path& path, std::span<const LinkForce> forces, size_t links) {
  if (!forces.empty() && forces.size() != links)
    path.refuse(toText(forces.size()) + " links", "must have none or " + toText(links));
  for (size_t i = 0; i < forces.size(); ++i) {
    const Path at = path[i];
    check(at / "force", forces[i].force, symmetric(kMaxForce));
    check(at / "torque", forces[i].torque, symmetric(kMaxForce));
  }
}

/// Force and torque about the centre that give the acceleration.
Spatial forceFor(const PlacedLink& link, const Spatial& acceleration) {
  const Vec3d spin = link.velocity.angular;
  return {acceleration.linear * link.mass,
          times(link.inertia, acceleration.angular) + cross(spin, times(link.inertia, spin))};
}

/// Of the parent's material point at the pivot, from the acceleration of the parent's centre.
Spatial carried(const Placed& placed, const PlacedLink& link, std::span<const Spatial> accelerations) {
  const auto at = [&](const Spatial& center, Vec3d spin, Vec3d arm) {
    Spatial out = movedBy(center, arm);
    out.linear += cross(spin, cross(spin, arm));
    return out;
  };
  if (link.parent < 0) return at({}, link.baseSpin, link.pivot - link.baseOrigin);
  const size_t parent = static_cast<size_t>(link.parent);
  const PlacedLink& on = placed.links[parent];
  return at(accelerations[parent], on.velocity.angular, link.pivot - on.center);
}

/// Of each link's centre.
std::vector<Spatial> accelerationsOf(const Placed& placed, std::span<const double> values) {
  std::vector<Spatial> out(placed.links.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const PlacedLink& link = placed.links[i];
    Spatial atPivot = carried(placed, link, out) + link.rate;
    for (size_t k = 0; k < static_cast<size_t>(link.dofCount); ++k) {
      const size_t dof = static_cast<size_t>(link.firstDof) + k;
      atPivot = atPivot + placed.dofs[dof].axis * values[dof];
    }
    const Vec3d arm = link.center - link.pivot, spin = link.velocity.angular;
    out[i] = movedBy(atPivot, arm);
    out[i].linear += cross(spin, cross(spin, arm));
  }
  return out;
}

/// What the joints do along each dof where each link needs a force about its centre; `needed` becomes what each link
/// takes from its parent.
std::vector<double> effortsFor(const Placed& placed, std::vector<Spatial>& needed) {
  std::vector<double> out(placed.dofs.size());
  for (size_t i = placed.links.size(); i-- > 0;) {
    const PlacedLink& link = placed.links[i];
    const Spatial atPivot = forceSeenFrom(needed[i], link.center - link.pivot);
    for (size_t k = 0; k < static_cast<size_t>(link.dofCount); ++k) {
      const size_t dof = static_cast<size_t>(link.firstDof) + k;
      out[dof] = articulation::dot(placed.dofs[dof].axis, atPivot);
    }
    if (link.parent < 0) continue;
    const size_t parent = static_cast<size_t>(link.parent);
    needed[parent] = needed[parent] + forceSeenFrom(atPivot, link.pivot - placed.links[parent].center);
  }
  return out;
}

std::vector<double> newtonEuler(const Placed& placed, std::span<const double> values, bool gravity,
                                std::span<const LinkForce> external) {
  const std::vector<Spatial> accelerations = accelerationsOf(placed, values);
  std::vector<Spatial> needed(placed.links.size());
  for (size_t i = 0; i < needed.size(); ++i) {
    const PlacedLink& link = placed.links[i];
    needed[i] = forceFor(link, accelerations[i]);
    if (gravity) needed[i].linear = needed[i].linear - link.weight;
    if (!external.empty()) needed[i] = needed[i] + Spatial{-external[i].force, -external[i].torque};
  }
  std::vector<double> out = effortsFor(placed, needed);
  for (size_t i = 0; i < out.size(); ++i) out[i] += placed.dofs[i].armature * values[i];
  return out;
}

/// A link and all that hangs on it as one rigid body.
struct Composite {
  double mass = 0;
  Vec3d center;
  SymMat3d inertia;  ///< about the centre, world axes

  void add(const Composite& b) {
    const double sum = mass + b.mass, reduced = sum > 0 ? mass * b.mass / sum : 0;
    const Vec3d d = b.center - center;
    const SymMat3d &i = inertia, &k = b.inertia;
    inertia = {i.xx + k.xx + reduced * (d.y * d.y + d.z * d.z),
               i.yy + k.yy + reduced * (d.x * d.x + d.z * d.z),
               i.zz + k.zz + reduced * (d.x * d.x + d.y * d.y),
               i.xy + k.xy - reduced * d.x * d.y,
               i.xz + k.xz - reduced * d.x * d.z,
               i.yz + k.yz - reduced * d.y * d.z};
    if (sum > 0) center += d * (b.mass / sum);
    mass = sum;
  }
};

std::vector<Composite> compositesOf(const Placed& placed) {
  std::vector<Composite> out;
  for (const PlacedLink& link : placed.links) out.push_back({link.mass, link.center, link.inertia});
  for (size_t i = out.size(); i-- > 0;)
    if (placed.links[i].parent >= 0) out[static_cast<size_t>(placed.links[i].parent)].add(out[i]);
  return out;
}

/// The lower triangle L of M = L L^T in place of M; false where M is not positive definite to rounding.
bool factor(std::vector<double>& m, size_t n) {
  for (size_t j = 0; j < n; ++j) {
    const double whole = m[j * n + j];
    double left = whole;
    for (size_t k = 0; k < j; ++k) left -= m[j * n + k] * m[j * n + k];
    if (!(left > 1e-14 * whole)) return false;
    const double diagonal = m[j * n + j] = std::sqrt(left);
    for (size_t i = j + 1; i < n; ++i) {
      double sum = m[i * n + j];
      for (size_t k = 0; k < j; ++k) sum -= m[i * n + k] * m[j * n + k];
      m[i * n + j] = sum / diagonal;
    }
  }
  return true;
}

void solveFactored(const std::vector<double>& l, std::vector<double>& x) {
  const size_t n = x.size();
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
  }
}

}  // namespace

size_t ArticulationDynamics::linkCount() const { return placed_->links.size(); }
size_t ArticulationDynamics::dofCount() const { return placed_->dofs.size(); }

Pose ArticulationDynamics::pose(size_t link) const {
  return articulation::toFloat(linkAt(*placed_, link, "ArticulationDynamics::pose").frame);
}

LinkVelocity ArticulationDynamics::velocity(size_t link) const {
  const Spatial& velocity = linkAt(*placed_, link, "ArticulationDynamics::velocity").velocity;
  return {velocity.linear, velocity.angular};
}

Vec3d ArticulationDynamics::centerOfMass(size_t link) const {
  return linkAt(*placed_, link, "ArticulationDynamics::centerOfMass").center;
}

Vec3d ArticulationDynamics::centerOfMass() const {
  // From the first link's, so that far from the origin nothing is lost.
  const Vec3d first = placed_->links.front().center;
  Vec3d sum;
  for (const PlacedLink& link : placed_->links) sum += (link.center - first) * link.mass;
  return first + sum * (1 / mass());
}

double ArticulationDynamics::mass() const {
  double sum = 0;
  for (const PlacedLink& link : placed_->links) sum += link.mass;
  return sum;
}

double ArticulationDynamics::kineticEnergy() const {
  double twice = 0;
  for (const PlacedLink& link : placed_->links) {
    const auto& [linear, angular] = link.velocity;
    twice += link.mass * avbd::dot(linear, linear) + avbd::dot(angular, times(link.inertia, angular));
  }
  for (const PlacedDof& dof : placed_->dofs) twice += dof.armature * dof.velocity * dof.velocity;
  return 0.5 * twice;
}

double ArticulationDynamics::potentialEnergy() const {
  double sum = 0;
  for (const PlacedLink& link : placed_->links) sum -= avbd::dot(link.weight, link.center);
  return sum;
}

std::vector<double> ArticulationDynamics::jacobian(size_t link, Vec3d point) const {
  const Path path("ArticulationDynamics::jacobian");
  linkAt(*placed_, link, "ArticulationDynamics::jacobian");
  check(path / "point", point, symmetric(kMaxPosition * kMaxUnit));
  const size_t n = dofCount();
  std::vector<double> out(6 * n);
  placed_->eachDofAbove(link, [&](size_t dof, const PlacedLink& on) {
    const auto& [linear, angular] = movedBy(placed_->dofs[dof].axis, point - on.pivot);
    const double column[6] = {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
    for (size_t row = 0; row < 6; ++row) out[row * n + dof] = column[row];
  });
  return out;
}

std::vector<double> ArticulationDynamics::massMatrix() const {
  const size_t n = dofCount();
  std::vector<double> out(n * n);
  const std::vector<Composite> composites = compositesOf(*placed_);
  for (size_t i = 0; i < placed_->links.size(); ++i) {
    const PlacedLink& link = placed_->links[i];
    const Composite& all = composites[i];
    for (int k = 0; k < link.dofCount; ++k) {
      const size_t column = static_cast<size_t>(link.firstDof + k);
      const Spatial motion = movedBy(placed_->dofs[column].axis, all.center - link.pivot);
      const Spatial force{motion.linear * all.mass, times(all.inertia, motion.angular)};
      placed_->eachDofAbove(i, [&](size_t row, const PlacedLink& on) {
        const Spatial atPivot = forceSeenFrom(force, all.center - on.pivot);
        out[row * n + column] = out[column * n + row] = articulation::dot(placed_->dofs[row].axis, atPivot);
      });
      out[column * n + column] += placed_->dofs[column].armature;
    }
  }
  return out;
}

std::vector<double> ArticulationDynamics::biasForces() const {
  return newtonEuler(*placed_, std::vector<double>(dofCount()), false, {});
}

std::vector<double> ArticulationDynamics::gravityForces() const {
  std::vector<Spatial> weights(placed_->links.size());
  for (size_t i = 0; i < weights.size(); ++i) weights[i].linear = placed_->links[i].weight;
  return effortsFor(*placed_, weights);
}

std::vector<double> ArticulationDynamics::inverseDynamics(std::span<const double> accelerations,
                                                          std::span<const LinkForce> external) const {
  const Path path("ArticulationDynamics::inverseDynamics");
  checkForces(path / "accelerations", accelerations, dofCount());
  checkExternal(path / "external", external, linkCount());
  return newtonEuler(*placed_, accelerations, true, external);
}

std::vector<double> ArticulationDynamics::forwardDynamics(std::span<const double> efforts,
                                                          std::span<const LinkForce> external) const {
  const Path path("ArticulationDynamics::forwardDynamics");
  checkForces(path / "efforts", efforts, dofCount());
  checkExternal(path / "external", external, linkCount());
  const std::vector<double> still = newtonEuler(*placed_, std::vector<double>(dofCount()), true, external);
  std::vector<double> matrix = massMatrix(), out(efforts.begin(), efforts.end());
  for (size_t i = 0; i < out.size(); ++i) out[i] -= still[i];
  if (!factor(matrix, out.size())) (path / "state").refuse("singular", "must have a mass matrix that can be inverted");
  solveFactored(matrix, out);
  return out;
}

}  // namespace avbd
