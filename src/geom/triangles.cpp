// Triangles of surfaces near something (triangles.h).
#include "geom/triangles.h"

namespace avbd {

void forEachTriangle(const ShapeGeom&, const Aabb&, FunctionRef<bool(const SurfaceTriangle&)>) {}
void forEachTriangleAlong(const ShapeGeom&, Vec3, Vec3, Vec3, FunctionRef<float(const SurfaceTriangle&, float)>) {}
Aabb surfaceBounds(const ShapeGeom&) { return {}; }

}  // namespace avbd
