// What the files of the family "any two convex shapes" share: a contact in the making, and faces that may carry it.
#pragma once

#include "collide/clip.h"
#include "collide/support_nearest.h"

namespace avbd {

/// Two shapes and what counts as equal between them.
struct Contact {
  const ShapePair& shapes;
  const CorePair& pair;
  double tolerance;  ///< length that makes no difference
  double beyond;     ///< farthest core points that count
};

/// Part of a separation that makes no difference: what a face may show less than the best direction.
inline double slackOf(const Contact& c, double separation) {
  constexpr double kRelative = 0.02;
  return c.tolerance + kRelative * (separation < 0 ? -separation : separation);
}

/// A face of a or b that may carry the contact.
struct Candidate {
  SupportFace face;            ///< in its shape's frame
  Vec3d normal;                ///< unit, from a to b, in a's frame
  double separation = -1e300;  ///< of the cores, along the normal
  bool isFace = false;
};

/// The faces of both shapes that separate them most, without looking for the direction of least depth; false if one of
/// them separates by more than c.beyond.
bool bestFaces(const Contact& c, Candidate& a, Candidate& b);

/// Whether the best direction can hardly be better than this face, which `found` was cut with: a lower bound of the
/// depth is within the slack.
bool isProven(const Contact& c, const Candidate& face, const ClipResult& found);

}  // namespace avbd
