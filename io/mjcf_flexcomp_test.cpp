// What <flexcomp> makes by itself: points as MuJoCo 3.14 numbers and places them.
#include "io/mjcf_flexcomp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace avbd::mjcf {
namespace {

void expectAt(Vec3d a, Vec3d b) { EXPECT_LT(length(a - b), 2e-6) << a.x << ' ' << a.y << ' ' << a.z; }

/// Six times the volume of each tetrahedron, without sign.
double sixVolumes(const FlexShape& shape) {
  double sum = 0;
  for (const FlexElement& e : shape.elements) {
    const Vec3d a = shape.points[e[0]];
    sum += std::abs(dot(shape.points[e[1]] - a, cross(shape.points[e[2]] - a, shape.points[e[3]] - a)));
  }
  return sum;
}

double area(const FlexShape& shape) {
  double sum = 0;
  for (const FlexElement& e : shape.elements)
    sum += length(cross(shape.points[e[1]] - shape.points[e[0]], shape.points[e[2]] - shape.points[e[0]])) / 2;
  return sum;
}

/// How many triangles have each edge.
std::map<std::pair<uint32_t, uint32_t>, int> edgesOf(const FlexShape& shape) {
  std::map<std::pair<uint32_t, uint32_t>, int> out;
  for (const FlexElement& e : shape.elements)
    for (size_t k = 0; k < 3; ++k) ++out[std::minmax(e[k], e[(k + 1) % 3])];
  return out;
}

TEST(Flexcomp, GridsAreCentredAndNumberedWithTheLastAxisFastest) {
  const FlexShape line = flexShape({FlexKind::Grid, 1, {4, 9, 9}, {0.1, 1, 1}});
  ASSERT_EQ(line.points.size(), 4u);
  ASSERT_EQ(line.elements.size(), 3u);
  expectAt(line.points[0], {-0.15, 0, 0});
  expectAt(line.points[3], {0.15, 0, 0});
  const FlexShape sheet = flexShape({FlexKind::Grid, 2, {3, 4, 9}, {0.1, 0.1, 1}});
  ASSERT_EQ(sheet.points.size(), 12u);
  ASSERT_EQ(sheet.elements.size(), 12u);
  expectAt(sheet.points[1], {-0.1, -0.05, 0});
  expectAt(sheet.points[4], {0, -0.15, 0});
  EXPECT_EQ(sheet.elements[0], (FlexElement{0, 4, 5, 0}));
  EXPECT_EQ(sheet.elements[1], (FlexElement{0, 5, 1, 0}));
  EXPECT_NEAR(area(sheet), 0.2 * 0.3, 1e-12);
  const FlexShape block = flexShape({FlexKind::Grid, 3, {3, 3, 2}, {0.1, 0.2, 0.3}});
  ASSERT_EQ(block.points.size(), 18u);
  ASSERT_EQ(block.elements.size(), 24u);
  expectAt(block.points[1], {-0.1, -0.2, 0.15});
  EXPECT_NEAR(sixVolumes(block), 6 * 0.2 * 0.4 * 0.3, 1e-12);
}

TEST(Flexcomp, ABoxIsAShellAboutAPoint) {
  const FlexPattern pattern{FlexKind::Box, 3, {3, 3, 4}, {0.1, 0.2, 0.1}};
  const FlexShape box = flexShape(pattern);
  ASSERT_EQ(box.points.size(), 35u);
  ASSERT_EQ(box.elements.size(), 64u);
  expectAt(box.points[0], {});
  expectAt(box.points[1], {-0.1, -0.2, -0.15});
  expectAt(box.points[10], {-0.1, -0.2, 0.15});
  expectAt(box.points[20], {-0.1, -0.2, 0.05});
  expectAt(box.points[27], {0, 0.2, -0.05});
  expectAt(box.points[34], {0.1, 0, 0.05});
  EXPECT_NEAR(sixVolumes(box), 6 * 0.2 * 0.4 * 0.3, 1e-12);
  for (const FlexElement& e : box.elements) EXPECT_EQ(e[0], 0u);
}

TEST(Flexcomp, CylindersAndEllipsoidsAreBoxesWhosePointsMoved) {
  const FlexShape cylinder = flexShape({FlexKind::Cylinder, 3, {3, 3, 4}, {0.1, 0.2, 0.1}});
  expectAt(cylinder.points[1], {-0.070711, -0.141421, -0.15});
  expectAt(cylinder.points[5], {0, 0, -0.15});
  const FlexShape ellipsoid = flexShape({FlexKind::Ellipsoid, 3, {3, 3, 4}, {0.1, 0.2, 0.1}});
  expectAt(ellipsoid.points[1], {-0.057735, -0.115470, -0.086603});
  expectAt(ellipsoid.points[19], {-0.068825, -0.137649, -0.034412});
  expectAt(ellipsoid.points[34], {0.094868, 0, 0.047434});
}

TEST(Flexcomp, InTwoDimensionsABoxHasNoLid) {
  const FlexShape box = flexShape({FlexKind::Ellipsoid, 2, {3, 3, 3}, {0.02, 0.02, 0.02}});
  ASSERT_EQ(box.points.size(), 25u);
  ASSERT_EQ(box.elements.size(), 40u);
  expectAt(box.points[9], {-0.014142, -0.014142, 0});
  expectAt(box.points[10], {-0.011547, -0.011547, 0.011547});
  expectAt(box.points[24], {0.014142, 0, 0.014142});
  int rim = 0;
  for (const auto& [edge, count] : edgesOf(box)) {
    EXPECT_LE(count, 2);
    rim += count == 1 ? 1 : 0;
  }
  EXPECT_EQ(rim, 8);
}

TEST(Flexcomp, ADiscAndACircle) {
  const FlexShape disc = flexShape({FlexKind::Disc, 2, {4, 6, 1}, {0.1, 0.3, 0.1}});
  ASSERT_EQ(disc.points.size(), 24u);
  ASSERT_EQ(disc.elements.size(), 30u);
  expectAt(disc.points[0], {-0.022063, -0.551577, 0});
  expectAt(disc.points[9], {-0.007115, 0.106727, 0});
  EXPECT_EQ(disc.elements[6], (FlexElement{3, 9, 4, 0}));
  const FlexShape circle = flexShape({FlexKind::Circle, 1, {8, 1, 1}, {0.1, 0.1, 0.1}});
  ASSERT_EQ(circle.points.size(), 7u);
  ASSERT_EQ(circle.elements.size(), 7u);
  expectAt(circle.points[1], {0.071850, 0.090097, 0});
  for (const FlexElement& e : circle.elements)
    EXPECT_NEAR(length(circle.points[e[0]] - circle.points[e[1]]), 0.1, 1e-12);
}

TEST(Flexcomp, CountsSayHowManyPointsThereWillBe) {
  for (const FlexKind kind : {FlexKind::Grid, FlexKind::Square, FlexKind::Disc, FlexKind::Circle})
    for (const int dim : {1, 2, 3}) {
      const FlexPattern pattern{kind, kind == FlexKind::Circle ? 1 : kind == FlexKind::Grid ? dim : 2, {4, 5, 6}};
      EXPECT_EQ(pointCount(pattern), static_cast<double>(flexShape(pattern).points.size()));
    }
  EXPECT_GE(pointCount({FlexKind::Box, 3, {2, 2, 2}}), 8);
}

TEST(Flexcomp, PointsOfNoElementGo) {
  FlexShape shape{1, {{9, 0, 0}, {1, 0, 0}, {8, 0, 0}, {2, 0, 0}}, {{3, 1, 0, 0}}};
  EXPECT_EQ(dropUnused(shape), (std::vector<uint32_t>{1, 3}));
  ASSERT_EQ(shape.points.size(), 2u);
  EXPECT_EQ(shape.elements[0], (FlexElement{1, 0, 0, 0}));
  const FlexShape solid = solidAbout({0, 0, -1}, {2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2, 0}}});
  EXPECT_EQ(solid.elements[0], (FlexElement{0, 1, 2, 3}));
  expectAt(solid.points[0], {0, 0, -1});
}

}  // namespace
}  // namespace avbd::mjcf
