// The block sweep against dense blocks in double, its plan, the independence of islands and of the lane width.
#include "solve/sweep.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <set>

#include "avbd/rows/sinks.h"
#include "solve/batch_oracle.h"

namespace avbd::oracle {
namespace {

SolveSettings settings(int iterations) {
  SolveSettings s;
  s.h = TestBatch::kStep, s.iterations = iterations;
  s.contactLeak = 0.98f, s.jointLeak = 0.97f;
  return s;
}

/// An island of `bodies` bodies that hold on to each other, to the static row and to a kinematic one, either way round.
void addIsland(TestBatch& batch, uint32_t first, uint32_t bodies, Random& random) {
  const auto any = [&] { return first + static_cast<uint32_t>(random.bits() % bodies); };
  for (uint32_t i = 0; i < bodies; ++i) batch.fillBody(first + i, random, 1);
  for (uint32_t i = 1; i < bodies; ++i) addContact(batch, first + i - 1, first + i, random);
  addContact(batch, batch.staticRow(), any(), random);
  addContact(batch, any(), batch.kinematicRow(0), random);
  for (uint32_t i = 1; i < bodies; i += 2) addFull(batch, first + i, first + i - 1, random);
  addFull(batch, any(), batch.kinematicRow(0), random);
  addJoint(batch, batch.kinematicRow(0), any(), random);
  for (uint32_t i = 2; i < bodies; i += 2) addJoint(batch, first + i, first + i - 2, random);
  for (uint32_t i = 3; i < bodies; i += 3) {
    rows::TetVolume<float> tet = RandomRows<rows::TetVolume>::any(random);
    soften(tet.k, random), tet.k *= 10;
    batch.tets.push_back({{first + i, first + i - 2, first + i - 1, first + i - 3}, tet});
  }
  batch.islands.push_back({first, first + bodies, false, true, false});
}

/// A batch of islands; bodies of one island have different colours, those of different ones share them.
struct Company {
  TestBatch batch;
  std::vector<uint32_t> color;
  uint32_t colors = 0;

