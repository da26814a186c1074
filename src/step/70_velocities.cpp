// Velocities and poses at the end of the step, from the displacements. Nothing is written to the world yet.
#include <cmath>

#include "step/begin_rows.h"
#include "step/free_motion.h"
#include "step/restitution.h"

namespace avbd {

namespace {

Vec3 readLin(const AlignedVector<float>& array, size_t at) { return {array[at], array[at + 1], array[at + 2]}; }
Vec3 readAng(const AlignedVector<float>& array, size_t at) { return {array[at + 4], array[at + 5], array[at + 6]}; }

bool isFinite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool isFinite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[noreturn]] void fail(const WorldData& world, Stage stage, uint32_t slot) {
  const BodyId id = world.bodyIds.id(slot);
  throw NonFiniteError(stageName(stage), id.index, id.generation);
}

Vec3 bounded(Vec3 v, float limit) {
  const float size = length(v);
  return size > limit ? v * (limit / size) : v;
}

/// v = v_free + (dp - y_p) / h, and the angular momentum likewise.
StepData::EndState endState(const BodyData& body, const StepData& step, const FreeMotion& free, size_t at) {
  const Vec3 dp = readLin(step.d, at), turn = readAng(step.d, at);
  StepData::EndState end;
  end.position = body.position + dp;
  end.rotation = unit(quatFromVector(turn) * body.rotation);
  end.linearVelocity = bounded(free.velocity + (dp - free.displacement) * (1 / step.h), body.maxLinearSpeed);
  const Vec3 gained = turnedProduct(body.inertia, body.rotation, (turn - free.turn) * (1 / step.h));
  const Vec3 spin = turnedProduct(body.invInertia, end.rotation, free.angularMomentum + gained);
  end.angularVelocity = bounded(unlocked(spin, body.locks >> 3), body.maxAngularSpeed);
  return end;
}

}  // namespace

void updateVelocities(WorldData& world, StepData& step) {
  step.end.resize(step.order.size());
  step.rowOfEnd.resize(step.order.size());
  step.endOf.assign(world.bodies.size(), kNone);
  for (const BatchRange& batch : step.batches)
    for (uint32_t i = 0; i < batch.bodies; ++i) {
      const uint32_t slot = step.order[batch.orderBegin + i];
      const size_t at = size_t(8) * (batch.rowBegin + i);
      if (!isFinite(readLin(step.target, at)) || !isFinite(readAng(step.target, at))) fail(world, Stage::Predict, slot);
      if (!isFinite(readLin(step.d, at)) || !isFinite(readAng(step.d, at))) fail(world, Stage::SolveBlocks, slot);
      step.endOf[slot] = batch.orderBegin + i;
      step.rowOfEnd[batch.orderBegin + i] = batch.rowBegin + i;
      StepData::EndState& end = step.end[batch.orderBegin + i];
      end = endState(world.bodies[slot], step, step.free[batch.orderBegin + i], at);
      const bool finite = isFinite(end.position) && isFinite(end.linearVelocity) && isFinite(end.angularVelocity) &&
                          std::isfinite(end.rotation.w + end.rotation.x + end.rotation.y + end.rotation.z);
      if (!finite) fail(world, Stage::Velocities, slot);
    }
  applyRestitution(world, step);
}

}  // namespace avbd
