// The scenes that sessions begin with: small, and rich in contacts, so that few bytes lead to much.
#include "fuzz/session.h"
#include "fuzz/surfaces.h"

namespace avbd::fuzz {

void Session::add(const BodyDef& def) {
  BodyDef placed = def;
  placed.position = def.position + offset_;
  bodies_.push_back(world_.create(placed));
  for (const ShapeId shape : world_.shapes(bodies_.back())) shapes_.push_back(shape);
}

void Session::begin(uint32_t scene, int count) {
  // The scenes are in metres; another length unit begins with nothing.
  if (world_.definition().lengthUnit != 1) return;
  if (scene == 1 || scene == 5) pile(count);
  if (scene == 2) chain(count);
  if (scene == 6) arm(count);
  if (scene == 3) hills(count);
  if (scene == 4 || scene == 7) machine(count);
}

/// Shapes of all kinds on a plane.
void Session::pile(int count) {
  add({.type = BodyType::Static, .shape = HalfSpace{}, .material = {.restitution = 0.3f}});
  const Geometry kinds[] = {Box{},
                            Sphere{},
                            Cylinder{0.4f, 0.5f, 0},
                            Hull{someHull(), {0.6f, 0.6f, 0.6f}, 0},
                            Capsule{0.3f, 0.4f},
                            Cone{0.5f, 0.5f, 0.05f},
                            Box{0.4f, 0.3f, 0.5f, 0.1f},
                            Ellipsoid{0.5f, 0.3f, 0.4f},
                            Hull{someHull(), {-0.5f, 0.7f, 0.5f}, 0.05f},
                            Box{}};
  for (int i = 0; i < count; ++i)
    add({.position = {0.1 * i, 0.55 + 1.0 * i, 0},
         .shape = kinds[i],
         .material = {.torsionalFriction = i % 3 ? 0 : 0.1f, .rollingFriction = i % 4 ? 0 : 0.05f}});
}

/// Hangs from the world; every third link is welded.
void Session::chain(int count) {
  BodyId last{};
  for (int i = 0; i < count; ++i) {
    add({.position = {0.5 + i, 5, 0},
         .shape = i % 2 ? Geometry{Capsule{0.2f, 0.2f}} : Geometry{Box{0.4f, 0.2f, 0.2f}}});
    const Pose frameA{i ? Vec3d{0.5, 0, 0} : offset_ + Vec3d{0, 5, 0}, {}}, frameB{{-0.5, 0, 0}, {}};
    if (i % 3 == 2)
      joints_.push_back(world_.create(FixedJoint{last, bodies_.back(), frameA, frameB}));
    else
      joints_.push_back(world_.create(BallJoint{last, bodies_.back(), frameA, frameB}));
    last = bodies_.back();
  }
  add({.type = BodyType::Static, .position = {3, 2, 0}, .shape = Cylinder{0.5f, 3, 0}});
}

/// A tree of all joints that an articulation may have, on a pedestal or floating, over a plane.
void Session::arm(int count) {
  add({.type = BodyType::Static, .shape = HalfSpace{}});
  const bool floating = count % 2 == 1;
  BodyId parent{};
  for (int i = 0; i <= count; ++i) {
    const Vec3d at{0.7 * i, 2 + 0.3 * (i % 3), 0.4 * (i % 2)};
    add({.position = at, .shape = i % 3 == 1 ? Geometry{Capsule{0.12f, 0.3f}} : Geometry{Box{0.3f, 0.15f, 0.2f}}});
    const BodyId child = bodies_.back();
    // The frames lie half way; every fourth link goes on from the first.
    const Vec3d from = parent ? world_.pose(parent).position : Vec3d{},
                half = (world_.pose(child).position - from) * 0.5;
    const Pose frameA{parent ? half : offset_ + at, {}}, frameB{parent ? half * -1.0 : Vec3d{}, {}};
    if (parent || !floating) addTreeJoint(i, {parent, child}, {frameA, frameB});
    parent = i % 4 == 3 ? bodies_[1] : child;
  }
}

void Session::addTreeJoint(int kind, std::array<BodyId, 2> ends, const std::array<Pose, 2>& frames) {
  using enum JointAxis;
  const auto [a, b] = ends;
  const auto& [frameA, frameB] = frames;
  D6Joint d6{.bodyA = a, .bodyB = b, .frameA = frameA, .frameB = frameB};
  for (const JointAxis axis : {LinearX, Twist, SwingY, SwingZ})
    if (kind & 1 || axis != LinearX) d6.axes[static_cast<size_t>(axis)].motion = AxisMotion::Free;
  const JointDrive drive{.stiffness = 50, .damping = 5};
  switch (kind % 6) {
    case 0:
    case 1:
      return joints_.push_back(world_.create(HingeJoint{
          .bodyA = a, .bodyB = b, .frameA = frameA, .frameB = frameB, .drive = drive, .collideConnected = kind == 1}));
    case 2:
      return joints_.push_back(world_.create(SliderJoint{
          .bodyA = b, .bodyB = a, .frameA = frameB, .frameB = frameA, .limit = {.lower = -0.5f, .upper = 0.5f}}));
    case 3:
      return joints_.push_back(world_.create(BallJoint{a, b, frameA, frameB}));
    case 4:
      return joints_.push_back(world_.create(d6));
    default:
      return joints_.push_back(world_.create(FixedJoint{a, b, frameA, frameB}));
  }
}

/// A mesh and a height field with something on each.
void Session::hills(int count) {
  add({.type = BodyType::Static, .shape = Mesh{someMesh()}});
  add({.type = BodyType::Static, .position = {10, 0, 0}, .shape = HeightField{someField()}});
  const Geometry kinds[] = {Box{0.4f, 0.4f, 0.4f}, Sphere{0.4f}, Hull{someHull(), {0.5f, 0.5f, 0.5f}, 0},
                            Capsule{0.2f, 0.4f}, Cylinder{0.3f, 0.3f, 0.02f}};
  for (int i = 0; i < count; ++i)
    add({.position = {i % 2 ? 10.0 + 0.4 * i : 0.5 * i - 1, 0.7 + 0.4 * i, 0.3 * i - 1}, .shape = kinds[i % 5]});
}

/// A moving platform with a belt, a trigger over it, and four bodies that keep a volume.
void Session::machine(int count) {
  add({.type = BodyType::Kinematic,
       .linearVelocity = {0.5f, 0, 0},
       .angularVelocity = {0, 0.3f, 0},
       .shapes = {{.geometry = Box{4, 0.25f, 4}, .hitEvents = true, .contactHook = true}}});
  add({.type = BodyType::Static, .shapes = {{.geometry = Box{2, 1, 2}, .pose = {{0, 1, 0}, {}}, .isTrigger = true}}});
  for (int i = 0; i < count; ++i)
    add({.position = {0.3 * (i % 3), 0.8 + 1.1 * (i / 2), i % 2 ? 0.6 : -0.6},
         .shape = i % 2 ? Geometry{Sphere{0.5f}} : Geometry{Box{0.5f, 0.5f, 0.5f}}});
  if (count < 4) return;
  const std::array<BodyId, 4> corners{bodies_[2], bodies_[3], bodies_[4], bodies_[5]};
  joints_.push_back(world_.create(TetVolume{.bodies = corners, .stiffness = count % 2 ? 0 : 1e5f}));
}

}  // namespace avbd::fuzz
