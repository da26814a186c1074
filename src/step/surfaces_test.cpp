// Bodies on meshes and height fields in a running world: several contacts a pair, memory across triangles, materials.
#include <avbd/avbd.h>
#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace avbd {
namespace {

constexpr float kDt = 1.0f / 60;

/// A grid of 2 n x 2 n cells of this size about the origin, with y = height(x, z); `material` of a cell by its middle.
std::shared_ptr<const MeshData> makeGrid(int n, float cell, const std::function<float(float, float)>& height,
                                         const std::function<int(float, float)>& material = {}) {
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint16_t> materials;
  const int side = 2 * n + 1;
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const float x = static_cast<float>(c - n) * cell, z = static_cast<float>(r - n) * cell;
      vertices.push_back({x, height(x, z), z});
    }
  for (int r = 0; r + 1 < side; ++r)
    for (int c = 0; c + 1 < side; ++c) {
      const auto at = [&](int i, int k) { return static_cast<uint32_t>((r + k) * side + c + i); };
      triangles.push_back({at(0, 0), at(0, 1), at(1, 1)});
      triangles.push_back({at(0, 0), at(1, 1), at(1, 0)});
      const float x = (static_cast<float>(c - n) + 0.5f) * cell, z = (static_cast<float>(r - n) + 0.5f) * cell;
      const uint16_t index = static_cast<uint16_t>(material ? material(x, z) : 0);
      materials.insert(materials.end(), 2, index);
    }
  return makeMesh({.vertices = vertices, .triangles = triangles, .materials = materials});
}
float flat(float, float) { return 0; }

BodyId addMesh(World& world, std::shared_ptr<const MeshData> data) {
  return world.create(BodyDef{.type = BodyType::Static, .shape = Mesh{std::move(data)}});
}
Vec3 forceOn(const World& world, BodyId id) {
  Vec3 sum;
  for (const Contact& contact : world.contacts())
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& point = contact.points[static_cast<size_t>(i)];
      const Vec3 onB = contact.normal * point.normalForce + point.frictionForce;
      if (contact.bodyB == id) sum = sum + onB;
      if (contact.bodyA == id) sum = sum - onB;
    }
  return sum;
}

// The mesh may be the pair's A or its B.
class Order : public testing::TestWithParam<bool> {
 protected:
  BodyId mesh, body;
  void fill(World& world, std::shared_ptr<const MeshData> data, const BodyDef& def) {
    if (GetParam()) mesh = addMesh(world, data);
    body = world.create(def);
    if (!GetParam()) mesh = addMesh(world, data);
  }
};

TEST_P(Order, ABoxRestsOnTriangles) {
  World world;
  fill(world, makeGrid(4, 0.3f, flat), BodyDef{.position = {0.05, 0.5, 0.1}, .shape = Box{0.5f, 0.5f, 0.5f}});
  for (int i = 0; i < 120; ++i) world.step(kDt);
  EXPECT_LT(length(world.velocity(body).linear), 2e-3);
  EXPECT_LT(length(world.pose(body).position - Vec3d{0.05, 0.5, 0.1}), 4e-3);
  const Vec3 force = forceOn(world, body);
  EXPECT_LT(length(force + world.definition().gravity * world.mass(body)), 0.01f * 9.81f * world.mass(body));
  ASSERT_EQ(world.contacts().size(), 1u);
  const Contact contact = world.contacts()[0];
  EXPECT_EQ(contact.bodyA, GetParam() ? mesh : body);
  EXPECT_LT((GetParam() ? contact.elementA : contact.elementB), 128u);
  EXPECT_EQ((GetParam() ? contact.elementB : contact.elementA), kNoElement);
  EXPECT_NEAR(contact.normal.y, GetParam() ? 1 : -1, 1e-6);
}

