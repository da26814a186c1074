// Conjugate gradients against a dense solution in double, and the independence of islands.
#include "solve/krylov.h"

#include <gtest/gtest.h>

#include "solve/batch_oracle.h"

namespace avbd::oracle {
namespace {

// What an island of a test holds.
struct IslandCase {
  uint32_t bodies;
  bool tree;
  bool rows;  ///< contacts, joints outside trees and tetrahedra
  float heavy;
};

void PrintTo(const IslandCase& c, std::ostream* out) {
  *out << c.bodies << " bodies" << (c.tree ? ", tree" : "") << (c.rows ? ", rows" : "") << ", " << c.heavy << " kg";
}

SolveSettings settings(int iterations, int krylov) {
  SolveSettings s;
  s.h = TestBatch::kStep, s.iterations = iterations, s.krylovIterations = krylov, s.newtonFactor = 1;
  return s;
}

/// Adds an island of the bodies from `first` on. Kinematic row 0 is one of its neighbours.
void addIsland(TestBatch& batch, uint32_t first, const IslandCase& c, Random& random) {
  std::vector<uint32_t> rows;
  for (uint32_t i = 0; i < c.bodies; ++i) {
    rows.push_back(first + i);
    batch.fillBody(first + i, random, i + 1 == c.bodies ? c.heavy : 1);
  }
  const size_t joint = batch.forest.joints.size(), node = batch.forest.nodes.size();
  if (c.tree) plantTree(batch, rows, random.bits() % 2 ? batch.staticRow() : kFree, random);
  const uint32_t index = static_cast<uint32_t>(batch.islands.size());
  for (size_t i = joint; i < batch.forest.joints.size(); ++i) batch.forest.joints[i].island = index;
  for (size_t i = node; i < batch.forest.nodes.size(); ++i) batch.forest.nodes[i].island = index;
  if (c.rows) {
    const auto any = [&] { return rows[random.bits() % rows.size()]; };
    for (uint32_t i = 1; i < c.bodies; ++i) addContact(batch, rows[i - 1], rows[i], random);
    addContact(batch, batch.staticRow(), any(), random);
    addContact(batch, any(), batch.kinematicRow(0), random);
    for (uint32_t i = 1; i < c.bodies; i += 2) addFull(batch, rows[i], rows[i - 1], random);
    addFull(batch, batch.staticRow(), any(), random);
    if (c.bodies > 2) addJoint(batch, rows[0], rows[2], random);
    addJoint(batch, rows[0], batch.kinematicRow(0), random);
    if (c.bodies > 3) {
      rows::TetVolume<float> tet = RandomRows<rows::TetVolume>::any(random);
      soften(tet.k, random), tet.k *= 10;
      batch.tets.push_back({{rows[0], rows[1], rows[2], rows[3]}, tet});
    }
  }
  batch.islands.push_back({first, first + c.bodies, c.tree, c.rows, false});
}

void solve(TestBatch& batch, int width, const SolveSettings& s) {
  KrylovScratch scratch;
  solveKrylov(batch.view(), {backend(width)}, s, batch.forest.nodes.empty() ? nullptr : &batch.forest, scratch);
}

void expectDense(const TestBatch& before, const TestBatch& after, double tolerance) {
  const DenseSystem system = systemOf(before);
  const std::vector<double> expected = solveDense(system.m, system.right);
  // An iteration turns no body by more than a radian.
  for (uint32_t body = 0; body < before.bodies(); ++body) {
    const double* turn = &expected[6 * body + 3];
    if (std::hypot(turn[0], turn[1], turn[2]) < 0.99) continue;
    const double x = double(after.d[rowEntry(body, 3)]) - before.d[rowEntry(body, 3)],
                 y = double(after.d[rowEntry(body, 4)]) - before.d[rowEntry(body, 4)],
                 z = double(after.d[rowEntry(body, 5)]) - before.d[rowEntry(body, 5)];
    ASSERT_LE(std::hypot(x, y, z), 1.001) << "body " << body;
    return;
  }
  double scale = 0;
  for (size_t i = 0; i < 6 * before.bodies(); ++i) scale = std::max(scale, std::fabs(expected[i]));
  for (uint32_t body = 0; body < before.bodies(); ++body)
    for (size_t k = 0; k < 6; ++k) {
      const double moved = double(after.d[rowEntry(body, k)]) - before.d[rowEntry(body, k)];
      ASSERT_NEAR(moved, expected[6 * body + k], tolerance * scale) << "body " << body << " unknown " << k;
    }
}

class Systems : public testing::TestWithParam<IslandCase> {};

TEST_P(Systems, OneIterationSolvesThemLikeADenseSystem) {
  for (uint64_t seed = 0; seed < 10 && !HasFatalFailure(); ++seed) {
    Random random(seed);
    TestBatch batch(GetParam().bodies, 1);
    batch.fillKinematic(batch.kinematicRow(0), random);
    addIsland(batch, 0, GetParam(), random);
    TestBatch before = batch;
    solve(batch, 4, settings(1, 100));
    expectDense(before, batch, 4e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Systems,
                         testing::Values(IslandCase{1, false, true, 1}, IslandCase{8, false, true, 1},
                                         IslandCase{8, true, false, 1}, IslandCase{8, true, true, 1},
                                         IslandCase{6, false, true, 100}, IslandCase{6, true, true, 100}));

TEST(Krylov, MultipliersOfTreesCarryWhatTheDenseSystemSays) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    TestBatch batch(6, 1);
    batch.fillKinematic(batch.kinematicRow(0), random);
    addIsland(batch, 0, {6, true, true, 1}, random);
    TestBatch before = batch;
    solve(batch, 4, settings(1, 100));
    const DenseSystem system = systemOf(before);
    const std::vector<double> expected = solveDense(system.m, system.right);
    double load = 0;
    for (size_t i = 36; i < expected.size(); ++i) load = std::max(load, std::fabs(expected[i]));
    size_t at = 36;
    for (size_t j = 0; j < batch.forest.joints.size(); ++j) {
      const rows::BallJoint<float>&was = before.forest.joints[j].rows.ball, &now = batch.forest.joints[j].rows.ball;
      EXPECT_NEAR(now.lambda.x - was.lambda.x, expected[at], 1e-3 * load);
      EXPECT_NEAR(now.lambda.y - was.lambda.y, expected[at + 1], 1e-3 * load);
      EXPECT_NEAR(now.lambda.z - was.lambda.z, expected[at + 2], 1e-3 * load);
      at += static_cast<size_t>(batch.forest.joints[j].m);
    }
  }
}

TEST(Krylov, LockedAxesDoNotMove) {
  Random random(2);
  TestBatch batch(8, 1);
  batch.fillKinematic(batch.kinematicRow(0), random);
  addIsland(batch, 0, {8, false, true, 1}, random);
  batch.locked = {1, 5};
  batch.locks = {7, 2 + 16 + 32};
  TestBatch before = batch;
  solve(batch, 4, settings(1, 100));
  expectDense(before, batch, 4e-3);
  for (const size_t k : {0, 1, 2}) EXPECT_EQ(batch.d[rowEntry(1, k)], before.d[rowEntry(1, k)]);
  for (const size_t k : {1, 4, 5}) EXPECT_EQ(batch.d[rowEntry(5, k)], before.d[rowEntry(5, k)]);
}

TEST(Krylov, ContactFloorsFollowTheMassThatTheyFeel) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    TestBatch batch(2, 1);
    for (uint32_t i = 0; i < 2; ++i) batch.fillBody(i, random, randomSize(random, 0.1f, 100));
    rows::Contact<float> c = RandomRows<rows::Contact>::any(random);
    for (int i = 0; i < 4; ++i) c.point[i].floorN = c.point[i].floorT = i < 3 ? 1.0f : 0.0f;
    batch.contacts = {{0, 1, c}, {batch.staticRow(), 1, c}, {batch.staticRow(), batch.kinematicRow(0), c}};
    backend(4).prepareContacts(batch.view(), settings(4, 8), {0, 1});
    const auto inverseMass = [&](uint32_t row, V3<float> arm, V3<float> along) {
      const float* m = batch.invMass.data() + 8 * row;
      const V3<float> a = cross(arm, along);
      return m[0] + dot(a, rows::Sym3<float>{m[1], m[2], m[3], m[4], m[5], m[6]} * a);
    };
    for (size_t n = 0; n < 3; ++n)
      for (int i = 0; i < 4; ++i) {
        const V3<float> onA = c.armA + c.point[i].arm, onB = c.armB + c.point[i].arm;
        const auto felt = [&](V3<float> along) {
          return inverseMass(batch.contacts[n].a, onA, along) + inverseMass(batch.contacts[n].b, onB, along);
        };
        const float wn = felt(c.n), wt = std::max(felt(c.t1), felt(c.t2)), factor = 10 * 60 * 60;
        const bool exists = i < 3 && n < 2;
        const auto& p = batch.contactAfter(n).point[i];
        EXPECT_NEAR(p.floorN, exists ? factor / wn : 0, 1e-4f * p.floorN) << n << " " << i;
        EXPECT_NEAR(p.floorT, exists ? factor / wt : 0, 1e-4f * p.floorT) << n << " " << i;
      }
  }
}

