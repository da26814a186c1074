// The kernels of one lane width; included once by each backend_w*.cpp with AVBD_LANES and AVBD_LANES_NAMESPACE defined.
// Everything here is local to that file: code for different instruction sets must not meet in the linker.
#include "avbd/rows/sinks.h"
#include "lane/scatter_pair.h"
#include "solve/backend.h"
#include "solve/geometric.h"

namespace avbd::AVBD_LANES_NAMESPACE {
namespace {

using namespace rows;
constexpr int N = AVBD_LANES;
using R = lane::Real<N>;
using lane::gatherTwist;

/// Calls f(tile, lane offset) for all lanes of some tiles.
template <class F>
AVBD_INLINE void forLanes(Slice tiles, F&& f) {
  for (uint32_t t = tiles.begin; t < tiles.end; ++t)
    for (int o = 0; o < kTile; o += N) f(t, o);
}

// ---- Stiffness floors of contacts ------------------------------------------------------------------------------

struct InverseMass {
  R linear;
  Sym3<R> angular;
};

AVBD_INLINE InverseMass gatherInverseMass(const float* array, const uint32_t* row) {
  R c[8];
  lane::gatherRows<N>(array, 8, row, c);
  return {c[0], {c[1], c[2], c[3], c[4], c[5], c[6]}};
}

AVBD_INLINE R inverseMassAlong(const InverseMass& m, const V3<R>& arm, const V3<R>& direction) {
  const V3<R> a = cross(arm, direction);
  return m.linear * dot(direction, direction) + dot(a, m.angular * a);
}

AVBD_INLINE R floorStiffness(const R& present, const R& w, float factor) {
  const auto usable = (present > 0.0f) & (w > 0.0f);
  return select(usable, splat<R>(factor) / select(usable, w, splat<R>(1)), zero<R>());
}

AVBD_INLINE void prepareContact(Contact<R>& c, const InverseMass& a, const InverseMass& b, float factor) {
  for (auto& p : c.point) {
    const V3<R> armA = c.armA + p.arm, armB = c.armB + p.arm;
    const R wn = inverseMassAlong(a, armA, c.n) + inverseMassAlong(b, armB, c.n);
    const R w1 = inverseMassAlong(a, armA, c.t1) + inverseMassAlong(b, armB, c.t1);
    const R w2 = inverseMassAlong(a, armA, c.t2) + inverseMassAlong(b, armB, c.t2);
    p.floorN = floorStiffness(p.floorN, wn, factor);
    p.floorT = floorStiffness(p.floorT, max(w1, w2), factor);
  }
}

AVBD_INLINE InverseMass scaled(const InverseMass& m, const R& s) { return {m.linear * s, m.angular * s}; }

/// hessianA, hessianB (full_contact.h); the masses along the normal are those at the reference point.
AVBD_INLINE void scaleHessian(FullContact<R>& c, const InverseMass& a, const InverseMass& b) {
  const R wA = inverseMassAlong(a, c.contact.armA, c.contact.n), wB = inverseMassAlong(b, c.contact.armB, c.contact.n);
  const R once = c.scaleA * wA + c.scaleB * wB;
  const R twice = c.scaleA * c.scaleA * wA + c.scaleB * c.scaleB * wB;
  const R factor = sqrt(select(twice > 0.0f, once / select(twice > 0.0f, twice, splat<R>(1)), zero<R>()));
  c.hessianA = c.scaleA * factor;
  c.hessianB = c.scaleB * factor;
}

AVBD_INLINE void prepareFull(FullContact<R>& c, const InverseMass& a, const InverseMass& b, float factor) {
  scaleHessian(c, a, b);
  const InverseMass sA = scaled(a, c.scaleA), sB = scaled(b, c.scaleB);
  prepareContact(c.contact, sA, sB, factor);
  const Sym3<R> turning = sA.angular + sB.angular;
  const auto along = [&](const V3<R>& axis) { return dot(axis, turning * axis); };
  c.kTorsion = floorStiffness(c.torsional, along(c.contact.n), factor);
  c.kRolling = floorStiffness(c.rolling, max(along(c.contact.t1), along(c.contact.t2)), factor);
}

}  // namespace
}  // namespace avbd::AVBD_LANES_NAMESPACE

#include "solve/node_kernels.h"
#include "solve/star_kernels.h"

