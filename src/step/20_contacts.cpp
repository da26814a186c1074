// Contacts: manifolds of all pairs, with what their points remember from the last step.
#include <algorithm>

#include "collide/collide.h"
#include "step/contacts.h"
#include "step/sleeping.h"

namespace avbd {

NearPose nearPose(const BodyData& body, const ShapeData& shape, Vec3d origin) {
  return {toFloat(body.position - origin) + rotate(body.rotation, shape.toMass.p), body.rotation * shape.toMass.q};
}

float smallerSize(const BodyData& a, const BodyData& b) {
  return std::min(a.minExtent > 0 ? a.minExtent : b.minExtent, b.minExtent > 0 ? b.minExtent : a.minExtent);
}

float speculativeMargin(const WorldData& world, const BodyData& a, const BodyData& b, float h) {
  const float speed = length(a.linearVelocity - b.linearVelocity) + length(a.angularVelocity) * a.radius +
                      length(b.angularVelocity) * b.radius;
  return kSpeculative * world.def.lengthUnit + std::min(speed * h, smallerSize(a, b));
}

namespace {

/// Manifold of two convex shapes, or of one and a half space.
void findManifold(WorldData& world, const StepData& step, PairData& pair) {
  const ShapeData &shapeA = world.shapes[pair.shapeA], &shapeB = world.shapes[pair.shapeB];
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const float margin = speculativeMargin(world, a, b, step.h);
  if (pair.kept.what != KeptManifold::What::Nothing && carryContact(world, step, pair, margin)) return;
  // Where nothing is found the last manifold's place has to stay: between substeps all of it, as it may have pushed.
  const Vec3 lastNormal = pair.manifold.normal, lastPoint = pair.manifold.points[0].position;
  Manifold last;
  if (step.substep > 0) last = pair.manifold;
  collide(shapeA.geom, nearPose(a, shapeA, a.position), shapeB.geom, nearPose(b, shapeB, a.position), margin,
          pair.manifold);
  keepContact(world, pair, margin, pair.manifold);
  if (pair.manifold.count == 0) {
    if (step.substep > 0) pair.manifold = last;
    pair.manifold.normal = lastNormal, pair.manifold.points[0].position = lastPoint;
    forgetContact(world, step, pair);
    return;
  }
  pair.origin = a.position;
  combineMaterials(pair, shapeA.material, shapeB.material);
  const bool begins = pair.pointCount == 0;
  rememberPoints(world, step, pair);
  if (begins) beginSlide(world, step, pair, {});
}

size_t endOfRun(const WorldData& world, size_t begin) {
  size_t end = begin + 1;
  while (end < world.pairs.size() && world.pairs[end].key() == world.pairs[begin].key()) ++end;
  return end;
}

bool anyPoints(const PairData& head, size_t entries) {
  for (size_t i = 0; i < entries; ++i)
    if ((&head)[i].pointCount > 0) return true;
  return false;
}

void count(StepReport& report, const PairData* pairs, size_t size) {
  for (size_t i = 0; i < size; ++i) {
    report.contacts += pairs[i].pointCount > 0;
    report.points += static_cast<uint32_t>(pairs[i].pointCount);
  }
}

bool isConvexPair(const PairData& pair) { return !pair.isTrigger && !pair.hasSurface; }

/// Manifolds that touch nothing but their pair. Between substeps forces are summed up in a list of the world's.
void findManifolds(WorldData& world, StepData& step) {
  if (step.substep > 0) return;
  step.jobs->forRange(static_cast<uint32_t>(world.pairs.size()), 64, [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i)
      if (isConvexPair(world.pairs[i])) findManifold(world, step, world.pairs[i]);
  });
}

/// Of the pair whose run begins at i; returns its end. `isAlone`: no other has looked for its manifold in this substep.
size_t findContactsOf(WorldData& world, StepData& step, size_t i, bool isAlone) {
  PairData& pair = world.pairs[i];
  size_t end = i + 1;
  if (step.substep == 0) pair.touching = pair.touchBegins = false;
  if (pair.isTrigger)
    pair.touching = pair.touching || overlaps(world, step, pair);
  else if (pair.hasSurface)
    findPatches(world, step, i, end = endOfRun(world, i));
  else if (step.substep > 0 || isAlone)
    findManifold(world, step, pair);
  if (pair.isTrigger ? pair.touching != pair.wasTouching : pair.wasTouching && !anyPoints(pair, end - i))
    step.touchChanges.push_back(pair.key());
  count(world.report, &pair, end - i);
  return end;
}

}  // namespace

void findContacts(WorldData& world, StepData& step) {
  step.overflow.clear();
  step.changes.clear();
  world.report.contacts = world.report.points = 0;
  findManifolds(world, step);
  for (size_t i = 0; i < world.pairs.size();) i = findContactsOf(world, step, i, false);
  count(world.report, step.overflow.data(), step.overflow.size());
  if (!step.overflow.empty()) lengthenRuns(world, step);
  if (wakeTouched(world, step)) {
    step.overflow.clear();
    for (const uint32_t pair : step.wokenPairs) findContactsOf(world, step, pair, true);
    count(world.report, step.overflow.data(), step.overflow.size());
    if (!step.overflow.empty()) lengthenRuns(world, step);
  }
  if (world.contactHook) askHook(world, step);
}

}  // namespace avbd
