// Acceptance: everything in one pit.
#include <algorithm>

#include "scenes/catalogue.h"
#include "scenes/crossings.h"
#include "scenes/measure.h"
#include "scenes/mixed.h"

namespace avbd::scenes {
namespace {

std::vector<Figure> mixed(const Settings& settings) {
  constexpr int kSteps = 450, kWatched = 30;
  Settings with = settings;
  if (!with.sleep) with.sleep = true;
  Build build("mixed", with);
  addPit(build, 1.5f, 4);
  addMixture(build, {.boxes = 200, .ragdolls = 20, .cloths = 5, .softs = 10}, 1.5f, 0.3);
  World& world = build.world();
  const Layout layout = layoutOf(world);
  double deepest = 0;
  int crossed = 0;
  bool finite = true;
  for (int i = 0; i < kSteps && finite; ++i) {
    world.step(1.0f / 60);
    if (i % kWatched != kWatched - 1) continue;
    finite = isFinite(world);
    deepest = std::max(deepest, penetrationOf(layout, posesOf(world, layout)).max);
    crossed += crossings(world) > 0;
  }
  return {holds("finite", finite), atMost("penetration", deepest, 0.01, "m"),
          atMost("watched_steps_with_crossings", crossed, 0, ""),
          atMost("speed_at_rest", speedMax(world), 0.05, "m/s")};
}

}  // namespace

std::vector<Line> mixedLines() { return {{"S", "mixed", mixed, ""}}; }

}  // namespace avbd::scenes
