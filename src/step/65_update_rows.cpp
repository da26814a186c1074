// Last dual update: the multipliers become the forces at the end of the step, whole; the leak is taken when the next
// step picks them up.
#include "solve/linked_joint.h"
#include "solve/scalar_joint.h"
#include "step/begin_rows.h"

namespace avbd {

void updateRows(WorldData& world, StepData& step) {
  SolveSettings settings = step.solve;
  settings.contactLeak = 1;
  forUnits(step,
           [&](const WorkUnit& unit) { step.backend->updateContacts(step.view(unit.batch), settings, unit.tiles); });
  forBatches(step, [&](uint32_t batch, Jobs*, int) {
    const BatchView view = step.view(batch);
    step.backend->updateOthers(view, settings);
    // Couplings read where scalar joints are, not their multipliers: the order is free.
    updateScalar(view);
    // The Krylov solver leaves whole forces.
    if (world.def.primalSolver == PrimalSolver::BlockSweep) updateLinked(view);
  });
}

}  // namespace avbd
