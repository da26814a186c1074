// Bending of cloth across an edge of two triangles, over four blocks.
//
// Quadratic in the points (Bergou et al. 2006): E = 1/2 k |sum of weight_i x_i|^2 with weights of cotangents at rest,
// which sum to zero, and k = D / (A0 + A1) with D the stiffness of the sheet. (Theirs is three times that; for a mesh
// of equilateral triangles bent along any of its edges this one gives D. A grid of right triangles is softer; how
// much farther than a plate a strip of it bends, the test Cloth.BendsAsAPlateDoes bounds.) Right for sheets that hardly
// stretch; at rest they are flat. J and k are constant.
#pragma once

#include <avbd/rows/row.h>

namespace avbd::rows {

/// What the products with H need of it.
template <class R>
struct BendOp {
  R weight[4];
  R k;
};

template <class R>
struct ClothBend {
  static constexpr int kBlocks = 4;
  R weight[4];  ///< [1]
  V3<R> bent;   ///< the sum at the start of the step [m]
  R k;          ///< [N/m]

  AVBD_INLINE void gradient(const V3<R> (&d)[4], V3<R> (&out)[4]) const {
    const V3<R> sum = bent + d[0] * weight[0] + d[1] * weight[1] + d[2] * weight[2] + d[3] * weight[3];
    for (int i = 0; i < 4; ++i) out[i] = sum * (k * weight[i]);
  }
  AVBD_INLINE BendOp<R> op() const { return {{weight[0], weight[1], weight[2], weight[3]}, k}; }
};

/// H p of the four blocks.
template <class R>
AVBD_INLINE void multiply(const BendOp<R>& o, const V3<R> (&p)[4], V3<R> (&out)[4]) {
  const V3<R> force = (p[0] * o.weight[0] + p[1] * o.weight[1] + p[2] * o.weight[2] + p[3] * o.weight[3]) * o.k;
  for (int i = 0; i < 4; ++i) out[i] = force * o.weight[i];
}

}  // namespace avbd::rows
