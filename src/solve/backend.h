// The solver's kernels as a table of functions, one table a lane width. All give the same bits.
#pragma once

#include "base/lane_width.h"
#include "solve/batch.h"

namespace avbd {

struct SweepView;
struct SweepColor;

struct Backend {
  int width;
  // Rows. Contacts go by slices of tiles; others are all else that stands in tiles.
  /// Fills the stiffness floors of tiles from the masses.
  void (*prepareContacts)(const BatchView&, const SolveSettings&, Slice tiles);
  void (*prepareOthers)(const BatchView&, const SolveSettings&);
  /// Adds rows to gradient and hessian and keeps each pair's 6x6; with `dual` moves the multipliers first.
  void (*stampContacts)(const BatchView&, const SolveSettings&, bool dual, Slice tiles);
  void (*stampOthers)(const BatchView&, const SolveSettings&, bool dual, ElementBlocks);
  void (*updateContacts)(const BatchView&, const SolveSettings&, Slice tiles);
  void (*updateOthers)(const BatchView&, const SolveSettings&);

  // Body rows; slices begin and end at multiples of 16.
  /// free, target of the bodies in tiles, in a step of h [s].
  void (*freeMotions)(const BatchView&, float h, Slice rows);
  /// mass, invMass, from free.
  void (*massRows)(const BatchView&, float h, Slice rows);
  /// end, from d.
  void (*endMotions)(const BatchView&, float h, Slice rows);
  /// gradient = M/h^2 (d - y), hessian = diagonal.
  void (*beginRows)(const BatchView&, Slice rows);
  /// inverse blocks of the hessian.
  void (*factor)(const BatchView&, Slice rows);
  /// r = -gradient; x, z, p, step = 0.
  void (*beginSearch)(const BatchView&, Slice rows);
  /// p = z + step p, and q = diagonal p.
  void (*turnAndMultiply)(const BatchView&, Slice rows);
  /// q = diagonal p.
  void (*multiplyRows)(const BatchView&, Slice rows);
  /// q += what the rows of H make of p.
  void (*multiplyContacts)(const BatchView&, Slice tiles);
  void (*multiplyOthers)(const BatchView&);
  /// z = inverse blocks * r, product = r . z.
  void (*precondition)(const BatchView&, Slice rows);
  /// product = a . b, row by row.
  void (*dotRows)(const BatchView&, const float* a, const float* b, Slice rows);
  /// x += step p, r -= step q; where step is 0 nothing, whatever p and q are.
  void (*advance)(const BatchView&, Slice rows);
  /// advance, then precondition.
  void (*advanceAndPrecondition)(const BatchView&, Slice rows);
  /// d += x, where x is shortened to turn by at most `mostTurn` [rad].
  void (*moveRows)(const BatchView&, float mostTurn, Slice rows);
  /// Sum of a[begin .. end]; the order of additions does not depend on the width.
  float (*sum)(const float* a, uint32_t begin, uint32_t end);

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
