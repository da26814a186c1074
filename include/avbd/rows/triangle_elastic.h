// Elasticity of a triangle of cloth in its plane, over three blocks: an energy with its Hessian, and a limit of strain.
//
// F is the two columns of the linear element's dx/dX, C = F^T F, E = (C - I)/2 Green's strain.
// Sheet: the stable Neo-Hookean energy of solid.h in two dimensions, A h (mu/2 (|F|^2 - 2) + lambda/2 (J - 1 -
// mu/lambda)^2) with J = |f0 x f1| its area against rest, mu that of linear elasticity and lambda = lambda_plane + mu,
// lambda_plane = E nu / (1 - nu^2), which is plane stress.
// Threads, where f0 is along the warp and f1 along the weft: warp/2 (|f0| - 1)^2 + weft/2 (|f1| - 1)^2 + shear/2 (f0 .
// f1)^2, what woven cloth has beyond a sheet that is the same all ways.
// Viscosity: as of solid.h, S = t/h times what C - C0 makes of Green's strain by all of the above.
// Limit: no direction has E > most. T (warp, weft, shear) is its multiplier, a tension which is a positive
// semi-definite matrix: T <- the nearest such to T + rho (E - most I), stress F T. Its J and bounds are no rows, but
// the law is that of one: rho is the larger of a floor by the corners' masses and of T by a strain.
//
// Hessian: mu dF + lambda (C : dF) C + kappa dC with C = dJ/dF = (f1 x n, n x f0) and kappa = lambda (J - 1) - mu.
// Out of the plane it is mu + kappa times at most s^2 / J with s the larger stretch: kappa is bounded by -mu J / s^2,
// which is exact at rest and in every strip that nothing holds sideways, and drops what a compressed sheet would buckle
// by. Of threads, viscosity and limit F dS, and dF S where S pulls; all rho where the limit pulls at all.
#pragma once

#include <avbd/rows/math.h>

namespace avbd::rows {

template <class R>
struct Stretch {
  V3<R> f0, f1, c0, c1, n;
  R J, inverseJ;  ///< 0 where J is
};

/// A symmetric 2 x 2 matrix: along warp, weft, between.
template <class R>
struct Plane {
  R xx, yy, xy;
};

template <class R>
AVBD_INLINE Plane<R> squares(const V3<R>& f0, const V3<R>& f1) {
  return {dot(f0, f0), dot(f1, f1), dot(f0, f1)};
}

/// The nearest of no negative eigenvalue.
template <class R>
AVBD_INLINE Plane<R> pulling(const Plane<R>& m) {
  const R mean = (m.xx + m.yy) * 0.5f, half = (m.xx - m.yy) * 0.5f, radius = sqrt(half * half + m.xy * m.xy);
  const R more = max(mean + radius, zero<R>()), less = max(mean - radius, zero<R>());
  const auto turns = radius > 0.0f;
  const R middle = (more + less) * 0.5f;
  const R scale = select(turns, (more - less) * 0.5f / select(turns, radius, splat<R>(1)), zero<R>());
  return {middle + half * scale, middle - half * scale, m.xy * scale};
}

/// What threads, viscosity and limit add to the products: dS = (xx dCxx + cross dCyy, yy dCyy + cross dCxx, xy dCxy),
/// and S itself, where it pulls.
template <class R>
struct ThreadOp {
  R xx, yy, xy, cross;
  Plane<R> pull;
};

/// What the products with H need of an element.
template <class R>
struct TriangleOp {
  V3<R> f0, f1, n;
  R inverseJ;
  R bx, by, cx, cy;
  R mu, lambda, kappa;
  ThreadOp<R> threads;
};

template <class R>
struct TriangleElastic {
  static constexpr int kBlocks = 3;
  V3<R> ab, ac;         ///< edges at the start of the step [m]
  R bx, by, cx, cy;     ///< gradients of the weights of corners b and c, in the plane at rest [1/m]
  R mu, lambda;         ///< times area and thickness at rest [J]
  R warp, weft, shear;  ///< likewise; 0 where cloth is the same all ways
  R damping;            ///< t / h
  R most;               ///< limit of Green's strain
  R floor;              ///< [J] least stiffness of the limit; 0: there is none
  R load;               ///< by which strain the limit holds its load: its inverse
  Plane<R> tension;     ///< T [J]

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

