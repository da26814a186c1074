// Layout of the batches.
#include <algorithm>

#include "geom/soft_mesh_parts.h"
#include "step/begin_chunks.h"
#include "world/soft.h"
#include "world/soft_touch.h"

namespace avbd {

namespace {

constexpr uint32_t kBatchBodies = kShareAll ? 1 : 64;  ///< islands are added to a batch until it holds so many bodies

template <class Solids>
void clearSolids(Solids& solids) {
  for (auto& lanes : solids.row) lanes.clear();
  solids.tets.clear(), solids.stars.clear();
  solids.starCenter.clear(), solids.starLinks.clear(), solids.starBegin.assign(1, 0);
}

void clearLanes(StepData& step) {
  for (auto* lanes : {step.contactRow, step.ballRow, step.fixedRow, step.fullRow, step.scalarRow})
    for (int side = 0; side < 2; ++side) lanes[side].clear();
  for (auto& lanes : step.tetRow) lanes.clear();
  step.contactPair.clear(), step.ballJoint.clear(), step.fixedJoint.clear(), step.tetJoint.clear();
  for (auto* lanes : {step.triangleRow, step.bendRow})
    for (int i = 0; i < 4; ++i) lanes[i].clear();
  step.triangles.clear(), step.hinges.clear();
  clearSolids(step.elastic), clearSolids(step.corotational);
  for (auto& lanes : step.touchRow) lanes.clear();
  step.touchLane.clear();
  step.fullPair.clear(), step.scalar.clear(), step.linked.clear();
  step.batches.clear(), step.ranges.clear(), step.lockedRows.clear(), step.locks.clear();
  step.chunks.clear(), step.seams.clear(), step.units.clear();
  step.forestCount = 0;
}

void addBodies(const WorldData& world, StepData& step, BatchRange& batch) {
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    IslandRange range;
    range.begin = batch.bodies;
    const uint32_t lockedBefore = batch.lockedCount;
    for (uint32_t i = 0; i < island.bodyCount; ++i) {
      const uint32_t slot = step.order[island.bodyBegin + i];
      if (world.bodies[slot].locks) {
        step.lockedRows.push_back(batch.bodies);
        step.locks.push_back(world.bodies[slot].locks);
        ++batch.lockedCount;
      }
      step.rowOf[slot] = batch.bodies++;
    }
    range.end = batch.bodies;
    range.floating = island.floating && batch.lockedCount == lockedBefore;
    range.coupled = island.pairCount > 0 || island.softCount > 0;
    step.ranges.push_back(range);
  }
}

void addFull(const WorldData& world, StepData& step, BatchRange& batch) {
  batch.fullTile = static_cast<uint32_t>(step.fullPair.size()) / kTile;
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    for (uint32_t i = 0; i < island.pairCount; ++i) {
      const uint32_t pair = step.islandPairs[island.pairBegin + i];
      if (!step.found[pair].isFull) continue;
      step.fullPair.push_back(pair);
      step.fullRow[0].push_back(rowInBatch(world, step, batch, step.found[pair].bodyA));
      step.fullRow[1].push_back(rowInBatch(world, step, batch, step.found[pair].bodyB));
    }
  }
  padLanes(step.fullPair, kNone);
  for (auto& lanes : step.fullRow) padLanes(lanes, batch.bodies);
  batch.fullTiles = static_cast<uint32_t>(step.fullPair.size()) / kTile - batch.fullTile;
}

void addJoints(const WorldData& world, StepData& step, BatchRange& batch) {
  batch.ballTile = static_cast<uint32_t>(step.ballJoint.size()) / kTile;
  batch.fixedTile = static_cast<uint32_t>(step.fixedJoint.size()) / kTile;
  batch.tetTile = static_cast<uint32_t>(step.tetJoint.size()) / kTile;
  batch.scalarTile = static_cast<uint32_t>(step.scalar.size()) / kTile;
  batch.linkedBegin = static_cast<uint32_t>(step.linked.size());
  plantForest(world, step, batch);
  batch.linkedCount = static_cast<uint32_t>(step.linked.size()) - batch.linkedBegin;
  batch.scalarCount = static_cast<uint32_t>(step.scalar.size()) - batch.scalarTile * kTile;
  step.scalar.resize(roundUp(static_cast<uint32_t>(step.scalar.size())));
  padLanes(step.ballJoint, kNone), padLanes(step.fixedJoint, kNone), padLanes(step.tetJoint, kNone);
  for (auto& lanes : step.ballRow) padLanes(lanes, batch.bodies);
  for (auto& lanes : step.fixedRow) padLanes(lanes, batch.bodies);
  for (auto& lanes : step.tetRow) padLanes(lanes, batch.bodies);
  for (auto& lanes : step.scalarRow) padLanes(lanes, batch.bodies);
  batch.scalarTiles = static_cast<uint32_t>(step.scalar.size()) / kTile - batch.scalarTile;
  batch.ballTiles = static_cast<uint32_t>(step.ballJoint.size()) / kTile - batch.ballTile;
  batch.fixedTiles = static_cast<uint32_t>(step.fixedJoint.size()) / kTile - batch.fixedTile;
  batch.tetTiles = static_cast<uint32_t>(step.tetJoint.size()) / kTile - batch.tetTile;
}

