// Snapshots: pairs, most of what a snapshot of a pile holds.
//
// A pair is coded by hand, as most of it follows from something else: its bodies from its shapes, two axes of its basis
// from the third, and where a point is from where it stuck. Only what does not follow is written. What follows is
// computed with +, - and * alone, the same on every processor.
#include <algorithm>

#include "avbd/rows/math.h"
#include "world/snapshot_kept.h"
#include "world/snapshot_parts.h"

namespace avbd::snapshot {
namespace {

/// Yes and no of a pair as bits.
template <class Pair, class F>
void eachFlag(Pair& pair, F&& f) {
  f(pair.hasSurface), f(pair.isTrigger), f(pair.triggerIsA), f(pair.reports), f(pair.wantsHits), f(pair.hasHook);
  f(pair.isFull), f(pair.touching), f(pair.wasTouching), f(pair.touchBegins), f(pair.landedSliding);
}
constexpr uint16_t kFlags = (1u << 11) - 1;

uint16_t flagsOf(const PairData& pair) {
  uint16_t flags = 0;
  int bit = 0;
  eachFlag(pair, [&](bool flag) { flags = static_cast<uint16_t>(flags | flag << bit++); });
  return flags;
}

void setFlags(PairData& pair, uint16_t flags) {
  int bit = 0;
  eachFlag(pair, [&](bool& flag) { flag = (flags >> bit++ & 1) != 0; });
}

/// The coefficients of a pair; of a pile they are all the same.
using Coefficients = std::array<float, 5>;
Coefficients coefficientsOf(const PairData& p) {
  return {p.staticFriction, p.friction, p.restitution, p.torsionalFriction, p.rollingFriction};
}
void setCoefficients(PairData& p, const Coefficients& c) {
  p.staticFriction = c[0], p.friction = c[1], p.restitution = c[2], p.torsionalFriction = c[3],
  p.rollingFriction = c[4];
}

/// Across a pair's normal, as the step makes it.
struct Basis {
  Vec3 t1, t2;
};
Basis basisOf(Vec3 n) {
  if (n == Vec3{}) return {};
  rows::V3<float> t1, t2;
  rows::orthonormalBasis(rows::V3<float>{n.x, n.y, n.z}, t1, t2);
  return {{t1.x, t1.y, t1.z}, {t2.x, t2.y, t2.z}};
}

/// What is known of a pair before it is read.
struct Expected {
  uint32_t shapeA = kNone;
  std::array<uint32_t, 6> ends{};  ///< bodyA, bodyB, generations
  uint16_t flags = 0, material = 0;
  uint8_t slides = 0;
  Vec3d origin;
  Coefficients coefficients{};
  uint32_t mean = 0;  ///< the next
  uint32_t feature = 0;
  BodiesApart bodies;

  /// The pair's shapes are known.
  void meet(const WorldData& data, const PairData& pair, bool sameA) {
    if (!sameA) meetA(data, pair.shapeA);
    const uint32_t bodyB = data.shapes[pair.shapeB].body;
    ends[1] = bodyB;
    ends[3] = data.shapeIds.id(pair.shapeB).generation;
    ends[5] = bodyB == kNone ? 0 : data.bodyIds.id(bodyB).generation;
  }
  /// It has points, or keeps a manifold.
  void touch(const WorldData& data) {
    if (ends[0] != kNone && ends[1] != kNone) bodies.place(data.bodies[ends[0]], data.bodies[ends[1]]);
  }