  /// rho of the limit.
  AVBD_INLINE R limitStiffness() const {
    return select(floor > 0.0f, max(floor, load * (tension.xx + tension.yy)), zero<R>());
  }
  /// T of the limit at a stretch, by the one before.
  AVBD_INLINE Plane<R> limitTension(const Stretch<R>& s) const {
    const R rho = limitStiffness(), half = rho * 0.5f, least = half + rho * most;
    const Plane<R> c = squares(s.f0, s.f1);
    const Plane<R> t =
        pulling<R>({tension.xx + half * c.xx - least, tension.yy + half * c.yy - least, tension.xy + half * c.xy});
    const auto limited = rho > 0.0f;
    return {select(limited, t.xx, zero<R>()), select(limited, t.yy, zero<R>()), select(limited, t.xy, zero<R>())};
  }

  AVBD_INLINE TriangleOp<R> op(const Stretch<R>& s) const {
    const Plane<R> c = squares(s.f0, s.f1);
    const R half = (c.xx - c.yy) * 0.5f, square = (c.xx + c.yy) * 0.5f + sqrt(half * half + c.xy * c.xy);
    const R least = -(mu * s.J) / max(square, splat<R>(1e-6f));
    const R kappa = clamp(lambda * (s.J - 1.0f) - mu, least, mu);
    return {s.f0, s.f1, s.n, s.inverseJ, bx, by, cx, cy, mu, lambda, kappa, threadOp(c, limitTension(s))};
  }

  /// dE/dx of each block; of the fourth, which stands for none, 0.
  AVBD_INLINE void gradient(const Stretch<R>& s, V3<R> (&out)[4]) const {
    const R pressure = lambda * (s.J - 1.0f);
    const Plane<R> t = threadStress(s);
    const V3<R> p0 = (s.f0 - s.c0) * mu + s.c0 * pressure + (s.f0 * t.xx + s.f1 * t.xy);
    const V3<R> p1 = (s.f1 - s.c1) * mu + s.c1 * pressure + (s.f0 * t.xy + s.f1 * t.yy);
    out[1] = p0 * bx + p1 * by;
    out[2] = p0 * cx + p1 * cy;
    out[0] = -(out[1] + out[2]);
    out[3] = zeroV3<R>();
  }

 private:
  /// Of a thread of square length c: its force by its length.
  AVBD_INLINE static R threadForce(const R& k, const R& c) { return k - k / sqrt(max(c, splat<R>(1e-6f))); }

  /// S of threads, viscosity and limit.
  AVBD_INLINE Plane<R> threadStress(const Stretch<R>& s) const {
    const Plane<R> c = squares(s.f0, s.f1), limit = limitTension(s);
    const Plane<R> start = squares(ab * bx + ac * cx, ab * by + ac * cy);
    const R dxx = c.xx - start.xx, dyy = c.yy - start.yy, dxy = c.xy - start.xy;
    const R trace = damping * (lambda - mu) * 0.5f * (dxx + dyy);
    return {limit.xx + threadForce(warp, c.xx) + damping * (mu + warp * 0.5f) * dxx + trace,
            limit.yy + threadForce(weft, c.yy) + damping * (mu + weft * 0.5f) * dyy + trace,
            limit.xy + shear * c.xy + damping * (mu + shear) * dxy};
  }

