// Triggers: overlap alone.
#include "collide/collide.h"
#include "collide/collide_surface.h"
#include "step/contacts.h"

namespace avbd {

namespace {

bool anyDeep(const Manifold& manifold) {
  for (int i = 0; i < manifold.count; ++i)
    if (manifold.points[i].separation <= 0) return true;
  return false;
}

}  // namespace

bool overlaps(const WorldData& world, StepData& step, const PairData& pair) {
  const ShapeData &shapeA = world.shapes[pair.shapeA], &shapeB = world.shapes[pair.shapeB];
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const NearPose poseA = nearPose(a, shapeA, a.position), poseB = nearPose(b, shapeB, a.position);
  if (!pair.hasSurface) {
    Manifold manifold;
    collide(shapeA.geom, poseA, shapeB.geom, poseB, 0, manifold);
    return anyDeep(manifold);
  }
  if (isSurface(shapeB.geom.type))
    collideSurface(shapeA.geom, poseA, shapeB.geom, poseB, 0, step.patches);
  else
    collideSurface(shapeB.geom, poseB, shapeA.geom, poseA, 0, step.patches);
  for (const SurfacePatch& patch : step.patches)
    if (anyDeep(patch.manifold)) return true;
  return false;
}

}  // namespace avbd
