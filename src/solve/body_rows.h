// Reading and adding to single body rows, for what is evaluated one at a time.
#pragma once

#include "avbd/rows/math.h"
#include "solve/batch.h"

namespace avbd {

inline rows::Twist<float> readTwist(const float* array, uint32_t row) {
  const float* p = array + 8 * row;
  return {{p[0], p[1], p[2]}, {p[4], p[5], p[6]}};
}

inline void addTwist(float* array, uint32_t row, const rows::Twist<float>& t) {
  float* p = array + 8 * row;
  p[0] += t.lin.x, p[1] += t.lin.y, p[2] += t.lin.z;
  p[4] += t.ang.x, p[5] += t.ang.y, p[6] += t.ang.z;
}

/// Order of a Sym6's 21 floats in a hessian row: linear 6, angular-linear 9, angular 6.
inline constexpr int kAngularBlock = 15;

inline void addAngular(const BatchView& v, uint32_t row, const rows::Sym3<float>& g) {
  float* h = v.hessian + kHessianRow * row + kAngularBlock;
  float* d = v.diagonal + 8 * row + 1;
  const float value[6] = {g.xx, g.yy, g.zz, g.xy, g.xz, g.yz};
  for (int i = 0; i < 6; ++i) {
    h[i] += value[i];
    d[i] += value[i];
  }
}

inline void addBlock(float* hessian, uint32_t row, const rows::Sym6<float>& s) {
  static_assert(sizeof(s) == 21 * sizeof(float));
  float value[21];
  __builtin_memcpy(value, &s, sizeof(s));
  for (int i = 0; i < 21; ++i) hessian[size_t(kHessianRow) * row + static_cast<size_t>(i)] += value[i];
}

}  // namespace avbd
