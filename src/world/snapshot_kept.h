// Snapshots: the manifold that a pair keeps (collide/kept_manifold.h), by what it differs from where its bodies and its
// points are now. They have hardly moved since, so little is left to write. That of bodies apart only saves time and is
// left out.
#pragma once

#include <limits>

#include "world/snapshot_near.h"
#include "world/world_data.h"

namespace avbd::snapshot {

/// A pair's bodies against each other.
struct BodiesApart {
  Matrix turnA, turnB;
  Quat qa, qb;
  Vec3 apart;            ///< from A's centre to B's, world axes
  bool placedA = false;  ///< turnA is that of A

  void place(const BodyData& a, const BodyData& b) {
    if (!placedA) turnA = matrixOf(a.rotation), qa = a.rotation, placedA = true;
    turnB = matrixOf(b.rotation), qb = b.rotation;
    apart = toFloat(b.position - a.position);
  }
};

/// What a kept manifold is expected to be.
struct ExpectedKept {
  Vec3 offset, normal;
  Quat turn;
  Vec3 point[kMaxManifoldPoints];  ///< without the half height along the normal
  float height[kMaxManifoldPoints] = {};

  ExpectedKept(const PairData& pair, KeptManifold::What what, const BodiesApart& bodies) {
    const bool ofB = what == KeptManifold::What::PointsOnB;
    const Matrix& base = ofB ? bodies.turnB : bodies.turnA;
    const Vec3 n = pair.manifold.normal;
    offset = transposed(base, ofB ? -bodies.apart : bodies.apart);
    turn = ofB ? conjugate(bodies.qb) * bodies.qa : conjugate(bodies.qa) * bodies.qb;
    normal = transposed(base, ofB ? -n : n);
    for (int k = 0; k < pair.manifold.count; ++k) {
      const Vec3 at = pair.manifold.points[k].position;
      point[k] = transposed(base, ofB ? at - bodies.apart : at);
      height[k] = pair.manifold.points[k].separation;
    }
  }
};

/// As the engine computes it.
inline float reachOf(const WorldData& data, const PairData& pair, const KeptManifold& kept) {
  const auto radius = [&](uint32_t shape, uint32_t body) {
    const bool bounded = data.shapes[shape].geom.type != ShapeType::HalfSpace;
    return bounded && body != kNone ? data.bodies[body].radius : std::numeric_limits<float>::infinity();
  };
  const float a = radius(pair.shapeA, pair.bodyA), b = radius(pair.shapeB, pair.bodyB);
  const bool ofB = kept.what == KeptManifold::What::PointsOnB;
  return kept.aroundBase ? (ofB ? b : a) + kept.clear : (ofB ? a : b);
}

// Head: what (2 bits), aroundBase, another reach, count of points (3 bits). Then the ways of offset, turn, the turn's w
// and normal; then, where there are points, those of each point and height.
constexpr uint8_t kAroundBase = 1u << 2, kOtherReach = 1u << 3;
constexpr int kKeptCountAt = 4;

inline bool keepsManifold(const std::byte* head) { return (static_cast<uint8_t>(*head) & 3u) != 0; }

template <class T>
void overwrite(std::byte* at, const T& value) {
  std::memcpy(at, &value, sizeof(value));
}

inline void writeKeptPoints(std::byte*& to, const KeptManifold& kept, int count, const ExpectedKept& expected) {
  std::byte* const ways = to;
  to += sizeof(uint16_t);
  uint32_t bits = 0;
  for (int k = 0; k < count; ++k) {
    bits |= putNear(to, kept.height[k], expected.height[k]) << (8 + 2 * k);
    const Vec3 at = expected.point[k] + kept.normal * (0.5f * kept.height[k]);
    bits |= putNear(to, Vec3{kept.x[k], kept.y[k], kept.z[k]}, at) << 2 * k;
  }
  overwrite(ways, static_cast<uint16_t>(bits));
}

inline int keptPoints(const KeptManifold& kept) {
  int count = kMaxManifoldPoints;
  constexpr float kZero = 0;
  const auto none = [&](int k) {
    return same(kept.x[k], kZero) && same(kept.y[k], kZero) && same(kept.z[k], kZero) && same(kept.height[k], kZero);
  };
  while (count > 0 && none(count - 1)) --count;
  return count;
}

inline void writeKept(std::byte*& to, const PairData& pair, const WorldData& data, const BodiesApart& bodies) {
  // All members by name: a new one does not compile before it is written here and read below.
  auto& [what, aroundBase, offset, turn, clear, reach, normal, x, y, z, height] = pair.kept;
  if (!keepsPoints(pair.kept)) return put(to, uint8_t{0});
  const ExpectedKept expected(pair, what, bodies);
  const int count = keptPoints(pair.kept);
  const bool otherReach = !same(reach, reachOf(data, pair, pair.kept));
  const uint32_t head = static_cast<uint32_t>(what) | (aroundBase ? kAroundBase : 0u) |
                        (otherReach ? kOtherReach : 0u) | static_cast<uint32_t>(count) << kKeptCountAt;
  put(to, static_cast<uint8_t>(head));
  std::byte* const ways = to;
  to += sizeof(uint8_t);
  put(to, clear);
  if (otherReach) put(to, reach);
  uint32_t bits = putNear(to, offset, expected.offset);
  bits |= putNear(to, Vec3{turn.x, turn.y, turn.z}, Vec3{expected.turn.x, expected.turn.y, expected.turn.z}) << 2;
  bits |= putNear(to, turn.w, expected.turn.w) << 4;
  bits |= putNear(to, normal, expected.normal) << 6;
  overwrite(ways, static_cast<uint8_t>(bits));
  writeKeptPoints(to, pair.kept, count, expected);
}

inline void readKeptPoints(const std::byte*& from, KeptManifold& kept, int count, const ExpectedKept& expected) {
  uint16_t bits = 0;
  put(from, bits);
  for (int k = 0; k < count; ++k) {
    putNear(from, kept.height[k], expected.height[k], bits >> (8 + 2 * k) & 3u);
    Vec3 p;
    putNear(from, p, expected.point[k] + kept.normal * (0.5f * kept.height[k]), bits >> 2 * k & 3u);
    kept.x[k] = p.x, kept.y[k] = p.y, kept.z[k] = p.z;
  }
}

inline void readKept(const std::byte*& from, PairData& pair, const WorldData& data, const BodiesApart& bodies) {
  KeptManifold& kept = pair.kept;
  kept = {};
  uint8_t head = 0, ways = 0;
  put(from, head);
  const uint32_t what = head & 3u;
  const int count = head >> kKeptCountAt;
  if (head == 0) return;
  require(what > static_cast<uint32_t>(KeptManifold::What::Apart) && count <= kMaxManifoldPoints,
          "a manifold kept in no way");
  kept.what = static_cast<KeptManifold::What>(what);
  kept.aroundBase = (head & kAroundBase) != 0;
  const ExpectedKept expected(pair, kept.what, bodies);
  put(from, ways);
  put(from, kept.clear);
  kept.reach = reachOf(data, pair, kept);
  if (head & kOtherReach) put(from, kept.reach);
  putNear(from, kept.offset, expected.offset, ways & 3u);
  Vec3 turn;
  putNear(from, turn, Vec3{expected.turn.x, expected.turn.y, expected.turn.z}, ways >> 2 & 3u);
  kept.turn = {0, turn.x, turn.y, turn.z};
  putNear(from, kept.turn.w, expected.turn.w, ways >> 4 & 3u);
  putNear(from, kept.normal, expected.normal, ways >> 6 & 3u);
  readKeptPoints(from, kept, count, expected);
}

}  // namespace avbd::snapshot
