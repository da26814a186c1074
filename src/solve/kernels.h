// The kernels of one lane width; included once by each backend_w*.cpp with AVBD_LANES and AVBD_LANES_NAMESPACE defined.
// Everything here is local to that file: code for different instruction sets must not meet in the linker.
#include "avbd/rows/sinks.h"
#include "lane/gather.h"
#include "solve/backend.h"
#include "solve/geometric.h"

namespace avbd::AVBD_LANES_NAMESPACE {
namespace {

using namespace rows;
constexpr int N = AVBD_LANES;
using R = lane::Real<N>;
using lane::gatherTwist;
using lane::scatterAddTwist;

/// Calls f(tile, lane offset) for all lanes of a number of tiles.
template <class F>
AVBD_INLINE void forLanes(uint32_t tiles, F&& f) {
  for (uint32_t t = 0; t < tiles; ++t)
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

void prepareContacts(const BatchView& v, const SolveSettings& s) {
  const float factor = s.floorFactor / (s.h * s.h);
  forLanes(v.contacts.tiles, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    Contact<R> c = v.contacts.tile[t].load<N>(o);
    const InverseMass a = gatherInverseMass(v.invMass, v.contacts.a + at);
    const InverseMass b = gatherInverseMass(v.invMass, v.contacts.b + at);
    for (auto& p : c.point) {
      const V3<R> armA = c.armA + p.arm, armB = c.armB + p.arm;
      const R wn = inverseMassAlong(a, armA, c.n) + inverseMassAlong(b, armB, c.n);
      const R w1 = inverseMassAlong(a, armA, c.t1) + inverseMassAlong(b, armB, c.t1);
      const R w2 = inverseMassAlong(a, armA, c.t2) + inverseMassAlong(b, armB, c.t2);
      p.floorN = floorStiffness(p.floorN, wn, factor);
      p.floorT = floorStiffness(p.floorT, max(w1, w2), factor);
    }
    v.contacts.tile[t].store<N>(o, c);
  });
}

// ---- Rows ------------------------------------------------------------------------------------------------------

AVBD_INLINE void addGeometric(const BatchView& v, const uint32_t* row, const V3<R>& force, const V3<R>& arm) {
  const Sym3<R> g = geometricStiffness(force, arm);
  const R o = zero<R>();
  R block[24];
  for (auto& entry : block) entry = o;
  const R angular[6] = {g.xx, g.yy, g.zz, g.xy, g.xz, g.yz};
  for (int i = 0; i < 6; ++i) block[15 + i] = angular[i];
  lane::scatterAddRows<N>(v.hessian, kHessianRow, row, block);
  const R diagonal[8] = {o, g.xx, g.yy, g.zz, g.xy, g.xz, g.yz, o};
  lane::scatterAddRows<N>(v.diagonal, 8, row, diagonal);
}

/// Stamps all pairs of one family; with `dual` moves their multipliers first (nothing has moved in between).
template <template <class> class Family, bool kJoint>
void stampPairs(const BatchView& v, const PairTiles<Family>& tiles, Tile<PairOp>* op, float leak, bool dual) {
  forLanes(tiles.tiles, [&](uint32_t t, int o) {
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
    scatterAddTwist<N>(v.gradient, a, shiftWrench(sink.wrench, sink.armA));
    scatterAddTwist<N>(v.gradient, b, -shiftWrench(sink.wrench, sink.armB));
    lane::scatterAddSym6<N>(v.hessian, a, shifted(sink.stiffness, sink.armA));
    lane::scatterAddSym6<N>(v.hessian, b, shifted(sink.stiffness, sink.armB));
    if constexpr (kJoint) {
      addGeometric(v, a, -sink.wrench.lin, sink.armA);
      addGeometric(v, b, sink.wrench.lin, sink.armB);
    }
  });
}

template <template <class> class Family>
void dualPairs(const BatchView& v, const PairTiles<Family>& tiles, float leak) {
  forLanes(tiles.tiles, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    Family<R> pair = tiles.tile[t].template load<N>(o);
    DualSink<R> sink{splat<R>(leak)};
    pair.rows(gatherTwist<N>(v.d, tiles.a + at), gatherTwist<N>(v.d, tiles.b + at), sink);
    tiles.tile[t].template store<N>(o, pair);
  });
}

AVBD_INLINE void gatherNodes(const BatchView& v, const float* array, uint32_t at, V3<R> (&node)[4]) {
  for (int i = 0; i < 4; ++i) node[i] = gatherTwist<N>(array, v.tets.node[i] + at).lin;
}

void stampTets(const BatchView& v, bool dual) {
  forLanes(v.tets.tiles, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    TetVolume<R> tet = v.tets.tile[t].load<N>(o);
    V3<R> d[4];
    gatherNodes(v, v.d, at, d);
    if (dual) {
      BlockDualSink<R, 4> sink{splat<R>(1)};
      tet.rows(d, sink);
      v.tets.tile[t].store<N>(o, tet);
    }
    BlockStampSink<R, 4> sink;
    tet.rows(d, sink);
    NodeOp<R> op;
    const V3<R> none = zeroV3<R>();
    for (int i = 0; i < 4; ++i) {
      op.lin[i] = sink.lin[i];
      scatterAddTwist<N>(v.gradient, v.tets.node[i] + at, Twist<R>{sink.gradient[i], none});
      Sym6<R> block = zeroSym6<R>();
      block.ll = sink.diagonal[i];
      lane::scatterAddSym6<N>(v.hessian, v.tets.node[i] + at, block);
    }
    op.k = sink.k;
    v.tets.op[t].store<N>(o, op);
  });
}

