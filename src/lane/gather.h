// Gather and scatter of body rows: rows of floats in memory <-> one register per column.
//
// A row is read and written in quarters of four floats, and a register of N lanes is taken as N/4 quarters: quarter q
// of register r starts as row 4q + r, and one 4x4 transpose inside the quarters then turns four registers into four
// columns, at every width with the same eight shuffles. Sums go row by row in lane order, so a row that repeats gets
// the same bits at every width.
#pragma once

#include <avbd/rows/math.h>

#include <cstddef>

#include "lane/wide.h"

namespace avbd::lane {

using rows::Sym6;
using rows::Twist;

inline constexpr int kBodyRow = 8;     ///< floats: lin xyz, pad, ang xyz, pad
inline constexpr int kMatrixRow = 24;  ///< floats: the 21 of a Sym6 in its order, 3 pads

using Quarter = Registers<4>::F;

AVBD_INLINE Quarter loadQuarter(const float* p) { return *reinterpret_cast<const Registers<4>::FAligned*>(p); }
AVBD_INLINE void storeQuarter(float* p, Quarter q) { *reinterpret_cast<Registers<4>::FAligned*>(p) = q; }

/// The register whose quarters stand at p[row[0]], p[row[4]], ... as offsets.
template <int N>
AVBD_INLINE Wide<N> loadQuarters(const float* p, int stride, const uint32_t* row) {
  const Quarter a = loadQuarter(p + static_cast<size_t>(row[0]) * stride);
  if constexpr (N == 4) {
    return Wide<4>(a);
  } else if constexpr (N == 8) {
    const Quarter b = loadQuarter(p + static_cast<size_t>(row[4]) * stride);
    return Wide<8>(__builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7));
  } else {
    const auto low = loadQuarters<8>(p, stride, row).v, high = loadQuarters<8>(p, stride, row + 8).v;
    return Wide<16>(__builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
  }
}
/// Quarter q of a register.
template <int Q, int N>
AVBD_INLINE Quarter quarterOf(Wide<N> a) {
  return __builtin_shufflevector(a.v, a.v, 4 * Q, 4 * Q + 1, 4 * Q + 2, 4 * Q + 3);
}

// The four shuffles of a 4x4 transpose, within each quarter.
template <int N>
AVBD_INLINE Wide<N> interleaveLow(Wide<N> a, Wide<N> b) {
  if constexpr (N == 4)
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 0, 4, 1, 5));
  else if constexpr (N == 8)
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 0, 8, 1, 9, 4, 12, 5, 13));
  else
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29));
}
template <int N>
AVBD_INLINE Wide<N> interleaveHigh(Wide<N> a, Wide<N> b) {
  if constexpr (N == 4)
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 2, 6, 3, 7));
  else if constexpr (N == 8)
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 2, 10, 3, 11, 6, 14, 7, 15));
  else
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31));
}
template <int N>
AVBD_INLINE Wide<N> lowHalves(Wide<N> a, Wide<N> b) {
  if constexpr (N == 4)
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 0, 1, 4, 5));
  else if constexpr (N == 8)
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 0, 1, 8, 9, 4, 5, 12, 13));
  else
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29));
}
template <int N>
AVBD_INLINE Wide<N> highHalves(Wide<N> a, Wide<N> b) {
  if constexpr (N == 4)
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 2, 3, 6, 7));
  else if constexpr (N == 8)
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 2, 3, 10, 11, 6, 7, 14, 15));
  else
    return Wide<N>(__builtin_shufflevector(a.v, b.v, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31));
}
/// Its own inverse.
template <int N>
AVBD_INLINE void transposeQuarters(Wide<N>& a, Wide<N>& b, Wide<N>& c, Wide<N>& d) {
  const Wide<N> ab0 = interleaveLow(a, b), ab1 = interleaveHigh(a, b);
  const Wide<N> cd0 = interleaveLow(c, d), cd1 = interleaveHigh(c, d);
  a = lowHalves(ab0, cd0);
  b = highHalves(ab0, cd0);
  c = lowHalves(ab1, cd1);
  d = highHalves(ab1, cd1);
}

