// Acceptance: everything broken is refused by name and changes nothing.
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "io/mesh_file.h"
#include "io/mjcf.h"
#include "io/record/reader.h"
#include "io/urdf.h"
#include "scenes/bad_input.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

struct Tally {
  int tried = 0, refused = 0;
  std::string first;  ///< what was not refused as it ought to be

  void count(bool good, const std::string& what) {
    ++tried;
    refused += good;
    if (!good && first.empty()) first = what;
  }
};

bool isRefused(const BadCall& bad) {
  Victim victim = makeVictim();
  const uint64_t before = victim.world.hash();
  try {
    bad.call(victim);
  } catch (const Error& e) {
    return e.definition() == bad.definition && e.field() == bad.field && !e.value().empty() && !e.range().empty() &&
           victim.world.hash() == before;
  }
  return false;
}

/// A folder of this process alone, gone at the end.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("avbd_bad_input_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code left;
    std::filesystem::remove_all(path_, left);
  }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }

 private:
  std::filesystem::path path_;
};

std::string nameOf(const BadFile& file) {
  if (file.kind == "mjcf") return "bad.xml";
  return file.kind == "recording" ? "bad.avbd" : "bad." + file.kind;
}

void readOnDisk(const BadFile& bad, const Folder& all, int number) {
  // Each in a folder of its own, so that none finds another one's files.
  const std::string folder = std::to_string(number) + "/";
  for (const auto& [name, content] : bad.beside) all.write(folder + name, content);
  const std::filesystem::path file = all.write(folder + nameOf(bad), bad.text);
  if (bad.kind == "mjcf") {
    readMjcf(file);
  } else if (bad.kind == "urdf") {
    readUrdf(file);
  } else if (bad.kind == "recording") {
    RecordReader reader(file);
  } else {
    readMeshFile(file);
  }
}

void readText(const BadFile& file) {
  if (file.kind == "mjcf") {
    readMjcfText(file.text, "bad.xml");
  } else if (file.kind == "urdf") {
    readUrdfText(file.text, "bad.urdf");
  } else {
    readMeshBytes(std::as_bytes(std::span(file.text)), file.kind, "bad." + file.kind);
  }
}

bool isRefused(const BadFile& file, const Folder& folder, int number) {
  const bool onDisk = file.onDisk || !file.beside.empty();
  try {
    if (onDisk)
      readOnDisk(file, folder, number);
    else
      readText(file);
  } catch (const FileError& e) {
    const std::string message = e.what();
    if (onDisk ? message.find(folder.path().string()) != 0 : message.find(nameOf(file)) != 0) return false;
    return std::all_of(file.names.begin(), file.names.end(),
                       [&](const std::string& part) { return message.find(part) != std::string::npos; });
  }
  return false;
}

/// Torn in the middle, a recording is no bad input but what a crash leaves: what is whole is there, and a note says
/// that the end is not.
bool isSalvaged(const std::string& whole, size_t size, uint64_t frames, const Folder& folder) {
  try {
    RecordReader reader(folder.write("torn.avbd", whole.substr(0, size)));
    if (reader.info().finished || reader.info().notes.empty() || reader.frameCount() != frames) return false;
    for (uint64_t i = 0; i < frames; ++i)
      if (reader.frame(i).poses.at(0).position.y != 1.0 - 0.1 * static_cast<double>(i)) return false;
    return true;
  } catch (const FileError&) {
    return false;
  }
}

/// Cut within each of its chunks.
void countTorn(const std::string& whole, const Folder& folder, Tally& tally) {
  const RecordReader reader(folder.write("whole.avbd", whole));
  const record::Index& index = reader.index();
  uint64_t frames = 0;
  for (size_t i = 0; i < index.offsets.size(); ++i) {
    tally.count(isSalvaged(whole, index.offsets[i] + 5, frames, folder), "recording cut in chunk " + std::to_string(i));
    frames += index.counts[i];
  }
}

std::string wholeText(const BadFile& file) {
  std::string all = file.kind;
  for (const std::string& part : file.names) all += " " + part;
  return all;
}

std::vector<Figure> badInput(const Settings&) {
  Tally tally;
  for (const auto& corpus : {badBodies(), badShapes(), badCalls(), badQuestions()})
    for (const BadCall& bad : corpus) tally.count(isRefused(bad), bad.definition + "." + bad.field + " = " + bad.value);
  const Folder folder;
  const std::string whole = wholeRecording(folder.path());
  int number = 0;
  for (const auto& corpus : {badFiles(), badModelsOnDisk(), badRecordings(whole)})
    for (const BadFile& file : corpus) tally.count(isRefused(file, folder, ++number), wholeText(file));
  countTorn(whole, folder, tally);
  return {{"tried", "", static_cast<double>(tally.tried), 200, 1e9, "inputs"},
          {"not_refused", tally.first.empty() ? "" : "first=" + tally.first,
           static_cast<double>(tally.tried - tally.refused), 0, 0, "inputs"}};
}

}  // namespace

Victim makeVictim() {
  Victim v;
  BodyDef floor;
  floor.type = BodyType::Static;
  floor.shape = HalfSpace{};
  v.floor = v.world.create(floor);
  BodyDef box;
  box.position = {0, 0.5, 0};
  box.shape = Box{0.5f, 0.5f, 0.5f};
  v.box = v.world.create(box);
  box.position = {3, 0.5, 0};
  v.deadBody = v.world.create(box);
  v.boxShape = v.world.shapes(v.box)[0];
  v.deadShape = v.world.shapes(v.deadBody)[0];
  v.joint = v.world.create(BallJoint{.bodyB = v.box, .frameA = {{0, 1, 0}}, .frameB = {{0, 0.5, 0}}});
  v.deadJoint = v.world.create(BallJoint{.bodyA = v.deadBody, .bodyB = v.box});
  v.world.destroy(v.deadBody);
  v.world.step(1.0f / 60);
  return v;
}

std::vector<Line> badInputLines() { return {{"D", "bad_input", badInput, ""}}; }

}  // namespace avbd::scenes