/// Lanes for all elements of one kind of a batch's soft bodies. Returns its tiles.
template <size_t n, class Of>
Slice addElements(const WorldData& world, StepData& step, const BatchRange& batch,
                  std::vector<StepData::Element>& elements, std::vector<uint32_t> (&rows)[4], Of&& of) {
  const auto begin = static_cast<uint32_t>(elements.size()) / kTile;
  for (uint32_t i = 0; i < batch.islandCount; ++i) {
    const Island& island = step.islands[batch.islandBegin + i];
    for (uint32_t k = island.softBegin; k < island.softBegin + island.softCount; ++k) {
      const SoftData& soft = world.softs[step.islandSofts[k]];
      const std::span<const std::array<uint32_t, n>> all = of(soft);
      for (uint32_t index = 0; index < all.size(); ++index) {
        elements.push_back({step.islandSofts[k], index});
        for (size_t c = 0; c < 4; ++c)
          rows[c].push_back(c < n ? step.rowOf[soft.bodies[all[index][c % n]]] : batch.bodies);
      }
    }
  }
  elements.resize(roundUp(static_cast<uint32_t>(elements.size())));
  for (auto& lanes : rows) padLanes(lanes, batch.bodies);
  return {begin, static_cast<uint32_t>(elements.size()) / kTile};
}

/// Stars of a soft solid.
template <class Solids>
void addStars(const StepData& step, Solids& solids, uint32_t slot, const SoftData& soft) {
  const SoftMeshData::Parts& mesh = soft.mesh->parts();
  const auto row = [&](uint32_t point) { return step.rowOf[soft.bodies[point]]; };
  for (uint32_t center = 0; center < mesh.starVolumes.size(); ++center) {
    solids.stars.push_back({slot, center});
    solids.starCenter.push_back(row(center));
    for (uint32_t i = mesh.starBegin[center]; i < mesh.starBegin[center + 1]; ++i) {
      const StarPoint& star = mesh.starPoints[i];
      solids.starLinks.push_back({star.gradient.x, star.gradient.y, star.gradient.z, row(star.point)});
    }
    solids.starBegin.push_back(static_cast<uint32_t>(solids.starLinks.size()));
  }
}

template <class Solids>
Slice addStars(const WorldData& world, const StepData& step, const BatchRange& batch, Solids& solids,
               SolidModel model) {
  const auto begin = static_cast<uint32_t>(solids.stars.size()) / kTile;
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    for (uint32_t k = island.softBegin; k < island.softBegin + island.softCount; ++k) {
      const SoftData& soft = world.softs[step.islandSofts[k]];
      if (!soft.mesh->isCloth() && soft.material.model == model) addStars(step, solids, step.islandSofts[k], soft);
    }
  }
  solids.stars.resize(roundUp(static_cast<uint32_t>(solids.stars.size())));
  padLanes(solids.starCenter, batch.bodies);
  solids.starBegin.resize(solids.stars.size() + 1, static_cast<uint32_t>(solids.starLinks.size()));
  return {begin, static_cast<uint32_t>(solids.stars.size()) / kTile};
}

template <class Solids>
Slice addTets(const WorldData& world, StepData& step, const BatchRange& batch, Solids& solids, SolidModel model) {
  return addElements<4>(world, step, batch, solids.tets, solids.row, [&](const SoftData& soft) {
    return soft.material.model == model ? soft.mesh->tets() : std::span<const std::array<uint32_t, 4>>();
  });
}

bool hasThreads(const WorldData& world, const StepData& step, const BatchRange& batch) {
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    for (uint32_t k = island.softBegin; k < island.softBegin + island.softCount; ++k) {
      const SoftMaterial& material = world.softs[step.islandSofts[k]].material;
      if (material.damping > step.h || isWoven(material) || material.maxStrain >= 0) return true;
    }
  }
  return false;
}

