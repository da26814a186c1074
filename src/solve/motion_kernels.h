// The kernels of single bodies' motion (free_body.h), for kernels.h. Tile t stands for the batch's rows 16 t to 16 t
// + 15.

#include "solve/free_body.h"

namespace avbd::AVBD_LANES_NAMESPACE {
namespace {

AVBD_INLINE void storeMass(float* row, const R& linear, const Sym3<R>& angular) {
  const R c[8] = {linear, angular.xx, angular.yy, angular.zz, angular.xy, angular.xz, angular.yz, zero<R>()};
  lane::storeRows<N>(row, 8, c);
}

void freeMotions(const BatchView& v, float h, Slice rows) {
  for (uint32_t i = rows.begin; i < rows.end; i += N) {
    const int o = static_cast<int>(i % kTile);
    const FreeMotion<R> free = freeMotion(v.body[i / kTile].load<N>(o), h);
    v.free[i / kTile].store<N>(o, free);
    lane::storeTwists<N>(v.target + 8 * i, Twist<R>{free.displacement, free.turn});
  }
}

void massRows(const BatchView& v, float h, Slice rows) {
  for (uint32_t i = rows.begin; i < rows.end; i += N) {
    const FreeBody<R> body = v.body[i / kTile].load<N>(static_cast<int>(i % kTile));
    // Damping makes a body sluggish for this step: what it damps of a force, the force must bring up, and a body at
    // rest rests on its whole weight.
    const auto here = body.mass > 0.0f;
    const R linear = select(here, 1.0f / select(here, body.keepLinear * (h * h), splat<R>(1)), zero<R>());
    const R angular = select(here, 1.0f / select(here, body.keepAngular * (h * h), splat<R>(1)), zero<R>());
    const M33<R> turn = toMatrix(v.free[i / kTile].load<N>(static_cast<int>(i % kTile)).middle);
    storeMass(v.mass + 8 * i, body.mass * linear, rotated(body.inertia, turn) * angular);
    storeMass(v.invMass + 8 * i, body.invMass, rotated(body.invInertia, turn));
  }
}

void endMotions(const BatchView& v, float h, Slice rows) {
  for (uint32_t i = rows.begin; i < rows.end; i += N) {
    const int o = static_cast<int>(i % kTile);
    const uint32_t t = i / kTile;
    v.end[t].store<N>(o, endMotion(v.body[t].load<N>(o), v.free[t].load<N>(o), lane::loadTwists<N>(v.d + 8 * i), h));
  }
}

}  // namespace
}  // namespace avbd::AVBD_LANES_NAMESPACE
