// How the cores of two convex shapes lie, in a's frame and in double: what nearest() and the manifolds share.
#pragma once

#include "collide/gjk.h"

namespace avbd {

struct CoreNearest {
  bool apart = false;   ///< farther apart than asked for; then `distance` is a lower bound and nothing else is set
  double distance = 0;  ///< negative: depth
  Vec3d normal;         ///< unit, from a to b
  Vec3d onA;            ///< b's point is distance * normal further
  bool sharp = true;    ///< false: a depth of curved cores that may be too large by kCoarse of the size
};
inline constexpr double kCoarse = 1e-4;
CoreNearest coreNearest(const CorePair& pair, double beyond);
/// Makes an answer sharp that is not.
void sharpen(const CorePair& pair, CoreNearest& near);

}  // namespace avbd
