// For tests: a batch of random bodies and rows, and the system that one outer iteration solves, dense and in double.
#pragma once

#include <vector>

#include "base/aligned.h"
#include "solve/batch.h"
#include "solve/geometric.h"
#include "solve/rows_oracle.h"
#include "solve/tree.h"

namespace avbd::oracle {

// ---- Dense systems ---------------------------------------------------------------------------------------------

struct DenseMatrix {
  size_t n;
  std::vector<double> a;
  explicit DenseMatrix(size_t size) : n(size), a(size * size, 0.0) {}
  double& at(size_t i, size_t j) { return a[i * n + j]; }
  double at(size_t i, size_t j) const { return a[i * n + j]; }
};

/// By elimination with row pivoting; a singular matrix gives NaN.
inline std::vector<double> solveDense(DenseMatrix m, std::vector<double> b) {
  for (size_t j = 0; j < m.n; ++j) {
    size_t pivot = j;
    for (size_t i = j + 1; i < m.n; ++i)
      if (std::fabs(m.at(i, j)) > std::fabs(m.at(pivot, j))) pivot = i;
    for (size_t k = j; k < m.n; ++k) std::swap(m.at(j, k), m.at(pivot, k));
    std::swap(b[j], b[pivot]);
    for (size_t i = j + 1; i < m.n; ++i) {
      const double f = m.at(i, j) / m.at(j, j);
      for (size_t k = j; k < m.n; ++k) m.at(i, k) -= f * m.at(j, k);
      b[i] -= f * b[j];
    }
  }
  for (size_t i = m.n; i-- > 0;) {
    for (size_t k = i + 1; k < m.n; ++k) b[i] -= m.at(i, k) * b[k];
    b[i] /= m.at(i, i);
  }
  return b;
}

// ---- A batch that owns its memory ------------------------------------------------------------------------------

template <template <class> class F>
struct Placed {
  uint32_t a, b;
  F<float> rows;
};
struct PlacedTet {
  uint32_t node[4];
  rows::TetVolume<float> rows;
};

class TestBatch {
 public:
  static constexpr float kStep = 1.0f / 60;

  // What the batch holds; view() lays it out.
  std::vector<Placed<rows::Contact>> contacts;
  std::vector<Placed<rows::BallJoint>> balls;
  std::vector<Placed<rows::FixedJoint>> fixed;
  std::vector<Placed<rows::FullContact>> full;
  std::vector<PlacedTet> tets;
  std::vector<IslandRange> islands;
  std::vector<uint32_t> locked;
  std::vector<uint8_t> locks;
  Forest forest;
  AlignedVector<float> d, target, mass, invMass, diagonal, gradient, hessian, elementBlocks, x, r, z, p, q, step,
      product;

  TestBatch(uint32_t dynamicBodies, uint32_t kinematicBodies) : bodies_(dynamicBodies) {
    rows_ = (dynamicBodies + 1 + kinematicBodies + kTile - 1) / kTile * kTile;
    for (auto* array : {&d, &target, &mass, &invMass, &diagonal, &gradient, &x, &r, &z, &p, &q})
      array->assign(8 * rows_, 0.0f);
    hessian.assign(kHessianRow * rows_, 0.0f);
    elementBlocks.assign(8 * rows_, 0.0f);
    step.assign(rows_, 0.0f), product.assign(rows_, 0.0f);
    inverse_.resize(rows_ / kTile);
  }
  uint32_t bodies() const { return bodies_; }
  uint32_t staticRow() const { return bodies_; }
  uint32_t kinematicRow(uint32_t i) const { return bodies_ + 1 + i; }

