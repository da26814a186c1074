// The whole frame on one page.
#include <algorithm>

#include "base/clock.h"
#include "base/float_mode.h"
#include "base/jobs.h"
#include "base/zone.h"
#include "step/break_joints.h"
#include "step/contacts.h"
#include "step/publish_events.h"
#include "step/settings.h"
#include "step/sleeping.h"
#include "step/soft_touches.h"
#include "step/step.h"
#include "step/step_data.h"
#include "world/joints.h"

namespace avbd {

namespace {

void run(Stage stage, void (*f)(WorldData&, StepData&), WorldData& world, StepData& step) {
  AVBD_ZONE(stageName(stage));
  const auto i = static_cast<size_t>(stage);
  const double start = wallSeconds(), shared = step.jobs->sharedSeconds();
  f(world, step);
  world.report.seconds[i] += wallSeconds() - start;
  world.report.sharedSeconds[i] += step.jobs->sharedSeconds() - shared;
}

}  // namespace

Stepper::Stepper() : data_(std::make_unique<StepData>()) {}
Stepper::~Stepper() = default;

namespace {

/// From the contacts to where the bodies would go, and what tied ones would pass on that way.
void solve(WorldData& world, StepData& step) {
  run(Stage::Islands, findIslands, world, step);
  run(Stage::Colors, colorBlocks, world, step);
  run(Stage::BeginRows, beginRows, world, step);
  run(Stage::Predict, predict, world, step);
  run(Stage::SolveBlocks, solveBlocks, world, step);
  run(Stage::UpdateRows, updateRows, world, step);
  run(Stage::Velocities, updateVelocities, world, step);
  run(Stage::Continuous, findTiedImpacts, world, step);
}

void substep(WorldData& world, StepData& step) {
  if (world.contactHook && world.hookedShapes > 0 && step.substep == 0) rememberPairs(world, step);
  step.round = 0;
  step.swept.clear(), step.tied.refused.clear();
  run(Stage::Pairs, findPairs, world, step);
  run(Stage::Contacts, findContacts, world, step);
  solve(world, step);
  for (step.round = 1; !step.tied.meetings.empty(); ++step.round) {
    run(Stage::Contacts, sweepContacts, world, step);
    solve(world, step);
  }
  run(Stage::Continuous, stopAtImpacts, world, step);
  run(Stage::Continuous, stopSofts, world, step);
  run(Stage::Sleep, chooseSleepers, world, step);
  run(Stage::Publish, publish, world, step);
}

void forgetForces(WorldData& world) {
  for (const uint32_t slot : world.sleep.awake) world.bodies[slot].force = world.bodies[slot].torque = {};
  clearJointForces(world);
}

void restore(WorldData& world, StepData& step) {
  restoreAwake(world, step);
  if (step.pairsKept)
    restorePairs(world, step);
  else
    forgetTouches(world, step);
  restoreSleepers(world, step);
}

}  // namespace

void Stepper::step(WorldData& world, float dt) {
  StepData& step = *data_;
  const FloatMode mode;
  if (!jobs_) jobs_ = std::make_unique<Jobs>(std::max(world.def.workers, kShareAll ? 3 : 1), world.def.tasks);
  step.jobs = jobs_.get();
  world.report.seconds = world.report.sharedSeconds = {};
  const uint64_t runs = jobs_->sharedRuns();
  world.report.fastBodies = world.report.impacts = 0;
  rememberAwake(world, step);
  chooseSettings(world, step, dt / static_cast<float>(world.def.substeps));
  beginEvents(world, step);
  step.pairsKept = false;
  for (step.substep = 0; step.substep < world.def.substeps; ++step.substep) {
    try {
      substep(world, step);
    } catch (...) {  // NonFiniteError, or an Error for what the contact hook answered
      restore(world, step);
      throw;
    }
  }
  forgetForces(world);
  run(Stage::Sleep, settle, world, step);
  if (world.breakable > 0) breakJoints(world);
  world.time += dt;
  ++world.report.step;
  world.report.sharedRuns = static_cast<uint32_t>(jobs_->sharedRuns() - runs);
  jobs_->throwFailure();
}

}  // namespace avbd
