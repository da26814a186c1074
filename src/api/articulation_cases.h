// For the tests: trees of all joints, some turned round, with masses and frames that agree with nothing; and moving on
// in coordinates.
#pragma once

#include <avbd/articulation.h>
#include <avbd/world.h>

#include <cmath>
#include <random>
#include <vector>

#include "api/articulation_math.h"
#include "world/rotation.h"

namespace avbd {

struct TreeCase {
  World world;
  std::vector<BodyId> bodies;
  std::vector<JointId> joints;
};

class TreeMaker {
 public:
  explicit TreeMaker(unsigned seed) : random_(seed) {}

  double number(double most) { return std::uniform_real_distribution<double>(-most, most)(random_); }
  Vec3d vector(double most) { return {number(most), number(most), number(most)}; }
  std::vector<double> numbers(size_t count, double most) {
    std::vector<double> out(count);
    for (double& value : out) value = number(most);
    return out;
  }
  Quat rotation() {
    const articulation::Quatd q = articulation::rotationOf(vector(1.7));
    return articulation::toFloat(articulation::Posed{{}, q}).rotation;
  }
  Pose pose(double reach) { return {vector(reach), rotation()}; }

  BodyId body(World& world) {
    const float a = size(), b = size(), c = size();
    const SymMat3d m = worldInertia(rotation(), {b + c, a + c, a + b, 0, 0, 0});
    const auto f = [](double x) { return static_cast<float>(x); };
    MassProperties mass{.mass = 3 * size(), .center = toFloat(vector(0.2))};
    mass.inertia = {f(m.xx), f(m.yy), f(m.zz), f(m.xy), f(m.xz), f(m.yz)};
    const Pose at = pose(1);
    BodyDef def{.position = at.position, .rotation = at.rotation, .massProperties = mass};
    def.gravityScale = 0.5f + size();
    return world.create(def);
  }

  /// Frames anywhere; armature of every coordinate.
  JointId d6(World& world, BodyId a, BodyId b, std::initializer_list<JointAxis> free) {
    D6Joint def{.bodyA = a, .bodyB = b, .frameA = pose(0.5), .frameB = pose(0.5)};
    for (const JointAxis axis : free)
      def.axes[static_cast<size_t>(axis)] = {.motion = AxisMotion::Free, .armature = 0.3f * size()};
    return world.create(def);
  }

 private:
  float size() { return static_cast<float>(0.6 + number(0.4)); }
  std::mt19937 random_;
};

/// Eleven links in three branches, with each kind of joint both ways round.
inline TreeCase makeTree(unsigned seed, bool floating, Vec3 gravity = {1, -9.81f, 2}) {
  using enum JointAxis;
  TreeMaker make(seed);
  TreeCase out{World({.gravity = gravity}), {}, {}};
  World& world = out.world;
  for (int i = 0; i < 11; ++i) out.bodies.push_back(make.body(world));
  const std::vector<BodyId>& b = out.bodies;
  const auto frames = [&](auto def) {
    def.frameA = make.pose(0.5), def.frameB = make.pose(0.5);
    return world.create(def);
  };
  if (!floating) {
    const Pose at = make.pose(2);
    const BodyId base = world.create(
        BodyDef{.type = BodyType::Static, .position = at.position, .rotation = at.rotation, .shape = Sphere{0.1f}});
    out.joints.push_back(frames(HingeJoint{.bodyA = base, .bodyB = b[0], .armature = 0.4f}));
  }
  const std::vector<JointId> more{frames(SliderJoint{.bodyA = b[1], .bodyB = b[0], .armature = 0.2f}),  // reversed
                                  frames(BallJoint{.bodyA = b[1], .bodyB = b[2]}),
                                  make.d6(world, b[3], b[2], {SwingY, SwingZ}),  // reversed
                                  make.d6(world, b[3], b[4], {Twist, SwingY, SwingZ}),
                                  frames(FixedJoint{.bodyA = b[0], .bodyB = b[5]}),
                                  frames(BallJoint{.bodyA = b[6], .bodyB = b[5]}),                // reversed
                                  make.d6(world, b[7], b[6], {LinearX, LinearZ, Twist, SwingZ}),  // reversed
                                  make.d6(world, b[0], b[8], {LinearX, LinearY, LinearZ, Twist, SwingY, SwingZ}),
                                  frames(HingeJoint{.bodyA = b[9], .bodyB = b[8], .armature = 0.1f}),  // reversed
                                  make.d6(world, b[8], b[10], {LinearY, SwingY})};
  out.joints.insert(out.joints.end(), more.begin(), more.end());
  return out;
}

/// Any state; swings and balls within a radian or so.
inline ArticulationState makeState(const Articulation& tree, unsigned seed) {
  TreeMaker make(seed);
  return {make.pose(2), make.numbers(tree.positionCount(), 0.7), make.numbers(tree.dofCount(), 1.5)};
}

/// Where the root of a floating base turns about, in its frame.
inline Vec3d rootCenter(const World& world, const Articulation& tree) {
  return toDouble(world.centerOfMass(tree.links().front().body));
}

/// What the coordinates are after `time` at the state's velocities and these accelerations, to second order in time.
inline ArticulationState movedOn(const World& world, const Articulation& tree, const ArticulationState& state,
                                 const std::vector<double>& accelerations, double time) {
  using namespace articulation;
  ArticulationState out = state;
  std::vector<double> step(tree.dofCount());
  for (size_t i = 0; i < step.size(); ++i) {
    step[i] = time * (state.velocities[i] + 0.5 * time * accelerations[i]);
    out.velocities[i] += time * accelerations[i];
  }
  for (const ArticulationLink& link : tree.links()) {
    const double* by = step.data() + link.firstDof;
    double* to = out.positions.data() + (link.firstDof - (tree.isFloating() ? 6 : 0));
    if (!link.joint) {
      const Posed base = toDouble(state.base);
      const Quatd turned = rotationOf({by[3], by[4], by[5]}) * base.rotation;
      const Vec3d center = rootCenter(world, tree);
      const Vec3d moved = rotate(base.rotation, center) - rotate(turned, center) + Vec3d{by[0], by[1], by[2]};
      out.base = articulation::toFloat(Posed{base.position + moved, turned});
    } else if (world.type(link.joint) == JointType::Ball) {
      const Vec3d vector = rotationVectorOf(rotationOf({by[0], by[1], by[2]}) * rotationOf({to[0], to[1], to[2]}));
      to[0] = vector.x, to[1] = vector.y, to[2] = vector.z;
    } else {
      for (int i = 0; i < link.dofCount; ++i) to[i] += by[i];
    }
  }
  return out;
}

}  // namespace avbd
