// What a run leaves behind: shapes and joints once, poses, contacts and figures for each frame.
#pragma once

#include <avbd/avbd.h>

#include <array>
#include <limits>
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

/// Between which a coordinate keeps [m, rad]; infinite: no stop on that side.
struct RecordedLimit {
  float lower = -std::numeric_limits<float>::infinity();
  float upper = std::numeric_limits<float>::infinity();
  friend bool operator==(const RecordedLimit&, const RecordedLimit&) = default;
};

/// What a coordinate q of a joint adds to a coupling: the sum of factors[i] q^(i + 1).
struct RecordedTerm {
  uint32_t joint = kNotRecorded;  ///< index into joints
  JointAxis axis = JointAxis::Twist;
  std::array<float, 4> factors{};
  friend bool operator==(const RecordedTerm&, const RecordedTerm&) = default;
};

/// As it was when the recording began. Couplings and custom joints have no frames.
struct RecordedJoint {
  uint32_t bodyA = 0, bodyB = 0;    ///< index into bodies; kNotRecorded is the world
  Pose frameA{}, frameB{};          ///< in each body's frame; in the world where there is no body
  std::optional<JointType> type{};  ///< none: not known, nor what stands below, nor the frames' rotations
  std::string name{};               ///< of its coordinates in the model's file, with commas between; may be empty
  uint8_t freeAxes = 0;             ///< bit i: the coordinate JointAxis(i) is not locked
  /// By JointAxis. Of a DistanceJoint or PulleyJoint the first is that of its length, of a Coupling that of L.
  std::array<RecordedLimit, 6> limits{};
  /// Of a SwingCone [rad]; infinite: none.
  float coneY = std::numeric_limits<float>::infinity(), coneZ = std::numeric_limits<float>::infinity();
  std::array<Vec3d, 2> wheels{};      ///< of a pulley, in the world [m]: where A's and B's part of the rope ends
  float ratio = 1;                    ///< of a pulley: the length is that of A's part + ratio that of B's
  std::vector<RecordedTerm> terms{};  ///< of a coupling
  double rest = 0;       ///< of a coupling that is locked (freeAxes 0): what it holds the sum of its terms at
  std::string family{};  ///< of a custom joint
  std::array<uint32_t, 2> moreBodies{kNotRecorded, kNotRecorded};  ///< of a custom joint: its third and fourth
  uint8_t residuals = 0;  ///< how many numbers RecordedFrame::residuals has of it
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
  Vec3d position{};                                       ///< of a touch or hit
  Vec3 normal{};                                          ///< likewise, from A to B; zero: not known
  float speed = 0;                                        ///< of a hit [m/s]
  float impulse = 0;                                      ///< of a touch or hit [N s]
};

/// What a joint did in the step before the frame.
struct RecordedJointState {
  JointReaction reaction{};  ///< on A, world axes, at A's anchor
  bool enabled = true;
};

struct RecordedFrame {
  double time = 0;
  std::vector<Pose> poses;           ///< of all bodies, in order of Recording::bodies
  std::vector<Velocity> velocities;  ///< of all bodies, or empty; files do not keep those of points, which read as NaN
  std::vector<RecordedContact> contacts;
  uint32_t contactsLeftOut = 0;  ///< weaker contact points that `contacts` does not hold
  std::vector<RecordedEvent> events;
  double kineticEnergy = 0;   ///< [J]
  double penetrationMax = 0;  ///< [m]
  double jointGapMax = 0;     ///< [m]
  /// [m], [rad] that a coordinate lies beyond its limits, or a swing beyond its cone, of the joints that are enabled;
  /// NaN: not known.
  double limitExcessMax = std::numeric_limits<double>::quiet_NaN();
  double limitExcessAngleMax = std::numeric_limits<double>::quiet_NaN();
  std::vector<RecordedJointState> joints{};  ///< of all joints, in order of Recording::joints, or empty
  /// How far pulleys, couplings and custom joints are from holding, one joint after the other in that order, or empty.
  /// Of a pulley: its length less what it may be [m], with slack no less than 0. Of a coupling: L - rest; of a free one
  /// how far L lies beyond its limits. Of a custom joint: C of each row, in the row's unit. Zero where not enabled.
  std::vector<float> residuals{};
};

/// A soft body. Its points are bodies, one after the other, behind all bodies that are no points; on each point of its
/// surface is a ball, a shape behind all other shapes. appendSoft (softs.h) makes them.
struct RecordedSoft {
  std::string name;
  bool cloth = false;
  uint32_t firstBody = 0;      ///< index into bodies: that of the first point
  uint32_t firstShape = 0;     ///< index into shapes: that of the first ball
  std::vector<Vec3> points{};  ///< at rest [m]
  std::vector<std::array<uint32_t, 3>>
      surface{};                 ///< of points, anticlockwise seen from outside; of cloth all triangles
  uint32_t elements = 0;         ///< tetrahedra or triangles
  float radius = 0;              ///< [m] of the balls
  double step = 0;               ///< [m] a file holds where points are in multiples of this
  std::optional<Color> color{};  ///< as in RecordedShape
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
  std::vector<RecordedSoft> softs{};
};

/// Numbers in RecordedFrame::residuals where there are any.
inline size_t residualCount(const Recording& head) {
  size_t count = 0;
  for (const RecordedJoint& joint : head.joints) count += joint.residuals;
  return count;
}

}  // namespace avbd
