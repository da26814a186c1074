// Velocities and poses at the end of the step, from the displacements. Nothing is written to the world yet.
#include <cmath>

#include "step/begin_chunks.h"
#include "step/free_motion.h"
#include "step/restitution.h"

namespace avbd {

namespace {

Vec3 readLin(const UnwrittenVector<float>& array, size_t at) { return {array[at], array[at + 1], array[at + 2]}; }
Vec3 readAng(const UnwrittenVector<float>& array, size_t at) { return {array[at + 4], array[at + 5], array[at + 6]}; }

bool isFinite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool isFinite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[noreturn]] void fail(const WorldData& world, Stage stage, uint32_t slot) {
  const BodyId id = world.bodyIds.id(slot);
  throw NonFiniteError(stageName(stage), id.index, id.generation);
}

StepData::EndState endState(const BodyData& body, Vec3 dp, const EndMotion<float>& end) {
  return {body.position + dp, fromRow(end.q), fromRow(end.v), fromRow(end.w)};
}

void endBody(const WorldData& world, StepData& step, uint32_t index, uint32_t row) {
  const uint32_t slot = step.order[index];
  const size_t at = size_t(8) * row;
  if (!isFinite(readLin(step.target, at)) || !isFinite(readAng(step.target, at))) fail(world, Stage::Predict, slot);
  if (!isFinite(readLin(step.d, at)) || !isFinite(readAng(step.d, at))) fail(world, Stage::SolveBlocks, slot);
  step.endOf[slot] = index;
  step.rowOfEnd[index] = row;
  StepData::EndState& end = step.end[index];
  end =
      endState(world.bodies[slot], readLin(step.d, at), step.endTiles[row / kTile].get(static_cast<int>(row % kTile)));
  const bool finite = isFinite(end.position) && isFinite(end.linearVelocity) && isFinite(end.angularVelocity) &&
                      std::isfinite(end.rotation.w + end.rotation.x + end.rotation.y + end.rotation.z);
  if (!finite) fail(world, Stage::Velocities, slot);
}

}  // namespace

void updateVelocities(WorldData& world, StepData& step) {
  step.end.resize(step.order.size());
  step.rowOfEnd.resize(step.order.size());
  step.endOf.resize(world.bodies.size());
  forUnits(step, [&](const WorkUnit& unit) {
    step.backend->endMotions(step.view(unit.batch), step.h, {unit.rows.begin, roundUp(unit.rows.end)});
    forBodies(step, unit, [&](uint32_t index, uint32_t row) { endBody(world, step, index, row); });
  });
  applyRestitution(world, step);
}

}  // namespace avbd
