// The hash is a fixed function of the bytes alone and spreads every bit.
#include "base/hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <set>
#include <vector>

namespace avbd {
namespace {

std::vector<unsigned char> sample(size_t size) {
  std::vector<unsigned char> bytes(size);
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<unsigned char>(i * 37 + 11);
  return bytes;
}

TEST(Hash, GoldenValues) {
  // Recorded state hashes rest on this function: it must not change unnoticed.
  EXPECT_EQ(hash64(nullptr, 0), 0x68223b4811bd6370u);
  EXPECT_EQ(hash64(sample(5).data(), 5), 0x0a325ec8d01fd394u);
  EXPECT_EQ(hash64(sample(100).data(), 100), 0x115de24ed4edaee8u);
  EXPECT_EQ(hash64(sample(100).data(), 100, 1), 0xd40ba46eb3c9fc9au);
}

TEST(Hash, CutsDoNotMatter) {
  const auto bytes = sample(131);
  const uint64_t whole = hash64(bytes.data(), bytes.size());
  for (size_t step = 1; step <= bytes.size(); ++step) {
    Hash64 hash;
    for (size_t i = 0; i < bytes.size(); i += step) hash.bytes(bytes.data() + i, std::min(step, bytes.size() - i));
    EXPECT_EQ(hash.digest(), whole) << "pieces of " << step;
  }
}

TEST(Hash, DigestLeavesTheStreamAsItWas) {
  const auto bytes = sample(70);
  Hash64 hash;
  hash.bytes(bytes.data(), 45);
  EXPECT_EQ(hash.digest(), hash64(bytes.data(), 45));
  hash.bytes(bytes.data() + 45, 25);
  EXPECT_EQ(hash.digest(), hash64(bytes.data(), 70));
}

TEST(Hash, LengthCounts) {
  const std::vector<unsigned char> zeros(200);
  std::set<uint64_t> seen;
  for (size_t size = 0; size <= zeros.size(); ++size) seen.insert(hash64(zeros.data(), size));
  EXPECT_EQ(seen.size(), zeros.size() + 1);
}

TEST(Hash, EveryBitChangesAboutHalfOfTheDigest) {
  auto bytes = sample(100);
  const uint64_t whole = hash64(bytes.data(), bytes.size());
  double sum = 0;
  for (size_t bit = 0; bit < 800; ++bit) {
    bytes[bit / 8] ^= static_cast<unsigned char>(1u << (bit % 8));
    const int changed = std::popcount(whole ^ hash64(bytes.data(), bytes.size()));
    EXPECT_GE(changed, 12) << "bit " << bit;
    sum += changed;
    bytes[bit / 8] ^= static_cast<unsigned char>(1u << (bit % 8));
  }
  EXPECT_NEAR(sum / 800, 32, 0.6);
}

TEST(Hash, EmptyAndOneElementListsDiffer) {
  Hash64 a, b;
  a.values(std::vector<uint32_t>{});
  a.values(std::vector<uint32_t>{1});
  b.values(std::vector<uint32_t>{1});
  b.values(std::vector<uint32_t>{});
  EXPECT_NE(a.digest(), b.digest());
}

TEST(Hash, SignOfZeroCounts) {
  Hash64 a, b;
  a.value(0.0f);
  b.value(-0.0f);
  EXPECT_NE(a.digest(), b.digest());
}

}  // namespace
}  // namespace avbd