namespace avbd::AVBD_LANES_NAMESPACE {
namespace {

void prepareContacts(const BatchView& v, const SolveSettings& s, Slice tiles) {
  const float factor = s.floorFactor / (s.h * s.h);
  forLanes(tiles, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    Contact<R> c = v.contacts.tile[t].load<N>(o);
    prepareContact(c, gatherInverseMass(v.invMass, v.contacts.a + at), gatherInverseMass(v.invMass, v.contacts.b + at),
                   factor);
    v.contacts.tile[t].store<N>(o, c);
  });
}

void prepareOthers(const BatchView& v, const SolveSettings& s) {
  const float factor = s.floorFactor / (s.h * s.h);
  forLanes({0, v.full.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    FullContact<R> c = v.full.tile[t].load<N>(o);
    prepareFull(c, gatherInverseMass(v.invMass, v.full.a + at), gatherInverseMass(v.invMass, v.full.b + at), factor);
    v.full.tile[t].store<N>(o, c);
  });
  prepareNodeContacts(v, factor);
  prepareTriangles(v, factor);
}

// ---- Rows ------------------------------------------------------------------------------------------------------

AVBD_INLINE void addToDiagonal(const BatchView& v, const uint32_t* a, const Sym3<R>& gA, const uint32_t* b,
                               const Sym3<R>& gB) {
  const R o = zero<R>();
  const R va[8] = {o, gA.xx, gA.yy, gA.zz, gA.xy, gA.xz, gA.yz, o};
  const R vb[8] = {o, gB.xx, gB.yy, gB.zz, gB.xy, gB.xz, gB.yz, o};
  lane::scatterAddPairs<N>(v.diagonal, 8, a, va, b, vb);
}

/// Stamps all pairs of one family; with `dual` moves their multipliers first (nothing has moved in between).
template <template <class> class Family, bool kJoint>
void stampPairs(const BatchView& v, const PairTiles<Family>& tiles, Slice range, Tile<PairOp>* op, float leak,
                bool dual) {
  forLanes(range, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const uint32_t *a = tiles.a + at, *b = tiles.b + at;
    Family<R> pair = tiles.tile[t].template load<N>(o);
    const Twist<R> dA = gatherTwist<N>(v.d, a), dB = gatherTwist<N>(v.d, b);
    if (dual) {
      DualSink<R> sink{splat<R>(leak)};
      pair.rows(dA, dB, sink);
      tiles.tile[t].template store<N>(o, pair);
    }
    StampSink<R> sink;
    sink.clear();
    pair.rows(dA, dB, sink);
    op[t].store<N>(o, PairOp<R>{sink.armA, sink.armB, sink.stiffness});
    Sym6<R> blockA = shifted(sink.stiffness, sink.armA), blockB = shifted(sink.stiffness, sink.armB);
    if constexpr (kJoint) {
      const Sym3<R> gA = geometricStiffness(-sink.wrench.lin, sink.armA);
      const Sym3<R> gB = geometricStiffness(sink.wrench.lin, sink.armB);
      blockA.aa = blockA.aa + gA;
      blockB.aa = blockB.aa + gB;
      addToDiagonal(v, a, gA, b, gB);
    }
    lane::scatterAddTwists<N>(v.gradient, a, shiftWrench(sink.wrench, sink.armA), b,
                              -shiftWrench(sink.wrench, sink.armB));
    lane::scatterAddSym6s<N>(v.hessian, a, blockA, b, blockB);
  });
}

void stampFull(const BatchView& v, float leak, bool dual) {
  forLanes({0, v.full.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const uint32_t *a = v.full.a + at, *b = v.full.b + at;
    FullContact<R> pair = v.full.tile[t].load<N>(o);
    const Twist<R> dA = gatherTwist<N>(v.d, a), dB = gatherTwist<N>(v.d, b);
    if (dual) {
      DualSink<R> sink{splat<R>(leak)};
      pair.rows(dA, dB, sink);
      v.full.tile[t].store<N>(o, pair);
    }
    StampSink<R> sink;
    sink.clear();
    pair.rows(dA, dB, sink);
    v.fullOp[t].store<N>(o, ScaledOp<R>{{sink.armA, sink.armB, sink.stiffness}, pair.hessianA, pair.hessianB});
    lane::scatterAddTwists<N>(v.gradient, a, shiftWrench(sink.wrench, sink.armA) * pair.scaleA, b,
                              -(shiftWrench(sink.wrench, sink.armB) * pair.scaleB));
    lane::scatterAddSym6s<N>(v.hessian, a, shifted(sink.stiffness, sink.armA) * (pair.hessianA * pair.hessianA), b,
                             shifted(sink.stiffness, sink.armB) * (pair.hessianB * pair.hessianB));
  });
}

template <template <class> class Family>
void dualPairs(const BatchView& v, const PairTiles<Family>& tiles, Slice range, float leak) {
  forLanes(range, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    Family<R> pair = tiles.tile[t].template load<N>(o);
    DualSink<R> sink{splat<R>(leak)};
    pair.rows(gatherTwist<N>(v.d, tiles.a + at), gatherTwist<N>(v.d, tiles.b + at), sink);
    tiles.tile[t].template store<N>(o, pair);
  });
}

void stampTets(const BatchView& v, bool dual) {
  forLanes({0, v.tets.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    TetVolume<R> tet = v.tets.tile[t].load<N>(o);
    V3<R> d[4];
    gatherNodes(v.tets.node, v.d, at, d);
    if (dual) {
      BlockDualSink<R, 4> sink{splat<R>(1)};
      tet.rows(d, sink);
      v.tets.tile[t].store<N>(o, tet);
    }
    BlockStampSink<R, 4> sink;
    tet.rows(d, sink);
    NodeOp<R> op;
    for (int i = 0; i < 4; ++i) op.lin[i] = sink.lin[i];
    op.k = sink.k;
    v.tets.op[t].store<N>(o, op);
    scatterVectors<4>(v.gradient, v.tets.node, at, sink.gradient);
    scatterBlocks<4>(v.hessian, kHessianRow, v.tets.node, at, sink.diagonal);
  });
}

