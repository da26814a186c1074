// Conjugate gradients over the islands of a batch.
//
// With the forces and weights of an outer iteration frozen, H x = -gradient is solved for all islands of the batch in
// step, each with its own coefficients. Islands with exact trees run projected conjugate gradients: the first
// application of the preconditioner meets the joints' violations, all later ones stay in the null space of J, and the
// residual gives up what the joints carry (r -= J^T mu) so that it does not drown in rounding.
#include "solve/krylov.h"

#include <algorithm>
#include <array>

#include "avbd/rows/sinks.h"
#include "solve/body_rows.h"
#include "solve/linked_joint.h"
#include "solve/locks.h"
#include "solve/parts.h"
#include "solve/scalar_joint.h"
#include "solve/swept_contact.h"

namespace avbd {

namespace {

constexpr float kSettled = 3e-5f;           ///< relative change of a tree's pose that ends its outer iterations
constexpr float kRelativeResidual = 1e-9f;  ///< of r . M^-1 r, squared norm: an island below it is solved
/// The same with elements: their energy is not quadratic, and the next outer iteration, whose products cost the most
/// there, goes on from a better place.
constexpr float kRelativeResidualSoft = 1e-3f;

/// All bodies stand in trees, which factor their own blocks.
bool isForest(const BatchView& view, const Forest* forest) { return forest && forest->nodes.size() == view.bodies; }

/// The preconditioner solves the island in one go.
bool isExact(const IslandRange& island) { return island.hasTree && !island.coupled; }

enum class Phase { Start, First, Outer, Newton };

bool any(const std::vector<uint8_t>& islands) { return std::find(islands.begin(), islands.end(), 1) != islands.end(); }

class Krylov {
 public:
  Krylov(const BatchView& view, const KrylovTools& tools, Forest* forest, KrylovScratch& scratch)
      : v_(view), k_(tools.backend), parts_(view, tools.jobs), forest_(forest), s_(scratch) {
    s_.rz.assign(v_.islands, 0);
    s_.limit.assign(v_.islands, 0);
    s_.step.assign(v_.islands, 0);
    s_.active = s_.unsolved;
  }

  /// The residual r and all else of the search is at its start; of islands without trees z and products too.
  void solve(int iterations) {
    begin();
    for (int i = 0; i < iterations && any(s_.active); ++i) {
      parts_.chunks([&](const Chunk& chunk) {
        spread(chunk.rows);
        k_.turnAndMultiply(v_, chunk.rows);
        k_.multiplyContacts(v_, chunk.tiles);
      });
      multiplyAcross();
      parts_.chunks([&](const Chunk& chunk) { k_.dotRows(v_, v_.p, v_.q, chunk.rows); });
      for (uint32_t n = 0; n < v_.islands; ++n) chooseLength(n);
      const bool last = i + 1 == iterations;
      parts_.chunks([&](const Chunk& chunk) {
        spread(chunk.rows);
        if (last || forest_)
          k_.advance(v_, chunk.rows);
        else
          k_.advanceAndPrecondition(v_, chunk.rows);
      });
      if (last) break;
      if (forest_) precondition(false);
      for (uint32_t n = 0; n < v_.islands; ++n) chooseTurn(n);
    }
  }

  /// q = H p.
  void product() {
    parts_.chunks([&](const Chunk& chunk) {
      k_.multiplyRows(v_, chunk.rows);
      k_.multiplyContacts(v_, chunk.tiles);
    });
    multiplyAcross();
  }

 private:
  /// A step of each island's to its rows.
  void spread(Slice rows) {
    if (v_.islands == 1) {
      std::fill(v_.step + rows.begin, v_.step + std::min(rows.end, v_.bodies), s_.step[0]);
      return;
    }
    for (uint32_t n = 0; n < v_.islands; ++n)
      std::fill(v_.step + v_.island[n].begin, v_.step + v_.island[n].end, s_.step[n]);
  }

  /// What couples chunks.
  void multiplyAcross() {
    parts_.seams([&](Slice tiles) { k_.multiplyContacts(v_, tiles); });
    k_.multiplyOthers(v_);
    multiplyLinked(v_, s_.active.data());
    clearLocked(v_, v_.q);
  }

