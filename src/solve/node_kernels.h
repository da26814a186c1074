// The kernels of what joins four nodes by their linear motions, for kernels.h: elements of soft bodies, and contacts of
// points with faces.

namespace avbd::AVBD_LANES_NAMESPACE {
namespace {

using NodeRows = const uint32_t* const (&)[4];  ///< body rows of the four nodes, by lane

AVBD_INLINE void gatherNodes(NodeRows rows, const float* array, uint32_t at, V3<R> (&node)[4]) {
  for (int i = 0; i < 4; ++i) {
    R linear[4];
    lane::gatherRows<N>(array, 8, rows[i] + at, linear);
    node[i] = {linear[0], linear[1], linear[2]};
  }
}

/// Adds K values a node to rows of an array, lane after lane and node after node.
template <int nodes, int K>
AVBD_INLINE void scatterNodes(float* array, int stride, NodeRows rows, uint32_t at, const R (&value)[4][K]) {
  alignas(64) float lanes[nodes][K][N];
  for (int i = 0; i < nodes; ++i)
    for (int k = 0; k < K; ++k) lane::store(lanes[i][k], value[i][k]);
  for (uint32_t l = 0; l < N; ++l)
    for (int i = 0; i < nodes; ++i)
      for (int k = 0; k < K; ++k) array[size_t(rows[i][at + l]) * static_cast<size_t>(stride) + k] += lanes[i][k][l];
}

/// The same of the linear parts of body rows, of the first `nodes` nodes.
template <int nodes>
AVBD_INLINE void scatterVectors(float* array, NodeRows rows, uint32_t at, const V3<R> (&value)[4]) {
  using Row = lane::Wide<4>;
  alignas(64) float lanes[nodes][N][4];
  for (int i = 0; i < nodes; ++i) {
    const R columns[4] = {value[i].x, value[i].y, value[i].z, zero<R>()};
    lane::storeRows<N>(lanes[i][0], 4, columns);
  }
  for (uint32_t l = 0; l < N; ++l)
    for (int i = 0; i < nodes; ++i) {
      float* row = array + size_t(8) * rows[i][at + l];
      lane::store(row, lane::load<Row>(row) + lane::load<Row>(lanes[i][l]));
    }
}

/// Of the nodes' blocks of 3 x 3.
template <int nodes>
AVBD_INLINE void scatterBlocks(float* array, int stride, NodeRows rows, uint32_t at, const Sym3<R> (&block)[4]) {
  R out[4][6];
  for (int i = 0; i < nodes; ++i) {
    const Sym3<R>& m = block[i];
    const R entries[6] = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
    for (int k = 0; k < 6; ++k) out[i][k] = entries[k];
  }
  scatterNodes<nodes>(array, stride, rows, at, out);
}

/// What an element adds to its nodes, and to the products.
template <class Op>
struct ElementStamp {
  V3<R> gradient[4];
  Op op;
};

template <class Op, class Tet>
AVBD_INLINE ElementStamp<Op> stampOfTet(const Tet& tet, const V3<R> (&d)[4]) {
  ElementStamp<Op> stamp;
  const auto s = tet.deformation(d);
  stamp.op = tet.op(s);
  tet.gradient(s, stamp.op, stamp.gradient);
  return stamp;
}

AVBD_INLINE auto stampOf(const TetElastic<R>& tet, const V3<R> (&d)[4]) { return stampOfTet<ElasticOp<R>>(tet, d); }
AVBD_INLINE auto stampOf(const TetCorotational<R>& tet, const V3<R> (&d)[4]) {
  return stampOfTet<TetCorotationalOp<R>>(tet, d);
}

template <class Op>
AVBD_INLINE void blocksOf(const TetElastic<R>& tet, const Op& op, Sym3<R> (&block)[4]) {
  const V3<R> g[4] = {-(tet.gb + tet.gc + tet.gd), tet.gb, tet.gc, tet.gd};
  for (int i = 0; i < 4; ++i) block[i] = solidBlock(op.solid, g[i]);
}

AVBD_INLINE ElementStamp<TriangleOp<R>> stampOf(const TriangleElastic<R>& triangle, const V3<R> (&d)[4]) {
  ElementStamp<TriangleOp<R>> stamp;
  const Stretch<R> s = triangle.stretch(d);
  triangle.gradient(s, stamp.gradient);
  stamp.op = triangle.op(s);
  return stamp;
}

AVBD_INLINE void blocksOf(const TriangleElastic<R>& triangle, const TriangleOp<R>& op, Sym3<R> (&block)[4]) {
  block[0] = triangleBlock(op, -(triangle.bx + triangle.cx), -(triangle.by + triangle.cy));
  block[1] = triangleBlock(op, triangle.bx, triangle.by);
  block[2] = triangleBlock(op, triangle.cx, triangle.cy);
  block[3] = diagonal(zeroV3<R>());
}

AVBD_INLINE ElementStamp<BendOp<R>> stampOf(const ClothBend<R>& bend, const V3<R> (&d)[4]) {
  ElementStamp<BendOp<R>> stamp;
  bend.gradient(d, stamp.gradient);
  stamp.op = bend.op();
  return stamp;
}

AVBD_INLINE void blocksOf(const ClothBend<R>& bend, const BendOp<R>&, Sym3<R> (&block)[4]) {
  for (int i = 0; i < 4; ++i) {
    const R k = bend.k * (bend.weight[i] * bend.weight[i]);
    block[i] = diagonal(V3<R>{k, k, k});
  }
}

constexpr int kElementBlock = 8;  ///< floats of a row of BatchView::elementBlocks

template <template <class> class Family, template <class> class Op>
void stampElements(const BatchView& v, const NodeTiles<Family, Op>& all, bool blocks) {
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    V3<R> d[4];
    gatherNodes(all.node, v.d, at, d);
    const Family<R> element = all.tile[t].template load<N>(o);
    const auto stamp = stampOf(element, d);
    all.op[t].template store<N>(o, stamp.op);
    scatterVectors<Family<R>::kBlocks>(v.gradient, all.node, at, stamp.gradient);
    if (!blocks) return;
    Sym3<R> block[4];
    blocksOf(element, stamp.op, block);
    scatterBlocks<Family<R>::kBlocks>(v.elementBlocks, kElementBlock, all.node, at, block);
  });
}

