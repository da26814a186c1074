// Rows: lays out the batches and fills masses, constants and remembered multipliers.
#include "step/begin_rows.h"

namespace avbd {

void beginRows(WorldData& world, StepData& step) {
  layOutBatches(world, step);
  fillBodies(world, step);
  fillContacts(world, step);
  fillJoints(world, step);
  for (size_t i = 0; i < step.batches.size(); ++i) step.backend->prepareContacts(step.view(i), step.solve);
}

}  // namespace avbd
