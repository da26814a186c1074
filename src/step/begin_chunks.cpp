// Chunks and seams (begin_chunks.h). They depend on the island alone, never on how many threads there are.
#include "step/begin_chunks.h"

#include <algorithm>
#include <bitset>

namespace avbd {

namespace {

constexpr uint32_t kChunkRows = 256;  ///< of most chunks: some tens of microseconds of an iteration
constexpr uint32_t kMostChunks = 64;

uint32_t chunkRows(const BatchRange& batch) {
  return std::max(kChunkRows, roundUp((batch.bodies + kMostChunks - 1) / kMostChunks));
}

/// The first of the chunks' static rows. Several chunks have them beyond the tile of the last body, which belongs to
/// the last chunk alone.
uint32_t staticRow(const BatchRange& batch) { return batch.chunkCount > 1 ? roundUp(batch.bodies) : batch.bodies; }

/// Index of the seam between two chunks, which is new if need be.
uint32_t seamBetween(ChunkScratch& scratch, uint32_t chunks, uint32_t a, uint32_t b) {
  const uint32_t low = std::min(a, b), high = std::max(a, b);
  uint32_t& seam = scratch.seamOf[size_t(low) * chunks + high];
  if (seam == kNone) {
    seam = static_cast<uint32_t>(scratch.seams.size());
    scratch.seams.push_back({low, high});
  }
  return seam;
}

/// Where static things are concerned a chunk has its own row for them.
void placePair(StepData& step, BatchRange& batch, uint32_t index) {
  const FoundContact& pair = step.found[index];
  ChunkScratch& scratch = step.chunking;
  PlacedPair placed{index, rowInBatch(step, batch, pair.bodyA, pair.typeA),
                    rowInBatch(step, batch, pair.bodyB, pair.typeB)};
  const uint32_t chunks = batch.chunkCount;
  if (chunks > 1) {
    const bool dynamicA = placed.rowA < batch.bodies, dynamicB = placed.rowB < batch.bodies;
    const uint32_t a = scratch.chunkOf[dynamicA ? placed.rowA : placed.rowB];
    const uint32_t b = scratch.chunkOf[dynamicB ? placed.rowB : placed.rowA];
    if (placed.rowA == batch.bodies) placed.rowA = staticRow(batch) + a;
    if (placed.rowB == batch.bodies) placed.rowB = staticRow(batch) + b;
    placed.bucket = pair.hasKinematic() ? kNone : a == b ? a : chunks + seamBetween(scratch, chunks, a, b);
  }
  scratch.pairs.push_back(placed);
}

/// Gives each seam the lowest colour that no seam before it has at either chunk, and finds the order of the buckets:
/// chunks, seams by colour, and last what touches kinematic bodies, whose rows all chunks share.
void sortSeams(ChunkScratch& scratch, uint32_t chunks) {
  std::bitset<2 * kMostChunks> used[kMostChunks];
  for (ChunkScratch::Between& seam : scratch.seams) {
    const auto taken = used[seam.low] | used[seam.high];
    while (taken[seam.color]) ++seam.color;
    used[seam.low].set(seam.color), used[seam.high].set(seam.color);
  }
  std::vector<uint32_t>& order = scratch.order;
  order.resize(scratch.seams.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return scratch.seams[a].color != scratch.seams[b].color ? scratch.seams[a].color < scratch.seams[b].color : a < b;
  });
  scratch.place.resize(chunks + order.size() + 1);
  for (uint32_t c = 0; c < chunks; ++c) scratch.place[c] = c;
  for (uint32_t i = 0; i < order.size(); ++i) scratch.place[chunks + order[i]] = chunks + i;
  scratch.place.back() = static_cast<uint32_t>(scratch.place.size() - 1);
}

/// The static row that a bucket's empty lanes name.
uint32_t idleRow(const BatchRange& batch, const ChunkScratch& scratch, uint32_t bucket) {
  if (bucket < batch.chunkCount) return staticRow(batch) + bucket;
  const uint32_t seam = bucket - batch.chunkCount;
  return staticRow(batch) + (seam < scratch.order.size() ? scratch.seams[scratch.order[seam]].low : 0);
}

/// Tells the batch's chunk or seam which tiles are its own.
void addUnit(StepData& step, BatchRange& batch, uint32_t bucket, Slice tiles) {
  WorkUnit unit{static_cast<uint32_t>(step.batches.size()), {}, tiles};
  const ChunkScratch& scratch = step.chunking;
  if (bucket < batch.chunkCount) {
    Chunk& chunk = step.chunks[batch.chunkBegin + bucket];
    chunk.tiles = tiles;
    unit.rows = chunk.rows;
  } else {
    if (tiles.begin == tiles.end) return;
    const uint32_t seam = bucket - batch.chunkCount;
    const bool kinematic = seam == scratch.order.size();
    step.seams.push_back({tiles, kinematic ? 2 * kMostChunks : scratch.seams[scratch.order[seam]].color});
    ++batch.seamCount;
  }
  step.units.push_back(unit);
}

/// Lanes of the placed pairs, bucket by bucket, each from a new tile on.
void layOutBuckets(StepData& step, BatchRange& batch, uint32_t buckets) {
  ChunkScratch& scratch = step.chunking;
  std::vector<uint32_t>& next = scratch.next;
  next.assign(buckets + 1, 0);
  for (const PlacedPair& placed : scratch.pairs) ++next[placed.bucket + 1];
  const auto first = static_cast<uint32_t>(step.contactPair.size());
  batch.contactTile = first / kTile;
  batch.seamBegin = static_cast<uint32_t>(step.seams.size());
  next[0] = first;
  for (uint32_t b = 0; b < buckets; ++b) {
    next[b + 1] = next[b] + roundUp(next[b + 1]);
    addUnit(step, batch, b, {(next[b] - first) / kTile, (next[b + 1] - first) / kTile});
    for (auto& lanes : step.contactRow) lanes.resize(next[b + 1], idleRow(batch, scratch, b));
  }
  step.contactPair.resize(next[buckets], kNone);
  batch.contactTiles = (next[buckets] - first) / kTile;
  for (const PlacedPair& placed : scratch.pairs) {
    const uint32_t lane = next[placed.bucket]++;
    step.contactPair[lane] = placed.pair;
    step.contactRow[0][lane] = placed.rowA, step.contactRow[1][lane] = placed.rowB;
  }
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

void addContacts(StepData& step, BatchRange& batch) {
  ChunkScratch& scratch = step.chunking;
  const uint32_t chunks = batch.chunkCount;
  scratch.pairs.clear(), scratch.seams.clear();
  scratch.seamOf.assign(size_t(chunks) * chunks, kNone);
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    for (uint32_t i = 0; i < island.pairCount; ++i) {
      const uint32_t pair = step.islandPairs[island.pairBegin + i];
      if (!step.found[pair].isFull) placePair(step, batch, pair);
    }
  }
  sortSeams(scratch, chunks);
  const auto last = static_cast<uint32_t>(scratch.place.size() - 1);
  for (PlacedPair& placed : scratch.pairs) placed.bucket = scratch.place[std::min(placed.bucket, last)];
  layOutBuckets(step, batch, last + 1);
}

}  // namespace avbd
