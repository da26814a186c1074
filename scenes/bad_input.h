// A corpus of broken definitions and files, each with what the refusal must name.
#pragma once

#include <avbd/avbd.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace avbd::scenes {

/// A small world that broken calls are tried on: two bodies, a joint, and ids of things destroyed.
struct Victim {
  World world;
  BodyId box, floor, deadBody;
  ShapeId boxShape, deadShape;
  JointId joint, deadJoint;
};
Victim makeVictim();

struct BadCall {
  std::string definition, field;  ///< that the Error names
  std::string value;              ///< short, for reports
  std::function<void(Victim&)> call;
};
std::vector<BadCall> badBodies();
std::vector<BadCall> badShapes();
std::vector<BadCall> badCalls();      ///< of everything else that changes a world
std::vector<BadCall> badQuestions();  ///< queries, movers, debug draw

struct BadFile {
  std::string kind;  ///< "mjcf", "urdf", "obj", "stl", "msh", "recording"
  std::string text;
  std::vector<std::string> names;  ///< parts of the message: the field and the value, or what is wrong
  /// Name and content of files beside it; with any, or where `onDisk`, it is written into a folder and read from there.
  std::vector<std::pair<std::string, std::string>> beside{};
  bool onDisk = false;
};
std::vector<BadFile> badFiles();
std::vector<BadFile> badModelsOnDisk();
/// Whole, of three frames in chunks of their own; written into the folder on the way.
std::string wholeRecording(const std::filesystem::path& folder);
std::vector<BadFile> badRecordings(const std::string& whole);

}  // namespace avbd::scenes
