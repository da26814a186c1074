// Acceptance, shapes: an arch of hulls, sliding over the inner edges of meshes and height fields.
#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>

#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/catalogue.h"
#include "scenes/trials.h"

namespace avbd::scenes {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kResting = 0.5;  ///< [s] in which a body that was put down finds its rest depth

double heightOf(const World& world, BodyId id) { return world.pose(id).position.y; }

std::vector<Figure> arch(const Settings& settings) {
  Model model = archOfVoussoirs(settings);
  const Layout layout = layoutOf(model.world);
  const BodyId keystone = model.bodies[1 + kVoussoirs / 2].id;
  const double start = heightOf(model.world, keystone);
  Watch watch;
  watch.penetration = true;
  const Evidence e = observeRun(*avbdEngine(model, layout), layout, watch, {0, 600, model.dt});
  return {atMost("keystone_sinks", start - heightOf(model.world, keystone), 0.030, "m"),
          atMost("displacement", e.displacement.total, 0.1, "m"), atMost("penetration", e.penetrationLate, 0.010, "m"),
          holds("finite", e.finite)};
}

// A flat surface of 20 x 20 squares about the origin, y = 0.
void addFlatMesh(Build& build) {
  constexpr uint32_t kSide = 21;
  std::vector<Vec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  for (uint32_t i = 0; i < kSide * kSide; ++i)
    vertices.push_back({static_cast<float>(i % kSide) - 10, 0, static_cast<float>(i / kSide) - 10});
  for (uint32_t z = 0; z + 1 < kSide; ++z)
    for (uint32_t x = 0; x + 1 < kSide; ++x) {
      const uint32_t a = z * kSide + x, b = a + 1, c = a + kSide, d = c + 1;
      triangles.push_back({a, c, d});
      triangles.push_back({a, d, b});
    }
  BodyDef def;
  def.type = BodyType::Static;
  def.shape = Mesh{makeMesh({.vertices = vertices, .triangles = triangles})};
  build.add("mesh", def);
}

// Two of 20 x 20 squares that meet at x = 0.
void addTwoFields(Build& build) {
  const std::vector<float> flat(21 * 21, 0.0f);
  const auto data = makeHeightField({.columns = 21, .rows = 21, .heights = flat});
  for (const double x : {-10.0, 10.0}) {
    BodyDef def;
    def.type = BodyType::Static;
    def.position = {x, 0, 0};
    def.shape = HeightField{data};
    build.add(x < 0 ? "field_left" : "field_right", def);
  }
}

struct Path {
  const char* name;
  Vec3d from;
  double heading;  ///< [rad] about y, from x
};

struct Body {
  const char* name;
  Geometry geometry;
};

// Largest vertical speed of a body that slides without friction: from rest it is given its speed, and from then on
// every step counts.
double slideOver(const Settings& settings, bool fields, const Geometry& geometry, const Path& path) {
  Build build("ghost_edges", settings);
  build.friction(0);
  if (fields) {
    addTwoFields(build);
  } else {
    addFlatMesh(build);
  }
  BodyDef def;
  def.position = path.from + Vec3d{0, 0.5, 0};
  def.rotation = turned({0, 1, 0}, path.heading);
  def.shape = geometry;
  def.mass = 10;
  const BodyId body = build.add("body", def);
  Model model = build.take();
  for (int i = 0; i < stepsFor(kResting, kDt); ++i) model.world.step(static_cast<float>(kDt));
  const Vec3d start = model.world.pose(body).position;
  Velocity velocity = model.world.velocity(body);
  velocity.linear = velocity.linear + Vec3{static_cast<float>(2 * std::cos(path.heading)), 0,
                                           static_cast<float>(-2 * std::sin(path.heading))};
  model.world.setVelocity(body, velocity);
  double worst = 0;
  for (int i = 0; i < stepsFor(4, kDt); ++i) {
    model.world.step(static_cast<float>(kDt));
    worst = std::max(worst, std::abs(static_cast<double>(model.world.velocity(body).linear.y)));
  }
  const Vec3d end = model.world.pose(body).position;
  return std::abs(length(end - start) - 8) < 0.05 && std::abs(end.y - 0.5) < 0.01 ? worst : NAN;  // it must get there
}

std::vector<Figure> ghostEdges(const Settings& settings) {
  const Path paths[] = {{"along_edges", {-4, 0, 0}, 0},
                        {"between", {-4, 0, 0.37}, 0},
                        {"diagonal", {-3, 0, -3}, -kPi / 4},
                        {"askew", {-4, 0, 1.3}, 0.3}};
  // As wide as a cell, and in no whole ratio to one.
  const Body bodies[] = {
      {"box", Box{0.5f, 0.5f, 0.5f}}, {"odd_box", Box{0.87f, 0.5f, 0.31f}}, {"sphere", Sphere{0.5f}}};
  std::vector<Figure> figures;
  for (const bool fields : {false, true})
    for (const Body& body : bodies)
      for (const Path& path : paths)
        figures.push_back(atMost("vertical_speed", slideOver(settings, fields, body.geometry, path), 1e-3, "m/s",
                                 std::string(fields ? "fields," : "mesh,") + body.name + "," + path.name));
  return figures;
}

}  // namespace

Model archOfVoussoirs(const Settings& settings) {
  Build build("arch", settings);
  build.ground();
  for (int i = 0; i < kVoussoirs; ++i) {
    const double from = kPi * i / kVoussoirs, to = kPi * (i + 1) / kVoussoirs, middle = 0.5 * (from + to);
    const Vec3d at{3 * std::cos(middle), 3 * std::sin(middle), 0};
    std::vector<Vec3> corners;
    for (const double radius : {2.7, 3.3})
      for (const double angle : {from, to})
        for (const double z : {-0.5, 0.5})
          corners.push_back(toFloat(Vec3d{radius * std::cos(angle), radius * std::sin(angle), z} - at));
    BodyDef def;
    def.position = at;
    def.shape = Hull{makeHull({.points = corners})};
    build.add("voussoir_" + std::to_string(i), def);
  }
  return build.take();
}

std::vector<Line> shapeLines() { return {{"R", "arch", arch, ""}, {"R", "ghost_edges", ghostEdges, ""}}; }

}  // namespace avbd::scenes
