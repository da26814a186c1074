// Continuous collision: bodies that moved far for their size stop at the first impact on their way (continuous.h).
#include <algorithm>

#include "base/jobs.h"
#include "step/begin_rows.h"
#include "step/contacts.h"
#include "step/free_motion.h"
#include "step/step_data.h"
#include "world/joints.h"
#include "world/pairs.h"

namespace avbd {

namespace {

using State = MovedBody::State;

bool isBefore(const PlannedImpact& x, const PlannedImpact& y) {
  return x.time < y.time || (x.time == y.time && (x.key < y.key || (x.key == y.key && x.asked < y.asked)));
}
/// For a heap with the first impact on top.
bool isAfter(const PlannedImpact& x, const PlannedImpact& y) { return isBefore(y, x); }

class Search {
 public:
  Search(WorldData& world, StepData& step) : world_(world), step_(step), c_(step.continuous) {}

  void run() {
    const auto fast = static_cast<uint32_t>(c_.bodies.size());
    c_.meets.clear(), c_.queue.clear(), c_.visits.clear();
    for (uint32_t i = 0; i < fast; ++i) c_.bodies[i].box = boundsOnWay(world_, c_.bodies[i].motion, c_.bodies[i].slot);
    meetEachOther(fast);
    for (uint32_t i = 0; i < fast; ++i) meetOthers(i, true);
    askAll();
    while (!c_.queue.empty()) {
      std::pop_heap(c_.queue.begin(), c_.queue.end(), isAfter);
      const PlannedImpact impact = c_.queue.back();
      c_.queue.pop_back();
      if (impact.asked == c_.meets[impact.meet].asked) happen(impact);
    }
  }

 private:
  const BodyData& bodyOf(const MovedBody& moved) const { return world_.bodies[moved.slot]; }
  bool isDynamic(const MovedBody& moved) const { return bodyOf(moved).type == BodyType::Dynamic; }

  uint32_t indexOf(uint32_t slot) {
    if (c_.indexOf[slot] != kNone) return c_.indexOf[slot];
    c_.indexOf[slot] = static_cast<uint32_t>(c_.bodies.size());
    c_.bodies.push_back({});
    c_.bodies.back().slot = slot;
    c_.bodies.back().motion = motionOf(world_, step_, slot);
    return c_.indexOf[slot];
  }

  void addMeet(uint32_t shapeA, uint32_t shapeB) {
    const std::array<uint32_t, 2> shapes = inOrder(world_, shapeA, shapeB);
    ShapesMeet meet;
    meet.shape[0] = shapes[0], meet.shape[1] = shapes[1];
    const auto index = static_cast<uint32_t>(c_.meets.size());
    for (int k = 0; k < 2; ++k) {
      meet.body[k] = indexOf(world_.shapes[meet.shape[k]].body);
      meet.next[k] = c_.bodies[meet.body[k]].firstMeet;
      c_.bodies[meet.body[k]].firstMeet = index;
    }
    c_.meets.push_back(meet);
  }

  bool isKnown(uint32_t index, uint32_t shapeA, uint32_t shapeB) const {
    for (uint32_t m = c_.bodies[index].firstMeet; m != kNone; m = nextMeet(m, index)) {
      const ShapesMeet& meet = c_.meets[m];
      if ((meet.shape[0] == shapeA && meet.shape[1] == shapeB) || (meet.shape[0] == shapeB && meet.shape[1] == shapeA))
        return true;
    }
    return false;
  }

  uint32_t nextMeet(uint32_t m, uint32_t index) const { return c_.meets[m].next[c_.meets[m].body[0] == index ? 0 : 1]; }

  bool isVisit(uint32_t a, uint32_t b) const { return world_.shapes[a].isTrigger || world_.shapes[b].isTrigger; }

  void meet(uint32_t shapeA, uint32_t shapeB, bool first) {
    if (!mayTouch(world_, shapeA, shapeB)) return;
    if (!isVisit(shapeA, shapeB)) return addMeet(shapeA, shapeB);
    if (first) c_.visits.push_back(slotPair(shapeA, shapeB));
  }

  /// Fast bodies may have left their boxes in the tree.
  void meetEachOther(uint32_t fast) {
    forEachOverlap(
        fast, c_.byX, [&](uint32_t i) -> const Aabb& { return c_.bodies[i].box; },
        [&](uint32_t i, uint32_t k) {
          forEachShapePair(world_, c_.bodies[i].slot, c_.bodies[k].slot,
                           [&](uint32_t s, uint32_t t) { meet(s, t, true); });
        });
  }

