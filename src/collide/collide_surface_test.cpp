// A convex shape on meshes and height fields: no ghost edges, the normals that the surface offers, right separations.
#include "collide/collide_surface.h"

#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>
#include <gtest/gtest.h>

#include "collide/collide_surface_oracle.h"

namespace avbd::surface_test {
namespace {

const Vec3 kUp{0, 1, 0};
const Quat kAlongX = turned(1.57079632679f, {0, 0, 1});

/// A shape with a rotation, and how far below its origin it reaches then.
struct Body {
  const char* name;
  Geometry geometry;
  Quat rotation;
  float reach;
  int points;  ///< that it has flat on the ground
};

std::vector<Body> bodies() {
  return {{"box", Box{0.5f, 0.3f, 0.4f}, {}, 0.3f, 4},
          {"turned box", Box{0.5f, 0.3f, 0.4f}, turned(0.4f, kUp), 0.3f, 4},
          {"sphere", Sphere{0.4f}, turned(0.3f, {1, 2, 3}), 0.4f, 1},
          {"lying capsule", Capsule{0.25f, 0.5f}, kAlongX, 0.25f, 2},
          {"standing capsule", Capsule{0.25f, 0.5f}, {}, 0.75f, 1},
          {"cylinder", Cylinder{0.4f, 0.3f}, {}, 0.3f, 4},
          {"lying cylinder", Cylinder{0.4f, 0.3f}, kAlongX, 0.4f, 2},
          {"hull", Hull{prism(0.4f, 0.3f)}, {}, 0.3f, 4},
          {"rounded box", Box{0.4f, 0.2f, 0.3f, 0.1f}, turned(0.2f, kUp), 0.3f, 4}};
}

/// Everywhere over flat ground at y = 0, exactly on edges and corners too, sunk and hovering, narrow and wide margins:
/// one patch, straight up, the right separation.
void slideOverGround(const Geometry& ground, float range) {
  const float heights[] = {-0.002f, 0, 0.004f}, margins[] = {0.01f, 0.25f};
  for (const Body& body : bodies()) {
    const ShapeGeom geom = toShapeGeom(body.geometry);
    for (int i = 0; i <= 160; ++i) {
      const float x = range * static_cast<float>(i - 80) / 80,
                  z = i % 3 == 0 ? 0 : 0.37f * x + 0.1f * static_cast<float>(i % 7);
      for (const float height : heights) {
        for (const float margin : margins) {
          const NearPose pose{{x, body.reach + height, z}, body.rotation};
          const auto patches = touch(geom, pose, ground, {}, margin);
          SCOPED_TRACE(testing::Message()
                       << body.name << " at " << x << ", " << z << " height " << height << " margin " << margin);
          ASSERT_EQ(patches.size(), 1u);
          const Manifold& m = patches[0].manifold;
          ASSERT_EQ(m.normal, -kUp);
          ASSERT_EQ(margin < 0.1f ? m.count : body.points, body.points);
          ASSERT_NEAR(deepest(m), height, 2e-6f);
          for (int k = 0; k < m.count; ++k) ASSERT_NEAR(m.points[k].position.y, m.points[k].separation / 2, 2e-6f);
        }
      }
    }
  }
}

TEST(CollideSurface, slidesOverAFlatMeshWithoutGhostEdges) { slideOverGround(meshOf(grid(20, 20, 0.5f, flat)), 3.5f); }
TEST(CollideSurface, slidesOverAFineMesh) { slideOverGround(meshOf(grid(60, 60, 0.1f, flat)), 2); }
TEST(CollideSurface, slidesOverAFlatHeightField) { slideOverGround(fieldOf(21, 21, 0.5f, flat), 3.5f); }
TEST(CollideSurface, slidesOverTrianglesThatShareNoVertices) {
  slideOverGround(meshOf(torn(grid(20, 20, 0.5f, flat))), 3.5f);
}
TEST(CollideSurface, slidesOverTJunctions) { slideOverGround(meshOf(withTJunctions(10, 0.5f)), 1.5f); }

TEST(CollideSurface, aBoxHasItsFourCornersAsOnABox) {
  const ShapeGeom box = toShapeGeom(Box{0.5f, 0.5f, 0.5f});
  const auto patches = touch(box, {{0.13f, 0.499f, 0.21f}, {}}, meshOf(grid(20, 20, 0.3f, flat)), {}, 0.02f);
  ASSERT_EQ(patches.size(), 1u);
  const Manifold& m = patches[0].manifold;
  ASSERT_EQ(m.count, 4);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(std::fabs(m.points[k].position.x - 0.13f), 0.5f, 1e-6f);
    EXPECT_NEAR(std::fabs(m.points[k].position.z - 0.21f), 0.5f, 1e-6f);
    EXPECT_NEAR(m.points[k].separation, -0.001f, 1e-6f);
    for (int j = 0; j < k; ++j) EXPECT_NE(m.points[k].feature, m.points[j].feature);
  }
}

/// Two tiles side by side are two surfaces; none knows of the other.
TEST(CollideSurface, slidesFromOneHeightFieldToTheNext) {
  const Geometry tile = fieldOf(9, 9, 0.5f, flat);
  for (const Body& body : bodies()) {
    const ShapeGeom geom = toShapeGeom(body.geometry);
    for (int i = 0; i <= 200; ++i) {
      const float x = 0.01f * static_cast<float>(i - 100);
      int points = 0;
      for (const float side : {-2.0f, 2.0f}) {
        for (const SurfacePatch& p :
             touch(geom, {{x, body.reach - 0.002f, 0.1f}, body.rotation}, tile, {{side, 0, 0}, {}}, 0.2f)) {
          ASSERT_EQ(p.manifold.normal, -kUp) << body.name << " at " << x;
          ASSERT_NEAR(deepest(p.manifold), -0.002f, 2e-6f);
          points += p.manifold.count;
        }
      }
      ASSERT_GT(points, 0) << body.name << " at " << x;
    }
  }
}

/// A roof with slopes of 45 degrees and its ridge along z at y = 0.
TEST(CollideSurface, aRidgeOffersAllDirectionsBetweenItsFaces) {
  const Geometry roof = meshOf(grid(4, 8, 1, [](float x, float) { return -std::fabs(x); }));
  const ShapeGeom sphere = toShapeGeom(Sphere{0.5f});
  for (int i = -8; i <= 8; ++i) {
    const float angle = 0.09f * static_cast<float>(i);
    const Vec3 u{std::sin(angle), std::cos(angle), 0};
    const auto patches = touch(sphere, {u * 0.49f + Vec3{0, 0, 0.3f}, {}}, roof, {}, 0.02f);
    ASSERT_EQ(patches.size(), 1u) << i;
    EXPECT_LT(length(patches[0].manifold.normal + u), 1e-5f);
    EXPECT_NEAR(deepest(patches[0].manifold), -0.01f, 1e-6f);
  }
  const auto across = touch(toShapeGeom(Box{0.5f, 0.2f, 0.5f}), {{0.1f, 0.198f, 0.2f}, {}}, roof, {}, 0.02f);
  ASSERT_EQ(across.size(), 1u);
  EXPECT_LT(length(across[0].manifold.normal + kUp), 1e-5f);
  EXPECT_EQ(across[0].manifold.count, 2);
  EXPECT_NEAR(deepest(across[0].manifold), -0.002f, 1e-5f);
}

/// A valley with slopes of 45 degrees: each side pushes by its own normal and the fold between them by none.
TEST(CollideSurface, aValleyTouchesOnBothSides) {
  const Geometry valley = meshOf(grid(4, 8, 1, [](float x, float) { return std::fabs(x); }));
  const float half = std::sqrt(0.5f);
  const auto sphere = touch(toShapeGeom(Sphere{0.5f}), {{0, 0.5f / half - 0.001f, 0.25f}, {}}, valley, {}, 0.02f);
  ASSERT_EQ(sphere.size(), 2u);
  for (const SurfacePatch& p : sphere) {
    EXPECT_NEAR(std::fabs(p.manifold.normal.x), half, 1e-6f);
    EXPECT_NEAR(p.manifold.normal.y, -half, 1e-6f);
    EXPECT_NEAR(deepest(p.manifold), -0.001f * half, 1e-6f);
    EXPECT_EQ(p.manifold.count, 1);
  }
  const auto box = touch(toShapeGeom(Box{0.5f, 0.5f, 0.5f}), {{0, 1.0f - 0.3f, 0.25f}, turned(0.785398163f, {0, 0, 1})},
                         valley, {}, 0.02f);
  ASSERT_EQ(box.size(), 2u);
  for (const SurfacePatch& p : box) EXPECT_EQ(p.manifold.count, 4);
}

/// Treads 1 deep and 0.4 high that climb along +x.
SurfaceDef staircase(int steps) {
  SurfaceDef s;
  for (int i = 0; i < steps; ++i) {
    const auto x = static_cast<float>(i), y = 0.4f * static_cast<float>(i);
    quad(s, {x, y - 0.4f, 2}, {x, y, 2}, {x, y, -2}, {x, y - 0.4f, -2});
    quad(s, {x, y, -2}, {x, y, 2}, {x + 1, y, 2}, {x + 1, y, -2});
  }
  return s;
}

TEST(CollideSurface, aBoxOnAStairIsPushedUpWhereverItOverhangs) {
  const Geometry stairs = meshOf(staircase(6));
  const ShapeGeom box = toShapeGeom(Box{0.3f, 0.3f, 0.3f});
  // On the tread from x = 3 to 4 at y = 1.2; it overhangs the edge at x = 3.
  for (int i = 0; i < 55; ++i) {
    const float x = 3.64f - 0.017f * static_cast<float>(i);
    const auto patches = touch(box, {{x, 1.498f, 0.1f}, turned(0.0f, kUp)}, stairs, {}, 0.05f);
    ASSERT_EQ(patches.size(), 1u) << x;
    ASSERT_LT(length(patches[0].manifold.normal + kUp), 1e-5f) << x;
    ASSERT_NEAR(deepest(patches[0].manifold), -0.002f, 1e-5f) << x;
  }
  // Against the riser at x = 4.
  const auto both = touch(box, {{3.701f, 1.498f, 0.1f}, {}}, stairs, {}, 0.05f);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].manifold.normal, -kUp);
  EXPECT_EQ(both[1].manifold.normal, (Vec3{1, 0, 0}));
  EXPECT_NEAR(deepest(both[1].manifold), -0.001f, 1e-6f);
}

