// The solver's kernels as a table of functions, one table a lane width. All give the same bits.
#pragma once

#include "base/lane_width.h"
#include "solve/batch.h"

namespace avbd {

struct SweepView;
struct SweepColor;

struct Backend {
  int width;
  /// Fills the stiffness floors of contact tiles from the masses.
  void (*prepareContacts)(const BatchView&, const SolveSettings&);
  /// gradient = M/h^2 (d - y), hessian = diagonal.
  void (*beginIteration)(const BatchView&);
  /// Adds all rows to gradient and hessian and keeps each pair's 6x6; with `dual` moves the multipliers first.
  void (*stampRows)(const BatchView&, const SolveSettings&, bool dual);
  void (*updateRows)(const BatchView&, const SolveSettings&);
  /// inverse blocks of the hessian.
  void (*factor)(const BatchView&);
  /// z = inverse blocks * r.
  void (*precondition)(const BatchView&);
  /// q = H p.
  void (*multiply)(const BatchView&);
  /// a . b over rows begin .. end; the order of additions does not depend on the width.
  float (*dot)(const float* a, const float* b, uint32_t begin, uint32_t end);
  /// y += s x over rows begin .. end.
  void (*addScaled)(float* y, const float* x, float s, uint32_t begin, uint32_t end);
  /// y = x + s y.
  void (*scaleAdd)(float* y, const float* x, float s, uint32_t begin, uint32_t end);

  // Block sweep (sweep.h).
  /// Copies the pairs to their records; with `dual` moves the multipliers first.
  void (*stageRecords)(const BatchView&, const SweepView&, const SolveSettings&, bool dual);
  /// gradient and hessian of the bodies of a colour, by place.
  void (*stampColor)(const BatchView&, const SweepView&, const SweepColor&);
  /// d -= hessian^-1 gradient for the bodies of a colour.
  void (*solveColor)(const BatchView&, const SweepView&, const SweepColor&);
};

/// Table for a width that this processor runs: 1, 4, 8, 16.
const Backend& backend(int width);

namespace w1 {
extern const Backend kBackend;
}
namespace w4 {
extern const Backend kBackend;
}
namespace w8 {
extern const Backend kBackend;
}
namespace w16 {
extern const Backend kBackend;
}

}  // namespace avbd