/// Columns 0 .. 3 of N rows; p is aligned to 16 bytes, stride [floats] is a multiple of 4.
template <int N>
AVBD_INLINE void gatherFour(const float* p, int stride, const uint32_t* row, Wide<N>* column) {
  for (int r = 0; r < 4; ++r) column[r] = loadQuarters<N>(p, stride, row + r);
  transposeQuarters(column[0], column[1], column[2], column[3]);
}
template <int Q, int N>
AVBD_INLINE void addQuarters(float* p, int stride, const uint32_t* row, const Wide<N> (&part)[4]) {
  for (int r = 0; r < 4; ++r) {
    float* at = p + static_cast<size_t>(row[4 * Q + r]) * stride;
    storeQuarter(at, loadQuarter(at) + quarterOf<Q>(part[r]));
  }
  if constexpr (4 * (Q + 1) < N) addQuarters<Q + 1>(p, stride, row, part);
}
template <int Q, int N>
AVBD_INLINE void storeQuarters(float* p, int stride, const Wide<N> (&part)[4]) {
  for (int r = 0; r < 4; ++r) storeQuarter(p + (4 * Q + r) * stride, quarterOf<Q>(part[r]));
  if constexpr (4 * (Q + 1) < N) storeQuarters<Q + 1>(p, stride, part);
}

// ---- Rows of K floats, K a multiple of 4 -----------------------------------------------------------------------

// The steps of four columns are recursions, because a loop would send the values through the stack.
template <int N, int K0, int K>
AVBD_INLINE void gatherFrom(const float* rows, int stride, const uint32_t* index, Wide<N> (&values)[K]) {
  gatherFour<N>(rows + K0, stride, index, values + K0);
  if constexpr (K0 + 4 < K) gatherFrom<N, K0 + 4>(rows, stride, index, values);
}
/// values[k] of lane i = rows[index[i] * stride + k]
template <int N, int K>
AVBD_INLINE void gatherRows(const float* rows, int stride, const uint32_t* index, Real<N> (&values)[K]) {
  static_assert(K % 4 == 0);
  if constexpr (N == 1) {
    for (int k = 0; k < K; ++k) values[k] = rows[static_cast<size_t>(index[0]) * stride + k];
  } else {
    gatherFrom<N, 0>(rows, stride, index, values);
  }
}
template <int N, int K0, int K>
AVBD_INLINE void scatterAddFrom(float* rows, int stride, const uint32_t* index, const Wide<N> (&values)[K]) {
  Wide<N> part[4] = {values[K0], values[K0 + 1], values[K0 + 2], values[K0 + 3]};
  transposeQuarters(part[0], part[1], part[2], part[3]);
  addQuarters<0>(rows + K0, stride, index, part);
  if constexpr (K0 + 4 < K) scatterAddFrom<N, K0 + 4>(rows, stride, index, values);
}
/// rows[index[i] * stride + k] += values[k] of lane i, lane after lane.
template <int N, int K>
AVBD_INLINE void scatterAddRows(float* rows, int stride, const uint32_t* index, const Real<N> (&values)[K]) {
  static_assert(K % 4 == 0);
  if constexpr (N == 1) {
    for (int k = 0; k < K; ++k) rows[static_cast<size_t>(index[0]) * stride + k] += values[k];
  } else {
    scatterAddFrom<N, 0>(rows, stride, index, values);
  }
}
template <int N, int K0, int K>
AVBD_INLINE void storeFrom(float* rows, int stride, const Wide<N> (&values)[K]) {
  Wide<N> part[4] = {values[K0], values[K0 + 1], values[K0 + 2], values[K0 + 3]};
  transposeQuarters(part[0], part[1], part[2], part[3]);
  storeQuarters<0>(rows + K0, stride, part);
  if constexpr (K0 + 4 < K) storeFrom<N, K0 + 4>(rows, stride, values);
}
/// N consecutive rows.
template <int N, int K>
AVBD_INLINE void loadRows(const float* rows, int stride, Real<N> (&values)[K]) {
  uint32_t index[N];
  for (int i = 0; i < N; ++i) index[i] = i;
  gatherRows<N>(rows, stride, index, values);
}
template <int N, int K>
AVBD_INLINE void storeRows(float* rows, int stride, const Real<N> (&values)[K]) {
  static_assert(K % 4 == 0);
  if constexpr (N == 1) {
    for (int k = 0; k < K; ++k) rows[k] = values[k];
  } else {
    storeFrom<N, 0>(rows, stride, values);
  }
}

