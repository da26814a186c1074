// Prints state hashes of short runs: the same text from every compiler, level of optimisation, lane width, number of
// workers and processor. test/golden_hashes.txt keeps it.
#include <avbd/avbd.h>

#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <string>

#include "test/same_bits_scenes.h"

namespace {

using namespace avbd;

void run(const bits::Trial& trial, WorldDef def, PrimalSolver solver) {
  def.primalSolver = solver;
  World world = trial.make(def);
  std::printf("%s %s", trial.name.c_str(), solver == PrimalSolver::Krylov ? "krylov" : "sweep");
  for (int step = 1; step <= trial.steps; ++step) {
    if (trial.before) trial.before(world);
    world.step(1.0f / 60);
    if (step % (trial.steps / 3) == 0) std::printf(" %016" PRIx64, world.hash());
  }
  std::printf("\n");
}

// "--width 8": the number after a name.
int option(int argc, char** argv, const char* name, int otherwise) {
  for (int i = 1; i + 1 < argc; ++i)
    if (std::strcmp(argv[i], name) == 0) return std::stoi(argv[i + 1]);
  return otherwise;
}

}  // namespace

// same_bits [--width N] [--workers N]: one line a run. Exit status 3: this processor has no such width.
int main(int argc, char** argv) {
  const WorldDef def{.workers = option(argc, argv, "--workers", 1), .simdWidth = option(argc, argv, "--width", 0)};
  try {
    World{def};
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  try {
    std::vector<bits::Trial> trials = bits::smallTrials();
    for (bits::Trial& trial : bits::sceneTrials()) trials.push_back(std::move(trial));
    for (const bits::Trial& trial : trials) {
      run(trial, def, PrimalSolver::Krylov);
      if (trial.sweep) run(trial, def, PrimalSolver::BlockSweep);
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
