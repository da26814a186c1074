// Prints state hashes of short runs: the same text from every compiler, level of optimisation, lane width, number of
// workers and processor. test/golden_hashes.txt keeps it.
#include <avbd/avbd.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "test/same_bits_scenes.h"

namespace {

using namespace avbd;

void run(const bits::Trial& trial, WorldDef def, PrimalSolver solver) {
  def.primalSolver = solver;
  World world = trial.make(def);
  const int steps = trial.steps > 0 ? trial.steps : world.bodyCount() > 500 ? 24 : 60;
  std::printf("%s %s", trial.name.c_str(), solver == PrimalSolver::Krylov ? "krylov" : "sweep");
  for (int step = 1; step <= steps; ++step) {
    if (trial.before) trial.before(world);
    world.step(1.0f / 60);
    if (step % (steps / 3) == 0) std::printf(" %016" PRIx64, world.hash());
  }
  std::printf("\n");
}

struct Arguments {
  WorldDef def;
  std::vector<std::string> trials;  ///< empty: all
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const bool width = std::strcmp(argv[i], "--width") == 0, workers = std::strcmp(argv[i], "--workers") == 0;
    if ((width || workers) && i + 1 < argc)
      (width ? arguments.def.simdWidth : arguments.def.workers) = std::stoi(argv[++i]);
    else
      arguments.trials.push_back(argv[i]);
  }
  return arguments;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

// same_bits [--width N] [--workers N] [TRIAL...]: one line a run. Exit status 3: this processor has no such width.
int main(int argc, char** argv) {
  const auto [def, wanted] = parse(argc, argv);
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
      if (!wanted.empty() && !has(wanted, trial.name)) continue;
      run(trial, def, PrimalSolver::Krylov);
      if (trial.sweep) run(trial, def, PrimalSolver::BlockSweep);
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