TEST_P(Order, ABallInACornerHasThreeContacts) {
  // Corner of a cube that stands on its tip, seen from inside.
  const float s = 2;
  const std::vector<Vec3> vertices = {{0, 0, 0}, {s, s, 0}, {-0.5f * s, s, 0.866f * s}, {-0.5f * s, s, -0.866f * s}};
  const std::vector<std::array<uint32_t, 3>> triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}};
  World world;
  fill(world, makeMesh({.vertices = vertices, .triangles = triangles}),
       BodyDef{.position = {0, 1.2, 0}, .shape = Sphere{0.4f}, .canSleep = false});
  for (int i = 0; i < 180; ++i) world.step(kDt);
  ASSERT_EQ(world.contacts().size(), 3u);
  for (const Contact& contact : world.contacts()) {
    EXPECT_EQ(contact.pointCount, 1);
    EXPECT_GT(contact.points[0].normalForce, 0.2f * 9.81f * world.mass(body));
  }
  EXPECT_LT(length(world.velocity(body).linear), 2e-3);
  EXPECT_LT(length(forceOn(world, body) + world.definition().gravity * world.mass(body)),
            0.01f * 9.81f * world.mass(body));
  EXPECT_EQ(world.report().contacts, 3u);
  EXPECT_EQ(world.report().pairs, 3u);
  // All of the run goes at once.
  world.excludeCollision(mesh, body);
  EXPECT_TRUE(world.contacts().empty());
  world.step(kDt);
  EXPECT_TRUE(world.contacts().empty());
  EXPECT_EQ(world.report().pairs, 0u);
  ASSERT_EQ(world.events().ends.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Sides, Order, testing::Bool());

/// Where a body sent off at `speed` along x comes to, on triangles and on a half space.
struct Sent {
  double meshX, planeX, highest, lowest;
};
Sent send(const Geometry& shape, double height, float speed, int steps) {
  Sent sent{0, 0, -1e9, 1e9};
  for (const bool onMesh : {true, false}) {
    World world;
    if (onMesh)
      addMesh(world, makeGrid(40, 0.25f, flat));
    else
      world.create(BodyDef{.type = BodyType::Static, .shape = HalfSpace{}});
    const BodyId id =
        world.create(BodyDef{.position = {-8, height, 0.03}, .linearVelocity = {speed, 0, 0}, .shape = shape});
    for (int i = 0; i < steps; ++i) {
      world.step(kDt);
      if (!onMesh) continue;
      sent.highest = std::max(sent.highest, world.pose(id).position.y);
      sent.lowest = std::min(sent.lowest, world.pose(id).position.y);
    }
    (onMesh ? sent.meshX : sent.planeX) = world.pose(id).position.x + 8;
  }
  return sent;
}

TEST(Surface, SlidingOverTrianglesIsSlidingOverAPlane) {
  const Sent sent = send(Box{0.3f, 0.2f, 0.3f}, 0.2, 8, 150);
  EXPECT_NEAR(sent.meshX, sent.planeX, 0.01 * sent.planeX);
  EXPECT_GT(sent.planeX, 6);
  EXPECT_LT(sent.highest, 0.2 + 1e-3);
  EXPECT_GT(sent.lowest, 0.2 - 4e-3);
}

TEST(Surface, RollingOverTrianglesIsRollingOverAPlane) {
  const Sent sent = send(Sphere{0.3f}, 0.3, 6, 150);
  EXPECT_NEAR(sent.meshX, sent.planeX, 0.01 * sent.planeX);
  EXPECT_LT(sent.highest, 0.3 + 1e-3);
  EXPECT_GT(sent.lowest, 0.3 - 4e-3);
}

