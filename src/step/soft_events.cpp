// Events of soft bodies (soft_events.h).
//
// What touches now and did not in the last step begins, and what did and does not now ends: sets, not counts, as points
// come and go while their bodies touch all the time.
#include "step/soft_events.h"

#include <algorithm>
#include <tuple>

#include "step/soft_touches.h"
#include "world/soft.h"
#include "world/soft_contacts.h"
#include "world/soft_touch.h"

namespace avbd {

namespace {

/// Points of one body come one after another, so most only add to the last note.
SoftNote& noteOf(const WorldData& world, StepData& step, uint32_t shapeA, uint32_t shapeB) {
  std::vector<SoftNote>& notes = step.softNotes;
  if (notes.empty() || notes.back().pair.key != thingPair(world, shapeA, shapeB)) {
    SoftNote note;
    note.pair = softPair(world, shapeA, shapeB);
    note.order = static_cast<uint32_t>(notes.size());
    notes.push_back(note);
  }
  return notes.back();
}

/// Where two things pushed, and how hard.
struct Push {
  uint32_t shapeA, shapeB;  ///< slots, A < B
  Vec3d position;
  Vec3 normal;  ///< from A to B
  float force;
};

SoftNote& addPush(const WorldData& world, StepData& step, const Push& push) {
  SoftNote& note = noteOf(world, step, push.shapeA, push.shapeB);
  note.impulse += push.force * step.h;
  if (push.force <= note.most) return note;
  const bool reports = note.pair.reports;
  note.pair = softPair(world, push.shapeA, push.shapeB);
  note.pair.reports = reports;
  note.pair.position = push.position, note.pair.normal = push.normal;
  note.most = push.force;
  return note;
}

bool wantsEvents(const WorldData& world, uint32_t a, uint32_t b) {
  return world.shapes[a].contactEvents && world.shapes[b].contactEvents;
}

/// [m/s] at which the two sides of a touch come nearer, when the substep began.
float approachOf(const WorldData& world, const FoundTouch& found) {
  const std::array<uint32_t, 4> nodes = nodesOf(world, found.touch);
  Vec3 motion;
  for (size_t i = 0; i < 4; ++i) motion = motion + world.bodies[nodes[i]].linearVelocity * found.weights[i];
  if (found.touch.kind == TouchKind::ShapeFace)
    motion = motion - cross(world.bodies[nodes[0]].angularVelocity, found.arm);
  return dot(motion, found.touch.normal);
}

void noteHit(const WorldData& world, StepData& step, const FoundTouch& found, const Push& push) {
  const SoftPair pair = softPair(world, push.shapeA, push.shapeB);
  HitRecord hit;
  hit.key = pair.key;
  hit.order = static_cast<uint32_t>(step.hits.size());
  hit.event = {pair.shape[0], pair.shape[1], pair.body[0], pair.body[1], push.position, push.normal, 0, 0,
               pair.soft[0],  pair.soft[1]};
  hit.event.impulse = push.force * step.h;
  // What carried before is no new hit.
  if (!(found.touch.lambda.x > 0)) hit.event.speed = std::max(0.0f, approachOf(world, found));
  step.hits.push_back(hit);
}

/// One note for each pair, with the place that pushed most.
void mergeNotes(std::vector<SoftNote>& notes) {
  std::sort(notes.begin(), notes.end(), [](const SoftNote& x, const SoftNote& y) {
    return std::tie(x.pair.key, x.order) < std::tie(y.pair.key, y.order);
  });
  size_t size = 0;
  for (size_t i = 0; i < notes.size(); ++size) {
    SoftNote note = notes[i];
    for (++i; i < notes.size() && notes[i].pair.key == note.pair.key; ++i) {
      const SoftNote& more = notes[i];
      const float impulse = note.impulse + more.impulse;
      const bool reports = note.pair.reports || more.pair.reports;
      if (more.most > note.most) note = more;
      note.impulse = impulse, note.pair.reports = reports;
    }
    notes[size] = note;
  }
  notes.resize(size);
}

/// Whether two pairs of one key are of the same things: slots are taken again.
bool isSame(const SoftPair& x, const SoftPair& y) {
  const auto is = [&](int i, int k) { return x.soft[i] == y.soft[k] && (x.soft[i] || x.shape[i] == y.shape[k]); };
  return (is(0, 0) && is(1, 1)) || (is(0, 1) && is(1, 0));
}

/// Both sleep, or stand still: nothing has looked for their touches, and they go on.
bool rests(const WorldData& world, const SoftPair& pair) {
  for (int i = 0; i < 2; ++i) {
    if (pair.soft[i]) {
      if (!world.softIds.isAlive(pair.soft[i])) return false;
      if (!isAsleep(world, world.softs[world.softIds.slot(pair.soft[i])])) return false;
    } else if (!world.shapeIds.isAlive(pair.shape[i]) ||
               !world.bodies[world.shapes[world.shapeIds.slot(pair.shape[i])].body].asleep) {
      return false;
    }
  }
  return true;
}

void tell(Events& events, const SoftPair& pair, bool begins, float impulse) {
  if (!pair.reports) return;
  if (pair.isTrigger) {
    const int trigger = pair.triggerIsA ? 0 : 1, visitor = 1 - trigger;
    (begins ? events.enters : events.leaves)
        .push_back(
            {pair.shape[trigger], pair.shape[visitor], pair.body[trigger], pair.body[visitor], pair.soft[visitor]});
    return;
  }
  (begins ? events.begins : events.ends)
      .push_back({pair.shape[0], pair.shape[1], pair.body[0], pair.body[1], pair.position, pair.normal, impulse,
                  pair.soft[0], pair.soft[1]});
}

}  // namespace

void noteSoftContact(const WorldData& world, StepData& step, const PairData& pair, const PointForces& forces) {
  for (int i = 0; i < pair.pointCount; ++i) {
    const float force = forces[static_cast<size_t>(i)];
    if (!(force > 0)) continue;
    SoftNote& note = addPush(
        world, step, {pair.shapeA, pair.shapeB, pair.origin + pair.manifold.points[i].position, pair.normal, force});
    note.pair.reports = note.pair.reports || wantsEvents(world, pair.shapeA, pair.shapeB);
  }
}

void noteSoftVisit(const WorldData& world, StepData& step, uint32_t shapeA, uint32_t shapeB, bool triggerIsA) {
  SoftPair& pair = noteOf(world, step, shapeA, shapeB).pair;
  if (pair.isTrigger) return;
  pair.isTrigger = pair.reports = true;
  pair.triggerIsA = triggerIsA;
}

void noteSoftTouches(const WorldData& world, StepData& step) {
  for (size_t i = 0; i < step.softTouches.size(); ++i) {
    const SoftContact& contact = step.newSoftContacts[i];
    const FoundTouch& found = step.softTouches[i];
    const float force = world.softTouches[i].lambda.x;
    if (!found.awake || !(force > 0)) continue;
    const bool turned = contact.shape[0] > contact.shape[1];
    const uint32_t a = contact.shape[turned ? 1 : 0], b = contact.shape[turned ? 0 : 1];
    const Push push{a, b, contact.position, turned ? contact.normal : -contact.normal, force};
    SoftNote& note = addPush(world, step, push);
    note.pair.reports = note.pair.reports || wantsEvents(world, a, b);
    if (world.shapes[a].hitEvents || world.shapes[b].hitEvents) noteHit(world, step, found, push);
  }
}

void publishSoftEvents(WorldData& world, StepData& step) {
  std::vector<SoftPair>& now = step.softPairs;
  now.clear();
  if (world.softPairs.empty() && step.softNotes.empty()) return;
  mergeNotes(step.softNotes);
  auto old = world.softPairs.begin();
  const auto end = world.softPairs.end();
  const auto leave = [&](uint64_t key) {
    for (; old != end && old->key < key; ++old) {
      if (rests(world, *old)) {
        now.push_back(*old);
        now.back().begins = false;
      } else {
        tell(world.events, *old, false, 0);
      }
    }
  };
  for (SoftNote& note : step.softNotes) {
    SoftPair& pair = note.pair;
    leave(pair.key);
    const bool met = old != end && old->key == pair.key, goesOn = met && isSame(*old, pair);
    if (met && !(goesOn && pair.reports)) tell(world.events, *old, false, 0);
    pair.begins = !goesOn || (pair.reports && !old->reports);
    if (pair.begins) tell(world.events, pair, true, note.impulse);
    now.push_back(pair);
    if (met) ++old;
  }
  leave(~uint64_t{0});
  world.softPairs.swap(now);
}

}  // namespace avbd
