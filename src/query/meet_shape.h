// A ray or a moving convex shape against one shape of the world.
#pragma once

#include "query/query.h"

namespace avbd {

/// What a search needs to ask one shape: which, where, and the whole way of the search. Where a cast starts depends on
/// nothing else, so that closest, all and any agree and do not depend on the world's past.
struct Candidate {
  const ShapeData& shape;
  uint32_t slot;
  Pose pose;
  const BoxWay& whole;
};

/// Ray, on the part of the whole way that is left. backFaces: one-sided triangles are met from behind too.
WayHit meetRay(const Candidate& candidate, Vec3d from, const Way& way, bool backFaces);
/// Convex shape.
WayHit meetPlaced(const Candidate& candidate, const Placed& placed, const Way& way, bool backFaces);

}  // namespace avbd
