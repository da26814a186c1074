// Scatter of both sides of a pair: lane after lane, first side a, then side b, so that a row named by several lanes and
// sides sums in the same order at every width.
#pragma once

#include "lane/gather.h"

namespace avbd::lane {

template <int Q, int N>
AVBD_INLINE void addQuarterPairs(float* p, int stride, const uint32_t* a, const Wide<N> (&partA)[4], const uint32_t* b,
                                 const Wide<N> (&partB)[4]) {
  for (int r = 0; r < 4; ++r) {
    float* atA = p + static_cast<size_t>(a[4 * Q + r]) * stride;
    storeQuarter(atA, loadQuarter(atA) + quarterOf<Q>(partA[r]));
    float* atB = p + static_cast<size_t>(b[4 * Q + r]) * stride;
    storeQuarter(atB, loadQuarter(atB) + quarterOf<Q>(partB[r]));
  }
  if constexpr (4 * (Q + 1) < N) addQuarterPairs<Q + 1>(p, stride, a, partA, b, partB);
}

template <int N, int K0, int K>
AVBD_INLINE void scatterPairFrom(float* rows, int stride, const uint32_t* a, const Wide<N> (&va)[K], const uint32_t* b,
                                 const Wide<N> (&vb)[K]) {
  Wide<N> partA[4] = {va[K0], va[K0 + 1], va[K0 + 2], va[K0 + 3]};
  Wide<N> partB[4] = {vb[K0], vb[K0 + 1], vb[K0 + 2], vb[K0 + 3]};
  transposeQuarters(partA[0], partA[1], partA[2], partA[3]);
  transposeQuarters(partB[0], partB[1], partB[2], partB[3]);
  addQuarterPairs<0>(rows + K0, stride, a, partA, b, partB);
  if constexpr (K0 + 4 < K) scatterPairFrom<N, K0 + 4>(rows, stride, a, va, b, vb);
}

/// rows[a[i]] += va of lane i; rows[b[i]] += vb of lane i; lane after lane. K a multiple of 4.
template <int N, int K>
AVBD_INLINE void scatterAddPairs(float* rows, int stride, const uint32_t* a, const Real<N> (&va)[K], const uint32_t* b,
                                 const Real<N> (&vb)[K]) {
  static_assert(K % 4 == 0);
  if constexpr (N == 1) {
    for (int k = 0; k < K; ++k) rows[static_cast<size_t>(a[0]) * stride + k] += va[k];
    for (int k = 0; k < K; ++k) rows[static_cast<size_t>(b[0]) * stride + k] += vb[k];
  } else {
    scatterPairFrom<N, 0>(rows, stride, a, va, b, vb);
  }
}

template <int N>
AVBD_INLINE void scatterAddTwists(float* rows, const uint32_t* a, const Same<Twist<Real<N>>>& ta, const uint32_t* b,
                                  const Same<Twist<Real<N>>>& tb) {
  const Real<N> o(0.0f);
  const Real<N> va[kBodyRow] = {ta.lin.x, ta.lin.y, ta.lin.z, o, ta.ang.x, ta.ang.y, ta.ang.z, o};
  const Real<N> vb[kBodyRow] = {tb.lin.x, tb.lin.y, tb.lin.z, o, tb.ang.x, tb.ang.y, tb.ang.z, o};
  scatterAddPairs<N>(rows, kBodyRow, a, va, b, vb);
}

template <int N>
AVBD_INLINE void scatterAddSym6s(float* rows, const uint32_t* a, const Same<Sym6<Real<N>>>& ma, const uint32_t* b,
                                 const Same<Sym6<Real<N>>>& mb) {
  MatrixRow<Real<N>> ra = matrixRow<Real<N>>(ma), rb = matrixRow<Real<N>>(mb);
  scatterAddPairs<N>(rows, kMatrixRow, a, ra.columns(), b, rb.columns());
}

}  // namespace avbd::lane
