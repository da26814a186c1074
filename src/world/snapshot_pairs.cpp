// Snapshots: pairs, most of what a snapshot of a pile holds.
//
// A pair is coded by hand, as most of it follows from something else: its bodies from its shapes, two axes of its basis
// from the third, one manifold from the other (snapshot_kept.h), and where a point stuck from where it is. Only what
// does not follow is written. What follows is computed as the step computes it, the same on every processor.
#include <algorithm>

#include "avbd/rows/math.h"
#include "world/snapshot_parts.h"
#include "world/snapshot_points.h"

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

/// bodyA, bodyB, generations.
using Ends = std::array<uint32_t, 6>;
Ends endsOf(const PairData& p) {
  return {p.bodyA, p.bodyB, p.generation[0], p.generation[1], p.generation[2], p.generation[3]};
}
void setEnds(PairData& pair, const Ends& ends) {
  pair.bodyA = ends[0], pair.bodyB = ends[1];
  std::copy(ends.begin() + 2, ends.end(), pair.generation);
}

/// A pair of which nothing is to tell but that it is there: about half of them.
struct QuietLook {
  uint16_t flags = 0, material = 0;
  Coefficients coefficients{};
  bool operator==(const QuietLook& other) const {
    return flags == other.flags && material == other.material && same(coefficients, other.coefficients);
  }
};

QuietLook lookOf(const PairData& pair) { return {flagsOf(pair), pair.material, coefficientsOf(pair)}; }

bool isQuiet(const PairData& p) {
  return p.pointCount == 0 && p.gonePoints == 0 && p.mean == kNone && p.slides == 0 && p.patch == 0 &&
         p.element == kNoElement && !keepsPoints(p.kept) && !p.hasContact() && same(p.turn, Vec3{}) &&
         same(p.torque, Vec3{});
}

/// What is known of a pair before it is read.
struct Expected {
  uint32_t shapeA = kNone;
  Ends ends{};
  uint16_t flags = 0, material = 0;
  uint8_t slides = 0;
  Vec3d origin;
  Coefficients coefficients{};
  uint32_t mean = 0;  ///< the next
  uint32_t feature = 0;
  QuietLook quiet;

  /// The pair's shapes are known.
  void meet(const PairSides& sides, const PairData& pair, bool sameA) {
    if (!sameA) meetA(sides[pair.shapeA]);
    const PairSide& side = sides[pair.shapeB];
    ends[1] = side.body;
    ends[3] = side.shapeGeneration;
    ends[5] = side.bodyGeneration;
  }

 private:
  void meetA(const PairSide& side) {
    ends[0] = side.body;
    ends[2] = side.shapeGeneration;
    ends[4] = side.bodyGeneration;
    origin = side.last.position;
  }
};

/// More than any pair takes.
constexpr size_t kPairBytes = 768;

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
constexpr int kPointsAt = 17, kGoneAt = 20, kManifoldAt = 23, kFollowsAt = 26, kPairBits = 29;
constexpr uint32_t kQuiet = 1u << 28;

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

/// Of a pair that has a contact. `normal`: what the manifold's is expected to be.
void writeBasis(std::byte*& to, uint32_t& bits, const PairData& pair, Vec3 normal, Expected& expected) {
  putNew(to, bits, kOrigin, pair.origin, expected.origin);
  putOther(to, bits, kNormal, pair.normal, normal);
  putOther(to, bits, kManifoldNormal, pair.manifold.normal, pair.normal);
  const Basis basis = basisOf(pair.normal);
  if (!same(pair.t1, basis.t1) || !same(pair.t2, basis.t2)) bits |= kBasis, put(to, pair.t1), put(to, pair.t2);
}

void readBasis(const std::byte*& from, uint32_t bits, PairData& pair, Vec3 normal, Expected& expected) {
  putNew(from, bits, kOrigin, pair.origin, expected.origin);
  putOther(from, bits, kNormal, pair.normal, normal);
  putOther(from, bits, kManifoldNormal, pair.manifold.normal, pair.normal);
  const Basis basis = basisOf(pair.normal);
  pair.t1 = basis.t1, pair.t2 = basis.t2;
  if (bits & kBasis) put(from, pair.t1), put(from, pair.t2);
}

