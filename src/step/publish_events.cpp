// Events of a step (publish_events.h).
#include "step/publish_events.h"

#include <algorithm>
#include <tuple>

#include "step/soft_events.h"
#include "step/swept_contacts.h"
#include "world/bodies.h"
#include "world/pairs.h"
#include "world/soft_contacts.h"

namespace avbd {

namespace {

void noteHit(const WorldData& world, StepData& step, const PairData& pair, const PointForces& forces) {
  const BodyData &a = world.bodies[pair.bodyA], &b = world.bodies[pair.bodyB];
  HitRecord hit;
  const bool ofSoft = anyIsParticle(world, pair.bodyA, pair.bodyB);
  hit.key = ofSoft ? thingPair(world, pair.shapeA, pair.shapeB) : pair.key();
  hit.order = static_cast<uint32_t>(step.hits.size());
  hit.event = {pair.shapeId(0), pair.shapeId(1), pair.bodyId(0), pair.bodyId(1), pair.origin, pair.normal, 0, 0};
  hit.event.softA = softOfBody(world, pair.bodyA), hit.event.softB = softOfBody(world, pair.bodyB);
  for (int i = 0; i < pair.pointCount; ++i) {
    if (!(forces[static_cast<size_t>(i)] > 0)) continue;
    const ContactArms arms = armsOf(world, step, pair, i);
    const Vec3 motion =
        a.linearVelocity + cross(a.angularVelocity, arms.a) - b.linearVelocity - cross(b.angularVelocity, arms.b);
    const float speed = dot(pair.normal, motion);
    hit.event.impulse += forces[static_cast<size_t>(i)] * step.h;
    // A landing may take two steps: a point that already carries is no new hit.
    if (pair.points[i].lambda.x > 0 || speed <= hit.event.speed) continue;
    hit.event.speed = speed;
    hit.event.position = pair.origin + pair.manifold.points[i].position;
  }
  if (hit.event.impulse > 0) step.hits.push_back(hit);
}

/// For the begin of a touch, if this step makes one. Rare, so kept out of the way of what goes on.
[[gnu::noinline]] void noteTouch(StepData& step, const PairData& pair, const PointForces& forces) {
  TouchRecord touch;
  touch.key = pair.key();
  touch.order = static_cast<uint32_t>(step.touches.size());
  touch.normal = pair.normal;
  float most = 0;
  for (int i = 0; i < pair.pointCount; ++i) {
    const float force = forces[static_cast<size_t>(i)];
    touch.impulse += force * step.h;
    if (force <= most) continue;
    most = force;
    touch.position = pair.origin + pair.manifold.points[i].position;
  }
  step.touches.push_back(touch);
}

/// One record for each pair, with the place of the patch and substep that pushed most.
void mergeTouches(std::vector<TouchRecord>& touches) {
  std::sort(touches.begin(), touches.end(), [](const TouchRecord& x, const TouchRecord& y) {
    return std::tie(x.key, x.order) < std::tie(y.key, y.order);
  });
  size_t size = 0;
  for (size_t i = 0; i < touches.size(); ++size) {
    TouchRecord touch = touches[i];
    float most = touch.impulse;
    for (++i; i < touches.size() && touches[i].key == touch.key; ++i) {
      const float impulse = touch.impulse + touches[i].impulse;
      if (touches[i].impulse > most) touch = touches[i], most = touch.impulse;
      touch.impulse = impulse;
    }
    touches[size] = touch;
  }
  touches.resize(size);
}

/// What the merged records say of a pair that began to touch in this step.
const TouchRecord& touchOf(const StepData& step, uint64_t key) {
  const auto at = std::lower_bound(step.touches.begin(), step.touches.end(), key,
                                   [](const TouchRecord& touch, uint64_t k) { return touch.key < k; });
  AVBD_ASSERT(at != step.touches.end() && at->key == key);
  return *at;
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

/// A pair of the list whose touching has changed.
void addChange(WorldData& world, const StepData& step, size_t index) {
  const PairData& pair = world.pairs[index];
  Events& events = world.events;
  if (pair.isTrigger) {
    const ShapeId shape[2] = {pair.shapeId(0), pair.shapeId(1)};
    const BodyId body[2] = {pair.bodyId(0), pair.bodyId(1)};
    (pair.touching ? events.enters : events.leaves).push_back(visitOf(shape, body, pair.triggerIsA));
    return;
  }
  TouchEvent event{pair.shapeId(0), pair.shapeId(1), pair.bodyId(0), pair.bodyId(1), {}, {}, 0, {}, {}};
  if (pair.touching) {
    const TouchRecord& touch = touchOf(step, pair.key());
    event.position = touch.position, event.normal = touch.normal, event.impulse = touch.impulse;
  } else {
    const TouchPlace place = lastPlace(world, index);
    event.position = place.position, event.normal = place.normal;
  }
  (pair.touching ? events.begins : events.ends).push_back(event);
}

uint64_t keyOf(const LostTouch& lost) { return uint64_t(lost.shape[0].index - 1) << 32 | (lost.shape[1].index - 1); }

/// A pair that is gone for good: the end, and if nobody knows of it yet, the begin.
void addLost(Events& events, const StepData& step, const LostTouch& lost) {
  if (!lost.reports) return;
  if (lost.isTrigger) {
    const TriggerEvent visit = visitOf(lost.shape, lost.body, lost.triggerIsA);
    if (!lost.wasTouching) events.enters.push_back(visit);
    events.leaves.push_back(visit);
    return;
  }
  TouchEvent event{lost.shape[0], lost.shape[1], lost.body[0], lost.body[1], lost.position, lost.normal, 0, {}, {}};
  if (!lost.wasTouching) {
    const TouchRecord& touch = touchOf(step, keyOf(lost));
    event.impulse = touch.impulse;
    events.begins.push_back(event);
    events.begins.back().position = touch.position, events.begins.back().normal = touch.normal;
  }
  events.ends.push_back(event);
}

/// A pair may have left the list more than once.
void mergeLost(std::vector<LostTouch>& all) {
  const auto before = [](const LostTouch& x, const LostTouch& y) {
    return std::tie(x.shape[0], x.shape[1]) < std::tie(y.shape[0], y.shape[1]);
  };
  // Stable, without memory, and quick for what is nearly in order.
  for (auto at = all.begin(); at != all.end(); ++at)
    std::rotate(std::upper_bound(all.begin(), at, *at, before), at, at + 1);
  size_t size = 0;
  for (size_t i = 0; i < all.size(); ++size) {
    LostTouch lost = all[i];
    for (++i; i < all.size() && all[i].shape[0] == lost.shape[0] && all[i].shape[1] == lost.shape[1]; ++i) {
      const bool wasTouching = lost.wasTouching, touched = lost.touched;
      lost = all[i];
      lost.wasTouching = lost.wasTouching || wasTouching;
      lost.touched = lost.touched || touched;
    }
    all[size] = lost;
  }
  all.resize(size);
}

/// What left the list and is there again went on all the time; for the rest it is the end.
void publishLost(WorldData& world, StepData& step) {
  std::vector<LostTouch>& all = world.lostTouches;
  for (const LostTouch& lost : all)
    if (lost.unwanted) addLost(world.events, step, lost);
  std::erase_if(all, [](const LostTouch& lost) { return lost.unwanted; });
  mergeLost(all);
  for (const LostTouch& lost : all) {
    const size_t index = findPair(world, keyOf(lost));
    PairData* pair = index < world.pairs.size() ? &world.pairs[index] : nullptr;
    if (!pair || pair->shapeId(0) != lost.shape[0] || pair->shapeId(1) != lost.shape[1]) {
      addLost(world.events, step, lost);
      continue;
    }
    pair->wasTouching = pair->wasTouching || lost.wasTouching;
    pair->touching = pair->touching || lost.touched;
    step.touchChanges.push_back(pair->key());
  }
  all.clear();
}

/// Triggers that fast bodies entered and left within the step; soft bodies leave in the next one. Of a pair that leaves
/// in this step anyhow, or passes in several substeps, that is told once.
void publishCrossings(WorldData& world, StepData& step) {
  const std::vector<TriggerEvent>& leaves = world.events.leaves;
  for (const TriggerEvent& e : step.continuous.crossings) {
    const auto isSame = [&](const TriggerEvent& x) { return x.trigger == e.trigger && x.visitor == e.visitor; };
    if (std::any_of(leaves.begin(), leaves.end(), isSame)) continue;
    if (anyIsParticle(world, world.bodyIds.slot(e.visitorBody), world.bodyIds.slot(e.triggerBody)))
      noteSoftVisit(world, step, world.shapeIds.slot(e.trigger), world.shapeIds.slot(e.visitor), true);
    else
      world.events.enters.push_back(e), world.events.leaves.push_back(e);
  }
}

template <class Event, class Ids>
void sortBy(std::vector<Event>& events, Ids ids) {
  std::sort(events.begin(), events.end(), [&](const Event& x, const Event& y) { return ids(x) < ids(y); });
}

void publishMoves(WorldData& world, const StepData& step) {
  for (const uint32_t slot : world.sleep.awake) {
    const BodyData& body = world.bodies[slot];
    const PoseBefore& before = step.posesBefore[slot];
    if (body.position == before.position && body.rotation == before.rotation) continue;
    world.events.moves.push_back({world.bodyIds.id(slot), bodyPose(body), body.userData});
  }
}

}  // namespace

void beginEvents(WorldData& world, StepData& step) {
  world.means.swap(step.meansBefore);
  world.means.clear();
  step.lostBefore = world.lostTouches.size();
  step.hits.clear();
  step.softNotes.clear();
  step.touches.clear();
  step.touches.reserve(world.pairs.size());
  step.touchChanges.clear();
  step.touchChanges.reserve(2 * world.pairs.size());
  if (!world.def.moveEvents) return;
  step.posesBefore.resize(world.bodies.size());
  for (const uint32_t slot : world.sleep.awake)
    step.posesBefore[slot] = {world.bodies[slot].position, world.bodies[slot].rotation};
}

void noteContact(WorldData& world, StepData& step, uint32_t index, const PointForces& forces) {
  const PairData& pair = world.pairs[index];
  bool touches = false;
  for (int i = 0; i < pair.pointCount; ++i) touches = touches || forces[static_cast<size_t>(i)] > 0;
  PairData& head = world.pairs[index - pair.patch];
  if (touches != head.wasTouching) step.touchChanges.push_back(pair.key());
  if (!touches) return;
  head.touching = true;
  if (step.found[index].isSoft)
    noteSoftContact(world, step, pair, forces);
  else if (!head.wasTouching)
    noteTouch(step, pair, forces);
  if (pair.wantsHits) noteHit(world, step, pair, forces);
}

void publishEvents(WorldData& world, StepData& step) {
  Events& events = world.events;
  events.begins.clear(), events.ends.clear(), events.enters.clear(), events.leaves.clear();
  events.hits.clear(), events.moves.clear(), events.breaks.clear();
  mergeTouches(step.touches);
  publishLost(world, step);
  for (const uint64_t key : step.touchChanges) {
    const size_t index = findPair(world, key);
    if (index == world.pairs.size()) continue;
    PairData& pair = world.pairs[index];
    if (pair.touching == pair.wasTouching) continue;
    if (pair.reports) addChange(world, step, index);
    pair.wasTouching = pair.touching;
    pair.touchBegins = pair.touching;
  }
  publishCrossings(world, step);
  publishSoftEvents(world, step);
  const auto shapes = [](const TouchEvent& e) { return std::tie(e.shapeA, e.shapeB); };
  const auto trigger = [](const TriggerEvent& e) { return std::tie(e.trigger, e.visitor); };
  sortBy(events.begins, shapes), sortBy(events.ends, shapes);
  sortBy(events.enters, trigger), sortBy(events.leaves, trigger);
  publishHits(world, step);
  sortBy(events.hits, [](const HitEvent& e) { return std::tie(e.shapeA, e.shapeB); });
  if (world.def.moveEvents) publishMoves(world, step);
}

void forgetTouches(WorldData& world, const StepData& step) {
  for (PairData& pair : world.pairs) pair.touching = pair.wasTouching, pair.touchBegins = false;
  size_t i = 0;
  std::erase_if(world.lostTouches, [&](LostTouch& lost) {
    lost.touched = false;
    return i++ >= step.lostBefore && !lost.wasTouching;
  });
}

}  // namespace avbd
