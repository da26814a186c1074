// How deep shapes overlap, measured in double and independently of the engine's own collision code.
#pragma once

#include <avbd/geometry.h>

#include <functional>
#include <span>

namespace avbd::scenes {

/// A shape where it is in the world.
struct PlacedShape {
  Geometry geometry;
  Pose pose;            ///< of the shape, in the world
  uint32_t body = 0;    ///< shapes of one body never touch
  bool movable = true;  ///< two shapes that cannot move are no pair
};

/// Depths are the exact minimum translations that part the two shapes [m].
struct Penetration {
  double max = 0;
  double mean = 0;               ///< over the pairs that overlap
  size_t count = 0;              ///< pairs that overlap
  int shapeA = -1, shapeB = -1;  ///< the deepest pair, as indices into the shapes; -1 where nothing overlaps
};

/// Whether two shapes (by index) are to be measured.
using PairPredicate = std::function<bool(uint32_t, uint32_t)>;

/// Minimum translation that parts two shapes [m]; 0 where they are apart or only touch.
double penetrationDepth(const PlacedShape& a, const PlacedShape& b);

/// All pairs of shapes of different bodies of which at least one is movable and for which mayTouch (if given) holds.
Penetration measurePenetration(std::span<const PlacedShape> shapes, const PairPredicate& mayTouch = {});

}  // namespace avbd::scenes
