// Falling asleep and waking within a step.
#pragma once

#include "step/step_data.h"

namespace avbd {

/// Wakes what sleeps and is touched by what does not. The pairs of what woke, which return to the list, are in
/// step.wokenPairs: their contacts are still to be found. False if there are none.
bool wakeTouched(WorldData& world, StepData& step);

/// At the start of a step: what is awake, so that a later substep that fails can be undone.
void rememberAwake(const WorldData& world, StepData& step);
/// Undoes what the step has done to bodies and joints so far, wakings too; before pairs are restored.
void restoreAwake(WorldData& world, StepData& step);
/// The same, after pairs have been restored: what was woken leaves the lists.
void restoreSleepers(WorldData& world, StepData& step);

/// At the end of a step: the islands that were chosen fall asleep, and the events of sleep are told.
void settle(WorldData& world, StepData& step);

}  // namespace avbd
