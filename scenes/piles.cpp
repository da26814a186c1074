// Piles: the pyramid, five stacks, and the pit in three degrees of disorder.
#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

constexpr Box kUnit{0.5f, 0.5f, 0.5f};

Model pyramid30(const Settings& settings) {
  Build build("pyramid30", settings);
  build.ground();
  for (int r = 0; r < 30; ++r) {
    const int n = 30 - r;
    for (int i = 0; i < n; ++i)
      build.box("box_" + std::to_string(r) + "_" + std::to_string(i), kUnit, {(i - (n - 1) / 2.0) * 1.1, 0.5 + r, 0},
                1000);
  }
  return build.take();
}

Model fiveStacks(const Settings& settings) {
  Build build("stacks", settings);
  build.ground();
  for (int k = 0; k < 5; ++k)
    for (int i = 0; i < 10; ++i)
      build.box("box_" + std::to_string(k) + "_" + std::to_string(i), kUnit, {5.0 * (k - 2), 0.5 + i, 0}, 1000);
  return build.take();
}

void addPit(Build& build, float halfHeight) {
  const double y = halfHeight;
  build.ground();
  build.fixedBox("wall_left", {0.5f, halfHeight, 8}, {-7.5, y, 0});
  build.fixedBox("wall_right", {0.5f, halfHeight, 8}, {7.5, y, 0});
  build.fixedBox("wall_back", {8, halfHeight, 0.5f}, {0, y, -7.5});
  build.fixedBox("wall_front", {8, halfHeight, 0.5f}, {0, y, 7.5});
}

bool outsidePit(Vec3d p) { return !(p.y > 0 && p.x > -7 && p.x < 7 && p.z > -7 && p.z < 7); }

// Calls place(j, k, i) for all boxes in the order in which they are made.
template <class F>
void eachPitBox(F&& place) {
  for (int j = 0; j < 20; ++j)
    for (int k = 0; k < 10; ++k)
      for (int i = 0; i < 10; ++i) place(j, k, i);
}

std::string pitName(int j, int k, int i) {
  return "box_" + std::to_string(j) + "_" + std::to_string(k) + "_" + std::to_string(i);
}

Model pitGrid(const Settings& settings) {
  Build build("pit_grid", settings);
  addPit(build, 15);
  eachPitBox([&](int j, int k, int i) {
    build.box(pitName(j, k, i), kUnit, {(i - 4.5) * 1.1, 1 + 1.1 * j, (k - 4.5) * 1.1}, 1000);
  });
  return build.take();
}

Model bricks(const Settings& settings) {
  Build build("bricks", settings);
  addPit(build, 15);
  eachPitBox([&](int j, int k, int i) {
    const double dx = 0.15 * ((7 * j) % 5 - 2), dz = 0.15 * ((3 * j) % 5 - 2);
    build.box(pitName(j, k, i), kUnit, {(i - 4.5) * 1.1 + dx, 1 + 1.1 * j, (k - 4.5) * 1.1 + dz}, 1000);
  });
  return build.take();
}

Model pile(const Settings& settings) {
  Build build("pile", settings);
  addPit(build, 20);
  Draws draws(12345);
  eachPitBox([&](int j, int k, int i) {
    float u[5];
    for (float& value : u) value = draws.next();
    build.box(pitName(j, k, i), kUnit, {(i - 4.5) * 1.1, 5 + 1.5 * j, (k - 4.5) * 1.1}, 1000,
              {{u[0], 0, u[1]}, {3 * u[2], 3 * u[3], 3 * u[4]}});
  });
  return build.take();
}

std::vector<Figure> checkPit(const Evidence& e, double max, double mean) {
  return {atMost("penetration_max", e.penetration.max, max, "m"),
          atMost("penetration_mean", e.penetration.mean, mean, "m"), atMost("escaped", e.escaped, 0, "boxes"),
          holds("finite", e.finite)};
}

Scene pit(std::string name, std::string alias, std::string description, Model (*make)(const Settings&), int warmup) {
  Scene scene{std::move(name), std::move(alias), std::move(description), make, warmup, 300, {}, {}};
  scene.watch.escaped = outsidePit;
  return scene;
}

}  // namespace

std::vector<Scene> pileScenes() {
  std::vector<Scene> list;
  list.push_back({"pyramid30", "a", "pyramid of 465 boxes, base 30", pyramid30, 60, 300, {}, [](const Evidence& e) {
                    return std::vector<Figure>{atMost("penetration_max", e.penetration.max, 0.006, "m"),
                                               atMost("horizontal", e.displacement.horizontal, 0.020, "m"),
                                               holds("finite", e.finite)};
                  }});
  list.push_back({"stacks", "b", "five stacks of ten boxes", fiveStacks, 60, 300, {}, [](const Evidence& e) {
                    return std::vector<Figure>{atMost("penetration_max", e.penetration.max, 0.006, "m"),
                                               atMost("horizontal", e.displacement.horizontal, 0.020, "m"),
                                               holds("finite", e.finite)};
                  }});
  list.push_back(pit("pit_grid", "c", "pit with 2000 boxes as a perfect grid of columns", pitGrid, 60));
  // Twenty boxes rest on the lowest ones. The columns stay apart while none leaves by half of the 0.1 m between them.
  list.back().check = [](const Evidence& e) {
    std::vector<Figure> figures = checkPit(e, 0.012, 0.005);
    figures.push_back(atMost("horizontal", e.displacement.horizontal, 0.050, "m"));
    return figures;
  };
  list.push_back(pit("bricks", "c2", "pit with 2000 boxes in shifted layers", bricks, 60));
  list.back().check = [](const Evidence& e) { return checkPit(e, 0.012, 0.0025); };
  list.push_back(pit("pile", "c3", "pit with 2000 boxes dropped in disorder", pile, 240));
  list.back().check = [](const Evidence& e) { return checkPit(e, 0.060, 0.005); };
  return list;
}

}  // namespace avbd::scenes
