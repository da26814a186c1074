// Chunks and seams of a batch (solve/batch.h), and the lanes of its contacts.
#pragma once

#include "step/begin_rows.h"

namespace avbd {

inline constexpr uint32_t kChunkedBodies = 384;  ///< an island of so many bodies is cut into chunks

inline constexpr uint32_t kMostChunks = 64;

inline uint32_t roundUp(uint32_t n) { return (n + kTile - 1) / kTile * kTile; }

/// Fills the last tile with lanes that name the static row, or nothing.
inline void padLanes(std::vector<uint32_t>& lanes, uint32_t value) {
  while (lanes.size() % kTile != 0) lanes.push_back(value);
}

/// The first of the chunks' static rows. Several chunks have them beyond the tile of the last body, which belongs to
/// the last chunk alone.
inline uint32_t staticRow(const BatchRange& batch) {
  return batch.chunkCount > 1 ? roundUp(batch.bodies) : batch.bodies;
}

/// Cuts the batch's bodies into chunks; after this its rows are counted, but for kinematic ones.
void addChunks(StepData& step, BatchRange& batch);
/// Gives every contact a lane: chunk by chunk, then seam by seam.
void addContacts(StepData& step, BatchRange& batch);

}  // namespace avbd