void dualTets(const BatchView& v) {
  forLanes(v.tets.tiles, [&](uint32_t t, int o) {
    TetVolume<R> tet = v.tets.tile[t].load<N>(o);
    V3<R> d[4];
    gatherNodes(v, v.d, t * kTile + static_cast<uint32_t>(o), d);
    BlockDualSink<R, 4> sink{splat<R>(1)};
    tet.rows(d, sink);
    v.tets.tile[t].store<N>(o, tet);
  });
}

void stampRows(const BatchView& v, const SolveSettings& s, bool dual) {
  Tile<PairOp>* op = v.op;
  stampPairs<Contact, false>(v, v.contacts, op, s.contactLeak, dual);
  op += v.contacts.tiles;
  stampPairs<BallJoint, true>(v, v.balls, op, 1, dual);
  op += v.balls.tiles;
  stampPairs<FixedJoint, true>(v, v.fixed, op, 1, dual);
  stampTets(v, dual);
}

void updateRows(const BatchView& v, const SolveSettings& s) {
  dualPairs(v, v.contacts, s.contactLeak);
  dualPairs(v, v.balls, 1);
  dualPairs(v, v.fixed, 1);
  dualTets(v);
}

// ---- Body rows -------------------------------------------------------------------------------------------------

struct MassRow {
  R linear;
  Sym3<R> angular;
};

AVBD_INLINE MassRow loadMass(const float* row) {
  R c[8];
  lane::loadRows<N>(row, 8, c);
  return {c[0], {c[1], c[2], c[3], c[4], c[5], c[6]}};
}

void beginIteration(const BatchView& v) {
  for (uint32_t i = 0; i < v.rows; i += N) {
    const MassRow m = loadMass(v.mass + 8 * i);
    const Twist<R> e = lane::loadTwists<N>(v.d + 8 * i) - lane::loadTwists<N>(v.target + 8 * i);
    lane::storeTwists<N>(v.gradient + 8 * i, Twist<R>{e.lin * m.linear, m.angular * e.ang});
    const R o = zero<R>();
    const R c[8] = {m.linear, m.angular.xx, m.angular.yy, m.angular.zz, m.angular.xy, m.angular.xz, m.angular.yz, o};
    lane::storeRows<N>(v.diagonal + 8 * i, 8, c);
    const Sym6<R> block{{m.linear, m.linear, m.linear, o, o, o}, {{o, o, o}, {o, o, o}, {o, o, o}}, m.angular};
    lane::storeSym6<N>(v.hessian + kHessianRow * i, block);
  }
}

void factor(const BatchView& v) {
  for (uint32_t i = 0; i < v.rows; i += N) {
    const Sym6<R> inv = inverse(lane::loadSym6<N>(v.hessian + kHessianRow * i));
    v.inverse[i / kTile].store<N>(static_cast<int>(i % kTile), inv);
  }
}

