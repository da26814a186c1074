// Every formula gives in each lane of every width the bits that it gives in float, and the same ones in every build.
#include <gtest/gtest.h>

#include "lane/formulas.h"

namespace avbd::lane {
namespace {

using formulas::Random;

constexpr int kLanes = 16;

/// NaNs differ in sign and payload between processors; the engine never looks at those.
uint32_t comparable(float a) { return a != a ? 0x7fc00000u : std::bit_cast<uint32_t>(a); }

template <class Formula>
struct Sample {
  alignas(64) float in[Formula::kIn][kLanes];
  alignas(64) float out[Formula::kOut][kLanes];

  Sample(Random& random, bool nasty) {
    for (auto& field : in)
      for (float& a : field) a = nasty ? random.nasty() : random.number(3);
  }
  void runFloat() {
    for (int lane = 0; lane < kLanes; ++lane) {
      float one[Formula::kIn], result[Formula::kOut] = {};
      for (int i = 0; i < Formula::kIn; ++i) one[i] = in[i][lane];
      Formula::run(one, result);
      for (int i = 0; i < Formula::kOut; ++i) out[i][lane] = result[i];
    }
  }
  template <int N>
  void expectSame(const char* name) const {
    using R = Wide<N>;
    for (int lane = 0; lane < kLanes; lane += N) {
      R wide[Formula::kIn], result[Formula::kOut] = {};
      for (int i = 0; i < Formula::kIn; ++i) wide[i] = load<R>(&in[i][lane]);
      Formula::run(wide, result);
      for (int i = 0; i < Formula::kOut; ++i)
        for (int j = 0; j < N; ++j)
          ASSERT_EQ(comparable(result[i][j]), comparable(out[i][lane + j]))
              << name << " output " << i << " width " << N << ": " << result[i][j] << " for " << out[i][lane + j];
    }
  }
};

template <class Formula>
uint64_t check(const char* name, bool nasty, int rounds) {
  Random random(nasty ? 1 : 2);
  uint64_t hash = 0xcbf29ce484222325u;
  for (int round = 0; round < rounds; ++round) {
    Sample<Formula> sample(random, nasty);
    sample.runFloat();
    sample.template expectSame<4>(name);
    sample.template expectSame<8>(name);
    sample.template expectSame<16>(name);
    if (testing::Test::HasFatalFailure()) return 0;
    for (auto& field : sample.out)
      for (float a : field) hash = (hash ^ comparable(a)) * 0x100000001b3u;
  }
  return hash;
}

TEST(EqualBits, EveryWidthOnEverydayInput) {
  uint64_t hash = 0;
  formulas::forEach([&](auto formula, const char* name) { hash ^= check<decltype(formula)>(name, false, 300); });
  EXPECT_EQ(hash, 0xa76e0dc4d804fd4au) << std::hex << hash
                                       << ": other bits than every other compiler, level and instruction set gives";
}

TEST(EqualBits, EveryWidthOnCornersOfTheFormat) {
  uint64_t hash = 0;
  formulas::forEach([&](auto formula, const char* name) { hash ^= check<decltype(formula)>(name, true, 1500); });
  EXPECT_EQ(hash, 0xda47bdf50508f585u) << std::hex << hash
                                       << ": other bits than every other compiler, level and instruction set gives";
}

template <int N>
void masksAndLoads() {
  using R = Wide<N>;
  alignas(64) float data[20], back[20] = {};
  uint32_t kind[20];
  for (int i = 0; i < 20; ++i) data[i] = static_cast<float>(i), kind[i] = i % 3;
  const R a = loadUnaligned<R>(data + 1);
  for (int i = 0; i < N; ++i) EXPECT_EQ(a[i], data[i + 1]);
  storeUnaligned(back + 3, a);
  for (int i = 0; i < N; ++i) EXPECT_EQ(back[i + 3], data[i + 1]);
  store(back, load<R>(data));
  for (int i = 0; i < N; ++i) EXPECT_EQ(back[i], data[i]);
  EXPECT_EQ(toBits(a < 3.0f), 3u);
  for (int count = 0; count <= N; ++count) EXPECT_EQ(toBits(firstLanes<R>(count)), (1u << count) - 1);
  EXPECT_TRUE(all(a < 100.0f) && !all(a < 1.5f) && any(a < 1.5f) && !any(a < 0.5f));
  EXPECT_EQ(toBits((a < 3.0f) ^ (a < 2.0f)), 2u);
  uint32_t twos = 0;
  for (int i = 0; i < N; ++i) twos |= static_cast<uint32_t>(kind[i + 1] == 2) << i;
  EXPECT_EQ(toBits(lanesEqual<R>(kind + 1, 2)), twos);
  EXPECT_EQ(std::bit_cast<uint32_t>(R(-0.0f)[N - 1]), 0x80000000u);
}
TEST(Wide, MasksLoadsAndStores) {
  masksAndLoads<4>();
  masksAndLoads<8>();
  masksAndLoads<16>();
  EXPECT_TRUE(firstLanes<float>(1) && !firstLanes<float>(0));
}

}  // namespace
}  // namespace avbd::lane
