// Sinks: what listens to the rows of a family.
#pragma once

#include <avbd/rows/row.h>

namespace avbd::rows {

/// Share of a trial friction force that the cone allows: min(1, bound / |trial|), 1 where there is none.
template <class R>
AVBD_INLINE R coneShare(const R& f1, const R& f2, const R& bound) {
  const R size = sqrt(f1 * f1 + f2 * f2);
  return select(size > bound, bound / select(size > bound, size, splat<R>(1)), splat<R>(1));
}

/// The same of one force alone.
template <class R>
AVBD_INLINE R boundedShare(const R& f, const R& bound) {
  const R size = abs(f);
  return select(size > bound, bound / select(size > bound, size, splat<R>(1)), splat<R>(1));
}

/// Primal: gathers the gradient J^T F as a wrench at the reference point and the Hessian J^T k J about it.
template <class R>
struct StampSink {
  V3<R> armA, armB;
  Twist<R> wrench;  ///< on A; B gets the opposite
  Sym6<R> stiffness;

  AVBD_INLINE void clear() {
    wrench = zeroTwist<R>();
    stiffness = zeroSym6<R>();
  }
  AVBD_INLINE void arms(const V3<R>& a, const V3<R>& b) {
    armA = a;
    armB = b;
  }
  AVBD_INLINE void add(const PairRow<R>& row, const R& force, const R& k) {
    const Twist<R> w{row.lin, row.ang};
    wrench.lin = wrench.lin + w.lin * force;
    wrench.ang = wrench.ang + w.ang * force;
    addOuter(stiffness, k, w);
  }
  AVBD_INLINE R emit(const PairRow<R>& row, R& lambda) {
    const R f = clamp(row.s * lambda + row.k * row.C, row.lower, row.upper);
    add(row, f, row.k);
    return f;
  }
  /// Two tangent rows under one circular bound. Their Hessian is a majoriser: k times the share that the cone allows.
  AVBD_INLINE R emitCone(const PairRow<R>& r1, const PairRow<R>& r2, R& l1, R& l2, const R& bound) {
    const R f1 = l1 + r1.k * r1.C, f2 = l2 + r2.k * r2.C;
    const R share = coneShare(f1, f2, bound);
    add(r1, f1 * share, r1.k * share);
    add(r2, f2 * share, r2.k * share);
    return share;
  }
  /// The same of one row: friction in one direction.
  AVBD_INLINE R emitBounded(const PairRow<R>& row, R& lambda, const R& bound) {
    const R f = lambda + row.k * row.C;
    const R share = boundedShare(f, bound);
    add(row, f * share, row.k * share);
    return share;
  }
};

/// Dual: the multiplier becomes the force, times `leak` (1: none).
template <class R>
struct DualSink {
  R leak;
  AVBD_INLINE void arms(const V3<R>&, const V3<R>&) {}
  AVBD_INLINE R emit(const PairRow<R>& row, R& lambda) {
    const R f = clamp(row.s * lambda + row.k * row.C, row.lower, row.upper);
    lambda = leak * f;
    return f;
  }
  AVBD_INLINE R emitCone(const PairRow<R>& r1, const PairRow<R>& r2, R& l1, R& l2, const R& bound) {
    const R f1 = l1 + r1.k * r1.C, f2 = l2 + r2.k * r2.C;
    const R share = coneShare(f1, f2, bound);
    l1 = leak * f1 * share;
    l2 = leak * f2 * share;
    return share;
  }
  AVBD_INLINE R emitBounded(const PairRow<R>& row, R& lambda, const R& bound) {
    const R f = lambda + row.k * row.C;
    const R share = boundedShare(f, bound);
    lambda = leak * f * share;
    return share;
  }
};

/// Keeps every row as it is (tests, reports, the exact tree). Friction rows count like the others.
template <class R, int kMax>
struct ProbeSink {
  V3<R> armA, armB;
  PairRow<R> row[kMax];
  R* lambda[kMax];
  int count = 0;
  AVBD_INLINE void arms(const V3<R>& a, const V3<R>& b) {
    armA = a;
    armB = b;
  }
  AVBD_INLINE R emit(const PairRow<R>& r, R& l) {
    row[count] = r;
    lambda[count++] = &l;
    return clamp(r.s * l + r.k * r.C, r.lower, r.upper);
  }
  AVBD_INLINE R emitCone(const PairRow<R>& r1, const PairRow<R>& r2, R& l1, R& l2, const R& bound) {
    emit(r1, l1);
    emit(r2, l2);
    return coneShare(l1 + r1.k * r1.C, l2 + r2.k * r2.C, bound);
  }
  AVBD_INLINE R emitBounded(const PairRow<R>& r, R& l, const R& bound) {
    emit(r, l);
    return boundedShare(l + r.k * r.C, bound);
  }
};

/// Primal sink of rows over N blocks.
template <class R, int N>
struct BlockStampSink {
  V3<R> gradient[N];
  Sym3<R> diagonal[N];
  V3<R> lin[N];  ///< J of the row, for products with the whole Hessian
  R k;
  AVBD_INLINE R emit(const BlockRow<R, N>& row, R& lambda) {
    const R f = clamp(row.s * lambda + row.k * row.C, row.lower, row.upper);
    k = row.k;
    for (int i = 0; i < N; ++i) {
      lin[i] = row.lin[i];
      gradient[i] = row.lin[i] * f;
      diagonal[i] = rows::diagonal(zeroV3<R>());
      addOuter(diagonal[i], row.k, row.lin[i]);
    }
    return f;
  }
};

template <class R, int N>
struct BlockDualSink {
  R leak;
  AVBD_INLINE R emit(const BlockRow<R, N>& row, R& lambda) {
    const R f = clamp(row.s * lambda + row.k * row.C, row.lower, row.upper);
    lambda = leak * f;
    return f;
  }
};

template <class R, int N>
struct BlockProbeSink {
  BlockRow<R, N> row;
  AVBD_INLINE R emit(const BlockRow<R, N>& r, R& lambda) {
    row = r;
    return clamp(r.s * lambda + r.k * r.C, r.lower, r.upper);
  }
};

}  // namespace avbd::rows
