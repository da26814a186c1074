// Primal and dual iterations, batch by batch.
#include "step/keep_momentum.h"
#include "step/settings.h"

namespace avbd {

void solveBlocks(WorldData& world, StepData& step) {
  const bool sweep = world.def.primalSolver == PrimalSolver::BlockSweep;
  for (size_t i = 0; i < step.batches.size(); ++i) {
    const BatchRange& batch = step.batches[i];
    const SolveSettings settings = withIterations(step.solve, batch.iterations);
    Forest* forest = batch.forest != kNone ? &step.forests[batch.forest] : nullptr;
    if (sweep) {
      const Colors colors{step.coloring.ofOrder.data() + batch.orderBegin, step.coloring.colors};
      solveSweep(step.view(i), *step.backend, settings, colors, step.sweep);
    } else {
      solveKrylov(step.view(i), *step.backend, settings, forest, step.krylov);
    }
    keepMomentum(world, step, batch);
  }
}

}  // namespace avbd
