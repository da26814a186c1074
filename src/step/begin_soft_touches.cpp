// Rows of touches of soft bodies: constants of the step and remembered multipliers.
#include "step/begin_rows.h"
#include "step/contacts.h"
#include "step/settings.h"
#include "step/soft_touches.h"
#include "world/soft_touch.h"

namespace avbd {

namespace {

constexpr float kMost = 2;  ///< as of contacts of bodies: bound of the load's stiffness [island masses / h^2]

rows::NodeContact<float> touchRows(const WorldData& world, const StepData& step, const FoundTouch& found, float mass,
                                   float leak) {
  const SoftTouch& touch = found.touch;
  const std::array<uint32_t, 4> nodes = nodesOf(world, touch);
  const std::array<float, 4> stuck = nodeWeights(touch.kind, touch.anchor);
  const bool ofShape = touch.kind == TouchKind::ShapeFace;
  const TouchBasis basis = basisOf(touch.normal);
  rows::NodeContact<float> c{};
  c.n = toRow(touch.normal), c.t1 = toRow(basis.t1), c.t2 = toRow(basis.t2);
  c.arm = toRow(found.arm);
  Vec3 slip;
  const BodyData& first = world.bodies[nodes[0]];
  for (size_t i = 0; i < 4; ++i) {
    c.weight[i] = found.weights[i];
    slip = slip + toFloat(world.bodies[nodes[i]].position - first.position) * stuck[i];
  }
  if (ofShape) slip = slip - rotate(first.rotation, touch.place);
  c.biasN = normalBias(world, step, found.separation);
  c.bias1 = (1 - step.alpha) * dot(slip, basis.t1);
  c.bias2 = (1 - step.alpha) * dot(slip, basis.t2);
  c.floorN = c.floorT = 1;  // prepareOthers puts the stiffness
  c.loadStiffness = 1 / step.loadDepth;
  c.stiffest = kMost * mass / (step.h * step.h);
  const auto [a, b] = shapesOf(world, touch);
  const CombinedMaterial material = combined(world.shapes[a].material, world.shapes[b].material);
  c.mu = touch.slides > 1 ? material.friction : material.staticFriction;
  c.lambdaN = leak * touch.lambda.x, c.lambda1 = leak * touch.lambda.y, c.lambda2 = leak * touch.lambda.z;
  return c;
}

}  // namespace

void fillSoftTouches(const WorldData& world, StepData& step) {
  for (const BatchRange& batch : step.batches) {
    const float leak = withIterations(step.solve, batch.iterations).contactLeak;
    for (size_t lane = size_t(batch.touchTile) * kTile; lane < size_t(batch.touchTile + batch.touchTiles) * kTile;
         ++lane) {
      rows::NodeContact<float> rows{};
      const uint32_t index = step.touchLane[lane];
      if (index != kNone) {
        const FoundTouch& found = step.softTouches[index];
        const float mass = step.islands[step.islandOf[bodyOfSecond(world, found.touch)]].mass;
        rows = touchRows(world, step, found, mass, leak);
      }
      step.touchTiles[lane / kTile].set(static_cast<int>(lane % kTile), rows);
    }
  }
}

}  // namespace avbd
