// Elasticity and viscosity of a solid at one deformation F, in units of energy (times the volume at rest).
//
// Stable Neo-Hookean (Smith, de Goes, Kim 2018, without the logarithm; as two terms in Macklin, Mueller 2021):
// E = mu/2 (|F|^2 - 3) + lambda/2 (J - 1 - mu/lambda)^2 with J = det F. With mu = mu_L and lambda = lambda_L + mu_L of
// linear elasticity its second order about rest is that of Hooke. Stress P = mu (F - cof F) + p cof F with the
// pressure p = lambda (J - 1). Where lambda is beyond what a solver can take, p is augmented: lambda (J - 1) + share m
// with m the pressure of the iteration before, lambda = K rho / (K + rho) and share = K / (K + rho), K the true one.
//
// Viscosity: the second Piola-Kirchhoff stress of Hooke's law for the rate of Green's strain over the step, which no
// turn makes: S = eta (C - C0) + zeta/2 tr(C - C0), C = F^T F, C0 that at the step's start, eta = t/h mu and zeta =
// t/h lambda_L. It is the derivative of eta/4 |C - C0|^2 + zeta/8 tr^2 >= 0, which is 0 where the step starts: no step
// gains energy by it.
//
// Hessian: mu dF + lambda (cof F : dF) cof F + kappa d(cof F), kappa = p - mu, and F dS. Where the third term would
// make it indefinite kappa is bounded by mu / s, with s a bound of the largest stretch, and by half of that in a
// flattened or inverted element: a majoriser there, exact about rest and in every stretched bar. Left out: dF S.
#pragma once

#include <avbd/rows/math.h>

