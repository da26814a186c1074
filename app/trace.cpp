// Chrome's trace events, one a line: times in microseconds.
#include "app/trace.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>

namespace avbd::cli {
namespace {

constexpr double kMicro = 1e6;
constexpr size_t kLine = 256;

}  // namespace

Trace::Trace(std::ostream& out) : out_(out) {
  out_ << "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[";
  event(R"({"name":"process_name","ph":"M","pid":1,"tid":1,"args":{"name":"avbd"}})");
  event(R"({"name":"thread_name","ph":"M","pid":1,"tid":1,"args":{"name":"step"}})");
}

void Trace::event(const char* text) {
  out_ << (first_ ? "\n" : ",\n") << text;
  first_ = false;
}

void Trace::slice(const char* name, double start, double seconds, const StepReport& report, bool isStep) {
  char line[kLine], arguments[kLine / 4] = "";
  if (isStep) std::snprintf(arguments, sizeof arguments, ",\"args\":{\"step\":%" PRIu64 "}", report.step);
  std::snprintf(line, sizeof line, R"({"name":"%s","cat":"%s","ph":"X","pid":1,"tid":1,"ts":%.3f,"dur":%.3f%s})", name,
                isStep ? "step" : "stage", start * kMicro, seconds * kMicro, arguments);
  event(line);
}

void Trace::counter(const char* name, double start, double value) {
  char line[kLine];
  std::snprintf(line, sizeof line, R"({"name":"%s","ph":"C","pid":1,"ts":%.3f,"args":{"%s":%.0f}})", name,
                start * kMicro, name, value);
  event(line);
}

void Trace::add(double start, double seconds, const StepReport& report) {
  slice("step", start, seconds, report, true);
  // Stages run one after the other; what lies between them is small and stands at the step's end.
  double at = start;
  const double end = start + seconds;
  for (size_t i = 0; i < kStageCount; ++i) {
    const double length = std::min(report.seconds[i], end - at);
    slice(stageName(static_cast<Stage>(i)), at, length, report, false);
    at += length;
  }
  counter("bodies", start, report.bodies);
  counter("pairs", start, report.pairs);
  counter("contacts", start, report.contacts);
  counter("points", start, report.points);
  counter("joints", start, report.joints);
  counter("islands", start, report.islands);
  counter("colors", start, report.colors);
}

void Trace::finish() { out_ << "\n]}\n"; }

}  // namespace avbd::cli
