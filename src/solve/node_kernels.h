// The kernels of what joins four nodes by their linear motions, for kernels.h: elements of soft bodies, and contacts of
// points with faces.

namespace avbd::AVBD_LANES_NAMESPACE {
namespace {

using NodeRows = const uint32_t* const (&)[4];  ///< body rows of the four nodes, by lane

AVBD_INLINE void gatherNodes(NodeRows rows, const float* array, uint32_t at, V3<R> (&node)[4]) {
  for (int i = 0; i < 4; ++i) node[i] = gatherTwist<N>(array, rows[i] + at).lin;
}

/// Adds K values a node to rows of an array, lane after lane and node after node.
template <int K>
AVBD_INLINE void scatterNodes(float* array, int stride, NodeRows rows, uint32_t at, const R (&value)[4][K]) {
  alignas(64) float lanes[4][K][N];
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < K; ++k) lane::store(lanes[i][k], value[i][k]);
  for (uint32_t l = 0; l < N; ++l)
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < K; ++k) array[size_t(rows[i][at + l]) * static_cast<size_t>(stride) + k] += lanes[i][k][l];
}

AVBD_INLINE void scatterVectors(float* array, NodeRows rows, uint32_t at, const V3<R> (&value)[4]) {
  R out[4][3];
  for (int i = 0; i < 4; ++i) out[i][0] = value[i].x, out[i][1] = value[i].y, out[i][2] = value[i].z;
  scatterNodes(array, 8, rows, at, out);
}

/// Of the nodes' blocks of 3 x 3.
AVBD_INLINE void scatterBlocks(const BatchView& v, NodeRows rows, uint32_t at, const Sym3<R> (&block)[4]) {
  R out[4][6];
  for (int i = 0; i < 4; ++i) {
    const Sym3<R>& m = block[i];
    const R entries[6] = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
    for (int k = 0; k < 6; ++k) out[i][k] = entries[k];
  }
  scatterNodes(v.hessian, kHessianRow, rows, at, out);
}

void stampElastic(const BatchView& v) {
  const ElasticTiles& all = v.elastic;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const TetElastic<R> tet = all.tile[t].load<N>(o);
    V3<R> d[4], gradient[4];
    gatherNodes(all.node, v.d, at, d);
    const Deformation<R> s = tet.deformation(d);
    tet.gradient(s, gradient);
    all.op[t].store<N>(o, tet.op(s));
    scatterVectors(v.gradient, all.node, at, gradient);
    const V3<R> g[4] = {-(tet.gb + tet.gc + tet.gd), tet.gb, tet.gc, tet.gd};
    Sym3<R> block[4];
    for (int i = 0; i < 4; ++i) block[i] = tet.block(s, g[i]);
    scatterBlocks(v, all.node, at, block);
  });
}

void stampTriangles(const BatchView& v) {
  const TriangleTiles& all = v.triangles;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const TriangleElastic<R> triangle = all.tile[t].load<N>(o);
    V3<R> d[4], gradient[4];
    gatherNodes(all.node, v.d, at, d);
    const Stretch<R> s = triangle.stretch(d);
    triangle.gradient(s, gradient);
    all.op[t].store<N>(o, triangle.op(s));
    scatterVectors(v.gradient, all.node, at, gradient);
    const Sym3<R> block[4] = {triangle.block(s, -(triangle.bx + triangle.cx), -(triangle.by + triangle.cy)),
                              triangle.block(s, triangle.bx, triangle.by), triangle.block(s, triangle.cx, triangle.cy),
                              diagonal(zeroV3<R>())};
    scatterBlocks(v, all.node, at, block);
  });
}

void stampBends(const BatchView& v) {
  const BendTiles& all = v.bends;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    const ClothBend<R> bend = all.tile[t].load<N>(o);
    V3<R> d[4], gradient[4];
    gatherNodes(all.node, v.d, at, d);
    bend.gradient(d, gradient);
    const NodeContactOp<R> op = bend.op();
    all.op[t].store<N>(o, op);
    scatterVectors(v.gradient, all.node, at, gradient);
    Sym3<R> block[4];
    for (int i = 0; i < 4; ++i) block[i] = op.stiffness * (bend.weight[i] * bend.weight[i]);
    scatterBlocks(v, all.node, at, block);
  });
}

/// Of elements of any kind that multiply() knows.
template <template <class> class Op>
void multiplyElements(const BatchView& v, NodeRows rows, const Tile<Op>* op, uint32_t tiles) {
  forLanes({0, tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    V3<R> p[4], out[4];
    gatherNodes(rows, v.p, at, p);
    multiply(op[t].template load<N>(o), p, out);
    scatterVectors(v.q, rows, at, out);
  });
}

void multiplyElastic(const BatchView& v) {
  multiplyElements<ElasticOp>(v, v.elastic.node, v.elastic.op, v.elastic.tiles);
  multiplyElements<TriangleOp>(v, v.triangles.node, v.triangles.op, v.triangles.tiles);
  multiplyElements<NodeContactOp>(v, v.bends.node, v.bends.op, v.bends.tiles);
  multiplyElements<NodeContactOp>(v, v.nodeContacts.node, v.nodeContacts.op, v.nodeContacts.tiles);
}

void prepareNodeContacts(const BatchView& v, float factor) {
  const NodeContactTiles& all = v.nodeContacts;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    NodeContact<R> c = all.tile[t].load<N>(o);
    R w = zero<R>();
    for (int i = 0; i < 4; ++i)
      w = w + c.weight[i] * c.weight[i] * gatherInverseMass(v.invMass, all.node[i] + at).linear;
    c.floorN = floorStiffness(c.floorN, w, factor);
    c.floorT = floorStiffness(c.floorT, w, factor);
    all.tile[t].store<N>(o, c);
  });
}

void stampNodeContacts(const BatchView& v, float leak, bool dual) {
  const NodeContactTiles& all = v.nodeContacts;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    const uint32_t at = t * kTile + static_cast<uint32_t>(o);
    NodeContact<R> c = all.tile[t].load<N>(o);
    V3<R> d[4], gradient[4];
    gatherNodes(all.node, v.d, at, d);
    if (dual) {
      DualSink<R> sink{splat<R>(leak)};
      c.rows(d, sink);
      all.tile[t].store<N>(o, c);
    }
    StampSink<R> sink;
    sink.clear();
    c.rows(d, sink);
    NodeContactOp<R> op{{c.weight[0], c.weight[1], c.weight[2], c.weight[3]}, sink.stiffness.ll};
    all.op[t].store<N>(o, op);
    Sym3<R> block[4];
    for (int i = 0; i < 4; ++i) {
      gradient[i] = sink.wrench.lin * c.weight[i];
      block[i] = op.stiffness * (c.weight[i] * c.weight[i]);
    }
    scatterVectors(v.gradient, all.node, at, gradient);
    scatterBlocks(v, all.node, at, block);
  });
}

void dualNodeContacts(const BatchView& v, float leak) {
  const NodeContactTiles& all = v.nodeContacts;
  forLanes({0, all.tiles}, [&](uint32_t t, int o) {
    NodeContact<R> c = all.tile[t].load<N>(o);
    V3<R> d[4];
    gatherNodes(all.node, v.d, t * kTile + static_cast<uint32_t>(o), d);
    DualSink<R> sink{splat<R>(leak)};
    c.rows(d, sink);
    all.tile[t].store<N>(o, c);
  });
}

}  // namespace
}  // namespace avbd::AVBD_LANES_NAMESPACE
