// Numbers print short, exact and the same everywhere.
#include "base/format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace avbd {
namespace {

TEST(Format, ShortestThatReadsBack) {
  EXPECT_EQ(toText(0.1f), "0.1");
  EXPECT_EQ(toText(0.1), "0.1");
  EXPECT_EQ(toText(-2.0f), "-2");
  EXPECT_EQ(toText(16777217.0), "16777217");
  EXPECT_EQ(toText(1e30f), "1e+30");
  EXPECT_EQ(std::stof(toText(1.0f / 3)), 1.0f / 3);
  EXPECT_EQ(std::stod(toText(1.0 / 3)), 1.0 / 3);
}

TEST(Format, NotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(toText(nan), "nan");
  EXPECT_EQ(toText(std::copysign(nan, -1.0f)), "nan");
  EXPECT_EQ(toText(inf), "inf");
  EXPECT_EQ(toText(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(Format, Composed) {
  EXPECT_EQ(toText(Vec3{1, 2.5f, std::nanf("")}), "(1, 2.5, nan)");
  EXPECT_EQ(toText(Vec3d{0, -0.25, 1e10}), "(0, -0.25, 1e+10)");
  EXPECT_EQ(toText(Quat{}), "(1, 0, 0, 0)");
  EXPECT_EQ(toText(SymMat3{1, 2, 3, 4, 5, 6}), "(1, 2, 3, 4, 5, 6)");
  EXPECT_EQ(toText(BodyId{}), "null");
  EXPECT_EQ(toText(BodyId{3, 2}), "3 (generation 2)");
  EXPECT_EQ(toText(-7), "-7");
  EXPECT_EQ(toText(true), "true");
}

}  // namespace
}  // namespace avbd
