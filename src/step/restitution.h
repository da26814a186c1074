// Restitution, all of it.
//
// A contact point with restitution e that meets the other surface within the step, at the time tc and the speed v,
// leaves it at e v. Its row asks for the place where the point would be at the step's end (rebound), so that no height
// is lost to where in the step the impact falls; after the solve the velocities of the rows that carried force are set
// (a velocity pass, applyRestitution). Velocities are those of the middle of a step, as the position update x += h v
// has it.
#pragma once

#include "step/step_data.h"

namespace avbd {

struct Rebound {
  float height = 0;  ///< [m] above touching, at the end of the step
  float speed = 0;   ///< [m/s] of separation after the step; 0: nothing rebounds
};

/// Of point i of a pair, from the velocities and free accelerations at the start of the step.
Rebound rebound(const WorldData& world, const StepData& step, const PairData& pair, int i);

/// Impulses that give every rebounding row its speed; changes step.end. Total impulses stay repulsive. They stay in
/// step.bounces, contact by contact in the order of the lanes (step.contactPair, then step.fullPair).
void applyRestitution(const WorldData& world, StepData& step);

}  // namespace avbd