TEST(Surface, EachTriangleHasItsMaterial) {
  World world;
  const auto data = makeGrid(20, 0.5f, flat, [](float, float z) { return z > 0 ? 1 : 0; });
  ShapeDef surface{.geometry = Mesh{data}, .material = {.friction = 9}};
  surface.materials = {{.friction = 0}, {.friction = 0.5f}};
  world.create(world.create(BodyDef{.type = BodyType::Static}), surface);
  const Material own{.friction = 0.5f};
  const BodyId ice = world.create(
      BodyDef{.position = {-6, 0.2, -3}, .linearVelocity = {3, 0, 0}, .shape = Box{0.3f, 0.2f, 0.3f}, .material = own});
  const BodyId rubber = world.create(
      BodyDef{.position = {-6, 0.2, 3}, .linearVelocity = {3, 0, 0}, .shape = Box{0.3f, 0.2f, 0.3f}, .material = own});
  for (int i = 0; i < 120; ++i) world.step(kDt);
  EXPECT_NEAR(world.velocity(ice).linear.x, 3, 0.01);
  EXPECT_NEAR(world.pose(rubber).position.x + 6, 9.0 / (2 * 0.5 * 9.81), 0.02);
}

TEST(Surface, AHeightFieldCarriesToo) {
  std::vector<float> heights(64, 0.25f);
  const auto data = makeHeightField({.columns = 8, .rows = 8, .heights = heights});
  World world;
  world.create(BodyDef{.type = BodyType::Static, .shape = HeightField{data}});
  const BodyId id = world.create(BodyDef{.position = {0.1, 1, 0.2}, .shape = Box{0.5f, 0.5f, 0.5f}});
  for (int i = 0; i < 120; ++i) world.step(kDt);
  EXPECT_NEAR(world.pose(id).position.y, 0.75, 4e-3);
  EXPECT_LT(length(world.velocity(id).linear), 2e-3);
}

/// A standing quad from the origin out to x = length, that looks along -z.
std::shared_ptr<const MeshData> makeDoor(float length, float height) {
  const std::vector<Vec3> vertices = {{0, -height, 0}, {length, -height, 0}, {length, height, 0}, {0, height, 0}};
  return makeMesh({.vertices = vertices, .triangles = std::vector<std::array<uint32_t, 3>>{{0, 2, 1}, {0, 3, 2}}});
}

// Its tip goes farther in a step than a ball is seen ahead of a body at rest.
TEST(Surface, ATurningDoorOfTrianglesTakesABallAlong) {
  for (const float spin : {1.0f, 5.0f})
    for (int k = 0; k < 8; ++k) {
      World world({.gravity = {}});
      const BodyId door = world.create(
          BodyDef{.type = BodyType::Kinematic, .angularVelocity = {0, spin, 0}, .shape = Mesh{makeDoor(2, 1)}});
      const double at = -0.7 - 0.03 * k;  // rad: ahead of the door, which turns from x towards -z
      const BodyId ball =
          world.create(BodyDef{.position = {1.8 * std::cos(at), 0, 1.8 * std::sin(at)}, .shape = Sphere{0.1f}});
      while (world.time() < 1.2f / spin) world.step(kDt);
      const Vec3d local = rotate(conjugate(world.pose(door).rotation), world.pose(ball).position);
      EXPECT_LT(local.z, 0) << spin << ", " << k << ": the door went through";
      EXPECT_GT(length(world.velocity(ball).linear), 0.8f * spin) << spin << ", " << k;
    }
}

TEST(Surface, MaterialsMayBeChangedWhileItIsUsed) {
  World world;
  const auto data = makeGrid(20, 0.5f, flat, [](float, float z) { return z > 0 ? 1 : 0; });
  ShapeDef surface{.geometry = Mesh{data}};
  surface.materials = {{.friction = 0}, {.friction = 0}};
  const ShapeId shape = world.create(world.create(BodyDef{.type = BodyType::Static}), surface);
  const BodyId box = world.create(BodyDef{.position = {-6, 0.2, 3},
                                          .linearVelocity = {3, 0, 0},
                                          .shape = Box{0.3f, 0.2f, 0.3f},
                                          .material = {.friction = 0.5f}});
  for (int i = 0; i < 30; ++i) world.step(kDt);
  EXPECT_NEAR(world.velocity(box).linear.x, 3, 0.01);
  const std::vector<Material> rough = {{.friction = 0}, {.friction = 0.5f}};
  world.setMaterials(shape, rough);
  EXPECT_EQ(world.materials(shape).at(1).friction, 0.5f);
  for (int i = 0; i < 60; ++i) world.step(kDt);
  EXPECT_LT(length(world.velocity(box).linear), 2e-3);
  EXPECT_THROW(world.setMaterials(shape, std::vector<Material>(1)), Error);
  EXPECT_EQ(world.materials(shape).size(), 2u);
  world.setMaterials(shape, {});
  EXPECT_TRUE(world.materials(shape).empty());
}

