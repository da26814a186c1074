// The touching points of two shapes, as the collision code returns them.
#pragma once

#include <avbd/types.h>

namespace avbd {

inline constexpr int kMaxManifoldPoints = 4;

struct ManifoldPoint {
  Vec3 position;         ///< halfway between the two surfaces, relative to the pair's origin
  float separation = 0;  ///< gap along the normal; negative where the shapes overlap
  uint32_t feature = 0;  ///< names the pair of features; the same from step to step as long as they are the same
};

/// Whose face a manifold's normal moves with; None: it depends on both.
enum class Carrier : uint8_t { None, A, B };

struct Manifold {
  Vec3 normal;  ///< unit, from A to B
  int count = 0;
  ManifoldPoint points[kMaxManifoldPoints];
  float clear = 0;  ///< what is not among the points is at least so far apart; 0: that is not known
  Carrier carrier = Carrier::None;
};

}  // namespace avbd
