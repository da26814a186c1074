// Reads a robot with meshes from a URDF file, lets it fall, records it to a file and reads that again.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "io/record/reader.h"
#include "io/record/source.h"
#include "io/record/writer.h"
#include "io/urdf.h"
using namespace avbd;

namespace {

void printModel(const Model& model) {
  std::printf("%s: %zu bodies, %zu shapes, step %.4f s\n", model.name.c_str(), model.bodies.size(),
              model.world.shapeCount(), model.dt);
  for (const NamedBody& body : model.bodies)
    std::printf("  %-8s %7.3f kg, %zu shapes\n", body.name.c_str(), double(model.world.mass(body.id)),
                model.world.shapes(body.id).size());
  for (const std::string& note : model.notes) std::printf("  note: %s\n", note.c_str());
}

/// Runs for `duration` [s] and keeps every step.
void runAndRecord(Model& model, double duration, const std::filesystem::path& file) {
  RecordSource source(model);
  RecordWriter writer(file, source.head());
  writer.add(source.frame(model, 0));
  while (model.world.time() < duration) {
    model.world.step(static_cast<float>(model.dt));
    source.watch(model.world);
    writer.add(source.frame(model, model.world.time()));
  }
  writer.finish({{"duration", std::to_string(duration) + " s"}});
}

}  // namespace

int main(int argc, char** argv) try {
  const std::filesystem::path urdf = std::filesystem::path(AVBD_CORPUS) / "urdf";
  const std::filesystem::path file = argc > 1 ? argv[1] : urdf / "good/mesh_hook.urdf";
  // A robot is fixed by its root link unless it floats; then the ground lies half a metre below its lowest point.
  UrdfOptions options{.floating = true, .ground = 0.5, .decompose = true};
  options.packagePaths = {urdf / "parts_description"};
  Model model = readUrdf(file, options);
  printModel(model);

  const std::filesystem::path recording = std::filesystem::current_path() / "robot.avbd";
  runAndRecord(model, 4, recording);

  RecordReader reader(recording);
  const RecordingInfo& info = reader.info();
  std::printf("%s: %llu bytes, %llu frames, %.2f to %.2f s, %s\n", recording.filename().c_str(),
              static_cast<unsigned long long>(info.bytes), static_cast<unsigned long long>(info.frames), info.firstTime,
              info.lastTime, info.finished ? "finished" : "cut off");
  bool good = info.finished && info.notes.empty() && reader.verify().empty();

  // What was read back is what ran, to the bit; and the robot has fallen half a metre and lies still.
  const RecordedFrame first = reader.frame(0), last = reader.frame(reader.frameCount() - 1);
  float speed = 0;
  for (size_t i = 0; i < model.bodies.size(); ++i) {
    const Pose& pose = last.poses[i];
    std::printf("  %-8s fell %.3f m\n", reader.head().bodies[i].name.c_str(),
                first.poses[i].position.z - pose.position.z);
    good = good && pose == model.world.pose(model.bodies[i].id);
    speed = std::max(speed, length(last.velocities[i].linear));
  }
  good = good && speed < 0.05f && !last.contacts.empty();
  std::printf("%s\n", good ? "read again as it ran" : "something is wrong");
  return good ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
