// Locked axes.
#include "solve/locks.h"

namespace avbd {

namespace {

/// Place in a hessian row of the block's entry (i, j), i >= j: linear 6, angular-linear 9, angular 6.
int entry(int i, int j) {
  constexpr int kOffDiagonal[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  if (i < 3) return kOffDiagonal[i][j];
  if (j >= 3) return 15 + kOffDiagonal[i - 3][j - 3];
  return 6 + 3 * (i - 3) + j;
}

void lockAxis(float* row, int axis) {
  for (int j = 0; j < 6; ++j) row[j <= axis ? entry(axis, j) : entry(j, axis)] = 0;
  row[entry(axis, axis)] = 1;
}

}  // namespace

void applyLocks(const BatchView& view) {
  for (uint32_t i = 0; i < view.lockedCount; ++i)
    for (int axis = 0; axis < 6; ++axis)
      if (view.locks[i] >> axis & 1) lockAxis(view.hessian + kHessianRow * view.locked[i], axis);
  clearLocked(view, view.gradient);
}

void clearLocked(const BatchView& view, float* array) {
  for (uint32_t i = 0; i < view.lockedCount; ++i)
    for (int axis = 0; axis < 6; ++axis)
      if (view.locks[i] >> axis & 1) array[8 * view.locked[i] + static_cast<uint32_t>(axis < 3 ? axis : axis + 1)] = 0;
}

}  // namespace avbd