  /// Adds what a body's shapes meet in the tree.
  void meetOthers(uint32_t index, bool first) {
    const uint32_t slot = c_.bodies[index].slot;
    const BodyMotion motion = c_.bodies[index].motion;
    for (uint32_t s = world_.bodies[slot].firstShape; s != kNone; s = world_.shapes[s].next) {
      const Aabb box = boundsOnWay(motion, world_.shapes[s], world_.bodies[slot].radius);
      world_.tree.query(box, [&](uint32_t other) {
        const uint32_t known = c_.indexOf[world_.shapes[other].body];
        if (known != kNone && (known == index || (first && c_.bodies[known].isFast))) return;
        if (first || !isKnown(index, s, other)) meet(s, other, first);
      });
    }
  }

  /// What a body cannot stop that it meets.
  bool isUnstoppable(const MovedBody& moved) const {
    return moved.state == State::Carried || (moved.isFast && !isDynamic(moved));
  }
  bool isStopped(const MovedBody& moved, const MovedBody& by) const {
    return moved.state == State::Free && isDynamic(moved) && !bodyOf(moved).asleep && bodyOf(moved).continuous &&
           !isTied(world_, moved.slot) && (moved.isFast || isUnstoppable(by));
  }

  /// Whether one of the two would stop.
  bool isOpen(uint32_t m) const {
    const MovedBody &a = c_.bodies[c_.meets[m].body[0]], &b = c_.bodies[c_.meets[m].body[1]];
    return isStopped(a, b) || isStopped(b, a);
  }

  void plan(uint32_t m, const Impact& impact) {
    ShapesMeet& meet = c_.meets[m];
    ++meet.asked;
    if (!impact.happens) return;
    const uint64_t key = uint64_t(meet.shape[0]) << 32 | meet.shape[1];
    c_.queue.push_back({impact.time, key, m, meet.asked, impact.normal});
    std::push_heap(c_.queue.begin(), c_.queue.end(), isAfter);
  }

  void ask(uint32_t m, float from) { plan(m, isOpen(m) ? impactOf(world_, step_, c_.meets[m], from) : Impact{}); }

  void askAll() {
    const auto count = static_cast<uint32_t>(c_.meets.size());
    c_.answers.resize(count);
    step_.jobs->forRange(count, 8, [&](uint32_t begin, uint32_t end, int) {
      for (uint32_t m = begin; m < end; ++m)
        c_.answers[m] = isOpen(m) ? impactOf(world_, step_, c_.meets[m], 0) : Impact{};
    });
    for (uint32_t m = 0; m < count; ++m) plan(m, c_.answers[m]);
  }

  void happen(const PlannedImpact& impact) {
    const ShapesMeet& meet = c_.meets[impact.meet];
    const uint32_t a = meet.body[0], b = meet.body[1];
    const bool stopsA = isStopped(c_.bodies[a], c_.bodies[b]), stopsB = isStopped(c_.bodies[b], c_.bodies[a]);
    c_.changed.clear();
    if (stopsA && stopsB) {
      stop(a, impact.time), stop(b, impact.time);
    } else if (stopsA) {
      meetEnd(a, b, impact.time, impact.normal);
    } else if (stopsB) {
      meetEnd(b, a, impact.time, -impact.normal);
    }
    if (c_.changed.empty()) return;
    ++world_.report.impacts;
    askAgain(impact.time);
  }

  /// What becomes of a body that meets another one which goes on as before.
  void meetEnd(uint32_t index, uint32_t by, float time, Vec3 normal) {
    const MovedBody& other = c_.bodies[by];
    if (other.state == State::Stopped || bodyOf(other).type == BodyType::Static) return stop(index, time);
    if (isPulled(index)) return;
    MovedBody& moved = c_.bodies[index];
    const Vec3 turn = other.motion.turn * (1 - time);
    change(index, State::Carried, time, carried(at(moved.motion, time), other.motion, time, normal));
    moved.turned = moved.turned + turn;
  }

  void stop(uint32_t index, float time) {
    if (isPulled(index)) return;
    change(index, State::Stopped, time, resting(at(c_.bodies[index].motion, time)));
  }

  void change(uint32_t index, State state, float time, const BodyMotion& motion) {
    MovedBody& moved = c_.bodies[index];
    moved.state = state;
    moved.time = time;
    moved.turned = moved.motion.turn * time;
    moved.before = moved.motion;
    moved.motion = motion;
    c_.changed.push_back(index);
  }

  /// Whether a joint ties the body to a kinematic one that goes on too fast to leave it.
  bool isPulled(uint32_t index) const {
    return anyJoint(world_, c_.bodies[index].slot, [&](uint32_t slot) {
      const JointData& joint = world_.joints[slot];
      return joint.enabled && std::any_of(std::begin(joint.body), std::end(joint.body), [&](uint32_t body) {
               const uint32_t known = body == kNone ? kNone : c_.indexOf[body];
               return known != kNone && c_.bodies[known].isFast && !isDynamic(c_.bodies[known]);
             });
    });
  }

