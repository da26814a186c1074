// Events of soft bodies, each of which counts as one thing: notes of a step, and what follows from them at its end.
#pragma once

#include "step/publish_events.h"

namespace avbd {

/// A particle and a shape pushed each other in a substep. `forces`: rebounds included.
void noteSoftContact(const WorldData& world, StepData& step, const PairData& pair, const PointForces& forces);
/// A particle is in a trigger. Slots of shapes in any order.
void noteSoftVisit(const WorldData& world, StepData& step, uint32_t shapeA, uint32_t shapeB, bool triggerIsA);
/// Surfaces pushed each other in a substep: step.newSoftContacts. While bodies have their velocities of its start, and
/// step.softTouches the forces.
void noteSoftTouches(const WorldData& world, StepData& step);
/// At the end of a step: WorldData::softPairs, and their begins and ends.
void publishSoftEvents(WorldData& world, StepData& step);

}  // namespace avbd
