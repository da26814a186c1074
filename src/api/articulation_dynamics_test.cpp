// Dynamics of articulations against differences of what they are made from.
#include <gtest/gtest.h>

#include "api/articulation_cases.h"
#include "api/articulation_placed.h"

namespace avbd {
namespace {

using articulation::Placed;

/// A tree in some state; with a floating base at odd seeds.
struct Case {
  TreeCase made;
  Articulation tree;
  ArticulationState state;
  size_t n;

  explicit Case(unsigned seed)
      : made(makeTree(seed, seed % 2 == 1)),
        tree(made.world, made.joints),
        state(makeState(tree, seed + 100)),
        n(tree.dofCount()) {}

  ArticulationDynamics dynamics() const { return tree.dynamics(made.world, state); }
  ArticulationDynamics dynamics(const std::vector<double>& velocities) const {
    ArticulationState to = state;
    to.velocities = velocities;
    return tree.dynamics(made.world, to);
  }
  Placed placed(double time, const std::vector<double>& accelerations) const {
    return articulation::place(made.world, tree, movedOn(made.world, tree, state, accelerations, time));
  }
  std::vector<double> zero() const { return std::vector<double>(n); }
  std::vector<double> unit(size_t dof) const {
    std::vector<double> out(n);
    out[dof] = 1;
    return out;
  }
};

class Dynamics : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Trees, Dynamics, testing::Range(1u, 7u));

std::vector<double> times(const std::vector<double>& matrix, const std::vector<double>& v) {
  std::vector<double> out(matrix.size() / v.size());
  for (size_t i = 0; i < out.size(); ++i)
    for (size_t k = 0; k < v.size(); ++k) out[i] += matrix[i * v.size() + k] * v[k];
  return out;
}

double dotOf(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void expectClose(const std::vector<double>& a, const std::vector<double>& b, double relative, const char* what) {
  ASSERT_EQ(a.size(), b.size());
  double size = 1e-300;
  for (const double x : b) size = std::max(size, std::abs(x));
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], relative * size) << what << ' ' << i;
}

std::vector<double> sum(std::vector<double> a, const std::vector<double>& b, double scale = 1) {
  for (size_t i = 0; i < a.size(); ++i) a[i] += scale * b[i];
  return a;
}

// Links' velocities are the change of where they are: linear, and angular by the way that axes turn.
TEST_P(Dynamics, VelocitiesAreTheChangeOfPlaces) {
  const Case c(GetParam());
  // A floating base's pose is float: its turning shows in the differences.
  const double h = 1e-3, tolerance = c.tree.isFloating() ? 2e-3 : 2e-5;
  const Placed now = c.placed(0, c.zero()), before = c.placed(-h, c.zero()), after = c.placed(h, c.zero());
  for (size_t i = 0; i < now.links.size(); ++i) {
    const Vec3d moved = (after.links[i].center - before.links[i].center) * (0.5 / h);
    EXPECT_LT(length(moved - now.links[i].velocity.linear), tolerance) << i;
    const auto turn = after.links[i].frame.rotation * articulation::conjugate(before.links[i].frame.rotation);
    const Vec3d turned = articulation::rotationVectorOf(turn) * (0.5 / h);
    EXPECT_LT(length(turned - now.links[i].velocity.angular), tolerance) << i;
  }
}

// Of any link and point, by unit velocities that the test above has checked.
TEST_P(Dynamics, JacobianIsTheVelocityOfEachDof) {
  const Case c(GetParam());
  TreeMaker make(GetParam());
  const ArticulationDynamics all = c.dynamics();
  for (size_t link = 0; link < all.linkCount(); ++link) {
    const Vec3d point = make.vector(2);
    const std::vector<double> jacobian = all.jacobian(link, point);
    for (size_t dof = 0; dof < c.n; ++dof) {
      const LinkVelocity v = c.dynamics(c.unit(dof)).velocity(link);
      const Vec3d linear = v.linear + cross(v.angular, point - all.centerOfMass(link));
      const double expected[6] = {linear.x, linear.y, linear.z, v.angular.x, v.angular.y, v.angular.z};
      for (size_t row = 0; row < 6; ++row) EXPECT_NEAR(jacobian[row * c.n + dof], expected[row], 1e-12);
    }
  }
}

