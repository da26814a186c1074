// Hulls against qhull: the same vertices where points are in general position, the same volume everywhere.
#include <gtest/gtest.h>

#if __has_include(<libqhull_r/qhull_ra.h>) && defined(AVBD_QHULL)

#include <avbd/hull.h>

#include <algorithm>

#include "geom/hull_cases.h"
#include "geom/hull_qhull.h"

namespace avbd {
namespace {

/// Nothing merges, nothing is left out.
std::shared_ptr<const HullData> exactHull(std::span<const Vec3> points, float extent) {
  return makeHull({.points = points, .tolerance = 1e-9f * extent, .maxVertices = 255});
}

TEST(HullQhull, sameVerticesInGeneralPosition) {
  for (Cloud kind : {Cloud::Ball, Cloud::Sphere, Cloud::Cube, Cloud::Needle, Cloud::Pancake, Cloud::Duplicates}) {
    for (uint32_t seed = 1; seed <= 40; ++seed) {
      // Few enough that all hull vertices may stay.
      const std::vector<Vec3> points = cloud(kind, kind == Cloud::Sphere ? 10 + 5 * seed : 500, seed);
      const QhullAnswer answer = askQhull(points);
      const auto hull = exactHull(points, 2);
      ASSERT_EQ(hull->vertices().size(), answer.vertices.size()) << static_cast<int>(kind) << " seed " << seed;
      for (int i : answer.vertices) {
        EXPECT_TRUE(std::ranges::count(hull->vertices(), points[i]) == 1) << static_cast<int>(kind) << " seed " << seed;
      }
      EXPECT_NEAR(hull->massProperties(1).mass, answer.volume, 1e-6 * answer.volume);
    }
  }
}

TEST(HullQhull, sameVolumeOfEveryCloudAndSize) {
  for (int kind = 0; kind < kCloudCount; ++kind) {
    for (float size : {1.0f, 1e-5f, 1e5f}) {
      std::vector<Vec3> points = cloud(static_cast<Cloud>(kind), 200, 11);
      for (Vec3& p : points) p = p * size;
      const QhullAnswer answer = askQhull(points);
      const auto hull = exactHull(points, 2 * size);
      EXPECT_NEAR(hull->massProperties(1).mass, answer.volume, 1e-6 * answer.volume) << kind << " size " << size;
      // Within the default tolerance a flat cloud loses a part of its thickness, the others next to nothing.
      const double volume = makeHull({.points = points, .maxVertices = 255})->massProperties(1).mass;
      const bool thin = static_cast<Cloud>(kind) == Cloud::Pancake || static_cast<Cloud>(kind) == Cloud::Needle;
      EXPECT_LE(volume, answer.volume * (1 + 1e-6));
      EXPECT_GE(volume, answer.volume * (thin ? 0.7 : 0.999)) << kind << " size " << size;
    }
  }
}

}  // namespace
}  // namespace avbd

#else

TEST(HullQhull, skipped) { GTEST_SKIP() << "built without qhull (libqhull-dev)"; }

#endif
