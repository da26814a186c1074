// The tree of faces finds all that a box overlaps, also after its points have moved.
#include "geom/face_tree.h"

#include <avbd/soft_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace avbd {
namespace {

Aabb boundsOf(const std::vector<Vec3>& points, const FaceTree::Face& face) {
  Aabb box{points[face[0]], points[face[0]]};
  for (const uint32_t i : face) {
    const Vec3 p = points[i];
    box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y), std::min(box.lower.z, p.z)};
    box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y), std::max(box.upper.z, p.z)};
  }
  return box;
}

TEST(FaceTree, FindsWhatABoxOverlaps) {
  const auto mesh = makeTetBox({1, 0.7f, 0.5f}, 6, 5, 4);
  const auto faces = mesh->surface();
  std::vector<Vec3> points(mesh->points().begin(), mesh->points().end());
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> draw(-0.3f, 0.3f), place(-1.2f, 1.2f), size(0.01f, 0.4f);
  std::vector<Aabb> bounds;
  for (int trial = 0; trial < 60; ++trial) {
    if (trial % 10 == 5)
      for (Vec3& p : points) p = p + Vec3{draw(generator), draw(generator), draw(generator)};
    mesh->faceTree().refit(
        faces, [&](uint32_t i) { return points[i]; }, bounds);
    const Vec3 at{place(generator), place(generator), place(generator)};
    const float half = size(generator);
    const Aabb box{at - Vec3{half, half, half}, at + Vec3{half, half, half}};
    std::vector<uint32_t> found;
    mesh->faceTree().query(bounds, box, [&](uint32_t face) {
      if (overlaps(boundsOf(points, faces[face]), box)) found.push_back(face);
    });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    std::vector<uint32_t> expected;
    for (uint32_t i = 0; i < faces.size(); ++i)
      if (overlaps(boundsOf(points, faces[i]), box)) expected.push_back(i);
    EXPECT_EQ(found, expected);
  }
}

TEST(FaceTree, OfOneFaceHasOneNode) {
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<FaceTree::Face> faces = {{0, 1, 2}};
  const FaceTree tree(points, faces);
  EXPECT_EQ(tree.nodeCount(), 1u);
}

}  // namespace
}  // namespace avbd