TEST_P(Dynamics, MassMatrixIsTheCurvatureOfKineticEnergy) {
  const Case c(GetParam());
  const std::vector<double> m = c.dynamics().massMatrix();
  const auto energy = [&](const std::vector<double>& v) { return c.dynamics(v).kineticEnergy(); };
  for (size_t i = 0; i < c.n; ++i) {
    for (size_t k = 0; k < c.n; ++k) {
      const double both = energy(sum(c.unit(i), c.unit(k))), difference = energy(sum(c.unit(i), c.unit(k), -1));
      EXPECT_NEAR(m[i * c.n + k], 0.5 * (both - difference), 1e-11 * both) << i << ' ' << k;
      EXPECT_EQ(m[i * c.n + k], m[k * c.n + i]);
    }
  }
  const std::vector<double>& v = c.state.velocities;
  EXPECT_NEAR(0.5 * dotOf(v, times(m, v)), energy(v), 1e-12 * energy(v));
  EXPECT_GT(energy(v), 0);
}

// D'Alembert: each link's inertial forces, by differences of its velocity, through its Jacobian.
TEST_P(Dynamics, InverseDynamicsIsWhatTheLinksNeed) {
  const Case c(GetParam());
  TreeMaker make(GetParam() + 7);
  const std::vector<double> a = make.numbers(c.n, 2);
  const double h = 1e-3;
  const Placed now = c.placed(0, a), before = c.placed(-h, a), after = c.placed(h, a);
  const ArticulationDynamics dynamics = c.dynamics();
  std::vector<double> expected(c.n);
  for (size_t i = 0; i < now.links.size(); ++i) {
    const auto& link = now.links[i];
    const Vec3d spin = link.velocity.angular;
    const Vec3d linear = (after.links[i].velocity.linear - before.links[i].velocity.linear) * (0.5 / h);
    const Vec3d angular = (after.links[i].velocity.angular - before.links[i].velocity.angular) * (0.5 / h);
    const Vec3d force = linear * link.mass - link.weight;
    const Vec3d torque =
        articulation::times(link.inertia, angular) + cross(spin, articulation::times(link.inertia, spin));
    const std::vector<double> jacobian = dynamics.jacobian(i, link.center);
    const double six[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
    for (size_t k = 0; k < c.n; ++k)
      for (size_t row = 0; row < 6; ++row) expected[k] += jacobian[row * c.n + k] * six[row];
  }
  for (size_t k = 0; k < c.n; ++k) expected[k] += now.dofs[k].armature * a[k];
  expectClose(dynamics.inverseDynamics(a), expected, c.tree.isFloating() ? 1e-3 : 1e-5, "effort");
}

TEST_P(Dynamics, TheEquationOfMotionHolds) {
  const Case c(GetParam());
  TreeMaker make(GetParam() + 13);
  const ArticulationDynamics dynamics = c.dynamics();
  const std::vector<double> a = make.numbers(c.n, 2);
  std::vector<double> expected = sum(times(dynamics.massMatrix(), a), dynamics.biasForces());
  expected = sum(expected, dynamics.gravityForces(), -1);
  expectClose(dynamics.inverseDynamics(a), expected, 1e-12, "without external forces");
  std::vector<LinkForce> external(dynamics.linkCount());
  for (size_t i = 0; i < external.size(); ++i) {
    external[i] = {make.vector(10), make.vector(10)};
    const std::vector<double> jacobian = dynamics.jacobian(i, dynamics.centerOfMass(i));
    const Vec3d f = external[i].force, t = external[i].torque;
    const double six[6] = {f.x, f.y, f.z, t.x, t.y, t.z};
    for (size_t k = 0; k < c.n; ++k)
      for (size_t row = 0; row < 6; ++row) expected[k] -= jacobian[row * c.n + k] * six[row];
  }
  const std::vector<double> efforts = dynamics.inverseDynamics(a, external);
  expectClose(efforts, expected, 1e-12, "with external forces");
  expectClose(dynamics.forwardDynamics(efforts, external), a, 1e-9, "and back");
  EXPECT_EQ(c.dynamics(c.zero()).biasForces(), c.zero());
}

TEST_P(Dynamics, GravityIsTheSlopeOfThePotential) {
  const Case c(GetParam());
  const std::vector<double> gravity = c.dynamics().gravityForces();
  const double h = 1e-4;
  std::vector<double> slope(c.n);
  for (size_t dof = c.tree.isFloating() ? 6 : 0; dof < c.n; ++dof) {
    ArticulationState at = c.state;
    at.velocities = c.unit(dof);
    const auto potential = [&](double time) {
      return c.tree.dynamics(c.made.world, movedOn(c.made.world, c.tree, at, c.zero(), time)).potentialEnergy();
    };
    slope[dof] = (potential(-h) - potential(h)) / (2 * h);
    EXPECT_NEAR(gravity[dof], slope[dof], 1e-4) << dof;
  }
  // Of a floating base: the weight, and its moment about the root's centre.
  if (!c.tree.isFloating()) return;
  const Placed placed = c.placed(0, c.zero());
  Vec3d weight, moment;
  for (const auto& link : placed.links) {
    weight = weight + link.weight;
    moment = moment + cross(link.center - placed.links.front().center, link.weight);
  }
  const std::vector<double> base(gravity.begin(), gravity.begin() + 6);
  expectClose(base, {weight.x, weight.y, weight.z, moment.x, moment.y, moment.z}, 1e-12, "base");
}

// The kinetic energy grows by the power of efforts and gravity, whatever the velocities do.
TEST_P(Dynamics, PowerIsTheChangeOfEnergy) {
  const Case c(GetParam());
  TreeMaker make(GetParam() + 17);
  const ArticulationDynamics dynamics = c.dynamics();
  const std::vector<double> efforts = make.numbers(c.n, 5), a = dynamics.forwardDynamics(efforts);
  const double h = 1e-4;
  const auto energy = [&](double time) {
    return c.tree.dynamics(c.made.world, movedOn(c.made.world, c.tree, c.state, a, time)).kineticEnergy();
  };
  const double power = dotOf(sum(efforts, dynamics.gravityForces()), c.state.velocities);
  const double tolerance = (c.tree.isFloating() ? 1e-2 : 1e-4) * (1 + energy(0));
  EXPECT_NEAR((energy(h) - energy(-h)) / (2 * h), power, tolerance);
}

TEST(ArticulationDynamics, NothingIsLostFarFromTheOrigin) {
  const Case c(1);
  ArticulationState far = c.state;
  far.base.position = far.base.position + Vec3d{1e7, -1e7, 2e7};
  const ArticulationDynamics there = c.tree.dynamics(c.made.world, far), here = c.dynamics();
  expectClose(there.massMatrix(), here.massMatrix(), 1e-7, "mass matrix");
  expectClose(there.biasForces(), here.biasForces(), 1e-7, "bias");
}

TEST(ArticulationDynamics, MassAndItsCenter) {
  const Case c(2);
  const ArticulationDynamics dynamics = c.dynamics();
  double mass = 0;
  Vec3d moment;
  for (size_t i = 0; i < dynamics.linkCount(); ++i) {
    const double m = static_cast<double>(c.made.world.mass(c.tree.links()[i].body));
    mass += m, moment = moment + dynamics.centerOfMass(i) * m;
  }
  EXPECT_DOUBLE_EQ(dynamics.mass(), mass);
  EXPECT_LT(length(dynamics.centerOfMass() - moment * (1 / mass)), 1e-12);
}

}  // namespace
}  // namespace avbd
