// Shapes: what a body collides with, its surface material and filter.
#pragma once

#include <avbd/types.h>

#include <cstdint>
#include <limits>
#include <variant>

namespace avbd {

/// Ball about the shape's origin. radius [m] > 0.
struct Sphere {
  float radius = 0.5f;
};

/// Cylinder with hemispherical ends along the shape's y axis. radius [m] > 0; halfHeight [m] >= 0 is half the
/// cylinder's length without the ends.
struct Capsule {
  float radius = 0.5f;
  float halfHeight = 0.5f;
};

/// Box about the shape's origin with half extents [m], each > 0.
struct Box {
  float x = 0.5f, y = 0.5f, z = 0.5f;
};

/// Everything below the shape's plane y = 0: solid, unbounded. Only for static and kinematic bodies.
struct HalfSpace {};

using Geometry = std::variant<Sphere, Capsule, Box, HalfSpace>;

/// How the coefficients of two touching materials become one. The rule with the larger value wins.
enum class Combine : uint8_t { GeometricMean, Average, Minimum, Multiply, Maximum };

/// Surface of a shape.
struct Material {
  float friction = 0.5f;      ///< Coulomb coefficient while slipping, >= 0
  float staticFriction = -1;  ///< while sticking, >= friction; -1 means equal to friction
  float restitution = 0;      ///< 0 .. 1: rebound speed over approach speed
  Combine frictionCombine = Combine::GeometricMean;
  Combine restitutionCombine = Combine::Maximum;
  /// Of two touching shapes the one with the larger priority alone gives friction and restitution; equal priorities
  /// combine (MJCF's rule).
  int32_t frictionPriority = 0;
};

/// Which shapes may touch. Two shapes collide if they share a positive group; never if they share a negative one;
/// otherwise if each one's category meets the other's mask (or, with anyMask, if either does).
struct Filter {
  uint32_t category = 1;
  uint32_t mask = 0xffffffffu;
  int32_t group = 0;
  bool anyMask = false;  ///< MJCF's rule: one of the two directions is enough; applies if both shapes set it
};

/// A shape to put on a body.
struct ShapeDef {
  Geometry geometry = Sphere{};
  Pose pose{};           ///< in the body's frame
  float density = 1000;  ///< [kg/m^3] >= 0; where BodyDef.mass is given only ratios count. HalfSpace has no mass.
  Material material{};
  Filter filter{};
  uint64_t userData = 0;
};

}  // namespace avbd
