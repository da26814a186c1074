// Events of a step (publish_events.h).
#include "step/publish_events.h"

#include <algorithm>
#include <tuple>

#include "world/bodies.h"
#include "world/pairs.h"

namespace avbd {

namespace {

void noteHit(const WorldData& world, StepData& step, const PairData& pair, const PointForces& forces) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  const Vec3 fromAToB = toFloat(b.position - a.position);
  HitRecord hit;
  hit.key = pair.key();
  hit.order = static_cast<uint32_t>(step.hits.size());
  hit.event = {pair.shapeId(0), pair.shapeId(1), pair.bodyId(0), pair.bodyId(1), pair.origin, pair.normal, 0, 0};
  for (int i = 0; i < pair.pointCount; ++i) {
    if (!(forces[static_cast<size_t>(i)] > 0)) continue;
    const Vec3 armA = pair.manifold.points[i].position;
    const Vec3 motion = a.linearVelocity + cross(a.angularVelocity, armA) - b.linearVelocity -
                        cross(b.angularVelocity, armA - fromAToB);
    const float speed = dot(pair.normal, motion);
    hit.event.impulse += forces[static_cast<size_t>(i)] * step.h;
    // A landing may take two steps: a point that already carries is no new hit.
    if (pair.points[i].lambda.x > 0 || speed <= hit.event.speed) continue;
    hit.event.speed = speed;
    hit.event.position = pair.origin + armA;
  }
  if (hit.event.impulse > 0) step.hits.push_back(hit);
}

/// One event for each pair, with the place of its fastest point.
void publishHits(WorldData& world, StepData& step) {
  std::vector<HitEvent>& hits = world.events.hits;
  std::sort(step.hits.begin(), step.hits.end(),
            [](const HitRecord& x, const HitRecord& y) { return std::tie(x.key, x.order) < std::tie(y.key, y.order); });
  for (size_t i = 0; i < step.hits.size();) {
    HitEvent hit = step.hits[i].event;
    const uint64_t key = step.hits[i].key;
    for (++i; i < step.hits.size() && step.hits[i].key == key; ++i) {
      const HitEvent& more = step.hits[i].event;
      const float impulse = hit.impulse + more.impulse;
      if (more.speed > hit.speed) hit = more;
      hit.impulse = impulse;
    }
    if (hit.speed >= world.def.hitSpeed) hits.push_back(hit);
  }
}

void addTouch(Events& events, const ShapeId (&shape)[2], const BodyId (&body)[2], bool begins) {
  (begins ? events.begins : events.ends).push_back({shape[0], shape[1], body[0], body[1]});
}

void addVisit(Events& events, const ShapeId (&shape)[2], const BodyId (&body)[2], bool triggerIsA, bool enters) {
  const int trigger = triggerIsA ? 0 : 1, visitor = 1 - trigger;
  (enters ? events.enters : events.leaves).push_back({shape[trigger], shape[visitor], body[trigger], body[visitor]});
}

void addChange(Events& events, const PairData& pair) {
  const ShapeId shape[2] = {pair.shapeId(0), pair.shapeId(1)};
  const BodyId body[2] = {pair.bodyId(0), pair.bodyId(1)};
  if (pair.isTrigger)
    addVisit(events, shape, body, pair.triggerIsA, pair.touching);
  else
    addTouch(events, shape, body, pair.touching);
}

/// What left the list and is there again went on all the time; for the rest it is the end.
void publishLost(WorldData& world, StepData& step) {
  for (const LostTouch& lost : world.lostTouches) {
    const uint64_t key = uint64_t(lost.shape[0].index - 1) << 32 | (lost.shape[1].index - 1);
    PairData* pair = findPair(world, key);
    if (pair && pair->shapeId(0) == lost.shape[0] && pair->shapeId(1) == lost.shape[1])
      pair->wasTouching = true, step.touchChanges.push_back(key);
    else if (lost.isTrigger)
      addVisit(world.events, lost.shape, lost.body, lost.triggerIsA, false);
    else if (lost.reports)
      addTouch(world.events, lost.shape, lost.body, false);
  }
  world.lostTouches.clear();
}

template <class Event, class Ids>
void sortBy(std::vector<Event>& events, Ids ids) {
  std::sort(events.begin(), events.end(), [&](const Event& x, const Event& y) { return ids(x) < ids(y); });
}

void publishMoves(WorldData& world, const StepData& step) {
  world.bodyIds.forEach([&](uint32_t slot) {
    const BodyData& body = world.bodies[slot];
    const PoseBefore& before = step.posesBefore[slot];
    if (body.position == before.position && body.rotation == before.rotation) return;
    world.events.moves.push_back({world.bodyIds.id(slot), bodyPose(body), body.userData});
  });
}

}  // namespace

void beginEvents(const WorldData& world, StepData& step) {
  step.hits.clear();
  step.touchChanges.clear();
  step.touchChanges.reserve(2 * world.pairs.size());
  if (!world.def.moveEvents) return;
  step.posesBefore.resize(world.bodies.size());
  for (size_t i = 0; i < world.bodies.size(); ++i)
    step.posesBefore[i] = {world.bodies[i].position, world.bodies[i].rotation};
}

void noteContact(WorldData& world, StepData& step, uint32_t index, const PointForces& forces) {
  const PairData& pair = world.pairs[index];
  bool touches = false;
  for (int i = 0; i < pair.pointCount; ++i) touches = touches || forces[static_cast<size_t>(i)] > 0;
  PairData& head = world.pairs[index - pair.patch];
  if (touches != head.wasTouching) step.touchChanges.push_back(pair.key());
  if (!touches) return;
  head.touching = true;
  if (pair.wantsHits) noteHit(world, step, pair, forces);
}

void publishEvents(WorldData& world, StepData& step) {
  Events& events = world.events;
  events.begins.clear(), events.ends.clear(), events.enters.clear(), events.leaves.clear();
  events.hits.clear(), events.moves.clear();
  publishLost(world, step);
  for (const uint64_t key : step.touchChanges) {
    PairData* pair = findPair(world, key);
    if (!pair || pair->touching == pair->wasTouching) continue;
    if (pair->reports) addChange(events, *pair);
    pair->wasTouching = pair->touching;
  }
  const auto shapes = [](const TouchEvent& e) { return std::tie(e.shapeA, e.shapeB); };
  const auto trigger = [](const TriggerEvent& e) { return std::tie(e.trigger, e.visitor); };
  sortBy(events.begins, shapes), sortBy(events.ends, shapes);
  sortBy(events.enters, trigger), sortBy(events.leaves, trigger);
  publishHits(world, step);
  if (world.def.moveEvents) publishMoves(world, step);
}

}  // namespace avbd
