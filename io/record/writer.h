// Writes recordings, a chunk of frames at a time: what is on the disk stays readable whatever happens to the program.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/record/content.h"
#include "io/record/file_bytes.h"
#include "io/record/recording.h"

namespace avbd {

struct RecordOptions {
  bool compress = true;  ///< with zstd, where the build has it
  /// A chunk is written when it holds so many frames, or so many bytes before compression.
  uint32_t framesPerChunk = 64;
  size_t bytesPerChunk = 4u << 20;
};

class RecordWriter {
 public:
  /// Begins a file with a recording's head; frames that it holds are not written. Throws std::invalid_argument for a
  /// head that does not fit together or is too large to be read again, before the file is touched, and FileError if it
  /// cannot be written.
  RecordWriter(const std::filesystem::path& path, const Recording& head, const RecordOptions& options = {});
  /// Goes on after the last complete chunk of a file: one that was finished, or whose writer died.
  static RecordWriter reopen(const std::filesystem::path& path, const RecordOptions& options = {});
  RecordWriter(RecordWriter&&) noexcept = default;
  /// Finishes the file if it can.
  ~RecordWriter();

  /// Throws std::invalid_argument for a frame that does not fit the head, lies before the last one, or is too large for
  /// a chunk. What cannot be written throws FileError, as in the calls below, and leaves the file as it was before;
  /// what was added stays and is written with the next call.
  void add(const RecordedFrame& frame);
  /// Writes what was added, so that others can read it.
  void flush();
  /// Writes a chunk beside the frames (run_again.h).
  void addChunk(uint32_t type, const record::Bytes& content);
  /// Flushes, writes the report, the index and the end. Nothing can be added after.
  void finish(const std::vector<std::pair<std::string, std::string>>& report = {});
  uint64_t frameCount() const { return index_.times.size() + block_.size(); }
  const Recording& head() const { return head_; }

 private:
  /// A whole chunk of the head.
  struct Part {
    uint32_t type;
    record::Bytes chunk;
  };
  RecordWriter(const std::filesystem::path& path, const Recording& head, const RecordOptions& options,
               const std::vector<Part>& parts);
  RecordWriter(record::FileBytes file, Recording head, record::Index index, uint64_t at, const RecordOptions& options);
  static std::vector<Part> partsOf(const Recording& head, bool compress);
  void check(const RecordedFrame& frame) const;
  void append(const record::Bytes& bytes);
  void write(uint32_t type, const record::Bytes& chunk);

  record::FileBytes file_;
  RecordOptions options_;
  Recording head_;
  record::Index index_;
  uint64_t at_ = 0;
  uint64_t next_ = 0;  // number of the next frame
  record::FrameBlock block_;
  bool open_ = false;
};

}  // namespace avbd
