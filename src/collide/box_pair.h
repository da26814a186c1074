// Two boxes as the files of the box-box family share them.
#pragma once

#include "collide/collide_pairs.h"

namespace avbd {

/// Box b seen from box a and the reverse.
struct BoxPair {
  float ha[3], hb[3];  ///< half extents
  float r[3][3];       ///< column j is b's axis j in a's frame
  float absR[3][3];
  float da[3];      ///< from a's centre to b's, in a's frame
  float db[3];      ///< the same in b's frame
  float tolerance;  ///< length that makes no difference, a small part of the thinnest extent
  float margin;
};

/// An edge of each box that separates them best, or holds them together least.
struct EdgeAxis {
  int i = -1, j = -1;  ///< axes of a and b that it is the cross product of; -1: none
  float separation = 0;
  Vec3 normal;  ///< unit, from a to b, in a's frame
};

/// A point in the frame that it was found in.
struct FacePoints {
  int count = 0;
  float lowest = 0;  ///< smallest separation of all points of the cut face, also of those left out
  ManifoldPoint points[kMaxManifoldPoints];
};

/// A box and how the other one lies in its frame; face: 2 axis + (1 if on the positive side).
struct FaceView {
  const float* h;      ///< extents of the box whose face it is
  const float* other;  ///< extents of the other box
  float center[3];     ///< of the other box
  float turn[3][3];    ///< column j is the other box's axis j
  int face;
  float tolerance, margin;
};

/// The other box's face that looks at the reference face, cut by its side planes, at most four points of it.
void clipFace(const FaceView& view, FacePoints& out);

/// The nearest points of two boxes that are apart, in a's frame, and their distance. The normal is set only where that
/// is no less than the tolerance: below, it would be rounding.
float touchNearest(const BoxPair& pair, Manifold& out);

}  // namespace avbd
