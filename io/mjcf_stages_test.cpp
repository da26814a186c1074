// Which joints of one MJCF body become one joint of ours, and what stands between.
#include "io/mjcf_stages.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/mjcf_mass.h"

namespace avbd::mjcf {
namespace {

Body bodyWith(const std::string& joints) {
  return parseText("<mujoco><compiler angle='radian'/><worldbody><body>" + joints +
                       "<geom size='1'/></body></worldbody></mujoco>",
                   "t.xml")
      .bodies[1];
}

std::vector<size_t> countsOf(const std::string& joints) {
  std::vector<size_t> out;
  for (const Stage& stage : stagesOf(bodyWith(joints))) out.push_back(stage.count);
  return out;
}

using Counts = std::vector<size_t>;

TEST(MjcfStages, WhatOneJointCanDoIsOneStage) {
  EXPECT_EQ(countsOf(""), Counts{});
  EXPECT_EQ(countsOf("<joint/>"), Counts{1});
  EXPECT_EQ(countsOf("<joint type='ball'/>"), Counts{1});
  EXPECT_EQ(countsOf("<joint type='slide' axis='1 0 0'/><joint type='slide'/><joint axis='0 1 0'/>"), Counts{3});
  EXPECT_EQ(countsOf("<joint type='slide' axis='0 1 0'/><joint axis='0 1 0'/>"), Counts{2});
  EXPECT_EQ(countsOf("<joint type='slide' axis='1 1 0'/><joint type='slide' axis='-1 1 0'/><joint type='slide'/>"
                     "<joint type='ball'/>"),
            Counts{4});
}

TEST(MjcfStages, TwoHingesAreOneWhereAxesMeetSquareAndOneIsBounded) {
  EXPECT_EQ(countsOf("<joint axis='0 1 0' range='-2 2'/><joint axis='1 0 0'/>"), Counts{2});
  EXPECT_EQ(countsOf("<joint axis='0 1 0'/><joint axis='1 0 0' range='-2 2'/>"), Counts{2});
  EXPECT_EQ(countsOf("<joint axis='0 1 0'/><joint axis='1 0 0'/>"), (Counts{1, 1}));
  EXPECT_EQ(countsOf("<joint axis='0 1 0' range='-3 2'/><joint axis='1 0 0'/>"), (Counts{1, 1}));
  // Bounds count from where the file has the body.
  EXPECT_EQ(countsOf("<joint axis='0 1 0' range='1 5' ref='3'/><joint axis='1 0 0'/>"), Counts{2});
  EXPECT_EQ(countsOf("<joint axis='0 1 0' range='-2 2'/><joint axis='1 1 0'/>"), (Counts{1, 1}));
  // Anchors anywhere along the axes, as long as these meet.
  EXPECT_EQ(countsOf("<joint axis='0 1 0' range='-2 2' pos='0 3 0'/><joint axis='1 0 0' pos='5 0 0'/>"), Counts{2});
  EXPECT_EQ(countsOf("<joint axis='0 1 0' range='-2 2' pos='0 3 1'/><joint axis='1 0 0' pos='5 0 0'/>"),
            (Counts{1, 1}));
}

TEST(MjcfStages, OtherwiseABodyStandsBetween) {
  const std::string y = "<joint axis='0 1 0' range='-2 2'/>", x = "<joint axis='1 0 0' range='-2 2'/>";
  EXPECT_EQ(countsOf(x + "<joint axis='0 0 1' range='-1 1'/>" + y), (Counts{2, 1}));
  EXPECT_EQ(countsOf("<joint type='slide' axis='1 0 0'/><joint type='slide' axis='1 0 0'/>"), (Counts{1, 1}));
  EXPECT_EQ(countsOf("<joint type='slide' axis='1 1 0'/><joint type='slide' axis='1 0 0'/>"), (Counts{1, 1}));
  EXPECT_EQ(countsOf("<joint type='slide' axis='1 1 0'/><joint axis='1 0 0'/>"), (Counts{1, 1}));
  EXPECT_EQ(countsOf(y + "<joint type='slide'/>"), (Counts{1, 1}));
  EXPECT_EQ(countsOf(y + "<joint type='ball'/>"), (Counts{1, 1}));
  EXPECT_EQ(countsOf("<joint type='slide'/>" + y + x), Counts{3});
}

TEST(MjcfStages, FramesLieAlongTheAxes) {
  const Body body = bodyWith("<joint type='slide' axis='0 0 -1'/><joint axis='0 1 0' pos='1 2 3'/>");
  const Stage stage = stagesOf(body)[0];
  EXPECT_EQ(stage.frame.position.x, 1);
  const Vec3d x = rotate(stage.frame.rotation, Vec3d{1, 0, 0}), y = rotate(stage.frame.rotation, Vec3d{0, 1, 0});
  EXPECT_NEAR(x.y, 1, 1e-12);
  EXPECT_NEAR(y.z * stage.signs[0], -1, 1e-12);
  EXPECT_EQ(stage.axes, (std::vector<JointAxis>{JointAxis::LinearY, JointAxis::Twist}));
  EXPECT_EQ(stage.signs[1], 1);
  EXPECT_FALSE(stage.turned);
}

// The sum about the anchor is what it was; only the share of inertia lies elsewhere.
TEST(MjcfStages, WhatIsSplitOffKeepsMassCentreAndInertia) {
  const Mass before{5, {0.3, -0.2, 0.7}, {0.5, 0.6, 0.7, 0.1, 0.05, -0.02}};
  Mass child = before;
  const Vec3d anchor{0.1, 0.1, 0.2};
  const Mass parts[] = {splitOff(child, anchor), child};
  EXPECT_GT(parts[0].mass, 0.001 * before.mass);
  EXPECT_EQ(parts[0].center.z, anchor.z);
  const Mass whole = sum(parts);
  EXPECT_NEAR(whole.mass, before.mass, 1e-12);
  EXPECT_NEAR(length(whole.center - before.center), 0, 1e-12);
  EXPECT_NEAR(whole.inertia.xx, before.inertia.xx, 1e-12);
  EXPECT_NEAR(whole.inertia.yy, before.inertia.yy, 1e-12);
  EXPECT_NEAR(whole.inertia.xz, before.inertia.xz, 1e-12);
}

// A ball far out on a weightless rod: no inertia is left to take the point mass from.
TEST(MjcfStages, WhatIsLeftIsAlwaysABody) {
  Mass child{1, {0, 0, 50}, {0.004, 0.004, 0.004}};
  splitOff(child, {});
  const auto moments = principal(child.inertia).values;
  for (const double moment : moments) EXPECT_GT(moment, 0.003);
}

}  // namespace
}  // namespace avbd::mjcf
