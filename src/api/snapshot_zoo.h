// For the tests of snapshots: a world that has some of everything.
#pragma once

#include <avbd/avbd.h>

#include <memory>
#include <string>
#include <vector>

namespace avbd {

/// A rod along x that counts, in its memory, how often it was asked to remember.
class CountingRod : public CustomFamily {
 public:
  std::string name() const override { return "counting_rod"; }
  int rowCount() const override { return 1; }
  void evaluate(std::span<const CustomBody> now, std::span<const CustomBody>, float, std::span<const float> constants,
                std::span<const float> memory, std::span<CustomRow> rows) const override {
    // The rod grows with what it remembers, so that forgetting it shows.
    rows[0].C = now[1].center.x - now[0].center.x - static_cast<double>(constants[0] + 1e-3f * memory[0]);
    rows[0].linear[0] = {-1, 0, 0}, rows[0].linear[1] = {1, 0, 0};
    rows[0].stiffness = 500;
  }
  void remember(std::span<const CustomBody>, std::span<const float>, std::span<float> memory) const override {
    memory[0] += 1;
  }
};

class SnapshotZoo {
 public:
  explicit SnapshotZoo(const WorldDef& def = usual(), bool hook = true) : world(def) {
    add({.type = BodyType::Static, .position = {0, -1, 0}, .shape = Box{20, 1, 20}});
    addPile();
    addSurfaces();
    addJoints();
    addSoft();
    if (hook) world.setContactHook(slippery);
  }

  static WorldDef usual() { return {.substeps = 2, .moveEvents = true}; }
  static bool slippery(ContactPlan& plan) {
    plan.friction = plan.staticFriction = 0.1f;
    plan.surfaceVelocity = {0.2f, 0, 0};
    return true;
  }

  void step(int steps = 1) {
    for (int i = 0; i < steps; ++i) world.step(1.0f / 60);
  }
  BodyId add(const BodyDef& def) {
    bodies.push_back(world.create(def));
    return bodies.back();
  }

  World world;
  std::vector<BodyId> bodies;
  std::vector<JointId> joints;

 private:
  void addSoft() {
    const SoftId soft = world.create(SoftDef{.mesh = makeTetBox({0.3f, 0.2f, 0.3f}, 2, 1, 2),
                                             .pose = {{-9, 0.4, -9}, {}},
                                             .velocity = {{0.5f, 0, 0}, {0, 1, 0}}});
    world.create(SoftDef{.mesh = makeClothGrid(0.4f, 0.4f, 3, 3), .pose = {{-9, 1, -9}, {}}});
    const BodyId tied = add({.position = {-8.5, 0.5, -9}, .shape = Sphere{0.1f}});
    const BodyId corner = world.particles(soft).back();
    const Vec3d at = world.pose(corner).position;
    joints.push_back(
        world.create(BallJoint{.bodyA = corner, .bodyB = tied, .frameB = {at - world.pose(tied).position, {}}}));
  }
  void addPile() {
    const std::vector<Vec3> corners = {{0.4f, 0, 0},     {-0.4f, 0.1f, 0}, {0, 0.4f, 0},
                                       {0, -0.4f, 0.1f}, {0, 0, 0.4f},     {0.1f, 0, -0.4f}};
    const auto rock = makeHull({.points = corners});
    const Geometry shapes[] = {
        Box{0.3f, 0.3f, 0.3f}, Sphere{0.3f}, Hull{rock}, Capsule{0.2f, 0.2f}, Hull{rock, {1, -1.5f, 1}, 0.02f},
        Cylinder{0.3f, 0.3f}};
    for (int i = 0; i < 12; ++i)
      add({.position = {0.25 * (i % 3), 0.5 + 0.65 * i, 0.1 * (i % 2)},
           .shapes = {{.geometry = shapes[i % 6],
                       .material = {.restitution = i % 4 == 0 ? 0.6f : 0.0f, .rollingFriction = i % 3 ? 0.0f : 0.02f},
                       .hitEvents = true,
                       .contactHook = i % 5 == 2}}});
    add({.type = BodyType::Static, .position = {0, 1, 0}, .shapes = {{.geometry = Sphere{1.5f}, .isTrigger = true}}});
    world.excludeCollision(bodies[1], bodies[2]);
  }