void addSofts(const WorldData& world, StepData& step, BatchRange& batch) {
  constexpr SolidModel kNeoHookean = SolidModel::NeoHookean, kCorotational = SolidModel::Corotational;
  batch.elastic = addTets(world, step, batch, step.elastic, kNeoHookean);
  batch.corotational = addTets(world, step, batch, step.corotational, kCorotational);
  const Slice triangles = addElements<3>(world, step, batch, step.triangles, step.triangleRow,
                                         [](const SoftData& soft) { return soft.mesh->triangles(); });
  const Slice hinges = addElements<4>(world, step, batch, step.hinges, step.bendRow,
                                      [](const SoftData& soft) { return soft.mesh->hinges(); });
  batch.triangleTile = triangles.begin, batch.triangleTiles = triangles.end - triangles.begin;
  batch.bendTile = hinges.begin, batch.bendTiles = hinges.end - hinges.begin;
  batch.stars = addStars(world, step, batch, step.elastic, kNeoHookean);
  batch.corotationalStars = addStars(world, step, batch, step.corotational, kCorotational);
  batch.threads = hasThreads(world, step, batch);
}

void addTouches(const WorldData& world, StepData& step, BatchRange& batch) {
  batch.touchTile = static_cast<uint32_t>(step.touchLane.size()) / kTile;
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const Island& island = step.islands[batch.islandBegin + n];
    for (uint32_t i = 0; i < island.touchCount; ++i) {
      const uint32_t index = step.islandTouches[island.touchBegin + i];
      const std::array<uint32_t, 4> nodes = nodesOf(world, step.softTouches[index].touch);
      step.touchLane.push_back(index);
      for (size_t k = 0; k < 4; ++k) step.touchRow[k].push_back(rowInBatch(world, step, batch, nodes[k]));
    }
  }
  padLanes(step.touchLane, kNone);
  for (auto& lanes : step.touchRow) padLanes(lanes, batch.bodies);
  batch.touchTiles = static_cast<uint32_t>(step.touchLane.size()) / kTile - batch.touchTile;
}

/// Makes room for `count` that somebody else writes. What was in it is of the last step, and not copied.
template <class T>
void makeRoom(UnwrittenVector<T>& array, size_t count) {
  if (array.size() >= count) return;
  array.clear();
  if (array.capacity() < count) array.reserve(count + count / 2);
  array.resize(count);
}

/// What the solver does not write itself for the rows of static and kinematic bodies begins as 0.
void resizeRows(StepData& step, uint32_t rows) {
  for (auto* array : {&step.d, &step.target, &step.mass, &step.invMass}) makeRoom(*array, size_t(8) * rows);
  step.jobs->forRange(rows, 512, [&](uint32_t begin, uint32_t end, int) {
    for (auto* array : {&step.d, &step.target, &step.mass, &step.invMass})
      std::fill(array->begin() + 8 * ptrdiff_t(begin), array->begin() + 8 * ptrdiff_t(end), 0.0f);
  });
  for (auto* array : {&step.diagonal, &step.gradient, &step.x, &step.r, &step.z, &step.p, &step.q})
    makeRoom(*array, size_t(8) * rows);
  for (auto* array : {&step.length, &step.product}) makeRoom(*array, rows);
  makeRoom(step.hessian, size_t(kHessianRow) * rows);
  makeRoom(step.elementBlocks, size_t(8) * rows);
  makeRoom(step.body, rows / kTile), makeRoom(step.free, rows / kTile), makeRoom(step.endTiles, rows / kTile);
  makeRoom(step.inverse, rows / kTile);
}

/// What chunks add to and no chunk begins: rows of static and kinematic bodies.
void clearRowsBeyondChunks(StepData& step) {
  for (const BatchRange& batch : step.batches) {
    if (batch.chunkCount == 1) continue;
    const size_t begin = batch.rowBegin + step.chunks[batch.chunkBegin + batch.chunkCount - 1].rows.end;
    const size_t end = batch.rowBegin + batch.rows;
    for (auto* array : {&step.diagonal, &step.gradient, &step.x, &step.r, &step.z, &step.p, &step.q})
      std::fill(array->begin() + 8 * begin, array->begin() + 8 * end, 0.0f);
    std::fill(step.hessian.begin() + kHessianRow * begin, step.hessian.begin() + kHessianRow * end, 0.0f);
  }
}

