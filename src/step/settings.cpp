// Constants of the method, rescaled so that the behaviour per second does not depend on step or iterations.
#include "step/settings.h"

#include <algorithm>

namespace avbd {

namespace {

constexpr float kCorrection = 0.05f;  ///< 1 - alpha: share of a violation corrected in a reference step
constexpr float kLeak = 0.01f;        ///< share of a contact multiplier that each reference iteration forgets
constexpr float kJointLeak = 0.001f;  ///< the same of joints that no tree holds
constexpr float kSlop = 0.001f;       ///< of the length unit
constexpr float kLoadDepth = 0.005f;  ///< of the length unit: without gravity
constexpr float kNegligible = 1e-4f;  ///< of the load depth, a micrometre: what a search need not correct
constexpr float kResting = 0.5f;      ///< of what gravity gives in a step
constexpr int kKrylovIterations = 12;

}  // namespace

SolveSettings withIterations(SolveSettings settings, int iterations) {
  const float share = static_cast<float>(kReferenceIterations) / static_cast<float>(iterations);
  settings.iterations = iterations;
  settings.contactLeak = 1 - std::min(0.5f, kLeak * share);
  settings.jointLeak = 1 - kJointLeak * share;
  return settings;
}

void chooseSettings(const WorldData& world, StepData& step, float h) {
  const WorldDef& def = world.def;
  const float steps = h / kReferenceStep;
  step.h = h;
  step.alpha = 1 - std::min(1.0f, kCorrection * steps);
  step.slop = kSlop * def.lengthUnit;
  step.restingSpeed = kResting * length(def.gravity) * h;
  const float fall = 2 * length(def.gravity) * h * h;
  step.loadDepth = fall > 0 ? fall : kLoadDepth * def.lengthUnit * steps * steps;
  step.solve.h = h;
  step.solve.negligible = kNegligible * step.loadDepth;
  step.solve.krylovIterations = def.krylovIterations > 0 ? def.krylovIterations : kKrylovIterations;
  step.solve = withIterations(step.solve, def.iterations);
  // The sanitizers see the scalar back-end alone (CMakeLists.txt).
  const int width = def.simdWidth > 0 ? def.simdWidth : kShareAll ? 1 : widestLane();
  step.backend = &backend(width);
}

}  // namespace avbd