  void addSurfaces() {
    std::vector<Vec3> vertices;
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<uint16_t> materials;
    constexpr uint32_t kSide = 6;
    for (uint32_t i = 0; i < kSide * kSide; ++i) {
      const uint32_t x = i % kSide, z = i / kSide;
      vertices.push_back({0.6f * float(x) - 1.5f, 0.1f * float((x + 2 * z) % 3), 0.6f * float(z) - 1.5f});
      if (x + 1 == kSide || z + 1 == kSide) continue;
      triangles.push_back({i, i + kSide, i + kSide + 1}), triangles.push_back({i, i + kSide + 1, i + 1});
      materials.push_back(uint16_t(i % 2)), materials.push_back(0);
    }
    BodyDef mill{.type = BodyType::Kinematic, .position = {8, 0.5, 0}, .angularVelocity = {0, 0.5f, 0}};
    mill.shapes.push_back(
        {.geometry = Mesh{makeMesh({.vertices = vertices, .triangles = triangles, .materials = materials})},
         .materials = {{.friction = 0.2f}, {.friction = 0.9f}}});
    add(mill);
    const std::vector<float> heights{0, 0.2f, 0, 0.1f, 0, 0.3f, 0.1f, 0, 0.2f};
    add({.type = BodyType::Static,
         .position = {-8, 0.2, 0},
         .shape = HeightField{
             makeHeightField({.columns = 3, .rows = 3, .spacingX = 2, .spacingZ = 2, .heights = heights})}});
    const Geometry kinds[] = {Sphere{0.2f}, Box{0.25f, 0.15f, 0.2f}, Box{0.25f, 0.15f, 0.2f}};
    for (int i = 0; i < 6; ++i)
      add({.position = {(i % 2 ? 8 : -8) + 0.5 * (i / 2), 1.5 + 0.3 * i, 0.1 * i}, .shape = kinds[i % 3]});
  }

  void addJoints() {
    std::vector<BodyId> link;
    for (int i = 0; i < 8; ++i)
      link.push_back(add({.position = {-4, 3, 2.0 + i}, .shape = Box{0.2f, 0.2f, 0.2f}, .filter = {.mask = 0}}));
    const auto at = [&](BodyId body) { return Pose{world.pose(body).position, {}}; };
    const auto hinge = [&](BodyId body) {
      return world.create(
          HingeJoint{.bodyB = body, .frameA = at(body), .drive = {.damping = 50, .velocity = 20}, .friction = 0.1f});
    };
    joints.push_back(hinge(link[0]));
    joints.push_back(world.create(HingeJoint{.bodyB = link[1], .frameA = at(link[1])}));
    joints.push_back(world.create(gear(joints[0], joints[1], 3)));
    joints.push_back(world.create(SliderJoint{
        .bodyB = link[2], .frameA = at(link[2]), .limit = {.lower = -0.5f, .upper = 0.5f}, .drive = {.force = 30}}));
    joints.push_back(world.create(
        DistanceJoint{.bodyA = link[2], .bodyB = link[3], .frameA = {}, .frameB = {}, .min = 0.5f, .max = 1.2f}));
    joints.push_back(world.create(
        PulleyJoint{.bodyA = link[3], .bodyB = link[4], .wheelA = {-4, 6, 5}, .wheelB = {-4, 6, 6}, .ratio = 2}));
    joints.push_back(world.create(CustomJoint{
        .family = std::make_shared<CountingRod>(), .bodies = {link[5], link[6]}, .constants = {0.1f}, .memory = {0}}));
    joints.push_back(world.create(BallJoint{.bodyB = link[5], .frameA = at(link[5]), .frameB = {{0.3, 0, 0}, {}}}));
    joints.push_back(world.create(BallJoint{.bodyB = link[6], .frameA = at(link[6])}));
    joints.push_back(world.create(FixedJoint{.bodyA = link[6], .bodyB = link[7], .frameA = {{0, 0, 1}, {}}}));
    world.setBreakLimits(joints.back(), {.force = 3, .torque = 3});
    D6Joint arm{.bodyB = link[4], .frameA = at(link[4])};
    arm.axes[0].motion = arm.axes[3].motion = arm.axes[4].motion = arm.axes[5].motion = AxisMotion::Free;
    arm.axes[0].spring = {.stiffness = 40};
    arm.slerp = {.stiffness = 5, .damping = 1};
    joints.push_back(world.create(arm));
    world.create(
        TetVolume{.bodies = {bodies[1], bodies[3], bodies[5], bodies[7]}, .restVolume = 0.05f, .stiffness = 100});
  }
};

}  // namespace avbd
