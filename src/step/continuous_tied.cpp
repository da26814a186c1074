// Bodies that joints tie to others: what they would pass gets its rows, and the step is solved again.
//
// Such a body cannot stop behind the solve: that would take from its joints what the solver moved to keep them. So its
// way is looked at before anything is published, and where it meets something in a way that counts (continuous.h), the
// pair gets the contact of the pose where they meet. Nothing is foreseen, so nothing is met that is not there: the ways
// are those of a solved step. A body that is held goes another way, and so do those that it is tied to, so each body
// gets its first impact alone, and what is met on the new ways in the next round.
#include <algorithm>

#include "base/jobs.h"
#include "step/contacts.h"
#include "step/step_data.h"
#include "step/swept_contacts.h"
#include "world/joints.h"
#include "world/pairs.h"
#include "world/sleep.h"

namespace avbd {

namespace {

constexpr int kMostRounds = 4;  ///< solves more of a step

class TiedSearch {
 public:
  TiedSearch(const WorldData& world, StepData& step) : world_(world), step_(step), t_(step.tied) {}

  /// Fills step.tied.meetings with what happens first, each body at most once.
  void run() {
    t_.keys.clear();
    for (const uint32_t body : t_.bodies) meetInTree(body);
    meetEachOther();
    std::sort(t_.keys.begin(), t_.keys.end());
    t_.keys.erase(std::unique(t_.keys.begin(), t_.keys.end()), t_.keys.end());
    askAll();
    takeFirst();
  }

 private:
  bool isHeld(uint32_t body) const {
    return isDynamic(world_, body) && world_.bodies[body].continuous && isTied(world_, body);
  }

  void meet(uint32_t shapeA, uint32_t shapeB) {
    const ShapeData &a = world_.shapes[shapeA], &b = world_.shapes[shapeB];
    if (a.body == b.body || a.isTrigger || b.isTrigger || !mayTouch(world_, shapeA, shapeB)) return;
    if (!isHeld(a.body) && !isHeld(b.body)) return;
    t_.keys.push_back(slotPair(shapeA, shapeB));
  }

  void meetInTree(uint32_t body) {
    const BodyMotion motion = motionOf(world_, step_, body);
    for (uint32_t s = world_.bodies[body].firstShape; s != kNone; s = world_.shapes[s].next)
      world_.tree.query(boundsOnWay(motion, world_.shapes[s], world_.bodies[body].radius),
                        [&](uint32_t other) { meet(s, other); });
  }

  /// They may have left their boxes in the tree.
  void meetEachOther() {
    t_.boxes.clear();
    for (const uint32_t body : t_.bodies) t_.boxes.push_back(boundsOnWay(world_, motionOf(world_, step_, body), body));
    forEachOverlap(
        static_cast<uint32_t>(t_.boxes.size()), t_.byX, [&](uint32_t i) -> const Aabb& { return t_.boxes[i]; },
        [&](uint32_t i, uint32_t k) {
          forEachShapePair(world_, t_.bodies[i], t_.bodies[k], [&](uint32_t s, uint32_t t) { meet(s, t); });
        });
  }

  TiedImpact ask(uint64_t key) const {
    const auto low = static_cast<uint32_t>(key >> 32), high = static_cast<uint32_t>(key);
    TiedImpact meeting;
    meeting.key = key;
    meeting.motion[0] = motionOf(world_, step_, world_.shapes[low].body);
    meeting.motion[1] = motionOf(world_, step_, world_.shapes[high].body);
    const std::array<uint32_t, 2> shapes = inOrder(world_, low, high);
    const bool swapped = shapes[0] != low;
    const Impact impact =
        impactOf(world_, step_, shapes, {&meeting.motion[swapped ? 1 : 0], &meeting.motion[swapped ? 0 : 1]}, 0, true);
    meeting.time = impact.happens ? impact.time : 2;
    return meeting;
  }

  void askAll() {
    const auto count = static_cast<uint32_t>(t_.keys.size());
    t_.meetings.resize(count);
    step_.jobs->forRange(count, 8, [&](uint32_t begin, uint32_t end, int) {
      for (uint32_t i = begin; i < end; ++i) t_.meetings[i] = ask(t_.keys[i]);
    });
    std::erase_if(t_.meetings, [&](const TiedImpact& m) {
      return m.time > 1 || std::binary_search(t_.refused.begin(), t_.refused.end(), m.key);
    });
  }

  void takeFirst() {
    std::sort(t_.meetings.begin(), t_.meetings.end(), [](const TiedImpact& x, const TiedImpact& y) {
      return x.time < y.time || (x.time == y.time && x.key < y.key);
    });
    t_.taken.clear();
    std::erase_if(t_.meetings, [&](const TiedImpact& m) {
      const uint32_t ends[2] = {world_.shapes[m.key >> 32].body, world_.shapes[m.key & 0xffffffffu].body};
      bool free = true;
      for (const uint32_t body : ends)
        free = free && std::find(t_.taken.begin(), t_.taken.end(), body) == t_.taken.end();
      for (const uint32_t body : ends)
        if (free && isHeld(body)) t_.taken.push_back(body);
      return !free;
    });
  }

  const WorldData& world_;
  StepData& step_;
  TiedData& t_;
};

}  // namespace

bool isTied(const WorldData& world, uint32_t body) {
  return anyJoint(world, body, [&](uint32_t slot) {
    if (!acts(world, slot)) return false;
    bool tied = false;
    forEachBody(world, slot, [&](uint32_t other) { tied = tied || (other != body && isDynamic(world, other)); });
    return tied;
  });
}

void findTiedImpacts(WorldData& world, StepData& step) {
  step.tied.meetings.clear();
  if (!world.def.continuous) return;
  listFast(world, step);
  if (!world.def.continuousJointed || !step.tied.any || step.round == kMostRounds) return;
  TiedSearch(world, step).run();
}

void sweepContacts(WorldData& world, StepData& step) {
  step.tied.changed.clear();
  for (const ContactChange& change : step.changes)
    step.tied.changed.push_back({world.pairs.key(change.pair), world.pairs[change.pair].patch});
  for (const TiedImpact& meeting : step.tied.meetings) {
    if (!sweepContact(world, step, meeting)) step.tied.refused.push_back(meeting.key);
    ++world.report.impacts;
  }
  renewContacts(world, step);
  std::sort(step.tied.refused.begin(), step.tied.refused.end());
}

}  // namespace avbd
