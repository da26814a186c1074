// The triangles of a Mesh or HeightField shape near something, in the shape's frame with its scale applied.
#pragma once

#include "base/function_ref.h"
#include "geom/aabb.h"

namespace avbd {

/// One triangle of a surface and what lies beyond its edges. Edge i goes from v[i] to v[(i + 1) % 3].
struct SurfaceTriangle {
  Vec3 v[3];          ///< anticlockwise seen from the front
  Vec3 normal;        ///< unit, to the front
  Vec3 across[3];     ///< normal of the neighbour across edge i; `normal` itself where there is none
  bool isRim[3];      ///< no neighbour across edge i (or more than one)
  bool isConvex[3];   ///< the surface bends away from the front at edge i by more than rounding: a ridge
  uint32_t element;   ///< as contacts and queries name it
  uint16_t material;  ///< index into ShapeDef::materials
  bool doubleSided;
};

/// Calls f for every triangle whose bounds overlap the box (shape's frame), in an order that depends only on the data.
/// f may return false to stop.
void forEachTriangle(const ShapeGeom& surface, const Aabb& box, FunctionRef<bool(const SurfaceTriangle&)> f);

/// The same without looking up neighbours: all edges are given as rims.
void forEachBareTriangle(const ShapeGeom& surface, const Aabb& box, FunctionRef<bool(const SurfaceTriangle&)> f);
/// Looks up the neighbours of a bare triangle.
void findNeighbours(const ShapeGeom& surface, SurfaceTriangle& triangle);

/// Calls f for triangles that a box of these half extents (zero: a ray) may meet on its way from -> from + fraction
/// motion, nearest parts of the tree first. f returns the new fraction 0 .. 1 that is left to search: the one given to
/// go on as before, smaller to cut the way short, negative to stop. Neighbours are not looked up: all edges are given
/// as rims.
void forEachTriangleAlong(const ShapeGeom& surface, Vec3 from, Vec3 motion, Vec3 halfExtent,
                          FunctionRef<float(const SurfaceTriangle&, float fraction)> f);

/// Bounds in the shape's frame, with scale; of a HeightField down to its thickness below the lowest point.
Aabb surfaceBounds(const ShapeGeom& surface);

}  // namespace avbd
