// Block Gauss-Seidel: the order of things.
#include "solve/sweep.h"

#include "solve/locks.h"

namespace avbd {

void solveSweep(const BatchView& view, const Backend& backend, const SolveSettings& settings, const Colors& colors,
                SweepPlan& plan) {
  plan.build(view, colors);
  const SweepView sweep = plan.view();
  const size_t count = plan.colors().size();
  for (int i = 0; i < settings.iterations; ++i) {
    backend.stageRecords(view, sweep, settings, i > 0);
    for (size_t c = 0; c < count; ++c) {
      // To and fro, so that neither end of a stack is always the last to hear.
      const SweepColor& color = plan.colors()[i % 2 == 0 ? c : count - 1 - c];
      backend.stampColor(view, sweep, color);
      if (color.lockedCount) applyLocks(plan.lockedIn(view, color));
      backend.solveColor(view, sweep, color);
    }
  }
}

}  // namespace avbd
