// Geometry becomes the plain data that collision works on.
#include "geom/shape.h"

#include <gtest/gtest.h>

namespace avbd {
namespace {

TEST(Shape, sphere) {
  const ShapeGeom g = toShapeGeom(Sphere{0.25f});
  EXPECT_EQ(g.type, ShapeType::Sphere);
  EXPECT_EQ(g.radius, 0.25f);
}

TEST(Shape, capsule) {
  const ShapeGeom g = toShapeGeom(Capsule{0.25f, 0.75f});
  EXPECT_EQ(g.type, ShapeType::Capsule);
  EXPECT_EQ(g.radius, 0.25f);
  EXPECT_EQ(g.extent, (Vec3{0, 0.75f, 0}));
}

TEST(Shape, boxWithAndWithoutRounding) {
  const ShapeGeom sharp = toShapeGeom(Box{1, 2, 3}), round = toShapeGeom(Box{1, 2, 3, 0.5f});
  EXPECT_EQ(sharp.type, ShapeType::Box);
  EXPECT_EQ(sharp.radius, 0);
  EXPECT_EQ(round.type, ShapeType::RoundedBox);
  EXPECT_EQ(round.radius, 0.5f);
  EXPECT_EQ(sharp.extent, (Vec3{1, 2, 3}));
  EXPECT_EQ(round.extent, sharp.extent);
}

TEST(Shape, cylinderAndCone) {
  const ShapeGeom cylinder = toShapeGeom(Cylinder{0.5f, 2, 0.1f}), cone = toShapeGeom(Cone{0.5f, 2});
  EXPECT_EQ(cylinder.type, ShapeType::Cylinder);
  EXPECT_EQ(cylinder.extent, (Vec3{0.5f, 2, 0.5f}));
  EXPECT_EQ(cylinder.radius, 0.1f);
  EXPECT_EQ(cone.type, ShapeType::Cone);
  EXPECT_EQ(cone.extent, cylinder.extent);
}

TEST(Shape, onlyUnboundedAndHollowOnesAreFixed) {
  EXPECT_TRUE(isOnlyFixed(HalfSpace{}));
  EXPECT_TRUE(isOnlyFixed(Mesh{}));
  EXPECT_TRUE(isOnlyFixed(HeightField{}));
  EXPECT_FALSE(isOnlyFixed(Hull{}));
  EXPECT_FALSE(isOnlyFixed(Sphere{}));
  EXPECT_STREQ(geometryName(HeightField{}), "HeightField");
  EXPECT_STREQ(geometryName(Hull{}), "Hull");
}

}  // namespace
}  // namespace avbd
