// What the files of the family "any two convex shapes" share: a contact in the making, and faces that may carry it.
#pragma once

#include "collide/clip.h"
#include "collide/support_nearest.h"

namespace avbd {

/// Two shapes and what counts as equal between them.
struct CoreContact {
  const ShapePair& shapes;
  const CorePair& pair;
  double tolerance;  ///< length that makes no difference
  double beyond;     ///< farthest core points that count
};

/// Part of a separation that makes no difference: what a face may show less than the best direction.
inline double slackOf(const CoreContact& c, double separation) {
  constexpr double kRelative = 0.02;
  return c.tolerance + kRelative * (separation < 0 ? -separation : separation);
}

/// A face of a or b that may carry the contact.
struct CarrierFace {
  SupportFace face;            ///< in its shape's frame
  Vec3d normal;                ///< unit, from a to b, in a's frame
  double separation = -1e300;  ///< of the cores, along the normal
  bool isFace = false;
};

/// The faces of both shapes that separate them most, without looking for the direction of least depth; false if one of
/// them separates by more than c.beyond.
bool bestFaces(const CoreContact& c, CarrierFace& a, CarrierFace& b);

/// Whether the best direction can hardly be better than this face, which `found` was cut with: a lower bound of the
/// depth is within the slack.
bool isProven(const CoreContact& c, const CarrierFace& face, const ClipResult& found);

}  // namespace avbd
