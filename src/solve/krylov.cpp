// Conjugate gradients over the islands of a batch.
//
// With the forces and weights of an outer iteration frozen, H x = -gradient is solved for all islands of the batch in
// step, each with its own coefficients. Islands with exact trees run projected conjugate gradients: the first
// application of the preconditioner meets the joints' violations, all later ones stay in the null space of J, and the
// residual gives up what the joints carry (r -= J^T mu) so that it does not drown in rounding.
#include "solve/krylov.h"

#include <algorithm>

#include "avbd/rows/sinks.h"
#include "solve/body_rows.h"
#include "solve/linked_joint.h"
#include "solve/locks.h"
#include "solve/scalar_joint.h"

namespace avbd {

namespace {

constexpr float kSettled = 3e-5f;           ///< relative change of a tree's pose that ends its outer iterations
constexpr float kRelativeResidual = 1e-9f;  ///< of r . M^-1 r, squared norm: an island below it is solved

/// All bodies stand in trees, which factor their own blocks.
bool isForest(const BatchView& view, const Forest* forest) { return forest && forest->nodes.size() == view.bodies; }

/// The preconditioner solves the island in one go.
bool isExact(const IslandRange& island) { return island.hasTree && !island.coupled; }

enum class Phase { First, Outer, Newton };

bool any(const std::vector<uint8_t>& islands) { return std::find(islands.begin(), islands.end(), 1) != islands.end(); }

class Krylov {
 public:
  Krylov(const BatchView& view, const Backend& backend, Forest* forest, KrylovScratch& scratch)
      : v_(view), k_(backend), forest_(forest), s_(scratch) {
    s_.rz.assign(v_.islands, 0);
    s_.limit.assign(v_.islands, 0);
    s_.active = s_.unsolved;
  }

  void solve(int iterations) {
    begin();
    for (int i = 0; i < iterations && any(s_.active); ++i) {
      multiply();
      for (uint32_t n = 0; n < v_.islands; ++n) advance(n);
      if (i + 1 == iterations) break;
      precondition(false);
      for (uint32_t n = 0; n < v_.islands; ++n) turn(n);
    }
  }

 private:
  void multiply() {
    k_.multiply(v_);
    multiplyLinked(v_, s_.active.data());
    clearLocked(v_, v_.q);
  }

  void precondition(bool violated) {
    if (!isForest(v_, forest_)) k_.precondition(v_);
    if (forest_) forest_->solve(v_, s_.active.data(), violated);
  }

  void begin() {
    for (uint32_t i = 0; i < 8 * v_.rows; ++i) {
      v_.x[i] = v_.p[i] = v_.z[i] = 0;
      v_.r[i] = i < 8 * v_.bodies ? -v_.gradient[i] : 0.0f;
    }
    if (forest_) meetViolations();
    if (!any(s_.active)) return;
    precondition(false);
    for (uint32_t n = 0; n < v_.islands; ++n) {
      if (!s_.active[n]) continue;
      const IslandRange& island = v_.island[n];
      s_.rz[n] = k_.dot(v_.r, v_.z, island.begin, island.end);
      s_.limit[n] = kRelativeResidual * s_.rz[n];
      s_.active[n] = s_.rz[n] > 0;
      if (s_.active[n]) k_.scaleAdd(v_.p, v_.z, 0, island.begin, island.end);
    }
  }

  /// x = the preconditioner's answer on islands with trees; exact, and final, where nothing else couples bodies.
  void meetViolations() {
    precondition(true);
    for (uint32_t n = 0; n < v_.islands; ++n) {
      const IslandRange& island = v_.island[n];
      if (!island.hasTree || !s_.active[n]) continue;
      k_.scaleAdd(v_.p, v_.z, 0, island.begin, island.end);
      k_.scaleAdd(v_.x, v_.z, 0, island.begin, island.end);
      if (!island.coupled) s_.active[n] = 0;
    }
    if (!any(s_.active)) return;
    multiply();
    for (uint32_t n = 0; n < v_.islands; ++n)
      if (v_.island[n].hasTree && s_.active[n]) k_.addScaled(v_.r, v_.q, -1, v_.island[n].begin, v_.island[n].end);
  }

