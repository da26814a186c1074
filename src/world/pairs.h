// Which shapes may touch, and what is forgotten when something is moved, changed or destroyed between steps.
#pragma once

#include "world/world_data.h"

namespace avbd {

/// Groups, categories and masks.
bool filtersMeet(const Filter& a, const Filter& b);
/// Whether a pair of these two shapes may exist: different bodies, one of them dynamic, filters, exclusions.
bool mayTouch(const WorldData& data, uint32_t shapeA, uint32_t shapeB);

void erasePairsOfBody(WorldData& data, uint32_t body);
void erasePairsOfShape(WorldData& data, uint32_t shape);
void erasePairsBetween(WorldData& data, uint32_t bodyA, uint32_t bodyB);

/// The next step looks for all pairs of the shape.
void markUnpaired(WorldData& data, uint32_t shape);
void markBodyUnpaired(WorldData& data, uint32_t body);
void unmarkUnpaired(WorldData& data, uint32_t shape);

/// Counted: a pair excluded twice has to be freed twice.
void exclude(WorldData& data, uint32_t bodyA, uint32_t bodyB);
void endExclusion(WorldData& data, uint32_t bodyA, uint32_t bodyB);
void endExclusionsOf(WorldData& data, uint32_t body);
bool isExcluded(const WorldData& data, uint32_t bodyA, uint32_t bodyB);

}  // namespace avbd