void precondition(const BatchView& v) {
  for (uint32_t i = 0; i < v.rows; i += N) {
    const Sym6<R> inv = v.inverse[i / kTile].load<N>(static_cast<int>(i % kTile));
    lane::storeTwists<N>(v.z + 8 * i, inv * lane::loadTwists<N>(v.r + 8 * i));
  }
}

void multiplyPairs(const BatchView& v, const uint32_t* rowA, const uint32_t* rowB, const Tile<PairOp>* op,
                   uint32_t tiles) {
  forLanes(tiles, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const PairOp<R> pair = op[t].load<N>(o);
    const Twist<R> u = shiftToPoint(gatherTwist<N>(v.p, rowA + at), pair.armA) -
                       shiftToPoint(gatherTwist<N>(v.p, rowB + at), pair.armB);
    const Twist<R> w = pair.stiffness * u;
    scatterAddTwist<N>(v.q, rowA + at, shiftWrench(w, pair.armA));
    scatterAddTwist<N>(v.q, rowB + at, -shiftWrench(w, pair.armB));
  });
}

void multiplyTets(const BatchView& v) {
  forLanes(v.tets.tiles, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const NodeOp<R> op = v.tets.op[t].load<N>(o);
    V3<R> p[4];
    gatherNodes(v, v.p, at, p);
    R sum = zero<R>();
    for (int i = 0; i < 4; ++i) sum = sum + dot(op.lin[i], p[i]);
    const R force = sum * op.k;
    for (int i = 0; i < 4; ++i)
      scatterAddTwist<N>(v.q, v.tets.node[i] + at, Twist<R>{op.lin[i] * force, zeroV3<R>()});
  });
}

void multiply(const BatchView& v) {
  for (uint32_t i = 0; i < v.rows; i += N) {
    const MassRow m = loadMass(v.diagonal + 8 * i);
    const Twist<R> p = lane::loadTwists<N>(v.p + 8 * i);
    lane::storeTwists<N>(v.q + 8 * i, Twist<R>{p.lin * m.linear, m.angular * p.ang});
  }
  const Tile<PairOp>* op = v.op;
  multiplyPairs(v, v.contacts.a, v.contacts.b, op, v.contacts.tiles);
  op += v.contacts.tiles;
  multiplyPairs(v, v.balls.a, v.balls.b, op, v.balls.tiles);
  op += v.balls.tiles;
  multiplyPairs(v, v.fixed.a, v.fixed.b, op, v.fixed.tiles);
  multiplyTets(v);
}

// ---- Vectors ---------------------------------------------------------------------------------------------------

/// Sixteen sums side by side, two rows at a time, then halved: the same order at every width.
float dotRows(const float* a, const float* b, uint32_t begin, uint32_t end) {
  alignas(64) float sum[16] = {};
  uint32_t i = 8 * begin;
  for (; i + 16 <= 8 * end; i += 16)
    for (int k = 0; k < 16; k += N)
      lane::store(sum + k, lane::load<R>(sum + k) + lane::loadUnaligned<R>(a + i + k) * lane::loadUnaligned<R>(b + i + k));
  for (int k = 0; i < 8 * end; ++i, ++k) sum[k] += a[i] * b[i];
  for (int half = 8; half > 0; half /= 2)
    for (int k = 0; k < half; ++k) sum[k] += sum[k + half];
  return sum[0];
}

AVBD_INLINE constexpr uint32_t step() { return N < 8 ? N : 8; }
using Row = lane::Real<(N < 8 ? N : 8)>;

void addScaled(float* y, const float* x, float s, uint32_t begin, uint32_t end) {
  for (uint32_t i = 8 * begin; i < 8 * end; i += step())
    lane::storeUnaligned(y + i, lane::loadUnaligned<Row>(y + i) + splat<Row>(s) * lane::loadUnaligned<Row>(x + i));
}

void scaleAdd(float* y, const float* x, float s, uint32_t begin, uint32_t end) {
  for (uint32_t i = 8 * begin; i < 8 * end; i += step())
    lane::storeUnaligned(y + i, lane::loadUnaligned<Row>(x + i) + splat<Row>(s) * lane::loadUnaligned<Row>(y + i));
}

}  // namespace

extern const Backend kBackend;
const Backend kBackend = {N,        prepareContacts, beginIteration, stampRows, updateRows, factor,
                          precondition, multiply,    dotRows,        addScaled, scaleAdd};

}  // namespace avbd::AVBD_LANES_NAMESPACE
