// Exact trees against a dense solution in double.
#include "solve/tree.h"

#include <gtest/gtest.h>

#include "solve/backend.h"
#include "solve/batch_oracle.h"
#include "solve/locks.h"

namespace avbd::oracle {
namespace {

constexpr uint8_t kAll[2] = {1, 1};  ///< islands that take part

enum class Support { Free, Static, Kinematic };

struct TreeCase {
  uint32_t bodies;
  Support support;
  bool lock;
  float heavy;  ///< mass of the last body; the others weigh a kilogram
};

void PrintTo(const TreeCase& c, std::ostream* out) {
  *out << c.bodies << " bodies, support " << static_cast<int>(c.support) << (c.lock ? ", locks" : "") << ", " << c.heavy
       << " kg";
}

/// A tree over shuffled rows, so that no node stands in its row's place.
void build(TestBatch& batch, const TreeCase& c, Random& random) {
  std::vector<uint32_t> row(c.bodies);
  for (uint32_t i = 0; i < c.bodies; ++i) row[i] = i;
  for (uint32_t i = c.bodies; i > 1; --i) std::swap(row[i - 1], row[random.bits() % i]);
  for (uint32_t i = 0; i < c.bodies; ++i) batch.fillBody(row[i], random, i + 1 == c.bodies ? c.heavy : 1);
  batch.fillKinematic(batch.kinematicRow(0), random);
  const uint32_t support = c.support == Support::Free     ? kFree
                           : c.support == Support::Static ? batch.staticRow()
                                                          : batch.kinematicRow(0);
  plantTree(batch, row, support, random);
  batch.islands = {{0, c.bodies, true, true, c.support == Support::Free}};
  if (!c.lock) return;
  for (const TreeNode& node : batch.forest.nodes) {
    const bool root = node.joint < 0;
    if (!root && batch.forest.joints[static_cast<size_t>(node.joint)].angular) continue;
    // A free root may lose any axes. Behind a joint the body must keep what the joint's rows can move.
    const uint32_t any = 1 + random.bits() % 62, turn = 8u << random.bits() % 3;
    batch.locked.push_back(node.row);
    batch.locks.push_back(static_cast<uint8_t>(root ? any : turn));
  }
}

/// Stamps and factors, as an outer iteration does.
void prepare(TestBatch& batch, const BatchView& view) {
  const Backend& kernels = backend(4);
  kernels.beginRows(view, {0, view.rows});
  const SolveSettings settings{.h = TestBatch::kStep};
  kernels.stampContacts(view, settings, false, {0, view.contacts.tiles});
  kernels.stampOthers(view, settings, false, ElementBlocks::New);
  batch.forest.stamp(view, kAll);
  if (view.lockedCount) applyLocks(view);
  batch.forest.factor(view, kAll);
  for (size_t i = 0; i < 8 * view.rows; ++i) view.r[i] = i < 8 * view.bodies ? -view.gradient[i] : 0.0f;
}

double largest(const std::vector<double>& v, size_t begin, size_t end) {
  double size = 0;
  for (size_t i = begin; i < end; ++i) size = std::max(size, std::fabs(v[i]));
  return size;
}

/// z and the joints' mu against the dense solution; tolerances relative to the largest of each.
void expectSolution(const TestBatch& batch, const std::vector<double>& expected, double tolerance) {
  const size_t n = 6 * batch.bodies();
  const double scale = largest(expected, 0, n), load = largest(expected, n, expected.size());
  for (uint32_t body = 0; body < batch.bodies(); ++body)
    for (size_t k = 0; k < 6; ++k)
      ASSERT_NEAR(batch.z[rowEntry(body, k)], expected[6 * body + k], tolerance * scale) << body << " " << k;
  size_t at = n;
  for (const TreeJoint& joint : batch.forest.joints)
    for (int i = 0; i < joint.m; ++i) ASSERT_NEAR(joint.mu[i], expected[at++], tolerance * load) << "multiplier " << i;
}

/// r must have lost J^T mu, which leaves H z.
void expectResidual(const TestBatch& batch, const DenseSystem& system, double tolerance) {
  const size_t n = 6 * batch.bodies();
  std::vector<double> mu;
  for (const TreeJoint& joint : batch.forest.joints) mu.insert(mu.end(), joint.mu, joint.mu + joint.m);
  const double scale = largest(system.right, 0, n) + (mu.empty() ? 0 : largest(mu, 0, mu.size()));
  for (uint32_t body = 0; body < batch.bodies(); ++body)
    for (size_t k = 0; k < 6; ++k) {
      double left = system.right[6 * body + k];
      for (size_t i = 0; i < mu.size(); ++i) left -= system.m.at(6 * body + k, n + i) * mu[i];
      ASSERT_NEAR(batch.r[rowEntry(body, k)], left, tolerance * scale) << body << " " << k;
    }
}

void check(const TreeCase& c, uint64_t seed, double tolerance) {
  Random random(seed);
  TestBatch batch(c.bodies, 1);
  build(batch, c, random);
  const DenseSystem system = systemOf(batch);
  const BatchView view = batch.view();
  prepare(batch, view);
  batch.forest.solve(view, kAll, true);
  expectSolution(batch, solveDense(system.m, system.right), tolerance);
  expectResidual(batch, system, tolerance);
}

class Trees : public testing::TestWithParam<TreeCase> {};

TEST_P(Trees, SolveLikeADenseSystem) {
  for (uint64_t seed = 0; seed < 20 && !HasFatalFailure(); ++seed)
    check(GetParam(), seed, GetParam().heavy > 1 ? 5e-4 : 3e-5);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Trees,
                         testing::Values(TreeCase{1, Support::Static, false, 1}, TreeCase{2, Support::Free, false, 1},
                                         TreeCase{9, Support::Free, false, 1}, TreeCase{9, Support::Static, false, 1},
                                         TreeCase{9, Support::Kinematic, false, 1}, TreeCase{6, Support::Free, true, 1},
                                         TreeCase{6, Support::Static, true, 1}, TreeCase{9, Support::Free, false, 1000},
                                         TreeCase{9, Support::Static, false, 1000}));

/// Couples every node to all that stand before it, so that any loop has its block.
void fillWhole(Forest& forest) {
  for (size_t i = 0; i < forest.nodes.size(); ++i) {
    forest.nodes[i].fillBegin = static_cast<uint32_t>(forest.fills.size());
    forest.nodes[i].fillCount = static_cast<uint32_t>(i);
    for (size_t other = i; other-- > 0;) forest.fills.emplace_back().node = static_cast<int32_t>(other);
  }
}

/// A ball or fixed joint between two nodes that no tree holds, and its block.
void addLoop(TestBatch& batch, size_t a, size_t b, Random& random) {
  Forest& forest = batch.forest;
  const size_t balls = batch.balls.size(), fixed = batch.fixed.size();
  addJoint(batch, forest.nodes[a].row, forest.nodes[b].row, random);
  FilledPair pair;
  pair.kind = batch.balls.size() > balls ? FilledPair::Kind::Ball : FilledPair::Kind::Fixed;
  pair.lane = static_cast<uint32_t>(batch.balls.size() > balls ? balls : fixed);
  pair.childIsA = a > b;
  const size_t child = std::max(a, b), other = std::min(a, b);
  pair.fill = forest.nodes[child].fillBegin + static_cast<uint32_t>(child - 1 - other);
  forest.filledPairs.push_back(pair);
}

class Loops : public testing::TestWithParam<TreeCase> {};

TEST_P(Loops, InTheFactorSolveLikeADenseSystem) {
  for (uint64_t seed = 0; seed < 20 && !HasFatalFailure(); ++seed) {
    Random random(seed);
    TestBatch batch(GetParam().bodies, 1);
    build(batch, GetParam(), random);
    fillWhole(batch.forest);
    for (int i = 0; i < 3; ++i) {
      const size_t a = random.bits() % GetParam().bodies, b = random.bits() % GetParam().bodies;
      if (a != b) addLoop(batch, a, b, random);
    }
    const DenseSystem system = systemOf(batch);
    const BatchView view = batch.view();
    prepare(batch, view);
    batch.forest.solve(view, kAll, true);
    expectSolution(batch, solveDense(system.m, system.right), 2e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Loops,
                         testing::Values(TreeCase{3, Support::Static, false, 1}, TreeCase{6, Support::Free, false, 1},
                                         TreeCase{6, Support::Static, false, 1},
                                         TreeCase{6, Support::Static, false, 100}));

// A second right side, without violations, on the same factors: the multipliers add up.
TEST(Forest, LaterSolutionsStayInTheNullSpaceAndAddTheirMultipliers) {
  Random random(3);
  TestBatch batch(7, 1);
  build(batch, {7, Support::Static, false, 1}, random);
  DenseSystem system = systemOf(batch);
  const BatchView view = batch.view();
  prepare(batch, view);
  batch.forest.solve(view, kAll, true);
  std::vector<double> total = solveDense(system.m, system.right);
  for (uint32_t body = 0; body < 7; ++body)
    for (size_t k = 0; k < 6; ++k) view.r[rowEntry(body, k)] = random.number(1000);
  for (size_t i = 0; i < system.right.size(); ++i)
    system.right[i] = i < 42 ? view.r[rowEntry(static_cast<uint32_t>(i / 6), i % 6)] : 0;
  batch.forest.solve(view, kAll, false);
  const std::vector<double> second = solveDense(system.m, system.right);
  expectSolution(batch, second, 2e-4);
  const std::vector<TreeJoint> before = batch.forest.joints;
  batch.forest.updateMultipliers(kAll);
  size_t at = 42;
  for (size_t j = 0; j < before.size(); ++j) {
    const auto now = [&](int i) {
      const rows::FixedJoint<float>& f = batch.forest.joints[j].rows;
      const float value[6] = {f.ball.lambda.x, f.ball.lambda.y, f.ball.lambda.z, f.lambda.x, f.lambda.y, f.lambda.z};
      return value[i];
    };
    const rows::FixedJoint<float>& f = before[j].rows;
    const float was[6] = {f.ball.lambda.x, f.ball.lambda.y, f.ball.lambda.z, f.lambda.x, f.lambda.y, f.lambda.z};
    const double load = largest(total, 42, total.size()) + largest(second, 42, second.size());
    for (int i = 0; i < before[j].m; ++i, ++at) EXPECT_NEAR(now(i), was[i] + total[at] + second[at], 5e-4 * load);
    for (int i = before[j].m; i < 6; ++i) EXPECT_EQ(now(i), was[i]) << "a ball joint has no torque";
  }
}

// Two trees in one forest do not see each other.
TEST(Forest, TreesAreIndependent) {
  for (uint64_t seed = 0; seed < 5; ++seed) {
    Random random(seed);
    TestBatch one(4, 1), both(9, 1);
    for (uint32_t i = 0; i < 4; ++i) one.fillBody(i, random, 1 + static_cast<float>(i));
    for (size_t i = 0; i < 32; ++i)
      both.d[i] = one.d[i], both.target[i] = one.target[i], both.mass[i] = one.mass[i],
      both.invMass[i] = one.invMass[i];
    for (uint32_t i = 4; i < 9; ++i) both.fillBody(i, random, 1);
    plantTree(one, {0, 1, 2, 3}, one.staticRow(), random);
    plantTree(both, {4, 5, 6, 7, 8}, kFree, random);
    one.islands = {{0, 4, true, true, false}}, both.islands = {{0, 4, true, true, false}, {4, 9, true, true, true}};
    // The same tree again, behind the other.
    const int32_t nodes = static_cast<int32_t>(both.forest.nodes.size());
    const int32_t joints = static_cast<int32_t>(both.forest.joints.size());
    for (TreeNode node : one.forest.nodes) {
      if (node.parent >= 0) node.parent += nodes;
      if (node.joint >= 0) node.joint += joints;
      both.forest.nodes.push_back(node);
    }
    for (TreeJoint joint : one.forest.joints) {
      if (joint.rowA == one.staticRow()) joint.rowA = both.staticRow();
      if (joint.rowB == one.staticRow()) joint.rowB = both.staticRow();
      both.forest.joints.push_back(joint);
    }
    for (TestBatch* batch : {&one, &both}) {
      const BatchView view = batch->view();
      prepare(*batch, view);
      batch->forest.solve(view, kAll, true);
    }
    for (size_t i = 0; i < 32; ++i) ASSERT_EQ(one.z[i], both.z[i]) << i;
  }
}

}  // namespace
}  // namespace avbd::oracle
