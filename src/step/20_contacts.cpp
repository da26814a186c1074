// Contacts: manifolds of all pairs, with what their points remember from the last step.
#include <algorithm>

#include "collide/collide.h"
#include "step/contacts.h"
#include "step/sleeping.h"
#include "step/soft_events.h"
#include "step/soft_touches.h"
#include "world/pairs.h"

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

/// Of convex pairs. Between substeps forces are summed up in a list of the world's; before, a manifold touches nothing
/// but its pair.
void findManifolds(WorldData& world, StepData& step) {
  const auto find = [&](uint32_t begin, uint32_t end, int) {
    for (uint32_t i = begin; i < end; ++i) {
      world.pairs.prefetch(i + PairList::kAhead);
      if (!world.pairs.isConvex(i)) continue;
      PairData& pair = world.pairs[i];
      if (step.substep == 0) pair.touching = pair.touchBegins = false;
      findManifold(world, step, pair);
      step.found[i] = foundContact(world, pair);
    }
  };
  const auto count = static_cast<uint32_t>(world.pairs.size());
  step.found.resize(count);
  if (step.substep == 0)
    step.jobs->forRange(count, 64, find);
  else
    find(0, count, 0);
}

void count(StepReport& report, int points) {
  report.contacts += points > 0;
  report.points += static_cast<uint32_t>(points);
}

/// Of the pair whose run begins at i, a trigger's or a surface's.
void findOther(WorldData& world, StepData& step, size_t i) {
  PairData& pair = world.pairs[i];
  if (step.substep == 0) pair.touching = pair.touchBegins = false;
  if (pair.isTrigger) {
    pair.touching = pair.touching || overlaps(world, step, pair);
    if (pair.touching != pair.wasTouching) step.touchChanges.push_back(pair.key());
    step.found[i] = foundContact(world, pair);
    if (pair.touching && step.found[i].isSoft) noteSoftVisit(world, step, pair.shapeA, pair.shapeB, pair.triggerIsA);
    return;
  }
  const size_t end = world.pairs.endOfRun(i);
  findPatches(world, step, i, end);
  bool anyPoints = false;
  for (size_t k = i; k < end; ++k) {
    step.found[k] = foundContact(world, world.pairs[k]);
    anyPoints = anyPoints || step.found[k].points > 0;
  }
  if (pair.wasTouching && !anyPoints) step.touchChanges.push_back(pair.key());
}

/// What is left of the pairs begin .. end - 1 once the convex ones have their manifolds.
void findRest(WorldData& world, StepData& step, size_t begin, size_t end) {
  for (size_t i = begin; i < end;) {
    const size_t next = world.pairs.isConvex(i) ? i + 1 : world.pairs.endOfRun(i);
    if (world.pairs.isConvex(i)) {
      // Not where it was found: other threads ask for records by this.
      world.pairs.setTouches(i, step.found[i].points > 0);
      if (step.found[i].ends) step.touchChanges.push_back(world.pairs.key(i));
    } else {
      findOther(world, step, i);
    }
    for (; i < next; ++i) count(world.report, step.found[i].points);
  }
}

/// Fills step.found anew, where the list of pairs has changed.
void noteAll(const WorldData& world, StepData& step) {
  step.found.resize(world.pairs.size());
  for (size_t i = 0; i < step.found.size(); ++i) step.found[i] = foundContact(world, world.pairs[i]);
}

/// Patches for which there was no place in their runs.
void addOverflow(WorldData& world, StepData& step) {
  if (step.overflow.empty()) return;
  for (const PairData& pair : step.overflow) count(world.report, pair.pointCount);
  lengthenRuns(world, step);
  step.overflow.clear();
  noteAll(world, step);
}

/// Contacts of pairs that have just woken.
void findWoken(WorldData& world, StepData& step) {
  for (const uint32_t i : step.wokenPairs) {
    if (world.pairs.isConvex(i)) {
      findManifold(world, step, world.pairs[i]);
      step.found[i] = foundContact(world, world.pairs[i]);
    }
    findRest(world, step, i, i + 1);
  }
}

void wakeMet(WorldData& world, StepData& step) {
  if (!wakeTouched(world, step)) return;
  noteAll(world, step);
  findWoken(world, step);
  addOverflow(world, step);
}

/// What a touch wakes touches more.
void meetSoft(WorldData& world, StepData& step) {
  size_t woken;
  do {
    woken = step.wokenIslands.size();
    findSoftTouches(world, step);
    wakeMet(world, step);
  } while (step.wokenIslands.size() > woken && world.softIds.count() > 0);
}

}  // namespace

void renewContacts(WorldData& world, StepData& step) {
  noteAll(world, step);
  wakeMet(world, step);
  for (size_t i = 0; i < step.changes.size(); ++i) {
    const TiedData::Place& at = step.tied.changed[i];
    step.changes[i].pair = static_cast<uint32_t>(findPair(world, at.key) + at.patch);
  }
  if (world.contactHook) askHookAgain(world, step);
  world.report.contacts = world.report.points = 0;
  for (const FoundContact& found : step.found) count(world.report, found.points);
}

void findContacts(WorldData& world, StepData& step) {
  step.overflow.clear();
  step.changes.clear();
  world.report.contacts = world.report.points = 0;
  findManifolds(world, step);
  findRest(world, step, 0, world.pairs.size());
  addOverflow(world, step);
  meetSoft(world, step);
  if (world.contactHook) askHook(world, step);
}

}  // namespace avbd
