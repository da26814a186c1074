// Small dense factorisations that the elimination of trees is made of.
#pragma once

#include <array>

#include "avbd/rows/row.h"
#include "solve/tree.h"

namespace avbd {

inline std::array<float, 6> entries(const rows::Twist<float>& t) {
  return {t.lin.x, t.lin.y, t.lin.z, t.ang.x, t.ang.y, t.ang.z};
}

/// J of a row about the centre of mass of the body at `arm`; sign -1 for B.
inline void fillJacobian(float (&j)[6], const rows::PairRow<float>& row, const rows::V3<float>& arm, float sign) {
  const std::array<float, 6> at = entries(shiftWrench(rows::Twist<float>{row.lin, row.ang}, arm));
  for (size_t k = 0; k < 6; ++k) j[k] = sign * at[k];
}

/// In place LDL^T of the lower triangle; the diagonal keeps inverse pivots. Only the first n rows.
template <int kMax>
void factorLdl(float (&a)[kMax][kMax], int n) {
  for (int j = 0; j < n; ++j) {
    const float inverse = rows::inversePivot(a[j][j]);
    for (int i = j + 1; i < n; ++i) {
      const float l = a[i][j] * inverse;
      for (int k = j + 1; k <= i; ++k) a[i][k] -= l * a[k][j];
    }
    for (int i = j + 1; i < n; ++i) a[i][j] *= inverse;
    a[j][j] = inverse;
  }
}

template <int kMax>
void solveLdl(const float (&a)[kMax][kMax], int n, float* x) {
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j) x[i] -= a[i][j] * x[j];
  for (int i = 0; i < n; ++i) x[i] *= a[i][i];
  for (int i = n - 2; i >= 0; --i)
    for (int j = i + 1; j < n; ++j) x[i] -= a[j][i] * x[j];
}

/// The same for kColumns right-hand sides side by side.
template <int kColumns, int kMax, int kStride>
void solveLdlColumns(const float (&a)[kMax][kMax], int n, float (*x)[kStride]) {
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j)
      for (int c = 0; c < kColumns; ++c) x[i][c] -= a[i][j] * x[j][c];
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < kColumns; ++c) x[i][c] *= a[i][i];
  for (int i = n - 2; i >= 0; --i)
    for (int j = i + 1; j < n; ++j)
      for (int c = 0; c < kColumns; ++c) x[i][c] -= a[j][i] * x[j][c];
}

/// 1/k that S gets on its diagonal.
inline float complianceOf(const TreeRows<6>&, int) { return 0; }
inline float complianceOf(const MixedRows& rows, int i) { return rows.compliance[i]; }

/// U = Hc^-1 Jc^T and the factor of S = Jc U + 1/k, of m rows.
template <int kColumns, class Rows>
void factorRows(const float (&h)[6][6], Rows& rows, int m) {
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < kColumns; ++i) rows.u[k][i] = i < m && i < Rows::kRows ? rows.jc[i][k] : 0.0f;
  solveLdlColumns<kColumns>(h, 6, rows.u);
  for (int i = 0; i < m; ++i) {
    float sum[kColumns] = {};
    for (int k = 0; k < 6; ++k)
      for (int j = 0; j < kColumns; ++j) sum[j] += rows.jc[i][k] * rows.u[k][j];
    for (int j = 0; j <= i && j < Rows::kRows; ++j) rows.sFactor[i][j] = sum[j];
    rows.sFactor[i][i] += complianceOf(rows, i);
  }
  factorLdl(rows.sFactor, m);
}

/// Calls f.operator()<rows known to the compiler, or 0>(rows of the joint).
template <class F>
void withRows(Forest& forest, TreeJoint& joint, F&& f) {
  if (joint.mixed >= 0) {
    f.template operator()<0>(forest.mixed[static_cast<size_t>(joint.mixed)]);
  } else if (joint.angular) {
    f.template operator()<6>(static_cast<TreeRows<6>&>(joint));
  } else {
    f.template operator()<3>(static_cast<TreeRows<6>&>(joint));
  }
}

}  // namespace avbd
