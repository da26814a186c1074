// Making meshes: welding, what is dropped, neighbours, refusals.
#include <avbd/error.h>
#include <avbd/mesh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "geom/mesh_parts.h"
#include "geom/triangles.h"

namespace avbd {
namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

const std::vector<Vec3> kCorners = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
const Triangles kSquare = {{0, 1, 2}, {0, 2, 3}};

MeshReport reportOf(const std::vector<Vec3>& vertices, const Triangles& triangles, float weld = 0) {
  return makeMesh({.vertices = vertices, .triangles = triangles, .weldDistance = weld})->report();
}

TEST(Mesh, aSquareOfTwoTriangles) {
  const auto mesh = makeMesh({.vertices = kCorners, .triangles = kSquare});
  EXPECT_EQ(mesh->triangleCount(), 2u);
  EXPECT_EQ(mesh->report().boundaryEdges, 4u);
  EXPECT_EQ(mesh->report().nonManifoldEdges, 0u);
  EXPECT_EQ(mesh->lower(), (Vec3{0, 0, 0}));
  EXPECT_EQ(mesh->upper(), (Vec3{1, 0, 1}));
  for (uint32_t i = 0; i < 2; ++i) {
    const auto t = mesh->triangle(i);
    const auto& from = kSquare[mesh->sourceTriangle(i)];
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(t[k], kCorners[from[k]]);
    EXPECT_EQ(triangleNormal(t[0], t[1], t[2]), (Vec3{0, 1, 0}));
  }
}

TEST(Mesh, weldsEqualVerticesAndWithADistanceNearOnes) {
  std::vector<Vec3> soup = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {-0.0f, 0, 0}, {1, 0, 1}, {1, 0, 0}};
  const Triangles two = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(reportOf(soup, two).boundaryEdges, 4u);
  soup[3].x = 0.001f;
  soup[4].z = 0.9995f;
  EXPECT_EQ(reportOf(soup, two).boundaryEdges, 6u);
  EXPECT_EQ(reportOf(soup, two, 0.0005f).boundaryEdges, 6u);
  EXPECT_EQ(reportOf(soup, two, 0.002f).boundaryEdges, 4u);
}

TEST(Mesh, weldsWithDistancesFarBelowTheCoordinates) {
  // At the origin floats lie that close; elsewhere only equal vertices do.
  const std::vector<Vec3> soup = {{0, 0, 0},      {0, 0, 1e6f},    {1e6f, 0, 1e6f},
                                  {5e-21f, 0, 0}, {1e6f, 0, 1e6f}, {1e6f, 0, 0}};
  const Triangles two = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(reportOf(soup, two, 1e-20f).boundaryEdges, 4u);
  EXPECT_EQ(reportOf(soup, two, 1e-21f).boundaryEdges, 6u);
  EXPECT_EQ(reportOf(soup, two, 1e-45f).boundaryEdges, 6u);
  EXPECT_EQ(reportOf(kCorners, kSquare, 1e-20f).boundaryEdges, 4u);
}

TEST(Mesh, dropsAndCountsWhatHasNoAreaOrIsThereTwice) {
  std::vector<Vec3> vertices = kCorners;
  vertices.push_back({0.5f, 0, 0.5f});  // on the diagonal
  vertices.push_back({0.5f, 0, 0.5f});  // twice
  const Triangles triangles = {{0, 1, 2}, {0, 2, 3}, {0, 0, 1}, {0, 4, 2}, {4, 5, 1}, {1, 2, 0}, {2, 0, 1}};
  const MeshReport report = reportOf(vertices, triangles);
  EXPECT_EQ(report.triangles, 2u);
  EXPECT_EQ(report.degenerate, 3u);
  EXPECT_EQ(report.duplicate, 2u);
  // The same corners the other way round are another front, unless both sides push anyway.
  EXPECT_EQ(reportOf(kCorners, {{0, 1, 2}, {2, 1, 0}}).duplicate, 0u);
  const Triangles both = {{0, 1, 2}, {2, 1, 0}};
  EXPECT_EQ(makeMesh({.vertices = kCorners, .triangles = both, .doubleSided = true})->report().duplicate, 1u);
}

TEST(Mesh, countsEdgesThatAreNoSurface) {
  std::vector<Vec3> vertices = kCorners;
  vertices.push_back({0.5f, 1, 0.5f});
  EXPECT_EQ(reportOf(vertices, {{0, 1, 2}, {0, 2, 3}, {0, 2, 4}}).nonManifoldEdges, 1u);
  EXPECT_EQ(reportOf(vertices, {{0, 1, 2}, {0, 3, 2}}).nonManifoldEdges, 1u);  // they disagree about the front
}

