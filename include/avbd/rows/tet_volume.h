// Volume of a tetrahedron over four blocks: one row.
//
// C = (b - a) . ((c - a) x (d - a)) / 6 - V0 at the current positions, as C_start plus the change; J is its exact
// gradient: J_b = (c - a) x (d - a) / 6, J_c = (d - a) x (b - a) / 6, J_d = (b - a) x (c - a) / 6, J_a = -(J_b + J_c +
// J_d). Left out: the second derivative of C.
#pragma once

#include <avbd/rows/row.h>

namespace avbd::rows {

template <class R>
struct TetVolume {
  static constexpr int kBlocks = 4;
  V3<R> ab, ac, ad;  ///< edges at the start of the step [m]
  R bias;            ///< C at the start of the step, stabilised [m^3]
  R k, s;            ///< [N/m^5]
  R lambda;          ///< [J/m^3]

  template <class Sink>
  AVBD_INLINE void rows(const V3<R> (&d)[4], Sink& sink) {
    const V3<R> b = ab + (d[1] - d[0]), c = ac + (d[2] - d[0]), e = ad + (d[3] - d[0]);
    const R sixth = splat<R>(1.0f / 6), inf = splat<R>(kInfinity);
    BlockRow<R, 4> row;
    row.lin[1] = cross(c, e) * sixth;
    row.lin[2] = cross(e, b) * sixth;
    row.lin[3] = cross(b, c) * sixth;
    row.lin[0] = -(row.lin[1] + row.lin[2] + row.lin[3]);
    // The change of volume, term by term: the difference of two volumes would lose it in rounding.
    const V3<R> db = d[1] - d[0], dc = d[2] - d[0], de = d[3] - d[0];
    row.C = bias + (dot(db, cross(c, e)) + dot(ab, cross(dc, e)) + dot(ab, cross(ac, de))) * sixth;
    row.k = k;
    row.s = s;
    row.lower = -inf;
    row.upper = inf;
    sink.emit(row, lambda);
  }
};

}  // namespace avbd::rows
