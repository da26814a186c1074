// Depth of two overlapping convex cores (expanding polytope, van den Bergen 2001), in double.
//
// A polytope of points of the difference b - a grows inside it. Its face nearest to the origin is a lower bound of the
// depth, the lowest point of the difference across that face an upper bound; the point is added and the next nearest
// face looked at. The search ends where the bounds agree within a tolerance, which so is proven for every answer; for
// cores with flat faces only they agree up to rounding after finitely many points.
#pragma once

#include "collide/gjk.h"

namespace avbd {

struct Depth {
  double depth = 0;   ///< the translation of b along `normal` that parts the cores
  double lower = 0;   ///< no translation shorter than this does
  Vec3d normal;       ///< unit, from a to b
  Simplex face;       ///< with the weights of the point where the face meets the normal
  bool flat = false;  ///< the difference has no volume: depth 0, normal across it
};

/// `simplex`: points of the difference to begin with. tolerance: of the pair's size.
void epa(const CorePair& pair, const Simplex& simplex, double tolerance, Depth& out);

}  // namespace avbd
