// The worlds whose bits are compared. Nothing here may come from the C library's sines, which differ by platform.
#include "test/same_bits_scenes.h"

#include <avbd/articulation.h>
#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>
#include <avbd/soft_mesh.h>

#include <array>
#include <cmath>
#include <utility>

#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::bits {
namespace {

using scenes::Draws;

World begin(const WorldDef& def) {
  World world(def);
  world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
  return world;
}

World pyramid(const WorldDef& def) {
  World world = begin(def);
  for (int row = 0; row < 6; ++row) {
    for (int i = 0; i < 6 - row; ++i) {
      world.create(BodyDef{.position = {(i - (5 - row) / 2.0) * 1.1, 0.5 + row, 0}, .shape = Box{0.5f, 0.5f, 0.5f}});
    }
  }
  return world;
}

World chain(const WorldDef& def) {
  World world = begin(def);
  BodyId previous;
  for (int i = 0; i < 12; ++i) {
    const BodyId link = world.create(
        BodyDef{.position = {0.5 * i + 0.25, 8, 0}, .shape = Sphere{0.1f}, .mass = i < 11 ? 1.0f : 500.0f});
    const Vec3d atPrevious = i == 0 ? Vec3d{0, 8, 0} : Vec3d{0.25, 0, 0};
    world.create(BallJoint{.bodyA = previous, .bodyB = link, .frameA = {atPrevious}, .frameB = {{-0.25, 0, 0}}});
    previous = link;
  }
  return world;
}

// Spin, friction, restitution, joints and overlap at once.
World mixed(const WorldDef& def) {
  World world = begin(def);
  const Geometry geometries[] = {Sphere{0.4f}, Capsule{0.2f, 0.4f}, Box{0.5f, 0.3f, 0.4f}};
  BodyId previous;
  for (int i = 0; i < 24; ++i) {
    BodyDef body{.position = {0.7 * (i % 4), 0.3 + 0.6 * (i / 4), 0.6 * (i % 3)}, .shape = geometries[i % 3]};
    body.linearVelocity = {0.3f * static_cast<float>(i % 5), -1, 0.2f};
    body.angularVelocity = {1, 0.5f * static_cast<float>(i % 7), -2};
    body.material.restitution = i % 2 ? 0.5f : 0.0f;
    const BodyId id = world.create(body);
    if (i % 6 == 5) world.create(FixedJoint{.bodyA = previous, .bodyB = id, .frameA = {{0, 0.5, 0}}});
    previous = id;
  }
  return world;
}

BodyId hung(World& world, Vec3d at) {
  return world.create(BodyDef{.position = at, .shape = Box{0.3f, 0.2f, 0.1f}, .mass = 2});
}

// Every type of joint from the world to a box 0.5 m beside it, with limits, drives, friction and springs.
World joints(const WorldDef& def) {
  World world = begin(def);
  const Pose inB{{-0.5, 0, 0}, {}};
  double x = 0;
  const auto next = [&] { return Pose{{x += 2, 5, 0}, {}}; };
  const auto add = [&](auto joint) {
    joint.frameA = next(), joint.frameB = inB;
    joint.bodyB = hung(world, joint.frameA.position + Vec3d{0.5, 0, 0});
    return world.create(joint);
  };
  add(HingeJoint{.limit = {-0.4f, 0.3f}, .friction = 0.1f});
  const JointId driven = add(HingeJoint{.drive = {.stiffness = 50, .damping = 2, .position = 0.5f}, .armature = 0.1f});
  const JointId other = add(HingeJoint{.spring = {.stiffness = 10, .damping = 0.1f}});
  const JointId slider = add(SliderJoint{.limit = {-0.5f, 0.5f}, .drive = {.damping = 20, .velocity = 0.3f}});
  world.create(gear(driven, other, 2));
  world.create(mimic(other, slider, 0.5f, 0, JointAxis::Twist, JointAxis::LinearX));
  D6Joint cone;
  for (size_t i = 3; i < 6; ++i) cone.axes[i] = {.motion = AxisMotion::Free, .friction = 0.2f};
  cone.cone = {.y = 0.4f, .z = 0.7f};
  add(cone);
  cone.cone = {};
  for (size_t i = 3; i < 6; ++i) cone.axes[i].friction = 0;
  cone.slerp = {.stiffness = 40, .damping = 1, .rotation = {0.8f, 0, 0.6f, 0}};
  add(cone);
  add(DistanceJoint{.min = 0.2f, .max = 0.6f});
  add(BallJoint{});
  PulleyJoint rope;
  rope.bodyA = hung(world, {-4, 2, 0}), rope.bodyB = hung(world, {-6, 2, 0});
  rope.wheelA = {-4, 6, 0}, rope.wheelB = {-6, 6, 0}, rope.ratio = 1.5f;
  world.create(rope);
  return world;
}

// An arm of five hinges held by inverse dynamics, and a loop closed on it.
World arm(const WorldDef& def) {
  World world = begin(def);
  BodyId previous;
  for (int i = 0; i < 5; ++i) {
    const BodyId link = hung(world, {0.35 + 0.7 * i, 3, 0});
    const Quat axis = i % 2 ? Quat{0.5f, 0.5f, 0.5f, 0.5f} : Quat{0.6f, 0, 0.8f, 0};
    world.create(HingeJoint{.bodyA = previous,
                            .bodyB = link,
                            .frameA = {i == 0 ? Vec3d{0, 3, 0} : Vec3d{0.35, 0, 0}, axis},
                            .frameB = {{-0.35, 0, 0}, axis},
                            .drive = {.stiffness = 20, .damping = 1, .position = 0.2f}});
    previous = link;
  }
  const BodyId far = hung(world, {0.35 + 0.7 * 5, 3, 0.5});
  world.create(BallJoint{.bodyA = previous, .bodyB = far, .frameA = {{0.35, 0, 0.5}}, .frameB = {{-0.35, 0, 0}}});
  world.create(DistanceJoint{.bodyB = far, .frameA = {{0.35 + 0.7 * 5, 6, 0.5}}, .frameB = {}, .max = 3});
  return world;
}

void holdArm(World& world) {
  const Articulation tree(world, world.bodies()[1]);
  std::vector<double> efforts = tree.dynamics(world).gravityForces();
  for (double& e : efforts) e *= 0.5;
  tree.addEfforts(world, efforts);
}

std::shared_ptr<const HullData> stone(Draws& draws) {
  std::vector<Vec3> points;
  for (int i = 0; i < 20; ++i) points.push_back({0.4f * draws.next(), 0.3f * draws.next(), 0.35f * draws.next()});
  return makeHull({.points = points});
}

void addWaves(World& world, Draws& draws) {
  constexpr int kSide = 17;
  std::vector<float> heights;
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  for (int r = 0; r < kSide; ++r) {
    for (int c = 0; c < kSide; ++c) {
      heights.push_back(0.2f * draws.next());
      vertices.push_back({0.5f * static_cast<float>(c), 0.2f * draws.next(), 0.5f * static_cast<float>(r)});
      if (c + 1 == kSide || r + 1 == kSide) continue;
      const auto i = static_cast<uint32_t>(r * kSide + c);
      triangles.push_back({i, i + kSide, i + kSide + 1});
      triangles.push_back({i, i + kSide + 1, i + 1});
    }
  }
  world.create(BodyDef{
      .type = BodyType::Static,
      .position = {0, 0.5, 0},
      .shape = HeightField{
          makeHeightField({.columns = kSide, .rows = kSide, .spacingX = 0.5f, .spacingZ = 0.5f, .heights = heights})}});
  world.create(BodyDef{.type = BodyType::Static,
                       .position = {4, 0.5, -4},
                       .shape = Mesh{makeMesh({.vertices = vertices, .triangles = triangles})}});
}

// Every convex shape on a height field and a mesh side by side.
// Cloth that falls on two soft cubes that fall on the ground and on each other, a box hanging on a corner of one of
// them; beside them one of each other kind: damped, incompressible, and woven cloth whose limit holds a weight.
World soft(const WorldDef& def) {
  World world = begin(def);
  const auto cube = makeTetBox({0.3f, 0.3f, 0.3f}, 3, 3, 3);
  for (int i = 0; i < 2; ++i) {
    const SoftId id = world.create(SoftDef{.mesh = cube,
                                           .pose = {{0.2 * i, 0.5 + 0.85 * i, 0}, {0.8f, 0, 0.6f, 0}},
                                           .velocity = {{1, 0, 0}, {0, 1, 2}},
                                           .material = {.youngsModulus = i == 0 ? 2e4f : 5e5f}});
    if (i > 0) continue;
    const Pose corner = world.pose(world.particles(id).back());
    const BodyId box =
        world.create(BodyDef{.position = corner.position + Vec3d{0, 0.2, 0}, .shape = Box{0.1f, 0.1f, 0.1f}});
    world.create(BallJoint{.bodyA = world.particles(id).back(), .bodyB = box, .frameB = {{0, -0.2, 0}, {}}});
  }
  world.create(SoftDef{.mesh = makeClothGrid(0.6f, 0.6f, 6, 6),
                       .pose = {{0.1, 2, 0}, {}},
                       .material = {.youngsModulus = 2e5f, .density = 300}});
  const auto small = makeTetBox({0.2f, 0.2f, 0.2f}, 2, 2, 2);
  world.create(SoftDef{.mesh = small,
                       .pose = {{2, 0.3, 0}, {}},
                       .velocity = {{1, 0, 0}, {0, 1, 2}},
                       .material = {.poissonRatio = 0.4f, .damping = 0.1f}});
  world.create(SoftDef{.mesh = small,
                       .pose = {{4, 0.3, 0}, {}},
                       .velocity = {{1, 0, 0}, {0, 1, 2}},
                       .material = {.poissonRatio = 0.4999f}});
  const SoftId flag = world.create(SoftDef{.mesh = makeClothGrid(0.3f, 0.3f, 4, 4),
                                           .pose = {{6, 1, 0}, {}},
                                           .material = {.youngsModulus = 2e4f,
                                                        .thickness = 0.001f,
                                                        .damping = 0.05f,
                                                        .maxStrain = 0.05f,
                                                        .warp = {1, 0, 1},
                                                        .weftModulus = 1e4f,
                                                        .shearModulus = 2e3f}});
  const std::vector<BodyId> points = world.particles(flag);
  world.setLocks(points[0], kLockLinearX | kLockLinearY | kLockLinearZ);
  const Vec3d corner = world.pose(points.back()).position;
  const BodyId weight = world.create(BodyDef{.position = corner, .shape = Sphere{0.05f}, .mass = 2});
  world.create(BallJoint{.bodyA = weight, .bodyB = points.back()});
  return world;
}

World surfaces(const WorldDef& def) {
  World world = begin(def);
  Draws draws(7);
  addWaves(world, draws);
  const std::shared_ptr<const HullData> hull = stone(draws);
  const Geometry shapes[] = {Sphere{0.3f},
                             Capsule{0.2f, 0.3f},
                             Box{0.3f, 0.2f, 0.25f},
                             Cylinder{0.3f, 0.2f},
                             Cone{0.3f, 0.3f},
                             Ellipsoid{0.4f, 0.2f, 0.3f},
                             Hull{hull},
                             Box{0.2f, 0.2f, 0.2f, 0.05f},
                             Hull{hull, {0.7f, 1.2f, 1}, 0.03f}};
  for (int i = 0; i < 36; ++i) {
    BodyDef body{.position = {6 * (i % 6) / 5.0 + 0.2 * draws.next(), 1.4, -3 + 6 * (i / 6) / 5.0}};
    body.shape = shapes[i % 9];
    body.angularVelocity = {draws.next(), draws.next(), draws.next()};
    body.material = {.friction = 0.6f, .restitution = i % 3 ? 0.0f : 0.4f};
    if (i % 4 == 0) body.material.rollingFriction = body.material.torsionalFriction = 0.02f;
    world.create(body);
  }
  return world;
}

Trial ofScene(const scenes::Scene& scene) {
  const auto settings = [](const WorldDef& def) {
    scenes::Settings s;
    s.simdWidth = def.simdWidth, s.workers = def.workers;
    return s;
  };
  const auto make = [scene, settings](const WorldDef& def) { return std::move(scene.make(settings(def)).world); };
  return {scene.name, make};
}

}  // namespace

std::vector<Trial> smallTrials() {
  const auto substeps = [](WorldDef def) {
    def.substeps = 3;
    return mixed(def);
  };
  return {{"small_pyramid", pyramid, 60, true}, {"short_chain", chain, 60, true},
          {"mixed", mixed, 90, true},           {"mixed_substeps", substeps, 30},
          {"joints", joints, 60, true},         {"arm", arm, 60, false, holdArm},
          {"surfaces", surfaces, 90},           {"soft", soft, 60}};
}

std::vector<Trial> sceneTrials() {
  std::vector<Trial> trials;
  for (const auto group : {scenes::pileScenes, scenes::chainScenes, scenes::stackScenes, scenes::netScenes,
                           scenes::scissorScenes, scenes::ragdollScenes})
    for (const scenes::Scene& scene : group())
      // These pits of 2000 boxes would show nothing that `bricks` does not.
      if (scene.name != "pit_grid" && scene.name != "pile") trials.push_back(ofScene(scene));
  return trials;
}

}  // namespace avbd::bits
