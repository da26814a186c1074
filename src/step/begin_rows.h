// Parts of the stage 50_begin_rows.
#pragma once

#include "avbd/rows/math.h"
#include "step/step_data.h"

namespace avbd {

inline rows::V3<float> toRow(Vec3 v) { return {v.x, v.y, v.z}; }
inline rows::V3<float> toRow(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline rows::Q4<float> toRow(Quat q) { return {q.w, q.x, q.y, q.z}; }
inline rows::Sym3<float> toRow(const SymMat3& s) { return {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz}; }
inline Vec3 fromRow(rows::V3<float> v) { return {v.x, v.y, v.z}; }
/// f(unit) for all units of work, by all workers.
template <class F>
void forUnits(const StepData& step, F&& f) {
  step.jobs->run(static_cast<uint32_t>(step.units.size()), [&](uint32_t i, int) { f(step.units[i]); });
}
/// f(batch, jobs for its chunks or null, worker) for all batches: those with chunks one after the other, the others
/// side by side.
template <class F>
void forBatches(const StepData& step, F&& f) {
  const auto count = static_cast<uint32_t>(step.batches.size());
  for (uint32_t i = 0; i < count; ++i)
    if (step.batches[i].chunkCount > 1) f(i, step.jobs, 0);
  step.jobs->run(count, [&](uint32_t i, int worker) {
    if (step.batches[i].chunkCount == 1) f(i, static_cast<Jobs*>(nullptr), worker);
  });
}
/// f(index in StepData::order, body row over all batches) for the bodies of a unit.
template <class F>
void forBodies(const StepData& step, const WorkUnit& unit, F&& f) {
  const BatchRange& batch = step.batches[unit.batch];
  for (uint32_t i = unit.rows.begin; i < unit.rows.end; ++i) f(batch.orderBegin + i, batch.rowBegin + i);
}

inline Quat fromRow(rows::Q4<float> q) { return {q.w, q.x, q.y, q.z}; }

/// Cuts the islands into batches and gives every body its row, every pair and joint its lane.
void layOutBatches(const WorldData& world, StepData& step);
void fillBodies(const WorldData& world, StepData& step);
void fillContacts(WorldData& world, StepData& step, const WorkUnit& unit);  ///< may run beside other units
void fillFullContacts(WorldData& world, StepData& step);
void fillJoints(const WorldData& world, StepData& step);
/// Of soft bodies: d and deform.
void predictSofts(const WorldData& world, StepData& step);
void fillElements(const WorldData& world, StepData& step);
void publishElements(WorldData& world, const StepData& step);  ///< what they remember; 90_publish
void fillScalarJoints(const WorldData& world, StepData& step);
/// Acceleration drives of trees, after the scalar joints: by the inertia of all that hangs on them.
void weighAccelerationDrives(const WorldData& world, StepData& step);
void fillLinkedJoints(const WorldData& world, StepData& step);  ///< after the scalar ones

/// Body row that a joint or pair names in its batch.
uint32_t rowInBatch(const WorldData& world, StepData& step, BatchRange& batch, uint32_t body);
uint32_t rowInBatch(StepData& step, BatchRange& batch, uint32_t body, BodyType type);
/// Chooses which joints of a batch its exact trees hold; the others get lanes of their own.
void plantForest(const WorldData& world, StepData& step, BatchRange& batch);
/// Finds the islands whose joints' loops no factor can hold, and takes their joints from the trees: of a net a tree is
/// only a small part, and solving it exactly costs more than it helps. True if there are any.
bool releaseWide(StepData& step, const BatchRange& batch, Forest& forest);
/// Gives the loops of a batch to its forest's factor where that stays narrow.
void fillForest(StepData& step, const BatchRange& batch, Forest& forest);
/// Leaves all of them to iterations.
void leaveLoops(StepData& step, const BatchRange& batch);

}  // namespace avbd
