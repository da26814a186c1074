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

/// Neither stopped nor carried yet.
bool isLive(const MovedBody& moved) { return moved.state == State::Free || moved.state == State::Joined; }

/// Whether a body may be moved aside of where the solve put it, as nothing but contacts hold it.
bool isLoose(const WorldData& world, uint32_t slot) {
  const BodyData& body = world.bodies[slot];
  return body.type == BodyType::Dynamic && !body.asleep && body.continuous && body.locks == 0 &&
         !anyJoint(world, slot, [&](uint32_t joint) { return acts(world, joint); });
}
/// Whether a body and those that it touches, few enough, could be moved all alike: nothing else holds them.
bool floats(const WorldData& world, const StepData& step, uint32_t slot) {
  if (!isLoose(world, slot)) return false;
  const Island& island = step.islands[step.islandOf[slot]];
  if (!island.floating || island.bodyCount > kMostTogether) return false;
  if (island.jointCount + island.softCount + island.touchCount > 0) return false;
  for (uint32_t i = 0; i < island.bodyCount; ++i)
    if (!isLoose(world, step.order[island.bodyBegin + i])) return false;
  return true;
}

class Search {
 public:
  Search(WorldData& world, StepData& step) : world_(world), step_(step), c_(step.continuous) {}

  void run() {
    const auto fast = static_cast<uint32_t>(c_.bodies.size());
    c_.meets.clear(), c_.queue.clear(), c_.visits.clear(), c_.groups.clear();
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

  /// A point of a surface and what moves: the faces about the point go before that (soft_impacts.h).
  bool facesMeet(uint32_t shapeA, uint32_t shapeB) const {
    const auto isOfSurface = [&](uint32_t shape) {
      const uint32_t body = world_.shapes[shape].body;
      return isParticle(world_, body) && !world_.softs[world_.bodies[body].soft].mesh->surface().empty();
    };
    const auto moves = [&](uint32_t shape) {  // half-spaces meet points alone
      const ShapeData& data = world_.shapes[shape];
      return world_.bodies[data.body].type != BodyType::Static && data.geom.type != ShapeType::HalfSpace;
    };
    return (isOfSurface(shapeA) && moves(shapeB)) || (isOfSurface(shapeB) && moves(shapeA));
  }

  void meet(uint32_t shapeA, uint32_t shapeB) {
    if (!mayTouch(world_, shapeA, shapeB)) return;
    if (!isVisit(shapeA, shapeB)) {
      if (!facesMeet(shapeA, shapeB)) addMeet(shapeA, shapeB);
      return;
    }
    c_.visits.push_back(slotPair(shapeA, shapeB));
  }

  /// Fast bodies may have left their boxes in the tree.
  void meetEachOther(uint32_t fast) {
    forEachOverlap(
        fast, c_.byX, [&](uint32_t i) -> const Aabb& { return c_.bodies[i].box; },
        [&](uint32_t i, uint32_t k) {
          forEachShapePair(world_, c_.bodies[i].slot, c_.bodies[k].slot, [&](uint32_t s, uint32_t t) { meet(s, t); });
        });
  }

  /// Adds what a body's shapes meet in the tree.
  void meetOthers(uint32_t index, bool first, float spare = 0) {
    const uint32_t slot = c_.bodies[index].slot;
    const BodyMotion motion = c_.bodies[index].motion;
    for (uint32_t s = world_.bodies[slot].firstShape; s != kNone; s = world_.shapes[s].next) {
      const Aabb box = grown(boundsOnWay(motion, world_.shapes[s], world_.bodies[slot].radius), spare);
      world_.tree.query(box, [&](uint32_t other) {
        const uint32_t known = c_.indexOf[world_.shapes[other].body];
        if (known != kNone && (known == index || (first && c_.bodies[known].isFast))) return;
        if (first || !isKnown(index, s, other)) meet(s, other);
      });
    }
  }

  /// Adds what a body meets that has left its box in the tree.
  void meetMoved(uint32_t index) {
    const Aabb box = c_.bodies[index].box;
    for (uint32_t k = 0; k < c_.bodies.size(); ++k) {
      const MovedBody& other = c_.bodies[k];
      if (k == index || (!other.isFast && other.state != State::Joined) || !overlaps(box, other.box)) continue;
      forEachShapePair(world_, c_.bodies[index].slot, other.slot, [&](uint32_t s, uint32_t t) {
        if (!isKnown(index, s, t)) meet(s, t);
      });
    }
  }

  /// What a body cannot stop that it meets.
  bool isUnstoppable(const MovedBody& moved) const {
    return moved.state == State::Carried || (moved.isFast && !isDynamic(moved));
  }
  bool isStopped(const MovedBody& moved, const MovedBody& by) const {
    return isLive(moved) && isDynamic(moved) && !bodyOf(moved).asleep && bodyOf(moved).continuous &&
           !isTied(world_, moved.slot) && (moved.isFast || moved.state == State::Joined || isUnstoppable(by));
  }

  /// Whether one of the two would stop.
  bool isOpen(uint32_t m) const {
    const MovedBody &a = c_.bodies[c_.meets[m].body[0]], &b = c_.bodies[c_.meets[m].body[1]];
    const bool together =
        a.group != kNone && a.group == b.group && a.state == State::Joined && b.state == State::Joined;
    if (together && c_.groups[a.group].turnsNot) return false;
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
    if ((stopsA || stopsB) && join(a, b, impact.time)) {
      // Both go on.
    } else if (stopsA && stopsB) {
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
    change(index, State::Carried, time, carried(at(c_.bodies[index].motion, time), other.motion, time, normal));
  }

  void stop(uint32_t index, float time) {
    if (isPulled(index)) return;
    change(index, State::Stopped, time, resting(at(c_.bodies[index].motion, time)));
  }

  void change(uint32_t index, State state, float time, const BodyMotion& motion) {
    MovedBody& moved = c_.bodies[index];
    moved.turned = moved.turned + moved.motion.turn * (time - moved.since);
    if (moved.state == State::Free) moved.before = moved.motion, moved.time = time;
    moved.state = state;
    moved.since = time;
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

  /// Two that nothing else holds go on together. Returns false where that cannot be.
  bool join(uint32_t a, uint32_t b, float time) {
    const uint32_t groups[2] = {groupOf(a), groupOf(b)};
    if (groups[0] == kNone || groups[1] == kNone) return false;
    if (!isLive(c_.bodies[a]) || !isLive(c_.bodies[b])) return false;
    if (groups[0] == groups[1]) return keepFromTurning(groups[0], time);
    if (c_.groups[groups[0]].count + c_.groups[groups[1]].count > kMostTogether) return false;
    const MeanMotion mean[2] = {meanOf(groups[0]), meanOf(groups[1])};
    const float mass = mean[0].mass + mean[1].mass;
    const Vec3 both = (mean[0].shift * mean[0].mass + mean[1].shift * mean[1].mass) * (1 / mass);
    for (int k = 0; k < 2; ++k)
      forEachLive(groups[k], [&](uint32_t i) {
        change(i, State::Joined, time, shifted(c_.bodies[i].motion, both - mean[k].shift, time));
      });
    unite(groups[0], groups[1]);
    return true;
  }

  /// What goes together and yet meets, as it turns or moves within, goes on like one body that does not turn.
  bool keepFromTurning(uint32_t group, float time) {
    c_.groups[group].turnsNot = true;
    const Vec3 shift = meanOf(group).shift;
    forEachLive(group, [&](uint32_t i) {
      change(i, State::Joined, time, shifted(resting(at(c_.bodies[i].motion, time)), shift, time));
    });
    return true;
  }

  /// The body and what it touches, if nothing holds those; else one that may stop alone. kNone if it is none of these.
  uint32_t groupOf(uint32_t index) {
    if (c_.bodies[index].asked) return c_.bodies[index].group;
    c_.bodies[index].asked = true;
    const uint32_t slot = c_.bodies[index].slot;
    const bool all = floats(world_, step_, slot);
    if (!all && !(c_.bodies[index].isFast && isLoose(world_, slot))) return kNone;
    const auto group = static_cast<uint32_t>(c_.groups.size());
    c_.groups.push_back({});
    if (!all) return addTo(group, index);
    const Island& island = step_.islands[step_.islandOf[slot]];
    for (uint32_t i = 0; i < island.bodyCount; ++i) addTo(group, indexOf(step_.order[island.bodyBegin + i]));
    return group;
  }

  uint32_t addTo(uint32_t group, uint32_t index) {
    MovedBody& moved = c_.bodies[index];
    moved.asked = true, moved.group = group, moved.nextInGroup = c_.groups[group].first;
    c_.groups[group].first = index, ++c_.groups[group].count;
    return group;
  }

  template <class F>
  void forEachLive(uint32_t group, F&& f) {
    for (uint32_t i = c_.groups[group].first; i != kNone; i = c_.bodies[i].nextInGroup)
      if (isLive(c_.bodies[i])) f(i);
  }

  struct MeanMotion {
    float mass = 0;
    Vec3 shift;
  };
  MeanMotion meanOf(uint32_t group) {
    MeanMotion mean;
    forEachLive(group, [&](uint32_t i) {
      mean.mass += bodyOf(c_.bodies[i]).mass;
      mean.shift = mean.shift + c_.bodies[i].motion.shift * bodyOf(c_.bodies[i]).mass;
    });
    mean.shift = mean.shift * (1 / mean.mass);
    return mean;
  }

  void unite(uint32_t group, uint32_t other) {
    uint32_t last = kNone;
    for (uint32_t i = c_.groups[other].first; i != kNone; i = c_.bodies[i].nextInGroup)
      c_.bodies[i].group = group, last = i;
    c_.bodies[last].nextInGroup = c_.groups[group].first;
    c_.groups[group].first = c_.groups[other].first;
    c_.groups[group].count += c_.groups[other].count;
    c_.groups[group].turnsNot = c_.groups[group].turnsNot && c_.groups[other].turnsNot;
  }

  /// Those that join others step by step change their ways by little, so more is searched than they need.
  static float spareOf(const MovedBody& moved) { return 0.25f * length(moved.motion.shift); }
  /// Whether a body goes where nothing was searched yet.
  bool leavesBox(MovedBody& moved) const {
    if (moved.state != State::Joined) return moved.state == State::Carried;
    const Aabb way = boundsOnWay(world_, moved.motion, moved.slot);
    if (contains(moved.box, way)) return false;
    moved.box = grown(way, spareOf(moved));
    return true;
  }

  /// The changed bodies go another way from now on.
  void askAgain(float time) {
    const size_t known = c_.meets.size();
    c_.astray.clear();
    for (const uint32_t index : c_.changed)
      if (leavesBox(c_.bodies[index])) c_.astray.push_back(index);
    for (const uint32_t index : c_.astray) {
      const bool joined = c_.bodies[index].state == State::Joined;
      meetOthers(index, false, joined ? spareOf(c_.bodies[index]) : 0);
      if (joined) meetMoved(index);
    }
    for (size_t m = known; m < c_.meets.size(); ++m) ask(static_cast<uint32_t>(m), time);
    ++changes_;
    for (const uint32_t index : c_.changed)
      for (uint32_t m = c_.bodies[index].firstMeet; m != kNone; m = nextMeet(m, index)) {
        if (m >= known || c_.meets[m].change == changes_) continue;
        c_.meets[m].change = changes_;
        ask(m, time);
      }
  }

  WorldData& world_;
  StepData& step_;
  ContinuousData& c_;
  uint32_t changes_ = 0;
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
  Vec3 turned = moved.turned + moved.motion.turn * (1 - moved.since);
  if (moved.state == State::Joined && moved.motion.turn == moved.before.turn) turned = moved.before.turn;
  if (moved.state == State::Carried && body.locks != 0) pose = unlockedPose(body, moved, pose);
  const Vec3 way = toFloat(pose.position - body.position);
  float* d = step.d.data() + size_t(8) * step.rowOfEnd[index];
  d[0] = way.x, d[1] = way.y, d[2] = way.z;
  end.position = pose.position;
  if (turned == Vec3{d[4], d[5], d[6]}) return;
  const bool held = anyJoint(world, moved.slot, [&](uint32_t slot) { return acts(world, slot); });
  if ((body.locks >> 3) == 0 && !held) {
    const auto momentum = turnedProduct(toRow(body.inertia), toRow(end.rotation), toRow(end.angularVelocity));
    end.angularVelocity = fromRow(turnedProduct(toRow(body.invInertia), toRow(pose.rotation), momentum));
  }
  end.rotation = pose.rotation;
  d[4] = turned.x, d[5] = turned.y, d[6] = turned.z;
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
