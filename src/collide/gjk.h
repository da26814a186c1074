// Distance of two convex cores (Gilbert, Johnson, Keerthi 1988), in double.
//
// A simplex of points of the difference b - a walks towards the origin: its nearest point v is an upper bound of the
// distance, the lowest point of the difference along v a lower one. The walk ends where the two agree, where the
// simplex cannot improve, or where it holds the origin.
#pragma once

#include "collide/support.h"

namespace avbd {

struct Simplex {
  int count = 0;
  DifferencePoint point[4];
  double weight[4] = {};  ///< of the points in the one nearest to the origin
};

enum class GjkResult {
  Apart,   ///< farther than `beyond`; `lower` says by how much at least
  Near,    ///< v is from a to b
  Overlap  ///< the origin is in the difference, up to kTouching of the size
};

struct Gjk {
  GjkResult result = GjkResult::Overlap;
  Simplex simplex;
  Vec3d v;           ///< from a's nearest point to b's
  double lower = 0;  ///< lower bound of the distance
};

inline constexpr double kTouching = 1e-9;  ///< of the size: cores no farther apart count as overlapping

/// Ends early once the cores are known to be farther apart than `beyond`. `start`: a guess of the direction a to b.
Gjk gjk(const CorePair& pair, Vec3d start, double beyond);

/// The nearest points' one on a.
inline Vec3d pointOnA(const Simplex& s) {
  Vec3d p = s.point[0].a * s.weight[0];
  for (int i = 1; i < s.count; ++i) p = p + s.point[i].a * s.weight[i];
  return p;
}

}  // namespace avbd
