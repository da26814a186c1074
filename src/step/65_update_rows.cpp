// Last dual update: the multipliers become the forces at the end of the step, whole; the leak is taken when the next
// step picks them up.
#include "solve/linked_joint.h"
#include "solve/scalar_joint.h"
#include "step/step_data.h"

namespace avbd {

void updateRows(WorldData& world, StepData& step) {
  SolveSettings settings = step.solve;
  settings.contactLeak = 1;
  for (size_t i = 0; i < step.batches.size(); ++i) {
    step.backend->updateRows(step.view(i), settings);
    // Couplings read where scalar joints are, not their multipliers: the order is free.
    updateScalar(step.view(i));
    // The Krylov solver leaves whole forces.
    if (world.def.primalSolver == PrimalSolver::BlockSweep) updateLinked(step.view(i));
  }
}

}  // namespace avbd
