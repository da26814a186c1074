// Stepping an engine and looking at it between the steps.
#include "scenes/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "scenes/scene.h"

namespace avbd::scenes {
namespace {

constexpr int kLateGap = 300;

class AvbdEngine final : public Engine {
 public:
  using Before = std::function<void(Model&, int64_t)>;
  AvbdEngine(Model& model, const Layout& layout, Before before)
      : model_(model), layout_(layout), before_(std::move(before)) {}
  void prepare() override {
    if (before_) before_(model_, steps_);
    ++steps_;
  }
  void step(double dt) override { model_.world.step(static_cast<float>(dt)); }
  void poses(std::span<Pose> out) const override { model_.world.getPoses(layout_.bodies, out); }

 private:
  Model& model_;
  const Layout& layout_;
  Before before_;
  int64_t steps_ = 0;
};

void raise(double& peak, double value) {
  if (!(value <= peak)) peak = value;  // a NaN is kept
}

void watchStep(Evidence& e, const Layout& layout, const Watch& watch, std::span<const Pose> poses, double left) {
  if (watch.penetration) {
    const double depth = penetrationOf(layout, poses).max;
    raise(e.penetrationPeak, depth);
    if (left < 1) raise(e.penetrationLate, depth);
  }
}

void finishRun(Evidence& e, const Layout& layout, const Watch& watch, std::span<const Pose> poses) {
  e.finite = e.finite && isFinite(poses);
  e.penetration = penetrationOf(layout, poses);
  e.gapLast = jointGapMax(layout, poses);
  raise(e.penetrationPeak, e.penetration.max);
  raise(e.penetrationLate, e.penetration.max);
  raise(e.gapPeak, e.gapLast);
  raise(e.gapLate, e.gapLast);
  e.top = -1e300;
  for (size_t i = 0; i < poses.size(); ++i) {
    if (!layout.dynamic[i]) continue;
    e.top = std::max(e.top, poses[i].position.y);
    if (watch.escaped && watch.escaped(poses[i].position)) ++e.escaped;
  }
}

}  // namespace

std::unique_ptr<Engine> avbdEngine(Model& model, const Layout& layout, std::function<void(Model&, int64_t)> before) {
  return std::make_unique<AvbdEngine>(model, layout, std::move(before));
}

Evidence observeRun(Engine& engine, const Layout& layout, const Watch& watch, const Span& span) {
  using Clock = std::chrono::steady_clock;
  Evidence e;
  std::vector<Pose> start(layout.bodies.size()), poses(layout.bodies.size());
  engine.poses(start);
  const int total = span.warmup + span.steps;
  const bool each = watch.penetration || watch.gap || watch.observe;
  for (int i = 0; i < total; ++i) {
    engine.prepare();
    const auto before = Clock::now();
    try {
      engine.step(span.dt);
    } catch (const NonFiniteError&) {
      e.finite = false;
      engine.poses(poses);
      break;
    }
    const std::chrono::duration<double, std::milli> took = Clock::now() - before;
    if (i >= span.warmup) e.milliseconds.push_back(took.count());
    if (!each && i + 1 < total) continue;
    engine.poses(poses);
    const int left = total - 1 - i;
    watchStep(e, layout, watch, poses, left * span.dt);
    if (watch.gap) {
      const double gap = jointGapMax(layout, poses);
      raise(e.gapPeak, gap);
      if (left < kLateGap) raise(e.gapLate, gap);
    }
    if (watch.observe) watch.observe(e, layout, poses, left);
  }
  if (total <= 0) poses = start;
  finishRun(e, layout, watch, poses);
  e.displacement = displacement(layout, start, poses);
  return e;
}

Evidence run(const Scene& scene, const Settings& settings) {
  Model model = scene.make(settings);
  const Layout layout = layoutOf(model.world);
  const std::unique_ptr<Engine> engine = avbdEngine(model, layout, scene.before);
  Evidence e = observeRun(*engine, layout, scene.watch, {scene.warmup, scene.steps, model.dt});
  e.kineticEnergy = model.world.kineticEnergy();
  e.speed = speedMax(model.world);
  e.finite = e.finite && isFinite(model.world);
  return e;
}

}  // namespace avbd::scenes
