// A ray against one shape, in the shape's frame and in double: exact but for its rounding.
#pragma once

#include "geom/shape.h"
#include "query/frame.h"

namespace avbd {

struct LocalRay {
  Vec3d from;
  Vec3d direction;    ///< unit
  double length = 0;  ///< [m]
};

struct LocalHit {
  double distance = -1;  ///< negative: no hit. 0: starts inside
  Vec3d normal;          ///< unit, out of the shape; against the ray where it starts inside
  explicit operator bool() const { return distance >= 0; }
};

/// Whether rayShape() knows a shape of this type and radius in closed form; others go through cast() of
/// collide/convex.h.
bool hasExactRay(const ShapeGeom& geom);
/// Spheres, capsules, boxes with and without rounding, ellipsoids, half-spaces; hulls, cylinders and cones without.
LocalHit rayShape(const ShapeGeom& geom, const LocalRay& ray);
/// Front or back face of a triangle; neighbours that share two corners leave no crack between them.
LocalHit rayTriangle(const Vec3 (&v)[3], const LocalRay& ray, bool backFaces);

}  // namespace avbd
