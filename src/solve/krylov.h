// Primal solver: conjugate gradients over each island of a batch, preconditioned by exact blocks and exact trees.
#pragma once

#include "base/jobs.h"
#include "solve/backend.h"
#include "solve/tree.h"

namespace avbd {

/// What a start along two ways needs: products with the force, and with each other through H.
struct StartSums {
  float down[2], curvature[2], both;
};

/// What one batch is solved with; memory is kept between steps.
struct KrylovScratch {
  std::vector<float> rz, limit, step;
  std::vector<float> least;       ///< of r . M^-1 r: below it an island is solved
  std::vector<StartSums> start;   ///< by island
  std::vector<uint8_t> active;    ///< islands that still iterate within an outer iteration
  std::vector<uint8_t> unsolved;  ///< islands that outer iterations still move
};

/// What a batch is solved by.
struct KrylovTools {
  const Backend& backend;
  Jobs* jobs = nullptr;  ///< null: the calling thread does all
};

/// Runs all outer iterations: d and the multipliers of the batch move to the end of the step. `forest` may be null.
void solveKrylov(const BatchView& view, const KrylovTools& tools, const SolveSettings& settings, Forest* forest,
                 KrylovScratch& scratch);

}  // namespace avbd
