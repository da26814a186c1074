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
    std::vector<Aabb> boxes;
    for (const auto& face : faces) boxes.push_back(boundsOf(points, face));
    mesh->faceTree().refit(boxes, bounds);
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

using Pair = std::pair<uint32_t, uint32_t>;

TEST(FaceTree, FindsEachTwoFacesThatOverlapOnce) {
  const auto mesh = makeTetBox({1, 0.7f, 0.5f}, 5, 4, 3), other = makeTetBox({0.5f, 0.6f, 0.4f}, 3, 5, 4);
  std::vector<Aabb> boxes[2], bounds[2];
  const SoftMeshData* all[2] = {mesh.get(), other.get()};
  for (int i = 0; i < 2; ++i) {
    const std::vector<Vec3> points(all[i]->points().begin(), all[i]->points().end());
    for (const auto& face : all[i]->surface()) boxes[i].push_back(boundsOf(points, face));
    all[i]->faceTree().refit(boxes[i], bounds[i]);
  }
  const Vec3 lower{0.3f, 0.1f, -0.4f}, upper{0.4f, 0.2f, -0.2f};
  const FaceTree::Placed a{boxes[0], bounds[0], {}, {}}, b{boxes[1], bounds[1], lower, upper};
  std::vector<Pair> found, expected;
  mesh->faceTree().pairs(a, other->faceTree(), b, [&](uint32_t i, uint32_t k) { found.push_back({i, k}); });
  for (uint32_t i = 0; i < boxes[0].size(); ++i)
    for (uint32_t k = 0; k < boxes[1].size(); ++k)
      if (overlaps(boxes[0][i], {boxes[1][k].lower + lower, boxes[1][k].upper + upper})) expected.push_back({i, k});
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);

  found.clear(), expected.clear();
  mesh->faceTree().pairs(
      a, [](uint32_t, uint32_t) { return false; },
      [&](uint32_t i, uint32_t k) {
        found.push_back({std::min(i, k), std::max(i, k)});
      });
  for (uint32_t i = 0; i < boxes[0].size(); ++i)
    for (uint32_t k = i + 1; k < boxes[0].size(); ++k)
      if (overlaps(boxes[0][i], boxes[0][k])) expected.push_back({i, k});
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);
}

TEST(FaceTree, OfOneFaceHasOneNode) {
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<FaceTree::Face> faces = {{0, 1, 2}};
  const FaceTree tree(points, faces);
  EXPECT_EQ(tree.nodeCount(), 1u);
}

}  // namespace
}  // namespace avbd