TEST(CollideSurface, aSphereInAFineBowl) {
  const auto bowl = [](float x, float z) { return 2 - std::sqrt(4 - x * x - z * z); };
  const Geometry mesh = meshOf(grid(40, 40, 0.05f, bowl));
  for (int i = 0; i < 20; ++i) {
    const float a = 0.3f * static_cast<float>(i), r = 0.03f * static_cast<float>(i);
    const Vec3 down{std::sin(r) * std::cos(a), -std::cos(r), std::sin(r) * std::sin(a)};
    const auto patches = touch(toShapeGeom(Sphere{0.5f}), {Vec3{0, 2, 0} + down * 1.5f, {}}, mesh, {}, 0.01f);
    ASSERT_EQ(patches.size(), 1u);
    EXPECT_GT(dot(patches[0].manifold.normal, down), 0.999f);
    EXPECT_NEAR(deepest(patches[0].manifold), 0, 5e-4f);
  }
}

TEST(CollideSurface, aBoxEdgeOnASpike) {
  const Geometry spike = meshOf(pyramid(0.2f, 1));
  for (const float tilt : {0.0f, 0.3f, -0.6f, 0.785398f}) {
    const Quat q = turned(tilt, {0, 0, 1});
    const float reach = 0.5f * (std::fabs(std::cos(tilt)) + std::fabs(std::sin(tilt)));
    const NearPose pose{{0, 1 + reach - 0.003f, 0}, q};
    const Vec3 lowest = tilt == 0 ? Vec3{0, 1 - 0.003f, 0} : pose * Vec3{tilt > 0 ? -0.5f : 0.5f, -0.5f, 0};
    // The lowest edge right over the tip.
    const NearPose over{pose.p - Vec3{lowest.x, 0, 0}, q};
    const auto patches = touch(toShapeGeom(Box{0.5f, 0.5f, 0.5f}), over, spike, {}, 0.02f);
    ASSERT_EQ(patches.size(), 1u) << tilt;
    // The tip goes out through the nearer of the edge's two faces.
    const float out = tilt == 0 ? 1 : std::fmin(std::cos(tilt), std::fabs(std::sin(tilt)));
    EXPECT_NEAR(dot(patches[0].manifold.normal, -kUp), out, 1e-3f) << tilt;
    EXPECT_NEAR(deepest(patches[0].manifold), -0.003f * out, 1e-5f) << tilt;
  }
}

