// What a World holds.
#pragma once

#include <avbd/world.h>

#include <mutex>

#include "api/scaled_hulls.h"
#include "step/step.h"
#include "world/shared_table.h"
#include "world/snapshot_sides.h"
#include "world/world_data.h"

namespace avbd {

struct World::Impl {
  WorldData data;
  Stepper stepper;
  std::mutex treeMutex;  ///< held by the query that fits the tree
  ScaledHulls scaledHulls;
  SharedTable shared;                   ///< what snapshots name
  snapshot::PairSides pairSides;        ///< of the snapshot that is written or read
  std::unique_ptr<WorldData> restored;  ///< where one is read into
};

}  // namespace avbd
