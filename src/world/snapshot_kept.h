// Snapshots: the manifold that a pair has and the one that it keeps (collide/kept_manifold.h). With the bodies where
// contacts were last looked for, one of the two mostly follows from the other: a manifold that was carried from the
// kept one, or a kept one from the manifold that was found. Only the other is written. A manifold of bodies apart only
// saves time and is left out.
#pragma once

#include "world/snapshot_near.h"
#include "world/snapshot_sides.h"

namespace avbd::snapshot {

/// A pair's bodies as the last search for contacts saw them, relative to A's centre. Of one that is gone nothing is
/// known.
struct LastPlaces {
  NearBody a, b;
  bool both = false;  ///< they are there

  LastPlaces(const PairSide& sideA, const PairSide& sideB) {
    both = sideA.lives && sideB.lives;
    if (!both) return;
    a = {{{}, sideA.last.rotation}, sideA.radius};
    b = {{toFloat(sideB.last.position - sideA.last.position), sideB.last.rotation}, sideB.radius};
  }
};

enum class Follows : uint8_t { Nothing, Manifold, Kept };

inline ManifoldPoint pointOf(const CarriedPoints& now, int i, uint32_t feature) {
  return {{now.position.x[i], now.position.y[i], now.position.z[i]}, now.separation[i], feature};
}

inline bool sameKept(const KeptManifold& p, const KeptManifold& q) {
  // All members by name: a new one does not compile before it is here and in the functions below.
  auto& [what, aroundBase, offset, turn, clear, reach, normal, x, y, z, height] = p;
  return what == q.what && aroundBase == q.aroundBase && same(offset, q.offset) && same(turn, q.turn) &&
         same(clear, q.clear) && same(reach, q.reach) && same(normal, q.normal) && same(x, q.x) && same(y, q.y) &&
         same(z, q.z) && same(height, q.height);
}

/// What is kept of a manifold that was found, if `clear` and `carrier` are those that it had.
inline KeptManifold keptOf(const Manifold& manifold, float clear, Carrier carrier, const LastPlaces& last) {
  KeptManifold kept;
  Manifold found = manifold;
  found.clear = clear, found.carrier = carrier;
  keep(found, last.a, last.b, kept);
  return kept;
}

inline Carrier carrierOf(const KeptManifold& kept) {
  return kept.what == KeptManifold::What::PointsOnB ? Carrier::B : Carrier::A;
}

/// Which of the two follows from the other, bit by bit. `carried`: filled where it is the manifold.
inline Follows whatFollows(const PairData& pair, const LastPlaces& last, CarriedPoints& carried) {
  if (!keepsPoints(pair.kept) || !last.both) return Follows::Nothing;
  const OtherPlace place = otherPlace(pair.kept.what, last.a.pose, last.b.pose);
  if (same(place.offset, pair.kept.offset) && same(place.turn, pair.kept.turn)) {
    const KeptManifold again = keptOf(pair.manifold, pair.kept.clear, carrierOf(pair.kept), last);
    if (sameKept(again, pair.kept)) return Follows::Kept;
  }
  carryPoints(pair.kept, place, carried);
  bool all = same(carried.normal, pair.manifold.normal);
  for (int i = 0; all && i < pair.manifold.count; ++i) {
    const ManifoldPoint &is = pair.manifold.points[i], at = pointOf(carried, i, is.feature);
    all = same(is.position, at.position) && same(is.separation, at.separation);
  }
  return all ? Follows::Manifold : Follows::Nothing;
}

/// As the engine computes it.
inline float reachOf(const KeptManifold& kept, const LastPlaces& last) {
  const bool ofB = kept.what == KeptManifold::What::PointsOnB;
  const float base = ofB ? last.b.radius : last.a.radius, other = ofB ? last.a.radius : last.b.radius;
  return kept.aroundBase ? base + kept.clear : other;
}

// Head: what (2 bits), aroundBase, another reach, count of points (3 bits). Then the ways of offset, turn and the
// turn's w.
constexpr uint8_t kAroundBase = 1u << 2, kOtherReach = 1u << 3;
constexpr int kKeptCountAt = 4;

inline int keptPoints(const KeptManifold& kept) {
  int count = kMaxManifoldPoints;
  constexpr float kZero = 0;
  const auto none = [&](int k) {
    return same(kept.x[k], kZero) && same(kept.y[k], kZero) && same(kept.z[k], kZero) && same(kept.height[k], kZero);
  };
  while (count > 0 && none(count - 1)) --count;
  return count;
}

inline Vec3 vectorOf(Quat q) { return {q.x, q.y, q.z}; }

/// `offset` and `turn`: of the other body as the base sees it.
inline void writeKept(std::byte*& to, const KeptManifold& kept, const LastPlaces& last, Vec3 offset, Quat turn) {
  const int count = keptPoints(kept);
  const bool otherReach = !same(kept.reach, reachOf(kept, last));
  const uint32_t head = static_cast<uint32_t>(kept.what) | (kept.aroundBase ? kAroundBase : 0u) |
                        (otherReach ? kOtherReach : 0u) | static_cast<uint32_t>(count) << kKeptCountAt;
  put(to, static_cast<uint8_t>(head));
  std::byte* const ways = to++;
  uint32_t bits = putNear(to, kept.offset, offset);
  bits |= putNear(to, vectorOf(kept.turn), vectorOf(turn)) << 2;
  bits |= putNear(to, kept.turn.w, turn.w) << 4;
  *ways = static_cast<std::byte>(bits);
  put(to, kept.clear);
  if (otherReach) put(to, kept.reach);
  put(to, kept.normal);
  for (int k = 0; k < count; ++k) put(to, kept.x[k]), put(to, kept.y[k]), put(to, kept.z[k]), put(to, kept.height[k]);
}

inline KeptManifold::What readWhat(uint32_t what) {
  require(what == static_cast<uint32_t>(KeptManifold::What::PointsOnA) ||
              what == static_cast<uint32_t>(KeptManifold::What::PointsOnB),
          "a manifold kept in no way");
  return static_cast<KeptManifold::What>(what);
}

/// `place`: filled if one is kept.
inline void readKept(const std::byte*& from, KeptManifold& kept, const LastPlaces& last, OtherPlace& place) {
  kept = {};
  uint8_t head = 0, ways = 0;
  put(from, head);
  if (head == 0) return;
  const int count = head >> kKeptCountAt;
  kept.what = readWhat(head & 3u);
  require(last.both && count <= kMaxManifoldPoints, "a manifold kept in no way");
  kept.aroundBase = (head & kAroundBase) != 0;
  put(from, ways);
  place = otherPlace(kept.what, last.a.pose, last.b.pose);
  putNear(from, kept.offset, place.offset, ways & 3u);
  Vec3 turn;
  putNear(from, turn, vectorOf(place.turn), ways >> 2 & 3u);
  kept.turn = {0, turn.x, turn.y, turn.z};
  putNear(from, kept.turn.w, place.turn.w, ways >> 4 & 3u);
  put(from, kept.clear);
  kept.reach = reachOf(kept, last);
  if (head & kOtherReach) put(from, kept.reach);
  put(from, kept.normal);
  for (int k = 0; k < count; ++k)
    put(from, kept.x[k]), put(from, kept.y[k]), put(from, kept.z[k]), put(from, kept.height[k]);
}

}  // namespace avbd::snapshot
