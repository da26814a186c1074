// Rows: lays out the batches and fills masses, constants and remembered multipliers.
#include "step/begin_rows.h"
#include "step/soft_touches.h"
#include "step/swept_contacts.h"

namespace avbd {

void beginRows(WorldData& world, StepData& step) {
  layOutBatches(world, step);
  fillBodies(world, step);
  prepareSwept(world, step);
  forUnits(step, [&](const WorkUnit& unit) {
    const BatchView view = step.view(unit.batch);
    fillContacts(world, step, unit);
    step.backend->prepareContacts(view, step.solve, unit.tiles);
  });
  fillFullContacts(world, step);
  listSwept(world, step);
  fillJoints(world, step);
  fillElements(world, step);
  fillSoftTouches(world, step);
  for (size_t i = 0; i < step.batches.size(); ++i) step.backend->prepareOthers(step.view(i), step.solve);
}

}  // namespace avbd
