// `avbd replay`: makes a recording's run again and finds where the two part.
//
// Each step's hash is compared. Where it differs, the hashes by stage say what was the first to differ, and the frames
// whose poses and velocities they hold which body.
#include <algorithm>
#include <cmath>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/control_script.h"
#include "app/failure.h"
#include "app/load.h"
#include "app/number_text.h"
#include "app/run_again.h"
#include "io/record/reader.h"
#include "io/record/softs.h"
#include "io/record/source.h"

namespace avbd::cli {
namespace {

constexpr const char* kNoStage = "";

template <class T>
void take(std::optional<T>& setting, const std::optional<T>& asked) {
  if (asked) setting = asked;
}

void takeSettings(scenes::Settings& settings, const scenes::Settings& asked) {
  take(settings.iterations, asked.iterations), take(settings.substeps, asked.substeps);
  take(settings.krylovIterations, asked.krylovIterations), take(settings.simdWidth, asked.simdWidth);
  take(settings.workers, asked.workers), take(settings.sleep, asked.sleep),
      take(settings.primalSolver, asked.primalSolver);
}

/// The run as it was, step by step.
class Again {
 public:
  Again(const RunAgain& recorded, const ReplayArguments& a) {
    RunArguments arguments = argumentsOf(*recorded.run, a.file);
    takeSettings(arguments.settings, a.settings);
    model_ = loadModel(arguments);
    plan_ = planRun(arguments, *model_);
    if (!recorded.run->control.empty())
      control_ = parseControlScript(recorded.run->control, "the recorded control script", model_->actuators);
  }

  void step() {
    throwIfStopped();
    control_.apply(*model_, time(), plan_.dt);
    if (model_->before) model_->before(*model_, step_);
    ++step_;
    try {
      model_->world.step(static_cast<float>(plan_.dt));
    } catch (const NonFiniteError& e) {
      throw nonFiniteRun(*model_, e, step_, time());
    }
  }
  const Model& model() const { return *model_; }
  const World& world() const { return model_->world; }
  int64_t made() const { return step_; }
  double time() const { return static_cast<double>(step_) * plan_.dt; }
  /// The step that a frame of this time shows.
  int64_t stepOf(double time) const { return std::llround(time / plan_.dt); }

 private:
  std::optional<Model> model_;
  Plan plan_;
  ControlScript control_;
  int64_t step_ = 0;
};

/// The first of its stages to differ; none where the versions' stages are not the same.
const char* stageOf(const RecordedStep& recorded, const World& world) {
  const auto now = world.stageHashes();
  if (recorded.stages == std::array<uint64_t, kStageCount>{}) return kNoStage;
  for (size_t i = 0; i < kStageCount; ++i)
    if (recorded.stages[i] != now[i]) return stageName(static_cast<Stage>(i));
  return kNoStage;
}

std::string apartText(const Pose& pose, const Pose& recorded, const Velocity& velocity,
                      const Velocity* recordedVelocity) {
  std::string text = "by " + digits(length(pose.position - recorded.position), 3) + " m";
  if (!recordedVelocity) return text;
  text += ", " + digits(static_cast<double>(length(velocity.linear - recordedVelocity->linear)), 3) + " m/s, ";
  return text + digits(static_cast<double>(length(velocity.angular - recordedVelocity->angular)), 3) + " rad/s";
}

/// Whether a point of a soft body is where it was, as far as recordings tell.
bool isNear(Vec3d a, Vec3d b, double step) {
  return std::max({std::fabs(a.x - b.x), std::fabs(a.y - b.y), std::fabs(a.z - b.z)}) <= step;
}

/// The first body of a frame that is not as it was; empty: all are.
std::string bodyOf(const Recording& head, const RecordedFrame& now, const RecordedFrame& was) {
  for (uint32_t i = 0; i < now.poses.size(); ++i) {
    const RecordedSoft* soft = softOf(head, i);
    const Velocity* velocity = soft || was.velocities.empty() ? nullptr : &was.velocities[i];
    const bool same = soft ? isNear(now.poses[i].position, was.poses[i].position, soft->step)
                           : now.poses[i] == was.poses[i] && (!velocity || now.velocities[i] == *velocity);
    if (same) continue;
    return "\"" + head.bodies[i].name + "\" (" + std::to_string(i) + "), " +
           apartText(now.poses[i], was.poses[i], now.velocities[i], velocity);
  }
  return {};
}

/// Goes on to the first frame in which some body is not as it was.
void tellBody(Again& again, RecordReader& reader, std::ostream& out) {
  RecordSource source(again.model());
  for (uint64_t i = 0; i < reader.frameCount(); ++i) {
    const int64_t step = again.stepOf(reader.times()[i]);
    if (step < again.made()) continue;
    while (again.made() < step) again.step();
    const std::string body = bodyOf(reader.head(), source.frame(again.model(), again.time()), reader.frame(i));
    if (body.empty()) continue;
    out << "first body: " << body << ", in the frame of step " << step << "\n";
    return;
  }
  out << "no body differs in any frame\n";
}

}  // namespace

int replayCommand(const ReplayArguments& a, std::ostream& out) {
  const RunAgain recorded = readRunAgain(a.file);
  if (!recorded.run || recorded.steps.empty())
    throw BadInput(a.file + ": holds no hashes of steps; `avbd run --record` writes them");
  RecordReader reader(a.file);
  Again again(recorded, a);
  if (RecordSource(again.model()).head().bodies.size() != reader.head().bodies.size())
    throw BadInput(a.file + ": its run has other bodies than " + again.model().name + " has now");
  for (const RecordedStep& step : recorded.steps) {
    while (again.made() < static_cast<int64_t>(step.step)) again.step();
    if (again.world().hash() == step.hash) continue;
    const std::string stage = stageOf(step, again.world());
    out << "parts at step " << step.step << " (" << digits(again.time(), 6) << " s)";
    out << (stage.empty() ? std::string() : ", in stage " + stage) << "\n";
    tellBody(again, reader, out);
    return kExitCheckFailed;
  }
  out << recorded.steps.back().step << " steps, each as it was recorded\n";
  return kExitDone;
}

}  // namespace avbd::cli
