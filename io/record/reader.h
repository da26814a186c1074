// Reads recordings: at any frame, while they grow, and after the program that wrote them has died.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/file_error.h"
#include "io/record/content.h"
#include "io/record/file_bytes.h"
#include "io/record/recording.h"

namespace avbd {

struct RecordingInfo {
  uint16_t versionMajor = 0, versionMinor = 0;
  uint64_t bytes = 0;
  uint64_t chunks = 0, frames = 0;
  double firstTime = 0, lastTime = 0;  ///< [s]; 0 if there is no frame
  bool finished = false;               ///< index and end are there: the writer came to its end
  std::vector<std::string> notes;      ///< what is damaged, cut off or not known to this version
};

/// Not for several threads at once.
class RecordReader {
 public:
  /// Throws FileError for what is no recording, is of a version to come, or lacks what frames need. A file without its
  /// end is searched for all complete chunks.
  explicit RecordReader(const std::filesystem::path& path);

  const RecordingInfo& info() const { return info_; }
  const Recording& head() const { return head_.recording; }  ///< everything but frames
  uint64_t frameCount() const { return times_.size(); }
  /// Of all frames [s], ascending.
  const std::vector<double>& times() const { return times_; }
  /// The last frame at or before this time; 0 if all are later.
  uint64_t frameAt(double time) const;
  /// Throws FileError, with the chunk's place, if the frame's chunk is damaged.
  RecordedFrame frame(uint64_t number);
  /// Takes in what was written since. True if there are new frames.
  bool refresh();
  /// With every `stride`-th frame and the last one.
  Recording readAll(uint64_t stride = 1);
  /// Unpacks every chunk. Returns what is damaged, a line for each, beyond what the notes say.
  std::vector<std::string> verify();
  /// Where the last complete chunk that is no index ends: a writer goes on here.
  uint64_t contentEnd() const { return contentEnd_; }
  const record::Index& index() const { return index_; }

 private:
  struct FrameChunk {
    uint64_t offset, first;
  };
  bool openByIndex();
  void clear();
  void scan();
  bool scanChunk();
  bool skipDamage();
  bool takeChunk(uint32_t type, uint64_t offset, const record::Bytes& content);
  void takeFrames(uint64_t offset, uint64_t first, const std::vector<double>& times);
  record::Bytes chunkAt(uint64_t offset, uint32_t type) const;
  std::string placeOf(uint64_t offset, uint32_t type) const;
  void load(size_t chunk);
  void noteEnd();

  record::FileBytes file_;
  RecordingInfo info_;
  record::HeadReader head_;
  record::Index index_;
  std::vector<FrameChunk> chunks_;
  std::vector<double> times_;
  uint64_t framesSeen_ = 0;  // by the file's own numbers, lost ones included
  uint64_t scanned_ = 0;     // everything before this is known
  uint64_t contentEnd_ = 0;
  record::FrameBlock block_;  // of the chunk read last
  size_t loaded_ = SIZE_MAX;
  std::vector<std::string> scanNotes_;
};

/// Lines of text for `avbd info`: label and value. Throws FileError.
std::vector<std::pair<std::string, std::string>> describeRecording(const std::filesystem::path& path);
/// Whether a file begins as a recording does.
bool isRecording(const std::filesystem::path& path);

}  // namespace avbd