// ---- Independence ----------------------------------------------------------------------------------------------

const IslandCase kMixed[] = {{5, false, true, 1},  {4, true, false, 1},  {1, false, true, 1}, {7, true, true, 50},
                             {1, false, false, 1}, {9, false, true, 10}, {3, true, true, 1}};

/// Islands made each from its own seed, so that they are the same in every company.
TestBatch company(const std::vector<size_t>& members) {
  uint32_t bodies = 0;
  for (const size_t i : members) bodies += kMixed[i].bodies;
  TestBatch batch(bodies, 1);
  Random fixed(99);
  batch.fillKinematic(batch.kinematicRow(0), fixed);
  uint32_t first = 0;
  for (const size_t i : members) {
    Random random(i);
    addIsland(batch, first, kMixed[i], random);
    first += kMixed[i].bodies;
  }
  return batch;
}

TEST(Krylov, NoIslandChangesABitOfAnother) {
  const std::vector<size_t> all{3, 0, 6, 1, 5, 2, 4};
  for (const SolveSettings& s : {settings(4, 8), settings(6, 40)}) {
    TestBatch together = company(all);
    solve(together, 4, s);
    uint32_t first = 0;
    for (const size_t i : all) {
      TestBatch alone = company({i});
      solve(alone, 4, s);
      for (size_t k = 0; k < 8 * kMixed[i].bodies; ++k)
        ASSERT_EQ(together.d[8 * first + k], alone.d[k]) << "island " << i << " entry " << k;
      first += kMixed[i].bodies;
    }
  }
}

TEST(Krylov, EveryWidthGivesTheSameBits) {
  const std::vector<size_t> all{0, 1, 2, 3, 4, 5, 6};
  TestBatch one = company(all);
  solve(one, 1, settings(4, 8));
  for (const int width : {4, 8, 16}) {
    if (!laneWidthRuns(width)) continue;
    TestBatch wide = company(all);
    solve(wide, width, settings(4, 8));
    for (size_t k = 0; k < 8 * one.bodies(); ++k) ASSERT_EQ(wide.d[k], one.d[k]) << "width " << width;
  }
}

}  // namespace
}  // namespace avbd::oracle
