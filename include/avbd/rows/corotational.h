// Co-rotational elasticity of a solid, of tetrahedra and of stars: Hooke's law in the frame that turns with the
// element, in units of energy (times the volume at rest).
//
// E = mu |F - R|^2 + lambda/2 (tr(R^T F) - 3)^2 with R the rotation nearest to F (polar.h) and Lame's mu and lambda
// (Mueller, Gross 2004; with the derivative of R as in McAdams et al. 2011). Stress P = 2 mu (F - R) + p R with p =
// lambda (tr(R^T F) - 3). Viscosity is that of solid.h.
//
// Hessian: 2 mu dF + lambda (R : dF) R + (p - 2 mu) dR, where dR = m x R with m = K w, w = sum of R_j x dF_j over the
// columns and K of the directions u_i of the stretches s_i the sum of u_i u_i^T / (s_j + s_k). It is exact but where a
// part of the third term would make it negative: that part is bounded so that what is left is 0.
#pragma once

#include <avbd/rows/polar.h>
#include <avbd/rows/tet_elastic.h>

namespace avbd::rows {

/// What the products with H need of it.
template <class R>
struct CorotationalOp {
  V3<R> f0, f1, f2;
  Columns<R> turn;
  Sym3<R> twist;  ///< (p - 2 mu) K, bounded
  R mu, lambda;
  R eta, zeta;
};

template <class R>
AVBD_INLINE Columns<R> operator-(const Columns<R>& a, const Columns<R>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R>
AVBD_INLINE Columns<R> operator*(const Columns<R>& a, const Same<R>& k) {
  return {a.x * k, a.y * k, a.z * k};
}
/// tr(A^T B)
template <class R>
AVBD_INLINE R contraction(const Columns<R>& a, const Columns<R>& b) {
  return dot(a.x, b.x) + dot(a.y, b.y) + dot(a.z, b.z);
}

/// damping: t / h.
template <class R>
AVBD_INLINE CorotationalOp<R> corotationalOp(const Columns<R>& f, const R& mu, const R& lambda, const R& damping) {
  constexpr float kLeastSum = 0.1f;  // of two stretches: where they cancel, R turns at any rate
  const Polar<R> polar = polarOf(f);
  const R k = lambda * contraction(polar.turn, f - polar.turn) - 2.0f * mu;
  const auto part = [&](const R& sum) { return max(k / max(sum, splat<R>(kLeastSum)), -mu); };
  CorotationalOp<R> o{f.x, f.y, f.z, polar.turn, diagonal(zeroV3<R>()), mu, lambda, damping * mu, damping * lambda};
  addOuter(o.twist, part(polar.mean + polar.least), polar.way.x);
  addOuter(o.twist, part(polar.most + polar.least), polar.way.y);
  addOuter(o.twist, part(polar.most + polar.mean), polar.way.z);
  return o;
}

template <class R>
AVBD_INLINE Columns<R> elasticStress(const CorotationalOp<R>& o) {
  const Columns<R> strain = Columns<R>{o.f0, o.f1, o.f2} - o.turn;
  return strain * (2.0f * o.mu) + o.turn * (o.lambda * contraction(o.turn, strain));
}

/// Change of stress with dF, without viscosity.
template <class R>
AVBD_INLINE Columns<R> elasticRate(const CorotationalOp<R>& o, const Columns<R>& d) {
  const R pressure = o.lambda * contraction(o.turn, d);
  const V3<R> m = o.twist * (cross(o.turn.x, d.x) + cross(o.turn.y, d.y) + cross(o.turn.z, d.z));
  return d * (2.0f * o.mu) + o.turn * pressure + Columns<R>{cross(m, o.turn.x), cross(m, o.turn.y), cross(m, o.turn.z)};
}

/// The Hessian's block of a point whose motion a gives dF = a g^T.
template <class R>
AVBD_INLINE Sym3<R> solidBlock(const CorotationalOp<R>& o, const V3<R>& g) {
  const R square = dot(g, g), k = 2.0f * o.mu * square, viscous = o.eta * square;
  const V3<R> u = o.turn.x * g.x + o.turn.y * g.y + o.turn.z * g.z;
  const V3<R> cx{zero<R>(), u.z, -u.y}, cy{-u.z, zero<R>(), u.x}, cz{u.y, -u.x, zero<R>()};  // u x a = sum of a_i c_i
  const V3<R> tx = o.twist * cx, ty = o.twist * cy, tz = o.twist * cz;
  Sym3<R> h{k + dot(cx, tx), k + dot(cy, ty), k + dot(cz, tz), dot(cx, ty), dot(cx, tz), dot(cy, tz)};
  addOuter(h, o.lambda, u);
  addOuter(h, o.eta + o.zeta, o.f0 * g.x + o.f1 * g.y + o.f2 * g.z);
  addOuter(h, viscous, o.f0), addOuter(h, viscous, o.f1), addOuter(h, viscous, o.f2);
  return h;
}

// ---- Tetrahedra --------------------------------------------------------------------------------------------------

template <class R>
struct TetCorotationalOp {
  CorotationalOp<R> solid;
  V3<R> gb, gc, gd;
};

/// The members of a tetrahedron by Neo-Hookean (tet_elastic.h), with Lame's lambda itself.
template <class R>
struct TetCorotational : TetElastic<R> {
  AVBD_INLINE Columns<R> deformation(const V3<R> (&d)[4]) const {
    return this->gradientOf(this->ab + (d[1] - d[0]), this->ac + (d[2] - d[0]), this->ad + (d[3] - d[0]));
  }
  AVBD_INLINE TetCorotationalOp<R> op(const Columns<R>& f) const {
    return {corotationalOp<R>(f, this->mu, this->lambda, this->damping), this->gb, this->gc, this->gd};
  }
  /// dE/dx of each block.
  AVBD_INLINE void gradient(const Columns<R>&, const TetCorotationalOp<R>& op, V3<R> (&out)[4]) const {
    const Columns<R> start = this->gradientOf(this->ab, this->ac, this->ad);
    TetElastic<R>::spread(op, elasticStress(op.solid) + viscousStress(op.solid, start), out);
  }
};

// ---- Stars -------------------------------------------------------------------------------------------------------

template <class R>
struct StarCorotational {
  Columns<R> start;  ///< F at the start of the step
  R mu, lambda;      ///< times the volume at rest [J]
  R damping;         ///< t / h

  AVBD_INLINE Columns<R> deformation(const Columns<R>& change) const { return start + change; }
  AVBD_INLINE CorotationalOp<R> op(const Columns<R>& f) const { return corotationalOp<R>(f, mu, lambda, damping); }
  AVBD_INLINE Columns<R> stress(const Columns<R>&, const CorotationalOp<R>& op) const {
    return elasticStress(op) + viscousStress(op, start);
  }
};

}  // namespace avbd::rows
