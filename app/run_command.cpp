// `avbd run`: simulate, write, report, and show the run in a browser as it happens.
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <thread>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/control_script.h"
#include "app/failure.h"
#include "app/figures.h"
#include "app/json_text.h"
#include "app/load.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "viewer/live.h"

namespace avbd::cli {
namespace {

/// Of the wall clock [s].
struct Taken {
  double start = 0, seconds = 0;
};

double clockSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Taken timedStep(Model& model, int64_t step, double dt) {
  try {
    if (model.before) model.before(model, step - 1);
    const double before = clockSeconds();
    model.world.step(static_cast<float>(dt));
    return {before, clockSeconds() - before};
  } catch (const NonFiniteError& e) {
    throw nonFiniteRun(model, e, step, static_cast<double>(step) * dt);
  }
}

/// An empty file of a name that nobody can guess; it vanishes with this.
class TemporaryFile {
 public:
  TemporaryFile() {
    constexpr int kEnding = 5;
    std::string pattern = (std::filesystem::temp_directory_path() / "avbd_live_XXXXXX.avbd").string();
    const int file = mkstemps(pattern.data(), kEnding);
    if (file < 0) throw BadInput("--live " + pattern + ": " + std::strerror(errno));
    close(file);
    path_ = pattern;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A page that shows the run's recording while it grows. Made before any output, so that a port that is taken costs no
/// file; what it shows is the recording that the user asked for, or one that vanishes with the page.
class LivePage {
 public:
  explicit LivePage(const RunArguments& a) : server_(static_cast<uint16_t>(a.port)) {
    if (a.record.empty()) temporary_.emplace();
    file_ = temporary_ ? temporary_->path() : a.record;
  }

  const std::string& file() const { return file_; }
  /// The recording has begun.
  void show(std::ostream& err) {
    server_.show(file_);
    begin_ = Clock::now();
    err << "live at " << server_.url() << "; Ctrl-C ends it" << std::endl;
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

  std::optional<TemporaryFile> temporary_;
  std::string file_;
  LiveServer server_;
  Clock::time_point begin_{};
};

}  // namespace

int runCommand(const RunArguments& asked, std::ostream& out, std::ostream& err) {
  RunArguments a = asked;
  Model model = loadModel(a);
  const Plan plan = planRun(a, model);
  ControlScript control;
  if (!a.control.empty()) control = readControlScript(a.control, model.actuators);
  std::optional<LivePage> page;
  if (a.live) a.record = page.emplace(asked).file();
  Outputs outputs(a, model, plan);
  if (page) page->show(err);
  Clockwork clock;
  const double began = clockSeconds();
  {
    Progress progress(err);
    outputs.look(model, 0, plan);
    for (int64_t step = 1; step <= plan.steps; ++step) {
      throwIfStopped();
      control.apply(model, static_cast<double>(step - 1) * plan.dt, plan.dt);
      const Taken taken = timedStep(model, step, plan.dt);
      clock.add(taken.seconds, model.world.report());
      outputs.timed(taken.start - began, taken.seconds, model.world.report());
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
