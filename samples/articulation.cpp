// An arm without drives writes a circle: its Jacobian tells the joints' speeds, inverse dynamics the efforts for them.
// Then gravity's share of the efforts alone lets it rest where it is. Prints what happens.
#include <avbd/articulation.h>
#include <avbd/avbd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
using namespace avbd;

namespace {

constexpr float kStep = 1.0f / 240;

/// Waist about y, shoulder and elbow about z; two links of 0.6 m.
struct Arm {
  World world;
  std::vector<JointId> joints;

  Arm() {
    const float h = std::sqrt(0.5f);
    const Quat aboutY{h, 0, 0, h}, aboutZ{h, 0, -h, 0};  // hinges turn about x
    const BodyId post = world.create(BodyDef{.shape = Cylinder{0.1f, 0.3f}, .mass = 8});
    const BodyId upper = world.create(BodyDef{.shape = Capsule{0.05f, 0.25f}, .mass = 4});
    const BodyId lower = world.create(BodyDef{.shape = Capsule{0.04f, 0.26f}, .mass = 2});
    // The capsules lie along their own y axes: from -y to +y.
    const Pose start{{0, -0.3, 0}, aboutZ}, end{{0, 0.3, 0}, aboutZ};
    joints = {world.create(HingeJoint{.bodyB = post, .frameA = {{}, aboutY}, .frameB = {{0, -0.3, 0}, aboutY}}),
              world.create(HingeJoint{.bodyA = post, .bodyB = upper, .frameA = {{0, 0.4, 0}, aboutZ}, .frameB = start}),
              world.create(HingeJoint{.bodyA = upper, .bodyB = lower, .frameA = end, .frameB = start})};
  }
};

Vec3d cross(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/// Joint speeds that move the tip with `velocity`: by the three upper rows of its Jacobian.
std::array<double, 3> speedsFor(const std::vector<double>& jacobian, Vec3d velocity) {
  Vec3d column[3];
  for (size_t i = 0; i < 3; ++i) column[i] = {jacobian[i], jacobian[3 + i], jacobian[6 + i]};
  const double volume = dot(column[0], cross(column[1], column[2]));
  return {dot(velocity, cross(column[1], column[2])) / volume, dot(velocity, cross(column[2], column[0])) / volume,
          dot(velocity, cross(column[0], column[1])) / volume};
}

Vec3d tipOf(const ArticulationDynamics& dynamics) { return (dynamics.pose(2) * Pose{{0, 0.3, 0}, {}}).position; }

}  // namespace

int main() {
  Arm arm;
  const Articulation tree(arm.world, arm.joints);
  tree.setPositions(arm.world, std::array{0.0, -0.3, -1.5});
  std::printf("%zu links, %zu dofs, %.1f kg\n", tree.links().size(), tree.dofCount(), tree.dynamics(arm.world).mass());

  const Vec3d center = tipOf(tree.dynamics(arm.world)) - Vec3d{0, 0.2, 0};
  double worst = 0;
  for (int step = 0; step < 960; ++step) {
    const ArticulationDynamics now = tree.dynamics(arm.world);
    const double angle = 3 * step * double{kStep};
    const Vec3d wanted = center + Vec3d{0, 0.2 * std::cos(angle), 0.2 * std::sin(angle)}, tip = tipOf(now);
    const Vec3d along{0, -0.6 * std::sin(angle), 0.6 * std::cos(angle)};
    const std::array<double, 3> speeds = speedsFor(now.jacobian(2, tip), along + (wanted - tip) * 20);
    const std::vector<double> velocities = tree.velocities(arm.world);
    std::array<double, 3> accelerations;
    for (size_t i = 0; i < 3; ++i) accelerations[i] = 60 * (speeds[i] - velocities[i]);
    const std::vector<double> efforts = now.inverseDynamics(accelerations);
    tree.addEfforts(arm.world, efforts);
    arm.world.step(kStep);
    if (step < 240) continue;
    worst = std::max(worst, length(wanted - tip));
    if (step % 120 == 0)
      std::printf("%4.1f s  tip %6.3f %6.3f %6.3f  off by %.1f mm  efforts %6.1f %6.1f %6.1f N m\n", arm.world.time(),
                  tip.x, tip.y, tip.z, 1000 * length(wanted - tip), efforts[0], efforts[1], efforts[2]);
  }

  tree.setVelocities(arm.world, std::array{0.0, 0.0, 0.0});
  const Vec3d before = tipOf(tree.dynamics(arm.world));
  for (int step = 0; step < 240; ++step) {
    std::vector<double> held = tree.dynamics(arm.world).gravityForces();
    for (double& effort : held) effort = -effort;
    tree.addEfforts(arm.world, held);
    arm.world.step(kStep);
  }
  const double moved = length(tipOf(tree.dynamics(arm.world)) - before);
  std::printf("held against gravity for a second the tip moved by %.2f mm\n", 1000 * moved);
  const bool good = worst < 0.01 && moved < 0.005;
  std::printf("%s\n", good ? "it wrote a circle" : "something is wrong");
  return good ? 0 : 1;
}