template <class Solids>
void resizeSolids(Solids& solids) {
  const size_t tets = solids.tets.size() / kTile, stars = solids.stars.size() / kTile;
  makeRoom(solids.tetTiles, tets), makeRoom(solids.tetOp, tets);
  makeRoom(solids.starTiles, stars), makeRoom(solids.starOp, stars);
}

void resizeTiles(StepData& step) {
  const size_t contacts = step.contactPair.size() / kTile, balls = step.ballJoint.size() / kTile,
               fixed = step.fixedJoint.size() / kTile, tets = step.tetJoint.size() / kTile,
               full = step.fullPair.size() / kTile, scalars = step.scalar.size() / kTile;
  makeRoom(step.contacts, contacts), makeRoom(step.balls, balls), makeRoom(step.fixed, fixed);
  makeRoom(step.tets, tets), makeRoom(step.full, full);
  makeRoom(step.touchTiles, step.touchLane.size() / kTile), makeRoom(step.touchOp, step.touchLane.size() / kTile);
  const size_t triangles = step.triangles.size() / kTile, hinges = step.hinges.size() / kTile;
  makeRoom(step.triangleTiles, triangles), makeRoom(step.triangleOp, triangles);
  makeRoom(step.bendTiles, hinges), makeRoom(step.bendOp, hinges);
  resizeSolids(step.elastic), resizeSolids(step.corotational);
  makeRoom(step.op, contacts + balls + fixed + scalars), makeRoom(step.tetOp, tets), makeRoom(step.fullOp, full);
}

}  // namespace

const ContactChange& changeOf(const StepData& step, uint32_t pair) {
  static constexpr ContactChange kNoChange;
  const auto at = std::lower_bound(step.changes.begin(), step.changes.end(), pair,
                                   [](const ContactChange& change, uint32_t index) { return change.pair < index; });
  return at != step.changes.end() && at->pair == pair ? *at : kNoChange;
}

uint32_t rowInBatch(const WorldData& world, StepData& step, BatchRange& batch, uint32_t body) {
  return rowInBatch(step, batch, body, body == kNone ? BodyType::Static : world.bodies[body].type);
}

uint32_t rowInBatch(StepData& step, BatchRange& batch, uint32_t body, BodyType type) {
  if (type == BodyType::Static) return batch.bodies;
  if (type == BodyType::Dynamic) return step.rowOf[body];
  if (step.kinematicBatch[body] != step.batches.size()) {
    step.kinematicBatch[body] = static_cast<uint32_t>(step.batches.size());
    step.rowOf[body] = batch.rows++;
    step.kinematicRows.push_back({body, batch.rowBegin + step.rowOf[body]});
  }
  return step.rowOf[body];
}

void layOutBatches(const WorldData& world, StepData& step) {
  clearLanes(step);
  step.rowOf.resize(world.bodies.size());
  for (const StepData::KinematicRow& row : step.kinematicRows) step.kinematicBatch[row.body] = kNone;
  step.kinematicBatch.resize(std::max(step.kinematicBatch.size(), world.bodies.size()), kNone);
  step.kinematicRows.clear();
  uint32_t rows = 0, island = 0;
  while (island < step.islands.size()) {
    BatchRange batch;
    batch.islandBegin = island;
    batch.iterations = step.islands[island].iterations;
    batch.orderBegin = step.islands[island].bodyBegin;
    batch.rowBegin = rows;
    batch.lockedBegin = static_cast<uint32_t>(step.lockedRows.size());
    uint32_t bodies = 0;
    const auto fits = [&] {
      if (island == step.islands.size() || step.islands[island].iterations != batch.iterations) return false;
      return bodies == 0 || (bodies < kBatchBodies && step.islands[island].bodyCount < kChunkedBodies);
    };
    for (; fits(); ++island, ++batch.islandCount) bodies += step.islands[island].bodyCount;
    addBodies(world, step, batch);
    addChunks(step, batch);
    addContacts(step, batch);
    addFull(world, step, batch);
    addJoints(world, step, batch);
    addSofts(world, step, batch);
    addTouches(world, step, batch);
    batch.rows = roundUp(batch.rows);
    step.chunks.back().rows.end = batch.chunkCount > 1 ? roundUp(batch.bodies) : batch.rows;
    rows += batch.rows;
    step.batches.push_back(batch);
  }
  resizeRows(step, rows);
  clearRowsBeyondChunks(step);
  resizeTiles(step);
}

