// Hulls, meshes and height fields in a recording: once each, and the same shape again when read.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "io/record/chunk.h"
#include "io/record/reader.h"
#include "io/record/sample.h"
#include "io/record/writer.h"

namespace avbd::record {
namespace {

std::shared_ptr<const HullData> hullOf(size_t points) {
  Chance chance;
  std::vector<Vec3> cloud;
  while (cloud.size() < points) cloud.push_back(chance.vector());
  return makeHull({cloud});
}

/// A strip of triangles; the second material on every third one.
std::shared_ptr<const MeshData> stripOf(uint32_t triangles) {
  Chance chance;
  std::vector<Vec3> points;
  std::vector<std::array<uint32_t, 3>> corners;
  std::vector<uint16_t> materials;
  for (uint32_t i = 0; i < triangles + 2; ++i)
    points.push_back({0.5f * static_cast<float>(i), 0.1f * chance.real(), i % 2 == 0 ? 0.0f : 1.0f});
  for (uint32_t i = 0; i < triangles; ++i) {
    corners.push_back({i, i % 2 == 0 ? i + 1 : i + 2, i % 2 == 0 ? i + 2 : i + 1});
    materials.push_back(i % 3 == 0 ? 1 : 0);
  }
  return makeMesh({.vertices = points, .triangles = corners, .materials = materials, .doubleSided = true});
}

TEST(RecordSurfaces, ComeBackAndAreStoredOnce) {
  const Folder folder;
  const auto hull = hullOf(30), same = hullOf(30);
  const auto mesh = stripOf(50);
  const std::vector<float> heights{0, 1, 2, 3, 4, 5.5f};
  const std::vector<uint16_t> cells{1, HeightFieldDef::kHole};
  const auto field = makeHeightField({.columns = 3,
                                      .rows = 2,
                                      .spacingX = 0.5f,
                                      .spacingZ = 2,
                                      .heights = heights,
                                      .materials = cells,
                                      .thickness = 3});
  Recording r;
  r.bodies = {{"all", BodyType::Static}};
  for (const Geometry& geometry : {Geometry(Hull{hull}), Geometry(Hull{same, {1, -2, 3}, 0.1f}), Geometry(Mesh{mesh}),
                                   Geometry(Mesh{mesh, {2, 2, -2}}), Geometry(HeightField{field, {1, 2, 3}})})
    r.shapes.push_back({0, geometry, {}});
  const auto path = folder.file("a.avbd");
  RecordWriter(path, r).finish();

  const RecordReader reader(path);
  const auto& types = reader.index().types;
  EXPECT_EQ(std::count(types.begin(), types.end(), kSurfaces), 3);
  const auto& shapes = reader.head().shapes;
  ASSERT_EQ(shapes.size(), 5u);
  const Hull &plain = std::get<Hull>(shapes[0].geometry), &scaled = std::get<Hull>(shapes[1].geometry);
  EXPECT_EQ(plain.data, scaled.data) << "shared";
  EXPECT_EQ(scaled.scale, (Vec3{1, -2, 3}));
  EXPECT_EQ(scaled.rounding, 0.1f);
  ASSERT_EQ(plain.data->vertices().size(), hull->vertices().size());
  EXPECT_EQ(plain.data->faces().size(), hull->faces().size());
  for (const Vec3 v : hull->vertices()) {
    const auto all = plain.data->vertices();
    EXPECT_NE(std::find(all.begin(), all.end(), v), all.end());
  }
  const MeshData& back = *std::get<Mesh>(shapes[2].geometry).data;
  ASSERT_EQ(back.triangleCount(), mesh->triangleCount());
  EXPECT_TRUE(back.doubleSided());
  // In order of the source: stored that way, so the source's number names the same triangle.
  const auto bySource = [](const MeshData& m) {
    std::map<uint32_t, uint32_t> elements;
    for (uint32_t i = 0; i < m.triangleCount(); ++i) elements[m.sourceTriangle(i)] = i;
    return elements;
  };
  const auto a = bySource(*mesh), b = bySource(back);
  for (const auto& [source, element] : a) {
    const uint32_t other = b.at(source);
    EXPECT_EQ(back.materialIndex(other), mesh->materialIndex(element));
    const auto x = mesh->triangle(element), y = back.triangle(other);
    EXPECT_TRUE(std::is_permutation(x.begin(), x.end(), y.begin()));
  }
  const HeightFieldData& terrain = *std::get<HeightField>(shapes[4].geometry).data;
  EXPECT_EQ(terrain.contentHash(), field->contentHash());
  EXPECT_EQ(terrain.height(2, 1), 5.5f);
  EXPECT_EQ(terrain.cellMaterial(1, 0), HeightFieldDef::kHole);
  EXPECT_EQ(terrain.thickness(), 3);
}

TEST(RecordSurfaces, AHullFarFromItsOriginComesBack) {
  const Folder folder;
  Chance chance;
  std::vector<Vec3> cloud;
  while (cloud.size() < 30) cloud.push_back(Vec3{5000, -3000, 0} + 0.05f * chance.vector());
  const auto hull = makeHull({cloud});
  Recording r;
  r.bodies = {{"all", BodyType::Static}};
  r.shapes.push_back({0, Hull{hull}, {}});
  const auto path = folder.file("a.avbd");
  RecordWriter(path, r).finish();
  const RecordReader reader(path);
  EXPECT_TRUE(reader.info().notes.empty());
  const auto* back = std::get_if<Hull>(&reader.head().shapes[0].geometry);
  ASSERT_NE(back, nullptr);
  EXPECT_EQ(back->data->vertices().size(), hull->vertices().size());
}

TEST(RecordSurfaces, ASurfaceThatCannotBeMadeIsNamedAndShowsAsNothing) {
  const Folder folder;
  Recording r;
  r.bodies = {{"all", BodyType::Static}};
  const auto path = folder.file("a.avbd");
  RecordWriter(path, r).finish();
  std::string bytes = Folder::read(path);
  bytes.resize(bytes.size() - kFooterBytes);
  FieldWriter flat;  // four points in one plane
  flat.value(1, uint8_t{0});
  flat.list(10, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  const Bytes chunk = chunkBytes(kSurfaces, flat.bytes(), false);
  bytes.insert(bytes.end(), chunk.begin(), chunk.end());
  FieldWriter shape;
  shape.list(1, std::vector<uint32_t>{0});
  shape.list(2, std::vector<uint8_t>{7});
  shape.list(3, std::vector<float>{1, 1, 1, 0});
  shape.list(4, std::vector<uint32_t>{0});
  shape.list(5, std::vector<double>{0, 0, 0});
  shape.list(6, std::vector<float>{1, 0, 0, 0});
  const Bytes shapes = chunkBytes(kShapes, shape.bytes(), false);
  bytes.insert(bytes.end(), shapes.begin(), shapes.end());
  const RecordReader reader(folder.write("b.avbd", bytes));
  const auto& notes = reader.info().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("chunk SURF") != std::string::npos && note.find("HullDef") != std::string::npos;
  }));
  ASSERT_EQ(reader.head().shapes.size(), 1u);
  const auto* nothing = std::get_if<Sphere>(&reader.head().shapes[0].geometry);
  ASSERT_NE(nothing, nullptr);
  EXPECT_EQ(nothing->radius, 0);
}

}  // namespace
}  // namespace avbd::record
