// The kinds of joints that acceptance tries one by one.
#pragma once

#include <span>

#include "scenes/build.h"

namespace avbd::scenes {

enum class JointKind : uint8_t { Fixed, Spherical, Revolute, Prismatic, D6, Distance, Rope, Cone, Pulley, Universal };

inline constexpr JointKind kJointKinds[] = {
    JointKind::Fixed,    JointKind::Spherical, JointKind::Revolute, JointKind::Prismatic, JointKind::D6,
    JointKind::Distance, JointKind::Rope,      JointKind::Cone,     JointKind::Pulley,    JointKind::Universal};

const char* nameOf(JointKind kind);
/// Joins points that may stand apart: distance, rope and pulley.
bool spans(JointKind kind);

/// Where a joint stands in the world: its points on either body (the same one, but where it spans) and its frame.
struct Spot {
  Vec3d a, b;
  Quat frame{};
};

inline constexpr double kConeAngle = 3.14159265358979323846 / 6;

/// A null body is the world. Revolute turns about the frame's x axis, prismatic slides along it, cone and universal
/// point along it. The D6 turns about its y axis alone, as a swing.
JointId connect(Build& build, JointKind kind, BodyId a, BodyId b, const Spot& at);

/// How a box of 4 kg is held from the world's origin: below it, or with its centre one metre beside it, where the joint
/// carries a torque too.
struct Holding {
  JointKind kind;
  bool beside = false;
  Quat frame{};
};
/// Each kind below, and those that carry a torque beside too. A cone beside rests on its stop, 30 degrees lower.
std::span<const Holding> holdings();

}  // namespace avbd::scenes
