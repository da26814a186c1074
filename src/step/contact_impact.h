// Impacts: what of a contact's force only stopped an approach.
//
// The next step begins its iterations with the forces of this one. A force that stopped two bodies is no guess for what
// they need once they are stopped: it drives them apart, and as the Hessian keeps the stiffness of rows without force,
// the iterations take back only an eleventh of that each. So a point remembers what it took to stop it, and the next
// step begins with the rest, which is what it carries.
#pragma once

#include "avbd/rows/contact.h"
#include "step/step_data.h"

namespace avbd {

/// Takes from the force that a point remembers what was its impact.
void takeImpact(PointMemory& memory);
/// The same, at no cost where there was none.
inline void forgetImpact(PointMemory& memory) {
  if (memory.rebound > 0 || memory.impact > 0) takeImpact(memory);
}
/// Remembers the impacts of the step that begins, of a pair whose rows stand.
void noteImpacts(const WorldData& world, const StepData& step, PairData& pair, const rows::Contact<float>& contact);

}  // namespace avbd
