// Box queries and rays over meshes and height fields against looking at every triangle.
#include "geom/triangles.h"

#include <avbd/height_field.h>
#include <avbd/mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace avbd {
namespace {

std::mt19937 gRandom(7);
float unit() { return std::uniform_real_distribution<float>(-1, 1)(gRandom); }
Vec3 anywhere(float size) { return Vec3{unit(), unit(), unit()} * size; }

/// Triangles of all sizes and forms, anywhere.
Geometry soup(uint32_t count) {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 middle = anywhere(10);
    const float size = i % 100 == 0 ? 3.0f : 0.05f;
    for (int k = 0; k < 3; ++k) vertices.push_back(middle + anywhere(size));
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return Mesh{makeMesh({.vertices = vertices, .triangles = triangles})};
}

Geometry rough(int columns, int rows) {
  std::vector<float> heights;
  for (int i = 0; i < columns * rows; ++i) heights.push_back(unit());
  std::vector<uint16_t> materials;
  for (int i = 0; i < (columns - 1) * (rows - 1); ++i)
    materials.push_back(i % 11 == 5 ? HeightFieldDef::kHole : uint16_t{0});
  return HeightField{makeHeightField({.columns = columns,
                                      .rows = rows,
                                      .spacingX = 0.25f,
                                      .spacingZ = 0.4f,
                                      .heights = heights,
                                      .materials = materials})};
}

Geometry scaled(Geometry geometry, Vec3 scale) {
  if (auto* mesh = std::get_if<Mesh>(&geometry)) mesh->scale = scale;
  if (auto* field = std::get_if<HeightField>(&geometry)) field->scale = scale;
  return geometry;
}

struct Flat {
  Vec3 v[3];
  uint32_t element;
};

std::vector<Flat> allOf(const Geometry& geometry) {
  std::vector<Flat> all;
  const auto add = [&](uint32_t element, const std::array<Vec3, 3>& t, Vec3 s) {
    Flat f{{}, element};
    for (size_t k = 0; k < 3; ++k) f.v[k] = {t[k].x * s.x, t[k].y * s.y, t[k].z * s.z};
    all.push_back(f);
  };
  if (const auto* mesh = std::get_if<Mesh>(&geometry)) {
    for (uint32_t i = 0; i < mesh->data->triangleCount(); ++i) add(i, mesh->data->triangle(i), mesh->scale);
  }
  if (const auto* field = std::get_if<HeightField>(&geometry)) {
    const int cells = field->data->columns() - 1;
    for (uint32_t i = 0; i < field->data->triangleCount(); ++i) {
      const int cell = static_cast<int>(i / 2);
      if (field->data->cellMaterial(cell % cells, cell / cells) == HeightFieldDef::kHole) continue;
      add(i, field->data->triangle(i), field->scale);
    }
  }
  return all;
}

bool boundsMeet(const Flat& t, const Aabb& box) {
  const auto outside = [&](auto part) {
    const float a = part(t.v[0]), b = part(t.v[1]), c = part(t.v[2]);
    return std::min({a, b, c}) > part(box.upper) || std::max({a, b, c}) < part(box.lower);
  };
  return !outside([](Vec3 v) { return v.x; }) && !outside([](Vec3 v) { return v.y; }) &&
         !outside([](Vec3 v) { return v.z; });
}

void expectBoxesFindAll(const Geometry& geometry, int queries) {
  const ShapeGeom geom = toShapeGeom(geometry);
  const std::vector<Flat> all = allOf(geometry);
  const Aabb whole = surfaceBounds(geom);
  const Vec3 middle = (whole.lower + whole.upper) * 0.5f, half = (whole.upper - whole.lower) * 0.6f;
  size_t found = 0;
  for (int i = 0; i < queries; ++i) {
    const Vec3 c = middle + Vec3{half.x * unit(), half.y * unit(), half.z * unit()};
    const float share = i % 10 == 0 ? 0.5f : 0.05f;
    const Vec3 e{half.x * share * std::fabs(unit()), half.y * share * std::fabs(unit()),
                 half.z * share * std::fabs(unit())};
    const Aabb box{c - e, c + e};
    std::vector<uint32_t> expected, got;
    for (const Flat& t : all) {
      if (boundsMeet(t, box)) expected.push_back(t.element);
    }
    forEachTriangle(geom, box, [&](const SurfaceTriangle& t) {
      got.push_back(t.element);
      return true;
    });
    std::sort(got.begin(), got.end());
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(got, expected);
    found += got.size();
  }
  EXPECT_GT(found, static_cast<size_t>(queries));
}

/// Moeller and Trumbore, Fast, minimum storage ray-triangle intersection (1997), in double.
double rayFraction(const Vec3* v, Vec3 from, Vec3 motion) {
  const Vec3d a = toDouble(v[0]), e1 = toDouble(v[1]) - a, e2 = toDouble(v[2]) - a, d = toDouble(motion),
              s = toDouble(from) - a;
  const auto crossOf = [](Vec3d p, Vec3d q) {
    return Vec3d{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
  };
  const Vec3d p = crossOf(d, e2), q = crossOf(s, e1);
  const double det = dot(e1, p), u = dot(s, p) / det, w = dot(d, q) / det, t = dot(e2, q) / det;
  return det != 0 && u >= 0 && w >= 0 && u + w <= 1 && t >= 0 && t <= 1 ? t : 2;
}

void expectRaysHitTheSame(const Geometry& geometry, int queries) {
  const ShapeGeom geom = toShapeGeom(geometry);
  const std::vector<Flat> all = allOf(geometry);
  const Aabb whole = surfaceBounds(geom);
  const Vec3 middle = (whole.lower + whole.upper) * 0.5f, half = (whole.upper - whole.lower) * 0.6f;
  int hits = 0;
  for (int i = 0; i < queries; ++i) {
    const auto at = [&] { return middle + Vec3{half.x * unit(), half.y * unit(), half.z * unit()}; };
    const Vec3 from = at();
    Vec3 motion = at() - from;
    // Along axes and planes too.
    if (i % 4 == 1) motion = {0, motion.y, 0};
    if (i % 4 == 2) motion.z = 0;
    if (i % 8 == 7) motion.x = motion.y = 0;
    double expected = 2;
    for (const Flat& t : all) expected = std::min(expected, rayFraction(t.v, from, motion));
    double got = 2;
    forEachTriangleAlong(geom, from, motion, {}, [&](const SurfaceTriangle& t, float fraction) {
      got = std::min(got, rayFraction(t.v, from, motion));
      return got < fraction ? static_cast<float>(got) : fraction;
    });
    ASSERT_NEAR(got, expected, 1e-9) << i;
    hits += got <= 1 ? 1 : 0;
  }
  EXPECT_GT(hits, queries / 200);  // most rays miss a small surface in the middle
}

/// Every triangle that a box at some moment of its way overlaps must be given.
void expectSweptBoxesFindAll(const Geometry& geometry, int queries) {
  const ShapeGeom geom = toShapeGeom(geometry);
  const std::vector<Flat> all = allOf(geometry);
  const Aabb whole = surfaceBounds(geom);
  const Vec3 middle = (whole.lower + whole.upper) * 0.5f, half = (whole.upper - whole.lower) * 0.6f;
  size_t found = 0, visited = 0;
  for (int i = 0; i < queries; ++i) {
    const auto at = [&] { return middle + Vec3{half.x * unit(), half.y * unit(), half.z * unit()}; };
    const Vec3 from = at(), motion = at() - from, e = Vec3{0.3f, 0.2f, 0.1f} * std::fabs(unit());
    std::set<uint32_t> got;
    forEachTriangleAlong(geom, from, motion, e, [&](const SurfaceTriangle& t, float fraction) {
      EXPECT_TRUE(got.insert(t.element).second);
      return fraction;
    });
    visited += got.size();
    for (int k = 0; k <= 10; ++k) {
      const Vec3 c = from + motion * (0.1f * static_cast<float>(k));
      for (const Flat& t : all) {
        if (!boundsMeet(t, {c - e, c + e})) continue;
        ASSERT_TRUE(got.count(t.element)) << i << ' ' << k;
        ++found;
      }
    }
  }
  EXPECT_GT(found, 0u);
  EXPECT_LT(visited, static_cast<size_t>(queries) * all.size() / 4);
}

TEST(Triangles, boxQueriesFindWhatTheyOverlap) {
  expectBoxesFindAll(soup(2000), 300);
  expectBoxesFindAll(scaled(soup(500), {-2, 0.01f, 100}), 200);
  expectBoxesFindAll(rough(40, 25), 300);
  expectBoxesFindAll(scaled(rough(19, 50), {3, 0.1f, 0.7f}), 200);
  expectBoxesFindAll(rough(2, 2), 200);
}

TEST(Triangles, boxQueriesInAMeshOfAHundredThousand) { expectBoxesFindAll(soup(100000), 30); }

TEST(Triangles, raysHitTheNearestTriangle) {
  expectRaysHitTheSame(soup(3000), 400);
  expectRaysHitTheSame(scaled(soup(500), {-2, 0.01f, 100}), 400);
  expectRaysHitTheSame(rough(40, 25), 600);
  expectRaysHitTheSame(scaled(rough(19, 50), {3, 0.1f, 0.7f}), 400);
  expectRaysHitTheSame(rough(2, 3), 400);
}

TEST(Triangles, raysInAMeshOfAHundredThousand) { expectRaysHitTheSame(soup(100000), 60); }

TEST(Triangles, sweptBoxesMissNothing) {
  expectSweptBoxesFindAll(soup(1000), 60);
  expectSweptBoxesFindAll(rough(40, 25), 60);
  expectSweptBoxesFindAll(scaled(rough(40, 25), {1, 4, 0.5f}), 60);
}

TEST(Triangles, raysMeetNearTrianglesFirstAndStopWhenTold) {
  const Geometry geometry = soup(5000);
  const ShapeGeom geom = toShapeGeom(geometry);
  int all = 0, cut = 0, stopped = 0;
  const Vec3 from{-12, 0.1f, 0.2f}, motion{24, 0, 0}, e{0.5f, 0.5f, 0.5f};
  forEachTriangleAlong(geom, from, motion, e, [&](const SurfaceTriangle&, float f) { return ++all, f; });
  forEachTriangleAlong(geom, from, motion, e, [&](const SurfaceTriangle&, float) { return ++cut, 0.25f; });
  forEachTriangleAlong(geom, from, motion, e, [&](const SurfaceTriangle&, float) { return ++stopped, -1.0f; });
  EXPECT_GT(all, 30);
  EXPECT_LT(cut, all / 2);
  EXPECT_EQ(stopped, 1);
  int first = 0;
  forEachTriangle(geom, surfaceBounds(geom), [&](const SurfaceTriangle&) { return ++first, false; });
  EXPECT_EQ(first, 1);
}

}  // namespace
}  // namespace avbd
