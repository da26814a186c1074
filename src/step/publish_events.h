// Events of a step: what began, ended, hit and moved, over all its substeps.
#pragma once

#include "step/step_data.h"

namespace avbd {

/// Normal forces of a contact's points over a substep, rebounds included [N].
using PointForces = std::array<float, kMaxManifoldPoints>;

/// Of a pair with a trigger, which no soft body visits.
inline TriggerEvent visitOf(const ShapeId (&shape)[2], const BodyId (&body)[2], bool triggerIsA) {
  const int trigger = triggerIsA ? 0 : 1, visitor = 1 - trigger;
  return {shape[trigger], shape[visitor], body[trigger], body[visitor], {}};
}

/// At the start of a step. The events of the last one stay until the end of this one.
void beginEvents(WorldData& world, StepData& step);
/// A contact that was solved, while the bodies' velocities and the points' forces are still those of the start of the
/// substep. `index`: of the pair.
void noteContact(WorldData& world, StepData& step, uint32_t index, const PointForces& forces);
/// At the end of a step.
void publishEvents(WorldData& world, StepData& step);
/// A step that fails: nothing touched in it.
void forgetTouches(WorldData& world, const StepData& step);

}  // namespace avbd
