// Runs and their steps' hashes as chunks, and back.
#include "io/record/run_again.h"

#include "io/file_error.h"
#include "io/record/chunk.h"
#include "io/record/file_bytes.h"
#include "io/record/reader.h"

namespace avbd {
namespace record {
namespace {

enum RunField : uint16_t { kArguments = 1, kControl = 3, kSceneHash = 4 };
enum StepField : uint16_t { kNumbers = 1, kHashes = 2, kStages = 3, kStageHashes = 4 };

void takeSteps(const FieldReader& f, std::vector<RecordedStep>& to) {
  const std::vector<uint64_t> numbers = f.list<uint64_t>(kNumbers);
  const std::vector<uint64_t> hashes = f.listOf<uint64_t>(kHashes, numbers.size());
  const uint32_t stages = f.value<uint32_t>(kStages, 0);
  if (hashes.size() != numbers.size()) f.refuse(kHashes, "is missing");
  // Another version's stages are others.
  const bool known = stages == kStageCount;
  const std::vector<uint64_t> byStage =
      known ? f.listOf<uint64_t>(kStageHashes, numbers.size() * kStageCount) : std::vector<uint64_t>();
  for (size_t i = 0; i < numbers.size(); ++i) {
    RecordedStep step{numbers[i], hashes[i], {}};
    if (!to.empty() && step.step <= to.back().step) f.refuse(kNumbers, "does not ascend");
    for (size_t k = 0; k < kStageCount && !byStage.empty(); ++k) step.stages[k] = byStage[i * kStageCount + k];
    to.push_back(step);
  }
}

RecordedRun runOf(const FieldReader& f) {
  constexpr size_t kArgumentsMost = 4096;
  return {f.texts(kArguments, kArgumentsMost), f.text(kControl), f.value<uint64_t>(kSceneHash, 0)};
}

}  // namespace

Bytes runContent(const RecordedRun& run) {
  FieldWriter out;
  out.texts(kArguments, run.arguments);
  out.text(kControl, run.control);
  out.value(kSceneHash, run.sceneHash);
  return out.bytes();
}

Bytes stepsContent(const std::vector<RecordedStep>& steps) {
  std::vector<uint64_t> numbers, hashes, stages;
  for (const RecordedStep& step : steps) {
    numbers.push_back(step.step);
    hashes.push_back(step.hash);
    stages.insert(stages.end(), step.stages.begin(), step.stages.end());
  }
  FieldWriter out;
  out.list(kNumbers, numbers, Encoding::Line, 1);
  out.list(kHashes, hashes);
  out.value(kStages, static_cast<uint32_t>(kStageCount));
  out.list(kStageHashes, stages);
  return out.bytes();
}

}  // namespace record

RunAgain readRunAgain(const std::filesystem::path& path) {
  using namespace record;
  const RecordReader reader(path);
  const FileBytes file(path, FileBytes::Access::Read);
  RunAgain found;
  const Index& index = reader.index();
  for (size_t i = 0; i < index.offsets.size(); ++i) {
    if (index.types[i] != kRun && index.types[i] != kSteps) continue;
    const std::string place = "chunk " + typeName(index.types[i]) + " at byte " + std::to_string(index.offsets[i]);
    Bytes bytes(kChunkHeadBytes);
    bytes.resize(file.read(index.offsets[i], bytes));
    const std::optional<ChunkHead> head = chunkHead(bytes);
    if (!head || head->stored > file.size() - index.offsets[i]) throw FileError(place + " is cut short", file.name());
    bytes.resize(head->stored);
    bytes.resize(file.read(index.offsets[i] + kChunkHeadBytes, bytes));
    const Bytes content = unpack(*head, bytes, place);
    const FieldReader fields(content, place);
    if (head->type == kRun)
      found.run = runOf(fields);
    else
      takeSteps(fields, found.steps);
  }
  return found;
}

}  // namespace avbd
