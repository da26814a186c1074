// Geometry survives the way to plain data and back.
#include "geom/shape.h"

#include <gtest/gtest.h>

namespace avbd {
namespace {

TEST(Shape, keepsSphere) {
  const ShapeGeom g = toShapeGeom(Sphere{0.25f});
  EXPECT_EQ(g.type, ShapeType::Sphere);
  EXPECT_EQ(std::get<Sphere>(toGeometry(g)).radius, 0.25f);
}

TEST(Shape, keepsCapsule) {
  const ShapeGeom g = toShapeGeom(Capsule{0.25f, 0.75f});
  EXPECT_EQ(g.type, ShapeType::Capsule);
  EXPECT_EQ(g.extent, (Vec3{0, 0.75f, 0}));
  const Capsule c = std::get<Capsule>(toGeometry(g));
  EXPECT_EQ(c.radius, 0.25f);
  EXPECT_EQ(c.halfHeight, 0.75f);
}

TEST(Shape, keepsBox) {
  const ShapeGeom g = toShapeGeom(Box{1, 2, 3});
  EXPECT_EQ(g.type, ShapeType::Box);
  EXPECT_EQ(g.radius, 0);
  const Box b = std::get<Box>(toGeometry(g));
  EXPECT_EQ(b.x, 1);
  EXPECT_EQ(b.y, 2);
  EXPECT_EQ(b.z, 3);
}

TEST(Shape, keepsHalfSpace) {
  const ShapeGeom g = toShapeGeom(HalfSpace{});
  EXPECT_EQ(g.type, ShapeType::HalfSpace);
  EXPECT_TRUE(std::holds_alternative<HalfSpace>(toGeometry(g)));
}

}  // namespace
}  // namespace avbd
