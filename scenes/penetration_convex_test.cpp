// The direction search against closed forms and against the exact measure of simple shapes.
#include "scenes/penetration_convex.h"

#include <avbd/hull.h>
#include <avbd/mesh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenes/penetration.h"

namespace avbd::scenes {
namespace {

Quat randomRotation(std::mt19937& random) {
  std::normal_distribution<double> draw;
  const double w = draw(random), x = draw(random), y = draw(random), z = draw(random);
  const double k = 1 / std::sqrt(w * w + x * x + y * y + z * z);
  const auto f = [k](double v) { return static_cast<float>(v * k); };
  return {f(w), f(x), f(y), f(z)};
}

TEST(ConvexDepth, agreesWithTheExactMeasureOfSimpleShapes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-0.8, 0.8);
  const Geometry shapes[] = {Sphere{0.5f}, Capsule{0.3f, 0.6f}, Box{0.4f, 0.6f, 0.3f}};
  int overlapping = 0;
  for (int i = 0; i < 400; ++i) {
    const Geometry &a = shapes[i % 3], &b = shapes[(i / 3) % 3];
    const Pose pa{{}, randomRotation(random)}, pb{{draw(random), draw(random), draw(random)}, randomRotation(random)};
    const double exact = penetrationDepth({a, pa, 0, true}, {b, pb, 1, true});
    const double found = convexDepth(convexBody(a, pa), convexBody(b, pb));
    EXPECT_NEAR(std::max(found, 0.0), exact, 5e-5) << i;
    overlapping += exact > 0;
  }
  EXPECT_GT(overlapping, 100);
}

TEST(ConvexDepth, knowsSmoothShapes) {
  const Pose origin;
  const auto depth = [&](const Geometry& a, const Geometry& b, Vec3d at) {
    return convexDepth(convexBody(a, origin), convexBody(b, {at, {}}));
  };
  const Cylinder cylinder{0.5f, 1};
  EXPECT_NEAR(depth(cylinder, cylinder, {0, 1.9, 0}), 0.1, 1e-7);
  EXPECT_NEAR(depth(cylinder, cylinder, {0.6, 0, 0.6}), 1 - std::sqrt(0.72), 1e-7);
  EXPECT_NEAR(depth(cylinder, Sphere{0.25f}, {0.8, 1.4, 0}), 0.25 - 0.5, 1e-6);  // apart, from the rim: 3-4-5
  EXPECT_NEAR(depth(Cylinder{0.5f, 1, 0.1f}, cylinder, {1.05, 0, 0}), 0.05, 1e-7);
  // A ball at a cone's side: the side's normal in the section is (2, 1) / sqrt 5.
  EXPECT_NEAR(depth(Cone{0.5f, 0.5f}, Sphere{0.25f}, {0.25 + 0.2, 0 + 0.1, 0}), 0.25 - 0.1 * std::sqrt(5.0), 1e-6);
  EXPECT_NEAR(depth(Ellipsoid{0.5f, 1, 2}, Box{1, 1, 1}, {0, 1.9, 0}), 0.1, 1e-7);
  EXPECT_NEAR(penetrationDepth({HalfSpace{}, origin, 0, false}, {Cone{0.5f, 1}, {{0, 0.9, 0}, {}}, 1, true}), 0.1,
              1e-7);
}

TEST(ConvexDepth, measuresHullsLikeBoxes) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back({k & 1 ? 0.4f : -0.4f, k & 2 ? 0.6f : -0.6f, k & 4 ? 0.3f : -0.3f});
  const Hull hull{makeHull({.points = corners})};
  const Box box{0.4f, 0.6f, 0.3f};
  std::mt19937 random(9);
  std::uniform_real_distribution<double> draw(-0.6, 0.6);
  for (int i = 0; i < 100; ++i) {
    const Pose pa{{}, randomRotation(random)}, pb{{draw(random), draw(random), draw(random)}, randomRotation(random)};
    EXPECT_NEAR(penetrationDepth({hull, pa, 0, true}, {hull, pb, 1, true}),
                penetrationDepth({box, pa, 0, true}, {box, pb, 1, true}), 1e-6);
  }
}

TEST(ConvexDepth, measuresAgainstTriangles) {
  const Vec3 vertices[] = {{-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}};
  const std::array<uint32_t, 3> triangles[] = {{0, 2, 1}, {0, 3, 2}};
  const Mesh mesh{makeMesh({.vertices = vertices, .triangles = triangles})};
  const PlacedShape floor{mesh, {{0, 1, 0}, {}}, 0, false};
  EXPECT_NEAR(penetrationDepth(floor, {Box{0.5f, 0.5f, 0.5f}, {{1, 1.49, 2}, {}}, 1, true}), 0.01, 1e-7);
  EXPECT_NEAR(penetrationDepth(floor, {Sphere{0.5f}, {{0, 1.48, 0}, {}}, 1, true}), 0.02, 1e-6);
  EXPECT_EQ(penetrationDepth(floor, {Sphere{0.5f}, {{0, 1.6, 0}, {}}, 1, true}), 0);
}

}  // namespace
}  // namespace avbd::scenes
