// Shapes: what a body collides with, its surface material and filter.
#pragma once

#include <avbd/types.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

namespace avbd {

class HullData;
class MeshData;
class HeightFieldData;

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

// Shapes with `rounding` are swept by a ball of that radius [m] >= 0: edges become round and all sizes grow by it.

/// Box about the shape's origin with half extents [m], each > 0.
struct Box {
  float x = 0.5f, y = 0.5f, z = 0.5f;
  float rounding = 0;
};

/// Cylinder along the shape's y axis about its origin. radius and halfHeight [m] > 0.
struct Cylinder {
  float radius = 0.5f;
  float halfHeight = 0.5f;
  float rounding = 0;
};

/// Cone along the shape's y axis: the base at y = -halfHeight, the tip at y = halfHeight. radius and halfHeight [m] >
/// 0.
struct Cone {
  float radius = 0.5f;
  float halfHeight = 0.5f;
  float rounding = 0;
};

/// Ellipsoid about the shape's origin with half axes [m], each > 0.
struct Ellipsoid {
  float x = 0.5f, y = 0.5f, z = 0.5f;
};

/// Convex hull (hull.h: makeHull). scale: each component finite, not 0, |scale| 1e-3 .. 1e3; negative ones mirror.
struct Hull {
  std::shared_ptr<const HullData> data;
  Vec3 scale{1, 1, 1};
  float rounding = 0;
};

/// Everything below the shape's plane y = 0: solid, unbounded. Only for static and kinematic bodies.
struct HalfSpace {};

/// Triangles (mesh.h: makeMesh). Only for static and kinematic bodies. scale as for Hull.
struct Mesh {
  std::shared_ptr<const MeshData> data;
  Vec3 scale{1, 1, 1};
};

/// Terrain (height_field.h: makeHeightField). Only for static and kinematic bodies. scale as for Hull, but positive.
struct HeightField {
  std::shared_ptr<const HeightFieldData> data;
  Vec3 scale{1, 1, 1};
};

using Geometry = std::variant<Sphere, Capsule, Box, HalfSpace, Cylinder, Cone, Ellipsoid, Hull, Mesh, HeightField>;

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
  /// [m] >= 0: a contact resists turning about its normal up to this times the normal force (MuJoCo's torsional
  /// coefficient). Combined as friction is.
  float torsionalFriction = 0;
  /// [m] >= 0: a contact resists rolling up to this times the normal force. Combined as friction is.
  float rollingFriction = 0;
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
  /// Surfaces of a Mesh or HeightField: its triangles' material indices point in here, so there must be enough. Empty:
  /// all are `material`. At most 65535.
  std::vector<Material> materials{};
  Filter filter{};
  /// Touches nothing, has no mass and does not change how its body moves; reports what enters and leaves it (events.h):
  /// by the filter, shapes of dynamic and kinematic bodies, convex ones if it is not convex itself. It sees neither
  /// static bodies nor other triggers. A Mesh is its triangles alone, from both sides: what is inside a closed one has
  /// left it (decompose.h makes hulls of it). A HeightField is solid down to its thickness.
  bool isTrigger = false;
  bool contactEvents = true;  ///< begin and end of its contacts are reported; of a pair both must want it
  bool hitEvents = false;     ///< hits harder than WorldDef::hitSpeed are reported; one of the pair must want it
  bool contactHook = false;   ///< World's contact hook sees its contacts; one of the pair must want it
  uint64_t userData = 0;
};

}  // namespace avbd