/// A pair's manifold and the one that it keeps, and what follows of them.
struct Manifolds {
  LastPlaces last;
  CarriedPoints carried;
  Follows follows = Follows::Nothing;

  Vec3 normal() const { return follows == Follows::Manifold ? carried.normal : Vec3{}; }
  PlacesOn places(const PairData& pair, int count) const {
    return follows == Follows::Manifold ? placesOf(carried) : placesOf(pair.manifold, count, last);
  }
};

/// What is written in front of a pair's basis.
void writeBefore(std::byte*& to, uint32_t& bits, const PairData& pair, Manifolds& all) {
  const int count = pointsOf(pair);
  if (count > 0 && count == pair.manifold.count) all.follows = whatFollows(pair, all.last, all.carried);
  bits |= static_cast<uint32_t>(all.follows) << kFollowsAt;
  if (all.follows == Follows::Manifold) writeKept(to, pair.kept, all.last, all.carried.offset, all.carried.turn);
}

void readBefore(const std::byte*& from, uint32_t bits, PairData& pair, Manifolds& all) {
  const uint32_t follows = bits >> kFollowsAt;
  require(follows <= static_cast<uint32_t>(Follows::Kept), "a pair of which something else follows");
  all.follows = static_cast<Follows>(follows);
  if (all.follows != Follows::Manifold) return;
  OtherPlace place;
  readKept(from, pair.kept, all.last, place);
  require(keepsPoints(pair.kept), "a manifold carried from none");
  carryPoints(pair.kept, place, all.carried);
  for (int i = 0; i < pair.manifold.count; ++i) pair.manifold.points[i] = pointOf(all.carried, i, 0);
}

void writeKeptAlone(std::byte*& to, const KeptManifold& kept, const LastPlaces& last) {
  if (!keepsPoints(kept) || !last.both) return put(to, uint8_t{0});
  const OtherPlace place = otherPlace(kept.what, last.a.pose, last.b.pose);
  writeKept(to, kept, last, place.offset, place.turn);
}

/// The points, and what was not written before.
void writeAfter(std::byte*& to, const PairData& pair, const Manifolds& all, Expected& expected) {
  const int count = pointsOf(pair);
  if (all.follows != Follows::Manifold)
    for (int i = 0; i < count; ++i)
      put(to, pair.manifold.points[i].separation), put(to, pair.manifold.points[i].position);
  if (count > 0) {
    const PlacesOn places = all.places(pair, count);
    for (int i = 0; i < count; ++i) writePoint(to, pair, i, places, expected.feature);
  }
  if (all.follows == Follows::Nothing) writeKeptAlone(to, pair.kept, all.last);
  if (all.follows == Follows::Kept) put(to, static_cast<uint8_t>(pair.kept.what)), put(to, pair.kept.clear);
}

void readAfter(const std::byte*& from, PairData& pair, const Manifolds& all, Expected& expected) {
  const int count = pointsOf(pair);
  if (all.follows != Follows::Manifold)
    for (int i = 0; i < count; ++i)
      put(from, pair.manifold.points[i].separation), put(from, pair.manifold.points[i].position);
  if (count > 0) {
    const PlacesOn places = all.places(pair, count);
    for (int i = 0; i < count; ++i) readPoint(from, pair, i, places, expected.feature);
  }
  OtherPlace place;
  if (all.follows == Follows::Nothing) readKept(from, pair.kept, all.last, place);
  if (all.follows != Follows::Kept) return;
  KeptManifold kept;
  uint8_t what = 0;
  put(from, what), put(from, kept.clear);
  kept.what = readWhat(what);
  pair.kept = keptOf(pair.manifold, kept.clear, carrierOf(kept), all.last);
  require(pair.kept.what == kept.what, "a manifold kept from none");
}