/// A closed cube: from all sides, edges and corners a sphere and a box are pushed as by the solid cube.
TEST(CollideSurface, aClosedCubeFromAllSides) {
  const Geometry cube = meshOf(cubeMesh(3));
  const ShapeGeom sphere = toShapeGeom(Sphere{0.3f});
  for (int x = -5; x <= 5; ++x) {
    for (int y = -5; y <= 5; ++y) {
      for (int z = -5; z <= 5; ++z) {
        const Vec3 c = Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} * 0.131f;
        const Vec3 y0 = clampTo(c, {0.5f, 0.5f, 0.5f});
        const float distance = length(c - y0);
        if (distance == 0) continue;
        const auto patches = touch(sphere, {c, {}}, cube, {}, 0.05f);
        ASSERT_EQ(patches.size(), distance - 0.3f < 0.05f ? 1u : 0u) << x << y << z;
        if (patches.empty()) continue;
        EXPECT_LT(length(patches[0].manifold.normal + (c - y0) * (1 / distance)), 2e-5f) << x << ' ' << y << ' ' << z;
        EXPECT_NEAR(deepest(patches[0].manifold), distance - 0.3f, 1e-6f);
      }
    }
  }
}

TEST(CollideSurface, aBoxOverTheEdgesOfACubeMeshIsPushedTheShortWay) {
  const Geometry cube = meshOf(cubeMesh(3));
  const ShapeGeom box = toShapeGeom(Box{0.4f, 0.4f, 0.4f});
  for (int i = 0; i < 100; ++i) {
    const float x = 0.0087f * static_cast<float>(i), z = 0.3f;
    const auto patches = touch(box, {{x, 0.898f, z}, {}}, cube, {}, 0.05f);
    ASSERT_EQ(patches.size(), 1u) << x;
    EXPECT_LT(length(patches[0].manifold.normal + kUp), 1e-5f) << x;
    EXPECT_NEAR(deepest(patches[0].manifold), -0.002f, 1e-5f) << x;
    EXPECT_EQ(patches[0].manifold.count, 4) << x;
  }
}

