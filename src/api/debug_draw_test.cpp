// What debugDraw gives a renderer: counts, places and directions for every type of shape.
#include <avbd/debug_draw.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace avbd {
namespace {

std::shared_ptr<const HullData> tetrahedron() {
  static const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return makeHull({points});
}

std::shared_ptr<const MeshData> square() {
  static const std::vector<Vec3> points{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
  static const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  return makeMesh({points, triangles});
}

std::shared_ptr<const HeightFieldData> hills() {
  static const std::vector<float> heights{0, 1, 0, 0.5f, 0, 0.25f};
  return makeHeightField({.columns = 3, .rows = 2, .heights = heights});
}

std::vector<Geometry> bounded() {
  return {Sphere{0.5f},
          Capsule{0.25f, 0.75f},
          Box{0.1f, 0.2f, 0.3f},
          Box{0.1f, 0.2f, 0.3f, 0.05f},
          Cylinder{0.5f, 0.25f},
          Cylinder{0.5f, 0.25f, 0.1f},
          Cone{0.5f, 1},
          Cone{0.5f, 1, 0.1f},
          Ellipsoid{0.1f, 0.2f, 0.3f},
          Hull{tetrahedron()},
          Hull{tetrahedron(), {1, -2, 1}, 0.05f}};
}

/// Six times the volume that outward triangles enclose (divergence theorem).
double volume(const DebugLists& lists) {
  double sum = 0;
  for (size_t i = 0; i < lists.triangles.size(); i += 3) {
    const Vec3 a = lists.triangles[i].position, b = lists.triangles[i + 1].position,
               c = lists.triangles[i + 2].position;
    sum += static_cast<double>(dot(a, cross(b, c))) / 6;
  }
  return sum;
}

DebugLists drawn(const Geometry& geometry, const DebugDrawOptions& options, const Pose& pose = {}) {
  DebugLists lists;
  debugDraw(geometry, pose, 0xff123456, lists, options);
  return lists;
}

TEST(DebugDraw, SolidTrianglesEncloseTheShapesVolume) {
  const DebugDrawOptions options{.wire = false, .solid = true, .segments = 128};
  const double pi = M_PI;
  EXPECT_NEAR(volume(drawn(Sphere{0.5f}, options)), 4 * pi / 3 / 8, 1e-3);
  EXPECT_NEAR(volume(drawn(Capsule{0.25f, 0.75f}, options)), pi / 16 * 1.5 + 4 * pi / 3 / 64, 1e-3);
  EXPECT_NEAR(volume(drawn(Box{0.1f, 0.2f, 0.3f}, options)), 0.048, 1e-6);
  EXPECT_NEAR(volume(drawn(Cylinder{0.5f, 0.25f}, options)), pi / 8, 1e-3);
  EXPECT_NEAR(volume(drawn(Cone{0.5f, 1}, options)), pi / 4 * 2 / 3, 1e-3);
  EXPECT_NEAR(volume(drawn(Ellipsoid{0.1f, 0.2f, 0.3f}, options)), 4 * pi / 3 * 0.006, 1e-4);
  EXPECT_NEAR(volume(drawn(Hull{tetrahedron()}, options)), 1.0 / 6, 1e-6);
  EXPECT_NEAR(volume(drawn(Hull{tetrahedron(), {2, -3, 1}}, options)), 1, 1e-6) << "mirrored: still outwards";
  // Steiner: a cylinder swept by a ball: V + A r + M r^2 + 4 pi / 3 r^3 with M = pi (h + pi R), h the whole height.
  const double R = 0.5, h = 0.5, r = 0.1;
  EXPECT_NEAR(
      volume(drawn(Cylinder{0.5f, 0.25f, 0.1f}, options)),
      pi * R * R * h + (2 * pi * R * h + 2 * pi * R * R) * r + pi * (h + pi * R) * r * r + 4 * pi / 3 * r * r * r,
      2e-3);
}

TEST(DebugDraw, WireHasTheEdges) {
  DebugDrawOptions options{.segments = 16};
  EXPECT_EQ(drawn(Sphere{1}, options).lines.size(), 2u * 3 * 16);
  EXPECT_EQ(drawn(Capsule{1, 1}, options).lines.size(), 2u * (2 * 16 + 4 * 8 + 4));
  EXPECT_EQ(drawn(Box{}, options).lines.size(), 2u * 12);
  EXPECT_EQ(drawn(Box{1, 1, 1, 0.1f}, options).lines.size(), 2u * 24);
  EXPECT_EQ(drawn(Cylinder{}, options).lines.size(), 2u * (2 * 16 + 4));
  EXPECT_EQ(drawn(Cone{}, options).lines.size(), 2u * (16 + 4));
  EXPECT_EQ(drawn(Hull{tetrahedron()}, options).lines.size(), 2u * 6);
  EXPECT_EQ(drawn(HalfSpace{}, options).lines.size(), 2u * 7);
  EXPECT_EQ(drawn(Mesh{square()}, options).lines.size(), 2u * 6);
  EXPECT_EQ(drawn(HeightField{hills()}, options).lines.size(), 2u * 12);
  options.wire = false;
  EXPECT_EQ(drawn(Box{}, options).lines.size(), 0u);
  options.solid = true;
  EXPECT_EQ(drawn(Mesh{square()}, options).triangles.size(), 3u * 2);
  EXPECT_EQ(drawn(HeightField{hills()}, options).triangles.size(), 3u * 4);
  EXPECT_EQ(drawn(HalfSpace{}, options).triangles.size(), 3u * 2);
}

TEST(DebugDraw, EverythingIsFiniteAndMovesWithThePose) {
  const DebugDrawOptions options{.wire = true, .solid = true};
  std::vector<Geometry> all = bounded();
  all.insert(all.end(), {HalfSpace{}, Mesh{square(), {1, -1, 2}}, HeightField{hills(), {2, 3, 4}}, Capsule{0.5f, 0}});
  const Pose pose{{1, 2, 3}, {0.5f, 0.5f, 0.5f, 0.5f}};
  for (const Geometry& geometry : all) {
    const DebugLists here = drawn(geometry, options), there = drawn(geometry, options, pose);
    ASSERT_EQ(here.lines.size(), there.lines.size());
    ASSERT_EQ(here.triangles.size(), there.triangles.size());
    EXPECT_GT(here.lines.size(), 0u) << geometry.index();
    EXPECT_GT(here.triangles.size(), 0u) << geometry.index();
    for (const auto* lists : {&here.lines, &here.triangles}) {
      const auto& moved = lists == &here.lines ? there.lines : there.triangles;
      for (size_t i = 0; i < lists->size(); ++i) {
        const Vec3 p = (*lists)[i].position;
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << geometry.index();
        const Vec3d q = pose.position + rotate(pose.rotation, toDouble(p));
        ASSERT_LT(length(toDouble(moved[i].position) - q), 1e-4) << geometry.index();
        ASSERT_EQ(moved[i].color, 0xff123456u);
      }
    }
  }
}

World worldOf(const Geometry& geometry, const Pose& pose, BodyType type) {
  World world;
  BodyDef def;
  def.type = type;
  def.position = pose.position;
  def.rotation = pose.rotation;
  def.shape = geometry;
  world.create(def);
  return world;
}

TEST(DebugDraw, BoundsHoldTheShapeTightly) {
  const Quat turn{0.8f, 0.2f, -0.4f, 0.4f};
  const DebugDrawOptions solid{.wire = false, .solid = true, .segments = 200};
  const DebugDrawOptions bounds{.wire = false, .bounds = true};
  for (const Geometry& geometry : bounded()) {
    const Pose pose{{5, -2, 1}, turn};
    const World world = worldOf(geometry, pose, BodyType::Kinematic);
    DebugLists box, body;
    debugDraw(world, box, bounds);
    debugDraw(world, body, solid);
    ASSERT_EQ(box.lines.size(), 24u) << geometry.index();
    float Vec3::*const axes[] = {&Vec3::x, &Vec3::y, &Vec3::z};
    for (float Vec3::*const axis : axes) {
      float low = INFINITY, high = -INFINITY, boxLow = INFINITY, boxHigh = -INFINITY;
      for (const auto& v : body.triangles)
        low = std::min(low, v.position.*axis), high = std::max(high, v.position.*axis);
      for (const auto& v : box.lines)
        boxLow = std::min(boxLow, v.position.*axis), boxHigh = std::max(boxHigh, v.position.*axis);
      EXPECT_NEAR(low, boxLow, 2e-3) << geometry.index();
      EXPECT_NEAR(high, boxHigh, 2e-3) << geometry.index();
    }
  }
}

TEST(DebugDraw, ContactsJointsAndTheRest) {
  World world;
  BodyDef ground;
  ground.type = BodyType::Static;
  ground.shape = HalfSpace{};
  world.create(ground);
  BodyDef box;
  box.shape = Box{0.5f, 0.5f, 0.5f};
  box.position = {10, 0.5, 0};
  const BodyId a = world.create(box);
  box.position = {20, 0.5, 0};
  box.linearVelocity = {0, 0, 2};
  const BodyId b = world.create(box);
  world.create(BallJoint{.bodyA = a, .frameA = {{0, 0, 0.5}, {}}, .frameB = {{10, 0.5, 0.5}, {}}});
  world.step(1.0f / 60);
  const DebugDrawOptions nothing{.wire = false, .origin = {10, 0, 0}};
  DebugLists lists;
  debugDraw(world, lists, nothing);
  EXPECT_TRUE(lists.lines.empty() && lists.triangles.empty() && lists.points.empty());

  DebugDrawOptions options = nothing;
  options.contacts = true;
  debugDraw(world, lists, options);
  ASSERT_EQ(lists.points.size(), 8u);
  EXPECT_NEAR(std::fabs(lists.points[0].position.x), 0.5, 1e-3) << "about the origin";
  double force = 0;
  for (size_t i = 0; i < lists.lines.size(); i += 2)
    if (lists.lines[i].color == 0xffff5a36u)
      force += static_cast<double>((lists.lines[i + 1].position - lists.lines[i].position).y) / options.lengthPerNewton;
  double carried = 0;  // by the ground, upwards, whichever of the two is A
  for (const Contact& c : world.contacts())
    for (int i = 0; i < c.pointCount; ++i) {
      const ContactPoint& p = c.points[static_cast<size_t>(i)];
      carried += static_cast<double>((p.normalForce * c.normal + p.frictionForce).y);
    }
  EXPECT_GT(std::fabs(carried), 1000);
  EXPECT_NEAR(force, carried, 1e-3 * std::fabs(carried));

  lists.clear();
  options = nothing;
  options.joints = options.centersOfMass = options.velocities = options.bodyIds = true;
  debugDraw(world, lists, options);
  EXPECT_EQ(lists.points.size(), 1u);
  EXPECT_EQ(lists.textCount(), 3u);
  EXPECT_EQ(lists.text(2).text, std::to_string(b.index));
  EXPECT_GE(lists.lines.size(), 2u * (2 + 6));

  options = nothing;
  options.wire = options.islands = true;
  lists.clear();
  debugDraw(world, lists, options);
  std::vector<DebugColor> colors;
  for (const auto& v : lists.lines)
    if (colors.empty() || colors.back() != v.color) colors.push_back(v.color);
  EXPECT_EQ(colors.size(), 3u) << "ground and two islands";
}

TEST(DebugDraw, RefusesOptionsOutOfRange) {
  DebugLists lists;
  EXPECT_THROW(debugDraw(Sphere{}, {}, 0, lists, {.segments = 2}), Error);
  EXPECT_THROW(debugDraw(World(), lists, {.planeHalf = NAN}), Error);
  EXPECT_THROW(debugDraw(World(), lists, {.origin = {INFINITY, 0, 0}}), Error);
}

TEST(DebugDraw, RefusesGeometryAndPosesThatNoWorldHolds) {
  DebugLists lists;
  const DebugDrawOptions options{.wire = true, .solid = true};
  for (const Geometry& geometry : {Geometry{Hull{}}, Geometry{Mesh{}}, Geometry{HeightField{}}, Geometry{Sphere{NAN}},
                                   Geometry{Box{1, -1, 1}}, Geometry{Hull{tetrahedron(), {0, 1, 1}}}})
    EXPECT_THROW(debugDraw(geometry, {}, 0, lists, options), Error) << geometry.index();
  EXPECT_THROW(debugDraw(Sphere{}, {{NAN, 0, 0}, {}}, 0, lists, options), Error);
  EXPECT_THROW(debugDraw(Sphere{}, {{}, {0, 0, 0, 0}}, 0, lists, options), Error);
  EXPECT_THROW(debugDraw(Sphere{}, {{}, {NAN, 0, 0, 0}}, 0, lists, options), Error);
  EXPECT_TRUE(lists.lines.empty() && lists.triangles.empty());
  // Large units: as the world itself.
  World world({.lengthUnit = 1e4f});
  world.create(BodyDef{.type = BodyType::Static, .shape = Sphere{1e8f}});
  debugDraw(world, lists, options);
  const size_t drawnOnce = lists.lines.size();
  debugDraw(Sphere{1e8f}, {}, 0, lists, options);
  EXPECT_EQ(lists.lines.size(), 2 * drawnOnce);
}

}  // namespace
}  // namespace avbd
