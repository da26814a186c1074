// Soft slabs of one height and any width on the ground: cost of a soft body against its size.
#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/large.h"

namespace avbd::scenes {
namespace {

constexpr int kLayers = 6, kTetsOfCell = 5;
constexpr float kCell = 0.1f;

int sideOf(int tets) {
  return static_cast<int>(std::lround(std::sqrt(tets / static_cast<double>(kLayers * kTetsOfCell))));
}

Model slab(const Settings& settings, int tets) {
  Build build("slab_" + std::to_string(tets), settings);
  build.ground();
  const int side = sideOf(tets);
  const float half = kCell * static_cast<float>(side) / 2, height = kCell * kLayers / 2;
  build.soft("slab", {.mesh = makeTetBox({half, height, half}, side, kLayers, side),
                      .pose = {{0, double{height} + 0.05, 0}, {}},
                      .material = {.youngsModulus = 1e6f}});
  return build.take();
}

/// Its own weight presses it by 1.8 mm; what it bounced by has died away.
std::vector<Figure> checkSlab(const Evidence& e) {
  return {holds("finite", e.finite), atMost("penetration", e.penetration.max, 0.005, "m"),
          Figure{"top", "", e.top, 0.58, 0.63, "m"}};
}

Scene slabScene(int tets) {
  const int side = sideOf(tets);
  return {"slab_" + std::to_string(tets),
          "",
          "a soft slab of " + std::to_string(side * side * kLayers * kTetsOfCell) + " tetrahedra on the ground",
          [tets](const Settings& s) { return slab(s, tets); },
          60,
          std::clamp(2000000 / tets, 20, 300),
          {},
          checkSlab};
}

}  // namespace

std::vector<Scene> slabScenes() {
  std::vector<Scene> list;
  for (const int tets : {1000, 3000, 10000, 30000, 100000}) list.push_back(slabScene(tets));
  return list;
}

}  // namespace avbd::scenes
