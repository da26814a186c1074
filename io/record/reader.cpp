// Opening by the index, or by going through all chunks; then frames by number.
#include "io/record/reader.h"

#include <algorithm>
#include <cmath>

#include "io/record/chunk.h"

namespace avbd {

using namespace record;

RecordReader::RecordReader(const std::filesystem::path& path) : file_(path, FileBytes::Access::Read) {
  Bytes head(kFileHeadBytes);
  head.resize(file_.read(0, head));
  checkFileHead(head, file_.name());
  info_.versionMajor = kMajor;
  info_.versionMinor = minorOf(head);
  if (!openByIndex()) {
    clear();
    scan();
  }
  noteEnd();
}

void RecordReader::clear() {
  head_ = {};
  index_ = {};
  chunks_.clear();
  times_.clear();
  framesSeen_ = 0;
  scanned_ = contentEnd_ = kFileHeadBytes;
  info_.finished = false;
}

// False if the end is missing or anything does not fit: the chunks then say more than the index.
bool RecordReader::openByIndex() {
  const uint64_t size = file_.size();
  if (size < kFileHeadBytes + kFooterBytes) return false;
  Bytes end(kFooterBytes);
  file_.read(size - kFooterBytes, end);
  const std::optional<Footer> footer = footerOf(end);
  if (!footer) return false;
  clear();
  try {
    const Bytes content = chunkAt(footer->index, kIndex);
    const Index index = indexOf(FieldReader(content, placeOf(footer->index, kIndex)));
    uint64_t before = 0;
    for (size_t i = 0; i < index.offsets.size(); ++i) {
      if (index.types[i] == kFrames) {
        chunks_.push_back({index.offsets[i], before});
        before += index.counts[i];
      } else if (index.types[i] != kSoftFrames) {
        const Bytes part = chunkAt(index.offsets[i], index.types[i]);
        takeChunk(index.types[i], index.offsets[i], part);
      }
    }
    if (before != footer->frames || !std::is_sorted(index.times.begin(), index.times.end())) return false;
    times_ = index.times;
    framesSeen_ = index.counts.empty() ? 0 : before;
    index_ = index;
  } catch (const FileError& e) {
    scanNotes_ = {std::string("not opened by its index: ") + e.what()};
    return false;
  }
  scanned_ = size;
  contentEnd_ = footer->index;
  info_.finished = true;
  return true;
}

Bytes RecordReader::chunkAt(uint64_t offset, uint32_t type) const {
  const std::string place = placeOf(offset, type);
  Bytes head(kChunkHeadBytes);
  head.resize(file_.read(offset, head));
  const std::optional<ChunkHead> found = chunkHead(head);
  if (!found || found->type != type) throw FileError(place + " is damaged: its head does not fit", file_.name());
  if (found->stored > file_.size() - offset - kChunkHeadBytes) throw FileError(place + " is cut off", file_.name());
  Bytes stored(found->stored);
  stored.resize(file_.read(offset + kChunkHeadBytes, stored));
  return unpack(*found, stored, place);
}

std::string RecordReader::placeOf(uint64_t offset, uint32_t type) const {
  return file_.name() + ": chunk " + typeName(type) + " at byte " + std::to_string(offset);
}

void RecordReader::takeFrames(uint64_t offset, uint64_t first, const std::vector<double>& times) {
  const double last = times_.empty() ? -INFINITY : times_.back();
  if (times.empty() || !(times[0] >= last) || !std::is_sorted(times.begin(), times.end()) ||
      !std::isfinite(times.front()) || !std::isfinite(times.back()))
    throw FileError(placeOf(offset, kFrames) + ": its times do not ascend", file_.name());
  if (first > framesSeen_)
    scanNotes_.push_back("frames " + std::to_string(framesSeen_) + " to " + std::to_string(first - 1) + " are lost");
  framesSeen_ = first + times.size();
  chunks_.push_back({offset, times_.size()});
  times_.insert(times_.end(), times.begin(), times.end());
}

// Adds to the index too. False for the index itself.
bool RecordReader::takeChunk(uint32_t type, uint64_t offset, const Bytes& content) {
  if (type == kIndex) return false;
  const FieldReader fields(content, placeOf(offset, type));
  uint64_t first = 0;
  uint32_t count = 0;
  if (type == kFrames) {
    const auto [number, times] = timesOf(fields);
    takeFrames(offset, number, times);
    first = number;
    count = static_cast<uint32_t>(times.size());
  } else if (!head_.take(type, fields)) {
    scanNotes_.push_back("chunk " + typeName(type) + " is not known to this version and left out");
  }
  index_.offsets.push_back(offset);
  index_.types.push_back(type);
  index_.firsts.push_back(first);
  index_.counts.push_back(count);
  return true;
}

void RecordReader::scan() {
  while (scanChunk() || skipDamage()) {
  }
  index_.times = times_;
}

// Takes the chunk at `scanned_`; false if none is complete there.
bool RecordReader::scanChunk() {
  Bytes bytes(kChunkHeadBytes);
  bytes.resize(file_.read(scanned_, bytes));
  const std::optional<ChunkHead> head = chunkHead(bytes);
  if (!head || head->stored > file_.size() - scanned_ - kChunkHeadBytes) return false;
  const uint64_t offset = scanned_;
  Bytes stored(head->stored);
  stored.resize(file_.read(offset + kChunkHeadBytes, stored));
  scanned_ += kChunkHeadBytes + stored.size();
  try {
    if (takeChunk(head->type, offset, unpack(*head, stored, placeOf(offset, head->type)))) contentEnd_ = scanned_;
  } catch (const FileError& e) {
    // A head that cannot be read leaves nothing to show the frames on.
    if (head->type != kFrames && head->type != kIndex && head->type != kMeta) throw;
    scanNotes_.push_back(e.what());
    if (head->type != kIndex) contentEnd_ = scanned_;
  }
  return true;
}

// Finds the next sound chunk behind damage; false at the file's end.
bool RecordReader::skipDamage() {
  const uint64_t size = file_.size();
  if (size <= scanned_) return false;
  Bytes bytes(kChunkHeadBytes);
  bytes.resize(file_.read(scanned_, bytes));
  if (chunkHead(bytes)) return false;  // cut off: nothing can follow
  constexpr size_t kBlock = 1 << 16;
  for (uint64_t at = scanned_ + 1; at + kChunkHeadBytes <= size; at += kBlock) {
    Bytes block(static_cast<size_t>(std::min<uint64_t>(size - at, kBlock + kChunkHeadBytes)));
    block.resize(file_.read(at, block));
    for (size_t i = 0; i < kBlock && i + kChunkHeadBytes <= block.size(); ++i) {
      if (block[i] != 'C' || !chunkHead(std::span(block).subspan(i))) continue;
      scanNotes_.push_back("bytes " + std::to_string(scanned_) + " to " + std::to_string(at + i - 1) +
                           " are damaged and left out");
      scanned_ = at + i;
      return true;
    }
  }
  return false;
}

// What the file's end says about its writer.
void RecordReader::noteEnd() {
  const uint64_t size = file_.size();
  info_.notes = scanNotes_;
  info_.notes.insert(info_.notes.end(), head_.notes.begin(), head_.notes.end());
  if (!info_.finished && size >= scanned_ + kFooterBytes) {
    Bytes end(kFooterBytes);
    file_.read(size - kFooterBytes, end);
    info_.finished = size == scanned_ + kFooterBytes && footerOf(end).has_value();
    if (info_.finished) scanned_ = size;
  }
  if (!info_.finished) {
    const uint64_t rest = size - std::min(size, scanned_);
    info_.notes.push_back("the end is missing: still being written, or its program stopped early" +
                          (rest > 0 ? "; the last " + std::to_string(rest) + " bytes are no complete chunk and left out"
                                    : std::string()));
  }
  info_.bytes = size;
  info_.chunks = index_.offsets.size();
  info_.frames = times_.size();
  info_.firstTime = times_.empty() ? 0 : times_.front();
  info_.lastTime = times_.empty() ? 0 : times_.back();
}

bool RecordReader::refresh() {
  const size_t before = times_.size();
  if (file_.size() < scanned_) {  // written anew
    clear();
    scanNotes_.clear();
    loaded_ = SIZE_MAX;
  }
  if (info_.finished && file_.size() == scanned_) return false;
  if (info_.finished) scanned_ = contentEnd_;  // someone appends: the end was cut off
  info_.finished = false;
  scan();
  noteEnd();
  return times_.size() != before;
}

uint64_t RecordReader::frameAt(double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  return after == times_.begin() ? 0 : static_cast<uint64_t>(after - times_.begin() - 1);
}

void RecordReader::load(size_t chunk) {
  if (loaded_ == chunk) return;
  const uint64_t offset = chunks_[chunk].offset;
  const Bytes content = chunkAt(offset, kFrames);
  const FieldReader fields(content, placeOf(offset, kFrames));
  FrameBlock block = framesOf(fields);
  const size_t end = chunk + 1 < chunks_.size() ? chunks_[chunk + 1].first : times_.size();
  if (block.bodies != head().bodies.size() || block.size() != end - chunks_[chunk].first)
    throw FileError(fields.place() + " does not fit the bodies or the index", file_.name());
  block_ = std::move(block);
  loaded_ = chunk;
}

RecordedFrame RecordReader::frame(uint64_t number) {
  if (number >= times_.size())
    throw FileError(file_.name() + ": has no frame " + std::to_string(number) + " of " + std::to_string(times_.size()),
                    file_.name());
  const auto after = std::upper_bound(chunks_.begin(), chunks_.end(), number,
                                      [](uint64_t n, const FrameChunk& chunk) { return n < chunk.first; });
  const auto chunk = static_cast<size_t>(after - chunks_.begin() - 1);
  load(chunk);
  return block_.frame(static_cast<size_t>(number - chunks_[chunk].first), head());
}

Recording RecordReader::readAll(uint64_t stride) {
  Recording all = head();
  for (uint64_t i = 0; i < frameCount(); i += stride) {
    all.frames.push_back(frame(i));
    if (i + 1 < frameCount() && i + stride >= frameCount()) i = frameCount() - 1 - stride;
  }
  return all;
}

std::vector<std::string> RecordReader::verify() {
  std::vector<std::string> found;
  for (size_t i = 0; i < index_.offsets.size(); ++i) {
    try {
      chunkAt(index_.offsets[i], index_.types[i]);
    } catch (const FileError& e) {
      found.emplace_back(e.what());
    }
  }
  for (size_t i = 0; i < chunks_.size() && found.empty(); ++i) {
    try {
      load(i);
    } catch (const FileError& e) {
      found.emplace_back(e.what());
    }
  }
  return found;
}

}  // namespace avbd
