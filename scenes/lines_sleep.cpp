// Acceptance, sleep: what a sleeping crowd costs, and what a ball rolled into it wakes.
#include <algorithm>
#include <chrono>

#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

constexpr int kSide = 45, kHeight = 5, kStacks = 2000;  ///< 10,000 boxes
constexpr double kApart = 4;

Model crowd(const Settings& settings) {
  Build build("crowd", settings);
  build.fixedBox("ground", {200, 1, 200}, {0, -1, 0});
  for (int k = 0; k < kStacks; ++k)
    for (int i = 0; i < kHeight; ++i)
      build.box("box", {0.5f, 0.5f, 0.5f}, {kApart * (k % kSide), 0.5 + i, kApart * (k / kSide)}, 1000);
  return build.take();
}

double secondsOf(Model& model) {
  const auto start = std::chrono::steady_clock::now();
  model.world.step(static_cast<float>(model.dt));
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Other work only ever adds to a step: the least of many is the step's own.
double leastSeconds(Model& model, int steps) {
  double least = 1e300;
  for (int i = 0; i < steps; ++i) least = std::min(least, secondsOf(model));
  return least;
}

/// How many bodies a ball wakes that is rolled from the side into the stack in the corner.
std::vector<Figure> rollIn(Model& model) {
  World& world = model.world;
  BodyDef ball;
  ball.position = {-2, 0.5, 0};
  ball.linearVelocity = {4, 0, 0};
  ball.angularVelocity = {0, 0, -8};
  ball.shape = Sphere{0.5f};
  world.create(ball);
  size_t woken = 0, strangers = 0;
  for (int i = 0; i < 40; ++i) {
    world.step(static_cast<float>(model.dt));
    for (const BodyId id : world.events().wakes) {
      ++woken;
      const Vec3d p = world.pose(id).position;
      strangers += p.x > 0.5 * kApart || p.z > 0.5 * kApart;
    }
  }
  const double asleep = static_cast<double>(world.report().asleep);
  return {atMost("woken_elsewhere", static_cast<double>(strangers), 0, "boxes"),
          {"woken", "", static_cast<double>(woken), kHeight, kHeight, "boxes"},
          {"asleep", "", asleep, kStacks * kHeight - kHeight, kStacks * kHeight - kHeight, "boxes"}};
}

std::vector<Figure> asleep(Settings settings) {
  settings.sleep = true;
  Model model = crowd(settings);
  double awake = 1e300;
  int steps = 0;
  for (; steps < 300 && model.world.report().asleep == 0; ++steps) {
    const double took = secondsOf(model);
    // The first steps make what later ones use again; the last one puts all away.
    if (steps > 5 && model.world.report().asleep == 0) awake = std::min(awake, took);
  }
  model.world.step(static_cast<float>(model.dt));
  const bool all = model.world.report().asleep == kStacks * kHeight;
  std::vector<Figure> figures = {holds("all_asleep", all),
                                 atMost("cost", leastSeconds(model, 200) / awake, 0.02, "of awake")};
  for (Figure& f : rollIn(model)) figures.push_back(std::move(f));
  return figures;
}

}  // namespace

std::vector<Line> sleepLines() { return {{"D", "asleep", asleep, ""}}; }

}  // namespace avbd::scenes
