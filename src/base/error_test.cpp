// What is thrown names the definition, the field, the value and the range.
#include <avbd/error.h>
#include <gtest/gtest.h>

namespace avbd {
namespace {

TEST(Error, ReadsAsTheHeaderSays) {
  const Error error("BodyDef", "mass", "nan", "must be finite and > 0");
  EXPECT_STREQ(error.what(), "BodyDef.mass = nan: must be finite and > 0");
  EXPECT_EQ(error.definition(), "BodyDef");
  EXPECT_EQ(error.field(), "mass");
  EXPECT_EQ(error.value(), "nan");
  EXPECT_EQ(error.range(), "must be finite and > 0");
}

TEST(Error, LeavesOutWhatIsEmpty) {
  EXPECT_STREQ(Error("World::destroy", "id", "", "is null").what(), "World::destroy.id: is null");
  EXPECT_STREQ(Error("World::step", "", "", "is running").what(), "World::step: is running");
}

TEST(NonFiniteError, NamesStageAndBody) {
  const NonFiniteError error("solve_blocks", 7, 2);
  EXPECT_STREQ(error.what(), "step stopped at solve_blocks: the state of body 7 (generation 2) is not finite");
  EXPECT_EQ(error.stage(), "solve_blocks");
  EXPECT_EQ(error.bodyIndex(), 7u);
  EXPECT_EQ(error.bodyGeneration(), 2u);
}

}  // namespace
}  // namespace avbd