void stampContacts(const BatchView& v, const SolveSettings& s, bool dual, Slice tiles) {
  stampPairs<Contact, false>(v, v.contacts, tiles, v.op, s.contactLeak, dual);
}

void stampOthers(const BatchView& v, const SolveSettings& s, bool dual, ElementBlocks blocks) {
  Tile<PairOp>* op = v.op + v.contacts.tiles;
  stampPairs<BallJoint, true>(v, v.balls, {0, v.balls.tiles}, op, s.jointLeak, dual);
  op += v.balls.tiles;
  stampPairs<FixedJoint, true>(v, v.fixed, {0, v.fixed.tiles}, op, s.jointLeak, dual);
  stampFull(v, s.contactLeak, dual);
  stampTets(v, dual);
  stampSofts(v, dual, blocks);
  stampNodeContacts(v, s.contactLeak, dual);
}

void updateContacts(const BatchView& v, const SolveSettings& s, Slice tiles) {
  dualPairs(v, v.contacts, tiles, s.contactLeak);
}

void updateOthers(const BatchView& v, const SolveSettings& s) {
  dualPairs(v, v.balls, {0, v.balls.tiles}, 1);
  dualPairs(v, v.fixed, {0, v.fixed.tiles}, 1);
  dualPairs(v, v.full, {0, v.full.tiles}, s.contactLeak);
  dualTets(v);
  dualStars(v);
  dualTriangles(v);
  dualNodeContacts(v, s.contactLeak);
}

// ---- Products with H -------------------------------------------------------------------------------------------

void multiplyPairs(const BatchView& v, const uint32_t* rowA, const uint32_t* rowB, const Tile<PairOp>* op,
                   Slice tiles) {
  forLanes(tiles, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const PairOp<R> pair = op[t].load<N>(o);
    const Twist<R> u = shiftToPoint(gatherTwist<N>(v.p, rowA + at), pair.armA) -
                       shiftToPoint(gatherTwist<N>(v.p, rowB + at), pair.armB);
    const Twist<R> w = pair.stiffness * u;
    lane::scatterAddTwists<N>(v.q, rowA + at, shiftWrench(w, pair.armA), rowB + at, -shiftWrench(w, pair.armB));
  });
}

void multiplyFull(const BatchView& v) {
  forLanes({0, v.full.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const ScaledOp<R> op = v.fullOp[t].load<N>(o);
    const PairOp<R>& pair = op.pair;
    const Twist<R> u = shiftToPoint(gatherTwist<N>(v.p, v.full.a + at), pair.armA) * op.hessianA -
                       shiftToPoint(gatherTwist<N>(v.p, v.full.b + at), pair.armB) * op.hessianB;
    const Twist<R> w = pair.stiffness * u;
    lane::scatterAddTwists<N>(v.q, v.full.a + at, shiftWrench(w, pair.armA) * op.hessianA, v.full.b + at,
                              -(shiftWrench(w, pair.armB) * op.hessianB));
  });
}

void multiplyContacts(const BatchView& v, Slice tiles) { multiplyPairs(v, v.contacts.a, v.contacts.b, v.op, tiles); }

void multiplyOthers(const BatchView& v) {
  const Tile<PairOp>* op = v.op + v.contacts.tiles;
  multiplyPairs(v, v.balls.a, v.balls.b, op, {0, v.balls.tiles});
  op += v.balls.tiles;
  multiplyPairs(v, v.fixed.a, v.fixed.b, op, {0, v.fixed.tiles});
  op += v.fixed.tiles;
  multiplyPairs(v, v.scalar.a, v.scalar.b, op, {0, v.scalar.tiles});
  multiplyFull(v);
  multiplyElements(v, v.tets);
  multiplySofts(v);
  multiplyStars(v, v.stars);
  multiplyStars(v, v.corotationalStars);
}

}  // namespace
}  // namespace avbd::AVBD_LANES_NAMESPACE

#include "solve/motion_kernels.h"
#include "solve/row_kernels.h"
#include "solve/sweep_kernels.h"

namespace avbd::AVBD_LANES_NAMESPACE {

extern const Backend kBackend;
const Backend kBackend = {N,
                          prepareContacts,
                          prepareOthers,
                          stampContacts,
                          stampOthers,
                          updateContacts,
                          updateOthers,
                          freeMotions,
                          massRows,
                          endMotions,
                          beginRows,
                          factor,
                          beginSearch,
                          turnAndMultiply,
                          multiplyRows,
                          multiplyContacts,
                          multiplyOthers,
                          precondition,
                          dotRows,
                          advance,
                          advanceAndPrecondition,
                          moveRows,
                          sum,
                          stageRecords,
                          stampColor,
                          solveColor};

}  // namespace avbd::AVBD_LANES_NAMESPACE
