// Acceptance, state: a world goes back to a snapshot and on from it as if nothing had been.
#include <algorithm>
#include <chrono>
#include <vector>

#include "scenes/allocations.h"
#include "scenes/build.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

/// A scene's model with the count of its steps, which Scene::before is told.
struct Run {
  const Scene& scene;
  Model model;
  int64_t made = 0;

  Run(const Scene& of, const Settings& settings) : scene(of), model(of.make(settings)) {}
  void step() {
    if (scene.before) scene.before(model, made);
    model.world.step(static_cast<float>(model.dt));
    ++made;
  }
  std::vector<uint64_t> hashes(int steps) {
    std::vector<uint64_t> all{model.world.hash()};
    for (int i = 0; i < steps; ++i) step(), all.push_back(model.world.hash());
    return all;
  }
};

int apart(const std::vector<uint64_t>& a, const std::vector<uint64_t>& b) {
  int count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

// Saved at some steps; run on; back, and on again; and the same in a second world that has not made a step.
Figure rollback(const Scene& scene, const Settings& settings) {
  constexpr size_t kLarge = 400;
  Run run(scene, settings);
  const bool large = run.model.bodies.size() > kLarge;
  const int further = large ? 4 : 20;
  const std::vector<int> moments = large ? std::vector<int>{12} : std::vector<int>{0, 21, 60};
  std::vector<std::byte> snapshot;
  int different = 0;
  for (const int moment : moments) {
    while (run.made < moment) run.step();
    const int64_t made = run.made;
    run.model.world.save(snapshot);
    const std::vector<uint64_t> first = run.hashes(further);
    Run second(scene, settings);
    for (Run* again : {&run, &second}) {
      again->model.world.restore(snapshot);
      again->made = made;
      different += apart(first, again->hashes(further));
    }
  }
  return atMost("hashes_apart", different, 0, "hashes", "scene=" + scene.name);
}

using Clock = std::chrono::steady_clock;

template <class F>
double secondsOf(F&& f) {
  const auto start = Clock::now();
  f();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// Size and time in the scene of shifted layers, in which all is contact.
std::vector<Figure> cost(const Settings& settings) {
  constexpr int kWarmup = 40, kSteps = 15;
  Run run(*find("c2"), settings);
  for (int i = 0; i < kWarmup; ++i) run.step();
  World& world = run.model.world;
  std::vector<std::byte> snapshot;
  for (int i = 0; i < 2; ++i) world.save(snapshot), world.restore(snapshot);
  uint64_t allocated = 0;
  std::vector<double> step, save, restore;
  for (int i = 0; i < kSteps; ++i) {
    step.push_back(secondsOf([&] { run.step(); }));
    world.save(snapshot);  // may grow
    const uint64_t before = allocationCount() ? allocationCount()() : 0;
    save.push_back(secondsOf([&] { world.save(snapshot); }));
    if (allocationCount()) allocated += allocationCount()() - before;
    restore.push_back(secondsOf([&] { world.restore(snapshot); }));
  }
  const double perBody = static_cast<double>(snapshot.size()) / static_cast<double>(world.bodyCount());
  std::vector<Figure> figures{atMost("bytes_per_body", perBody, 1000, "bytes", "scene=bricks"),
                              atMost("save", median(save) / median(step), 0.2, kOfAStep, "scene=bricks"),
                              atMost("restore", median(restore) / median(step), 0.2, kOfAStep, "scene=bricks")};
  if (allocationCount())
    figures.push_back(atMost("allocations", static_cast<double>(allocated), 0, "in 15 saves", "scene=bricks"));
  return figures;
}

std::vector<Figure> rollbackFigures(const Settings& settings) {
  std::vector<Figure> figures;
  for (const Scene& scene : all()) figures.push_back(rollback(scene, settings));
  for (Figure& figure : cost(settings)) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace

std::vector<Line> rollbackLines() { return {{"D", "rollback", rollbackFigures, ""}}; }

}  // namespace avbd::scenes
