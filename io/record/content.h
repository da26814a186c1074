// What stands in each kind of chunk: a recording's parts to fields and back. docs/recording.md lists the fields.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/record/fields.h"
#include "io/record/recording.h"

namespace avbd::record {

Bytes metaContent(const Recording& recording);
Bytes bodiesContent(const Recording& recording);
Bytes jointsContent(const Recording& recording);
Bytes softsContent(const Recording& recording);

/// Hulls, meshes and height fields, each once however many shapes use it.
class Surfaces {
 public:
  using Data = std::variant<std::shared_ptr<const HullData>, std::shared_ptr<const MeshData>,
                            std::shared_ptr<const HeightFieldData>>;
  /// Number of a shape's data, or kNotRecorded; data of equal content have one number.
  uint32_t add(const Geometry& geometry);
  const std::vector<Data>& all() const { return all_; }

 private:
  std::map<std::pair<size_t, uint64_t>, uint32_t> numbers_;  // by kind and content hash
  std::vector<Data> all_;
};
/// Red in the lowest byte; 0, which nobody sees, is no colour.
uint32_t packedColor(const std::optional<Color>& color);
std::optional<Color> unpackedColor(uint32_t color);
Bytes surfaceContent(const Surfaces::Data& data);
Bytes shapesContent(const Recording& recording, Surfaces& surfaces);

// Back. Each adds to `to`; FileError where a chunk does not fit. What a newer writer knew and this reader does not is
// left out with a line in `notes`.
struct HeadReader {
  /// Its data are null where they could not be made.
  struct Surface {
    uint8_t kind;
    Surfaces::Data data;
  };
  Recording recording;
  std::vector<Surface> surfaces;
  std::vector<std::string> notes;
  uint64_t thingsMost = 0;  ///< bodies, shapes and joints, each

  /// True if the chunk was one of these.
  bool take(uint32_t type, const FieldReader& fields);

 private:
  void takeMeta(const FieldReader& f);
  void takeBodies(const FieldReader& f);
  void takeSurface(const FieldReader& f);
  void takeShapes(const FieldReader& f);
  void takeJoints(const FieldReader& f);
  void takeSofts(const FieldReader& f);
  void refuseMore(const FieldReader& f, uint16_t id, size_t held) const;
  Geometry geometryOf(uint8_t kind, const float size[4], uint32_t surface, const FieldReader& f);
};

/// A run of frames as columns. The points of soft bodies have none but their own.
struct FrameBlock {
  uint64_t first = 0;
  uint32_t bodies = 0;  ///< that are no points
  uint32_t points = 0;
  bool hasVelocities = false;
  std::vector<double> times, positions;
  std::vector<float> rotations, linear, angular;
  std::vector<double> kineticEnergy, penetration, gap;
  std::vector<uint32_t> contactCounts, contactsLeftOut, contactA, contactB;
  std::vector<float> contactOffset, contactForce, contactNormal, contactSeparation;
  std::vector<uint32_t> eventCounts, eventA, eventB;
  std::vector<uint8_t> eventKind;
  std::vector<double> eventPosition;
  std::vector<float> eventNormal, eventSpeed, eventImpulse;
  std::vector<double> excess, excessAngle;
  uint32_t joints = 0;  ///< of each frame; 0: what they did is not known
  std::vector<float> jointForce, jointTorque;
  std::vector<uint8_t> jointEnabled;
  size_t residualsEach = 0;  ///< of each frame; 0: not known
  std::vector<float> residuals;
  std::vector<int64_t> pointPlaces;                                          ///< in steps of their soft bodies
  std::vector<uint32_t> contactBallA, contactBallB, eventBallA, eventBallB;  ///< index among the points' shapes

  size_t size() const { return times.size(); }
  /// At least what its content takes.
  size_t bytes() const;
  /// At least what a frame adds to that.
  static size_t bytesOf(const RecordedFrame& frame);
  /// The frame must have as many bodies, joints and residuals, and velocities or none, as those before it.
  void add(const RecordedFrame& frame, const Recording& head);
  RecordedFrame frame(size_t i, const Recording& head) const;

 private:
  void addJoints(const RecordedFrame& frame);
  void addPoints(const RecordedFrame& frame, const Recording& head);
  void placePoints(size_t i, const Recording& head, RecordedFrame& out) const;
};
Bytes framesContent(const FrameBlock& block);
/// Throws FileError for a run that does not fit in itself, or names bodies, shapes or kinds that there are not.
FrameBlock framesOf(const FieldReader& fields, const Recording& head);
/// The first frame's number and all times. As many frames as the bodies' poses are there for.
std::pair<uint64_t, std::vector<double>> timesOf(const FieldReader& fields, const Recording& head);

/// Where the chunks are.
struct Index {
  std::vector<uint64_t> offsets, firsts;  ///< firsts: of FRAM chunks, else 0
  std::vector<uint32_t> types, counts;    ///< counts: frames of FRAM chunks, else 0
  std::vector<double> times;              ///< of all frames
};
Bytes indexContent(const Index& index);
Index indexOf(const FieldReader& fields);

}  // namespace avbd::record
