// Measuring a run's end.
#include "app/figures.h"

#include <algorithm>

#include "io/record/source.h"
#include "scenes/measure.h"

namespace avbd::cli {
namespace {

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const size_t k = std::min(values.size() - 1, static_cast<size_t>(q * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return values[k];
}

// A NaN is kept.
void raise(double& most, double value) {
  if (!(value <= most)) most = value;
}

// Gaps that are lengths.
void measureJoints(const World& world, RunFigures& f) {
  for (const JointId id : world.joints()) {
    const JointType type = world.type(id);
    if (!world.isEnabled(id) || type == JointType::TetVolume || type == JointType::Coupling) continue;
    if (type == JointType::Custom) continue;
    raise(f.jointGapMax, world.gap(id));
    raise(f.jointAngleMax, world.angleError(id));
    const LimitExcess excess = limitExcess(world, id);
    raise(f.limitExcessMax, excess.length);
    raise(f.limitExcessAngleMax, excess.angle);
  }
}

}  // namespace

void Clockwork::add(double seconds, const StepReport& report) {
  milliseconds_.push_back(seconds * 1e3);
  seconds_ += seconds;
  sharedRuns_ += report.sharedRuns;
  for (size_t i = 0; i < kStageCount; ++i) stages_[i] += report.seconds[i], shared_[i] += report.sharedSeconds[i];
}

void Clockwork::put(RunFigures& figures) const {
  figures.msMedian = quantile(milliseconds_, 0.5);
  figures.msP95 = quantile(milliseconds_, 0.95);
  figures.realtimeFactor = seconds_ > 0 ? static_cast<double>(figures.steps) * figures.dt / seconds_ : 0;
  double sum = 0;
  for (const double s : stages_) sum += s;
  if (!(sum > 0)) return;
  for (size_t i = 0; i < kStageCount; ++i) {
    figures.stageShare[i] = stages_[i] / sum;
    figures.aloneShare[i] = (stages_[i] - shared_[i]) / sum;
  }
  figures.sharedRuns = static_cast<double>(sharedRuns_) / static_cast<double>(milliseconds_.size());
}

RunFigures measureRun(const Model& model, int64_t steps, double dt) {
  const World& world = model.world;
  const scenes::Layout layout = scenes::layoutOf(world);
  const std::vector<Pose> poses = scenes::posesOf(world, layout);
  const scenes::Penetration penetration = scenes::penetrationOf(layout, poses);
  RunFigures f;
  f.scene = model.name;
  for (const BodyId id : layout.bodies) (world.type(id) == BodyType::Static ? f.statics : f.bodies) += 1;
  f.shapes = world.shapeCount();
  f.joints = world.jointCount();
  f.probes = model.probes.size();
  f.softs = softFiguresOf(model);
  if (!f.softs.empty()) f.softContacts = softContactsOf(world);
  f.contactPoints = world.report().points;
  f.steps = steps;
  f.dt = dt;
  f.workers = world.definition().workers;
  f.penetrationMax = penetration.max;
  f.penetrationMean = penetration.mean;
  measureJoints(world, f);
  f.kineticEnergy = world.kineticEnergy();
  f.finite = scenes::isFinite(world);
  f.hash = world.hash();
  f.simdWidth = world.report().simdWidth;
  f.momentum = world.momentum();
  f.angularMomentum = world.angularMomentum();
  f.notes = model.notes;
  return f;
}

}  // namespace avbd::cli