/// Tensions of limits of strain.
void dualTriangles(const BatchView& v) {
  const auto& all = v.triangles;
  if (!v.threads) return;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    TriangleElastic<R> triangle = all.tile[t].load<N>(o);
    V3<R> d[4];
    gatherNodes(all.node, v.d, t * kTile + static_cast<uint32_t>(o), d);
    triangle.tension = triangle.limitTension(triangle.stretch(d));
    all.tile[t].store<N>(o, triangle);
  });
}

void prepareTriangles(const BatchView& v, float factor) {
  const auto& all = v.triangles;
  if (!v.threads) return;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    TriangleElastic<R> c = all.tile[t].load<N>(o);
    const R x[3] = {-(c.bx + c.cx), c.bx, c.cx}, y[3] = {-(c.by + c.cy), c.by, c.cy};
    R w = zero<R>();
    for (int i = 0; i < 3; ++i)
      w = w + (x[i] * x[i] + y[i] * y[i]) * gatherInverseMass(v.invMass, all.node[i] + at).linear;
    c.floor = floorStiffness(c.floor, w * 0.5f, factor);
    all.tile[t].store<N>(o, c);
  });
}

/// H p of a row over four nodes.
AVBD_INLINE void multiply(const NodeOp<R>& op, const V3<R> (&p)[4], V3<R> (&out)[4]) {
  R sum = zero<R>();
  for (int i = 0; i < 4; ++i) sum = sum + dot(op.lin[i], p[i]);
  const R force = sum * op.k;
  for (int i = 0; i < 4; ++i) out[i] = op.lin[i] * force;
}

/// threads: as in BatchView, for what may have them.
template <template <class> class Family, template <class> class Op, class... Threads>
void multiplyElements(const BatchView& v, const NodeTiles<Family, Op>& all, Threads... threads) {
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    V3<R> p[4], out[4];
    gatherNodes(all.node, v.p, at, p);
    multiply(all.op[t].template load<N>(o), threads..., p, out);
    scatterVectors<Family<R>::kBlocks>(v.q, all.node, at, out);
  });
}

/// Adds vectors to the nodes, and a vector to the angular part of the first, lane after lane.
AVBD_INLINE void scatterTouch(float* array, NodeRows rows, uint32_t at, const V3<R> (&value)[4], const V3<R>& turn) {
  using Row = lane::Wide<4>;
  alignas(64) float lanes[5][N][4];
  for (int i = 0; i < 5; ++i) {
    const V3<R>& v = i < 4 ? value[i] : turn;
    const R columns[4] = {v.x, v.y, v.z, zero<R>()};
    lane::storeRows<N>(lanes[i][0], 4, columns);
  }
  const auto add = [](float* to, const float* by) { lane::store(to, lane::load<Row>(to) + lane::load<Row>(by)); };
  for (uint32_t l = 0; l < N; ++l) {
    for (int i = 0; i < 4; ++i) add(array + size_t(8) * rows[i][at + l], lanes[i][l]);
    add(array + size_t(8) * rows[0][at + l] + 4, lanes[4][l]);
  }
}

