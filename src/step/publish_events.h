// Events of a step: what began, ended, hit and moved, over all its substeps.
#pragma once

#include "step/step_data.h"

namespace avbd {

/// Normal forces of a contact's points over a substep, rebounds included [N].
using PointForces = std::array<float, kMaxManifoldPoints>;

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
