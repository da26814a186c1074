// Continuous collision of the surfaces of soft bodies.
//
// After the solve the ways of all points are known. Two features whose ends are still parted by the plane that parts
// them at the start have not met on straight ways; of others conservative advancement tells when they come too near.
// Points that take part then go only as far as keeps them apart, in the end nowhere, where they start apart. Velocities
// stay, so the next step solves the contact.
#include <algorithm>

#include "avbd/rows/math.h"
#include "step/soft_touches.h"
#include "world/soft.h"
#include "world/soft_touch.h"

namespace avbd {

namespace {

constexpr float kKept = 0.2f, kKeptNear = 0.5f;  ///< of the thickness, and of the distance at the start
/// Below this distance [of the thickness] a larger share of it is kept: what is pressed together step by step would
/// else end in one place.
constexpr float kClose = 0.05f, kKeptClose = 0.95f;
constexpr float kUnseen = 1e-5f;  ///< of the thickness: nearer at the start are none that were kept apart
constexpr float kFar = 1e18f;
constexpr int kFewPasses = 6;    ///< after these what still meets stays where it started
constexpr int kManyPasses = 16;  ///< after these all points of bodies that take part
constexpr int kMostPasses = 60;

}  // namespace

float keptDistance(float thickness, float distance) {
  const float share = distance < kClose * thickness ? kKeptClose : kKeptNear;
  return std::min(kKept * thickness, share * distance);
}

bool mayMeet(const WorldData& world, const NearFeatures& near, const FeatureContact& contact) {
  // Behind the surface of another solid the way leads out through the face. Behind that of its own, which does not pass
  // through itself, a point comes through only where what is between turns inside out.
  if (near.kind == TouchKind::PointFace && !near.within() && !contact.counts) return false;
  return contact.distance > kUnseen * (world.softs[near.first].radius + world.softs[near.second].radius);
}

float meetingTime(const WorldData& world, const SoftSurfaces& surfaces, const NearFeatures& near) {
  const FeatureContact contact = featureContact(world, surfaces, near);
  if (!mayMeet(world, near, contact)) return 2;
  const bool point = near.kind == TouchKind::PointFace;
  const float both = world.softs[near.first].radius + world.softs[near.second].radius;
  const Vec3 direction = contact.off * (1 / contact.distance);
  const float end = leastApart(near.kind, [&](int i) { return dot(direction, near.points.when(i, 1)); });
  if (end >= keptDistance(both, contact.distance)) return 2;
  const float kept =
      near.within() ? keptDistance(thicknessOf(world, near), contact.distance) : keptDistance(both, contact.distance);
  if (end >= kept) return 2;
  return point ? pointMeetsFace(near.points, kept) : edgesMeet(near.points, kept);
}

FoundTouch touchAt(const WorldData& world, const NearFeatures& near, float time) {
  Vec3 p[4];
  for (int i = 0; i < 4; ++i) p[i] = near.points.when(i, time);
  FoundTouch found;
  found.touch = near.touch();
  const NearestFeatures nearest = nearestFeatures(near.kind, p);
  found.touch.anchor = nearest.place, found.off = nearest.off;
  found.touch.normal = found.off * (1 / length(found.off));
  const std::array<float, 4> weights = nodeWeights(near.kind, found.touch.anchor);
  float apart = 0;
  for (size_t i = 0; i < 4; ++i) apart -= weights[i] * dot(found.touch.normal, near.points.at[i]);
  found.separation = apart - thicknessOf(world, near);
  return found;
}

MovingFace movingFace(const WorldData& world, const SoftSurfaces& surfaces, uint32_t soft, uint32_t face) {
  const SoftPlace& place = surfaces.places[soft];
  const auto& corner = world.softs[soft].mesh->surface()[face];
  MovingFace moving;
  for (size_t i = 0; i < 3; ++i)
    moving.at[i] = place.points[corner[i]], moving.way[i] = place.ways[corner[i]] + place.drift;
  return moving;
}

float meetingTime(const WorldData& world, const StepData& step, uint32_t soft, const ShapePiece& piece, uint32_t face) {
  const MovingFace moving = movingFace(world, step.softs, soft, face);
  const float fastest = fastestApproach(piece, moving);
  const float thickness = world.softs[soft].radius;
  const Nearest near =
      nearestToFace(piece, piece.pose, {moving.at[0], moving.at[1], moving.at[2]}, fastest + kKept * thickness);
  // What overlaps at the start is on its way out.
  if (near.apart || near.distance < kUnseen * thickness) return 2;
  if (piece.front != Vec3{} && dot(piece.front, near.normal) < 0) return 2;
  const float kept = keptDistance(thickness, near.distance);
  if (length(piece.turn) == 0) {
    float least = 1e30f;
    for (int i = 0; i < 3; ++i) least = std::min(least, dot(near.normal, moving.way[i] - piece.linear));
    if (near.distance + least >= kept) return 2;
  }
  return pieceMeetsFace(piece, moving, kept);
}

namespace {

class Stops {
 public:
  Stops(WorldData& world, StepData& step) : world_(world), step_(step), s_(step.softs) {}

  void run() {
    checkFirst();
    for (int i = 0; i < kMostPasses && shorten(i); ++i) checkAgain();
    if (s_.share.empty()) return;
    for (const uint32_t slot : step_.order)
      if (s_.share[slot] < 1) end(slot);
    s_.share.clear();
  }

