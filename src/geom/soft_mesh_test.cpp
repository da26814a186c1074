// Tetrahedral meshes: what is refused, what is repaired, and what the surface is.
#include <avbd/error.h>
#include <avbd/soft_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "geom/soft_mesh_parts.h"

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

/// dx/dX of a map of the points, by the star of each.
template <class Map>
void eachStar(const SoftMeshData& mesh, Map&& map, const std::function<void(uint32_t, const Vec3d (&)[3])>& f) {
  const SoftMeshData::Parts& parts = mesh.parts();
  for (uint32_t center = 0; center < mesh.points().size(); ++center) {
    Vec3d column[3];
    for (uint32_t i = parts.starBegin[center]; i < parts.starBegin[center + 1]; ++i) {
      const StarPoint& star = parts.starPoints[i];
      const Vec3d arm = map(toDouble(mesh.points()[star.point])) - map(toDouble(mesh.points()[center]));
      const float g[3] = {star.gradient.x, star.gradient.y, star.gradient.z};
      for (size_t k = 0; k < 3; ++k) column[k] = column[k] + arm * double{g[k]};
    }
    f(center, column);
  }
}

TEST(TetMesh, StarsFindEveryLinearMapAndShareTheVolume) {
  const auto mesh = makeTetBox({0.5f, 0.3f, 0.2f}, 4, 3, 2);
  const Vec3d x{1.2, 0.1, -0.3}, y{0.4, 0.9, 0.2}, z{-0.1, 0.5, 1.1};
  eachStar(
      *mesh,
      [&](Vec3d p) {
        return x * p.x + y * p.y + z * p.z + Vec3d{3, 4, 5};
      },
      [&](uint32_t, const Vec3d(&column)[3]) {
        for (const Vec3d& off : {column[0] - x, column[1] - y, column[2] - z}) EXPECT_LT(dot(off, off), 1e-10);
      });
  double volume = 0;
  for (const float v : mesh->parts().starVolumes) volume += double{v};
  EXPECT_NEAR(volume, mesh->volume(), 1e-6);
}

TEST(TetMesh, AStarIsTheMeanOfItsTetrahedra) {
  const auto mesh = makeTetBox({0.5f, 0.3f, 0.2f}, 2, 2, 2);
  const SoftMeshData::Parts& parts = mesh->parts();
  // Bent: no star's mean is that of another.
  const auto bent = [](Vec3d p) { return Vec3d{p.x + 0.3 * p.x * p.y, p.y - 0.2 * p.x * p.x, p.z + 0.1 * p.z * p.y}; };
  eachStar(*mesh, bent, [&](uint32_t center, const Vec3d(&column)[3]) {
    Vec3d mean;
    double volume = 0;
    for (size_t t = 0; t < mesh->tets().size(); ++t) {
      const auto& corners = mesh->tets()[t];
      if (std::find(corners.begin(), corners.end(), center) == corners.end()) continue;
      const auto edge = [&](size_t k) {
        return bent(toDouble(mesh->points()[corners[k]])) - bent(toDouble(mesh->points()[corners[0]]));
      };
      const TetAtRest& rest = parts.tetsAtRest[t];
      const Vec3d f = edge(1) * double{rest.gb.x} + edge(2) * double{rest.gc.x} + edge(3) * double{rest.gd.x};
      mean = mean + f * double{rest.volume};
      volume += double{rest.volume};
    }
    const Vec3d off = mean * (1 / volume) - column[0];
    EXPECT_LT(dot(off, off), 1e-10);
    EXPECT_NEAR(double{parts.starVolumes[center]}, volume / 4, 1e-7);
  });
}

TEST(ClothMesh, HasNoStars) { EXPECT_TRUE(makeClothGrid(1, 1, 2, 2)->parts().starVolumes.empty()); }

}  // namespace
}  // namespace avbd
