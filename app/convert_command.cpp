// `avbd convert`: a recording as CSV, JSON, MCAP or a page.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/failure.h"
#include "app/output_file.h"
#include "io/record/export.h"
#include "viewer/page.h"

namespace avbd::cli {
namespace {

constexpr double kPagePoses = 2.4e6;  // of all bodies in all frames: about 48 MB of page

std::vector<std::string> exportPage(RecordReader& reader, std::ostream& out) {
  std::vector<std::string> leftOut;
  const double poses = static_cast<double>(reader.frameCount()) * static_cast<double>(reader.head().bodies.size());
  const auto stride = static_cast<uint64_t>(std::max(1.0, std::ceil(poses / kPagePoses)));
  const Recording all = reader.readAll(stride, &leftOut);
  if (all.frames.empty()) throw BadInput("--html: the recording holds no complete frame");
  writePage(out, all);
  return leftOut;
}

}  // namespace

int convertCommand(const ConvertArguments& a, std::ostream& out, std::ostream& err) {
  RecordReader reader(a.file);
  struct Output {
    std::unique_ptr<OutputFile> file;
    std::function<std::vector<std::string>(RecordReader&, std::ostream&)> write;
  };
  std::vector<Output> outputs;
  const auto add = [&](const char* option, const std::string& name, auto write) {
    if (name.empty()) return;
    auto file = std::make_unique<OutputFile>(option, name);
    std::error_code none;
    if (std::filesystem::equivalent(name, a.file, none)) throw BadInput(name + ": is the recording itself");
    for (const Output& other : outputs)
      if (other.file->target() == file->target()) throw BadInput(name + ": is named twice");
    outputs.push_back({std::move(file), write});
  };
  add("--csv", a.csv, [](RecordReader& r, std::ostream& o) { return exportCsv(r, o); });
  add("--json", a.json, [](RecordReader& r, std::ostream& o) { return exportJson(r, o); });
  add("--mcap", a.mcap, [](RecordReader& r, std::ostream& o) { return exportMcap(r, o); });
  add("--html", a.html, exportPage);
  if (outputs.empty()) throw BadInput("convert: nothing to write: give --csv, --json, --mcap or --html FILE");
  std::set<std::string> said;
  const auto say = [&](const std::vector<std::string>& notes) {
    for (const std::string& note : notes)
      if (said.insert(note).second) err << "avbd: " << a.file << ": " << note << "\n";
  };
  say(reader.info().notes);
  for (Output& output : outputs) {
    throwIfStopped();
    say(output.write(reader, output.file->stream()));
  }
  for (Output& output : outputs) output.file->finish();
  for (Output& output : outputs) output.file->commit();
  out << reader.frameCount() << " frames of " << reader.head().bodies.size() << " bodies\n";
  return kExitDone;
}

}  // namespace avbd::cli
