// A large world: a hundred thousand boxes that sleep and a thousand that do not; and the thousand alone.
#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

constexpr Box kUnit{0.5f, 0.5f, 0.5f};
constexpr int kSleepers = 100000, kRow = 320;

/// A hundred stacks of ten, which stay awake.
void addAwake(Build& build) {
  for (int k = 0; k < 100; ++k)
    for (int i = 0; i < 10; ++i) {
      const BodyId id = build.box("awake", kUnit, {3.0 * (k % 10), 0.5 + i, 3.0 * (k / 10)}, 1000);
      build.world().setCanSleep(id, false);
    }
}

Model awakeAlone(const Settings& settings) {
  Build build("awake_alone", settings);
  build.fixedBox("ground", {1000, 1, 1000}, {0, -1, 0});
  addAwake(build);
  return build.take();
}

Model sleepers(const Settings& settings) {
  Build build("sleepers", settings);
  build.fixedBox("ground", {1000, 1, 1000}, {0, -1, 0});
  addAwake(build);
  for (int i = 0; i < kSleepers; ++i) {
    const BodyId id = build.box("asleep", kUnit, {1.5 * (i % kRow) - 240, 0.5, 1.5 * (i / kRow) + 40}, 1000);
    build.world().putToSleep(id);
  }
  return build.take();
}

std::vector<Figure> check(const Evidence& e) {
  return {atMost("penetration_max", e.penetration.max, 0.006, "m"), holds("finite", e.finite)};
}

}  // namespace

std::vector<Scene> sleeperScenes() {
  return {{"sleepers", "", "100,000 boxes asleep beside a hundred stacks of ten", sleepers, 60, 300, {}, check},
          {"awake_alone", "", "the hundred stacks of ten of `sleepers` alone", awakeAlone, 60, 300, {}, check}};
}

}  // namespace avbd::scenes
