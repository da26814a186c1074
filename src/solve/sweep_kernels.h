// The block sweep's kernels of one lane width; part of kernels.h.
//
// Gradient and Hessian of a colour's bodies stand in the first rows of the batch's arrays, by place.
#pragma once

#include "solve/sweep.h"

namespace avbd::AVBD_LANES_NAMESPACE {
namespace {

// ---- Records ---------------------------------------------------------------------------------------------------

/// A pair as the columns of its record.
template <template <class> class Family>
struct Record {
  alignas(64) R column[kRecord<Family>];
  AVBD_INLINE Family<R>& value() { return *reinterpret_cast<Family<R>*>(column); }
  AVBD_INLINE void gather(const float* records, const uint32_t* index) {
    lane::gatherRows<N>(records, kRecord<Family>, index, column);
  }
  AVBD_INLINE void store(float* records, uint32_t at) {
    for (int i = lane::kFields<Family>; i < kRecord<Family>; ++i) column[i] = zero<R>();
    lane::storeRows<N>(records + size_t(at) * kRecord<Family>, kRecord<Family>, column);
  }
};

/// Copies the pairs of one family to its records; with `dual` moves their multipliers first.
template <template <class> class Family>
void stagePairs(const BatchView& v, const PairTiles<Family>& tiles, const SideView& sides, float leak, bool dual) {
  forLanes({0, tiles.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    Record<Family> record;
    record.value() = tiles.tile[t].template load<N>(o);
    if (dual) {
      DualSink<R> sink{splat<R>(leak)};
      record.value().rows(gatherTwist<N>(v.d, tiles.a + at), gatherTwist<N>(v.d, tiles.b + at), sink);
      tiles.tile[t].template store<N>(o, record.value());
    }
    record.store(sides.records, at);
  });
}

void stageTets(const BatchView& v, const SideView& sides, bool dual) {
  if (dual) dualTets(v);
  forLanes({0, v.tets.tiles}, [&](uint32_t t, int o) {
    Record<TetVolume> record;
    record.value() = v.tets.tile[t].load<N>(o);
    record.store(sides.records, t * kTile + static_cast<uint32_t>(o));
  });
}

void stageRecords(const BatchView& v, const SweepView& w, const SolveSettings& s, bool dual) {
  stagePairs(v, v.contacts, w.sides[kContactSides], s.contactLeak, dual);
  stagePairs(v, v.balls, w.sides[kBallSides], s.jointLeak, dual);
  stagePairs(v, v.fixed, w.sides[kFixedSides], s.jointLeak, dual);
  stagePairs(v, v.full, w.sides[kFullSides], s.contactLeak, dual);
  stageTets(v, w.sides[kTetSides], dual);
}

// ---- Sides -----------------------------------------------------------------------------------------------------

/// Calls f(group, lane offset) for the runs of one family in one colour.
template <class F>
AVBD_INLINE void forRuns(const SweepColor& color, SideFamily family, F&& f) {
  for (uint32_t g = color.groupBegin[family]; g < color.groupEnd[family]; ++g)
    for (uint32_t o = 0; o < kTile; o += N) f(g, o);
}

template <template <class> class Family, bool kJoint>
void stampSides(const BatchView& v, const SideView& sides, const SweepColor& color, SideFamily family) {
  forRuns(color, family, [&](uint32_t g, uint32_t o) {
    const Twist<R> own = gatherTwist<N>(v.d, sides.row + g * kTile + o);
    Twist<R> gradient = zeroTwist<R>();
    Sym6<R> hessian = zeroSym6<R>();
    for (uint32_t i = 0; i < sides.group[g].length; ++i) {
      const uint32_t at = sides.group[g].first + i * kTile + o;
      Record<Family> record;
      record.gather(sides.records, sides.pair + at);
      const Twist<R> other = gatherTwist<N>(v.d, sides.other + at);
      const auto isA = lane::load<R>(sides.role + at) == 0.0f;
      StampSink<R> sink;
      sink.clear();
      record.value().rows(select(isA, own, other), select(isA, other, own), sink);
      const V3<R> arm = select(isA, sink.armA, sink.armB);
      Twist<R> wrench = select(isA, sink.wrench, -sink.wrench);
      if constexpr (requires { record.value().scaleA; }) {
        const R scale = select(isA, record.value().scaleA, record.value().scaleB);
        wrench = wrench * scale;
        sink.stiffness = sink.stiffness * scale;  // this body's own derivative, exactly
      }
      gradient += shiftWrench(wrench, arm);
      hessian += shifted(sink.stiffness, arm);
      if constexpr (kJoint) hessian.aa = hessian.aa + geometricStiffness(-wrench.lin, arm);
    }
    lane::scatterAddTwist<N>(v.gradient, sides.place + g * kTile + o, gradient);
    lane::scatterAddSym6<N>(v.hessian, sides.place + g * kTile + o, hessian);
  });
}

/// Body rows of one of the nodes of some tets.
AVBD_INLINE void nodeRows(const BatchView& v, const SideView& sides, const uint32_t* tet, int node, uint32_t* row) {
  for (int l = 0; l < N; ++l) row[l] = tet[l] < sides.pairs ? v.tets.node[node][tet[l]] : v.bodies;
}

void stampTetSides(const BatchView& v, const SideView& sides, const SweepColor& color) {
  forRuns(color, kTetSides, [&](uint32_t g, uint32_t o) {
    Twist<R> gradient = zeroTwist<R>();
    Sym6<R> hessian = zeroSym6<R>();
    for (uint32_t i = 0; i < sides.group[g].length; ++i) {
      const uint32_t at = sides.group[g].first + i * kTile + o;
      Record<TetVolume> record;
      record.gather(sides.records, sides.pair + at);
      V3<R> d[4];
      for (int n = 0; n < 4; ++n) {
        uint32_t row[N];
        nodeRows(v, sides, sides.pair + at, n, row);
        d[n] = gatherTwist<N>(v.d, row).lin;
      }
      BlockStampSink<R, 4> sink;
      record.value().rows(d, sink);
      const R role = lane::load<R>(sides.role + at);
      for (int n = 0; n < 4; ++n) {
        const R mine = select(role == splat<R>(static_cast<float>(n)), splat<R>(1), zero<R>());
        gradient.lin += sink.gradient[n] * mine;
        hessian.ll = hessian.ll + sink.diagonal[n] * mine;
      }
    }
    lane::scatterAddTwist<N>(v.gradient, sides.place + g * kTile + o, gradient);
    lane::scatterAddSym6<N>(v.hessian, sides.place + g * kTile + o, hessian);
  });
}

// ---- Bodies of a colour ----------------------------------------------------------------------------------------

void beginColor(const BatchView& v, const uint32_t* row, uint32_t places) {
  for (uint32_t i = 0; i < places; i += N) {
    R m[8];
    lane::gatherRows<N>(v.mass, 8, row + i, m);
    const Sym3<R> angular{m[1], m[2], m[3], m[4], m[5], m[6]};
    const Twist<R> e = gatherTwist<N>(v.d, row + i) - gatherTwist<N>(v.target, row + i);
    lane::storeTwists<N>(v.gradient + 8 * i, Twist<R>{e.lin * m[0], angular * e.ang});
    const V3<R> o = zeroV3<R>();
    lane::storeSym6<N>(v.hessian + kHessianRow * i, Sym6<R>{diagonal(V3<R>{m[0], m[0], m[0]}), {o, o, o}, angular});
  }
}

/// Gradient and Hessian of every body of a colour, where all stand now.
void stampColor(const BatchView& v, const SweepView& w, const SweepColor& color) {
  beginColor(v, w.row + color.rowBegin, color.places);
  stampSides<Contact, false>(v, w.sides[kContactSides], color, kContactSides);
  stampSides<BallJoint, true>(v, w.sides[kBallSides], color, kBallSides);
  stampSides<FixedJoint, true>(v, w.sides[kFixedSides], color, kFixedSides);
  stampSides<FullContact, false>(v, w.sides[kFullSides], color, kFullSides);
  stampTetSides(v, w.sides[kTetSides], color);
}

/// d -= H^-1 gradient
void solveColor(const BatchView& v, const SweepView& w, const SweepColor& color) {
  const uint32_t* row = w.row + color.rowBegin;
  for (uint32_t i = 0; i < color.places; i += N) {
    const Twist<R> gradient = lane::loadTwists<N>(v.gradient + 8 * i);
    const Twist<R> x = solve(rows::factor(lane::loadSym6<N>(v.hessian + kHessianRow * i)), gradient);
    lane::scatterAddTwist<N>(v.d, row + i, -x);
  }
}

}  // namespace
}  // namespace avbd::AVBD_LANES_NAMESPACE
