// Reads recordings: at any frame, while they grow, and after the program that wrote them has died.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/file_error.h"
#include "io/record/chunk.h"
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
  /// Takes in what was written since. True if frames came, or the file was begun anew: then generation() is another and
  /// nothing read before holds. Throws FileError for what cannot be read; it may be at the next call.
  bool refresh();
  /// How often the file was begun anew, or replaced by another one of its name, since it was opened.
  uint64_t generation() const { return generation_; }
  /// With every `stride`-th frame and the last one. Frames that cannot be read are left out with a line in `leftOut`,
  /// or throw where there is none.
  Recording readAll(uint64_t stride = 1, std::vector<std::string>* leftOut = nullptr);
  /// Unpacks every chunk. Returns what is damaged, a line for each, beyond what the notes say.
  std::vector<std::string> verify();
  /// Where the last complete chunk that is no index ends: a writer goes on here.
  uint64_t contentEnd() const { return contentEnd_; }
  const record::Index& index() const { return index_; }

 private:
  struct FrameChunk {
    uint64_t offset, first;
  };
  void begin();
  bool openByIndex();
  void takeIndex(uint64_t offset, uint64_t frames);
  void clear();
  void forget();
  void scan();
  bool scanChunk();
  void passDamaged(const record::ChunkHead& head);
  bool skipDamage();
  void takeChunk(const record::ChunkHead& head, uint64_t offset, std::span<const uint8_t> stored);
  void takeHead(const record::ChunkHead& head, uint64_t offset, std::span<const uint8_t> stored);
  void takeFrames(uint64_t offset, uint64_t first, const std::vector<double>& times);
  void list(uint32_t type, uint64_t offset, uint64_t first, size_t count);
  void note(const std::string& text);
  std::pair<record::ChunkHead, record::Bytes> storedAt(uint64_t offset, uint32_t type) const;
  bool begunAnew() const;
  uint32_t fingerprint() const;
  std::string placeOf(uint64_t offset, uint32_t type) const;
  void load(size_t chunk);
  void noteEnd();

  std::filesystem::path path_;
  record::FileBytes file_;
  uint64_t generation_ = 0;
  uint32_t fingerprint_ = 0;  // of the chunks that tell this file from another
  RecordingInfo info_;
  record::HeadReader head_;
  record::Index index_;
  std::vector<FrameChunk> chunks_;
  std::vector<double> times_;
  uint64_t framesSeen_ = 0;  // by the file's own numbers, lost ones included
  uint64_t scanned_ = 0;     // everything before this is known; 0: not even the file's head
  uint64_t contentEnd_ = 0;
  bool indexLast_ = false;  // an index ends what is known: a writer goes on before it
  uint64_t headBytes_ = 0;  // unpacked, of the chunks of the head
  // Bytes of damaged chunks that were looked through; of those before the content's end.
  uint64_t searched_ = 0, contentSearched_ = 0;
  record::FrameBlock block_;  // of the chunk read last
  size_t loaded_ = SIZE_MAX;
  std::vector<std::string> scanNotes_;
};

/// Lines of text for `avbd info`: label and value. Throws FileError.
std::vector<std::pair<std::string, std::string>> describeRecording(const std::filesystem::path& path);
/// Whether a file begins as a recording does.
bool isRecording(const std::filesystem::path& path);

}  // namespace avbd
