// A shape as the collision code sees it: plain data, poses relative to an origin near both shapes.
#pragma once

#include <avbd/geometry.h>

namespace avbd {

enum class ShapeType : uint8_t { Sphere, Capsule, Box, HalfSpace };

/// Sphere: radius. Capsule: radius, extent.y = half height (axis y). Box: extent = half extents. HalfSpace: nothing.
struct ShapeGeom {
  ShapeType type = ShapeType::Sphere;
  float radius = 0;
  Vec3 extent;
};

ShapeGeom toShapeGeom(const Geometry& geometry);
Geometry toGeometry(const ShapeGeom& geom);

/// Where a shape is, relative to an origin that the two shapes of a pair share (float is enough near it).
struct NearPose {
  Vec3 p;
  Quat q;
};

}  // namespace avbd
