// Laws that every family of the list keeps.
#include <gtest/gtest.h>

#include <bit>

#include "lane/tile.h"
#include "solve/rows_oracle.h"

namespace avbd::oracle {
namespace {

using rows::Sym6;
using rows::Twist;

constexpr int kRounds = 200;

/// Motions of the blocks: not at all, or as much as a fast step.
struct Motion {
  float d[kMaxUnknowns] = {};
  Motion() = default;
  Motion(Random& random, float size) {
    for (float& a : d) a = random.number(size);
  }
};

/// An instance and a motion, drawn in this order by every compiler.
template <template <class> class F>
struct Drawn {
  F<float> rows;
  Motion at;
  Drawn(Random& random, float size) : rows(RandomRows<F>::any(random)), at(random, size) {}
};

// ---- J is the derivative of C ----------------------------------------------------------------------------------

template <template <class> class F>
void expectDerivative(const F<float>& instance, const Motion& at, const char* name) {
  constexpr double kStep = 1e-3;
  F<Precise> rows = toPrecise<F>(instance);
  Precise d[kMaxUnknowns];
  std::copy(std::begin(at.d), std::end(at.d), d);
  const RowList<Precise> here = listRows<F, Precise>(rows, d);
  for (int u = 0; u < here.unknowns; ++u) {
    const Precise before = d[u];
    d[u] = Precise(before.v + kStep);
    const RowList<Precise> up = listRows<F, Precise>(rows, d);
    d[u] = Precise(before.v - kStep);
    const RowList<Precise> down = listRows<F, Precise>(rows, d);
    d[u] = before;
    for (int i = 0; i < here.count; ++i)
      ASSERT_NEAR(here.J[i][u].v, (up.C[i].v - down.C[i].v) / (2 * kStep), 2e-6)
          << name << " row " << i << " unknown " << u;
  }
}

TEST(Families, JacobianIsTheDerivative) {
  forEachFamily([]<template <class> class F>(Family<F>, const char* name) {
    Random random(1);
    for (int round = 0; round < kRounds && !testing::Test::HasFatalFailure(); ++round) {
      expectDerivative<F>(RandomRows<F>::exact(random), Motion{}, name);
      const Drawn<F> drawn(random, 0.3f);
      if (RandomRows<F>::kExactEverywhere) expectDerivative<F>(drawn.rows, drawn.at, name);
    }
  });
}

// With arms all the way at the end pose the ball joint is fully implicit: J is exact in rotations added to the pose.
TEST(Families, BallJointBlendsItsArmsFromStartToEnd) {
  Random random(2);
  for (int round = 0; round < kRounds; ++round) {
    rows::BallJoint<float> ball = RandomRows<rows::BallJoint>::any(random);
    const Twist<float> dA = {randomVector(random, 1), randomVector(random, 1)}, dB = rows::zeroTwist<float>();
    const V3<float> end = rotate(rows::expQuat(dA.ang), ball.rA);
    for (const float tau : {0.0f, 0.25f, 1.0f}) {
      ball.tau = tau;
      rows::ProbeSink<float, 3> probe;
      ball.rows(dA, dB, probe);
      EXPECT_LT(length(probe.armA - (ball.rA * (1 - tau) + end * tau)), 1e-6f);
      EXPECT_LT(length(probe.armB - ball.rB), 1e-6f);
    }
  }
}

// ---- Action and reaction ---------------------------------------------------------------------------------------

template <template <class> class F>
void expectNoNetWrench(F<float> instance, const Motion& at, const char* name) {
  const RowList<float> list = listRows<F, float>(instance, at.d);
  V3<float> place[4] = {};
  if constexpr (kIsPair<F>) {
    rows::ProbeSink<float, F<float>::kRows> probe;
    instance.rows(twistAt(at.d), twistAt(at.d + 6), probe);
    // Both reach the same point.
    place[0] = -probe.armA, place[1] = -probe.armB;
  } else {
    RandomRows<F>::positions(instance, place);
    for (int i = 0; i < 4; ++i) place[i] += V3<float>{at.d[3 * i], at.d[3 * i + 1], at.d[3 * i + 2]};
  }
  const int width = kIsPair<F> ? 6 : 3;
  for (int i = 0; i < list.count; ++i) {
    V3<float> force{}, torque{};
    for (int b = 0; b < list.unknowns / width; ++b) {
      const float* j = list.J[i] + width * b;
      const V3<float> f{j[0], j[1], j[2]};
      force += f;
      torque += cross(place[b], f);
      if (width == 6) torque += V3<float>{j[3], j[4], j[5]};
    }
    EXPECT_LT(length(force), kIsPair<F> ? 1e-30f : 1e-6f) << name << " row " << i;
    EXPECT_LT(length(torque), 2e-6f) << name << " row " << i;
  }
}

TEST(Families, ActionEqualsReaction) {
  forEachFamily([]<template <class> class F>(Family<F>, const char* name) {
    Random random(3);
    for (int round = 0; round < kRounds; ++round) {
      expectNoNetWrench<F>(RandomRows<F>::any(random), Motion{}, name);
      const Drawn<F> drawn(random, 0.3f);
      expectNoNetWrench<F>(drawn.rows, drawn.at, name);
    }
  });
}

// ---- The sinks agree with the rows -----------------------------------------------------------------------------

struct DenseStamp {
  double gradient[kMaxUnknowns] = {}, gradientSize = 0;  ///< size: of the largest term
  double hessian[kMaxUnknowns][kMaxUnknowns] = {}, hessianSize = 0;
};

DenseStamp denseOf(const RowList<float>& list) {
  DenseStamp sum;
  for (int i = 0; i < list.count; ++i)
    for (int u = 0; u < list.unknowns; ++u) {
      sum.gradient[u] += double(list.J[i][u]) * list.force[i];
      sum.gradientSize = std::max(sum.gradientSize, std::fabs(double(list.J[i][u]) * list.force[i]));
      for (int w = 0; w < list.unknowns; ++w) {
        const double term = double(list.k[i]) * list.share[i] * list.J[i][u] * list.J[i][w];
        sum.hessian[u][w] += term;
        sum.hessianSize = std::max(sum.hessianSize, std::fabs(term));
      }
    }
  return sum;
}

void expectWrench(const Twist<float>& stamped, const DenseStamp& dense, int at, const char* name) {
  const float got[6] = {stamped.lin.x, stamped.lin.y, stamped.lin.z, stamped.ang.x, stamped.ang.y, stamped.ang.z};
  for (int k = 0; k < 6; ++k)
    ASSERT_NEAR(got[k], dense.gradient[at + k], 1e-5 * dense.gradientSize) << name << " gradient " << at + k;
}

/// Columns are what the block makes of the unit twists.
void expectBlock(const Sym6<float>& stamped, const DenseStamp& dense, int at, const char* name) {
  for (int k = 0; k < 6; ++k) {
    float unit[6] = {};
    unit[k] = 1;
    const Twist<float> column = stamped * twistAt(unit);
    const float got[6] = {column.lin.x, column.lin.y, column.lin.z, column.ang.x, column.ang.y, column.ang.z};
    for (int i = 0; i < 6; ++i)
      ASSERT_NEAR(got[i], dense.hessian[at + i][at + k], 1e-5 * dense.hessianSize) << name << " hessian " << i << k;
  }
}

template <template <class> class F>
void expectStamp(F<float> instance, const Motion& at, const char* name) {
  const DenseStamp dense = denseOf(listRows<F, float>(instance, at.d));
  if constexpr (kIsPair<F>) {
    rows::StampSink<float> sink;
    sink.clear();
    instance.rows(twistAt(at.d), twistAt(at.d + 6), sink);
    expectWrench(shiftWrench(sink.wrench, sink.armA), dense, 0, name);
    expectWrench(-shiftWrench(sink.wrench, sink.armB), dense, 6, name);
    expectBlock(shifted(sink.stiffness, sink.armA), dense, 0, name);
    expectBlock(shifted(sink.stiffness, sink.armB), dense, 6, name);
  } else {
    constexpr int kBlocks = F<float>::kBlocks;
    V3<float> motion[kBlocks];
    for (int i = 0; i < kBlocks; ++i) motion[i] = {at.d[3 * i], at.d[3 * i + 1], at.d[3 * i + 2]};
    rows::BlockStampSink<float, kBlocks> sink;
    instance.rows(motion, sink);
    for (int b = 0; b < kBlocks; ++b) {
      float got[3], diagonal[3][3];
      put(got, sink.gradient[b]);
      const rows::Sym3<float>& m = sink.diagonal[b];
      put(diagonal[0], m * V3<float>{1, 0, 0}), put(diagonal[1], m * V3<float>{0, 1, 0});
      put(diagonal[2], m * V3<float>{0, 0, 1});
      for (int i = 0; i < 3; ++i) {
        ASSERT_NEAR(got[i], dense.gradient[3 * b + i], 1e-5 * dense.gradientSize) << name;
        for (int j = 0; j < 3; ++j)
          ASSERT_NEAR(diagonal[i][j], dense.hessian[3 * b + i][3 * b + j], 1e-5 * dense.hessianSize) << name;
      }
    }
  }
}

TEST(Families, StampIsJacobianTimesForceAndStiffness) {
  forEachFamily([]<template <class> class F>(Family<F>, const char* name) {
    Random random(4);
    for (int round = 0; round < kRounds && !testing::Test::HasFatalFailure(); ++round) {
      expectStamp<F>(RandomRows<F>::any(random), Motion{}, name);
      const Drawn<F> drawn(random, 0.01f);
      expectStamp<F>(drawn.rows, drawn.at, name);
    }
  });
}

template <template <class> class F>
void runDual(F<float>& instance, const Motion& at, float leak) {
  if constexpr (kIsPair<F>) {
    rows::DualSink<float> sink{leak};
    instance.rows(twistAt(at.d), twistAt(at.d + 6), sink);
  } else {
    V3<float> motion[F<float>::kBlocks];
    for (int i = 0; i < F<float>::kBlocks; ++i) motion[i] = {at.d[3 * i], at.d[3 * i + 1], at.d[3 * i + 2]};
    rows::BlockDualSink<float, F<float>::kBlocks> sink{leak};
    instance.rows(motion, sink);
  }
}

struct BoundsSeen {
  int free = 0, atBound = 0, sticks = 0, slips = 0;
};

template <template <class> class F>
void expectBounded(F<float> instance, const Motion& at, BoundsSeen& seen, const char* name) {
  const RowList<float> list = listRows<F, float>(instance, at.d);
  runDual<F>(instance, at, 1);
  for (int i = 0; i < list.count; ++i) {
    const float force = *list.lambda[i];
    ASSERT_NEAR(force, list.force[i], 1e-6f * std::fabs(list.force[i])) << name << " row " << i;
    ASSERT_GE(force, list.lower[i]) << name;
    ASSERT_LE(force, list.upper[i]) << name;
    ++(force == list.lower[i] || force == list.upper[i] ? seen.atBound : seen.free);
    if (list.cone[i] == Cone::Alone) {
      ASSERT_LE(std::fabs(force), list.bound[i] * (1 + 1e-6f)) << name << " row " << i;
    }
    if (list.cone[i] != Cone::First) continue;
    ASSERT_LE(std::hypot(force, *list.lambda[i + 1]), list.bound[i] * (1 + 1e-6f)) << name << " row " << i;
    ++(list.share[i] < 1 ? seen.slips : seen.sticks);
  }
}

TEST(Families, ForcesStayWithinTheirBounds) {
  BoundsSeen seen;
  forEachFamily([&]<template <class> class F>(Family<F>, const char* name) {
    Random random(5);
    for (int round = 0; round < 2 * kRounds && !testing::Test::HasFatalFailure(); ++round) {
      const Drawn<F> drawn(random, 0.003f);
      expectBounded<F>(drawn.rows, drawn.at, seen, name);
    }
  });
  for (const int count : {seen.free, seen.atBound, seen.sticks, seen.slips}) EXPECT_GT(count, 100);
}

TEST(Families, DualLeaksTheSameShareOfEveryMultiplier) {
  forEachFamily([]<template <class> class F>(Family<F>, const char* name) {
    Random random(6);
    for (int round = 0; round < kRounds; ++round) {
      F<float> whole = RandomRows<F>::any(random), leaking = whole;
      const Motion at(random, 0.003f);
      const RowList<float> a = listRows<F, float>(whole, at.d), b = listRows<F, float>(leaking, at.d);
      runDual<F>(whole, at, 1);
      runDual<F>(leaking, at, 0.5f);
      for (int i = 0; i < a.count; ++i) ASSERT_EQ(*b.lambda[i], 0.5f * *a.lambda[i]) << name << " row " << i;
    }
  });
}

// ---- Rest and scale --------------------------------------------------------------------------------------------

TEST(Families, RestStaysAtRest) {
  forEachFamily([]<template <class> class F>(Family<F>, const char* name) {
    Random random(7);
    for (int round = 0; round < kRounds; ++round) {
      F<float> instance = RandomRows<F>::atRest(random);
      // At rest, or all blocks drift together.
      Motion at;
      const V3<float> drift = round % 2 ? randomVector(random, 1) : V3<float>{};
      for (int b = 0; b < kMaxUnknowns; b += kIsPair<F> ? 6 : 3) put(at.d + b, drift);
      const RowList<float> list = listRows<F, float>(instance, at.d);
      for (int i = 0; i < list.count; ++i) ASSERT_EQ(list.force[i], 0) << name << " row " << i;
      runDual<F>(instance, at, 1);
      for (int i = 0; i < list.count; ++i) ASSERT_EQ(*list.lambda[i], 0) << name << " row " << i;
    }
  });
}

TEST(Families, ForcesScaleExactlyByPowersOfTwo) {
  forEachFamily([]<template <class> class F>(Family<F>, const char* name) {
    Random random(8);
    for (int round = 0; round < kRounds; ++round) {
      F<float> one = RandomRows<F>::any(random), scaled = one;
      const float by = std::ldexp(1.0f, static_cast<int>(random.bits() % 41) - 20);
      RandomRows<F>::scaleForces(scaled, by);
      const Motion at(random, 0.003f);
      const RowList<float> a = listRows<F, float>(one, at.d), b = listRows<F, float>(scaled, at.d);
      for (int i = 0; i < a.count; ++i) {
        ASSERT_EQ(b.force[i], by * a.force[i]) << name << " row " << i;
        ASSERT_EQ(b.k[i] * b.share[i], by * (a.k[i] * a.share[i])) << name << " row " << i;
      }
      runDual<F>(one, at, 1);
      runDual<F>(scaled, at, 1);
      for (int i = 0; i < a.count; ++i) ASSERT_EQ(*b.lambda[i], by * *a.lambda[i]) << name << " row " << i;
    }
  });
}

// ---- Every width gives the bits of float -----------------------------------------------------------------------

/// NaNs differ in sign and payload between processors; the engine never looks at those.
uint32_t comparable(float a) { return a != a ? 0x7fc00000u : std::bit_cast<uint32_t>(a); }

/// All that a sink finds, as numbers: T is a struct of R only, read in lane `lane` of N.
template <int N, class T>
void append(std::vector<uint32_t>& out, const T& value, int lane) {
  const int fields = sizeof(T) / (N * sizeof(float));
  for (int i = 0; i < fields; ++i) {
    float one;
    std::memcpy(&one, reinterpret_cast<const char*>(&value) + sizeof(float) * static_cast<size_t>(i * N + lane), 4);
    out.push_back(comparable(one));
  }
}

template <class R>
struct Everything {
  Twist<R> d[2];
  V3<R> blocks[4];
};

template <int N, template <class> class F>
void runPair(const F<lane::Real<N>>& instance, const Twist<lane::Real<N>> (&d)[2], std::vector<uint32_t>* out) {
  using R = lane::Real<N>;
  F<R> probed = instance, moved = instance, stamped = instance;
  rows::ProbeSink<R, F<R>::kRows> probe;
  probed.rows(d[0], d[1], probe);
  rows::DualSink<R> dual{rows::splat<R>(0.98f)};
  moved.rows(d[0], d[1], dual);
  rows::StampSink<R> stamp;
  stamp.clear();
  stamped.rows(d[0], d[1], stamp);
  for (int lane = 0; lane < N; ++lane) {
    append<N>(out[lane], probe.armA, lane);
    append<N>(out[lane], probe.row, lane);
    append<N>(out[lane], moved, lane);
    append<N>(out[lane], stamp, lane);
  }
}

template <int N, template <class> class F>
void runBlocks(const F<lane::Real<N>>& instance, const V3<lane::Real<N>> (&d)[4], std::vector<uint32_t>* out) {
  using R = lane::Real<N>;
  constexpr int kBlocks = F<R>::kBlocks;
  F<R> probed = instance, moved = instance, stamped = instance;
  rows::BlockProbeSink<R, kBlocks> probe;
  probed.rows(d, probe);
  rows::BlockDualSink<R, kBlocks> dual{rows::splat<R>(0.98f)};
  moved.rows(d, dual);
  rows::BlockStampSink<R, kBlocks> stamp;
  stamped.rows(d, stamp);
  for (int lane = 0; lane < N; ++lane) {
    append<N>(out[lane], probe, lane);
    append<N>(out[lane], moved, lane);
    append<N>(out[lane], stamp, lane);
  }
}

/// What all sinks find in the 16 lanes of a tile at width N.
template <int N, template <class> class F>
std::vector<std::vector<uint32_t>> outputs(const Tile<F>& tile, const Tile<Everything>& motion) {
  std::vector<std::vector<uint32_t>> out(kTile);
  for (int at = 0; at < kTile; at += N) {
    const auto d = motion.template load<N>(at);
    if constexpr (kIsPair<F>)
      runPair<N, F>(tile.template load<N>(at), d.d, &out[static_cast<size_t>(at)]);
    else
      runBlocks<N, F>(tile.template load<N>(at), d.blocks, &out[static_cast<size_t>(at)]);
  }
  return out;
}

template <template <class> class F>
void fill(Random& random, bool nasty, Tile<F>& tile, Tile<Everything>& motion) {
  for (int lane = 0; lane < kTile; ++lane) {
    tile.set(lane, RandomRows<F>::any(random));
    for (auto& field : motion.data) field[lane] = random.number(0.1f);
    if (!nasty) continue;
    for (auto& field : tile.data) field[lane] = random.bits() % 4 ? field[lane] : random.nasty();
    for (auto& field : motion.data) field[lane] = random.nasty();
  }
}

TEST(Families, EveryWidthGivesTheBitsOfFloat) {
  forEachFamily([]<template <class> class F>(Family<F>, const char* name) {
    Random random(9);
    Tile<F> tile;
    Tile<Everything> motion;
    for (int round = 0; round < 100 && !testing::Test::HasFatalFailure(); ++round) {
      fill<F>(random, round % 2 == 1, tile, motion);
      const auto one = outputs<1, F>(tile, motion);
      ASSERT_GT(one[0].size(), 20u);
      ASSERT_TRUE((outputs<4, F>(tile, motion)) == one) << name;
      ASSERT_TRUE((outputs<8, F>(tile, motion)) == one) << name;
      ASSERT_TRUE((outputs<16, F>(tile, motion)) == one) << name;
    }
  });
}

}  // namespace
}  // namespace avbd::oracle
