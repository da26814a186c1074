// Opening by the index, or by going through all chunks; then frames by number.
#include "io/record/reader.h"

#include <algorithm>
#include <cmath>

#include "io/record/crc.h"
#include "io/record/limits.h"

namespace avbd {

using namespace record;

namespace {

bool isHead(uint32_t type) {
  return type == kMeta || type == kBodies || type == kSurfaces || type == kShapes || type == kJoints || type == kSofts;
}

/// Without these there is nothing to show the frames on.
bool isNeeded(uint32_t type) { return type == kBodies || type == kSurfaces || type == kShapes || type == kSofts; }

/// For replay alone (run_again.h).
bool isForReplay(uint32_t type) { return type == kRun || type == kSteps; }

bool isKnown(uint32_t type) { return isHead(type) || isForReplay(type) || type == kFrames || type == kIndex; }

bool ascend(const std::vector<double>& times) {
  return std::all_of(times.begin(), times.end(), [](double t) { return std::isfinite(t); }) &&
         std::is_sorted(times.begin(), times.end());
}

}  // namespace

RecordReader::RecordReader(const std::filesystem::path& path) : path_(path), file_(path, FileBytes::Access::Read) {
  begin();
}

// All or nothing: what throws leaves an empty recording, to be begun again.
void RecordReader::begin() {
  Bytes head(kFileHeadBytes);
  head.resize(file_.read(0, head));
  checkFileHead(head, file_.name());
  clear();
  info_.versionMajor = kMajor;
  info_.versionMinor = minorOf(head);
  scanned_ = contentEnd_ = kFileHeadBytes;
  try {
    if (!openByIndex()) scan();
    noteEnd();
  } catch (const FileError&) {
    clear();
    throw;
  }
}

void RecordReader::clear() {
  info_ = {};
  forget();
}

void RecordReader::forget() {
  head_ = {};
  index_ = {};
  chunks_.clear();
  times_.clear();
  scanNotes_.clear();
  framesSeen_ = headBytes_ = searched_ = contentSearched_ = scanned_ = contentEnd_ = 0;
  loaded_ = SIZE_MAX;
  indexLast_ = false;
}

// False if the end is missing or anything does not fit: the chunks then say more than the index.
bool RecordReader::openByIndex() {
  const uint64_t size = file_.size();
  if (size < kFileHeadBytes + kFooterBytes) return false;
  Bytes end(kFooterBytes);
  file_.read(size - kFooterBytes, end);
  const std::optional<Footer> footer = footerOf(end);
  if (!footer) return false;
  try {
    takeIndex(footer->index, footer->frames);
  } catch (const FileError& e) {
    forget();
    scanned_ = contentEnd_ = kFileHeadBytes;
    note(std::string("not opened by its index: ") + e.what());
    return false;
  }
  scanned_ = size;
  contentEnd_ = footer->index;
  info_.finished = true;
  return true;
}

void RecordReader::takeIndex(uint64_t offset, uint64_t frames) {
  const std::string place = placeOf(offset, kIndex);
  const uint64_t size = file_.size();
  const auto [head, stored] = storedAt(offset, kIndex);
  if (head.raw > indexMost(size)) throw FileError(place + " is longer than a file of this size needs", file_.name());
  const Bytes content = unpack(head, stored, place);
  const Index index = indexOf(FieldReader(content, place));
  uint64_t before = 0, last = 0;
  for (size_t i = 0; i < index.offsets.size(); ++i) {
    if (index.offsets[i] <= last || index.offsets[i] >= offset)
      throw FileError(place + ": its chunks do not ascend", file_.name());
    last = index.offsets[i];
    if (index.types[i] == kFrames) {
      chunks_.push_back({last, before});
      before += index.counts[i];
    } else if (isHead(index.types[i])) {
      const auto [partHead, part] = storedAt(last, index.types[i]);
      takeHead(partHead, last, part);
    } else if (!isForReplay(index.types[i])) {
      note("chunk " + typeName(index.types[i]) + " is not known to this version and left out");
    }
  }
  if (before != frames || before != index.times.size() || before > framesMost(size) || !ascend(index.times))
    throw FileError(place + ": its frames do not fit", file_.name());
  times_ = index.times;
  framesSeen_ = before;
  index_ = index;
}

// As they stand in the file, their sum checked.
std::pair<ChunkHead, Bytes> RecordReader::storedAt(uint64_t offset, uint32_t type) const {
  const std::string place = placeOf(offset, type);
  Bytes head(kChunkHeadBytes);
  head.resize(file_.read(offset, head));
  const std::optional<ChunkHead> found = chunkHead(head);
  if (!found || found->type != type) throw FileError(place + " is damaged: its head does not fit", file_.name());
  if (found->stored > file_.size() - offset - kChunkHeadBytes) throw FileError(place + " is cut off", file_.name());
  Bytes stored(found->stored);
  stored.resize(file_.read(offset + kChunkHeadBytes, stored));
  if (crc32c(stored) != found->sum) throw FileError(place + " is damaged: its checksum does not fit", file_.name());
  return {*found, std::move(stored)};
}

std::string RecordReader::placeOf(uint64_t offset, uint32_t type) const {
  return file_.name() + ": chunk " + typeName(type) + " at byte " + std::to_string(offset);
}

// The same of many chunks is said once.
void RecordReader::note(const std::string& text) {
  constexpr size_t kLooked = 16;
  const auto begin = scanNotes_.end() - static_cast<std::ptrdiff_t>(std::min(kLooked, scanNotes_.size()));
  if (std::find(begin, scanNotes_.end(), text) == scanNotes_.end()) scanNotes_.push_back(text);
}

void RecordReader::takeHead(const ChunkHead& head, uint64_t offset, std::span<const uint8_t> stored) {
  const uint64_t size = file_.size();
  if (headBytes_ + head.raw > headMost(size))
    throw FileError(placeOf(offset, head.type) + " unpacks to more than a file of this size may hold", file_.name());
  const Bytes content = unpack(head, stored, placeOf(offset, head.type));
  headBytes_ += head.raw;
  head_.thingsMost = thingsMost(size);
  head_.take(head.type, FieldReader(content, placeOf(offset, head.type)));
}

void RecordReader::takeFrames(uint64_t offset, uint64_t first, const std::vector<double>& times) {
  const double last = times_.empty() ? -INFINITY : times_.back();
  if (times.empty() || !ascend(times) || times[0] < last)
    throw FileError(placeOf(offset, kFrames) + ": its times do not ascend", file_.name());
  if (times_.size() + times.size() > framesMost(file_.size()))
    throw FileError(placeOf(offset, kFrames) + ": more frames than a file of this size may hold", file_.name());
  if (first > framesSeen_)
    note("frames " + std::to_string(framesSeen_) + " to " + std::to_string(first - 1) + " are lost");
  framesSeen_ = first + times.size();
  chunks_.push_back({offset, times_.size()});
  times_.insert(times_.end(), times.begin(), times.end());
  index_.times.insert(index_.times.end(), times.begin(), times.end());
}

void RecordReader::list(uint32_t type, uint64_t offset, uint64_t first, size_t count) {
  index_.offsets.push_back(offset);
  index_.types.push_back(type);
  index_.firsts.push_back(first);
  index_.counts.push_back(static_cast<uint32_t>(count));
}

// Adds to the index too.
void RecordReader::takeChunk(const ChunkHead& head, uint64_t offset, std::span<const uint8_t> stored) {
  if (head.type == kIndex) return;
  if (head.type == kFrames) {
    const Bytes content = unpack(head, stored, placeOf(offset, kFrames));
    const auto [first, times] = timesOf(FieldReader(content, placeOf(offset, kFrames)), head_.recording);
    takeFrames(offset, first, times);
    return list(kFrames, offset, first, times.size());
  }
  if (isHead(head.type))
    takeHead(head, offset, stored);
  else if (!isForReplay(head.type))
    note("chunk " + typeName(head.type) + " is not known to this version and left out");
  list(head.type, offset, 0, 0);
}

void RecordReader::scan() {
  while (scanChunk() || skipDamage()) {
  }
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
  if (crc32c(stored) != head->sum) {
    passDamaged(*head);
    return true;
  }
  try {
    takeChunk(*head, offset, stored);
  } catch (const FileError& e) {
    if (isNeeded(head->type)) throw;
    note(e.what());
  }
  scanned_ += kChunkHeadBytes + stored.size();
  indexLast_ = head->type == kIndex;
  if (indexLast_) return true;
  contentEnd_ = scanned_;
  contentSearched_ = searched_;
  return true;
}

// What was written in part stands before what was written next, somewhere within the length that its head claims.
void RecordReader::passDamaged(const ChunkHead& head) {
  const std::string what = placeOf(scanned_, head.type) + " is damaged: its checksum does not fit";
  if (isNeeded(head.type)) throw FileError(what, file_.name());
  note(what);
  searched_ += head.stored;
  constexpr uint64_t kTimesThrough = 4;  // many heads with lengths that reach over all others must not take for ever
  const bool search = searched_ <= kTimesThrough * file_.size();
  scanned_ += kChunkHeadBytes + (search ? 0 : head.stored);
}

// Finds the next sound chunk behind damage; false at the file's end.
bool RecordReader::skipDamage() {
  const uint64_t size = file_.size();
  size_t length = 1 << 12;
  for (uint64_t at = scanned_ + 1; at + kChunkHeadBytes <= size;
       at += length, length = std::min<size_t>(2 * length, 1 << 20)) {
    Bytes block(static_cast<size_t>(std::min<uint64_t>(size - at, length + kChunkHeadBytes)));
    block.resize(file_.read(at, block));
    for (size_t i = 0; i < length && i + kChunkHeadBytes <= block.size(); ++i) {
      if (block[i] != 'C' || !chunkHead(std::span(block).subspan(i))) continue;
      note("bytes " + std::to_string(scanned_) + " to " + std::to_string(at + i - 1) + " are damaged and left out");
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
  fingerprint_ = fingerprint();
}

// Heads hold the sums of their contents: those of the first chunks and of the last one tell files apart, at the cost of
// a few hundred bytes however long the file is.
uint32_t RecordReader::fingerprint() const {
  constexpr size_t kFirst = 8;
  uint32_t sum = 0;
  const auto add = [&](uint64_t offset, size_t length) {
    Bytes bytes(length);
    bytes.resize(file_.read(offset, bytes));
    sum = crc32(bytes, Polynomial::Castagnoli, sum);
  };
  add(0, kFileHeadBytes);
  for (size_t i = 0; i < std::min(kFirst, index_.offsets.size()); ++i) add(index_.offsets[i], kChunkHeadBytes);
  if (!chunks_.empty()) add(chunks_.front().offset, kChunkHeadBytes);
  if (!index_.offsets.empty()) add(index_.offsets.back(), kChunkHeadBytes);
  return sum;
}

bool RecordReader::begunAnew() const { return file_.size() < contentEnd_ || fingerprint() != fingerprint_; }

bool RecordReader::refresh() {
  const size_t before = times_.size();
  const bool moved = !file_.isAt(path_);
  if (moved) file_ = FileBytes(path_, FileBytes::Access::Read);
  if (scanned_ > 0 && (moved || begunAnew())) {
    ++generation_;
    clear();
  }
  if (scanned_ == 0) {
    begin();
    return true;
  }
  if (info_.finished && file_.size() == scanned_) return false;
  // Someone appends: the end was cut off.
  if (info_.finished || indexLast_) {
    scanned_ = contentEnd_;
    searched_ = contentSearched_;
  }
  info_.finished = indexLast_ = false;
  loaded_ = SIZE_MAX;  // bodies may come that its frames do not fit
  try {
    scan();
  } catch (const FileError&) {
    noteEnd();  // of what came before
    throw;
  }
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
  const auto [packed, stored] = storedAt(offset, kFrames);
  const Bytes content = unpack(packed, stored, placeOf(offset, kFrames));
  const FieldReader fields(content, placeOf(offset, kFrames));
  FrameBlock block = framesOf(fields, head());
  const auto at = [&](uint64_t frame) { return times_.begin() + static_cast<std::ptrdiff_t>(frame); };
  const uint64_t end = chunk + 1 < chunks_.size() ? chunks_[chunk + 1].first : times_.size();
  if (!std::equal(block.times.begin(), block.times.end(), at(chunks_[chunk].first), at(end)))
    throw FileError(fields.place() + " does not fit the index", file_.name());
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

Recording RecordReader::readAll(uint64_t stride, std::vector<std::string>* leftOut) {
  Recording all = head();
  for (uint64_t i = 0; i < frameCount(); i += stride) {
    try {
      all.frames.push_back(frame(i));
    } catch (const FileError& e) {
      if (!leftOut) throw;
      if (leftOut->empty() || leftOut->back() != e.what()) leftOut->emplace_back(e.what());
    }
    if (i + 1 < frameCount() && i + stride >= frameCount()) i = frameCount() - 1 - stride;
  }
  return all;
}

std::vector<std::string> RecordReader::verify() {
  std::vector<std::string> found;
  for (size_t i = 0; i < index_.offsets.size(); ++i) {
    try {
      const auto [head, stored] = storedAt(index_.offsets[i], index_.types[i]);
      if (isKnown(head.type)) unpack(head, stored, placeOf(index_.offsets[i], head.type));
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
