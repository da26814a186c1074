// `avbd run`: simulate, write, report, and show the run in a browser as it happens.
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/failure.h"
#include "app/figures.h"
#include "app/json_text.h"
#include "app/load.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "viewer/live.h"

namespace avbd::cli {
namespace {

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

/// A page that shows the run's recording while it grows.
class LivePage {
 public:
  /// The recording that the page shows; it vanishes with the run unless the user asked for it.
  static std::string fileOf(const RunArguments& a) {
    if (!a.live || !a.record.empty()) return a.record;
    return (std::filesystem::temp_directory_path() / ("avbd_live_" + std::to_string(getpid()) + ".avbd")).string();
  }
  LivePage(const RunArguments& a, const std::string& file, std::ostream& err)
      : temporary_(a.record.empty() ? file : ""), server_(file, static_cast<uint16_t>(a.port)), begin_(Clock::now()) {
    err << "live at " << server_.url() << "; Ctrl-C ends it" << std::endl;
  }
  ~LivePage() {
    std::error_code ignored;
    if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
  }

  /// Lets the simulated time not run ahead of the clock.
  void pace(double time) const {
    while (std::chrono::duration<double>(Clock::now() - begin_).count() < time) pause();
  }
  /// Until the user has seen enough.
  void stay() const {
    try {
      for (;;) pause();
    } catch (const Stopped&) {
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  static void pause() {
    throwIfStopped();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }

  std::string temporary_;
  LiveServer server_;
  Clock::time_point begin_;
};

}  // namespace

int runCommand(const RunArguments& asked, std::ostream& out, std::ostream& err) {
  RunArguments a = asked;
  a.record = LivePage::fileOf(asked);
  Model model = loadModel(a);
  const Plan plan = planRun(a, model);
  Outputs outputs(a, model, plan);
  std::unique_ptr<LivePage> page;
  if (a.live) page = std::make_unique<LivePage>(asked, a.record, err);
  Clockwork clock;
  {
    Progress progress(err);
    outputs.look(model, 0, plan);
    for (int64_t step = 1; step <= plan.steps; ++step) {
      throwIfStopped();
      const double seconds = timedStep(model, step, plan.dt);
      clock.add(seconds, model.world.report());
      outputs.look(model, step, plan);
      if (page) page->pace(static_cast<double>(step) * plan.dt);
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
  if (page) {
    out.flush();
    page->stay();
  }
  return kExitDone;
}

}  // namespace avbd::cli
