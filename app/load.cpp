// Scenes by name and files by path.
#include "app/load.h"

#include <cmath>
#include <filesystem>

#include "app/commands.h"
#include "app/failure.h"
#include "app/number_text.h"
#include "io/mjcf.h"

namespace avbd::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestStep = 1;  // [s], of World::step
constexpr double kMostSteps = 1e8;

bool looksLikeFile(const std::string& name) {
  std::error_code ignored;
  const fs::path path(name);
  return path.has_extension() || name.find('/') != std::string::npos || fs::exists(path, ignored);
}

}  // namespace

Model loadModel(const RunArguments& a) {
  if (const scenes::Scene* scene = scenes::find(a.scene)) {
    if (a.keyframe) throw BadInput("--keyframe " + *a.keyframe + ": scene " + a.scene + " has no keyframes");
    return scene->make(a.settings);
  }
  if (!looksLikeFile(a.scene)) sceneNamed(a.scene);
  MjcfOptions options;
  options.world = scenes::apply(a.settings);
  options.keyframe = a.keyframe.value_or("");
  return readMjcf(a.scene, options);
}

Plan planRun(const RunArguments& a, const Model& model) {
  Plan plan;
  plan.dt = a.dt.value_or(model.dt);
  // As the world takes it: a double may vanish as a float.
  if (const float dt = static_cast<float>(plan.dt); !(dt > 0 && plan.dt <= kLongestStep)) {
    const std::string name = a.dt ? "--dt" : a.scene + ": the file's step";
    throw BadInput(name + " = " + digits(plan.dt, 9) + ": must be > 0 and at most 1 s");
  }
  const double time = a.time.value_or(model.duration);
  if (!(time >= 0 && std::isfinite(time))) throw BadInput("--time = " + digits(time, 9) + ": must be finite and >= 0");
  const double steps = std::round(time / plan.dt);
  if (!(steps <= kMostSteps))
    throw BadInput("--time = " + digits(time, 9) + ": " + digits(steps, 4) + " steps of " + digits(plan.dt, 9) +
                   " s, must be at most 1e8");
  plan.steps = time > 0 ? std::max<int64_t>(1, static_cast<int64_t>(steps)) : 0;
  if (!(a.fps > 0 && a.fps <= 1e6)) throw BadInput("--fps = " + digits(a.fps, 9) + ": must be > 0 and at most 1e6");
  return plan;
}

}  // namespace avbd::cli
