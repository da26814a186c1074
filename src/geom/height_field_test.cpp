// Height fields: corners, holes, neighbours, memory, refusals.
#include <avbd/error.h>
#include <avbd/height_field.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "geom/triangles.h"

namespace avbd {
namespace {

std::vector<float> ramp(int columns, int rows) {
  std::vector<float> heights;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) heights.push_back(static_cast<float>(c) + 10 * static_cast<float>(r));
  }
  return heights;
}

TEST(HeightField, samplesLieWhereTheDefinitionSays) {
  const auto field = makeHeightField({.columns = 3, .rows = 2, .spacingX = 2, .spacingZ = 4, .heights = ramp(3, 2)});
  EXPECT_EQ(field->triangleCount(), 4u);
  EXPECT_EQ(field->thickness(), 4);
  EXPECT_EQ(field->lower(), (Vec3{-2, 0, -2}));
  EXPECT_EQ(field->upper(), (Vec3{2, 12, 2}));
  const auto first = field->triangle(2), second = field->triangle(3);
  EXPECT_EQ(first[0], (Vec3{0, 1, -2}));
  EXPECT_EQ(first[1], (Vec3{0, 11, 2}));
  EXPECT_EQ(first[2], (Vec3{2, 12, 2}));
  EXPECT_EQ(second[0], first[0]);
  EXPECT_EQ(second[1], first[2]);
  EXPECT_EQ(second[2], (Vec3{2, 2, -2}));
}

TEST(HeightField, everyTriangleIsVisitedOnceAndLooksUp) {
  const int columns = 37, rows = 23;
  std::vector<uint16_t> materials;
  for (int i = 0; i < (columns - 1) * (rows - 1); ++i)
    materials.push_back(i % 7 == 3 ? HeightFieldDef::kHole : static_cast<uint16_t>(i % 5));
  const auto field =
      makeHeightField({.columns = columns, .rows = rows, .heights = ramp(columns, rows), .materials = materials});
  const Geometry geometry = HeightField{field, {1, 0.5f, 2}};
  const ShapeGeom geom = toShapeGeom(geometry);
  std::vector<int> seen(field->triangleCount(), 0);
  forEachTriangle(geom, surfaceBounds(geom), [&](const SurfaceTriangle& t) {
    ++seen[t.element];
    const auto v = field->triangle(t.element);
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(t.v[k], (Vec3{v[k].x, v[k].y * 0.5f, v[k].z * 2}));
    EXPECT_GT(t.normal.y, 0);
    EXPECT_EQ(t.material, materials[t.element / 2]);
    return true;
  });
  for (size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], materials[i / 2] == HeightFieldDef::kHole ? 0 : 1);
}

/// Across each edge lies the triangle that has the same two corners.
TEST(HeightField, neighboursShareTheirEdge) {
  std::vector<float> heights;
  for (int i = 0; i < 48; ++i) heights.push_back(static_cast<float>((i * 7919) % 13) * 0.1f);
  std::vector<uint16_t> materials(35, 0);
  materials[17] = HeightFieldDef::kHole;
  const auto field = makeHeightField({.columns = 8, .rows = 6, .heights = heights, .materials = materials});
  const Geometry geometry = HeightField{field};
  const ShapeGeom geom = toShapeGeom(geometry);
  std::vector<SurfaceTriangle> all;
  forEachTriangle(geom, surfaceBounds(geom), [&](const SurfaceTriangle& t) {
    all.push_back(t);
    return true;
  });
  ASSERT_EQ(all.size(), 68u);
  int ridges = 0;
  for (const SurfaceTriangle& t : all) {
    for (int i = 0; i < 3; ++i) {
      const SurfaceTriangle* other = nullptr;
      int edge = 0;
      for (const SurfaceTriangle& o : all) {
        for (int k = 0; k < 3; ++k) {
          if (o.v[k] == t.v[(i + 1) % 3] && o.v[(k + 1) % 3] == t.v[i]) {
            other = &o;
            edge = k;
          }
        }
      }
      ASSERT_EQ(t.isRim[i], other == nullptr);
      if (!other) continue;
      EXPECT_EQ(t.across[i], other->normal);
      EXPECT_EQ(t.isConvex[i], other->isConvex[edge]);
      // A ridge: the other's third corner lies behind this plane.
      const float beyond = dot(t.normal, other->v[(edge + 2) % 3] - t.v[i]);
      if (std::fabs(beyond) > 1e-3f) {
        EXPECT_EQ(t.isConvex[i], beyond < 0);
      }
      ridges += t.isConvex[i] ? 1 : 0;
    }
  }
  EXPECT_GT(ridges, 20);
}

