// Moving boxes and growing boxes find in the tree what a loop over all leaves finds.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "geom/tree.h"

namespace avbd {
namespace {

struct Field {
  DynamicTree tree;
  std::vector<Aabb> boxes;
  std::mt19937 random{11};

  explicit Field(uint32_t count, float center = 0) {
    std::uniform_real_distribution<float> place(-30, 30), size(0.05f, 2);
    for (uint32_t i = 0; i < count; ++i) {
      const Vec3 p{center + place(random), place(random), place(random)}, h{size(random), size(random), size(random)};
      boxes.push_back({p - h, p + h});
      tree.insert(boxes.back(), i);
    }
  }
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
};

/// By stepping through the slabs in another way: the interval of each axis, in long double.
bool meets(const BoxWay& way, const Aabb& box, double length) {
  long double in = 0, out = length;
  const double o[3] = {way.from.x, way.from.y, way.from.z}, d[3] = {way.direction.x, way.direction.y, way.direction.z};
  const double h[3] = {way.half.x, way.half.y, way.half.z};
  const float lo[3] = {box.lower.x, box.lower.y, box.lower.z}, hi[3] = {box.upper.x, box.upper.y, box.upper.z};
  for (int i = 0; i < 3; ++i) {
    const long double low = static_cast<long double>(lo[i]) - h[i] - o[i],
                      high = static_cast<long double>(hi[i]) + h[i] - o[i];
    if (d[i] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    in = std::max(in, std::min(low / d[i], high / d[i]));
    out = std::min(out, std::max(low / d[i], high / d[i]));
  }
  return in <= out;
}

BoxWay randomWay(Field& field, int round) {
  Vec3d d{field.within(-1, 1), field.within(-1, 1), field.within(-1, 1)};
  if (round % 3 == 0) d.x = 0;
  if (round % 4 == 0) d.y = 0;
  if (d == Vec3d{}) d.z = 1;
  d = d * (1 / length(d));
  const double half = round % 2 ? 0 : 1.5, far = round % 7 == 0 ? 1e6 : 20;
  const Vec3d aim{field.within(-30, 30), field.within(-30, 30), field.within(-30, 30)};
  return {aim - d * far, d, round % 5 == 0 ? far : 3 * far, {half, half * 0.5, half * 2}};
}

TEST(TreeWay, alongFindsWhatALoopFinds) {
  Field field(500);
  size_t all = 0;
  for (int round = 0; round < 2000; ++round) {
    const BoxWay way = randomWay(field, round);
    std::vector<uint32_t> found, expected;
    field.tree.along(way, [&](uint32_t i, double left) {
      found.push_back(i);
      return left;
    });
    for (uint32_t i = 0; i < field.boxes.size(); ++i)
      if (meets(way, field.boxes[i], way.length)) expected.push_back(i);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected) << round;
    all += found.size();
  }
  EXPECT_GT(all, 3000u);
}

TEST(TreeWay, cuttingTheWayShortKeepsTheNearest) {
  Field field(2000);
  size_t asked = 0, hits = 0;
  for (int round = 0; round < 1000; ++round) {
    const BoxWay way = randomWay(field, round);
    const WayAxes axes(way);
    double best = 1e300, expected = 1e300;
    field.tree.along(way, [&](uint32_t i, double left) {
      ++asked;
      best = std::min(best, axes.meet(field.boxes[i], way.length).begin);
      return std::min(left, best);
    });
    for (const Aabb& box : field.boxes) {
      const WaySpan span = axes.meet(box, way.length);
      if (span.begin <= span.end) expected = std::min(expected, span.begin);
    }
    ASSERT_EQ(best, expected) << round;
    hits += expected < 1e300;
  }
  // Near ones first: hardly more leaves are asked than there are answers.
  EXPECT_LT(asked, 3 * hits);
  int calls = 0;
  field.tree.along(randomWay(field, 1), [&](uint32_t, double) {
    ++calls;
    return -1.0;
  });
  EXPECT_LE(calls, 1);
}

TEST(TreeWay, aroundFindsWhatALoopFinds) {
  for (const float center : {0.0f, 4096.0f}) {
    Field field(800, center);
    for (int round = 0; round < 1000; ++round) {
      const Vec3 p = toFloat(Vec3d{center + field.within(-40, 40), field.within(-40, 40), field.within(-40, 40)});
      const Vec3 h{0.5f, 1, 0.25f};
      const Aabb box{p - h, p + h};
      const float reach = static_cast<float>(field.within(0, 8));
      std::vector<uint32_t> found, expected;
      field.tree.around(box, reach, [&](uint32_t i, float left) {
        found.push_back(i);
        return left;
      });
      float nearest = 1e30f, best = 1e30f;
      field.tree.around(box, reach, [&](uint32_t i, float left) {
        best = std::min(best, squaredGap(field.boxes[i], box));
        return std::min(left, std::sqrt(best));
      });
      for (uint32_t i = 0; i < field.boxes.size(); ++i) {
        const float gap = squaredGap(field.boxes[i], box);
        if (gap <= reach * reach) expected.push_back(i);
        if (gap <= reach * reach) nearest = std::min(nearest, gap);
      }
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, expected);
      ASSERT_EQ(best, nearest);
    }
  }
}

TEST(TreeWay, emptyTree) {
  const DynamicTree tree;
  tree.along({{}, {1, 0, 0}, 10, {}}, [](uint32_t, double) -> double {
    ADD_FAILURE();
    return -1;
  });
  tree.around({}, 10, [](uint32_t, float) -> float {
    ADD_FAILURE();
    return -1;
  });
}

}  // namespace
}  // namespace avbd