void writeManifolds(std::byte*& to, uint32_t& bits, const PairSides& sides, const PairData& pair, Expected& expected) {
  if (pointsOf(pair) == 0 && !keepsPoints(pair.kept)) {  // most pairs
    if (pair.hasContact()) writeBasis(to, bits, pair, {}, expected);
    return put(to, uint8_t{0});
  }
  Manifolds all{LastPlaces(sides[pair.shapeA], sides[pair.shapeB]), {}};
  writeBefore(to, bits, pair, all);
  if (pair.hasContact()) writeBasis(to, bits, pair, all.normal(), expected);
  writeAfter(to, pair, all, expected);
}

void writePair(std::byte*& to, const PairSides& sides, const PairData& pair, Expected& expected) {
  // All members by name, so that a new one does not compile before it is written here and read below.
  [[maybe_unused]] auto& [shapeA, shapeB, bodyA, bodyB, generation, patch, material, element, hasSurface, isTrigger,
                          triggerIsA, reports, wantsHits, hasHook, isFull, touching, wasTouching, touchBegins, slides,
                          landedSliding, pointCount, gonePoints, mean, kept, staticFriction, friction, restitution,
                          torsionalFriction, rollingFriction, origin, manifold, normal, t1, t2, points, turn, torque] =
      pair;
  [[maybe_unused]] auto& [newNormal, newCount, newPoints, clear, carrier] = manifold;  // the last two are no state
  std::byte* const head = to;
  to += sizeof(uint32_t);
  uint32_t bits = static_cast<uint32_t>(pointCount) << kPointsAt | uint32_t(gonePoints) << kGoneAt |
                  static_cast<uint32_t>(manifold.count) << kManifoldAt;
  putNew(to, bits, kShapeA, shapeA, expected.shapeA);
  put(to, shapeB);
  expected.meet(sides, pair, !(bits & kShapeA));
  const Ends ends = endsOf(pair);
  const bool quiet = isQuiet(pair) && ends == expected.ends;
  if (quiet && lookOf(pair) == expected.quiet) {
    bits |= kQuiet;
    std::memcpy(head, &bits, sizeof(bits));
    return;
  }
  if (quiet) expected.quiet = lookOf(pair);
  putOther(to, bits, kEnds, ends, expected.ends);
  putNew(to, bits, kFlagBits, flagsOf(pair), expected.flags);
  putOther(to, bits, kPatch, patch, uint16_t{0});
  putNew(to, bits, kMaterial, material, expected.material);
  putOther(to, bits, kElement, element, kNoElement);
  putNew(to, bits, kCoefficients, coefficientsOf(pair), expected.coefficients);
  putOther(to, bits, kTurn, turn, Vec3{});
  putOther(to, bits, kTorque, torque, Vec3{});
  putNew(to, bits, kSlides, slides, expected.slides);
  if (mean != kNone) bits |= kMean;
  if (mean != kNone && mean != expected.mean) bits |= kOtherMean, put(to, mean);
  if (mean != kNone) expected.mean = mean + 1;
  if (pointsOf(pair) == 0 && pair.hasContact()) putOther(to, bits, kLastPoint, manifold.points[0].position, Vec3{});
  writeManifolds(to, bits, sides, pair, expected);
  std::memcpy(head, &bits, sizeof(bits));
}

void readManifolds(const std::byte*& from, uint32_t bits, const PairSides& sides, PairData& pair, Expected& expected) {
  Manifolds all{LastPlaces(sides[pair.shapeA], sides[pair.shapeB]), {}};
  readBefore(from, bits, pair, all);
  if (pair.hasContact()) readBasis(from, bits, pair, all.normal(), expected);
  readAfter(from, pair, all, expected);
}

void readEnds(const std::byte*& from, uint32_t bits, PairData& pair, const Expected& expected) {
  Ends ends;
  putOther(from, bits, kEnds, ends, expected.ends);
  setEnds(pair, ends);
}

