// Primal and dual iterations, batch by batch.
#include "step/begin_rows.h"
#include "step/keep_momentum.h"
#include "step/settings.h"

namespace avbd {

namespace {

/// At most, of an island with elements: what a search leaves undone slows the motion of what is stiff.
constexpr int kElasticKrylov = 24;

void solveBatch(const WorldData& world, StepData& step, uint32_t index, Jobs* jobs, int worker) {
  const BatchRange& batch = step.batches[index];
  SolveSettings settings = withIterations(step.solve, batch.iterations);
  if (batch.hasElements() && world.def.krylovIterations == 0) settings.krylovIterations = kElasticKrylov;
  Forest* forest = batch.forest != kNone ? &step.forests[batch.forest] : nullptr;
  const auto at = static_cast<size_t>(worker);
  // Colours know nothing of elements.
  if (world.def.primalSolver == PrimalSolver::BlockSweep && !batch.hasElements()) {
    const Colors colors{step.coloring.ofOrder.data() + batch.orderBegin, step.coloring.colors};
    solveSweep(step.view(index), *step.backend, settings, colors, step.sweep[at]);
  } else {
    solveKrylov(step.view(index), {*step.backend, jobs}, settings, forest, step.krylov[at]);
  }
  keepMomentum(world, step, batch);
}

}  // namespace

void solveBlocks(WorldData& world, StepData& step) {
  const auto workers = static_cast<size_t>(step.jobs->workers());
  step.sweep.resize(workers), step.krylov.resize(workers);
  forBatches(step, [&](uint32_t batch, Jobs* jobs, int worker) { solveBatch(world, step, batch, jobs, worker); });
}

}  // namespace avbd
