// Primal and dual iterations, batch by batch.
#include "step/step_data.h"

namespace avbd {

void solveBlocks(WorldData&, StepData& step) {
  for (size_t i = 0; i < step.batches.size(); ++i) {
    Forest* forest = step.batches[i].forest != kNone ? &step.forests[step.batches[i].forest] : nullptr;
    solveKrylov(step.view(i), *step.backend, step.solve, forest, step.krylov);
  }
}

}  // namespace avbd
