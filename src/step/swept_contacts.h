// Contacts of pairs that meet only on their way (solve/swept_contact.h, continuous_tied.cpp).
#pragma once

#include "step/step_data.h"

namespace avbd {

/// Gives the pair the contacts that it has when it meets; false where the hook refuses them, or there are none.
bool sweepContact(WorldData& world, StepData& step, const TiedImpact& meeting);

/// Null for a contact of the start of the step.
const SweptPair* sweptOf(const StepData& step, const PairData& pair);
/// Finds how deep their points may stay in this step, before their rows are filled.
void prepareSwept(const WorldData& world, StepData& step);
/// Tells the batches which of their lanes are swept.
void listSwept(const WorldData& world, StepData& step);

/// From each body's centre of mass to a point of a contact.
struct ContactArms {
  Vec3 a, b;
};
inline ContactArms armsOf(const WorldData& world, const StepData& step, const PairData& pair, int point) {
  const SweptPair* swept = step.swept.empty() ? nullptr : sweptOf(step, pair);
  if (swept) return {swept->armA[point], swept->armB[point]};
  const Vec3 arm = pair.manifold.points[point].position;
  const Vec3 apart = toFloat(world.bodies[pair.bodyB].position - world.bodies[pair.bodyA].position);
  return {isParticle(world, pair.bodyA) ? Vec3{} : arm, isParticle(world, pair.bodyB) ? Vec3{} : arm - apart};
}

}  // namespace avbd