void setQuiet(PairData& pair, const Expected& expected) {
  setEnds(pair, expected.ends);
  setFlags(pair, expected.quiet.flags);
  pair.material = expected.quiet.material;
  setCoefficients(pair, expected.quiet.coefficients);
  pair.patch = 0, pair.element = kNoElement, pair.slides = 0, pair.mean = kNone;
  pair.kept.what = KeptManifold::What::Nothing;
  pair.origin = {}, pair.normal = pair.manifold.normal = pair.t1 = pair.t2 = pair.manifold.points[0].position = Vec3{};
  pair.turn = pair.torque = Vec3{};
}

void readPair(const std::byte*& from, const PairSides& sides, PairData& pair, Expected& expected) {
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
  require(pair.shapeA < sides.size() && pair.shapeB < sides.size(), "a pair of shapes that there are not");
  expected.meet(sides, pair, !(bits & kShapeA));
  if (bits & kQuiet) return setQuiet(pair, expected);
  readEnds(from, bits, pair, expected);
  uint16_t flags = 0;
  putNew(from, bits, kFlagBits, flags, expected.flags);
  require(flags <= kFlags, "a pair of unknown kind");
  setFlags(pair, flags);
  putOther(from, bits, kPatch, pair.patch, uint16_t{0});
  putNew(from, bits, kMaterial, pair.material, expected.material);
  putOther(from, bits, kElement, pair.element, kNoElement);
  pair.origin = {}, pair.normal = pair.manifold.normal = pair.t1 = pair.t2 = pair.manifold.points[0].position = Vec3{};
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
  readManifolds(from, bits, sides, pair, expected);
  if (isQuiet(pair) && endsOf(pair) == expected.ends) expected.quiet = lookOf(pair);
}

void ask(const PairList& pairs, size_t i) { pairs.prefetch(i + PairList::kAhead); }
void ask(const std::vector<PairData>&, size_t) {}

template <class List>
void writePairs(Writer& out, const PairSides& sides, const List& pairs) {
  out.number(pairs.size());
  Expected expected;
  for (size_t i = 0; i < pairs.size(); ++i) {
    const PairData& pair = pairs[i];
    ask(pairs, i);
    std::byte* to = out.room(kPairBytes);
    writePair(to, sides, pair, expected);
    out.advance(to);
  }
}

size_t countPairs(Reader& in) { return in.count(2 * sizeof(uint32_t)); }

/// Reads the pairs of a list one by one, each to its place in it.
struct PairReader {
  Reader& in;
  const WorldData& data;
  const PairSides& sides;
  Expected expected{};
  const PairData* before = nullptr;
  size_t means = 0;  ///< how many they name

  void operator()(PairData& pair) {
    const std::byte* const begin = in.piece(kPairBytes);
    const std::byte* from = begin;
    readPair(from, sides, pair, expected);
    in.advance(static_cast<size_t>(from - begin));
    checkPair(data, sides, pair, before);
    if (pair.mean != kNone) means = std::max(means, pair.mean + size_t{1});
    before = &pair;
  }
};

}  // namespace

void codePairList(Writer& out, const PairSides& sides, const std::vector<PairData>& pairs) {
  writePairs(out, sides, pairs);
}

size_t codePairList(Reader& in, const WorldData& data, const PairSides& sides, std::vector<PairData>& pairs) {
  pairs.resize(countPairs(in));
  PairReader read{in, data, sides};
  for (PairData& pair : pairs) read(pair);
  return read.means;
}

void codePairs(Writer& out, const WorldData& data, const PairSides& sides) {
  writePairs(out, sides, data.pairs);
  list(out, data.means);
}

void codePairs(Reader& in, WorldData& data, const PairSides& sides) {
  PairReader read{in, data, sides};
  data.pairs.assign(countPairs(in), read);
  list(in, data.means);
  require(read.means <= data.means.size(), "a pair's means");
}

}  // namespace avbd::snapshot
