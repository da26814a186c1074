// A convex shape against a Mesh or HeightField -> one manifold for each direction and material in which it is touched.
#pragma once

#include <vector>

#include "geom/manifold.h"
#include "geom/shape.h"

namespace avbd {

struct SurfacePatch {
  Manifold manifold;      ///< normal from the convex shape to the surface
  uint32_t element = 0;   ///< triangle of the first point
  uint16_t material = 0;  ///< index into ShapeDef::materials
};

/// Finds the patches of `convex` (first) on `surface` within the margin, deepest first; none: out is empty. Edges and
/// corners inside a smooth surface make no contact of their own (no ghost edges).
void collideSurface(const ShapeGeom& convex, const NearPose& poseConvex, const ShapeGeom& surface,
                    const NearPose& poseSurface, float margin, std::vector<SurfacePatch>& out);

}  // namespace avbd
