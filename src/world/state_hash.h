// One number over everything that the next step's result depends on and that steps change.
#pragma once

#include "base/hash.h"
#include "world/world_data.h"

namespace avbd {

/// Poses, velocities, pending forces, multipliers and contact memories of everything alive, with the ids.
uint64_t stateHash(const WorldData& data);

/// The multipliers of one coordinate.
void addMultipliers(Hash64& hash, const JointMultipliers& multipliers);

/// World::stageHashes().
std::array<uint64_t, kStageCount> stageHashes(const WorldData& data);

}  // namespace avbd
