// Parts of the stage 75_continuous.
//
// A body that moves far for its size in a step could pass through something that the contacts of the step know nothing
// of. Its way from the start of the step to its end is searched for the first impact, in order of time: what the body
// then does for the rest of the step depends on what it meets.
// - Another body that nothing outside holds, or that is fast itself: from there on both go on with their common
//   velocity, and with them what they touch or have met before. That moves neither the centre of mass nor the moment of
//   what they have of momentum, and is the same in whatever common flight they are.
// - Something that stands still, or has a joint or lock to keep and is fast itself: what can stops where they touch.
// - Something else that goes on (a kinematic body, a slow one that something holds, a point of a rope): it takes the
//   fast body along.
// Velocities stay, so momentum does: the next step finds a contact that is about to be hit, and solves it.
//
// A body that is tied to others by joints is not stopped: continuous_tied.cpp.
#pragma once

#include <avbd/events.h>

#include <algorithm>
#include <array>
#include <vector>

#include "collide/time_of_impact.h"
#include "geom/aabb.h"
#include "solve/swept_contact.h"
#include "world/world_data.h"

namespace avbd {

struct StepData;

/// How a body moves over a step: a point of it goes straight, and it turns steadily about that point.
struct BodyMotion {
  Vec3d center;   ///< the point, at the start
  Vec3 arm;       ///< from there to the centre of mass, at the start
  Quat rotation;  ///< at the start
  Vec3 shift;     ///< [m] of the point
  Vec3 turn;      ///< [rad]
};
/// At a time 0 .. 1 of the step; position: of the centre of mass.
Pose at(const BodyMotion& motion, float time);
BodyMotion motionOf(const WorldData& world, const StepData& step, uint32_t body);
BodyMotion resting(const Pose& pose);
/// From `time` on with another shift, that much more over a whole step.
BodyMotion shifted(const BodyMotion& motion, Vec3 more, float time);
/// From `time` on as if fixed to what moves so; where that does not turn, along the normal alone and only if pushed.
BodyMotion carried(const Pose& pose, const BodyMotion& by, float time, Vec3 normal);
ShapeMotion motionOf(const BodyMotion& body, const ShapeData& shape, Vec3d origin);
/// Bounds of a shape on all its way.
Aabb boundsOnWay(const BodyMotion& body, const ShapeData& shape, float radius);
/// The same of all shapes of a body.
Aabb boundsOnWay(const WorldData& world, const BodyMotion& motion, uint32_t body);
/// How far the motions of two bodies may bring them closer or apart, at most.
float relativeWay(const BodyMotion& a, float radiusA, const BodyMotion& b, float radiusB);

/// A body in the search: fast, or met by one that is.
struct MovedBody {
  enum class State : uint8_t { Free, Joined, Stopped, Carried };
  uint32_t slot = kNone;
  State state = State::Free;
  bool isFast = false;
  bool asked = false;            ///< `group` is known
  uint32_t group = kNone;        ///< in ContinuousData::groups
  uint32_t nextInGroup = kNone;  ///< in ContinuousData::bodies
  float time = 1;                ///< at which it first went another way
  float since = 0;               ///< from when on `motion` holds
  uint32_t firstMeet = kNone;    ///< ShapesMeet::next leads on
  BodyMotion motion;
  BodyMotion before;  ///< up to `time`, where it is not free any more
  Vec3 turned;        ///< [rad] what it has turned up to `since`
  Aabb box;           ///< holds all its way, and was searched; of fast ones and those that go on together
};

/// Bodies that touch, or have met and go on together.
struct MovedGroup {
  uint32_t first = kNone, count = 0;  ///< MovedBody::nextInGroup leads on
  bool turnsNot = false;              ///< goes on like one body, without turning
};

/// Two shapes whose bounds meet on their way.
struct ShapesMeet {
  uint32_t body[2] = {kNone, kNone};   ///< in ContinuousData::bodies
  uint32_t shape[2] = {kNone, kNone};  ///< slots; the first is convex
  uint32_t next[2] = {kNone, kNone};   ///< the next one of body[k]
  uint32_t asked = 0;                  ///< how often its impact was looked for
  uint32_t change = 0;                 ///< the last change of bodies that it was asked for
};

struct PlannedImpact {
  float time = 0;
  uint64_t key = 0;  ///< of the shapes
  uint32_t meet = 0;
  uint32_t asked = 0;  ///< void if ShapesMeet::asked has moved on
  Vec3 normal;         ///< from the first shape to the second
};

struct ContinuousData {
  std::vector<MovedBody> bodies;
  std::vector<uint32_t> indexOf;  ///< by body slot: in `bodies`
  std::vector<ShapesMeet> meets;
  std::vector<MovedGroup> groups;
  std::vector<Impact> answers;          ///< by meet, to what is asked first
  std::vector<PlannedImpact> queue;     ///< a heap
  std::vector<uint32_t> byX;            ///< fast bodies by where they begin along x
  std::vector<uint32_t> changed;        ///< in `bodies`: by the last impact
  std::vector<uint32_t> astray;         ///< of those, the ones that go where nothing was searched
  std::vector<uint64_t> visits;         ///< triggers and fast bodies that may pass through them: shape slots
  std::vector<TriggerEvent> crossings;  ///< triggers that were entered and left, of all substeps so far
};

/// Two bodies on their way to where shapes of theirs meet.
struct TiedImpact {
  uint64_t key = 0;      ///< of the shapes
  BodyMotion motion[2];  ///< of the bodies of the lower and the higher shape
  float time = 0;
};

/// A contact of the pose where the pair meets.
struct SweptPair {
  uint64_t key = 0;
  uint16_t patch = 0;
  int round = 0;   ///< of the step, that it is for
  float time = 1;  ///< of the step, when they meet
  SweptContact rows;
  float turn = 0;         ///< [rad] that the bodies may turn by when they are held
  Vec3 armA[4], armB[4];  ///< from the centres of mass to the points when they meet
};

/// What the search for impacts of tied bodies needs (continuous_tied.cpp).
struct TiedData {
  std::vector<uint32_t> bodies;  ///< slots: fast ones that are tied, and fast kinematic ones
  bool any = false;              ///< some of them may meet a tied one
  std::vector<uint64_t> keys;    ///< of shapes that may meet
  std::vector<TiedImpact> meetings;
  std::vector<uint32_t> taken;    ///< bodies that have met something in this round
  std::vector<uint64_t> refused;  ///< keys, ascending: in this substep the hook has let them pass
  struct Place {
    uint64_t key;
    uint16_t patch;
  };
  std::vector<Place> changed;  ///< of StepData::changes: the list of pairs moves under them
  std::vector<Aabb> boxes;     ///< of `bodies`, on all their ways
  std::vector<uint32_t> byX;   ///< indices of those, for forEachOverlap()
};

/// Calls f(i, k) for each two of `count` boxes that overlap, in the order of their lower x. byX is its memory.
template <class BoxOf, class F>
void forEachOverlap(uint32_t count, std::vector<uint32_t>& byX, BoxOf&& boxOf, F&& f) {
  byX.resize(count);
  for (uint32_t i = 0; i < count; ++i) byX[i] = i;
  std::sort(byX.begin(), byX.end(), [&](uint32_t i, uint32_t k) {
    const float x = boxOf(i).lower.x, y = boxOf(k).lower.x;
    return x < y || (x == y && i < k);
  });
  for (uint32_t i = 0; i < count; ++i)
    for (uint32_t k = i + 1; k < count; ++k) {
      const Aabb &a = boxOf(byX[i]), &b = boxOf(byX[k]);
      if (b.lower.x > a.upper.x) break;
      if (overlaps(a, b)) f(byX[i], byX[k]);
    }
}

/// Calls f(shapeOfA, shapeOfB) for all of two bodies' shapes.
template <class F>
void forEachShapePair(const WorldData& world, uint32_t bodyA, uint32_t bodyB, F&& f) {
  for (uint32_t s = world.bodies[bodyA].firstShape; s != kNone; s = world.shapes[s].next)
    for (uint32_t t = world.bodies[bodyB].firstShape; t != kNone; t = world.shapes[t].next) f(s, t);
}

/// More bodies than this do not go on together: each that joins has all their ways searched again.
inline constexpr uint32_t kMostTogether = 32;
inline constexpr float kFastWay = 0.5f;  ///< of a half thickness: who moves farther in a step is fast

/// The convex shape of two first; of two convex ones the lower slot.
std::array<uint32_t, 2> inOrder(const WorldData& world, uint32_t shapeA, uint32_t shapeB);
/// When the two shapes meet so that the rest of their way would take them through each other.
Impact impactOf(const WorldData& world, const StepData& step, const ShapesMeet& meet, float from);
/// The same of shapes in order, and how their bodies move. `tied`: the step would have to be solved again, so only what
/// is as deep as the thinner one's half thickness counts.
Impact impactOf(const WorldData& world, const StepData& step, const std::array<uint32_t, 2>& shapes,
                const std::array<const BodyMotion*, 2>& motions, float from, bool tied);
/// Lists the fast bodies, those that are tied apart.
void listFast(const WorldData& world, StepData& step);
/// Whether a joint ties a body to another that moves (continuous_tied.cpp). Behind the solve such a body is an obstacle
/// to others, but goes its own way.
bool isTied(const WorldData& world, uint32_t body);
/// Triggers that a fast body passed through between the poses at which overlaps are looked for.
void findCrossings(WorldData& world, StepData& step);

}  // namespace avbd
