// Every stage has a name of its own, in the words of its file.
#include <avbd/profile.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace avbd {
namespace {

TEST(Profile, EveryStageHasItsOwnName) {
  std::set<std::string> names;
  for (size_t i = 0; i < kStageCount; ++i) names.insert(stageName(static_cast<Stage>(i)));
  EXPECT_EQ(names.size(), kStageCount);
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_STREQ(stageName(Stage::Pairs), "pairs");
  EXPECT_STREQ(stageName(Stage::BeginRows), "begin_rows");
  EXPECT_STREQ(stageName(Stage::Publish), "publish");
  // kStageCount counts the enum: the next value has no name.
  EXPECT_STREQ(stageName(static_cast<Stage>(kStageCount)), "unknown");
}

}  // namespace
}  // namespace avbd
