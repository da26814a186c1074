// Chunks (begin_chunks.h). They depend on the island alone, never on how many threads there are.
#include "step/begin_chunks.h"

#include <algorithm>

namespace avbd {

namespace {

constexpr uint32_t kChunkRows = 256;  ///< of most chunks: some tens of microseconds of an iteration

uint32_t chunkRows(const BatchRange& batch) {
  return std::max(kChunkRows, roundUp((batch.bodies + kMostChunks - 1) / kMostChunks));
}

}  // namespace

void addChunks(StepData& step, BatchRange& batch) {
  batch.chunkBegin = static_cast<uint32_t>(step.chunks.size());
  const uint32_t rows = chunkRows(batch);
  batch.chunkCount = 1;
  // A rest of less than half a chunk goes to the last one.
  if (batch.bodies >= kChunkedBodies) batch.chunkCount = std::max(1u, (batch.bodies + rows / 2) / rows);
  step.chunking.chunkOf.resize(batch.bodies);
  for (uint32_t i = 0; i < batch.chunkCount; ++i) {
    const Slice slice{i * rows, i + 1 < batch.chunkCount ? (i + 1) * rows : batch.bodies};
    step.chunks.push_back({slice, {}});
    std::fill(step.chunking.chunkOf.begin() + slice.begin, step.chunking.chunkOf.begin() + slice.end,
              static_cast<uint8_t>(i));
  }
  batch.rows = staticRow(batch) + batch.chunkCount;
}

}  // namespace avbd