  void precondition(bool violated) {
    if (!isForest(v_, forest_)) parts_.chunks([&](const Chunk& chunk) { k_.precondition(v_, chunk.rows); });
    forest_->solve(v_, s_.active.data(), violated);
    parts_.chunks([&](const Chunk& chunk) { k_.dotRows(v_, v_.r, v_.z, chunk.rows); });
  }

  float sum(uint32_t n) const { return k_.sum(v_.product, v_.island[n].begin, v_.island[n].end); }

  void begin() {
    if (forest_) {
      meetViolations();
      if (!any(s_.active)) return;
      precondition(false);
    }
    for (uint32_t n = 0; n < v_.islands; ++n) {
      if (!s_.active[n]) continue;
      s_.rz[n] = sum(n);
      s_.limit[n] = std::max((v_.deform ? kRelativeResidualSoft : kRelativeResidual) * s_.rz[n], s_.least[n]);
      s_.active[n] = s_.rz[n] > s_.least[n];
    }
  }

  /// x = the preconditioner's answer on islands with trees; exact, and final, where nothing else couples bodies.
  void meetViolations() {
    precondition(true);
    for (uint32_t n = 0; n < v_.islands; ++n) {
      const IslandRange& island = v_.island[n];
      if (!island.hasTree || !s_.active[n]) continue;
      std::copy(v_.z + 8 * island.begin, v_.z + 8 * island.end, v_.p + 8 * island.begin);
      std::copy(v_.z + 8 * island.begin, v_.z + 8 * island.end, v_.x + 8 * island.begin);
      if (!island.coupled) s_.active[n] = 0;
    }
    if (!any(s_.active)) return;
    product();
    for (uint32_t n = 0; n < v_.islands; ++n) {
      const IslandRange& island = v_.island[n];
      if (!island.hasTree || !s_.active[n]) continue;
      for (uint32_t i = 8 * island.begin; i < 8 * island.end; ++i) v_.r[i] -= v_.q[i];
    }
  }

  void chooseLength(uint32_t n) {
    s_.step[n] = 0;
    if (!s_.active[n]) return;
    const float pq = sum(n);
    if (pq > 0)
      s_.step[n] = s_.rz[n] / pq;
    else
      s_.active[n] = 0;
  }

  void chooseTurn(uint32_t n) {
    s_.step[n] = 0;
    if (!s_.active[n]) return;
    const float rz = sum(n);
    if (!(rz > s_.limit[n])) {
      s_.active[n] = 0;
      return;
    }
    s_.step[n] = rz / s_.rz[n];
    s_.rz[n] = rz;
  }

