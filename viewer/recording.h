// What a run leaves behind for the page: shapes once, poses and figures for each frame.
#pragma once

#include <avbd/avbd.h>

#include <string>
#include <vector>

namespace avbd {

struct RecordedShape {
  uint32_t body = 0;  ///< index into Recording::bodies
  Geometry geometry;
  Pose pose;  ///< in the body's frame
};

struct RecordedBody {
  std::string name;
  BodyType type = BodyType::Dynamic;
};

struct RecordedContact {
  Vec3d position;
  Vec3 force;  ///< on B [N]
};

struct RecordedFrame {
  double time = 0;
  std::vector<Pose> poses;  ///< of all bodies, in order of Recording::bodies
  std::vector<RecordedContact> contacts;
  double kineticEnergy = 0;   ///< [J]
  double penetrationMax = 0;  ///< [m]
  double jointGapMax = 0;     ///< [m]
};

struct RecordedJoint {
  uint32_t bodyA = 0, bodyB = 0;  ///< index into bodies; 0xffffffff is the world
  Vec3d anchorA, anchorB;         ///< in each body's frame
};

struct Recording {
  std::string title;
  Vec3 up{0, 1, 0};
  std::vector<RecordedBody> bodies;
  std::vector<RecordedShape> shapes;
  std::vector<RecordedJoint> joints;
  std::vector<RecordedFrame> frames;
  std::vector<std::pair<std::string, std::string>> report;  ///< lines of the report: label, value
};

}  // namespace avbd
