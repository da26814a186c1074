// Features of surfaces: each with one face.
#include "geom/surface_features.h"

#include <avbd/soft_mesh.h>
#include <gtest/gtest.h>

#include <set>

namespace avbd {
namespace {

void expectEachOnce(const SoftMeshData& mesh) {
  const auto faces = mesh.surface();
  const SurfaceFeatures all = surfaceFeatures(mesh.points().size(), faces);
  std::multiset<uint32_t> corners, edges;
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t e = all.faceEdges[f][k], a = faces[f][k], b = faces[f][(k + 1) % 3];
      ASSERT_LT(e, all.edges.size());
      EXPECT_EQ(all.edges[e], (std::array<uint32_t, 2>{std::min(a, b), std::max(a, b)}));
      EXPECT_TRUE(all.edgeFaces[e][0] == f || all.edgeFaces[e][1] == f);
      if (all.ownsCorner(f, k)) corners.insert(a);
      if (all.ownsEdge(f, k)) edges.insert(e);
    }
  std::set<uint32_t> points;
  for (const auto& face : faces) points.insert(face.begin(), face.end());
  EXPECT_EQ(corners, std::multiset<uint32_t>(points.begin(), points.end()));
  EXPECT_EQ(edges.size(), all.edges.size());
  EXPECT_EQ(std::set<uint32_t>(edges.begin(), edges.end()).size(), all.edges.size());
}

TEST(SurfaceFeatures, OfASolidEachHasOneFaceAndEveryEdgeTwo) {
  const auto mesh = makeTetBox({1, 1, 1}, 3, 4, 5);
  expectEachOnce(*mesh);
  const SurfaceFeatures all = surfaceFeatures(mesh->points().size(), mesh->surface());
  EXPECT_EQ(all.edges.size(), 3 * mesh->surface().size() / 2);
  for (const auto& faces : all.edgeFaces) EXPECT_NE(faces[1], SurfaceFeatures::kNoFace);
}

TEST(SurfaceFeatures, OfClothTheRimHasOneFace) {
  const auto mesh = makeClothGrid(1, 1, 4, 3);
  expectEachOnce(*mesh);
  const SurfaceFeatures all = surfaceFeatures(mesh->points().size(), mesh->surface());
  size_t rim = 0;
  for (const auto& faces : all.edgeFaces) rim += faces[1] == SurfaceFeatures::kNoFace;
  EXPECT_EQ(rim, 2 * (4 + 3));
}

}  // namespace
}  // namespace avbd
