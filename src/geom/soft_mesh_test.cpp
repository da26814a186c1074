// Tetrahedral meshes: what is refused, what is repaired, and what the surface is.
#include <avbd/error.h>
#include <avbd/soft_mesh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

namespace avbd {
namespace {

using Tet = std::array<uint32_t, 4>;

const std::vector<Vec3> kPoints = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};

std::string complaint(const std::vector<Vec3>& points, const std::vector<Tet>& tets) {
  try {
    makeTetMesh({points, tets});
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

void expectRefused(const std::vector<Vec3>& points, const std::vector<Tet>& tets, const char* part) {
  const std::string said = complaint(points, tets);
  EXPECT_NE(said.find(part), std::string::npos) << said;
}

TEST(TetMesh, WhatIsNoneIsRefusedByName) {
  expectRefused(kPoints, {}, "tets = none");
  expectRefused(kPoints, {{0, 1, 2, 5}}, "tets[0] = 5: must be < 5");
  std::vector<Vec3> bad = kPoints;
  bad[2].y = std::numeric_limits<float>::quiet_NaN();
  expectRefused(bad, {{0, 1, 2, 3}}, "points[2]");
  bad[2].y = 2e6f;
  expectRefused(bad, {{0, 1, 2, 3}}, "points[2]");
  expectRefused(kPoints, {{0, 1, 2, 2}, {0, 0, 1, 3}}, "at least one that has volume");
  std::vector<Vec3> fan = kPoints;
  fan.push_back({0.2f, 0.2f, -1});
  fan.push_back({0.3f, 0.3f, 2});
  expectRefused(fan, {{0, 1, 2, 3}, {0, 1, 2, 5}, {0, 1, 2, 6}}, "share the face 0 1 2");
}

TEST(TetMesh, RepairsByItsRules) {
  // In this order: sound, turned, the first once more, without volume; and point 5 in none.
  std::vector<Vec3> points = kPoints;
  points.push_back({9, 9, 9});
  const auto mesh = makeTetMesh({points, std::vector<Tet>{{0, 1, 2, 3}, {4, 1, 2, 3}, {3, 2, 1, 0}, {0, 1, 2, 1}}});
  const SoftMeshReport& report = mesh->report();
  EXPECT_EQ(report.elements, 2u);
  EXPECT_EQ(report.inverted, 1u);
  EXPECT_EQ(report.duplicate, 1u);
  EXPECT_EQ(report.degenerate, 1u);
  EXPECT_EQ(report.unused, 1u);
  ASSERT_EQ(mesh->points().size(), 5u);
  for (uint32_t i = 0; i < 5; ++i) EXPECT_EQ(mesh->sourcePoint(i), i);
  EXPECT_NEAR(mesh->volume(), 1.0 / 6 + 1.0 / 3, 1e-6);
}

TEST(TetMesh, PointsKeepTheirOrderWhereSomeAreDropped) {
  std::vector<Vec3> points = {{7, 7, 7}};
  points.insert(points.end(), kPoints.begin(), kPoints.begin() + 4);
  const auto mesh = makeTetMesh({points, std::vector<Tet>{{1, 2, 3, 4}}});
  ASSERT_EQ(mesh->points().size(), 4u);
  for (uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(mesh->sourcePoint(i), i + 1);
    EXPECT_EQ(mesh->points()[i], kPoints[i]);
  }
}

TEST(TetMesh, TheSurfaceOfABoxIsClosedAndLooksOutside) {
  const auto mesh = makeTetBox({0.5f, 1, 1.5f}, 3, 2, 4);
  EXPECT_EQ(mesh->points().size(), size_t{4 * 3 * 5});
  EXPECT_EQ(mesh->tets().size(), size_t{3 * 2 * 4 * 5});
  EXPECT_NEAR(mesh->volume(), 6, 1e-5);
  EXPECT_EQ(mesh->surface().size(), size_t{2 * 2 * (3 * 2 + 3 * 4 + 2 * 4)});
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  double six = 0;
  for (const auto& face : mesh->surface()) {
    const Vec3 a = mesh->points()[face[0]], b = mesh->points()[face[1]], c = mesh->points()[face[2]];
    six += double{dot(a, cross(b, c))};
    for (size_t i = 0; i < 3; ++i) ++edges[{face[i], face[(i + 1) % 3]}];
  }
  EXPECT_NEAR(six / 6, 6, 1e-5);
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
}

TEST(TetMesh, BoxesOfNoSizeAreRefused) {
  EXPECT_THROW(makeTetBox({0, 1, 1}, 1, 1, 1), Error);
  EXPECT_THROW(makeTetBox({1, std::numeric_limits<float>::infinity(), 1}, 1, 1, 1), Error);
  EXPECT_THROW(makeTetBox({1, 1, 1}, 0, 1, 1), Error);
  EXPECT_THROW(makeTetBox({1, 1, 1}, 1, 1, 1001), Error);
}

TEST(TetMesh, HashesAreOfTheContent) {
  const auto a = makeTetBox({1, 1, 1}, 2, 2, 2), b = makeTetBox({1, 1, 1}, 2, 2, 2), c = makeTetBox({1, 1, 2}, 2, 2, 2);
  EXPECT_EQ(a->contentHash(), b->contentHash());
  EXPECT_NE(a->contentHash(), c->contentHash());
}

std::string clothComplaint(const std::vector<Vec3>& points, const std::vector<std::array<uint32_t, 3>>& triangles) {
  try {
    makeClothMesh({points, triangles});
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ClothMesh, WhatIsNoneIsRefusedByName) {
  EXPECT_NE(clothComplaint(kPoints, {}).find("ClothMeshDef.triangles = none"), std::string::npos);
  EXPECT_NE(clothComplaint(kPoints, {{0, 1, 9}}).find("triangles[0] = 9"), std::string::npos);
  EXPECT_NE(clothComplaint(kPoints, {{0, 1, 1}}).find("at least one that has area"), std::string::npos);
  EXPECT_NE(clothComplaint(kPoints, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}).find("share the edge 0 1"), std::string::npos);
  EXPECT_THROW(makeClothGrid(0, 1, 1, 1), Error);
  EXPECT_THROW(makeClothGrid(1, 1, 0, 1), Error);
  EXPECT_THROW(makeClothGrid(1, std::numeric_limits<float>::quiet_NaN(), 1, 1), Error);
}

TEST(ClothMesh, AGridHasTheHingesOfItsInnerEdges) {
  const auto mesh = makeClothGrid(1, 0.5f, 4, 3);
  EXPECT_TRUE(mesh->isCloth());
  EXPECT_EQ(mesh->points().size(), size_t{5 * 4});
  EXPECT_EQ(mesh->triangles().size(), size_t{2 * 4 * 3});
  EXPECT_EQ(mesh->hinges().size(), size_t{4 * 3 + 3 * 3 + 4 * 2});
  EXPECT_NEAR(mesh->area(), 2, 1e-5);
  EXPECT_EQ(mesh->volume(), 0);
  for (const auto& triangle : mesh->triangles()) {
    const Vec3 a = mesh->points()[triangle[0]], b = mesh->points()[triangle[1]], c = mesh->points()[triangle[2]];
    EXPECT_GT(cross(b - a, c - a).y, 0);
  }
}

TEST(ClothMesh, RepairsByItsRules) {
  const auto mesh =
      makeClothMesh({kPoints, std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {2, 0, 1}, {0, 3, 3}, {2, 1, 4}}});
  EXPECT_EQ(mesh->report().elements, 2u);
  EXPECT_EQ(mesh->report().duplicate, 1u);
  EXPECT_EQ(mesh->report().degenerate, 1u);
  EXPECT_EQ(mesh->report().unused, 1u);
  EXPECT_EQ(mesh->sourcePoint(3), 4u);
}

}  // namespace
}  // namespace avbd
