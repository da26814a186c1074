// Every line of acceptance is a test: it fails if one of its figures does.
#include <gtest/gtest.h>

#include "scenes/scene.h"

namespace avbd::scenes {
namespace {

class Acceptance : public testing::TestWithParam<const Line*> {};

TEST_P(Acceptance, Line) {
  const Line& line = *GetParam();
  if (!line.run) GTEST_SKIP() << line.skipReason;
  const std::vector<Figure> figures = line.run({});
  EXPECT_FALSE(figures.empty());
  for (const Figure& f : figures)
    EXPECT_TRUE(passes(f)) << f.name << " " << f.params << " = " << f.measured << " " << f.unit << ", not within "
                           << f.lower << " .. " << f.upper;
}

std::vector<const Line*> everyLine() {
  std::vector<const Line*> list;
  for (const Line& line : lines()) list.push_back(&line);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Lines, Acceptance, testing::ValuesIn(everyLine()),
                         [](const testing::TestParamInfo<const Line*>& i) {
                           return i.param->list + "_" + i.param->name;
                         });

}  // namespace
}  // namespace avbd::scenes
