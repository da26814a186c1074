// Bodies: definitions and state.
#pragma once

#include <avbd/geometry.h>
#include <avbd/id.h>

#include <optional>
#include <vector>

namespace avbd {

enum class BodyType : uint8_t {
  Static,     ///< never moves
  Kinematic,  ///< moves at the velocity the user sets; nothing pushes it
  Dynamic,    ///< moved by forces
};

/// Axes that a dynamic body cannot move along or turn about (world axes); combine with |.
enum Lock : uint8_t {
  kLockNone = 0,
  kLockLinearX = 1,
  kLockLinearY = 2,
  kLockLinearZ = 4,
  kLockAngularX = 8,
  kLockAngularY = 16,
  kLockAngularZ = 32,
  kLockAngular = 56,
};

/// Mass, centre and inertia that replace what the shapes give.
struct MassProperties {
  float mass = 1;                     ///< [kg] > 0
  Vec3 center{};                      ///< centre of mass in the body's frame [m]
  SymMat3 inertia{1, 1, 1, 0, 0, 0};  ///< about the centre, in the body's axes [kg m^2]; positive definite
};

/// A body to create. Either `shape` (one shape at the body's origin, with `density`, `material`, `filter`) or
/// `shapes`, or both, or neither (then a dynamic body needs massProperties). Static and kinematic bodies have no mass;
/// the origin of their frame stands for their centre of mass.
struct BodyDef {
  BodyType type = BodyType::Dynamic;
  Vec3d position{};        ///< of the body's frame, in the world [m]
  Quat rotation{};         ///< body to world; length 1 within 1e-3, made exact on creation
  Vec3 linearVelocity{};   ///< of the centre of mass [m/s], world axes
  Vec3 angularVelocity{};  ///< [rad/s], world axes
  std::optional<Geometry> shape{};
  float density = 1000;  ///< of `shape` [kg/m^3]
  float mass = 0;        ///< [kg]; > 0 scales mass and inertia of the shapes to this mass, 0 keeps their densities'
  Material material{};   ///< of `shape`
  Filter filter{};       ///< of `shape`
  std::vector<ShapeDef> shapes{};
  std::optional<MassProperties> massProperties{};  ///< overrides mass, centre and inertia
  float linearDamping = 0;                         ///< [1/s] >= 0: v decays as exp(-damping t)
  float angularDamping = 0;                        ///< [1/s] >= 0
  float gravityScale = 1;
  uint8_t locks = kLockNone;
  float maxLinearSpeed = 1e4f;   ///< [m/s] > 0; faster velocities are scaled down at the end of the step
  float maxAngularSpeed = 1e3f;  ///< [rad/s] > 0
  /// Outer iterations, 0 .. 1000; 0: the world's. All that touch or are jointed take the most of what their bodies ask
  /// for.
  int iterations = 0;
  /// Stops where it would pass through something within a step (WorldDef::continuous). A kinematic body: takes along
  /// what it would pass through.
  bool continuous = true;
  bool canSleep = true;  ///< it may fall asleep by itself, with all that touches it (WorldDef::sleep)
  uint64_t userData = 0;
};

/// Linear velocity of the centre of mass [m/s] and angular velocity [rad/s], world axes.
struct Velocity {
  Vec3 linear, angular;
  friend bool operator==(const Velocity&, const Velocity&) = default;
};

}  // namespace avbd
