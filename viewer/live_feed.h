// What a live page is sent: its head, the figures of frames as they come, and frames on demand, as messages of bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "io/record/reader.h"

namespace avbd::live {

using Message = std::shared_ptr<const std::vector<uint8_t>>;

/// The first four bytes of a message. All numbers little endian, 4 bytes where nothing else is said.
enum class MessageKind : uint32_t {
  Head = 1,  ///< JSON, from byte 4 on
  /// First frame, count, finished; 8-byte times; float energies, penetrations, gaps, limits' excess in metres and
  /// radians; contacts, kept.
  Figures = 2,
  /// Frame, bodies, contacts, joints, residuals, points of soft bodies; floats: 7 for each body, 3 for each point, 3
  /// for each contact's place, 3 for its force, 3 for the force on each joint's B, NaN where it is not enabled,
  /// residuals.
  Frame = 3,
  Report = 4,  ///< JSON, from byte 4 on: a list of label and value
};

class Feed {
 public:
  explicit Feed(const std::filesystem::path& recording) : reader_(recording), generation_(reader_.generation()) {}

  /// Reads on. False if the file was begun anew, and all that was sent is void. Throws FileError where the file cannot
  /// be read at the moment; what is known stays.
  bool update();
  /// Frames whose figures are known.
  uint32_t known() const { return static_cast<uint32_t>(times_.size()); }
  bool finished() const { return reader_.info().finished && known() == reader_.frameCount(); }
  /// Null while there is no frame.
  Message head();
  Message figures(uint32_t first) const;
  /// It comes last into a recording: after the head was sent, unless that had finished before.
  Message report() const;
  /// A frame that cannot be read has no bodies.
  Message frame(uint32_t number);

 private:
  void forget();

  RecordReader reader_;
  uint64_t generation_;  // the reader's, of all below
  Message head_;
  Vec3d origin_;
  std::vector<double> times_;
  std::vector<float> energy_, penetration_, gap_, excess_, excessAngle_;
  std::vector<uint32_t> contactsAll_, contactsKept_;
};

}  // namespace avbd::live
