// A corpus of broken definitions and files, each with what the refusal must name.
#pragma once

#include <avbd/avbd.h>

#include <functional>
#include <string>
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
std::vector<BadCall> badCalls();  ///< of everything else

struct BadFile {
  std::string kind;  ///< "mjcf", "urdf", "obj", "stl", "msh"
  std::string text;
  std::string names;  ///< a part of the message
};
std::vector<BadFile> badFiles();

}  // namespace avbd::scenes