TEST(Mesh, knowsWhatLiesAcrossItsEdges) {
  const std::vector<Vec3> roof = {{0, 1, 0}, {0, 1, 1}, {1, 0, 0.5f}, {-1, 0, 0.5f}};
  const Triangles two = {{0, 1, 2}, {1, 0, 3}};
  for (const Vec3 scale : {Vec3{1, 1, 1}, Vec3{-1, 1, 1}, Vec3{2, 3, -1}, Vec3{1, -1, 1}}) {
    const auto mesh = makeMesh({.vertices = roof, .triangles = two});
    const Geometry geometry = Mesh{mesh, scale};
    const ShapeGeom geom = toShapeGeom(geometry);
    int seen = 0;
    Vec3 normals[2], across[2];
    forEachTriangle(geom, surfaceBounds(geom), [&](const SurfaceTriangle& t) {
      EXPECT_GT(t.normal.y * scale.y, 0);  // the front stays in front, also upside down
      EXPECT_LT(length(cross(t.v[1] - t.v[0], t.v[2] - t.v[0]) * (1 / length(cross(t.v[1] - t.v[0], t.v[2] - t.v[0]))) -
                       t.normal),
                1e-6f);
      int inner = 0;
      for (int i = 0; i < 3; ++i) {
        if (t.isRim[i]) continue;
        ++inner;
        EXPECT_EQ(t.v[i].x, 0);
        EXPECT_EQ(t.v[(i + 1) % 3].x, 0);
        EXPECT_TRUE(t.isConvex[i]);
        normals[seen] = t.normal;
        across[seen] = t.across[i];
      }
      EXPECT_EQ(inner, 1);
      ++seen;
      return true;
    });
    ASSERT_EQ(seen, 2);
    EXPECT_EQ(normals[0], across[1]);
    EXPECT_EQ(normals[1], across[0]);
  }
}

TEST(Mesh, aValleyIsNotConvexAndAFlatFoldIsNot) {
  for (const float height : {-1.0f, 0.0f}) {
    const std::vector<Vec3> fold = {{0, height, 0}, {0, height, 1}, {1, 0, 0.5f}, {-1, 0, 0.5f}};
    const Triangles two = {{0, 1, 2}, {1, 0, 3}};
    const Geometry geometry = Mesh{makeMesh({.vertices = fold, .triangles = two})};
    const ShapeGeom geom = toShapeGeom(geometry);
    forEachTriangle(geom, surfaceBounds(geom), [&](const SurfaceTriangle& t) {
      for (int i = 0; i < 3; ++i) EXPECT_FALSE(t.isConvex[i]);
      return true;
    });
  }
}

TEST(Mesh, equalMeshesHaveEqualHashes) {
  const auto hash = [](const std::vector<Vec3>& v, const Triangles& t, std::vector<uint16_t> m = {}) {
    return makeMesh({.vertices = v, .triangles = t, .materials = m})->contentHash();
  };
  EXPECT_EQ(hash(kCorners, kSquare), hash(kCorners, kSquare));
  std::vector<Vec3> moved = kCorners;
  moved[2].y = 1e-6f;
  EXPECT_NE(hash(kCorners, kSquare), hash(moved, kSquare));
  EXPECT_NE(hash(kCorners, kSquare), hash(kCorners, kSquare, {0, 1}));
  EXPECT_NE(hash(kCorners, kSquare), hash(kCorners, {{2, 1, 0}, {0, 2, 3}}));
}

/// Many triangles in one place make the tree no deeper than its walk can come back from.
TEST(Mesh, buildsOfTrianglesThatLieOnOneAnother) {
  std::vector<Vec3> vertices;
  Triangles triangles;
  for (uint32_t i = 0; i < 3000; ++i) {
    const float s = std::ldexp(1.0f, -static_cast<int>(i % 100));
    for (const Vec3 v : {Vec3{0, 0, 0}, Vec3{0, 0, s}, Vec3{s, 0, 0}})
      vertices.push_back(v + Vec3{0, static_cast<float>(i / 100), 0});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const auto mesh = makeMesh({.vertices = vertices, .triangles = triangles});
  int seen = 0;
  const Geometry geometry = Mesh{mesh};
  forEachTriangle(toShapeGeom(geometry), {{-1, -1, -1}, {2, 100, 2}}, [&](const SurfaceTriangle&) {
    ++seen;
    return true;
  });
  EXPECT_EQ(static_cast<uint32_t>(seen), mesh->triangleCount());
}

struct Refusal {
  std::string field, value, range;
};
Refusal refusal(const MeshDef& def) {
  try {
    makeMesh(def);
  } catch (const Error& e) {
    EXPECT_EQ(e.definition(), "MeshDef");
    return {e.field(), e.value(), e.range()};
  }
  return {"none", "", ""};
}

TEST(Mesh, refusesBadInput) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(refusal({}).field, "triangles");
  EXPECT_EQ(refusal({.vertices = kCorners}).field, "triangles");
  EXPECT_EQ(refusal({.triangles = kSquare}).field, "vertices");
  for (const float bad : {kNan, kInf, -kInf, 2e6f}) {
    std::vector<Vec3> vertices = kCorners;
    vertices[3].z = bad;
    EXPECT_EQ(refusal({.vertices = vertices, .triangles = kSquare}).field, "vertices[3]");
    EXPECT_EQ(refusal({.vertices = kCorners, .triangles = kSquare, .weldDistance = bad}).field, "weldDistance");
  }
  EXPECT_EQ(refusal({.vertices = kCorners, .triangles = kSquare, .weldDistance = -1}).field, "weldDistance");
  const Triangles beyond = {{0, 1, 2}, {0, 2, 4}};
  const Refusal index = refusal({.vertices = kCorners, .triangles = beyond});
  EXPECT_EQ(index.field, "triangles[1]");
  EXPECT_EQ(index.value, "4");
  const std::vector<uint16_t> one = {0};
  EXPECT_EQ(refusal({.vertices = kCorners, .triangles = kSquare, .materials = one}).field, "materials");
  const Triangles lines = {{0, 0, 1}, {2, 2, 2}};
  EXPECT_EQ(refusal({.vertices = kCorners, .triangles = lines}).field, "triangles");
}

}  // namespace
}  // namespace avbd
