// Lanes of contacts: chunk by chunk, then seam by seam, in the order of the pairs within each.
//
// Threads share the pairs in pieces: each finds the buckets of its own and counts them, so that it knows where in each
// bucket its own begin.
#include <algorithm>
#include <bitset>
#include <span>
#include <utility>

#include "step/begin_chunks.h"

namespace avbd {

namespace {

constexpr uint32_t kLeastPiece = 512, kMostPieces = 64;

/// Pairs of a piece; it depends on their number alone.
uint32_t grainOf(const ChunkScratch& scratch) {
  const auto count = static_cast<uint32_t>(scratch.pairs.size());
  return Jobs::grainOf(std::max(kLeastPiece, (count + kMostPieces - 1) / kMostPieces));
}

/// Calls f(piece, pairs) for the pieces of the scratch's pairs.
template <class F>
void forPieces(StepData& step, F&& f) {
  ChunkScratch& scratch = step.chunking;
  const uint32_t grain = grainOf(scratch);
  step.jobs->forRange(static_cast<uint32_t>(scratch.pairs.size()), grain, [&](uint32_t begin, uint32_t end, int) {
    f(begin / grain, std::span<PlacedPair>(scratch.pairs.data() + begin, scratch.pairs.data() + end));
  });
}

/// A place for each pair of the batch's islands, which stand one behind the other. Returns the first.
uint32_t countPairs(StepData& step, const BatchRange& batch) {
  const Island& first = step.islands[batch.islandBegin];
  const Island& last = step.islands[batch.islandBegin + batch.islandCount - 1];
  step.chunking.pairs.resize(last.pairBegin + last.pairCount - first.pairBegin);
  return first.pairBegin;
}

/// Bucket of a pair until the seams have their numbers: its chunk, or behind them all which two it is between.
uint32_t seamCode(uint32_t chunks, uint32_t a, uint32_t b) { return chunks + std::min(a, b) * chunks + std::max(a, b); }

/// Rows and bucket of a pair. Where static things are concerned a chunk has its own row for them.
void place(StepData& step, BatchRange& batch, PlacedPair& placed) {
  const FoundContact& pair = step.found[placed.pair];
  placed.rowA = rowInBatch(step, batch, pair.bodyA, pair.typeA);
  placed.rowB = rowInBatch(step, batch, pair.bodyB, pair.typeB);
  if (batch.chunkCount == 1) return;
  const std::vector<uint8_t>& chunkOf = step.chunking.chunkOf;
  const bool dynamicA = placed.rowA < batch.bodies, dynamicB = placed.rowB < batch.bodies;
  const uint32_t a = chunkOf[dynamicA ? placed.rowA : placed.rowB];
  const uint32_t b = chunkOf[dynamicB ? placed.rowB : placed.rowA];
  if (placed.rowA == batch.bodies) placed.rowA = staticRow(batch) + a;
  if (placed.rowB == batch.bodies) placed.rowB = staticRow(batch) + b;
  placed.bucket = pair.hasKinematic() ? kNone : a == b ? a : seamCode(batch.chunkCount, a, b);
}

/// Places the piece's pairs, the first of which is *pair, and lists the seams that it meets. Full contacts have lanes
/// elsewhere. Kinematic bodies get rows as they are met, one after the other, so their pairs wait.
void placePiece(StepData& step, BatchRange& batch, ChunkScratch::Piece& piece, std::span<PlacedPair> pairs,
                const uint32_t* pair) {
  std::bitset<kMostChunks*(kMostChunks + 1)> seen;
  piece.seams.clear();
  piece.hasKinematic = false;
  for (PlacedPair& placed : pairs) {
    placed = {*pair++};
    if (step.found[placed.pair].isFull) placed.pair = kNone;
    if (placed.pair == kNone) continue;
    const bool kinematic = step.found[placed.pair].hasKinematic();
    piece.hasKinematic = piece.hasKinematic || kinematic;
    if (kinematic) continue;
    place(step, batch, placed);
    if (placed.bucket < batch.chunkCount || seen[placed.bucket]) continue;
    seen.set(placed.bucket);
    piece.seams.push_back(placed.bucket);
  }
}

void placeKinematic(StepData& step, BatchRange& batch) {
  ChunkScratch& scratch = step.chunking;
  const size_t grain = grainOf(scratch);
  for (size_t k = 0; k < scratch.pieceCount; ++k) {
    if (!scratch.pieces[k].hasKinematic) continue;
    const size_t end = std::min((k + 1) * grain, scratch.pairs.size());
    for (size_t i = k * grain; i < end; ++i) {
      PlacedPair& placed = scratch.pairs[i];
      if (placed.pair != kNone && step.found[placed.pair].hasKinematic()) place(step, batch, placed);
    }
  }
}

/// Numbers the seams as the pairs meet them.
void numberSeams(ChunkScratch& scratch, uint32_t chunks) {
  scratch.seams.clear();
  scratch.seamOf.assign(size_t(chunks) * (chunks + 1), kNone);
  for (size_t k = 0; k < scratch.pieceCount; ++k)
    for (const uint32_t code : scratch.pieces[k].seams) {
      uint32_t& seam = scratch.seamOf[code];
      if (seam != kNone) continue;
      seam = static_cast<uint32_t>(scratch.seams.size());
      scratch.seams.push_back({code / chunks - 1, code % chunks});
    }
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

/// Place of a pair's bucket among all.
uint32_t placeOf(const ChunkScratch& scratch, uint32_t chunks, uint32_t bucket) {
  if (bucket == kNone) return scratch.place.back();
  return scratch.place[bucket < chunks ? bucket : chunks + scratch.seamOf[bucket]];
}

/// Gives the pairs their buckets' places and counts them, piece by piece.
void countBuckets(StepData& step, uint32_t chunks, uint32_t buckets) {
  forPieces(step, [&](uint32_t piece, std::span<PlacedPair> pairs) {
    ChunkScratch& scratch = step.chunking;
    std::vector<uint32_t>& next = scratch.pieces[piece].next;
    next.assign(buckets, 0);
    for (PlacedPair& placed : pairs) {
      if (placed.pair == kNone) continue;
      placed.bucket = placeOf(scratch, chunks, placed.bucket);
      ++next[placed.bucket];
    }
  });
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

/// Each bucket from a new tile on, and in it the pieces' pairs one piece behind the other.
void layOutBuckets(StepData& step, BatchRange& batch, uint32_t buckets) {
  ChunkScratch& scratch = step.chunking;
  const auto first = static_cast<uint32_t>(step.contactPair.size());
  batch.contactTile = first / kTile;
  batch.seamBegin = static_cast<uint32_t>(step.seams.size());
  uint32_t lane = first;
  for (uint32_t b = 0; b < buckets; ++b) {
    const uint32_t begin = lane;
    for (size_t k = 0; k < scratch.pieceCount; ++k) lane += std::exchange(scratch.pieces[k].next[b], lane);
    lane = begin + roundUp(lane - begin);
    addUnit(step, batch, b, {(begin - first) / kTile, (lane - first) / kTile});
    for (auto& lanes : step.contactRow) lanes.resize(lane, idleRow(batch, scratch, b));
  }
  step.contactPair.resize(lane, kNone);
  batch.contactTiles = (lane - first) / kTile;
}

void fillLanes(StepData& step) {
  forPieces(step, [&](uint32_t piece, std::span<PlacedPair> pairs) {
    std::vector<uint32_t>& next = step.chunking.pieces[piece].next;
    for (const PlacedPair& placed : pairs) {
      if (placed.pair == kNone) continue;
      const uint32_t lane = next[placed.bucket]++;
      step.contactPair[lane] = placed.pair;
      step.contactRow[0][lane] = placed.rowA, step.contactRow[1][lane] = placed.rowB;
    }
  });
}

}  // namespace

void addContacts(StepData& step, BatchRange& batch) {
  ChunkScratch& scratch = step.chunking;
  const uint32_t chunks = batch.chunkCount;
  const uint32_t first = countPairs(step, batch);
  const size_t grain = grainOf(scratch);
  scratch.pieceCount = (scratch.pairs.size() + grain - 1) / grain;
  scratch.pieces.resize(std::max(scratch.pieces.size(), scratch.pieceCount));
  forPieces(step, [&](uint32_t piece, std::span<PlacedPair> pairs) {
    const auto at = static_cast<size_t>(pairs.data() - scratch.pairs.data());
    placePiece(step, batch, scratch.pieces[piece], pairs, step.islandPairs.data() + first + at);
  });
  placeKinematic(step, batch);
  numberSeams(scratch, chunks);
  sortSeams(scratch, chunks);
  const auto buckets = static_cast<uint32_t>(scratch.place.size());
  countBuckets(step, chunks, buckets);
  layOutBuckets(step, batch, buckets);
  fillLanes(step);
}

}  // namespace avbd
