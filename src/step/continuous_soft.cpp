// Continuous collision of the surfaces of soft bodies.
//
// After the solve the ways of all points are known. Two features whose ends are still parted by the plane that parts
// them at the start have not met on straight ways; of others conservative advancement tells when they come too near.
// Impacts change the ways (soft_impacts.h), and what goes another way is searched again, until nothing meets.
#include <algorithm>

#include "avbd/rows/math.h"
#include "step/soft_impacts.h"
#include "step/soft_touches.h"
#include "world/soft.h"
#include "world/soft_touch.h"

namespace avbd {

namespace {

constexpr float kKept = 0.2f, kKeptNear = 0.5f;  ///< of the thickness, and of the distance at the start
/// Below this distance [of the thickness] a larger share of it is kept: what is pressed together step by step would
/// else end in one place.
constexpr float kClose = 0.05f, kKeptClose = 0.95f, kToleranceClose = 0.02f;
constexpr float kAimClose = 1.02f;  ///< of the distance: what keeps them apart leads them out
constexpr float kTolerance = 0.1f;  ///< of what is kept
constexpr float kAim = 1.5f;        ///< tolerances that are left besides
constexpr float kUnseen = 1e-5f;    ///< of the thickness: nearer at the start are none that were kept apart
constexpr float kDeep = 0.5f;       ///< of the thickness or of half the solid's: how far faces may be in solids
constexpr float kFar = 1e18f;
constexpr int kFewPasses = 8;  ///< after these a shape that comes to a face that stays is left to the rows
constexpr int kMostPasses = 60;

}  // namespace

Kept keptOf(float thickness, float distance) {
  if (distance < kClose * thickness) return {kKeptClose * distance, kToleranceClose * distance, kAimClose * distance};
  const float least = std::min(kKept * thickness, kKeptNear * distance), tolerance = kTolerance * least;
  return {least, tolerance, least + kAim * tolerance};
}

Kept keptOf(const WorldData& world, const NearFeatures& near, float distance) {
  return keptOf(
      near.within() ? thicknessOf(world, near) : world.softs[near.first].radius + world.softs[near.second].radius,
      distance);
}

/// A solid may overlap a face somewhat, of which rows lead it out; a triangle has no inside.
Kept keptOf(const ShapePiece& piece, float thickness, float distance) {
  if (piece.thin == 0) return keptOf(thickness, distance);
  const float deep = kDeep * std::min(thickness, piece.thin), tolerance = kTolerance * deep;
  const float least = std::min(-deep, distance - 2 * tolerance);
  return {least, tolerance, least + kAim * tolerance};
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
  const float end = leastApart(firstNodes(near.kind), [&](int i) { return dot(direction, near.points.when(i, 1)); });
  if (end >= keptOf(both, contact.distance).least) return 2;
  const Kept kept = keptOf(world, near, contact.distance);
  if (end >= kept.least) return 2;
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
  // What passes through a triangle at the start is on its way out.
  if (near.apart || (piece.thin == 0 && near.distance < kUnseen * thickness)) return 2;
  if (piece.front != Vec3{} && dot(piece.front, near.normal) < 0) return 2;
  const Kept kept = keptOf(piece, thickness, near.distance);
  if (length(piece.turn) == 0) {
    float least = 1e30f;
    for (int i = 0; i < 3; ++i) least = std::min(least, dot(near.normal, moving.way[i] - piece.linear));
    if (near.distance + least >= kept.least) return 2;
  }
  return pieceMeetsFace(piece, moving, kept);
}

namespace {

class Stops {
 public:
  Stops(WorldData& world, StepData& step) : world_(world), step_(step), s_(step.softs), impacts_(world, step) {}

  void run() {
    checkFirst();
    for (pass_ = 0; pass_ < kMostPasses && impacts_.any(); ++pass_) {
      const auto& points = impacts_.resolve(pass_);
      takeWays(world_, step_, points);
      checkNear();
      for (size_t i = 0; i < points.size(); ++i)
        if (i == 0 || points[i][0] != points[i - 1][0]) checkShapes(points[i][0]);
    }
    impacts_.end();
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
    world_.softIds.forEach([&](uint32_t slot) { checkShapes(slot); });
  }

  void checkNear() {
    forEachNear(world_, s_, [&](const NearFeatures& near) { check(near); });
  }
  void check(const NearFeatures& near) {
    const float time = meetingTime(world_, s_, near);
    if (time <= 1) impacts_.meet(near, time);
  }
  void checkShapes(uint32_t slot) {
    forEachNearShape(world_, step_, slot, true, [&](const ShapePiece& piece, uint32_t face) {
      const float time = meetingTime(world_, step_, slot, piece, face);
      if (time <= 1 && !(pass_ >= kFewPasses && comes(slot, piece, face))) impacts_.meet(piece, slot, face, time);
    });
  }

  /// Whether the shape comes to the face even if that stays.
  bool comes(uint32_t slot, const ShapePiece& piece, uint32_t face) const {
    if (piece.linear == Vec3{} && piece.turn == Vec3{}) return false;
    MovingFace still = movingFace(world_, s_, slot, face);
    for (Vec3& way : still.way) way = {};
    const Nearest near = nearestToFace(piece, piece.pose, still.at, kFar);
    return pieceMeetsFace(piece, still, keptOf(piece, world_.softs[slot].radius, near.distance)) <= 1;
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
    return left < keptOf(first.radius + second.radius, near.distance).least;
  }

  WorldData& world_;
  StepData& step_;
  SoftSurfaces& s_;
  SoftImpacts impacts_;
  int pass_ = 0;
};

}  // namespace

void stopSofts(WorldData& world, StepData& step) {
  if (!world.def.continuous || world.softIds.count() == 0 || world.sleep.awake.empty()) return;
  Stops(world, step).run();
}

}  // namespace avbd
