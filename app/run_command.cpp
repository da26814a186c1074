// `avbd run`: simulate, write, report.
#include <algorithm>
#include <chrono>
#include <memory>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/failure.h"
#include "app/figures.h"
#include "app/json_text.h"
#include "app/load.h"
#include "app/output_file.h"
#include "app/poses_csv.h"
#include "app/progress.h"
#include "app/recorder.h"
#include "app/sampler.h"
#include "viewer/page.h"

namespace avbd::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kPageFps = 60;
constexpr double kPageFrames = 1200;
constexpr double kPagePoses = 2.4e6;  // of all bodies in all frames: about 48 MB of page

double pageFps(const Model& model, const Plan& plan) {
  const double bodies = static_cast<double>(std::max<size_t>(1, model.bodies.size()));
  const double frames = std::max(2.0, std::min(kPageFrames, kPagePoses / bodies));
  const double time = static_cast<double>(plan.steps) * plan.dt;
  return time > 0 ? std::min(kPageFps, frames / time) : kPageFps;
}

// The files that a run writes: opened before the first step, so that what cannot be written costs no run.
class Outputs {
 public:
  Outputs(const RunArguments& a, const Model& model, const Plan& plan)
      : csvSampler_(a.fps, plan.dt), pageSampler_(pageFps(model, plan), plan.dt), ids_(model.bodies.size()) {
    for (size_t i = 0; i < ids_.size(); ++i) ids_[i] = model.bodies[i].id;
    poses_.resize(ids_.size());
    if (!a.poses.empty()) csvFile_ = std::make_unique<OutputFile>("--poses", a.poses);
    if (!a.html.empty()) pageFile_ = std::make_unique<OutputFile>("--html", a.html);
    refuseSame(a);
    if (csvFile_) csv_ = std::make_unique<PosesCsv>(csvFile_->stream(), model);
    const double frames = pageFps(model, plan) * static_cast<double>(plan.steps) * plan.dt;
    if (pageFile_) recorder_ = std::make_unique<Recorder>(model, static_cast<size_t>(frames) + 2);
  }

  void look(const Model& model, int64_t step, const Plan& plan) {
    const bool rows = csv_ && csvSampler_.due(step);
    const bool frame = recorder_ && (pageSampler_.due(step) || step == plan.steps);  // the end belongs to the page
    if (!rows && !frame) return;
    const double time = static_cast<double>(step) * plan.dt;
    model.world.getPoses(ids_, poses_);
    if (rows) csv_->write(time, poses_);
    if (frame) recorder_->add(model, time, poses_);
  }

  void commit(const ReportLines& report) {
    if (recorder_) {
      recorder_->recording().report = report;
      writePage(pageFile_->stream(), recorder_->recording());
    }
    // Both or none.
    for (const auto& file : {&csvFile_, &pageFile_})
      if (*file) (*file)->finish();
    for (const auto& file : {&csvFile_, &pageFile_})
      if (*file) (*file)->commit();
  }

 private:
  void refuseSame(const RunArguments& a) const {
    if (csvFile_ && pageFile_ && csvFile_->target() == pageFile_->target())
      throw BadInput("--html and --poses are the same file " + a.html);
    std::error_code none;
    for (const std::string& file : {a.poses, a.html})
      if (!file.empty() && fs::equivalent(file, a.scene, none)) throw BadInput(file + ": is the scene itself");
  }

  Sampler csvSampler_, pageSampler_;
  std::vector<BodyId> ids_;
  std::vector<Pose> poses_;
  std::unique_ptr<OutputFile> csvFile_, pageFile_;
  std::unique_ptr<PosesCsv> csv_;
  std::unique_ptr<Recorder> recorder_;
};

double timedStep(Model& model, int64_t step, double dt) {
  using Clock = std::chrono::steady_clock;
  try {
    const auto before = Clock::now();
    model.world.step(static_cast<float>(dt));
    return std::chrono::duration<double>(Clock::now() - before).count();
  } catch (const NonFiniteError& e) {
    throw nonFiniteRun(model, e, step, static_cast<double>(step) * dt);
  }
}

}  // namespace

int runCommand(const RunArguments& a, std::ostream& out, std::ostream& err) {
  Model model = loadModel(a);
  const Plan plan = planRun(a, model);
  Outputs outputs(a, model, plan);
  Clockwork clock;
  {
    Progress progress(err);
    outputs.look(model, 0, plan);
    for (int64_t step = 1; step <= plan.steps; ++step) {
      throwIfStopped();
      const double seconds = timedStep(model, step, plan.dt);
      clock.add(seconds, model.world.report());
      outputs.look(model, step, plan);
      progress.show(step, plan.steps, static_cast<double>(step) * plan.dt);
    }
  }
  RunFigures figures = measureRun(model, plan.steps, plan.dt);
  clock.put(figures);
  const ReportLines report = reportLines(figures);
  outputs.commit(report);
  if (a.json) {
    out << jsonText(figures) << "\n";
  } else if (a.report) {
    out << reportText(report);
  }
  return kExitDone;
}

}  // namespace avbd::cli
