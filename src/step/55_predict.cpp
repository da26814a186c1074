// Prediction: where the iterations start (d).
//
// The start decides how near the frozen friction cones and active sets of the first iteration are to the truth. A body
// that its contacts and joints carry starts from its velocity (at rest: from rest); one that they barely touch starts
// from free motion; one whose contacts all slide starts from the acceleration that it had, because near the threshold
// of sliding the majorised friction rows give way only slowly.
#include <algorithm>

#include "solve/parts.h"
#include "step/begin_chunks.h"
#include "step/begin_rows.h"
#include "step/free_motion.h"
#include "world/joints.h"

namespace avbd {

namespace {

constexpr float kLoaded = 0.1f;      ///< of its weight: a body whose multipliers carry less starts from free motion
constexpr uint8_t kSteadySlide = 3;  ///< steps that a contact must have slid before the acceleration is trusted

/// Adds what a contact gave its bodies in the last step and sees whether it slides.
void sumContact(const WorldData& world, StepData& step, uint32_t index, uint32_t rowA, uint32_t rowB) {
  const PairData& pair = world.pairs[index];
  if (pair.slides < kSteadySlide) step.slidesOnly[rowA] = step.slidesOnly[rowB] = 0;
  Vec3 force;
  for (int i = 0; i < pair.pointCount; ++i) {
    const Vec3 l = pair.points[i].lambda;
    force = force + pair.normal * l.x + pair.t1 * l.y + pair.t2 * l.z;
  }
  float scaleA = 1, scaleB = 1;
  if (!step.changes.empty()) scaleA = changeOf(step, index).scaleA, scaleB = changeOf(step, index).scaleB;
  step.carried[rowA] = step.carried[rowA] - force * scaleA;
  step.carried[rowB] = step.carried[rowB] + force * scaleB;
}

void sumLanes(const WorldData& world, StepData& step, const BatchRange& batch, const std::vector<uint32_t>& pairs,
              const std::vector<uint32_t> (&rows)[2], Slice tiles) {
  for (size_t lane = size_t(kTile) * tiles.begin; lane < size_t(kTile) * tiles.end; ++lane) {
    prefetchAhead(world, pairs, lane);
    if (pairs[lane] != kNone)
      sumContact(world, step, pairs[lane], batch.rowBegin + rows[0][lane], batch.rowBegin + rows[1][lane]);
  }
}

void sumJoints(const WorldData& world, StepData& step, const BatchRange& batch) {
  const auto rowOf = [&](uint32_t body) { return isDynamic(world, body) ? batch.rowBegin + step.rowOf[body] : kNone; };
  const auto add = [&](uint32_t body, Vec3 force) {
    if (rowOf(body) != kNone) step.carried[rowOf(body)] = step.carried[rowOf(body)] + force;
  };
  for (uint32_t n = batch.islandBegin; n < batch.islandBegin + batch.islandCount; ++n)
    for (uint32_t i = 0; i < step.islands[n].jointCount; ++i) {
      const uint32_t slot = step.islandJoints[step.islands[n].jointBegin + i];
      const JointData& joint = world.joints[slot];
      forEachBody(world, slot, [&](uint32_t body) {
        if (rowOf(body) != kNone) step.slidesOnly[rowOf(body)] = 0;
      });
      if (!hasFrames(joint.type) || joint.type == JointType::Pulley) continue;
      const Vec3 force{joint.lambda[0], joint.lambda[1], joint.lambda[2]};
      add(joint.body[0], -force), add(joint.body[1], force);
    }
}

/// Sums the forces that contacts and joints gave each body in the last step and sees which bodies only slide.
void sumCarried(const WorldData& world, StepData& step, uint32_t index, const Parts& parts) {
  const BatchRange& batch = step.batches[index];
  const auto sum = [&](Slice tiles) {
    const Slice all{batch.contactTile + tiles.begin, batch.contactTile + tiles.end};
    sumLanes(world, step, batch, step.contactPair, step.contactRow, all);
  };
  parts.chunks([&](const Chunk& chunk) { sum(chunk.tiles); });
  parts.seams(sum);
  sumLanes(world, step, batch, step.fullPair, step.fullRow, {batch.fullTile, batch.fullTile + batch.fullTiles});
  sumJoints(world, step, batch);
}

/// The acceleration of the last step, never more than gravity's.
Vec3 steadyAcceleration(const BodyData& body, float weight) {
  const float limit = weight / body.mass, size = length(body.acceleration);
  return size > limit ? body.acceleration * (limit / size) : body.acceleration;
}

void write(float* row, Vec3 lin, Vec3 ang) {
  row[0] = lin.x, row[1] = lin.y, row[2] = lin.z;
  row[4] = ang.x, row[5] = ang.y, row[6] = ang.z;
}

void predictBody(const WorldData& world, StepData& step, uint32_t index, uint32_t row) {
  const size_t at = size_t(8) * row;
  const BodyData& body = world.bodies[step.order[index]];
  const float weight = length(world.def.gravity) * rows::abs(body.gravityScale) * body.mass;
  if (body.soft != kNone) return;  // predictSofts()
  if (length(step.carried[row]) <= kLoaded * weight) {
    std::copy_n(step.target.data() + at, 8, step.d.data() + at);
    return;
  }
  Vec3 start = body.linearVelocity * step.h;
  if (step.slidesOnly[row]) start = start + steadyAcceleration(body, weight) * (step.h * step.h);
  write(step.d.data() + at, unlocked(start, body.locks), unlocked(body.angularVelocity * step.h, body.locks >> 3));
}

/// What meets something on its way starts where it does.
void startAtImpacts(StepData& step) {
  for (const BatchRange& batch : step.batches)
    for (uint32_t n = batch.islandBegin; n < batch.islandBegin + batch.islandCount; ++n) {
      const float time = step.islands[n].startTime;
      if (time == 1) continue;
      const IslandRange& island = step.ranges[n];
      float* d = step.d.data() + size_t(8) * (batch.rowBegin + island.begin);
      for (uint32_t i = 0; i < 8 * (island.end - island.begin); ++i) d[i] *= time;
    }
}

}  // namespace

void predict(WorldData& world, StepData& step) {
  step.carried.assign(step.rows(), Vec3{});
  step.slidesOnly.assign(step.rows(), 1);
  forBatches(step, [&](uint32_t batch, Jobs* jobs, int) {
    const BatchView view = step.view(batch);
    sumCarried(world, step, batch, Parts(view, jobs));
  });
  forUnits(step, [&](const WorkUnit& unit) {
    forBodies(step, unit, [&](uint32_t index, uint32_t row) { predictBody(world, step, index, row); });
  });
  predictSofts(world, step);
  if (!step.swept.empty()) startAtImpacts(step);
}

}  // namespace avbd