 private:
  /// What the search at the start found near; all, where points went elsewhere than they were thought to go.
  void checkFirst() {
    if (!takeSolvedWays(world_, step_)) {
      placeSolvedSofts(world_, step_);
      findNearFaces(world_, s_);
      checkNear();
    } else {
      for (const NearContact& near : s_.contacts)
        if (comesNear(near)) check(FeaturePairs(world_, s_, near.names.first, near.names.second).features(near.names));
    }
    checkShapes();
  }

  void checkAgain() {
    takeShares(world_, step_, changed_);
    checkNear();
    checkShapes();
  }

  void checkNear() {
    forEachNear(world_, s_, [&](const NearFeatures& near) { check(near); });
  }
  void check(const NearFeatures& near) { meet(meetingTime(world_, s_, near), near.touch()); }
  void checkShapes() {
    world_.softIds.forEach([&](uint32_t slot) {
      forEachNearShape(world_, step_, slot, true, [&](const ShapePiece& piece, uint32_t face) {
        const float time = meetingTime(world_, step_, slot, piece, face);
        if (time <= 1 && !comes(slot, piece, face)) meet(time, piece.namesWith(slot, face).touch());
      });
    });
  }

  /// Whether the shape comes to the face even if that stays: then a stop would leave the face in its way.
  bool comes(uint32_t slot, const ShapePiece& piece, uint32_t face) const {
    if (piece.linear == Vec3{} && piece.turn == Vec3{}) return false;
    MovingFace still = movingFace(world_, s_, slot, face);
    for (Vec3& way : still.way) way = {};
    const Nearest near = nearestToFace(piece, piece.pose, still.at, kFar);
    return pieceMeetsFace(piece, still, keptDistance(world_.softs[slot].radius, near.distance)) <= 1;
  }

  /// All points of the second side are at least `distance` behind those of the first, along the direction.
  bool comesNear(const NearContact& near) const {
    const FeatureNames& names = near.names;
    const SoftData &first = world_.softs[names.first], &second = world_.softs[names.second];
    const SoftPlace &a = s_.places[names.first], &b = s_.places[names.second];
    const auto along = [&](const SoftPlace& place, uint32_t point) { return dot(near.direction, place.ways[point]); };
    float back, forth;
    if (names.kind == TouchKind::EdgeEdge) {
      const auto& e = first.mesh->parts().features.edges[names.firstPart];
      const auto& f = second.mesh->parts().features.edges[names.secondPart];
      back = std::min(along(a, e[0]), along(a, e[1]));
      forth = std::max(along(b, f[0]), along(b, f[1]));
    } else {
      const auto& face = second.mesh->surface()[names.secondPart];
      back = along(a, names.firstPart);
      forth = std::max({along(b, face[0]), along(b, face[1]), along(b, face[2])});
    }
    const float left = near.distance + back - forth + dot(near.direction, a.drift - b.drift);
    return left < keptDistance(first.radius + second.radius, near.distance);
  }

  void meet(float time, const SoftTouch& touch) {
    if (time > 1 || !mayTouchSoft(world_, touch)) return;
    ++world_.report.impacts;
    for (const uint32_t body : nodesOf(world_, touch)) {
      // A body that meets a surface goes on: what it touches besides would not know of its stop.
      if (!isParticle(world_, body) || world_.bodies[body].asleep || !(s_.shareOf(body) > 0)) continue;
      met_.push_back({body, time});
    }
  }

  /// Shortens the ways of what met. Whether any became shorter.
  bool shorten(int pass) {
    if (met_.empty()) return false;
    if (s_.share.empty()) begin();
    std::sort(met_.begin(), met_.end());
    changed_.clear();
    for (size_t i = 0; i < met_.size(); ++i) {
      const auto& [body, time] = met_[i];
      if (i > 0 && met_[i - 1].first == body) continue;
      const uint32_t soft = world_.bodies[body].soft;
      if (pass >= kManyPasses)
        stay(soft);
      else
        change(soft, body, pass >= kFewPasses ? 0.0f : time);
    }
    met_.clear();
    return true;
  }

  void begin() {
    s_.share.assign(world_.bodies.size(), 1);
    pointOf_.resize(world_.bodies.size());
    world_.softIds.forEach([&](uint32_t slot) {
      const std::vector<uint32_t>& all = world_.softs[slot].bodies;
      for (uint32_t i = 0; i < all.size(); ++i) pointOf_[all[i]] = i;
    });
  }

  void change(uint32_t soft, uint32_t body, float factor) {
    s_.share[body] *= factor;
    changed_.push_back({soft, pointOf_[body]});
  }

  void stay(uint32_t soft) {
    for (const uint32_t body : world_.softs[soft].bodies)
      if (s_.share[body] > 0) change(soft, body, 0);
  }

  /// The pose where it stays.
  void end(uint32_t slot) {
    const BodyData& body = world_.bodies[slot];
    const uint32_t index = step_.endOf[slot];
    StepData::EndState& end = step_.end[index];
    float* d = step_.d.data() + size_t(8) * step_.rowOfEnd[index];
    const float share = s_.share[slot];
    end.position = body.position + toFloat(end.position - body.position) * share;
    for (int i = 0; i < 3; ++i) d[i] *= share;
  }

  WorldData& world_;
  StepData& step_;
  SoftSurfaces& s_;
  std::vector<uint32_t> pointOf_;                 ///< by body slot: its point
  std::vector<std::pair<uint32_t, float>> met_;   ///< bodies that meet, and when
  std::vector<std::array<uint32_t, 2>> changed_;  ///< soft bodies and points whose ways became shorter
};

}  // namespace

void stopSofts(WorldData& world, StepData& step) {
  if (!world.def.continuous || world.softIds.count() == 0 || world.sleep.awake.empty()) return;
  Stops(world, step).run();
}

}  // namespace avbd
