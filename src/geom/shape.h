// A shape as the collision code sees it: plain data, poses relative to an origin near both shapes.
#pragma once

#include <avbd/geometry.h>

namespace avbd {

/// Convex shapes first, then those that only static and kinematic bodies may have: of a pair the first is convex.
enum class ShapeType : uint8_t {
  Sphere,
  Capsule,
  Box,
  Cylinder,
  Cone,
  Ellipsoid,
  RoundedBox,
  Hull,
  Triangle,  ///< one of a Mesh or HeightField; only within the collision code
  HalfSpace,
  Mesh,
  HeightField
};
inline constexpr int kShapeTypeCount = 12;

/// A core and a ball of `radius` that sweeps it. Sphere: a point. Capsule: extent.y = half height (axis y). Box,
/// RoundedBox: extent = half extents. Cylinder, Cone: extent.x = extent.z = the core's radius, extent.y = half height.
/// Ellipsoid: extent = half axes, radius 0. HalfSpace: nothing. The others: `data`, and Mesh and HeightField
/// `scale`.
struct ShapeGeom {
  ShapeType type = ShapeType::Sphere;
  float radius = 0;
  Vec3 extent;
  const void* data = nullptr;
  Vec3 scale{1, 1, 1};

  const HullData& hull() const { return *static_cast<const HullData*>(data); }  ///< its scale is applied
  const Vec3* triangle() const { return static_cast<const Vec3*>(data); }       ///< three, anticlockwise
  const MeshData& mesh() const { return *static_cast<const MeshData*>(data); }  ///< `scale` is not applied
  const HeightFieldData& heights() const { return *static_cast<const HeightFieldData*>(data); }  ///< nor here
};

/// Whether a ShapeGeom of this type is a convex core with a radius.
constexpr bool isConvex(ShapeType type) { return type < ShapeType::HalfSpace; }
/// Mesh or HeightField.
constexpr bool isSurface(ShapeType type) { return type > ShapeType::HalfSpace; }
/// Whether only static and kinematic bodies may have it.
bool isOnlyFixed(const Geometry& geometry);
/// "Sphere", "Hull" ...
const char* geometryName(const Geometry& geometry);

/// The plain data of a geometry. A Hull with a scale has its scaled data made here (or found, if some shape has it);
/// `keep` then holds it, and must live as long as the ShapeGeom. Otherwise the Geometry itself must live as long.
ShapeGeom toShapeGeom(const Geometry& geometry, std::shared_ptr<const HullData>& keep);
/// The same for geometries that need nothing kept: all but a scaled Hull.
ShapeGeom toShapeGeom(const Geometry& geometry);

/// Where a shape is, relative to an origin that the two shapes of a pair share (float is enough near it).
struct NearPose {
  Vec3 p;
  Quat q;
};

/// A point of a shape's frame in the frame that the pose is given in.
inline Vec3 operator*(const NearPose& pose, Vec3 point) { return pose.p + rotate(pose.q, point); }

}  // namespace avbd