TEST(CollideSurface, whatIsBehindPassesUnlessBothSidesPush) {
  const ShapeGeom sphere = toShapeGeom(Sphere{0.5f});
  SurfaceDef def = grid(4, 4, 1, flat);
  EXPECT_TRUE(touch(sphere, {{0.2f, -0.1f, 0.1f}, {}}, meshOf(def), {}, 0.02f).empty());
  def.doubleSided = true;
  const Geometry sheet = meshOf(def);
  for (const float side : {-1.0f, 1.0f}) {
    const auto patches = touch(sphere, {{0.2f, 0.49f * side, 0.1f}, {}}, sheet, {}, 0.02f);
    ASSERT_EQ(patches.size(), 1u);
    EXPECT_EQ(patches[0].manifold.normal, (Vec3{0, -side, 0}));
    EXPECT_NEAR(deepest(patches[0].manifold), -0.01f, 1e-6f);
  }
  // From below a valley is a ridge.
  SurfaceDef fold = grid(4, 8, 1, [](float x, float) { return std::fabs(x); });
  fold.doubleSided = true;
  const auto under = touch(sphere, {{0.1f, -0.48f, 0.2f}, {}}, meshOf(fold), {}, 0.02f);
  ASSERT_EQ(under.size(), 1u);
  EXPECT_LT(length(under[0].manifold.normal - Vec3{-0.1f, 0.48f, 0} * (1 / length(Vec3{0.1f, 0.48f, 0}))), 1e-5f);
}

