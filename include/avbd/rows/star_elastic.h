// Elasticity of the star of a point of a solid, which are the tetrahedra about it: an energy with its Hessian (solid.h)
// over the point and its neighbours.
//
// F is the mean of the star's tetrahedra by their volumes, F = sum of x_j b_j^T with b_j = sum V_t g_tj / sum V_t, and
// the volume a quarter of theirs (node-based strain smoothing; Dohrmann et al. 2000, with a share of the element's
// energy against the modes that means do not see: Puso, Solberg 2006). Bending does not stretch a star as it does a
// tetrahedron, and one volume a point leaves an incompressible solid free to move where one a tetrahedron locks it.
#pragma once

#include <avbd/rows/solid.h>

namespace avbd::rows {

template <class R>
struct StarElastic {
  Columns<R> start;  ///< F at the start of the step
  R mu, lambda;      ///< times the volume at rest [J]
  R share;           ///< of the pressure before; 0: it is not augmented
  R damping;         ///< t / h
  R pressure;        ///< of the iteration before, times the volume [J]

  AVBD_INLINE Deformation<R> deformation(const Columns<R>& change) const { return deformationOf(start + change); }
  AVBD_INLINE R pressureAt(const Deformation<R>& s) const { return lambda * (s.J - 1.0f) + share * pressure; }
  AVBD_INLINE SolidOp<R> op(const Deformation<R>& s) const { return solidOp<R>(s, mu, lambda, pressureAt(s), damping); }
  AVBD_INLINE Columns<R> stress(const Deformation<R>& s, const SolidOp<R>& op) const {
    return elasticStress<R>(s, mu, pressureAt(s)) + viscousStress(op, start);
  }
};

}  // namespace avbd::rows
