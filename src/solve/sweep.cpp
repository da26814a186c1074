// Block Gauss-Seidel: the order of things.
#include "solve/sweep.h"

#include "solve/locks.h"

namespace avbd {

void solveSweep(const BatchView& view, const Backend& backend, const SolveSettings& settings, const Colors& colors,
                SweepPlan& plan) {
  plan.build(view, colors);
  const SweepView sweep = plan.view();
  for (int i = 0; i < settings.iterations; ++i) {
    backend.stageRecords(view, sweep, settings, i > 0);
    // Always in the same order. To and fro, the last colour would be the next iteration's first, where little has moved
    // since: with the few colours of a pile that wastes a good part of the work (docs/performance.md).
    for (const SweepColor& color : plan.colors()) {
      backend.stampColor(view, sweep, color);
      if (color.lockedCount) applyLocks(plan.lockedIn(view, color));
      backend.solveColor(view, sweep, color);
    }
  }
}

}  // namespace avbd
