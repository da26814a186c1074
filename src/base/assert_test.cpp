// AVBD_ASSERT speaks when it is on and costs nothing when it is off.
#include "base/assert.h"

#include <gtest/gtest.h>

namespace avbd {
namespace {

TEST(Assert, FailedSaysWhatAndWhere) {
  EXPECT_DEATH(assertFailed("a < b", "file.cpp", 7), "file.cpp:7: AVBD_ASSERT\\(a < b\\) failed");
}

TEST(Assert, TruePassesAndFalseDiesWhereOn) {
  int count = 0;
  AVBD_ASSERT(++count >= 0);
  EXPECT_EQ(count, AVBD_ASSERTS_ON);
#if AVBD_ASSERTS_ON
  EXPECT_DEATH(AVBD_ASSERT(count == 99), "AVBD_ASSERT\\(count == 99\\) failed");
#endif
}

}  // namespace
}  // namespace avbd