TEST(CollideSurface, aHeightFieldPushesUpFromWithinItsThickness) {
  const Geometry field = fieldOf(9, 9, 0.5f, flat, 0.8f);
  const ShapeGeom box = toShapeGeom(Box{0.2f, 0.2f, 0.2f});
  for (const float y : {0.1f, -0.1f, -0.5f, -0.79f}) {
    const auto patches = touch(box, {{0.1f, y, 0.3f}, {}}, field, {}, 0.02f);
    ASSERT_EQ(patches.size(), 1u) << y;
    EXPECT_EQ(patches[0].manifold.normal, -kUp);
    EXPECT_NEAR(deepest(patches[0].manifold), y - 0.2f, 1e-5f);
  }
  EXPECT_TRUE(touch(box, {{0.1f, -0.81f, 0.3f}, {}}, field, {}, 0.02f).empty());
}

TEST(CollideSurface, holesLetThroughAndTheirRimsTouch) {
  std::vector<uint16_t> materials(64, 0);
  for (const int cell : {27, 28, 35, 36}) materials[static_cast<size_t>(cell)] = HeightFieldDef::kHole;
  const Geometry field = fieldOf(9, 9, 0.5f, flat, 0.5f, materials);
  const ShapeGeom small = toShapeGeom(Sphere{0.3f}), large = toShapeGeom(Sphere{0.6f});
  EXPECT_TRUE(touch(small, {{0, 0.1f, 0}, {}}, field, {}, 0.02f).empty());
  EXPECT_TRUE(touch(small, {{0, -0.1f, 0}, {}}, field, {}, 0.02f).empty());
  // The large one rests on the four sides of the square hole.
  const float height = std::sqrt(0.36f - 0.25f);
  const auto rim = touch(large, {{0, height - 0.001f, 0}, {}}, field, {}, 0.02f);
  ASSERT_EQ(rim.size(), 4u);
  for (const SurfacePatch& p : rim) {
    EXPECT_NEAR(p.manifold.normal.y, -height / 0.6f, 2e-3f);
    EXPECT_LT(deepest(p.manifold), 0);
  }
}

