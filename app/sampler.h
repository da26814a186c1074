// Which steps of a run are looked at.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace avbd::cli {

/// Frame k is the step nearest to k / fps; step 0 is the state before the first step. With more frames a second than
/// steps each step is one.
class Sampler {
 public:
  Sampler(double fps, double dt) : stepsPerFrame_(std::max(1.0, 1 / (fps * dt))) {}

  /// To be asked for every step in order.
  bool due(int64_t step) {
    if (step < next_) return false;
    while (next_ <= step) next_ = std::llround(static_cast<double>(++frame_) * stepsPerFrame_);
    return true;
  }

 private:
  double stepsPerFrame_;
  int64_t frame_ = 0, next_ = 0;
};

}  // namespace avbd::cli