/// Heights at which a ball that sinks from 3 m enters and leaves a trigger, and whether that was all.
struct Visit {
  double enter = 0, leave = 0;
  int enters = 0, leaves = 0;
};
Visit sinkThrough(const Geometry& trigger) {
  World world({.gravity = {}});
  BodyDef def{.type = BodyType::Static};
  def.shapes.push_back({.geometry = trigger, .isTrigger = true});
  world.create(def);
  const BodyId ball =
      world.create(BodyDef{.position = {0.1, 3, 0.15}, .linearVelocity = {0, -1.2f, 0}, .shape = Sphere{0.25f}});
  Visit visit;
  for (int i = 0; i < 300; ++i) {
    const double at = world.pose(ball).position.y;
    world.step(kDt);
    if (!world.events().enters.empty()) ++visit.enters, visit.enter = at;
    if (!world.events().leaves.empty()) ++visit.leaves, visit.leave = at;
  }
  return visit;
}

TEST(SurfaceTrigger, AHullIsSolid) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
  const Visit visit = sinkThrough(Hull{makeHull({.points = corners})});
  EXPECT_EQ(visit.enters, 1);
  EXPECT_EQ(visit.leaves, 1);
  EXPECT_NEAR(visit.enter, 1.25, 0.03);
  EXPECT_NEAR(visit.leave, -1.25, 0.03);
}

TEST(SurfaceTrigger, AMeshIsItsTrianglesFromBothSides) {
  for (const float scale : {1.0f, -1.0f}) {  // the other way the front looks down
    const Visit visit = sinkThrough(Mesh{makeGrid(4, 0.5f, flat), {1, scale, 1}});
    EXPECT_EQ(visit.enters, 1);
    EXPECT_EQ(visit.leaves, 1);
    EXPECT_NEAR(visit.enter, 0.25, 0.03);
    EXPECT_NEAR(visit.leave, -0.25, 0.03);
  }
}

TEST(SurfaceTrigger, AHeightFieldIsSolidToItsThickness) {
  const std::vector<float> heights(64, 0.5f);
  const Visit visit =
      sinkThrough(HeightField{makeHeightField({.columns = 8, .rows = 8, .heights = heights, .thickness = 1})});
  EXPECT_EQ(visit.enters, 1);
  EXPECT_EQ(visit.leaves, 1);
  EXPECT_NEAR(visit.enter, 0.75, 0.03);
  EXPECT_NEAR(visit.leave, -0.5, 0.03);
}

TEST(Surface, MemoryMovesWithTheCentreOfMass) {
  World world;
  addMesh(world, makeGrid(4, 0.3f, flat));
  const BodyId id = world.create(BodyDef{.position = {0, 0.5, 0}, .shape = Box{0.5f, 0.5f, 0.5f}, .mass = 10});
  for (int i = 0; i < 60; ++i) world.step(kDt);
  world.setMassProperties(id, {.mass = 10, .center = {0.1f, 0, 0}, .inertia = {2, 2, 2, 0, 0, 0}});
  const Pose before = world.pose(id);
  for (int i = 0; i < 60; ++i) world.step(kDt);
  EXPECT_LT(length(world.pose(id).position - before.position), 1e-3);
}

}  // namespace
}  // namespace avbd
