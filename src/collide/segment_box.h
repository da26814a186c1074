// The point of a segment nearest to a box centred at the origin, in the box's frame: exact, without iteration.
#pragma once

#include "collide/pair_math.h"

namespace avbd {

/// Half the derivative by t of the squared distance from center + t half to the box: grows with t, in straight pieces.
inline float distanceSlope(const Axes& center, const Axes& half, const Axes& extent, float t) {
  float slope = 0;
  for (int i = 0; i < 3; ++i) {
    const float x = center[i] + t * half[i];
    slope += half[i] * (x - clampTo(x, -extent[i], extent[i]));
  }
  return slope;
}

/// t in -1 .. 1 of the point center + t half that is nearest to the box; the middle where there are many.
inline float nearestToBox(const Axes& center, const Axes& half, const Axes& extent) {
  float low = -1, high = 1;  // the slope is <= 0 at low, >= 0 at high
  float slopeLow = distanceSlope(center, half, extent, low), slopeHigh = distanceSlope(center, half, extent, high);
  if (slopeLow > 0) return -1;
  if (slopeHigh < 0) return 1;
  float flatLow = 2, flatHigh = -2;  // where the slope is zero
  if (slopeLow == 0) flatLow = flatHigh = -1;
  if (slopeHigh == 0) {
    flatLow = smaller(flatLow, 1);
    flatHigh = 1;
  }
  for (int i = 0; i < 3; ++i) {
    if (half[i] == 0) continue;
    for (int side = -1; side <= 1; side += 2) {
      const float t = (static_cast<float>(side) * extent[i] - center[i]) / half[i];
      if (!(t > low && t < high)) continue;
      const float slope = distanceSlope(center, half, extent, t);
      if (slope < 0) {
        low = t;
        slopeLow = slope;
      } else if (slope > 0) {
        high = t;
        slopeHigh = slope;
      } else {
        flatLow = smaller(flatLow, t);
        flatHigh = larger(flatHigh, t);
      }
    }
  }
  if (flatLow <= flatHigh) return 0.5f * (flatLow + flatHigh);
  return low + (high - low) * (-slopeLow / (slopeHigh - slopeLow));
}

}  // namespace avbd