  void advance(uint32_t n) {
    if (!s_.active[n]) return;
    const IslandRange& island = v_.island[n];
    const float pq = k_.dot(v_.p, v_.q, island.begin, island.end);
    if (!(pq > 0)) {
      s_.active[n] = 0;
      return;
    }
    const float a = s_.rz[n] / pq;
    k_.addScaled(v_.x, v_.p, a, island.begin, island.end);
    k_.addScaled(v_.r, v_.q, -a, island.begin, island.end);
  }

  void turn(uint32_t n) {
    if (!s_.active[n]) return;
    const IslandRange& island = v_.island[n];
    const float rz = k_.dot(v_.r, v_.z, island.begin, island.end);
    if (!(rz > s_.limit[n])) {
      s_.active[n] = 0;
      return;
    }
    k_.scaleAdd(v_.p, v_.z, rz / s_.rz[n], island.begin, island.end);
    s_.rz[n] = rz;
  }

  const BatchView& v_;
  const Backend& k_;
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

void boundTurns(const BatchView& view) {
  for (uint32_t i = 0; i < view.bodies; ++i) {
    float* x = view.x + 8 * i;
    const float turn = x[4] * x[4] + x[5] * x[5] + x[6] * x[6];
    if (!(turn > kMostTurn * kMostTurn)) continue;
    const float share = kMostTurn / rows::sqrt(turn);
    for (int k = 0; k < 8; ++k) x[k] *= share;
  }
}

}  // namespace

namespace {

void iterate(const BatchView& view, const Backend& backend, const SolveSettings& settings, Forest* forest, Phase phase,
             KrylovScratch& scratch) {
  const bool dual = phase != Phase::First;
  if (phase == Phase::Newton) {
    moveMultipliers(view, view.balls, settings.jointLeak, scratch.unsolved.data());
    moveMultipliers(view, view.fixed, settings.jointLeak, scratch.unsolved.data());
  }
  backend.beginIteration(view);
  backend.stampRows(view, settings, phase == Phase::Outer);
  stampScalar(view, settings.jointLeak, dual, scratch.unsolved.data());
  stampLinked(view, dual ? settings.jointLeak : 1, scratch.unsolved.data());
  if (forest) forest->stamp(view, scratch.unsolved.data());
  if (view.lockedCount) applyLocks(view);
  if (!isForest(view, forest)) backend.factor(view);
  if (forest) forest->factor(view, scratch.unsolved.data());
  Krylov(view, backend, forest, scratch).solve(settings.krylovIterations);
  boundTurns(view);
  backend.addScaled(view.d, view.x, 1, 0, view.bodies);
  takeLinkedForces(view, scratch.unsolved.data());
  if (forest) forest->updateMultipliers(scratch.unsolved.data());
}

}  // namespace

void solveKrylov(const BatchView& view, const Backend& backend, const SolveSettings& settings, Forest* forest,
                 KrylovScratch& scratch) {
  scratch.unsolved.assign(view.islands, 1);
  for (int i = 0; i < settings.iterations; ++i) {
    const Phase phase = i > 0 ? Phase::Outer : Phase::First;
    iterate(view, backend, settings, forest, phase, scratch);
    retireSettled(view, phase, scratch);
  }
  if (!forest) return;
  retireCoupled(view, scratch);
  for (int i = settings.iterations; i < settings.newtonFactor * settings.iterations && any(scratch.unsolved); ++i) {
    iterate(view, backend, settings, forest, Phase::Newton, scratch);
    retireSettled(view, Phase::Newton, scratch);
  }
}

}  // namespace avbd
