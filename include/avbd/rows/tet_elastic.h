// Elasticity of a tetrahedron over four blocks: an energy with its Hessian, where rows of 1/2 k C^2 do not fit.
//
// Stable Neo-Hookean (Smith, de Goes, Kim 2018, without the logarithm; as two terms in Macklin, Mueller 2021):
// E = V (mu/2 (|F|^2 - 3) + lambda/2 (J - 1 - mu/lambda)^2), with F = dx/dX of the linear element and J = det F. With
// mu = mu_L and lambda = lambda_L + mu_L of linear elasticity its second order about rest is that of Hooke. Stress
// P = mu (F - cof F) + lambda (J - 1) cof F.
//
// Hessian: mu dF + lambda (cof F : dF) cof F + kappa d(cof F), kappa = lambda (J - 1) - mu. Where the last term would
// make it indefinite kappa is bounded by mu / s, with s a bound of the largest stretch, and by half of that in a
// flattened or inverted element: a majoriser there, exact about rest and in every stretched bar.
#pragma once

#include <avbd/rows/math.h>

namespace avbd::rows {

/// Columns of F, of its cofactors, and J.
template <class R>
struct Deformation {
  V3<R> f0, f1, f2, c0, c1, c2;
  R J;
};

/// What the products with H need of an element.
template <class R>
struct ElasticOp {
  V3<R> f0, f1, f2;
  V3<R> gb, gc, gd;
  R mu, lambda, kappa;
};

template <class R>
struct TetElastic {
  static constexpr int kBlocks = 4;
  V3<R> ab, ac, ad;  ///< edges at the start of the step [m]
  V3<R> gb, gc, gd;  ///< gradients of the corners' weights at rest [1/m]; those of all four sum to zero
  R mu, lambda;      ///< times the volume at rest [J]

  AVBD_INLINE Deformation<R> deformation(const V3<R> (&d)[4]) const {
    const V3<R> b = ab + (d[1] - d[0]), c = ac + (d[2] - d[0]), e = ad + (d[3] - d[0]);
    Deformation<R> s;
    s.f0 = b * gb.x + c * gc.x + e * gd.x;
    s.f1 = b * gb.y + c * gc.y + e * gd.y;
    s.f2 = b * gb.z + c * gc.z + e * gd.z;
    s.c0 = cross(s.f1, s.f2), s.c1 = cross(s.f2, s.f0), s.c2 = cross(s.f0, s.f1);
    s.J = dot(s.f0, s.c0);
    return s;
  }

  /// dE/dx of each block.
  AVBD_INLINE void gradient(const Deformation<R>& s, V3<R> (&out)[4]) const {
    const R pressure = lambda * (s.J - 1.0f);
    const V3<R> p0 = (s.f0 - s.c0) * mu + s.c0 * pressure;
    const V3<R> p1 = (s.f1 - s.c1) * mu + s.c1 * pressure;
    const V3<R> p2 = (s.f2 - s.c2) * mu + s.c2 * pressure;
    out[1] = p0 * gb.x + p1 * gb.y + p2 * gb.z;
    out[2] = p0 * gc.x + p1 * gc.y + p2 * gc.z;
    out[3] = p0 * gd.x + p1 * gd.y + p2 * gd.z;
    out[0] = -(out[1] + out[2] + out[3]);
  }

  AVBD_INLINE ElasticOp<R> op(const Deformation<R>& s) const {
    const R xx = dot(s.f0, s.f0), yy = dot(s.f1, s.f1), zz = dot(s.f2, s.f2);
    const R xy = dot(s.f0, s.f1), xz = dot(s.f0, s.f2), yz = dot(s.f1, s.f2);
    const R mean = (xx + yy + zz) * (1.0f / 3), a = xx - mean, b = yy - mean, c = zz - mean;
    const R off = xy * xy + xz * xz + yz * yz;
    // A symmetric matrix of trace 0 has no eigenvalue beyond sqrt(2/3) of its norm.
    const R stretch = sqrt(mean + sqrt((a * a + b * b + c * c + 2.0f * off) * (2.0f / 3)));
    const R bound = mu / max(stretch, splat<R>(1e-6f)) * (0.5f + 0.5f * clamp(s.J, 0.0f, 1.0f));
    return {s.f0, s.f1, s.f2, gb, gc, gd, mu, lambda, clamp(lambda * (s.J - 1.0f) - mu, -bound, bound)};
  }

  /// The Hessian's block of one corner, of weight gradient g. The curvature of J has none: J is linear in each corner.
  AVBD_INLINE Sym3<R> block(const Deformation<R>& s, const V3<R>& g) const {
    const R k = mu * dot(g, g);
    Sym3<R> h = diagonal(V3<R>{k, k, k});
    addOuter(h, lambda, s.c0 * g.x + s.c1 * g.y + s.c2 * g.z);
    return h;
  }
};

/// H p of the four blocks.
template <class R>
AVBD_INLINE void multiply(const ElasticOp<R>& o, const V3<R> (&p)[4], V3<R> (&out)[4]) {
  const V3<R> b = p[1] - p[0], c = p[2] - p[0], e = p[3] - p[0];
  const V3<R> d0 = b * o.gb.x + c * o.gc.x + e * o.gd.x;
  const V3<R> d1 = b * o.gb.y + c * o.gc.y + e * o.gd.y;
  const V3<R> d2 = b * o.gb.z + c * o.gc.z + e * o.gd.z;
  const V3<R> c0 = cross(o.f1, o.f2), c1 = cross(o.f2, o.f0), c2 = cross(o.f0, o.f1);
  const R volume = o.lambda * (dot(c0, d0) + dot(c1, d1) + dot(c2, d2));
  const V3<R> p0 = d0 * o.mu + c0 * volume + (cross(d1, o.f2) + cross(o.f1, d2)) * o.kappa;
  const V3<R> p1 = d1 * o.mu + c1 * volume + (cross(d2, o.f0) + cross(o.f2, d0)) * o.kappa;
  const V3<R> p2 = d2 * o.mu + c2 * volume + (cross(d0, o.f1) + cross(o.f0, d1)) * o.kappa;
  out[1] = p0 * o.gb.x + p1 * o.gb.y + p2 * o.gb.z;
  out[2] = p0 * o.gc.x + p1 * o.gc.y + p2 * o.gc.z;
  out[3] = p0 * o.gd.x + p1 * o.gd.y + p2 * o.gd.z;
  out[0] = -(out[1] + out[2] + out[3]);
}

}  // namespace avbd::rows
