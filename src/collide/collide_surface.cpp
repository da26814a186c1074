// A convex shape against a surface (collide_surface.h).
#include "collide/collide_surface.h"

namespace avbd {

void collideSurface(const ShapeGeom&, const NearPose&, const ShapeGeom&, const NearPose&, float,
                    std::vector<SurfacePatch>& out) {
  out.clear();
}

}  // namespace avbd
