// Momentum of islands that touch nothing fixed.
#include "step/keep_momentum.h"

#include "step/begin_rows.h"

namespace avbd {

namespace {

struct Rigid {
  Vec3d center;                 ///< of mass, at the start of the step
  rows::V3<float> shift, turn;  ///< rigid motion that the island has too much
};

Vec3d centerOf(const WorldData& world, const StepData& step, const BatchRange& batch, const IslandRange& island) {
  Vec3d sum;
  double mass = 0;
  const Vec3d origin = world.bodies[step.order[batch.orderBegin + island.begin]].position;
  for (uint32_t i = island.begin; i < island.end; ++i) {
    const BodyData& body = world.bodies[step.order[batch.orderBegin + i]];
    sum = sum + (body.position - origin) * double(body.mass);
    mass += body.mass;
  }
  return origin + sum * (1 / mass);
}

rows::Sym3<float> pointInertia(float mass, const rows::V3<float>& r) {
  rows::Sym3<float> inertia = rows::diagonal(rows::V3<float>{1, 1, 1}) * (mass * dot(r, r));
  rows::addOuter(inertia, -mass, r);
  return inertia;
}

Rigid excess(const WorldData& world, const StepData& step, const BatchRange& batch, const IslandRange& island) {
  Rigid rigid;
  rigid.center = centerOf(world, step, batch, island);
  const rows::V3<float> none{0, 0, 0};
  rows::V3<float> linear = none, angular = none;
  rows::Sym3<float> inertia = rows::diagonal(none);
  float mass = 0;
  for (uint32_t i = island.begin; i < island.end; ++i) {
    const BodyData& body = world.bodies[step.order[batch.orderBegin + i]];
    const size_t at = size_t(8) * (batch.rowBegin + i);
    const float *d = step.d.data() + at, *y = step.target.data() + at, *m = step.mass.data() + at;
    const rows::V3<float> lin = rows::V3<float>{d[0] - y[0], d[1] - y[1], d[2] - y[2]} * m[0];
    const rows::Sym3<float> own{m[1], m[2], m[3], m[4], m[5], m[6]};
    const rows::V3<float> r = toRow(body.position - rigid.center);
    linear += lin;
    angular += own * rows::V3<float>{d[4] - y[4], d[5] - y[5], d[6] - y[6]} + cross(r, lin);
    inertia = inertia + own + pointInertia(m[0], r);
    mass += m[0];
  }
  rigid.shift = linear * (1 / mass);
  rigid.turn = rows::solve3(inertia, angular);
  return rigid;
}

}  // namespace

void keepMomentum(const WorldData& world, StepData& step, const BatchRange& batch) {
  for (uint32_t n = 0; n < batch.islandCount; ++n) {
    const IslandRange& island = step.ranges[batch.islandBegin + n];
    if (!island.floating || island.end - island.begin < 2) continue;
    const Rigid rigid = excess(world, step, batch, island);
    for (uint32_t i = island.begin; i < island.end; ++i) {
      const BodyData& body = world.bodies[step.order[batch.orderBegin + i]];
      float* d = step.d.data() + size_t(8) * (batch.rowBegin + i);
      const rows::V3<float> shift = rigid.shift + cross(rigid.turn, toRow(body.position - rigid.center));
      d[0] -= shift.x, d[1] -= shift.y, d[2] -= shift.z;
      d[4] -= rigid.turn.x, d[5] -= rigid.turn.y, d[6] -= rigid.turn.z;
    }
  }
}

}  // namespace avbd