  /// The changed bodies go another way from now on.
  void askAgain(float time) {
    const size_t known = c_.meets.size();
    for (const uint32_t index : c_.changed)
      if (c_.bodies[index].state == State::Carried) meetOthers(index, false);
    for (size_t m = known; m < c_.meets.size(); ++m) ask(static_cast<uint32_t>(m), time);
    for (const uint32_t index : c_.changed)
      for (uint32_t m = c_.bodies[index].firstMeet; m != kNone; m = nextMeet(m, index))
        if (m < known) ask(m, time);
  }

  WorldData& world_;
  StepData& step_;
  ContinuousData& c_;
};

void addFast(const WorldData& world, StepData& step, uint32_t slot, Vec3 way, Vec3 turn) {
  const BodyData& body = world.bodies[slot];
  const float size = body.minExtent > 0 ? body.minExtent : kSpeculative * world.def.lengthUnit;
  // A ball that turns goes nowhere.
  const float far = length(way) + length(turn) * std::max(body.radius - body.minExtent, 0.0f);
  if (!body.continuous || far <= kFastWay * size || body.firstShape == kNone) return;
  const bool tied = isTied(world, slot), kinematic = body.type == BodyType::Kinematic;
  if (tied || kinematic) step.tied.bodies.push_back(slot);
  step.tied.any = step.tied.any || tied || (kinematic && !world.sleep.joints.empty());
  if (tied) return;
  ContinuousData& c = step.continuous;
  c.bodies.push_back({});
  c.bodies.back().slot = slot;
  c.bodies.back().isFast = true;
}

/// What carries a body does not move it along or about what is locked.
Pose unlockedPose(const BodyData& body, const MovedBody& moved, Pose pose) {
  pose.position = body.position + unlocked(toFloat(pose.position - body.position), body.locks);
  if (body.locks >> 3) pose.rotation = at(moved.before, moved.time).rotation;
  return pose;
}

/// The pose where the body was left, and its velocity as it turns there with the angular momentum that it has; of one
/// that joints hold, whose momentum is theirs to turn, with the velocity that they left it.
void endThere(const WorldData& world, StepData& step, const MovedBody& moved) {
  const BodyData& body = world.bodies[moved.slot];
  const uint32_t index = step.endOf[moved.slot];
  StepData::EndState& end = step.end[index];
  Pose pose = at(moved.motion, 1);
  if (moved.state == State::Carried && body.locks != 0) pose = unlockedPose(body, moved, pose);
  const bool held = anyJoint(world, moved.slot, [&](uint32_t slot) { return acts(world, slot); });
  if ((body.locks >> 3) == 0 && !held) {
    const auto momentum = turnedProduct(toRow(body.inertia), toRow(end.rotation), toRow(end.angularVelocity));
    end.angularVelocity = fromRow(turnedProduct(toRow(body.invInertia), toRow(pose.rotation), momentum));
  }
  end.position = pose.position, end.rotation = pose.rotation;
  const Vec3 way = toFloat(end.position - body.position);
  float* d = step.d.data() + size_t(8) * step.rowOfEnd[index];
  d[0] = way.x, d[1] = way.y, d[2] = way.z;
  d[4] = moved.turned.x, d[5] = moved.turned.y, d[6] = moved.turned.z;
}

}  // namespace

void listFast(const WorldData& world, StepData& step) {
  ContinuousData& c = step.continuous;
  c.bodies.clear(), step.tied.bodies.clear();
  step.tied.any = false;
  for (uint32_t i = 0; i < step.order.size(); ++i) {
    const float* d = step.d.data() + size_t(8) * step.rowOfEnd[i];
    addFast(world, step, step.order[i], {d[0], d[1], d[2]}, {d[4], d[5], d[6]});
  }
  for (const uint32_t slot : step.kinematic) {
    const BodyData& body = world.bodies[slot];
    addFast(world, step, slot, body.linearVelocity * step.h, body.angularVelocity * step.h);
  }
  if (c.bodies.empty()) return;
  c.indexOf.assign(world.bodies.size(), kNone);
  for (uint32_t i = 0; i < c.bodies.size(); ++i) c.indexOf[c.bodies[i].slot] = i;
  for (MovedBody& moved : c.bodies) moved.motion = motionOf(world, step, moved.slot);
}

void stopAtImpacts(WorldData& world, StepData& step) {
  if (step.substep == 0) step.continuous.crossings.clear();
  if (!world.def.continuous) return;
  if (step.continuous.bodies.empty()) return;
  world.report.fastBodies += static_cast<uint32_t>(step.continuous.bodies.size());
  Search(world, step).run();
  findCrossings(world, step);
  for (const MovedBody& moved : step.continuous.bodies)
    if (moved.state != State::Free) endThere(world, step, moved);
}

}  // namespace avbd
