// Gather, scatter and tiles against plain loops over floats.
#include "lane/gather.h"

#include <gtest/gtest.h>

#include "lane/formulas.h"
#include "lane/tile.h"

namespace avbd::lane {
namespace {

using formulas::Random;

constexpr int kRows = 64;

template <int Stride>
struct Memory {
  alignas(64) float row[kRows][Stride];
  explicit Memory(uint64_t seed) {
    Random random(seed);
    for (auto& r : row)
      for (float& a : r) a = random.number(100);
  }
  bool operator==(const Memory& other) const { return std::memcmp(row, other.row, sizeof(row)) == 0; }
};
struct Index {
  uint32_t at[16];
  explicit Index(uint64_t seed, uint32_t span = kRows) {
    Random random(seed);
    for (uint32_t& i : at) i = random.bits() % span;
  }
};
void fill(float* p, int count, uint64_t seed) {
  Random random(seed);
  for (int i = 0; i < count; ++i) p[i] = random.number(100);
}

template <int N>
void twists() {
  const Memory<kBodyRow> memory(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Index index(trial, trial % 2 ? kRows : 3);  // few rows: many repeat within a register
    Tile<Twist> got, add;
    fill(add.data[0], 6 * kTile, trial);
    for (int lane = 0; lane < kTile; lane += N) got.store<N>(lane, gatherTwist<N>(memory.row[0], index.at + lane));
    Memory<kBodyRow> sum = memory, plain = memory;
    for (int lane = 0; lane < kTile; lane += N) scatterAddTwist<N>(sum.row[0], index.at + lane, add.load<N>(lane));
    for (int lane = 0; lane < kTile; ++lane) {
      const Twist<float> t = got.get(lane), a = add.get(lane);
      const float* from = memory.row[index.at[lane]];
      const float want[6] = {from[0], from[1], from[2], from[4], from[5], from[6]};
      EXPECT_EQ(std::memcmp(&t, want, sizeof(want)), 0);
      float* to = plain.row[index.at[lane]];
      to[0] += a.lin.x, to[1] += a.lin.y, to[2] += a.lin.z, to[4] += a.ang.x, to[5] += a.ang.y, to[6] += a.ang.z;
    }
    EXPECT_TRUE(sum == plain) << "width " << N;
  }
}
TEST(Gather, TwistsByIndex) {
  twists<1>();
  twists<4>();
  twists<8>();
  twists<16>();
}

template <int N>
void matrices() {
  const Memory<kMatrixRow> memory(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Index index(trial, trial % 2 ? kRows : 3);
    Tile<Sym6> got, add;
    fill(add.data[0], 21 * kTile, trial);
    for (int lane = 0; lane < kTile; lane += N) got.store<N>(lane, gatherSym6<N>(memory.row[0], index.at + lane));
    Memory<kMatrixRow> sum = memory, plain = memory;
    for (int lane = 0; lane < kTile; lane += N) scatterAddSym6<N>(sum.row[0], index.at + lane, add.load<N>(lane));
    for (int lane = 0; lane < kTile; ++lane) {
      const Sym6<float> m = got.get(lane), a = add.get(lane);
      EXPECT_EQ(std::memcmp(&m, memory.row[index.at[lane]], sizeof(m)), 0);
      for (int k = 0; k < 21; ++k) plain.row[index.at[lane]][k] += reinterpret_cast<const float*>(&a)[k];
    }
    EXPECT_TRUE(sum == plain) << "width " << N;
  }
}
TEST(Gather, MatricesByIndex) {
  matrices<1>();
  matrices<4>();
  matrices<8>();
  matrices<16>();
}

template <int N>
void consecutive() {
  const Memory<kBodyRow> bodies(3);
  const Memory<kMatrixRow> blocks(4);
  Memory<kBodyRow> copy(5);
  Memory<kMatrixRow> blockCopy(6);
  for (int row = 0; row < kRows; row += N) {
    storeTwists<N>(copy.row[row], loadTwists<N>(bodies.row[row]));
    storeSym6<N>(blockCopy.row[row], loadSym6<N>(blocks.row[row]));
  }
  for (int row = 0; row < kRows; ++row) {
    EXPECT_EQ(std::memcmp(copy.row[row], bodies.row[row], 12), 0);
    EXPECT_EQ(std::memcmp(copy.row[row] + 4, bodies.row[row] + 4, 12), 0);
    EXPECT_EQ(copy.row[row][3], 0.0f);
    EXPECT_EQ(copy.row[row][7], 0.0f);
    EXPECT_EQ(std::memcmp(blockCopy.row[row], blocks.row[row], 84), 0);
    EXPECT_EQ(blockCopy.row[row][23], 0.0f);
  }
}
TEST(Gather, ConsecutiveRows) {
  consecutive<1>();
  consecutive<4>();
  consecutive<8>();
  consecutive<16>();
}

template <class R>
struct Nested {
  rows::V3<R> a;
  R b;
  rows::Q4<R> c[3];
};
TEST(Tile, KeepsEachLaneApart) {
  static_assert(Tile<Nested>::kCount == 16 && sizeof(Tile<Nested>) == 16 * 16 * 4);
  Tile<Nested> tile;
  for (int lane = 0; lane < kTile; ++lane) {
    Nested<float> one;
    for (int i = 0; i < 16; ++i) reinterpret_cast<float*>(&one)[i] = static_cast<float>(100 * lane + i);
    tile.set(lane, one);
  }
  EXPECT_EQ(tile.get(7).c[2].z, 715.0f);
  EXPECT_EQ(tile.data[3][9], 903.0f);
  const Nested<Wide<8>> wide = tile.load<8>(8);
  EXPECT_EQ(wide.b[1], 903.0f);
  EXPECT_EQ((laneOf<Nested, 8>(wide, 2).c[0].w), 1004.0f);
  Tile<Nested> copy = {};
  copy.store<16>(0, tile.load<16>(0));
  EXPECT_EQ(std::memcmp(&copy, &tile, sizeof(tile)), 0);
  copy.store<4>(4, tile.load<4>(0));
  EXPECT_EQ(copy.get(5).b, 103.0f);
  EXPECT_EQ(copy.get(8).b, 803.0f);
}

}  // namespace
}  // namespace avbd::lane