// ---- Twists of bodies: rows of 8 floats, 32-byte aligned -------------------------------------------------------

template <int N>
AVBD_INLINE Twist<Real<N>> gatherTwist(const float* rows, const uint32_t* index) {
  Real<N> c[kBodyRow];
  gatherRows<N>(rows, kBodyRow, index, c);
  return {{c[0], c[1], c[2]}, {c[4], c[5], c[6]}};
}
/// The pads get + 0.
template <int N>
AVBD_INLINE void scatterAddTwist(float* rows, const uint32_t* index, const Same<Twist<Real<N>>>& t) {
  const Real<N> o(0.0f);
  const Real<N> c[kBodyRow] = {t.lin.x, t.lin.y, t.lin.z, o, t.ang.x, t.ang.y, t.ang.z, o};
  scatterAddRows<N>(rows, kBodyRow, index, c);
}
/// N consecutive rows.
template <int N>
AVBD_INLINE Twist<Real<N>> loadTwists(const float* rows) {
  Real<N> c[kBodyRow];
  loadRows<N>(rows, kBodyRow, c);
  return {{c[0], c[1], c[2]}, {c[4], c[5], c[6]}};
}
/// The pads become 0.
template <int N>
AVBD_INLINE void storeTwists(float* rows, const Same<Twist<Real<N>>>& t) {
  const Real<N> o(0.0f);
  const Real<N> c[kBodyRow] = {t.lin.x, t.lin.y, t.lin.z, o, t.ang.x, t.ang.y, t.ang.z, o};
  storeRows<N>(rows, kBodyRow, c);
}

// ---- 6x6 blocks of bodies: rows of 24 floats -------------------------------------------------------------------

/// Such a row: its members stand in the order of the row's floats.
template <class R>
struct MatrixRow {
  Sym6<R> block;
  R pad[3];
  AVBD_INLINE R (&columns())[kMatrixRow] { return reinterpret_cast<R(&)[kMatrixRow]>(*this); }
};
template <class R>
AVBD_INLINE MatrixRow<R> matrixRow(const Sym6<R>& block) {
  return {block, {R(0.0f), R(0.0f), R(0.0f)}};
}
template <int N>
AVBD_INLINE Sym6<Real<N>> gatherSym6(const float* rows, const uint32_t* index) {
  MatrixRow<Real<N>> row;
  gatherRows<N>(rows, kMatrixRow, index, row.columns());
  return row.block;
}
template <int N>
AVBD_INLINE void scatterAddSym6(float* rows, const uint32_t* index, const Same<Sym6<Real<N>>>& m) {
  MatrixRow<Real<N>> row = matrixRow<Real<N>>(m);
  scatterAddRows<N>(rows, kMatrixRow, index, row.columns());
}
template <int N>
AVBD_INLINE Sym6<Real<N>> loadSym6(const float* rows) {
  MatrixRow<Real<N>> row;
  loadRows<N>(rows, kMatrixRow, row.columns());
  return row.block;
}
template <int N>
AVBD_INLINE void storeSym6(float* rows, const Same<Sym6<Real<N>>>& m) {
  MatrixRow<Real<N>> row = matrixRow<Real<N>>(m);
  storeRows<N>(rows, kMatrixRow, row.columns());
}

}  // namespace avbd::lane
