// Runs in recordings (run_again.h).
#include "app/run_again.h"

#include <fstream>
#include <iterator>

#include "app/failure.h"
#include "io/record/crc.h"

namespace avbd::cli {
namespace {

std::string textOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

uint64_t sceneHash(const std::string& scene) {
  if (scenes::find(scene)) return 0;
  const std::string text = textOf(scene);
  if (text.empty()) return 0;
  const auto* bytes = reinterpret_cast<const uint8_t*>(text.data());
  // Never 0, and with the length, which a checksum of 32 bits does not tell.
  return uint64_t(text.size()) << 32 | record::crc32c({bytes, text.size()});
}

RecordedRun runOf(const RunArguments& a) {
  return {a.given, a.control.empty() ? std::string() : textOf(a.control), sceneHash(a.scene)};
}

RunArguments argumentsOf(const RecordedRun& run, const std::string& recording) {
  const Arguments parsed = parseArguments(run.arguments);
  const auto* given = std::get_if<RunArguments>(&parsed);
  if (!given) throw BadInput(recording + ": holds no run of avbd");
  RunArguments a = *given;
  a.html.clear(), a.poses.clear(), a.record.clear(), a.probes.clear(), a.trace.clear();
  a.live = false;
  if (run.sceneHash == 0 && scenes::find(a.scene)) return a;
  const uint64_t now = sceneHash(a.scene);
  if (now == 0) throw BadInput(a.scene + ": the recording's model is not here; replay it in the folder that it ran in");
  if (now != run.sceneHash) throw BadInput(a.scene + ": is not as it was when " + recording + " was recorded");
  return a;
}

}  // namespace avbd::cli
