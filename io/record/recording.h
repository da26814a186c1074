// What a run leaves behind: shapes and joints once, poses, contacts and figures for each frame.
#pragma once

#include <avbd/avbd.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/color.h"

namespace avbd {

/// Where an index into a recording's lists names nothing.
inline constexpr uint32_t kNotRecorded = 0xffffffffu;

struct RecordedShape {
  uint32_t body = 0;  ///< index into Recording::bodies
  Geometry geometry;
  Pose pose;  ///< in the body's frame
  bool trigger = false;
  std::optional<Color> color{};  ///< as the model's file gives it; no value: whoever draws it chooses
};

struct RecordedBody {
  std::string name;
  BodyType type = BodyType::Dynamic;
};

struct RecordedJoint {
  uint32_t bodyA = 0, bodyB = 0;  ///< index into bodies; kNotRecorded is the world
  Vec3d anchorA, anchorB;         ///< in each body's frame; in the world where there is no body
};

struct RecordedContact {
  Vec3d position;
  Vec3 force;                                             ///< on B [N]
  Vec3 normal{};                                          ///< unit, from A to B; zero: not known
  float separation = 0;                                   ///< [m]
  uint32_t shapeA = kNotRecorded, shapeB = kNotRecorded;  ///< index into shapes
};

enum class RecordedEventKind : uint8_t { TouchBegin, TouchEnd, TriggerEnter, TriggerLeave, Hit };

/// An event of the steps since the frame before. Of a trigger, A is the trigger and B its visitor.
struct RecordedEvent {
  RecordedEventKind kind = RecordedEventKind::TouchBegin;
  uint32_t shapeA = kNotRecorded, shapeB = kNotRecorded;  ///< index into shapes
  Vec3d position{};                                       ///< of a hit
  Vec3 normal{};                                          ///< of a hit, from A to B
  float speed = 0, impulse = 0;                           ///< of a hit [m/s], [N s]
};

struct RecordedFrame {
  double time = 0;
  std::vector<Pose> poses;           ///< of all bodies, in order of Recording::bodies
  std::vector<Velocity> velocities;  ///< of all bodies, or empty
  std::vector<RecordedContact> contacts;
  uint32_t contactsLeftOut = 0;  ///< weaker contact points that `contacts` does not hold
  std::vector<RecordedEvent> events;
  double kineticEnergy = 0;   ///< [J]
  double penetrationMax = 0;  ///< [m]
  double jointGapMax = 0;     ///< [m]
};

struct Recording {
  std::string title;
  std::string engine;  ///< name and version of what simulated
  Vec3 up{0, 1, 0};
  double dt = 0;  ///< [s] of a step; 0: not known. Frames may be several steps apart.
  std::vector<RecordedBody> bodies;
  std::vector<RecordedShape> shapes;
  std::vector<RecordedJoint> joints;
  std::vector<RecordedFrame> frames;
  std::vector<std::pair<std::string, std::string>> report;  ///< lines of the report: label, value
};

}  // namespace avbd