namespace avbd::rows {

/// Of a 3 x 3 matrix.
template <class R>
struct Columns {
  V3<R> x, y, z;
};

/// Columns of F, of its cofactors, and J.
template <class R>
struct Deformation {
  V3<R> f0, f1, f2, c0, c1, c2;
  R J;
};

template <class R>
AVBD_INLINE Deformation<R> deformationOf(const Columns<R>& f) {
  Deformation<R> s{f.x, f.y, f.z, cross(f.y, f.z), cross(f.z, f.x), cross(f.x, f.y), {}};
  s.J = dot(s.f0, s.c0);
  return s;
}

/// What the products with H need of it.
template <class R>
struct SolidOp {
  V3<R> f0, f1, f2;
  R mu, lambda, kappa;
  R eta, zeta;
};

template <class R>
AVBD_INLINE Columns<R> elasticStress(const Deformation<R>& s, const R& mu, const R& pressure) {
  return {(s.f0 - s.c0) * mu + s.c0 * pressure, (s.f1 - s.c1) * mu + s.c1 * pressure,
          (s.f2 - s.c2) * mu + s.c2 * pressure};
}

/// damping: t / h.
template <class R>
AVBD_INLINE SolidOp<R> solidOp(const Deformation<R>& s, const R& mu, const R& lambda, const R& pressure,
                               const R& damping) {
  const R xx = dot(s.f0, s.f0), yy = dot(s.f1, s.f1), zz = dot(s.f2, s.f2);
  const R xy = dot(s.f0, s.f1), xz = dot(s.f0, s.f2), yz = dot(s.f1, s.f2);
  const R mean = (xx + yy + zz) * (1.0f / 3), a = xx - mean, b = yy - mean, c = zz - mean;
  const R off = xy * xy + xz * xz + yz * yz;
  // A symmetric matrix of trace 0 has no eigenvalue beyond sqrt(2/3) of its norm.
  const R stretch = sqrt(mean + sqrt((a * a + b * b + c * c + 2.0f * off) * (2.0f / 3)));
  const R bound = mu / max(stretch, splat<R>(1e-6f)) * (0.5f + 0.5f * clamp(s.J, 0.0f, 1.0f));
  return {s.f0, s.f1, s.f2, mu, lambda, clamp(pressure - mu, -bound, bound), damping * mu, damping * (lambda - mu)};
}

/// F S for a change of C. Op: SolidOp, or what another energy has in its place, with the same viscosity.
template <class R, template <class> class Op>
AVBD_INLINE Columns<R> viscousOf(const Op<R>& o, const Sym3<R>& c) {
  const R trace = o.zeta * 0.5f * (c.xx + c.yy + c.zz);
  const R sxx = o.eta * c.xx + trace, syy = o.eta * c.yy + trace, szz = o.eta * c.zz + trace;
  const R sxy = o.eta * c.xy, sxz = o.eta * c.xz, syz = o.eta * c.yz;
  return {o.f0 * sxx + o.f1 * sxy + o.f2 * sxz, o.f0 * sxy + o.f1 * syy + o.f2 * syz,
          o.f0 * sxz + o.f1 * syz + o.f2 * szz};
}

template <class R>
AVBD_INLINE Columns<R> operator+(const Columns<R>& a, const Columns<R>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// Viscous stress of a step from F = start to that of the op.
template <class R, template <class> class Op>
AVBD_INLINE Columns<R> viscousStress(const Op<R>& o, const Columns<R>& start) {
  return viscousOf<R>(o, {dot(o.f0, o.f0) - dot(start.x, start.x), dot(o.f1, o.f1) - dot(start.y, start.y),
                          dot(o.f2, o.f2) - dot(start.z, start.z), dot(o.f0, o.f1) - dot(start.x, start.y),
                          dot(o.f0, o.f2) - dot(start.x, start.z), dot(o.f1, o.f2) - dot(start.y, start.z)});
}

/// Change of stress with dF, without viscosity.
template <class R>
AVBD_INLINE Columns<R> elasticRate(const SolidOp<R>& o, const Columns<R>& d) {
  const V3<R> c0 = cross(o.f1, o.f2), c1 = cross(o.f2, o.f0), c2 = cross(o.f0, o.f1);
  const R volume = o.lambda * (dot(c0, d.x) + dot(c1, d.y) + dot(c2, d.z));
  return {d.x * o.mu + c0 * volume + (cross(d.y, o.f2) + cross(o.f1, d.z)) * o.kappa,
          d.y * o.mu + c1 * volume + (cross(d.z, o.f0) + cross(o.f2, d.x)) * o.kappa,
          d.z * o.mu + c2 * volume + (cross(d.x, o.f1) + cross(o.f0, d.y)) * o.kappa};
}

/// Of viscosity alone.
template <class R, template <class> class Op>
AVBD_INLINE Columns<R> viscousRate(const Op<R>& o, const Columns<R>& d) {
  return viscousOf<R>(
      o, {2.0f * dot(o.f0, d.x), 2.0f * dot(o.f1, d.y), 2.0f * dot(o.f2, d.z), dot(o.f0, d.y) + dot(d.x, o.f1),
          dot(o.f0, d.z) + dot(d.x, o.f2), dot(o.f1, d.z) + dot(d.y, o.f2)});
}

/// Of both. threads: not all lanes have damping 0; each gives the bits that it gives alone.
template <class R, template <class> class Op>
AVBD_INLINE Columns<R> stressRate(const Op<R>& o, bool threads, const Columns<R>& d) {
  const Columns<R> elastic = elasticRate(o, d);
  if (!threads) return elastic;
  const Columns<R> both = elastic + viscousRate(o, d);
  const auto moves = o.eta > 0.0f;
  return {select(moves, both.x, elastic.x), select(moves, both.y, elastic.y), select(moves, both.z, elastic.z)};
}

/// The Hessian's block of a point whose motion a gives dF = a g^T. The curvature of J has none: a g^T has no cofactors.
template <class R>
AVBD_INLINE Sym3<R> solidBlock(const SolidOp<R>& o, const V3<R>& g) {
  const R square = dot(g, g), k = o.mu * square, viscous = o.eta * square;
  Sym3<R> h = diagonal(V3<R>{k, k, k});
  addOuter(h, o.lambda, cross(o.f1, o.f2) * g.x + cross(o.f2, o.f0) * g.y + cross(o.f0, o.f1) * g.z);
  addOuter(h, o.eta + o.zeta, o.f0 * g.x + o.f1 * g.y + o.f2 * g.z);
  addOuter(h, viscous, o.f0), addOuter(h, viscous, o.f1), addOuter(h, viscous, o.f2);
  return h;
}

}  // namespace avbd::rows