/// The same of blocks: the first node's is whole.
AVBD_INLINE void scatterTouchBlocks(const BatchView& v, NodeRows rows, uint32_t at, const Sym6<R>& first,
                                    const Sym3<R> (&block)[4]) {
  constexpr int kWhole = 24, kLinear = 6;
  alignas(64) float whole[N][kWhole], lanes[3][kLinear][N];
  lane::storeSym6<N>(whole[0], first);
  for (int i = 0; i < 3; ++i) {
    const Sym3<R>& m = block[i + 1];
    const R entries[kLinear] = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
    for (int k = 0; k < kLinear; ++k) lane::store(lanes[i][k], entries[k]);
  }
  for (uint32_t l = 0; l < N; ++l) {
    float* to = v.hessian + size_t(kHessianRow) * rows[0][at + l];
    for (int k = 0; k < 21; ++k) to[k] += whole[l][k];
    for (int i = 0; i < 3; ++i) {
      to = v.hessian + size_t(kHessianRow) * rows[i + 1][at + l];
      for (int k = 0; k < kLinear; ++k) to[k] += lanes[i][k][l];
    }
  }
}

/// Motion of the nodes, and the turn of the first.
AVBD_INLINE void gatherTouch(NodeRows rows, const float* array, uint32_t at, V3<R> (&node)[4], V3<R>& turn) {
  gatherNodes(rows, array, at, node);
  R angular[4];
  lane::gatherRows<N>(array + 4, 8, rows[0] + at, angular);
  turn = {angular[0], angular[1], angular[2]};
}

void multiplyNodeContacts(const BatchView& v) {
  const auto& all = v.nodeContacts;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    V3<R> p[4], turn, out[4], outTurn;
    gatherTouch(all.node, v.p, at, p, turn);
    multiply(all.op[t].template load<N>(o), p, turn, out, outTurn);
    scatterTouch(v.q, all.node, at, out, outTurn);
  });
}

void multiplySofts(const BatchView& v) {
  multiplyElements(v, v.elastic, v.threads);
  multiplyElements(v, v.corotational, v.threads);
  multiplyElements(v, v.triangles, v.threads);
  multiplyElements(v, v.bends);
  multiplyNodeContacts(v);
}

void prepareNodeContacts(const BatchView& v, float factor) {
  const auto& all = v.nodeContacts;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    NodeContact<R> c = all.tile[t].load<N>(o);
    R corners = zero<R>();
    for (int i = 1; i < 4; ++i)
      corners = corners + c.weight[i] * c.weight[i] * gatherInverseMass(v.invMass, all.node[i] + at).linear;
    const InverseMass first = gatherInverseMass(v.invMass, all.node[0] + at);
    const auto along = [&](const V3<R>& axis) {
      return corners + c.weight[0] * c.weight[0] * inverseMassAlong(first, c.arm, axis);
    };
    c.floorN = floorStiffness(c.floorN, along(c.n), factor);
    c.floorT = floorStiffness(c.floorT, max(along(c.t1), along(c.t2)), factor);
    all.tile[t].store<N>(o, c);
  });
}

void stampNodeContacts(const BatchView& v, float leak, bool dual) {
  const auto& all = v.nodeContacts;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    NodeContact<R> c = all.tile[t].load<N>(o);
    V3<R> d[4], turn, gradient[4];
    gatherTouch(all.node, v.d, at, d, turn);
    if (dual) {
      DualSink<R> sink{splat<R>(leak)};
      c.rows(d, turn, sink);
      all.tile[t].store<N>(o, c);
    }
    StampSink<R> sink;
    sink.clear();
    c.rows(d, turn, sink);
    NodeContactOp<R> op{{c.weight[0], c.weight[1], c.weight[2], c.weight[3]}, c.arm, sink.stiffness.ll};
    all.op[t].store<N>(o, op);
    Sym3<R> block[4];
    for (int i = 0; i < 4; ++i) {
      gradient[i] = sink.wrench.lin * c.weight[i];
      block[i] = op.stiffness * (c.weight[i] * c.weight[i]);
    }
    Sym6<R> first = zeroSym6<R>();
    first.ll = block[0];
    scatterTouch(v.gradient, all.node, at, gradient, cross(c.arm, gradient[0]));
    scatterTouchBlocks(v, all.node, at, shifted(first, c.arm), block);
  });
}

void dualNodeContacts(const BatchView& v, float leak) {
  const auto& all = v.nodeContacts;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    NodeContact<R> c = all.tile[t].load<N>(o);
    V3<R> d[4], turn;
    gatherTouch(all.node, v.d, t * kTile + static_cast<uint32_t>(o), d, turn);
    DualSink<R> sink{splat<R>(leak)};
    c.rows(d, turn, sink);
    all.tile[t].store<N>(o, c);
  });
}

/// Dual update of rows over four nodes.
template <template <class> class Family, template <class> class Op, class Sink>
void dualNodes(const BatchView& v, const NodeTiles<Family, Op>& all, Sink sink) {
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    Family<R> rows = all.tile[t].template load<N>(o);
    V3<R> d[4];
    gatherNodes(all.node, v.d, t * kTile + static_cast<uint32_t>(o), d);
    rows.rows(d, sink);
    all.tile[t].template store<N>(o, rows);
  });
}

void dualTets(const BatchView& v) { dualNodes(v, v.tets, BlockDualSink<R, 4>{splat<R>(1)}); }

}  // namespace
}  // namespace avbd::AVBD_LANES_NAMESPACE
