// One shape of each kind rolls into a valley: hull, rounded box, cylinder, cone, ellipsoid; a mesh stands in the
// middle.
#include <avbd/avbd.h>

#include <algorithm>
#include <cstdio>
using namespace avbd;

namespace {

/// A round valley of 41 x 41 heights, half a metre apart.
HeightField makeValley() {
  constexpr int kSide = 41;
  std::vector<float> heights;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const float x = 0.5f * float(column - 20), z = 0.5f * float(row - 20);
      heights.push_back(0.05f * (x * x + z * z));
    }
  return {makeHeightField({.columns = kSide, .rows = kSide, .spacingX = 0.5f, .spacingZ = 0.5f, .heights = heights})};
}

/// A pyramid with a square base, as triangles; anticlockwise seen from outside.
Mesh makePyramid() {
  const std::vector<Vec3> vertices{{1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, {-1, 0, 1}, {0, 1, 0}};
  const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 4}, {1, 2, 4}, {2, 3, 4},
                                                       {3, 0, 4}, {0, 2, 1}, {0, 3, 2}};
  return {makeMesh({.vertices = vertices, .triangles = triangles})};
}

/// The hull of the corners of a box with one corner cut off, and a point inside that it leaves out.
Hull makeStone() {
  const std::vector<Vec3> points{{-0.4f, -0.3f, -0.4f}, {0.4f, -0.3f, -0.4f}, {-0.4f, 0.3f, -0.4f}, {0.4f, 0.3f, -0.4f},
                                 {-0.4f, -0.3f, 0.4f},  {0.4f, -0.3f, 0.4f},  {-0.4f, 0.3f, 0.4f},  {0.1f, 0.3f, 0.4f},
                                 {0.4f, 0, 0.4f},       {0.4f, 0.3f, 0.1f},   {0.1f, 0.1f, 0.1f}};
  return {makeHull({.points = points})};
}

}  // namespace

int main() {
  World world({.gravity = {0, -9.81f, 0}});
  // What is round would roll for ever: rolling friction lets it come to rest. Both of a pair must have it.
  const Material rough{.friction = 0.6f, .rollingFriction = 0.03f};
  world.create(BodyDef{.type = BodyType::Static, .shape = makeValley(), .material = rough});
  world.create(BodyDef{.type = BodyType::Static, .position = {0, -0.2, 0}, .shape = makePyramid()});

  const Hull stone = makeStone();
  std::printf("the stone: %zu corners, %zu faces, %.3f m^3\n", stone.data->vertices().size(),
              stone.data->faces().size(), double(stone.data->massProperties(1).mass));
  const struct {
    const char* name;
    Geometry geometry;
  } kinds[] = {{"hull", stone},
               {"hull at twice the size", Hull{stone.data, {2, 2, 2}}},
               {"rounded box", Box{0.3f, 0.2f, 0.3f, 0.1f}},
               {"cylinder", Cylinder{0.3f, 0.4f}},
               {"cone", Cone{0.4f, 0.4f}},
               {"ellipsoid", Ellipsoid{0.5f, 0.3f, 0.3f}}};
  std::vector<BodyId> bodies;
  for (const auto& kind : kinds) {
    const double x = 2.5 * (double(bodies.size() % 3) - 1), z = bodies.size() < 3 ? -4 : 4;
    bodies.push_back(world.create(BodyDef{.position = {x, 3, z}, .shape = kind.geometry, .material = rough}));
  }
  for (int i = 0; i < 1200; ++i) world.step(1.0f / 60);

  bool good = true;
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Vec3d p = world.pose(bodies[i]).position;
    const Velocity v = world.velocity(bodies[i]);
    std::printf("%-24s %8.1f kg  at (%6.2f, %5.2f, %6.2f)  %.4f m/s\n", kinds[i].name, double(world.mass(bodies[i])),
                p.x, p.y, p.z, double(length(v.linear)));
    good = good && length(v.linear) < 0.05f && p.y > 0 && p.y < 3;
  }
  float deepest = 0;
  for (const Contact& contact : world.contacts())
    for (int k = 0; k < contact.pointCount; ++k) deepest = std::max(deepest, -contact.points[k].separation);
  std::printf("%zu contacts, deepest overlap %.1f mm\n", world.contacts().size(), 1000 * double(deepest));
  good = good && deepest < 0.02f;
  std::printf("%s\n", good ? "all at rest" : "something moves or sank");
  return good ? 0 : 1;
}