  AVBD_INLINE ThreadOp<R> threadOp(const Plane<R>& c, const Plane<R>& limit) const {
    const R pullX = max(threadForce(warp, c.xx), zero<R>()), pullY = max(threadForce(weft, c.yy), zero<R>());
    const R limiting = select(limit.xx + limit.yy > 0.0f, limitStiffness() * 0.5f, zero<R>());
    const R trace = damping * (lambda - mu) * 0.5f, tiny = splat<R>(1e-6f);
    return {(warp - pullX) * 0.5f / max(c.xx, tiny) + damping * (mu + warp * 0.5f) + trace + limiting,
            (weft - pullY) * 0.5f / max(c.yy, tiny) + damping * (mu + weft * 0.5f) + trace + limiting,
            shear + damping * (mu + shear) + limiting,
            trace,
            {limit.xx + pullX, limit.yy + pullY, limit.xy}};
  }
};

/// The Hessian's block of a corner with weight gradient (x, y), without what the curvature of J takes from it.
template <class R>
AVBD_INLINE Sym3<R> triangleBlock(const TriangleOp<R>& o, const R& x, const R& y) {
  const ThreadOp<R>& t = o.threads;
  const R xx = x * x, xy = x * y, yy = y * y;
  const R k = o.mu * (xx + yy) + (xx * t.pull.xx + 2.0f * xy * t.pull.xy + yy * t.pull.yy);
  Sym3<R> h = diagonal(V3<R>{k, k, k});
  addOuter(h, o.lambda, cross(o.f1, o.n) * x + cross(o.n, o.f0) * y);
  const R both = 2.0f * t.cross * xy + t.xy * xy;
  addOuter(h, 2.0f * t.xx * xx + t.xy * yy - both, o.f0);
  addOuter(h, 2.0f * t.yy * yy + t.xy * xx - both, o.f1);
  addOuter(h, both, o.f0 + o.f1);
  return h;
}

/// H p of the blocks. threads: not all lanes are without any.
template <class R>
AVBD_INLINE void multiply(const TriangleOp<R>& o, bool threads, const V3<R> (&p)[4], V3<R> (&out)[4]) {
  const V3<R> b = p[1] - p[0], c = p[2] - p[0];
  const V3<R> d0 = b * o.bx + c * o.cx, d1 = b * o.by + c * o.cy;
  const V3<R> c0 = cross(o.f1, o.n), c1 = cross(o.n, o.f0);
  const V3<R> dm = cross(d0, o.f1) + cross(o.f0, d1);
  const R dJ = dot(o.n, dm), volume = o.lambda * dJ;
  const V3<R> dn = (dm - o.n * dJ) * o.inverseJ;
  V3<R> p0 = d0 * o.mu + c0 * volume + (cross(d1, o.n) + cross(o.f1, dn)) * o.kappa;
  V3<R> p1 = d1 * o.mu + c1 * volume + (cross(dn, o.f0) + cross(o.n, d0)) * o.kappa;
  if (threads) {
    const ThreadOp<R>& t = o.threads;
    const R dxx = 2.0f * dot(o.f0, d0), dyy = 2.0f * dot(o.f1, d1), dxy = dot(o.f0, d1) + dot(d0, o.f1);
    const R sxx = t.xx * dxx + t.cross * dyy, syy = t.yy * dyy + t.cross * dxx, sxy = t.xy * dxy;
    const auto has = (t.xx > 0.0f) | (t.yy > 0.0f) | (t.xy > 0.0f);
    p0 = select(has, p0 + (o.f0 * sxx + o.f1 * sxy + d0 * t.pull.xx + d1 * t.pull.xy), p0);
    p1 = select(has, p1 + (o.f0 * sxy + o.f1 * syy + d0 * t.pull.xy + d1 * t.pull.yy), p1);
  }
  out[1] = p0 * o.bx + p1 * o.by;
  out[2] = p0 * o.cx + p1 * o.cy;
  out[0] = -(out[1] + out[2]);
  out[3] = zeroV3<R>();
}

}  // namespace avbd::rows
