// Size and time of snapshots, beside the step's: snapshot_bench [SCENE...] [--steps N].
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Figures {
  size_t bodies = 0, pairs = 0, points = 0, bytes = 0;
  double save = 0, restore = 0, step = 0;  ///< [ms], medians
  bool same = true;                        ///< after each restore the hash was that of the saved world
};

Figures measure(const avbd::scenes::Scene& scene, int steps) {
  avbd::Model model = scene.make({});
  const float dt = static_cast<float>(model.dt);
  int64_t made = 0;
  const auto step = [&] {
    if (scene.before) scene.before(model, made);
    if (model.before) model.before(model, made);
    model.world.step(dt);
    ++made;
  };
  for (int i = 0; i < scene.warmup; ++i) step();
  Figures figures;
  std::vector<double> save, restore, each;
  std::vector<std::byte> bytes;
  model.world.save(bytes), model.world.restore(bytes), model.world.restore(bytes);
  for (int i = 0; i < steps; ++i) {
    auto start = Clock::now();
    step();
    each.push_back(since(start));
    const uint64_t hash = model.world.hash();
    start = Clock::now();
    model.world.save(bytes);
    save.push_back(since(start));
    start = Clock::now();
    model.world.restore(bytes);
    restore.push_back(since(start));
    figures.same = figures.same && model.world.hash() == hash;
  }
  figures.bodies = model.world.bodyCount();
  figures.pairs = model.world.report().pairs, figures.points = model.world.report().points;
  figures.bytes = bytes.size();
  figures.save = median(save), figures.restore = median(restore), figures.step = median(each);
  return figures;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> names;
  int steps = 60;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--steps") == 0 && i + 1 < argc)
      steps = std::max(1, std::atoi(argv[++i]));
    else
      names.push_back(argv[i]);
  }
  if (names.empty()) names = {"a", "b", "c", "c2", "c3", "net", "ragdolls"};
  std::printf("%-14s %6s %6s %6s %9s %6s %8s %8s %8s %7s %7s\n", "scene", "bodies", "pairs", "points", "bytes", "/body",
              "save ms", "rest. ms", "step ms", "save", "restore");
  for (const std::string& name : names) {
    const avbd::scenes::Scene* scene = avbd::scenes::find(name);
    if (!scene) {
      std::fprintf(stderr, "snapshot_bench: no scene %s\n", name.c_str());
      return 2;
    }
    const Figures f = measure(*scene, steps);
    std::printf("%-14s %6zu %6zu %6zu %9zu %6.0f %8.3f %8.3f %8.3f %7.3f %7.3f%s\n", scene->name.c_str(), f.bodies,
                f.pairs, f.points, f.bytes, static_cast<double>(f.bytes) / static_cast<double>(f.bodies), f.save,
                f.restore, f.step, f.save / f.step, f.restore / f.step, f.same ? "" : "  NOT THE SAME");
  }
}
