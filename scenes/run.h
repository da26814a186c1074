// Running a scene in an engine and keeping what it showed.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/model.h"
#include "scenes/measure.h"

namespace avbd::scenes {

/// What a run showed, whichever engine made it. "Late" is the last second for penetration, the last 300 steps for gaps.
struct Evidence {
  Penetration penetration;                          ///< after the last step
  double penetrationPeak = 0, penetrationLate = 0;  ///< over the steps that were watched
  double gapPeak = 0, gapLate = 0, gapLast = 0;
  Displacement displacement;  ///< from before the first step
  double top = 0;             ///< highest centre of a dynamic body [m]
  double kineticEnergy = 0;   ///< [J]
  double speed = 0;           ///< of the fastest body after the last step [m/s]
  int escaped = 0;
  bool finite = true;
  std::map<std::string, double> own;  ///< the scene's own figures, by name
  std::vector<double> milliseconds;   ///< of each measured step
};

/// What to look at, and when.
struct Watch {
  bool penetration = false;  ///< after every step, not only after the last
  bool gap = false;
  std::function<bool(Vec3d)> escaped;  ///< tells from a body's position
  /// Called after every step, warm-up included, with the number of steps still to come.
  std::function<void(Evidence&, const Layout&, std::span<const Pose>, int)> observe;
};

/// An engine that holds a copy of a model.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual void prepare() {}  ///< what comes before a step and is not timed
  virtual void step(double dt) = 0;
  virtual void poses(std::span<Pose> out) const = 0;  ///< of the layout's bodies, in its order
};

struct Span {
  int warmup = 0, steps = 0;
  double dt = 1.0 / 60;
};

/// The engine steps in turn with the watching; only its step is timed.
Evidence observeRun(Engine& engine, const Layout& layout, const Watch& watch, const Span& span);

/// This project's engine over a model, which must outlive it. `before` is called before each step with the number of
/// steps made so far.
std::unique_ptr<Engine> avbdEngine(Model& model, const Layout& layout,
                                   std::function<void(Model&, int64_t)> before = {});

}  // namespace avbd::scenes