  /// A body of some kilograms, on its way.
  void fillBody(uint32_t row, Random& random, float kilograms) {
    rows::Sym3<float> inertia = rows::diagonal(V3<float>{1.0f, 1.3f, 1.7f} * (0.1f * kilograms));
    inertia = rotated(inertia, randomTurn(random, 1));
    const float scale = 1 / (kStep * kStep);
    put(mass, row, kilograms * scale, inertia * scale);
    put(invMass, row, 1 / kilograms, inverse(inertia));
    put(d, row, randomMotion(random));
    put(target, row, randomMotion(random));
  }
  void fillKinematic(uint32_t row, Random& random) { put(d, row, randomMotion(random)); }
  rows::Twist<float> motion(uint32_t row) const {
    const float* m = d.data() + 8 * row;
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}};
  }

  BatchView view() {
    BatchView v;
    v.bodies = bodies_, v.rows = rows_;
    v.islands = static_cast<uint32_t>(islands.size()), v.island = islands.data();
    v.d = d.data(), v.target = target.data(), v.mass = mass.data(), v.invMass = invMass.data();
    v.diagonal = diagonal.data(), v.gradient = gradient.data(), v.hessian = hessian.data();
    v.elementBlocks = elementBlocks.data();
    v.inverse = inverse_.data();
    v.x = x.data(), v.r = r.data(), v.z = z.data(), v.p = p.data(), v.q = q.data();
    v.step = step.data(), v.product = product.data();
    v.contacts = layOut(contacts, contactLanes_);
    chunk_ = {{0, rows_}, {0, v.contacts.tiles}};
    v.chunks = {&chunk_, 1};
    v.balls = layOut(balls, ballLanes_);
    v.fixed = layOut(fixed, fixedLanes_);
    v.full = layOut(full, fullLanes_);
    fullOp_.resize(v.full.tiles);
    v.fullOp = fullOp_.data();
    layOutTets(v.tets);
    op_.resize(v.contacts.tiles + v.balls.tiles + v.fixed.tiles);
    v.op = op_.data();
    v.locked = locked.data(), v.locks = locks.data(), v.lockedCount = static_cast<uint32_t>(locked.size());
    return v;
  }
  const rows::Contact<float> contactAfter(size_t i) const { return contactLanes_.tile[i / kTile].get(int(i % kTile)); }

 private:
  template <template <class> class F>
  struct Lanes {
    AlignedVector<Tile<F>> tile;
    std::vector<uint32_t> a, b;
  };

  static rows::Twist<float> randomMotion(Random& random) {
    return {randomVector(random, 0.05f), randomVector(random, 0.05f)};
  }
  static void put(AlignedVector<float>& array, uint32_t row, const rows::Twist<float>& twist) {
    float* to = array.data() + 8 * row;
    oracle::put(to, twist.lin), oracle::put(to + 4, twist.ang);
  }
  static void put(AlignedVector<float>& array, uint32_t row, float linear, const rows::Sym3<float>& s) {
    const float value[7] = {linear, s.xx, s.yy, s.zz, s.xy, s.xz, s.yz};
    std::copy(std::begin(value), std::end(value), array.data() + 8 * row);
  }

  template <template <class> class F>
  PairTiles<F> layOut(const std::vector<Placed<F>>& list, Lanes<F>& lanes) {
    const size_t tiles = (list.size() + kTile - 1) / kTile;
    F<float> none{};
    if constexpr (requires { none.q0; }) none.q0 = {1, 0, 0, 0};
    lanes.tile.resize(tiles);
    lanes.a.assign(tiles * kTile, staticRow());
    lanes.b.assign(tiles * kTile, staticRow());
    for (size_t i = 0; i < tiles * kTile; ++i) {
      lanes.tile[i / kTile].set(int(i % kTile), i < list.size() ? list[i].rows : none);
      if (i < list.size()) lanes.a[i] = list[i].a, lanes.b[i] = list[i].b;
    }
    return {lanes.tile.data(), lanes.a.data(), lanes.b.data(), static_cast<uint32_t>(tiles)};
  }

  void layOutTets(NodeTiles<rows::TetVolume, NodeOp>& to) {
    const size_t tiles = (tets.size() + kTile - 1) / kTile;
    tetTile_.resize(tiles), tetOp_.resize(tiles);
    for (int k = 0; k < 4; ++k) tetNode_[k].assign(tiles * kTile, staticRow());
    for (size_t i = 0; i < tiles * kTile; ++i) {
      tetTile_[i / kTile].set(int(i % kTile), i < tets.size() ? tets[i].rows : rows::TetVolume<float>{});
      for (int k = 0; k < 4 && i < tets.size(); ++k) tetNode_[k][i] = tets[i].node[k];
    }
    to.tile = tetTile_.data(), to.op = tetOp_.data(), to.tiles = static_cast<uint32_t>(tiles);
    for (int k = 0; k < 4; ++k) to.node[k] = tetNode_[k].data();
  }

  uint32_t bodies_, rows_;
  Chunk chunk_;
  AlignedVector<Tile<rows::Sym6>> inverse_;
  Lanes<rows::Contact> contactLanes_;
  Lanes<rows::BallJoint> ballLanes_;
  Lanes<rows::FixedJoint> fixedLanes_;
  Lanes<rows::FullContact> fullLanes_;
  AlignedVector<Tile<rows::TetVolume>> tetTile_;
  std::vector<uint32_t> tetNode_[4];
  AlignedVector<Tile<PairOp>> op_;
  AlignedVector<Tile<ScaledOp>> fullOp_;
  AlignedVector<Tile<NodeOp>> tetOp_;
};

