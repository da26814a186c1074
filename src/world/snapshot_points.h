// Snapshots: the points of a pair, what they remember and where they stick.
#pragma once

#include "world/snapshot_kept.h"

namespace avbd::snapshot {

/// Where the points would stick if they did so now.
struct PlacesOn {
  Vec3 a[kMaxManifoldPoints], b[kMaxManifoldPoints];
};

inline PlacesOn placesOf(const CarriedPoints& points) {
  const PlacesOnBodies on = placesOnBodies(points);
  PlacesOn places;
  for (int i = 0; i < kMaxManifoldPoints; ++i) {
    places.a[i] = {on.a.x[i], on.a.y[i], on.a.z[i]};
    places.b[i] = {on.b.x[i], on.b.y[i], on.b.z[i]};
  }
  return places;
}

inline PlacesOn placesOf(const Manifold& manifold, int count, const LastPlaces& last) {
  const Quat a = conjugate(last.a.pose.q), b = conjugate(last.b.pose.q);
  PlacesOn places;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = manifold.points[i].position;
    places.a[i] = rotate(a, at);
    places.b[i] = rotate(b, at - last.b.pose.p);
  }
  return places;
}

// Bits of a point's head: in two the bytes of its name, then flags, then the ways of the anchors.
constexpr uint32_t kOtherName = 1u << 2, kPushes = 1u << 3, kRebounds = 1u << 4, kOtherSticks = 1u << 5;
constexpr int kAnchorAAt = 6, kAnchorBAt = 8;
constexpr uint32_t kStopped = 1u << 10;
constexpr uint32_t kPointBits = (1u << 11) - 1;

inline uint32_t bytesOfName(uint32_t bits) { return 0x4210u >> 4 * (bits & 3u) & 15u; }

/// `expected`: the name, which becomes that of the point.
inline void writePoint(std::byte*& to, const PairData& pair, int i, const PlacesOn& places, uint32_t& expected) {
  const uint32_t name = pair.manifold.points[i].feature;
  auto& [feature, lambda, anchorA, anchorB, rebound, impact, sticks] = pair.points[i];
  std::byte* const head = to;
  to += sizeof(uint16_t);
  const uint32_t change = name ^ expected;
  uint32_t bits = change == 0 ? 0 : change < 1u << 8 ? 1 : change < 1u << 16 ? 2 : 3;
  std::memcpy(to, &change, sizeof(change));
  to += bytesOfName(bits);
  expected = name;
  if (feature != name) bits |= kOtherName, put(to, feature);
  const bool pushes = !same(lambda, Vec3{});
  bits |= pushes ? kPushes : 0;
  putIf(to, pushes, lambda);
  if (!same(rebound, 0.0f)) bits |= kRebounds, put(to, rebound);
  if (!same(impact, 0.0f)) bits |= kStopped, put(to, impact);
  bits |= sticks != 1 ? kOtherSticks : 0;
  putIf(to, sticks != 1, sticks);
  bits |= putNear(to, anchorA, places.a[i]) << kAnchorAAt;
  bits |= putNear(to, anchorB, places.b[i]) << kAnchorBAt;
  const auto stored = static_cast<uint16_t>(bits);
  std::memcpy(head, &stored, sizeof(stored));
}

inline void readPoint(const std::byte*& from, PairData& pair, int i, const PlacesOn& places, uint32_t& expected) {
  PointMemory& point = pair.points[i];
  uint16_t bits = 0;
  put(from, bits);
  require(bits <= kPointBits, "a point of unknown flags");
  uint32_t change = 0;
  std::memcpy(&change, from, sizeof(change));
  const uint32_t width = bytesOfName(bits);
  from += width;
  expected ^= width == 0 ? 0 : change & 0xffffffffu >> (8 * (4 - width));
  point = {};
  pair.manifold.points[i].feature = point.feature = expected;
  point.sticks = 1;
  if (bits & kOtherName) put(from, point.feature);
  if (bits & kPushes) put(from, point.lambda);
  if (bits & kRebounds) put(from, point.rebound);
  if (bits & kStopped) put(from, point.impact);
  if (bits & kOtherSticks) put(from, point.sticks);
  putNear(from, point.anchorA, places.a[i], bits >> kAnchorAAt & 3u);
  putNear(from, point.anchorB, places.b[i], bits >> kAnchorBAt & 3u);
}

}  // namespace avbd::snapshot
