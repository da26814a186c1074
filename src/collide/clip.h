// Faces of two convex cores that touch -> the points of a manifold.
//
// The other core's face is cut by the side planes of the reference face (Sutherland-Hodgman), heights above the
// reference are measured along the normal, and at most four points stay. A point is named by the two lines that meet in
// it, edges of the cut face or sides of the reference, so its name lasts as long as the same things meet.
#pragma once

#include "collide/convex.h"

namespace avbd {

/// The two faces in one frame.
struct FacePair {
  const SupportFace& reference;  ///< a face (count > 2), an edge, or an unbounded plane (count 0) through point[0]
  const SupportFace& incident;
  Vec3 normal;      ///< unit, from the reference's core to the other one; points are measured along it
  float tolerance;  ///< length that makes no difference
  float beyond;     ///< points higher than this are left out
  bool swapped;     ///< which of the two comes first in names
};

/// Positions on the reference, heights and names; at most four.
struct ClipPoint {
  Vec3 onReference;
  float height;
  uint32_t feature;
};
struct ClipResult {
  int count = 0;
  ClipPoint point[kMaxManifoldPoints];
  float lowest = 0;  ///< height of the lowest point, if any
  float middle = 0;  ///< height of the cut face's middle above the reference
  float inside = 0;  ///< how far inside the reference's sides that middle lies
};
void clipFaces(const FacePair& pair, ClipResult& out);

}  // namespace avbd