// ---- Random trees ----------------------------------------------------------------------------------------------

/// Where a tree hangs: nowhere (kFree), or on a row (static or kinematic).
inline constexpr uint32_t kFree = 0xffffffffu;

/// Joins the bodies of `row` to a random tree; the first hangs on `support`. Ball and fixed joints, either way round.
inline void plantTree(TestBatch& batch, const std::vector<uint32_t>& row, uint32_t support, Random& random) {
  Forest& forest = batch.forest;
  const int32_t first = static_cast<int32_t>(forest.nodes.size());
  for (size_t i = 0; i < row.size(); ++i) {
    TreeNode& node = forest.nodes.emplace_back();
    node.row = row[i];
    const size_t parent = i == 0 ? 0 : random.bits() % i;
    if (i > 0) node.parent = first + static_cast<int32_t>(parent);
    if (i == 0 && support == kFree) continue;
    node.joint = static_cast<int32_t>(forest.joints.size());
    TreeJoint& joint = forest.joints.emplace_back();
    const uint32_t other = i == 0 ? support : row[parent];
    joint.childIsA = random.bits() % 2;
    joint.rowA = joint.childIsA ? row[i] : other;
    joint.rowB = joint.childIsA ? other : row[i];
    joint.angular = random.bits() % 2;
    joint.m = joint.angular ? 6 : 3;
    joint.rows = RandomRows<rows::FixedJoint>::any(random);
  }
}

// ---- The system of one outer iteration -------------------------------------------------------------------------

/// [H J^T; J 0] (x, mu) = (-gradient, -C): 6 unknowns a body, then the multipliers of the forest's joints, in order.
struct DenseSystem {
  DenseMatrix m;
  std::vector<double> right;
};

namespace dense {

/// Column of a block's unknown, or none for bodies that do not move.
struct Columns {
  uint32_t row[4];
  int perBlock;
  uint32_t bodies;
  int of(int unknown) const {
    const uint32_t body = row[unknown / perBlock];
    return body < bodies ? static_cast<int>(6 * body) + unknown % perBlock : -1;
  }
};

/// Factors on what rows do to the blocks: on forces, and on J in the Hessian.
struct Scales {
  double force[4] = {1, 1, 1, 1}, hessian[4] = {1, 1, 1, 1};
};

inline void addRows(DenseSystem& s, const RowList<float>& list, const Columns& columns, const Scales& scales = {}) {
  for (int i = 0; i < list.count; ++i)
    for (int u = 0; u < list.unknowns; ++u) {
      if (columns.of(u) < 0) continue;
      const size_t cu = static_cast<size_t>(columns.of(u));
      const int block = u / columns.perBlock;
      s.right[cu] -= double(list.J[i][u]) * list.force[i] * scales.force[block];
      for (int w = 0; w < list.unknowns; ++w)
        if (columns.of(w) >= 0)
          s.m.at(cu, static_cast<size_t>(columns.of(w))) += double(list.k[i]) * list.share[i] * list.J[i][u] *
                                                            list.J[i][w] * scales.hessian[block] *
                                                            scales.hessian[w / columns.perBlock];
    }
}

inline void addAngular(DenseSystem& s, uint32_t bodies, uint32_t row, const rows::Sym3<float>& g) {
  if (row >= bodies) return;
  const float value[3][3] = {{g.xx, g.xy, g.xz}, {g.xy, g.yy, g.yz}, {g.xz, g.yz, g.zz}};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) s.m.at(6 * row + 3 + i, 6 * row + 3 + j) += value[i][j];
}

