// The benchmarks' large scenes hold what they say, apart from one another at the start.
#include "scenes/large.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scenes/trig.h"

namespace avbd::scenes {
namespace {

struct Size {
  const char* name;
  size_t dynamic, joints;
};

TEST(Large, HoldsWhatItSays) {
  for (const Size& size : {Size{"pyramid50", 1275, 0}, Size{"pyramids_100", 2100, 0}, Size{"rain", 10000, 0},
                           Size{"joint_grid", 10000, 19807}, Size{"ragdolls_200", 3200, 3000},
                           Size{"boxes_100", 100, 0}, Size{"boxes_3000", 3000, 0}, Size{"slab_1000", 343, 0}}) {
    SCOPED_TRACE(size.name);
    const Scene* scene = find(size.name);
    ASSERT_TRUE(scene);
    const Model m = scene->make({});
    const Layout layout = layoutOf(m.world);
    EXPECT_EQ(static_cast<size_t>(std::count(layout.dynamic.begin(), layout.dynamic.end(), 1)), size.dynamic);
    EXPECT_EQ(m.world.jointCount(), size.joints);
    const std::vector<Pose> poses = posesOf(m.world, layout);
    EXPECT_LT(penetrationOf(layout, poses).max, 1e-6);
    EXPECT_LT(jointGapMax(layout, poses), 1e-5);
    for (size_t i = 0; i < poses.size() && scene->watch.escaped; ++i)
      EXPECT_FALSE(layout.dynamic[i] && scene->watch.escaped(poses[i].position)) << i;
  }
}

TEST(Large, NamesDifferFromAllOthers) {
  std::set<std::string> names;
  for (const Scene& s : all()) names.insert(s.name);
  for (const Scene& s : large()) {
    EXPECT_TRUE(names.insert(s.name).second) << s.name;
    EXPECT_TRUE(s.check) << s.name;
    EXPECT_EQ(find(s.name), &s);
  }
}

TEST(Trig, AsTheLibrarysToADigit) {
  for (int i = -4000; i <= 4000; ++i) {
    const double angle = 0.0137 * i;
    EXPECT_NEAR(sine(angle), std::sin(angle), 4e-16);
    EXPECT_NEAR(cosine(angle), std::cos(angle), 4e-16);
  }
  EXPECT_EQ(sine(0), 0);
  EXPECT_EQ(cosine(0), 1);
}

}  // namespace
}  // namespace avbd::scenes
