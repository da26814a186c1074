// Elasticity of a tetrahedron over four blocks: an energy with its Hessian (solid.h), where rows of 1/2 k C^2 do not
// fit. F = dx/dX of the linear element.
//
// Tetrahedra alone are far too stiff in bending, since each is bent by stretching it: they carry a quarter of a solid
// or less, and the stars of its points (star_elastic.h) the rest.
#pragma once

#include <avbd/rows/solid.h>

namespace avbd::rows {

template <class R>
struct ElasticOp {
  SolidOp<R> solid;
  V3<R> gb, gc, gd;
};

template <class R>
struct TetElastic {
  static constexpr int kBlocks = 4;
  V3<R> ab, ac, ad;  ///< edges at the start of the step [m]
  V3<R> gb, gc, gd;  ///< gradients of the corners' weights at rest [1/m]; those of all four sum to zero
  R mu, lambda;      ///< times the volume at rest [J]
  R damping;         ///< t / h

  AVBD_INLINE Columns<R> gradientOf(const V3<R>& b, const V3<R>& c, const V3<R>& d) const {
    return {b * gb.x + c * gc.x + d * gd.x, b * gb.y + c * gc.y + d * gd.y, b * gb.z + c * gc.z + d * gd.z};
  }
  AVBD_INLINE Deformation<R> deformation(const V3<R> (&d)[4]) const {
    return deformationOf(gradientOf(ab + (d[1] - d[0]), ac + (d[2] - d[0]), ad + (d[3] - d[0])));
  }
  AVBD_INLINE ElasticOp<R> op(const Deformation<R>& s) const {
    return {solidOp<R>(s, mu, lambda, lambda * (s.J - 1.0f), damping), gb, gc, gd};
  }
  /// dE/dx of each block.
  AVBD_INLINE void gradient(const Deformation<R>& s, const ElasticOp<R>& op, V3<R> (&out)[4]) const {
    spread(op, elasticStress<R>(s, mu, lambda * (s.J - 1.0f)) + viscousStress(op.solid, gradientOf(ab, ac, ad)), out);
  }
  /// Of a stress the forces on the blocks.
  template <class Op>
  AVBD_INLINE static void spread(const Op& o, const Columns<R>& p, V3<R> (&out)[4]) {
    out[1] = p.x * o.gb.x + p.y * o.gb.y + p.z * o.gb.z;
    out[2] = p.x * o.gc.x + p.y * o.gc.y + p.z * o.gc.z;
    out[3] = p.x * o.gd.x + p.y * o.gd.y + p.z * o.gd.z;
    out[0] = -(out[1] + out[2] + out[3]);
  }
};

/// H p of the four blocks. threads: not all have damping 0. Op: that of an energy of tetrahedra.
template <class R, template <class> class Op>
AVBD_INLINE void multiply(const Op<R>& o, bool threads, const V3<R> (&p)[4], V3<R> (&out)[4]) {
  const V3<R> b = p[1] - p[0], c = p[2] - p[0], e = p[3] - p[0];
  const Columns<R> d{b * o.gb.x + c * o.gc.x + e * o.gd.x, b * o.gb.y + c * o.gc.y + e * o.gd.y,
                     b * o.gb.z + c * o.gc.z + e * o.gd.z};
  TetElastic<R>::spread(o, stressRate(o.solid, threads, d), out);
}

}  // namespace avbd::rows