/// Of a joint that pulls A with the force -`force` at its anchors.
inline void addGeometric(DenseSystem& s, const TestBatch& batch, uint32_t a, uint32_t b, V3<float> force,
                         rows::BallJoint<float> ball) {
  rows::ProbeSink<float, 3> probe;
  ball.rows(batch.motion(a), batch.motion(b), probe);
  addAngular(s, batch.bodies(), a, rows::geometricStiffness(-force, probe.armA));
  addAngular(s, batch.bodies(), b, rows::geometricStiffness(force, probe.armB));
}

template <template <class> class F>
RowList<float> addPair(DenseSystem& s, const TestBatch& batch, Placed<F> pair, const Scales& scales = {}) {
  float d[12];
  const rows::Twist<float> dA = batch.motion(pair.a), dB = batch.motion(pair.b);
  put(d, dA.lin), put(d + 3, dA.ang), put(d + 6, dB.lin), put(d + 9, dB.ang);
  RowList<float> list = listRows<F, float>(pair.rows, d);
  addRows(s, list, {{pair.a, pair.b}, 6, batch.bodies()}, scales);
  return list;
}

inline void addInertia(DenseSystem& s, const TestBatch& batch) {
  for (uint32_t body = 0; body < batch.bodies(); ++body) {
    const float* m = batch.mass.data() + 8 * body;
    const float block[3][3] = {{m[1], m[4], m[5]}, {m[4], m[2], m[6]}, {m[5], m[6], m[3]}};
    const float *d = batch.d.data() + 8 * body, *y = batch.target.data() + 8 * body;
    for (size_t i = 0; i < 3; ++i) {
      s.m.at(6 * body + i, 6 * body + i) += m[0];
      s.right[6 * body + i] -= double(m[0]) * (double(d[i]) - y[i]);
      for (size_t j = 0; j < 3; ++j) {
        s.m.at(6 * body + 3 + i, 6 * body + 3 + j) += block[i][j];
        s.right[6 * body + 3 + i] -= double(block[i][j]) * (double(d[4 + j]) - y[4 + j]);
      }
    }
  }
}

/// A tree's joint: no stiffness; its multipliers act now, and its rows are constraints.
inline void addTreeJoint(DenseSystem& s, const TestBatch& batch, const TreeJoint& joint, size_t at) {
  Placed<rows::FixedJoint> pair{joint.rowA, joint.rowB, joint.rows};
  float d[12];
  const rows::Twist<float> dA = batch.motion(pair.a), dB = batch.motion(pair.b);
  put(d, dA.lin), put(d + 3, dA.ang), put(d + 6, dB.lin), put(d + 9, dB.ang);
  const RowList<float> list = listRows<rows::FixedJoint, float>(pair.rows, d);
  const Columns columns{{pair.a, pair.b}, 6, batch.bodies()};
  for (int i = 0; i < joint.m; ++i) {
    const size_t row = at + static_cast<size_t>(i);
    s.right[row] = -double(list.C[i]);
    for (int u = 0; u < 12; ++u) {
      if (columns.of(u) < 0) continue;
      const size_t column = static_cast<size_t>(columns.of(u));
      s.m.at(row, column) = s.m.at(column, row) = list.J[i][u];
      s.right[column] -= double(list.J[i][u]) * *list.lambda[i];
    }
  }
  addGeometric(s, batch, pair.a, pair.b, joint.rows.ball.lambda, joint.rows.ball);
}

/// Locked unknowns do not move and are felt by nobody.
inline void lock(DenseSystem& s, const TestBatch& batch) {
  for (size_t i = 0; i < batch.locked.size(); ++i)
    for (size_t axis = 0; axis < 6; ++axis) {
      if (!(batch.locks[i] >> axis & 1)) continue;
      const size_t unknown = 6 * batch.locked[i] + axis;
      for (size_t k = 0; k < s.m.n; ++k) s.m.at(unknown, k) = s.m.at(k, unknown) = 0;
      s.m.at(unknown, unknown) = 1;
      s.right[unknown] = 0;
    }
}

}  // namespace dense

