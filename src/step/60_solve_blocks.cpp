// Primal and dual iterations, batch by batch.
#include "step/keep_momentum.h"

namespace avbd {

void solveBlocks(WorldData& world, StepData& step) {
  for (size_t i = 0; i < step.batches.size(); ++i) {
    Forest* forest = step.batches[i].forest != kNone ? &step.forests[step.batches[i].forest] : nullptr;
    solveKrylov(step.view(i), *step.backend, step.solve, forest, step.krylov);
    keepMomentum(world, step, step.batches[i]);
  }
}

}  // namespace avbd
