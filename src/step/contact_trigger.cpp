// Triggers: overlap alone.
#include "collide/collide.h"
#include "collide/collide_surface.h"
#include "collide/convex.h"
#include "geom/triangles.h"
#include "step/contacts.h"

namespace avbd {

namespace {

bool anyDeep(const Manifold& manifold) {
  for (int i = 0; i < manifold.count; ++i)
    if (manifold.points[i].separation <= 0) return true;
  return false;
}

/// A convex shape and any triangle of a mesh, from whatever side.
bool crosses(const ShapeGeom& convex, const NearPose& poseConvex, const ShapeGeom& mesh, const NearPose& poseMesh) {
  const Quat back = conjugate(poseMesh.q);
  const NearPose pose{rotate(back, poseConvex.p - poseMesh.p), back * poseConvex.q};
  bool found = false;
  forEachBareTriangle(mesh, bounds(convex, {toDouble(pose.p), pose.q}, 0), [&](const SurfaceTriangle& t) {
    const Nearest near = nearest(convex, pose, {ShapeType::Triangle, 0, {}, t.v}, {}, 0);
    found = !near.apart && near.distance <= 0;
    return !found;
  });
  return found;
}

bool overlapsSurface(StepData& step, const ShapeGeom& convex, const NearPose& poseConvex, const ShapeGeom& surface,
                     const NearPose& poseSurface) {
  if (surface.type == ShapeType::Mesh) return crosses(convex, poseConvex, surface, poseSurface);
  collideSurface(convex, poseConvex, surface, poseSurface, 0, step.patches);
  for (const SurfacePatch& patch : step.patches)
    if (anyDeep(patch.manifold)) return true;
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
  return isSurface(shapeB.geom.type) ? overlapsSurface(step, shapeA.geom, poseA, shapeB.geom, poseB)
                                     : overlapsSurface(step, shapeB.geom, poseB, shapeA.geom, poseA);
}

}  // namespace avbd