  static uint32_t sum(const std::vector<uint32_t>& sizes) {
    uint32_t all = 0;
    for (const uint32_t n : sizes) all += n;
    return all;
  }
  /// Each island is made from its size alone, so that it is the same in every company.
  explicit Company(const std::vector<uint32_t>& sizes, uint64_t seed = 0) : batch(sum(sizes), 1) {
    Random shared(99);
    batch.fillKinematic(batch.kinematicRow(0), shared);
    for (const uint32_t n : sizes) {
      Random random(seed + n);
      addIsland(batch, static_cast<uint32_t>(color.size()), n, random);
      for (uint32_t i = 0; i < n; ++i) color.push_back((i * 5 + 2) % n);
      if (n % 5 == 0) std::iota(color.end() - n, color.end(), 0);
      colors = std::max(colors, n);
    }
  }
  void solve(int width, const SolveSettings& s) {
    SweepPlan plan;
    solveSweep(batch.view(), backend(width), s, {color.data(), colors}, plan);
  }
};

// ---- Against dense blocks --------------------------------------------------------------------------------------

/// Moves one body to where its own 6x6 block says.
void moveAlone(TestBatch& batch, uint32_t body) {
  const DenseSystem system = systemOf(batch, Scaling::OwnBlocks);
  DenseMatrix block(6);
  std::vector<double> right(6);
  for (size_t i = 0; i < 6; ++i) {
    right[i] = system.right[6 * body + i];
    for (size_t j = 0; j < 6; ++j) block.at(i, j) = system.m.at(6 * body + i, 6 * body + j);
  }
  const std::vector<double> x = solveDense(block, right);
  for (size_t k = 0; k < 6; ++k) batch.d[rowEntry(body, k)] += static_cast<float>(x[k]);
}

template <template <class> class F>
void moveMultipliers(const TestBatch& batch, std::vector<Placed<F>>& list, float leak) {
  for (auto& pair : list) {
    rows::DualSink<float> sink{leak};
    pair.rows.rows(batch.motion(pair.a), batch.motion(pair.b), sink);
  }
}

void moveMultipliers(TestBatch& batch, const SolveSettings& s) {
  moveMultipliers(batch, batch.contacts, s.contactLeak);
  moveMultipliers(batch, batch.balls, s.jointLeak);
  moveMultipliers(batch, batch.fixed, s.jointLeak);
  moveMultipliers(batch, batch.full, s.contactLeak);
  for (PlacedTet& tet : batch.tets) {
    V3<float> d[4];
    for (int i = 0; i < 4; ++i) d[i] = batch.motion(tet.node[i]).lin;
    rows::BlockDualSink<float, 4> sink{1};
    tet.rows.rows(d, sink);
  }
}

/// The method in words: colour after colour, multipliers between the iterations.
void sweepSlowly(Company& c, const SolveSettings& s) {
  for (int i = 0; i < s.iterations; ++i) {
    if (i > 0) moveMultipliers(c.batch, s);
    for (uint32_t n = 0; n < c.colors; ++n)
      for (uint32_t body = 0; body < c.batch.bodies(); ++body)
        if (c.color[body] == n) moveAlone(c.batch, body);
  }
}

void expectSameMotion(const TestBatch& expected, const TestBatch& got, double tolerance) {
  double scale = 0;
  for (const float a : expected.d) scale = std::max(scale, double(std::fabs(a)));
  for (uint32_t body = 0; body < expected.bodies(); ++body)
    for (size_t k = 0; k < 6; ++k)
      ASSERT_NEAR(got.d[rowEntry(body, k)], expected.d[rowEntry(body, k)], tolerance * scale)
          << "body " << body << " unknown " << k;
}

TEST(Sweep, MovesBodyAfterBodyAsDenseBlocksSay) {
  for (const int iterations : {1, 2, 3})
    for (uint64_t seed = 0; seed < 5 && !testing::Test::HasFatalFailure(); ++seed) {
      Company slow({7, 1, 10, 4}, 100 * seed), fast({7, 1, 10, 4}, 100 * seed);
      sweepSlowly(slow, settings(iterations));
      fast.solve(4, settings(iterations));
      expectSameMotion(slow.batch, fast.batch, 2e-4 * iterations);
    }
}

TEST(Sweep, LockedAxesDoNotMove) {
  Company slow({7, 9}), fast({7, 9});
  for (Company* c : {&slow, &fast}) {
    c->batch.locked = {1, 5, 12};
    c->batch.locks = {7, 2 + 16 + 32, 63};
  }
  const TestBatch before = fast.batch;
  sweepSlowly(slow, settings(2));
  fast.solve(4, settings(2));
  expectSameMotion(slow.batch, fast.batch, 4e-4);
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 6; ++k) {
      const size_t entry = rowEntry(fast.batch.locked[i], k);
      if (fast.batch.locks[i] >> k & 1) {
        EXPECT_EQ(fast.batch.d[entry], before.d[entry]);
      }
    }
}

TEST(Sweep, WhatDoesNotMoveStaysWhereItIs) {
  Company c({9, 4});
  const TestBatch before = c.batch;
  c.solve(8, settings(3));
  for (uint32_t row = c.batch.bodies(); row < c.batch.d.size() / 8; ++row)
    for (size_t k = 0; k < 6; ++k) EXPECT_EQ(c.batch.d[rowEntry(row, k)], before.d[rowEntry(row, k)]) << row;
}

TEST(Sweep, ABodyThatTouchesNothingGoesToItsTarget) {
  Company c({3});
  c.batch.contacts.clear(), c.batch.balls.clear(), c.batch.fixed.clear(), c.batch.tets.clear();
  c.batch.full.clear();
  c.solve(4, settings(1));
  for (size_t i = 0; i < 3 * 8; ++i) EXPECT_NEAR(c.batch.d[i], c.batch.target[i], 1e-7) << i;
}

// ---- Independence ----------------------------------------------------------------------------------------------

/// A body that forty others touch, so that its sides fill several runs.
Company crowd() {
  Company c({40, 1});
  Random random(7);
  for (uint32_t i = 0; i < 40; ++i) i % 2 ? addContact(c.batch, 40, i, random) : addContact(c.batch, i, 40, random);
  c.color[40] = 40;
  c.colors = 41;
  return c;
}

TEST(Sweep, ABodyInACrowdMovesAsItsDenseBlockSays) {
  Company slow = crowd(), fast = crowd();
  sweepSlowly(slow, settings(1));
  fast.solve(16, settings(1));
  expectSameMotion(slow.batch, fast.batch, 4e-4);
}

TEST(Sweep, EveryWidthGivesTheSameBits) {
  for (const bool crowded : {false, true}) {
    const auto make = [&] { return crowded ? crowd() : Company({5, 4, 1, 17, 3, 9}); };
    Company one = make();
    one.batch.locked = {2}, one.batch.locks = {9};
    one.solve(1, settings(5));
    for (const int width : {4, 8, 16}) {
      if (!laneWidthRuns(width)) continue;
      Company wide = make();
      wide.batch.locked = {2}, wide.batch.locks = {9};
      wide.solve(width, settings(5));
      for (size_t i = 0; i < one.batch.d.size(); ++i) ASSERT_EQ(wide.batch.d[i], one.batch.d[i]) << width << ": " << i;
      for (size_t i = 0; i < one.batch.contacts.size(); ++i)
        for (int k = 0; k < 4; ++k) {
          const auto &a = one.batch.contactAfter(i).point[k], &b = wide.batch.contactAfter(i).point[k];
          ASSERT_EQ(a.lambdaN, b.lambdaN);
          ASSERT_EQ(a.lambda1, b.lambda1);
        }
    }
  }
}

TEST(Sweep, NoIslandChangesABitOfAnother) {
  const std::vector<uint32_t> sizes{9, 1, 17, 4, 2};
  Company together(sizes);
  together.solve(4, settings(4));
  uint32_t first = 0;
  for (const uint32_t n : sizes) {
    Company alone({n});
    alone.solve(4, settings(4));
    for (size_t k = 0; k < 8 * n; ++k)
      ASSERT_EQ(together.batch.d[8 * first + k], alone.batch.d[k]) << "island of " << n << " entry " << k;
    first += n;
  }
}

// ---- Plan ------------------------------------------------------------------------------------------------------

using Incidence = std::array<uint32_t, 4>;  // colour, body row, pair, role

std::multiset<Incidence> listed(const SweepPlan& plan, const SweepView& view, SideFamily family) {
  std::multiset<Incidence> found;
  const SideView& sides = view.sides[family];
  for (uint32_t c = 0; c < plan.colors().size(); ++c)
    for (uint32_t g = plan.colors()[c].groupBegin[family]; g < plan.colors()[c].groupEnd[family]; ++g) {
      EXPECT_LE(sides.group[g].length, kRunSides);
      for (uint32_t i = 0; i < kTile * sides.group[g].length; ++i) {
        const uint32_t at = sides.group[g].first + i, lane = g * kTile + i % kTile;
        if (sides.pair[at] == sides.pairs) continue;
        found.insert({c, sides.row[lane], sides.pair[at], static_cast<uint32_t>(sides.role[at])});
        EXPECT_EQ(view.row[plan.colors()[c].rowBegin + sides.place[lane]], sides.row[lane]);
      }
    }
  return found;
}

TEST(SweepPlan, NamesEverySideOfAMovingBodyOnce) {
  Company c = crowd();
  SweepPlan plan;
  plan.build(c.batch.view(), {c.color.data(), c.colors});
  const SweepView view = plan.view();
  std::multiset<Incidence> contacts, tets;
  for (uint32_t i = 0; i < c.batch.contacts.size(); ++i) {
    const uint32_t a = c.batch.contacts[i].a, b = c.batch.contacts[i].b;
    if (a < c.batch.bodies()) contacts.insert({c.color[a], a, i, 0});
    if (b < c.batch.bodies()) contacts.insert({c.color[b], b, i, 1});
  }
  for (uint32_t i = 0; i < c.batch.tets.size(); ++i)
    for (uint32_t k = 0; k < 4; ++k) tets.insert({c.color[c.batch.tets[i].node[k]], c.batch.tets[i].node[k], i, k});
  EXPECT_EQ(listed(plan, view, kContactSides), contacts);
  EXPECT_EQ(listed(plan, view, kTetSides), tets);
}

TEST(SweepPlan, KeepsItsMemory) {
  Company c = crowd(), small({4});
  SweepPlan plan;
  plan.build(c.batch.view(), {c.color.data(), c.colors});
  const SweepView first = plan.view();
  plan.build(small.batch.view(), {small.color.data(), small.colors});
  plan.build(c.batch.view(), {c.color.data(), c.colors});
  const SweepView second = plan.view();
  EXPECT_EQ(first.row, second.row);
  for (int f = 0; f < kSideFamilies; ++f) {
    EXPECT_EQ(first.sides[f].pair, second.sides[f].pair);
    EXPECT_EQ(first.sides[f].records, second.sides[f].records);
    EXPECT_EQ(first.sides[f].group, second.sides[f].group);
  }
}

}  // namespace
}  // namespace avbd::oracle
