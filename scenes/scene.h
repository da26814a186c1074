// A scene: a function that builds a world, how to run it, and a check of the result; and the lines of acceptance.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/model.h"
#include "scenes/run.h"

namespace avbd::scenes {

/// What an experiment changes in every world that a scene or line builds; what is not set keeps its default.
struct Settings {
  std::optional<int> iterations, substeps, krylovIterations, simdWidth, workers;
  std::optional<PrimalSolver> primalSolver;
  std::optional<bool> sleep;  ///< off where it is not set
};

/// The definition with the settings applied.
WorldDef apply(const Settings& settings, WorldDef def = {});

/// One figure that a scene's check measured, against its bounds.
struct Figure {
  std::string name;    ///< e.g. "penetration_max"
  std::string params;  ///< e.g. "mu=0.5", empty if none
  double measured = 0;
  double lower = 0, upper = 0;  ///< passes if finite and lower <= measured <= upper
  std::string unit;
};

/// Unit of a time over that of a step of the same run. `avbd verify` holds it against its bounds, no test does.
inline constexpr const char* kOfAStep = "of a step";

bool passes(const Figure& figure);
Figure atMost(std::string name, double measured, double upper, std::string unit, std::string params = {});
/// Within target (1 - tolerance) .. target (1 + tolerance).
Figure within(std::string name, double measured, double target, double tolerance, std::string unit,
              std::string params = {});
/// A yes-or-no figure: 1 or 0, bounds 1 .. 1.
Figure holds(std::string name, bool yes, std::string params = {});

struct Scene {
  std::string name;
  std::string alias;  ///< its letter in the list of benchmark scenes; empty if none
  std::string description;
  std::function<Model(const Settings&)> make;
  int warmup = 60, steps = 300;
  Watch watch;
  std::function<std::vector<Figure>(const Evidence&)> check;
  /// What the scene does by itself before each step, warm-up included, by the number of steps made so far; may be
  /// empty.
  std::function<void(Model&, int64_t)> before{};
};

/// One line of acceptance.
struct Line {
  std::string list;  ///< "R", "J", "A", "S", "D"
  std::string name;
  std::function<std::vector<Figure>(const Settings&)> run;  ///< empty if skipped
  std::string skipReason;
};

const std::vector<Scene>& all();
const std::vector<Line>& lines();
/// By name or alias; null if there is none.
const Scene* find(std::string_view name);
const Line* findLine(std::string_view name);

/// Builds the scene and runs it in this engine.
Evidence run(const Scene& scene, const Settings& settings = {});

}  // namespace avbd::scenes