BatchView StepData::view(size_t index) {
  const BatchRange& b = batches[index];
  BatchView v;
  v.bodies = b.bodies, v.rows = b.rows, v.islands = b.islandCount;
  v.island = ranges.data() + b.islandBegin;
  const size_t at = size_t(8) * b.rowBegin;
  const size_t tile = b.rowBegin / kTile;
  v.body = body.data() + tile, v.free = free.data() + tile, v.end = endTiles.data() + tile;
  v.d = d.data() + at, v.target = target.data() + at, v.mass = mass.data() + at, v.invMass = invMass.data() + at;
  v.diagonal = diagonal.data() + at, v.gradient = gradient.data() + at;
  if (b.hasElements() && !whole.empty()) v.whole = whole.data() + at, v.deform = deform.data() + at;
  v.hessian = hessian.data() + size_t(kHessianRow) * b.rowBegin;
  if (b.hasElements()) v.elementBlocks = elementBlocks.data() + at;
  v.inverse = inverse.data() + b.rowBegin / kTile;
  v.x = x.data() + at, v.r = r.data() + at, v.z = z.data() + at, v.p = p.data() + at, v.q = q.data() + at;
  v.step = length.data() + b.rowBegin, v.product = product.data() + b.rowBegin;
  v.chunks = {chunks.data() + b.chunkBegin, b.chunkCount};
  v.seams = {seams.data() + b.seamBegin, b.seamCount};
  v.contacts = {contacts.data() + b.contactTile, contactRow[0].data() + b.contactTile * kTile,
                contactRow[1].data() + b.contactTile * kTile, b.contactTiles};
  v.balls = {balls.data() + b.ballTile, ballRow[0].data() + b.ballTile * kTile, ballRow[1].data() + b.ballTile * kTile,
             b.ballTiles};
  v.fixed = {fixed.data() + b.fixedTile, fixedRow[0].data() + b.fixedTile * kTile,
             fixedRow[1].data() + b.fixedTile * kTile, b.fixedTiles};
  v.op = op.data() + b.contactTile + b.ballTile + b.fixedTile + b.scalarTile;
  const size_t lane = size_t(b.scalarTile) * kTile;
  v.scalar = {scalar.data() + lane, b.scalarCount, scalarRow[0].data() + lane, scalarRow[1].data() + lane,
              b.scalarTiles};
  v.linked = {linked.data() + b.linkedBegin, b.linkedCount};
  v.full = {full.data() + b.fullTile, fullRow[0].data() + b.fullTile * kTile, fullRow[1].data() + b.fullTile * kTile,
            b.fullTiles};
  v.swept = {sweptLanes.data() + b.sweptBegin, b.sweptCount};
  v.fullOp = fullOp.data() + b.fullTile;
  const auto nodes = [](auto& out, auto& tiles, auto& ops, const std::vector<uint32_t>(&rows)[4], uint32_t begin,
                        uint32_t count) {
    out = {tiles.data() + begin, {}, ops.data() + begin, count};
    for (int i = 0; i < 4; ++i) out.node[i] = rows[i].data() + size_t(begin) * kTile;
  };
  nodes(v.tets, tets, tetOp, tetRow, b.tetTile, b.tetTiles);
  const auto solids = [&](auto& toTets, auto& toStars, auto& from, Slice tetTiles, Slice stars) {
    nodes(toTets, from.tetTiles, from.tetOp, from.row, tetTiles.begin, tetTiles.end - tetTiles.begin);
    const size_t star = size_t(stars.begin) * kTile;
    toStars = {from.starTiles.data() + stars.begin,
               from.starOp.data() + stars.begin,
               from.starCenter.data() + star,
               from.starBegin.data() + star,
               from.starLinks.data(),
               stars.end - stars.begin};
  };
  solids(v.elastic, v.stars, elastic, b.elastic, b.stars);
  solids(v.corotational, v.corotationalStars, corotational, b.corotational, b.corotationalStars);
  nodes(v.triangles, triangleTiles, triangleOp, triangleRow, b.triangleTile, b.triangleTiles);
  nodes(v.bends, bendTiles, bendOp, bendRow, b.bendTile, b.bendTiles);
  v.threads = b.threads;
  nodes(v.nodeContacts, touchTiles, touchOp, touchRow, b.touchTile, b.touchTiles);
  v.locked = lockedRows.data() + b.lockedBegin, v.locks = locks.data() + b.lockedBegin;
  v.lockedCount = b.lockedCount;
  return v;
}

}  // namespace avbd
