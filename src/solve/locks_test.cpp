// Locked axes leave a system in which they are alone.
#include "solve/locks.h"

#include <gtest/gtest.h>

#include "solve/backend.h"
#include "solve/batch_oracle.h"

namespace avbd::oracle {
namespace {

/// Entry (i, j) of the 6x6 in a hessian row, found by a product: needs nothing of how the row is laid out but Sym6.
float entryOf(const float* row, int i, int j) {
  rows::Sym6<float> block;
  std::memcpy(&block, row, sizeof(block));
  float unit[6] = {}, got[6];
  unit[j] = 1;
  const rows::Twist<float> column = block * twistAt(unit);
  put(got, column.lin), put(got + 3, column.ang);
  return got[i];
}

struct Locked : testing::TestWithParam<int> {
  static constexpr uint32_t kBodies = 20, kRow = 17;
  Random random{5};
  TestBatch batch{kBodies, 1};
  uint8_t locks = static_cast<uint8_t>(GetParam());
  void SetUp() override {
    for (float& a : batch.hessian) a = random.number(10);
    for (float& a : batch.gradient) a = 1 + std::fabs(random.number());
    batch.locked = {3, kRow};
    batch.locks = {1, locks};
  }
  bool isLocked(size_t axis) const { return locks >> axis & 1; }
};

TEST_P(Locked, AxesStandAlone) {
  const AlignedVector<float> before = batch.hessian, gradient = batch.gradient;
  applyLocks(batch.view());
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const bool gone = isLocked(size_t(i)) || isLocked(size_t(j));
      const float expected = gone ? float(i == j) : entryOf(before.data() + kHessianRow * kRow, i, j);
      EXPECT_EQ(entryOf(batch.hessian.data() + kHessianRow * kRow, i, j), expected) << i << j;
    }
  for (size_t k = 0; k < 6; ++k)
    EXPECT_EQ(batch.gradient[rowEntry(kRow, k)], isLocked(k) ? 0 : gradient[rowEntry(kRow, k)]);
  // The neighbours keep what they had.
  for (const uint32_t row : {2u, 4u, 16u, 18u}) {
    for (size_t k = 0; k < kHessianRow; ++k)
      EXPECT_EQ(batch.hessian[kHessianRow * row + k], before[kHessianRow * row + k]);
    for (size_t k = 0; k < 8; ++k) EXPECT_EQ(batch.gradient[8 * row + k], gradient[8 * row + k]);
  }
}

TEST_P(Locked, AxesGetNoPart) {
  applyLocks(batch.view());
  // Positive definite where it is not locked.
  for (uint32_t row : {3u, kRow}) {
    float* h = batch.hessian.data() + kHessianRow * row;
    for (const int diagonal : {0, 1, 2, 15, 16, 17})
      if (h[diagonal] != 1) h[diagonal] += 100;
  }
  for (float& a : batch.r) a = random.number(10);
  const BatchView view = batch.view();
  clearLocked(view, view.r);
  for (const int width : {1, 4, 8, 16}) {
    if (!laneWidthRuns(width)) continue;
    backend(width).factor(view, {0, view.rows});
    backend(width).precondition(view, {0, view.rows});
    for (size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(batch.z[rowEntry(kRow, k)] == 0, isLocked(k)) << k;
      EXPECT_EQ(batch.r[rowEntry(kRow, k)] == 0, isLocked(k)) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Masks, Locked, testing::Values(0, 1, 2, 4, 8, 16, 32, 7, 56, 21, 42, 63));

}  // namespace
}  // namespace avbd::oracle
