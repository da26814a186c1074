// The step: advances a world by dt.
#pragma once

#include <memory>

#include "base/jobs.h"
#include "world/world_data.h"

namespace avbd {

struct StepData;

/// Owns the memory that a step works in; nothing in it survives a step.
class Stepper {
 public:
  Stepper();
  ~Stepper();
  /// Advances `world` by dt [s]. Throws NonFiniteError, or Error for an answer of the contact hook; poses, velocities
  /// and given forces are then those from before.
  void step(WorldData& world, float dt);

 private:
  std::unique_ptr<Jobs> jobs_;  ///< from the first step on
  std::unique_ptr<StepData> data_;
};

}  // namespace avbd
