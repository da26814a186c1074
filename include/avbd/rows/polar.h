// Polar decomposition: of a 3 x 3 matrix F the rotation R nearest to it, which is the one with the greatest tr(R^T F).
//
// One-sided Jacobi turns the columns of F V until they stand across each other (Hestenes 1958), a fixed number of
// sweeps; R = U V^T with U their directions, the least one turned so that U is a rotation too. So R is one of a
// flattened, inverted or collapsed F as well, where the least stretch is 0 or negative (Irving, Teran, Fedkiw 2004).
// It jumps where the two least stretches add up to 0: there no continuous choice exists.
#pragma once

#include <avbd/rows/solid.h>

namespace avbd::rows {

template <class R>
struct Polar {
  Columns<R> turn;      ///< R
  Columns<R> way;       ///< U: directions of the stretches, after the turn
  R most, mean, least;  ///< stretches: most >= mean >= |least|
};

/// Turns columns a and b of F V, and of V, until those of F V stand across each other.
template <class R>
AVBD_INLINE void makeOrthogonal(V3<R>& a, V3<R>& b, V3<R>& va, V3<R>& vb) {
  const R apart = lengthSq(b) - lengthSq(a), twice = 2.0f * dot(a, b);
  const R below = abs(apart) + sqrt(apart * apart + twice * twice);
  const auto done = below == 0.0f;
  const R tangent = select(done, 0.0f, copySign(1.0f, apart) * twice / select(done, 1.0f, below));
  const R c = 1.0f / sqrt(1.0f + tangent * tangent), s = c * tangent;
  const V3<R> a0 = a, va0 = va;
  a = a0 * c - b * s, b = a0 * s + b * c;
  va = va0 * c - vb * s, vb = va0 * s + vb * c;
}

/// The longer first; V stays a rotation.
template <class R>
AVBD_INLINE void longerFirst(V3<R>& a, V3<R>& b, V3<R>& va, V3<R>& vb) {
  const auto swaps = lengthSq(b) > lengthSq(a);
  const V3<R> a0 = a, va0 = va;
  a = select(swaps, b, a), b = select(swaps, -a0, b);
  va = select(swaps, vb, va), vb = select(swaps, -va0, vb);
}

template <class R>
AVBD_INLINE Polar<R> polarOf(const Columns<R>& f) {
  constexpr int kSweeps = 4;            // to the last bits, from any F
  constexpr float kCollapsed = 1e-12f;  // of a square: what is left has no direction of its own
  const R o = zero<R>(), one = splat<R>(1);
  V3<R> a = f.x, b = f.y, c = f.z, va{one, o, o}, vb{o, one, o}, vc{o, o, one};
  for (int i = 0; i < kSweeps; ++i)
    makeOrthogonal(a, b, va, vb), makeOrthogonal(a, c, va, vc), makeOrthogonal(b, c, vb, vc);
  longerFirst(a, b, va, vb), longerFirst(b, c, vb, vc), longerFirst(a, b, va, vb);
  const R size = lengthSq(a);
  const V3<R> u = normalised(select(size > 0.0f, a, V3<R>{one, o, o}));
  V3<R> across, other;
  orthonormalBasis(u, across, other);
  const V3<R> rest = b - u * dot(u, b);
  const V3<R> v = normalised(select(lengthSq(rest) > size * kCollapsed, rest, across));
  const V3<R> w = cross(u, v);
  const auto column = [&](const R& x, const R& y, const R& z) { return u * x + v * y + w * z; };
  const V3<R> x = column(va.x, vb.x, vc.x), y = column(va.y, vb.y, vc.y), z = column(va.z, vb.z, vc.z);
  // What the sweeps lost of length and right angles, to the second order: near rest stress is a small difference.
  const R xx = 1.5f - 0.5f * dot(x, x), yy = 1.5f - 0.5f * dot(y, y), zz = 1.5f - 0.5f * dot(z, z);
  const R xy = -0.5f * dot(x, y), xz = -0.5f * dot(x, z), yz = -0.5f * dot(y, z);
  return {{x * xx + y * xy + z * xz, x * xy + y * yy + z * yz, x * xz + y * yz + z * zz},
          {u, v, w},
          dot(u, a),
          dot(v, b),
          dot(w, c)};
}

}  // namespace avbd::rows