TEST(HeightField, boundsReachDownToTheThickness) {
  const auto field = makeHeightField({.columns = 3, .rows = 3, .heights = ramp(3, 3), .thickness = 5});
  const Geometry geometry = HeightField{field, {1, 2, 1}};
  const Aabb box = surfaceBounds(toShapeGeom(geometry));
  EXPECT_EQ(box.lower.y, -10);
  EXPECT_EQ(box.upper.y, 44);
}

TEST(HeightField, memoryIsTheSamplesAndLittleMore) {
  const std::vector<float> heights(513 * 513, 0.0f);
  const auto field = makeHeightField({.columns = 513, .rows = 513, .heights = heights});
  EXPECT_LT(static_cast<double>(field->bytes()), 4.75 * 513 * 513);
}

TEST(HeightField, hashesOfEqualFieldsAreEqual) {
  auto heights = ramp(4, 4);
  const auto hash = [&](float spacing) {
    return makeHeightField({.columns = 4, .rows = 4, .spacingX = spacing, .heights = heights})->contentHash();
  };
  const uint64_t first = hash(1);
  EXPECT_EQ(first, hash(1));
  EXPECT_NE(first, hash(2));
  heights[5] += 1;
  EXPECT_NE(first, hash(1));
}

std::string refusedField(const HeightFieldDef& def) {
  try {
    makeHeightField(def);
  } catch (const Error& e) {
    EXPECT_EQ(e.definition(), "HeightFieldDef");
    EXPECT_FALSE(e.value().empty());
    EXPECT_FALSE(e.range().empty());
    return e.field();
  }
  return "none";
}

TEST(HeightField, refusesBadInput) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  const std::vector<float> heights(6, 0.0f);
  EXPECT_EQ(refusedField({.columns = 3, .rows = 2, .heights = heights}), "none");
  EXPECT_EQ(refusedField({.columns = 6, .rows = 1, .heights = heights}), "rows");
  EXPECT_EQ(refusedField({.columns = -3, .rows = -2, .heights = heights}), "columns");
  EXPECT_EQ(refusedField({.columns = 32769, .rows = 2, .heights = heights}), "columns");
  EXPECT_EQ(refusedField({.columns = 2, .rows = 2, .heights = heights}), "heights");
  for (const float bad : {kNan, kInf, -kInf, 0.0f, -1.0f}) {
    EXPECT_EQ(refusedField({.columns = 3, .rows = 2, .spacingX = bad, .heights = heights}), "spacingX");
    EXPECT_EQ(refusedField({.columns = 3, .rows = 2, .spacingZ = bad, .heights = heights}), "spacingZ");
    if (bad != 0) {
      EXPECT_EQ(refusedField({.columns = 3, .rows = 2, .heights = heights, .thickness = bad}), "thickness");
    }
  }
  for (const float bad : {kNan, kInf, 2e6f}) {
    std::vector<float> wrong = heights;
    wrong[4] = bad;
    EXPECT_EQ(refusedField({.columns = 3, .rows = 2, .heights = wrong}), "heights[4]");
  }
  const std::vector<uint16_t> materials(3, 0);
  EXPECT_EQ(refusedField({.columns = 3, .rows = 2, .heights = heights, .materials = materials}), "materials");
}

}  // namespace
}  // namespace avbd
