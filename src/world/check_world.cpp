// Settings of a world (check.h).
#include "base/jobs.h"
#include "base/lane_width.h"
#include "world/check.h"
#include "world/limits.h"

namespace avbd {

void checkWorld(const WorldDef& def) {
  const Path path("WorldDef");
  check(path / "lengthUnit", def.lengthUnit, Range{kMinUnit, kMaxUnit});
  const double unit = def.lengthUnit;
  check(path / "gravity", def.gravity, symmetric(kMaxAcceleration * unit));
  check(path / "workers", def.workers, Range{1, Jobs::kMostWorkers});
  if (def.tasks.run) check(path / "tasks" / "workers", def.tasks.workers, Range{1, Jobs::kMostWorkers});
  check(path / "iterations", def.iterations, Range{1, kMaxIterations});
  check(path / "substeps", def.substeps, Range{1, 1000});
  check(path / "restitutionThreshold", def.restitutionThreshold, notNegative(kMaxSpeed * unit));
  check(path / "maxDepenetrationSpeed", def.maxDepenetrationSpeed, notNegative(kMaxSpeed * unit));
  check(path / "hitSpeed", def.hitSpeed, positive(kMaxSpeed * unit));
  check(path / "sleepTime", def.sleepTime, notNegative(kMaxSleepTime));
  check(path / "sleepSpeed", def.sleepSpeed, notNegative(kMaxSpeed));
  check(path / "krylovIterations", def.krylovIterations, Range{0, 1000});
  if (!(def.jointArmBlend == -1 || (def.jointArmBlend >= 0 && def.jointArmBlend <= 1))) {
    (path / "jointArmBlend").refuse(toText(def.jointArmBlend), "must be -1 or within 0 .. 1");
  }
  if (def.primalSolver != PrimalSolver::Krylov && def.primalSolver != PrimalSolver::BlockSweep) {
    (path / "primalSolver").refuse(toText(static_cast<int>(def.primalSolver)), "must be Krylov or BlockSweep");
  }
  const int width = def.simdWidth;
  if (width != 0 && width != 1 && width != 4 && width != 8 && width != 16) {
    (path / "simdWidth").refuse(toText(width), "must be 0, 1, 4, 8 or 16");
  }
  if (width != 0 && !laneWidthRuns(width)) {
    (path / "simdWidth").refuse(toText(width), "must be a width that this processor runs");
  }
}

}  // namespace avbd
