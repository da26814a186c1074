// Any two convex shapes (convex.h).
#include "collide/convex.h"

namespace avbd {

void collideConvex(const ShapePair&, Manifold&) {}
void collideConvexHalfSpace(const ShapePair&, Manifold&) {}

}  // namespace avbd