TEST(CollideSurface, meshesTouchWithTheirRimsButTilesDoNot) {
  const ShapeGeom sphere = toShapeGeom(Sphere{0.5f}), box = toShapeGeom(Box{0.5f, 0.5f, 0.5f});
  const Vec3 off{0.3f, 0.35f, 0};
  const Geometry mesh = meshOf(grid(4, 4, 0.5f, flat)), tile = fieldOf(5, 5, 0.5f, flat);
  const auto rim = touch(sphere, {Vec3{1, 0, 0.1f} + off, {}}, mesh, {}, 0.02f);
  ASSERT_EQ(rim.size(), 1u);
  EXPECT_LT(length(rim[0].manifold.normal + off * (1 / length(off))), 1e-5f);
  EXPECT_NEAR(deepest(rim[0].manifold), length(off) - 0.5f, 1e-6f);
  EXPECT_TRUE(touch(sphere, {Vec3{1, 0, 0.1f} + off, {}}, tile, {}, 0.02f).empty());
  // Half over the rim a box stands on what is there.
  for (const Geometry& ground : {mesh, tile}) {
    const auto half = touch(box, {{1.1f, 0.499f, 0.1f}, {}}, ground, {}, 0.02f);
    ASSERT_EQ(half.size(), 1u);
    EXPECT_EQ(half[0].manifold.normal, -kUp);
    EXPECT_EQ(half[0].manifold.count, 4);
    for (int k = 0; k < 4; ++k) EXPECT_LE(half[0].manifold.points[k].position.x, 1 + 1e-4f);
  }
}

TEST(CollideSurface, materialsMakePatchesOfTheirOwn) {
  SurfaceDef def = grid(4, 4, 1, flat);
  for (size_t i = 0; i < def.triangles.size(); ++i) {
    const Vec3 v = def.vertices[def.triangles[i][0]], w = def.vertices[def.triangles[i][1]],
               x = def.vertices[def.triangles[i][2]];
    def.materials.push_back(v.x + w.x + x.x > 0 ? 3 : 1);
  }
  const auto patches = touch(toShapeGeom(Box{0.5f, 0.5f, 0.5f}), {{0.1f, 0.499f, 0.3f}, {}}, meshOf(def), {}, 0.02f);
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_EQ(patches[0].material + patches[1].material, 4);
  for (const SurfacePatch& p : patches) {
    EXPECT_EQ(p.manifold.count, 4);
    for (int k = 0; k < 4; ++k) EXPECT_GE(p.manifold.points[k].position.x * (p.material == 3 ? 1 : -1), -1e-5f);
  }
}

TEST(CollideSurface, scaledAndMirroredMeshesPushOutOfTheirFronts) {
  SurfaceDef def = grid(8, 8, 0.5f, [](float x, float) { return -std::fabs(x); });
  const ShapeGeom sphere = toShapeGeom(Sphere{0.5f});
  for (const Vec3 scale : {Vec3{1, 1, 1}, Vec3{-1, 1, 1}, Vec3{2, 0.5f, 1}, Vec3{-2, 0.5f, -3}, Vec3{1, 1, -2}}) {
    Mesh mesh = std::get<Mesh>(meshOf(def));
    mesh.scale = scale;
    const auto top = touch(sphere, {{0, 0.49f, 0.2f}, {}}, mesh, {}, 0.02f);
    ASSERT_EQ(top.size(), 1u) << scale.x << ' ' << scale.y << ' ' << scale.z;
    EXPECT_LT(length(top[0].manifold.normal + kUp), 1e-5f);
    const float slope = scale.y / std::fabs(scale.x);
    const Vec3 n = Vec3{slope, 1, 0} * (1 / std::sqrt(1 + slope * slope));
    const auto side = touch(sphere, {Vec3{0.4f, -0.4f * slope, 0.2f} + n * 0.498f, {}}, mesh, {}, 0.02f);
    ASSERT_EQ(side.size(), 1u);
    EXPECT_LT(length(side[0].manifold.normal + n), 1e-5f);
    EXPECT_NEAR(deepest(side[0].manifold), -0.002f, 1e-6f);
  }
  Mesh down = std::get<Mesh>(meshOf(grid(8, 8, 0.5f, flat)));
  down.scale = {1, -1, 1};
  EXPECT_TRUE(touch(sphere, {{0.1f, 0.49f, 0.2f}, {}}, down, {}, 0.02f).empty());
  EXPECT_EQ(touch(sphere, {{0.1f, -0.49f, 0.2f}, {}}, down, {}, 0.02f).size(), 1u);
}

}  // namespace
}  // namespace avbd::surface_test
