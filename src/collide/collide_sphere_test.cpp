// Sphere against sphere, capsule, box and half-space, in cases with known answers.
#include <gtest/gtest.h>

#include "collide/collide.h"

namespace avbd {
namespace {

Manifold touch(const Geometry& a, Vec3 pa, const Geometry& b, Vec3 pb, float margin = 0.1f, Quat qb = {}) {
  Manifold m;
  collide(toShapeGeom(a), {pa, {}}, toShapeGeom(b), {pb, qb}, margin, m);
  return m;
}

void expectPoint(const Manifold& m, Vec3 normal, Vec3 position, float separation) {
  ASSERT_EQ(m.count, 1);
  EXPECT_LT(length(m.normal - normal), 1e-6f);
  EXPECT_LT(length(m.points[0].position - position), 1e-6f);
  EXPECT_NEAR(m.points[0].separation, separation, 1e-6f);
}

TEST(CollideSphere, sphere) {
  expectPoint(touch(Sphere{1}, {0, 0, 0}, Sphere{0.5f}, {1.25f, 0, 0}), {1, 0, 0}, {0.875f, 0, 0}, -0.25f);
  expectPoint(touch(Sphere{1}, {0, 2, 0}, Sphere{0.5f}, {0, 0.45f, 0}), {0, -1, 0}, {0, 0.975f, 0}, 0.05f);
  EXPECT_EQ(touch(Sphere{1}, {}, Sphere{0.5f}, {0, 1.7f, 0}).count, 0);
  const Manifold same = touch(Sphere{1}, {}, Sphere{0.5f}, {}), back = touch(Sphere{0.5f}, {}, Sphere{1}, {});
  EXPECT_EQ(std::fabs(same.normal.y), 1);
  EXPECT_EQ(same.normal, -back.normal);
  EXPECT_FLOAT_EQ(same.points[0].separation, -1.5f);
}

TEST(CollideSphere, capsule) {
  const Capsule c{0.5f, 1};
  expectPoint(touch(Sphere{0.5f}, {0.9f, 0.5f, 0}, c, {}), {-1, 0, 0}, {0.45f, 0.5f, 0}, -0.1f);  // its side
  expectPoint(touch(Sphere{0.5f}, {0, 2.05f, 0}, c, {}), {0, -1, 0}, {0, 1.525f, 0}, 0.05f);      // its end
  expectPoint(touch(Sphere{0.5f}, {0.3f, 1.4f, 0}, c, {}), {-0.6f, -0.8f, 0}, {0.15f, 1.2f, 0}, -0.5f);
  EXPECT_NEAR(length(touch(Sphere{0.5f}, {0, 0.2f, 0}, c, {}).normal), 1, 1e-6f);
  EXPECT_FLOAT_EQ(touch(Sphere{0.5f}, {0, 0.2f, 0}, c, {}).points[0].separation, -1);
}

TEST(CollideSphere, boxFromOutside) {
  const Box b{1, 2, 3};
  expectPoint(touch(Sphere{0.5f}, {0.3f, 2.4f, 1}, b, {}), {0, -1, 0}, {0.3f, 1.95f, 1}, -0.1f);  // face
  expectPoint(touch(Sphere{0.5f}, {1.3f, 2.4f, 1}, b, {}), {-0.6f, -0.8f, 0}, {1, 2, 1}, 0);      // edge
  const Manifold corner = touch(Sphere{2}, {2, 3, 4}, b, {});
  EXPECT_NEAR(corner.points[0].separation, std::sqrt(3.0f) - 2, 1e-6f);
  EXPECT_EQ(touch(Sphere{0.5f}, {1.5f, 2.5f, 0}, b, {}).count, 0);  // near both faces' planes, not near the edge
}

TEST(CollideSphere, boxFromInsideLeavesByTheNearestFace) {
  const Box b{1, 2, 3};
  expectPoint(touch(Sphere{0.5f}, {0.9f, 0, 0}, b, {}), {-1, 0, 0}, {0.7f, 0, 0}, -0.6f);
  expectPoint(touch(Sphere{0.5f}, {0, -1.9f, 0}, b, {}), {0, 1, 0}, {0, -1.7f, 0}, -0.6f);
  const Manifold center = touch(Sphere{0.5f}, {}, b, {});
  EXPECT_EQ(center.normal, (Vec3{-1, 0, 0}));
  EXPECT_FLOAT_EQ(center.points[0].separation, -1.5f);
}

TEST(CollideSphere, halfSpace) {
  expectPoint(touch(Sphere{0.5f}, {3, 0.45f, 1}, HalfSpace{}, {}), {0, -1, 0}, {3, -0.025f, 1}, -0.05f);
  const float s = std::sqrt(0.5f);
  expectPoint(touch(Sphere{0.5f}, {0, 0, 1.55f}, HalfSpace{}, {0, 0, 1}, 0.1f, {s, s, 0, 0}), {0, 0, -1},
              {0, 0, 1.025f}, 0.05f);
  EXPECT_EQ(touch(Sphere{0.5f}, {0, 0.7f, 0}, HalfSpace{}, {}).count, 0);
  EXPECT_FLOAT_EQ(touch(Sphere{0.5f}, {0, -9, 0}, HalfSpace{}, {}).points[0].separation, -9.5f);
}

}  // namespace
}  // namespace avbd
