// Large scenes, for benchmarks alone: pyramids, rain on hills, ragdolls, a grid of joints, layers of any number of
// boxes.
#include <avbd/height_field.h>
#include <avbd/hull.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "scenes/build.h"
#include "scenes/large.h"
#include "scenes/trig.h"

namespace avbd::scenes {
namespace {

constexpr Box kUnit{0.5f, 0.5f, 0.5f};

void addPyramid(Build& build, int rows, Vec3d at) {
  for (int r = 0; r < rows; ++r)
    for (int i = 0; i < rows - r; ++i)
      build.box("box", kUnit, at + Vec3d{(i - (rows - r - 1) / 2.0) * 1.1, 0.5 + r, 0}, 1000);
}

Model pyramid(const Settings& settings, int rows) {
  Build build("pyramid" + std::to_string(rows), settings);
  build.ground();
  addPyramid(build, rows, {});
  return build.take();
}

// A hundred islands.
Model pyramids(const Settings& settings) {
  constexpr int kSide = 10, kRows = 6;
  Build build("pyramids_100", settings);
  build.ground();
  for (int n = 0; n < kSide * kSide; ++n) {
    addPyramid(build, kRows, {10.0 * (n % kSide - (kSide - 1) / 2.0), 0, 4.0 * (n / kSide - (kSide - 1) / 2.0)});
  }
  return build.take();
}

// What carries more rows sinks deeper and spreads wider.
std::vector<Figure> checkPyramid(const Evidence& e, int rows) {
  const double more = std::max(1.0, rows / 30.0);
  return {atMost("penetration_max", e.penetration.max, 0.006 * more, "m"),
          atMost("horizontal", e.displacement.horizontal, 0.020 * more * more * more, "m"),
          holds("stands", e.top > rows - 1), holds("finite", e.finite)};
}

Scene pyramidScene(int rows) {
  return {"pyramid" + std::to_string(rows),
          "",
          "pyramid of " + std::to_string(rows * (rows + 1) / 2) + " boxes, base " + std::to_string(rows),
          [rows](const Settings& s) { return pyramid(s, rows); },
          60,
          300,
          {},
          [rows](const Evidence& e) { return checkPyramid(e, rows); }};
}

constexpr int kCells = 64;  // of 1 m

// A bowl with bumps, so that all comes to lie and nothing leaves.
float hillHeight(double x, double z) {
  return static_cast<float>(0.015 * (x * x + z * z) + 0.3 * sine(0.8 * x) * cosine(0.7 * z));
}

void addHills(Build& build) {
  std::vector<float> heights;
  for (int r = 0; r <= kCells; ++r)
    for (int c = 0; c <= kCells; ++c) heights.push_back(hillHeight(c - kCells / 2.0, r - kCells / 2.0));
  BodyDef def;
  def.type = BodyType::Static;
  def.shape = HeightField{makeHeightField({.columns = kCells + 1, .rows = kCells + 1, .heights = heights})};
  build.add("hills", def);
}

std::shared_ptr<const HullData> pebble(Draws& draws) {
  std::vector<Vec3> points;
  while (points.size() < 24) {
    const Vec3 p{draws.next(), draws.next(), draws.next()};
    if (const float far = length(p); far > 0.1f) points.push_back(p * (0.45f / far));
  }
  return makeHull({.points = points, .maxVertices = 16});
}

// 10,000 spheres, capsules, boxes, cylinders and hulls, 25 x 25 x 16.
Model rain(const Settings& settings) {
  constexpr int kSide = 25, kLayers = 16;
  Build build("rain", settings);
  addHills(build);
  Draws draws(4711);
  const std::array<Geometry, 5> shapes{Sphere{0.4f}, Capsule{0.25f, 0.25f}, Box{0.4f, 0.3f, 0.35f},
                                       Cylinder{0.35f, 0.3f}, Hull{pebble(draws)}};
  for (int n = 0; n < kSide * kSide * kLayers; ++n) {
    const int column = n % kSide, row = n / kSide % kSide, layer = n / (kSide * kSide);
    BodyDef def;
    def.position = {1.3 * (column - (kSide - 1) / 2.0) + 0.03 * draws.next(), 9 + 1.25 * layer,
                    1.3 * (row - (kSide - 1) / 2.0) + 0.03 * draws.next()};
    def.rotation = turned({0, 1, 0}, 3 * draws.next()) * turned({1, 0, 0}, 3 * draws.next());
    def.shape = shapes[static_cast<size_t>(n + layer) % shapes.size()];
    build.add("drop", def);
  }
  return build.take();
}

bool throughHills(Vec3d p) {
  const double half = kCells / 2.0;
  return !(std::abs(p.x) < half && std::abs(p.z) < half && p.y > static_cast<double>(hillHeight(p.x, p.z)) - 0.3);
}

Scene rainScene() {
  Watch watch;
  watch.escaped = throughHills;
  return {"rain", "", "10,000 mixed shapes raining on a height field", rain, 300, 120, watch, [](const Evidence& e) {
            return std::vector<Figure>{atMost("penetration_max", e.penetration.max, 0.060, "m"),
                                       atMost("penetration_mean", e.penetration.mean, 0.005, "m"),
                                       atMost("escaped", e.escaped, 0, "bodies"), holds("finite", e.finite)};
          }};
}

// Balls 1 m apart in a vertical net that hangs from seven of its upper row.
Model jointGrid(const Settings& settings) {
  constexpr int kSide = 100, kHeld = 3;
  Build build("joint_grid", settings);
  build.filter(kGhost);
  std::vector<BodyId> nodes;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const Vec3d at{static_cast<double>(i), -static_cast<double>(j), 0};
      const BodyId id = build.ball("node", 0.4f, at, 1);
      if (j == 0 && std::abs(i - kSide / 2) <= kHeld) build.joint({}, id, at);
      if (i > 0) build.joint(nodes.back(), id, at - Vec3d{0.5, 0, 0});
      if (j > 0) build.joint(nodes[nodes.size() - kSide], id, at + Vec3d{0, 0.5, 0});
      nodes.push_back(id);
    }
  return build.take();
}

Scene jointGridScene() {
  Watch watch;
  watch.gap = true;
  return {"joint_grid",
          "",
          "grid of 100 x 100 balls and 19,807 ball joints",
          jointGrid,
          60,
          120,
          watch,
          [](const Evidence& e) {
            return std::vector<Figure>{atMost("gap", e.gapLate, 0.020, "m"), holds("finite", e.finite)};
          }};
}

constexpr int kLayers = 10;

int sideOf(int boxes) { return static_cast<int>(std::ceil(std::sqrt(boxes / static_cast<double>(kLayers)) - 1e-9)); }
double halfPit(int boxes) { return 0.55 * sideOf(boxes) + 1.5; }

// As the pit of shifted layers, ten of them, as wide as it takes.
Model layers(const Settings& settings, int boxes) {
  Build build("boxes_" + std::to_string(boxes), settings);
  build.ground();
  const double half = halfPit(boxes);
  for (const double side : {-1.0, 1.0}) {
    build.fixedBox("wall", {0.5f, 10, static_cast<float>(half) + 1}, {side * (half + 0.5), 10, 0});
    build.fixedBox("wall", {static_cast<float>(half) + 1, 10, 0.5f}, {0, 10, side * (half + 0.5)});
  }
  const int side = sideOf(boxes);
  for (int n = 0; n < boxes; ++n) {
    const int j = n / (side * side), k = n / side % side, i = n % side;
    const double dx = 0.15 * ((7 * j) % 5 - 2), dz = 0.15 * ((3 * j) % 5 - 2), middle = (side - 1) / 2.0;
    build.box("box", kUnit, {(i - middle) * 1.1 + dx, 0.6 + 1.1 * j, (k - middle) * 1.1 + dz}, 1000);
  }
  return build.take();
}

Scene layersScene(int boxes) {
  const double half = halfPit(boxes);
  Watch watch;
  watch.escaped = [half](Vec3d p) { return !(p.y > 0 && std::abs(p.x) < half && std::abs(p.z) < half); };
  const int steps = std::clamp(3000000 / boxes, 20, 300);
  return {"boxes_" + std::to_string(boxes),
          "",
          std::to_string(boxes) + " boxes in ten shifted layers: cost against number",
          [boxes](const Settings& s) { return layers(s, boxes); },
          60,
          steps,
          watch,
          [](const Evidence& e) {
            return std::vector<Figure>{atMost("penetration_max", e.penetration.max, 0.012, "m"),
                                       atMost("penetration_mean", e.penetration.mean, 0.0025, "m"),
                                       atMost("escaped", e.escaped, 0, "boxes"), holds("finite", e.finite)};
          }};
}

}  // namespace

std::vector<Scene> crowdScenes() {
  std::vector<Scene> list{pyramidScene(50),
                          pyramidScene(100),
                          {"pyramids_100",
                           "",
                           "100 pyramids of 21 boxes",
                           pyramids,
                           60,
                           300,
                           {},
                           [](const Evidence& e) { return checkPyramid(e, 6); }},
                          rainScene(),
                          jointGridScene()};
  for (const int boxes : {100, 300, 1000, 3000, 10000, 30000, 100000}) list.push_back(layersScene(boxes));
  return list;
}

}  // namespace avbd::scenes
