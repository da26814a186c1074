// Elasticity of a triangle of cloth in its plane, over three blocks: an energy with its Hessian.
//
// The stable Neo-Hookean energy of tet_elastic.h in two dimensions: E = A h (mu/2 (|F|^2 - 2) + lambda/2 (J - 1 -
// mu/lambda)^2) with F the two columns of the linear element's dx/dX, J = |f0 x f1| its area against rest, mu that of
// linear elasticity and lambda = lambda_plane + mu with lambda_plane = E nu / (1 - nu^2), which is plane stress.
//
// Hessian: mu dF + lambda (C : dF) C + kappa dC with C = dJ/dF = (f1 x n, n x f0) and kappa = lambda (J - 1) - mu.
// Out of the plane it is mu + kappa times at most s^2 / J with s the larger stretch: kappa is bounded by -mu J / s^2,
// which is exact at rest and in every strip that nothing holds sideways, and drops what a compressed sheet would buckle
// by.
#pragma once

#include <avbd/rows/math.h>

namespace avbd::rows {

template <class R>
struct Stretch {
  V3<R> f0, f1, c0, c1, n;
  R J, inverseJ;  ///< 0 where J is
};

/// What the products with H need of an element.
template <class R>
struct TriangleOp {
  V3<R> f0, f1, n;
  R inverseJ;
  R bx, by, cx, cy;
  R mu, lambda, kappa;
};

template <class R>
struct TriangleElastic {
  static constexpr int kBlocks = 3;
  V3<R> ab, ac;      ///< edges at the start of the step [m]
  R bx, by, cx, cy;  ///< gradients of the weights of corners b and c, in the plane at rest [1/m]
  R mu, lambda;      ///< times area and thickness at rest [J]

  AVBD_INLINE Stretch<R> stretch(const V3<R> (&d)[4]) const {
    const V3<R> b = ab + (d[1] - d[0]), c = ac + (d[2] - d[0]);
    Stretch<R> s;
    s.f0 = b * bx + c * cx;
    s.f1 = b * by + c * cy;
    const V3<R> m = cross(s.f0, s.f1);
    s.J = length(m);
    const auto there = s.J > 1e-6f;
    s.inverseJ = select(there, 1.0f / select(there, s.J, splat<R>(1)), zero<R>());
    s.n = m * s.inverseJ;
    s.c0 = cross(s.f1, s.n), s.c1 = cross(s.n, s.f0);
    return s;
  }

  /// dE/dx of each block; of the fourth, which stands for none, 0.
  AVBD_INLINE void gradient(const Stretch<R>& s, V3<R> (&out)[4]) const {
    const R pressure = lambda * (s.J - 1.0f);
    const V3<R> p0 = (s.f0 - s.c0) * mu + s.c0 * pressure;
    const V3<R> p1 = (s.f1 - s.c1) * mu + s.c1 * pressure;
    out[1] = p0 * bx + p1 * by;
    out[2] = p0 * cx + p1 * cy;
    out[0] = -(out[1] + out[2]);
    out[3] = zeroV3<R>();
  }

  AVBD_INLINE TriangleOp<R> op(const Stretch<R>& s) const {
    const R xx = dot(s.f0, s.f0), yy = dot(s.f1, s.f1), xy = dot(s.f0, s.f1);
    const R half = (xx - yy) * 0.5f, square = (xx + yy) * 0.5f + sqrt(half * half + xy * xy);
    const R least = -(mu * s.J) / max(square, splat<R>(1e-6f));
    const R kappa = clamp(lambda * (s.J - 1.0f) - mu, least, mu);
    return {s.f0, s.f1, s.n, s.inverseJ, bx, by, cx, cy, mu, lambda, kappa};
  }

  /// The Hessian's block of a corner with weight gradient (x, y), without what the curvature of J takes from it.
  AVBD_INLINE Sym3<R> block(const Stretch<R>& s, const R& x, const R& y) const {
    const R k = mu * (x * x + y * y);
    Sym3<R> h = diagonal(V3<R>{k, k, k});
    addOuter(h, lambda, s.c0 * x + s.c1 * y);
    return h;
  }
};

/// H p of the blocks.
template <class R>
AVBD_INLINE void multiply(const TriangleOp<R>& o, const V3<R> (&p)[4], V3<R> (&out)[4]) {
  const V3<R> b = p[1] - p[0], c = p[2] - p[0];
  const V3<R> d0 = b * o.bx + c * o.cx, d1 = b * o.by + c * o.cy;
  const V3<R> c0 = cross(o.f1, o.n), c1 = cross(o.n, o.f0);
  const V3<R> dm = cross(d0, o.f1) + cross(o.f0, d1);
  const R dJ = dot(o.n, dm), volume = o.lambda * dJ;
  const V3<R> dn = (dm - o.n * dJ) * o.inverseJ;
  const V3<R> p0 = d0 * o.mu + c0 * volume + (cross(d1, o.n) + cross(o.f1, dn)) * o.kappa;
  const V3<R> p1 = d1 * o.mu + c1 * volume + (cross(dn, o.f0) + cross(o.n, d0)) * o.kappa;
  out[1] = p0 * o.bx + p1 * o.by;
  out[2] = p0 * o.cx + p1 * o.cy;
  out[0] = -(out[1] + out[2]);
  out[3] = zeroV3<R>();
}

}  // namespace avbd::rows
