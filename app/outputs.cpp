// Page, CSVs and recording of a run.
#include "app/outputs.h"

#include <algorithm>
#include <filesystem>

#include "app/failure.h"
#include "app/run_again.h"
#include "io/file_error.h"
#include "io/record/chunk.h"
#include "viewer/page.h"

namespace avbd::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kPageFps = 60;
constexpr double kPageFrames = 1200;
constexpr double kPagePoses = 2.4e6;      // of all bodies in all frames: about 48 MB of page
constexpr size_t kRecordContacts = 2000;  // of a frame: the strongest
// Whoever reads along sees a frame this much later at most; frames that are written together take less room.
constexpr auto kFlushAfter = std::chrono::milliseconds(1000), kFlushLive = std::chrono::milliseconds(200);

double pageFps(const Model& model, const Plan& plan) {
  const double bodies = static_cast<double>(std::max<size_t>(1, model.bodies.size()));
  const double frames = std::max(2.0, std::min(kPageFrames, kPagePoses / bodies));
  const double time = static_cast<double>(plan.steps) * plan.dt;
  return time > 0 ? std::min(kPageFps, frames / time) : kPageFps;
}

}  // namespace

Outputs::Outputs(const RunArguments& a, const Model& model, const Plan& plan)
    : csvSampler_(a.fps, plan.dt),
      pageSampler_(pageFps(model, plan), plan.dt),
      recordSampler_(a.fps, plan.dt),
      ids_(model.bodies.size()) {
  for (size_t i = 0; i < ids_.size(); ++i) ids_[i] = model.bodies[i].id;
  poses_.resize(ids_.size());
  if (!a.probes.empty() && model.probes.empty()) {
    throw BadInput("--probes " + a.probes + ": " + a.scene + " has no sensors that this program reads");
  }
  if (!a.poses.empty()) csvFile_ = std::make_unique<OutputFile>("--poses", a.poses);
  if (!a.html.empty()) pageFile_ = std::make_unique<OutputFile>("--html", a.html);
  if (!a.probes.empty()) probesFile_ = std::make_unique<OutputFile>("--probes", a.probes);
  if (!a.trace.empty()) traceFile_ = std::make_unique<OutputFile>("--trace", a.trace);
  refuseSame(a);
  if (traceFile_) trace_ = std::make_unique<Trace>(traceFile_->stream());
  if (probesFile_) probes_ = std::make_unique<ProbesCsv>(probesFile_->stream(), model);
  if (csvFile_) csv_ = std::make_unique<PosesCsv>(csvFile_->stream(), model);
  if (pageFile_) {
    const double frames = pageFps(model, plan) * static_cast<double>(plan.steps) * plan.dt;
    pageRecorder_ = std::make_unique<Recorder>(model, static_cast<size_t>(frames) + 2);
    page_ = pageRecorder_->head();
  }
  if (a.record.empty()) return;
  recorder_ = std::make_unique<Recorder>(model, 1, kRecordContacts);
  try {
    writer_ = std::make_unique<RecordWriter>(a.record, recorder_->head());
    writer_->addChunk(record::kRun, record::runContent(runOf(a)));
  } catch (const FileError& e) {
    throw BadInput(std::string("--record ") + e.what());
  }
  flushed_ = std::chrono::steady_clock::now();
  flushAfter_ = a.live ? kFlushLive : kFlushAfter;
}

void Outputs::look(const Model& model, int64_t step, const Plan& plan) {
  const bool end = step == plan.steps;
  if (recorder_ && step > 0) recorder_->watch(model.world);
  if (recorder_) steps_.push_back({static_cast<uint64_t>(step), model.world.hash(), model.world.stageHashes()});
  const bool rows = csv_ && csvSampler_.due(step);
  const bool onPage = pageRecorder_ && (pageSampler_.due(step) || end);  // the end belongs to page and recording
  const bool inRecord = recorder_ && (recordSampler_.due(step) || end);
  const double time = static_cast<double>(step) * plan.dt;
  if (rows) {
    model.world.getPoses(ids_, poses_);
    csv_->write(time, poses_);
  }
  if (probes_) probes_->write(time);
  if (onPage) page_.frames.push_back(pageRecorder_->frame(model, time));
  if (inRecord) record(recorder_->frame(model, time));
}

void Outputs::timed(double start, double seconds, const StepReport& report) {
  if (trace_) trace_->add(start, seconds, report);
}

void Outputs::record(const RecordedFrame& frame) {
  try {
    writer_->add(frame);
    const auto now = std::chrono::steady_clock::now();
    if (now - flushed_ < flushAfter_) return;
    flushRecording();
    flushed_ = now;
  } catch (const FileError& e) {
    throw BadInput(std::string("--record ") + e.what());
  }
}

void Outputs::flushRecording() {
  writer_->flush();
  if (!steps_.empty()) writer_->addChunk(record::kSteps, record::stepsContent(steps_));
  steps_.clear();
}

void Outputs::commit(const ReportLines& report) {
  if (pageFile_) {
    page_.report = report;
    writePage(pageFile_->stream(), page_);
  }
  if (trace_) trace_->finish();
  // All or none.
  const auto files = {&csvFile_, &pageFile_, &probesFile_, &traceFile_};
  for (const auto& file : files)
    if (*file) (*file)->finish();
  try {
    if (writer_) flushRecording(), writer_->finish(report);
  } catch (const FileError& e) {
    throw BadInput(std::string("--record ") + e.what());
  }
  for (const auto& file : files)
    if (*file) (*file)->commit();
}

void Outputs::refuseSame(const RunArguments& a) const {
  if (csvFile_ && pageFile_ && csvFile_->target() == pageFile_->target())
    throw BadInput("--html and --poses are the same file " + a.html);
  for (const auto& file : {&csvFile_, &pageFile_})
    if (*file && probesFile_ && (*file)->target() == probesFile_->target())
      throw BadInput("--probes is the same file as another output: " + a.probes);
  for (const auto& file : {&csvFile_, &pageFile_, &probesFile_})
    if (*file && traceFile_ && (*file)->target() == traceFile_->target())
      throw BadInput("--trace is the same file as another output: " + a.trace);
  std::error_code none;
  const std::string all[] = {a.poses, a.html, a.record, a.probes, a.trace};
  for (const std::string& file : all)
    if (!file.empty() && fs::equivalent(file, a.scene, none)) throw BadInput(file + ": is the scene itself");
  for (const std::string& file : all)
    if (!file.empty() && !a.control.empty() && fs::equivalent(file, a.control, none))
      throw BadInput(file + ": is the file of --control");
  if (a.record.empty()) return;
  const fs::path target = fs::weakly_canonical(a.record, none);
  for (const auto& file : {&csvFile_, &pageFile_, &probesFile_, &traceFile_})
    if (*file && (*file)->target() == target)
      throw BadInput("--record is the same file as another output: " + a.record);
}

}  // namespace avbd::cli