/// How full contacts enter the Hessian: as the products of the conjugate gradients have it, or with each body's own
/// block as the sweep has it.
enum class Scaling : uint8_t { Products, OwnBlocks };

/// The system at the batch's present d and multipliers.
inline DenseSystem systemOf(const TestBatch& batch, Scaling scaling = Scaling::Products) {
  size_t n = 6 * batch.bodies();
  for (const TreeJoint& joint : batch.forest.joints) n += static_cast<size_t>(joint.m);
  DenseSystem s{DenseMatrix(n), std::vector<double>(n, 0.0)};
  dense::addInertia(s, batch);
  for (const auto& pair : batch.contacts) dense::addPair(s, batch, pair);
  for (const auto& pair : batch.balls) {
    const RowList<float> list = dense::addPair(s, batch, pair);
    dense::addGeometric(s, batch, pair.a, pair.b, {list.force[0], list.force[1], list.force[2]}, pair.rows);
  }
  for (const auto& pair : batch.fixed) {
    const RowList<float> list = dense::addPair(s, batch, pair);
    dense::addGeometric(s, batch, pair.a, pair.b, {list.force[0], list.force[1], list.force[2]}, pair.rows.ball);
  }
  for (const auto& pair : batch.full) {
    const auto& c = pair.rows;
    dense::Scales scales{{c.scaleA, c.scaleB}, {c.hessianA, c.hessianB}};
    if (scaling == Scaling::OwnBlocks) scales.hessian[0] = std::sqrt(c.scaleA), scales.hessian[1] = std::sqrt(c.scaleB);
    dense::addPair(s, batch, pair, scales);
  }
  for (PlacedTet tet : batch.tets) {
    float d[12];
    for (int i = 0; i < 4; ++i) put(d + 3 * i, batch.motion(tet.node[i]).lin);
    const RowList<float> list = listRows<rows::TetVolume, float>(tet.rows, d);
    dense::addRows(s, list, {{tet.node[0], tet.node[1], tet.node[2], tet.node[3]}, 3, batch.bodies()});
  }
  size_t at = 6 * batch.bodies();
  for (const TreeJoint& joint : batch.forest.joints) {
    dense::addTreeJoint(s, batch, joint, at);
    at += static_cast<size_t>(joint.m);
  }
  dense::lock(s, batch);
  return s;
}

/// Unknown `k` (0 .. 5) of a body in an array of body rows.
inline size_t rowEntry(uint32_t body, size_t k) { return 8 * body + (k < 3 ? k : k + 1); }

/// Stiffness of a step's rows: c = 10 over the compliance that a kilogram has, up to ten times that.
inline void soften(float& k, Random& random) { k = randomSize(random, 1, 10) * 1e4f; }

inline void addContact(TestBatch& batch, uint32_t a, uint32_t b, Random& random) {
  rows::Contact<float> c = RandomRows<rows::Contact>::any(random);
  for (auto& p : c.point)
    if (p.floorN > 0) soften(p.floorN, random), soften(p.floorT, random), p.lambdaN *= 0.1f;
  batch.contacts.push_back({a, b, c});
}

inline void addFull(TestBatch& batch, uint32_t a, uint32_t b, Random& random) {
  rows::FullContact<float> f = RandomRows<rows::FullContact>::any(random);
  for (auto& p : f.contact.point)
    if (p.floorN > 0) soften(p.floorN, random), soften(p.floorT, random), p.lambdaN *= 0.1f;
  soften(f.kTorsion, random), soften(f.kRolling, random);
  batch.full.push_back({a, b, f});
}

inline void addJoint(TestBatch& batch, uint32_t a, uint32_t b, Random& random) {
  rows::FixedJoint<float> f = RandomRows<rows::FixedJoint>::any(random);
  soften(f.ball.k, random), soften(f.kAngular, random);
  if (random.bits() % 2)
    batch.fixed.push_back({a, b, f});
  else
    batch.balls.push_back({a, b, f.ball});
}

}  // namespace avbd::oracle