 private:
  void meetA(const WorldData& data, uint32_t shape) {
    const uint32_t body = data.shapes[shape].body;
    ends[0] = body;
    ends[2] = data.shapeIds.id(shape).generation;
    ends[4] = body == kNone ? 0 : data.bodyIds.id(body).generation;
    if (body != kNone) origin = data.bodies[body].position;
    bodies.placedA = false;
  }
};

/// More than any pair takes.
constexpr size_t kPairBytes = 768;

// Bits of a point's head.
constexpr uint32_t kOtherName = 1u << 2, kPushes = 1u << 3, kRebounds = 1u << 4, kOtherSticks = 1u << 5;
constexpr int kPlaceAt = 6, kAnchorAt = 8;
constexpr uint32_t kStopped = 1u << 10;
constexpr uint32_t kPointBits = (1u << 11) - 1;

void writePoint(std::byte*& to, const PairData& pair, int i, Expected& expected) {
  const ManifoldPoint& place = pair.manifold.points[i];
  const PointMemory& point = pair.points[i];
  auto& [feature, lambda, anchorA, anchorB, rebound, impact, sticks] = point;
  std::byte* const head = to;
  to += sizeof(uint16_t);
  const uint32_t name = place.feature ^ expected.feature;
  uint32_t bits = name == 0 ? 0 : name < 1u << 8 ? 1 : name < 1u << 16 ? 2 : 3;
  std::memcpy(to, &name, sizeof(name));
  to += (0x4210u >> 4 * bits) & 15u;
  expected.feature = place.feature;
  if (feature != place.feature) bits |= kOtherName, put(to, feature);
  if (lambda != Vec3{} || !same(lambda, Vec3{})) bits |= kPushes, put(to, lambda);
  if (!same(rebound, 0.0f)) bits |= kRebounds, put(to, rebound);
  if (!same(impact, 0.0f)) bits |= kStopped, put(to, impact);
  if (sticks != 1) bits |= kOtherSticks, put(to, sticks);
  put(to, place.separation);
  put(to, anchorA);
  const Vec3 arm = expected.bodies.turnA * anchorA;
  bits |= putNear(to, place.position, arm) << kPlaceAt;
  bits |= putNear(to, anchorB, transposed(expected.bodies.turnB, arm - expected.bodies.apart)) << kAnchorAt;
  const auto stored = static_cast<uint16_t>(bits);
  std::memcpy(head, &stored, sizeof(stored));
}

void readPoint(const std::byte*& from, PairData& pair, int i, Expected& expected) {
  ManifoldPoint& place = pair.manifold.points[i];
  PointMemory& point = pair.points[i];
  uint16_t bits = 0;
  put(from, bits);
  require(bits <= kPointBits, "a point of unknown flags");
  uint32_t name = 0;
  std::memcpy(&name, from, sizeof(name));
  const uint32_t width = (0x4210u >> 4 * (bits & 3u)) & 15u;
  from += width;
  name = width == 0 ? 0 : name & 0xffffffffu >> (8 * (4 - width));
  expected.feature ^= name;
  point = {};
  place.feature = point.feature = expected.feature;
  point.sticks = 1;
  if (bits & kOtherName) put(from, point.feature);
  if (bits & kPushes) put(from, point.lambda);
  if (bits & kRebounds) put(from, point.rebound);
  if (bits & kStopped) put(from, point.impact);
  if (bits & kOtherSticks) put(from, point.sticks);
  put(from, place.separation);
  put(from, point.anchorA);
  const Vec3 arm = expected.bodies.turnA * point.anchorA;
  putNear(from, place.position, arm, bits >> kPlaceAt & 3u);
  putNear(from, point.anchorB, transposed(expected.bodies.turnB, arm - expected.bodies.apart), bits >> kAnchorAt & 3u);
}

// Bits of a pair's head.
enum : uint32_t {
  kShapeA = 1u << 0,
  kEnds = 1u << 1,
  kFlagBits = 1u << 2,
  kPatch = 1u << 3,
  kMaterial = 1u << 4,
  kElement = 1u << 5,
  kOrigin = 1u << 6,
  kNormal = 1u << 7,
  kManifoldNormal = 1u << 8,
  kBasis = 1u << 9,
  kCoefficients = 1u << 10,
  kTurn = 1u << 11,
  kTorque = 1u << 12,
  kSlides = 1u << 13,
  kMean = 1u << 14,
  kOtherMean = 1u << 15,
  kLastPoint = 1u << 16,
};
constexpr int kPointsAt = 17, kGoneAt = 20, kManifoldAt = 23, kPairBits = 26;

int pointsOf(const PairData& pair) {
  return std::max({pair.manifold.count, pair.pointCount, static_cast<int>(pair.gonePoints)});
}

/// Writes a value and sets its bit where it is not the expected one, which becomes this.
template <class T>
void putNew(std::byte*& to, uint32_t& bits, uint32_t bit, const T& now, T& expected) {
  if (same(now, expected)) return;
  bits |= bit;
  put(to, now);
  expected = now;
}
template <class T>
void putNew(const std::byte*& from, uint32_t bits, uint32_t bit, T& now, T& expected) {
  if (bits & bit) put(from, expected);
  now = expected;
}
/// The same of what is expected to be this.
template <class T>
void putOther(std::byte*& to, uint32_t& bits, uint32_t bit, const T& now, const T& expected) {
  if (same(now, expected)) return;
  bits |= bit;
  put(to, now);
}
template <class T>
void putOther(const std::byte*& from, uint32_t bits, uint32_t bit, T& now, const T& expected) {
  if (bits & bit)
    put(from, now);
  else
    now = expected;
}

/// Of a pair that has a contact.
void writeBasis(std::byte*& to, uint32_t& bits, const PairData& pair, Expected& expected) {
  putNew(to, bits, kOrigin, pair.origin, expected.origin);
  putOther(to, bits, kNormal, pair.normal, Vec3{});
  putOther(to, bits, kManifoldNormal, pair.manifold.normal, pair.normal);
  const Basis basis = basisOf(pair.normal);
  if (!same(pair.t1, basis.t1) || !same(pair.t2, basis.t2)) bits |= kBasis, put(to, pair.t1), put(to, pair.t2);
}

void readBasis(const std::byte*& from, uint32_t bits, PairData& pair, Expected& expected) {
  putNew(from, bits, kOrigin, pair.origin, expected.origin);
  putOther(from, bits, kNormal, pair.normal, Vec3{});
  putOther(from, bits, kManifoldNormal, pair.manifold.normal, pair.normal);
  const Basis basis = basisOf(pair.normal);
  pair.t1 = basis.t1, pair.t2 = basis.t2;
  if (bits & kBasis) put(from, pair.t1), put(from, pair.t2);
}

void writePair(std::byte*& to, const WorldData& data, const PairData& pair, Expected& expected) {
  // All members by name, so that a new one does not compile before it is written here and read below.
  auto& [shapeA, shapeB, bodyA, bodyB, generation, patch, material, element, hasSurface, isTrigger, triggerIsA, reports,
         wantsHits, hasHook, isFull, touching, wasTouching, touchBegins, slides, landedSliding, pointCount, gonePoints,
         mean, kept, staticFriction, friction, restitution, torsionalFriction, rollingFriction, origin, manifold,
         normal, t1, t2, points, turn, torque] = pair;
  [[maybe_unused]] auto& [newNormal, newCount, newPoints, clear, carrier] = manifold;  // the last two are no state
  std::byte* const head = to;
  to += sizeof(uint32_t);
  uint32_t bits = static_cast<uint32_t>(pointCount) << kPointsAt | uint32_t(gonePoints) << kGoneAt |
                  static_cast<uint32_t>(manifold.count) << kManifoldAt;
  putNew(to, bits, kShapeA, shapeA, expected.shapeA);
  put(to, shapeB);
  expected.meet(data, pair, !(bits & kShapeA));
  const std::array<uint32_t, 6> ends = {bodyA, bodyB, generation[0], generation[1], generation[2], generation[3]};
  putOther(to, bits, kEnds, ends, expected.ends);
  putNew(to, bits, kFlagBits, flagsOf(pair), expected.flags);
  putOther(to, bits, kPatch, patch, uint16_t{0});
  putNew(to, bits, kMaterial, material, expected.material);
  putOther(to, bits, kElement, element, kNoElement);
  if (pair.hasContact()) writeBasis(to, bits, pair, expected);
  putNew(to, bits, kCoefficients, coefficientsOf(pair), expected.coefficients);
  putOther(to, bits, kTurn, turn, Vec3{});
  putOther(to, bits, kTorque, torque, Vec3{});
  putNew(to, bits, kSlides, slides, expected.slides);
  if (mean != kNone) bits |= kMean;
  if (mean != kNone && mean != expected.mean) bits |= kOtherMean, put(to, mean);
  if (mean != kNone) expected.mean = mean + 1;
  const int count = pointsOf(pair);
  if (count == 0 && pair.hasContact()) putOther(to, bits, kLastPoint, manifold.points[0].position, Vec3{});
  if (count > 0 || keepsPoints(kept)) expected.touch(data);
  for (int i = 0; i < count; ++i) writePoint(to, pair, i, expected);
  writeKept(to, pair, data, expected.bodies);
  std::memcpy(head, &bits, sizeof(bits));
}

void readEnds(const std::byte*& from, uint32_t bits, PairData& pair, const Expected& expected) {
  std::array<uint32_t, 6> ends;
  putOther(from, bits, kEnds, ends, expected.ends);
  pair.bodyA = ends[0], pair.bodyB = ends[1];
  std::copy(ends.begin() + 2, ends.end(), pair.generation);
}

void readPair(const std::byte*& from, const WorldData& data, PairData& pair, Expected& expected) {
  uint32_t bits = 0;
  put(from, bits);
  require(bits >> kPairBits == 0, "a pair of unknown flags");
  pair.pointCount = static_cast<int32_t>(bits >> kPointsAt & 7u);
  pair.gonePoints = static_cast<uint8_t>(bits >> kGoneAt & 7u);
  pair.manifold.count = static_cast<int>(bits >> kManifoldAt & 7u);
  pair.manifold.clear = 0, pair.manifold.carrier = Carrier::None;
  const int count = pointsOf(pair);
  require(count <= kMaxManifoldPoints, "a pair of too many points");
  putNew(from, bits, kShapeA, pair.shapeA, expected.shapeA);
  put(from, pair.shapeB);
  require(pair.shapeA < data.shapes.size() && pair.shapeB < data.shapes.size(), "a pair of shapes that there are not");
  expected.meet(data, pair, !(bits & kShapeA));
  readEnds(from, bits, pair, expected);
  uint16_t flags = 0;
  putNew(from, bits, kFlagBits, flags, expected.flags);
  require(flags <= kFlags, "a pair of unknown kind");
  setFlags(pair, flags);
  putOther(from, bits, kPatch, pair.patch, uint16_t{0});
  putNew(from, bits, kMaterial, pair.material, expected.material);
  putOther(from, bits, kElement, pair.element, kNoElement);
  pair.origin = {}, pair.normal = pair.manifold.normal = pair.t1 = pair.t2 = pair.manifold.points[0].position = Vec3{};
  if (pair.hasContact()) readBasis(from, bits, pair, expected);
  Coefficients coefficients;
  putNew(from, bits, kCoefficients, coefficients, expected.coefficients);
  setCoefficients(pair, coefficients);
  putOther(from, bits, kTurn, pair.turn, Vec3{});
  putOther(from, bits, kTorque, pair.torque, Vec3{});
  putNew(from, bits, kSlides, pair.slides, expected.slides);
  pair.mean = bits & kMean ? expected.mean : kNone;
  if (bits & kOtherMean) put(from, pair.mean);
  if (bits & kMean) expected.mean = pair.mean + 1;
  if (count == 0 && pair.hasContact()) putOther(from, bits, kLastPoint, pair.manifold.points[0].position, Vec3{});
  if (count > 0) expected.touch(data);
  for (int i = 0; i < count; ++i) readPoint(from, pair, i, expected);
  if (count == 0 && keepsManifold(from)) expected.touch(data);
  readKept(from, pair, data, expected.bodies);
}

template <class List>
void writePairs(Writer& out, const WorldData& data, const List& pairs) {
  out.number(pairs.size());
  Expected expected;
  for (const PairData& pair : pairs) {
    std::byte* to = out.room(kPairBytes);
    writePair(to, data, pair, expected);
    out.advance(to);
  }
}

size_t countPairs(Reader& in) { return in.count(2 * sizeof(uint32_t)); }

/// Reads the pairs of a list one by one, each to its place in it.
struct PairReader {
  Reader& in;
  const WorldData& data;
  Expected expected{};
  const PairData* before = nullptr;
  size_t means = 0;  ///< how many they name

  void operator()(PairData& pair) {
    const std::byte* const begin = in.piece(kPairBytes);
    const std::byte* from = begin;
    readPair(from, data, pair, expected);
    in.advance(static_cast<size_t>(from - begin));
    checkPair(data, pair, before);
    if (pair.mean != kNone) means = std::max(means, pair.mean + size_t{1});
    before = &pair;
  }
};

}  // namespace

void codePairList(Writer& out, const WorldData& data, const std::vector<PairData>& pairs) {
  writePairs(out, data, pairs);
}

size_t codePairList(Reader& in, const WorldData& data, std::vector<PairData>& pairs) {
  pairs.resize(countPairs(in));
  PairReader read{in, data};
  for (PairData& pair : pairs) read(pair);
  return read.means;
}

void codePairs(Writer& out, const WorldData& data) {
  writePairs(out, data, data.pairs);
  list(out, data.means);
}

void codePairs(Reader& in, WorldData& data) {
  PairReader read{in, data};
  data.pairs.assign(countPairs(in), read);
  list(in, data.means);
  require(read.means <= data.means.size(), "a pair's means");
}

}  // namespace avbd::snapshot