  const BatchView& v_;
  const Backend& k_;
  const Parts parts_;
  Forest* forest_;
  KrylovScratch& s_;
};

}  // namespace

namespace {

float largest(const float* array, uint32_t begin, uint32_t end) {
  float most = 0;
  for (uint32_t i = 8 * begin; i < 8 * end; ++i) most = rows::max(most, rows::abs(array[i]));
  return most;
}

const IslandRange& islandOf(const BatchView& view, uint32_t row) {
  return *(std::upper_bound(view.island, view.island + view.islands, row,
                            [](uint32_t value, const IslandRange& island) { return value < island.begin; }) -
           1);
}

/// Dual update of the joints in tiles, of some islands alone.
template <template <class> class Family>
void moveMultipliers(const BatchView& view, const PairTiles<Family>& tiles, float leak, const uint8_t* active) {
  for (uint32_t lane = 0; lane < tiles.tiles * kTile; ++lane) {
    const uint32_t a = tiles.a[lane], b = tiles.b[lane], row = a < view.bodies ? a : b;
    if (row >= view.bodies || !active[&islandOf(view, row) - view.island]) continue;
    Family<float> pair = tiles.tile[lane / kTile].get(static_cast<int>(lane % kTile));
    rows::DualSink<float> sink{leak};
    pair.rows(readTwist(view.d, a), readTwist(view.d, b), sink);
    tiles.tile[lane / kTile].set(static_cast<int>(lane % kTile), pair);
  }
}

/// Ends the iterations of islands that the preconditioner solves exactly once they do not move any more: their
/// iteration is Newton's, and only such an island's next iteration depends on nothing but itself. In outer iterations
/// all joints in tiles move their multipliers, so that what holds some goes on.
void retireSettled(const BatchView& view, Phase phase, KrylovScratch& scratch) {
  for (uint32_t n = 0; n < view.islands; ++n) {
    const IslandRange& island = view.island[n];
    if (!isExact(island) || !scratch.unsolved[n] || (phase != Phase::Newton && island.inTiles)) continue;
    const float moved = largest(view.x, island.begin, island.end), whole = largest(view.d, island.begin, island.end);
    if (moved <= kSettled * whole) scratch.unsolved[n] = 0;
  }
}

/// After the outer iterations: what needs conjugate gradients has had its due. Where it does not, they were one Newton
/// step each, at an eighth of the cost, and a mechanism that whips may take as many again.
void retireCoupled(const BatchView& view, KrylovScratch& scratch) {
  for (uint32_t n = 0; n < view.islands; ++n)
    if (!isExact(view.island[n])) scratch.unsolved[n] = 0;
  retireSettled(view, Phase::Newton, scratch);
}

}  // namespace

namespace {

/// Rows see turns through the arms of a pose on the way: beyond about a radian a solution of theirs is none of the
/// bodies', and a light body struck hard would be spun full turns through it. What turns a body farther in one
/// iteration is shortened, its translation with it, since most of that is the turn's.
constexpr float kMostTurn = 1;  ///< [rad] an iteration

/// Gradient, Hessian and its blocks' inverses.
void stamp(const BatchView& view, const KrylovTools& tools, const SolveSettings& settings, Forest* forest, Phase phase,
           KrylovScratch& scratch) {
  const Backend& k = tools.backend;
  const Parts parts(view, tools.jobs);
  const bool dual = phase == Phase::Outer || phase == Phase::Newton, outer = phase == Phase::Outer;
  const ElementBlocks blocks = phase == Phase::Start   ? ElementBlocks::None
                               : phase == Phase::First ? ElementBlocks::New
                                                       : ElementBlocks::Kept;
  parts.chunks([&](const Chunk& chunk) {
    k.beginRows(view, chunk.rows);
    k.stampContacts(view, settings, outer, chunk.tiles);
  });
  parts.seams([&](Slice tiles) { k.stampContacts(view, settings, outer, tiles); });
  k.stampOthers(view, settings, outer, blocks);
  stiffenSwept(view);
  stampScalar(view, settings.jointLeak, dual, scratch.unsolved.data());
  stampLinked(view, dual ? settings.jointLeak : 1, scratch.unsolved.data());
  if (forest) forest->stamp(view, scratch.unsolved.data());
  if (view.lockedCount) applyLocks(view);
  parts.chunks([&](const Chunk& chunk) {
    if (!isForest(view, forest)) k.factor(view, chunk.rows);
    k.beginSearch(view, chunk.rows);
    if (!forest) k.precondition(view, chunk.rows);
  });
  if (forest) forest->factor(view, scratch.unsolved.data());
}

/// What is struck on its way whips what is tied to it: rows far from their turn send an iteration astray, and shortened
/// one by one the bodies would leave their joints.
constexpr float kMostTurnSwept = 0.15f;  ///< [rad] an iteration

void shortenTogether(const BatchView& view, const IslandRange& island) {
  float most = 0;
  for (uint32_t i = island.begin; i < island.end; ++i) {
    const rows::V3<float> turn = readTwist(view.x, i).ang;
    most = rows::max(most, dot(turn, turn));
  }
  if (most <= kMostTurnSwept * kMostTurnSwept) return;
  const float share = kMostTurnSwept / rows::sqrt(most);
  for (uint32_t i = 8 * island.begin; i < 8 * island.end; ++i) view.x[i] *= share;
}

/// Of islands that whip. Once for each contact that they do so at: once shortened, they stay.
void shortenWhips(const BatchView& view) {
  for (const SweptContact& s : view.swept) {
    const uint32_t *a = s.isFull ? view.full.a : view.contacts.a, *b = s.isFull ? view.full.b : view.contacts.b;
    if (s.whips) shortenTogether(view, islandOf(view, a[s.lane] < view.bodies ? a[s.lane] : b[s.lane]));
  }
}

void iterate(const BatchView& view, const KrylovTools& tools, const SolveSettings& settings, Forest* forest,
             Phase phase, KrylovScratch& scratch) {
  if (phase == Phase::Newton) {
    moveMultipliers(view, view.balls, settings.jointLeak, scratch.unsolved.data());
    moveMultipliers(view, view.fixed, settings.jointLeak, scratch.unsolved.data());
  }
  if (phase != Phase::First) lineariseSwept(view);
  stamp(view, tools, settings, forest, phase, scratch);
  Krylov(view, tools, forest, scratch).solve(settings.krylovIterations);
  shortenWhips(view);
  Parts(view, tools.jobs).chunks([&](const Chunk& chunk) { tools.backend.moveRows(view, kMostTurn, chunk.rows); });
  takeLinkedForces(view, scratch.unsolved.data());
  if (forest) forest->updateMultipliers(scratch.unsolved.data());
}

}  // namespace

namespace {

/// What moves an island's bodies by no more than is negligible, were all as light as the lightest.
void findLeast(const BatchView& view, float negligible, KrylovScratch& scratch) {
  scratch.least.resize(view.islands);
  for (uint32_t n = 0; n < view.islands; ++n) {
    const IslandRange& island = view.island[n];
    float lightest = view.mass[size_t(8) * island.begin];
    for (uint32_t i = island.begin; i < island.end; ++i) lightest = rows::min(lightest, view.mass[size_t(8) * i]);
    scratch.least[n] = static_cast<float>(island.end - island.begin) * lightest * (negligible * negligible);
  }
}

}  // namespace

namespace {

/// Shares 0 .. 1 of both that make the energy least, by turns.
std::array<float, 2> bestShares(const StartSums& s) {
  constexpr int kTurns = 8;
  std::array<float, 2> share{};
  for (int i = 0; i < 2 * kTurns; ++i) {
    const size_t k = static_cast<size_t>(i % 2);
    if (!(s.curvature[k] > 0)) continue;
    share[k] = rows::min(1.0f, rows::max(0.0f, (s.down[k] - s.both * share[1 - k]) / s.curvature[k]));
  }
  return share;
}

float dotRange(const float* a, const float* b, const IslandRange& island) {
  float sum = 0;
  for (size_t i = size_t(8) * island.begin; i < size_t(8) * island.end; ++i) sum += a[i] * b[i];
  return sum;
}

/// d takes in as much of `whole` and `deform` as lowers the energy of the step, island by island.
void startSofts(const BatchView& view, const KrylovTools& tools, const SolveSettings& settings, Forest* forest,
                KrylovScratch& scratch) {
  stamp(view, tools, settings, forest, Phase::Start, scratch);
  Krylov krylov(view, tools, forest, scratch);
  std::vector<StartSums>& sums = scratch.start;
  sums.assign(view.islands, {});
  const float* const ways[2] = {view.whole, view.deform};
  for (int k = 0; k < 2; ++k) {
    std::copy_n(ways[k], size_t(8) * view.bodies, view.p);
    krylov.product();
    for (uint32_t n = 0; n < view.islands; ++n) {
      sums[n].down[k] = dotRange(view.r, ways[k], view.island[n]);
      sums[n].curvature[k] = dotRange(view.q, ways[k], view.island[n]);
      if (k == 0) sums[n].both = dotRange(view.q, ways[1], view.island[n]);
    }
  }
  for (uint32_t n = 0; n < view.islands; ++n) {
    const std::array<float, 2> share = bestShares(sums[n]);
    for (size_t i = size_t(8) * view.island[n].begin; i < size_t(8) * view.island[n].end; ++i)
      view.d[i] += share[0] * view.whole[i] + share[1] * view.deform[i];
  }
}

}  // namespace

void solveKrylov(const BatchView& view, const KrylovTools& tools, const SolveSettings& settings, Forest* forest,
                 KrylovScratch& scratch) {
  scratch.unsolved.assign(view.islands, 1);
  findLeast(view, settings.negligible, scratch);
  if (view.deform) startSofts(view, tools, settings, forest, scratch);
  for (int i = 0; i < settings.iterations; ++i) {
    const Phase phase = i > 0 ? Phase::Outer : Phase::First;
    iterate(view, tools, settings, forest, phase, scratch);
    retireSettled(view, phase, scratch);
  }
  if (!forest) return;
  retireCoupled(view, scratch);
  for (int i = settings.iterations; i < settings.newtonFactor * settings.iterations && any(scratch.unsolved); ++i) {
    iterate(view, tools, settings, forest, Phase::Newton, scratch);
    retireSettled(view, Phase::Newton, scratch);
  }
}

}  // namespace avbd
