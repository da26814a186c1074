// The words in which the scenes are written.
#pragma once

#include "scenes/scene.h"

namespace avbd::scenes {

inline constexpr float kFriction = 0.6f;
inline constexpr float kGravity = 9.81f;

/// Rotation by an angle [rad] about a unit axis.
Quat turned(Vec3 axis, double angle);
/// The shortest turn that takes x to a unit axis.
Quat along(Vec3 axis);

/// A model under construction: every call adds one body.
class Build {
 public:
  explicit Build(std::string name, const Settings& settings = {}, WorldDef def = {});

  /// Surface of the shapes that follow; the pair of two equal surfaces has this same value.
  Build& friction(float mu);
  Build& surface(const Material& material);
  Build& filter(const Filter& filter);

  BodyId fixedBox(std::string name, Box box, Vec3d at, Quat rotation = {});
  /// The static box of half extents (100, 1, 100) whose top is y = 0.
  BodyId ground();
  BodyId box(std::string name, Box half, Vec3d at, float mass, Velocity velocity = {}, Quat rotation = {});
  BodyId add(std::string name, BodyDef def);
  BodyId ball(std::string name, float radius, Vec3d at, float mass, Velocity velocity = {});
  /// A soft body whose particles are named by it and a number.
  SoftId soft(const std::string& name, const SoftDef& def);
  /// A ball joint at a world point; a null body is the world.
  JointId joint(BodyId a, BodyId b, Vec3d at);
  /// `def` between two bodies, both its frames at this world pose; a null body is the world.
  template <class Joint>
  JointId join(Joint def, BodyId a, BodyId b, const Pose& at) {
    def.bodyA = a;
    def.bodyB = b;
    def.frameA = inBody(a, at);
    def.frameB = inBody(b, at);
    return model_.world.create(def);
  }
  /// A world pose as the body sees it.
  Pose inBody(BodyId id, const Pose& at) const;
  /// Tells a coordinate of a joint by this name.
  void name(std::string name, JointId joint, JointAxis axis) {
    model_.joints.push_back({std::move(name), joint, axis});
  }

  World& world() { return model_.world; }
  Model take() { return std::move(model_); }

 private:
  Model model_;
  Material material_;
  Filter filter_;
};

/// A body that collides with nothing.
inline constexpr Filter kGhost{.category = 1, .mask = 0, .group = 0, .anyMask = false};

/// The generator of the disordered scenes: s = 1664525 s + 1013904223, draws in -1 .. 1.
class Draws {
 public:
  explicit Draws(uint32_t seed) : state_(seed) {}
  float next() {
    state_ = state_ * 1664525u + 1013904223u;
    return 2 * (static_cast<float>(state_ >> 8) / 16777216.0f) - 1;
  }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>((next() + 1) * 0.5f * static_cast<float>(n)) % n; }

 private:
  uint32_t state_;
};

std::string text(double value);  ///< short: "0.6", "1000"

}  // namespace avbd::scenes
